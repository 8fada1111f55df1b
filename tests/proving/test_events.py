"""What sets in at an instant does so in one recording, and lasts; what belongs to a day is gone on the next."""

import json
from dataclasses import replace

import numpy as np
import pytest

from evaluation.proving.case import Case, drawn_chain, run_truth
from evaluation.proving.cases import drawn_cases
from evaluation.proving.draw import drawn_effect
from evaluation.proving.effects import measurement
from evaluation.proving.effects.effect import STRENGTHS, coil_place, drawn_values, everywhere, value_at
from evaluation.proving.effects.electrical import OpenCoil
from evaluation.proving.effects.thermal import Draught
from evaluation.proving.pendulum import arm
from evaluation.proving.rig import drawn_rig
from evaluation.proving.setups import EFFECTS, SETUPS

SETUP = replace(SETUPS["small"], stop=30.0, step=0.5)


def case_with(effect, recording):
    rng = np.random.default_rng(4)
    programmes = [SETUP.shapes["soak"](rng, SETUP.top, 30.0) for _ in range(3)]
    effect.recording = recording
    rig, chain = drawn_rig(SETUP.sheet, rng), drawn_chain(SETUP, rng)
    strengths = {effect.identifier: "strong"}
    return Case("case", "single", SETUP, rig, [effect], [], strengths, programmes[:2], programmes[2:], (), chain)


def first_difference(case, number):
    """When the effect first shows in the coil's own string or temperature [s]; None: it does not."""
    programme = [*case.training, *case.held_out][number - 1]
    with_it, without = (run_truth(c, programme, number) for c in (case, replace(case, effects=[])))
    times, plain = without.signal("power")
    own, changed = with_it.signal("power")
    moments = np.arange(0.05, 30.0, 0.1)
    power = [np.stack([np.interp(moments, t, c) for c in v.T]) for t, v in ((times, plain), (own, changed))]
    warm = [np.stack([np.interp(moments, t.time, c) for c in t.states["temperature"].T]) for t in (without, with_it)]
    away = (np.abs(power[1] - power[0]) > 1e-3).any(axis=0) | (np.abs(warm[1] - warm[0]) > 0.2).any(axis=0)
    return float(moments[np.argmax(away)]) if away.any() else None


@pytest.mark.parametrize("recording", [1, 2])
def test_a_break_sets_in_once_and_lasts(recording, tmp_path):
    case = case_with(OpenCoil(coil_place(SETUP.sheet, 4), {"openness": 1.0, "instant": 12.0}), recording)
    found = [first_difference(case, n) for n in (1, 2, 3)]
    assert found[: recording - 1] == [None] * (recording - 1)
    assert found[recording - 1] == pytest.approx(12.0, abs=0.15)
    # In later ones it is there from the start: it shows as soon as the supply is switched on, at 2 s.
    assert found[recording:] == pytest.approx([2.0] * (3 - recording), abs=0.15)
    case.write(tmp_path / "cases", tmp_path / "answers", np.random.default_rng(1))
    (told,) = json.loads((tmp_path / "answers" / "case.json").read_text())["findings"]
    begins = [(i["order"], i["begin"]) for i in told["intervals"]]
    assert begins == [(recording, 12.0), *((n, 0.0) for n in range(recording + 1, 4))]
    assert told["intervals"][0]["title"] == f"small, training {recording}"


def test_a_draught_belongs_to_its_day():
    case = case_with(Draught(everywhere(SETUP.sheet), {"amount": 0.5, "instant": 12.0}), 1)
    assert first_difference(case, 1) == pytest.approx(12.3, abs=0.35)
    assert first_difference(case, 2) is None
    assert first_difference(case, 3) is None


def test_events_are_drawn_for_both_training_recordings_and_for_none_held_out():
    cases = [c for c, _ in drawn_cases(120, 3, ["single"]) if isinstance(c, Case)]
    numbers = [e.recording for c in cases for e in c.effects if e.is_sudden]
    assert set(numbers) == {1, 2}


def test_a_strength_is_a_third_of_its_range_and_no_value_is_preferred():
    rng = np.random.default_rng(1)
    drawn = [drawn_values({"x": (1.0, 8.0)}, {"y": (0.5, 2.0)}, s, rng) for s in STRENGTHS for _ in range(200)]
    values = np.array([d["x"] for d in drawn]).reshape(3, 200)
    edges = [1.0, 2.0, 4.0, 8.0]
    for low, high, part in zip(edges, edges[1:], values):
        assert low <= part.min() < 1.05 * low
        assert 0.95 * high < part.max() <= high
    assert len({d["y"] for d in drawn}) == 600
    assert value_at((-0.04, -0.16), 0.5) == pytest.approx(-0.08)


def test_no_number_of_the_ground_is_fixed():
    for effect in (*EFFECTS, *measurement.EFFECTS, *arm.EFFECTS):
        ranges = getattr(effect, "ranges", {})
        for name, (low, high) in {**effect.strengths, **ranges}.items():
            assert name == "exchange" or max(abs(low), abs(high)) > 1.02 * min(abs(low), abs(high)), effect.identifier


@pytest.mark.parametrize("effect", [e for e in EFFECTS if e.is_sudden], ids=lambda e: e.identifier)
def test_drawn_instants_lie_within_the_recording(effect):
    rng = np.random.default_rng(1)
    setup = SETUPS["small"]
    made = drawn_effect(effect, setup, drawn_rig(setup.sheet, rng), "weak", rng)
    assert 0.2 * setup.stop < made.parameters["instant"] < 0.7 * setup.stop
