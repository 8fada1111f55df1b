"""An input that was another for a while, and a law that acts only where the rig is hot: two recordings, own equations.

In one training recording both take the same heat away at the same time. Only other recordings tell them apart: there
the fault leaves nothing, and the law as much wherever it is as hot again.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import Scenario
from cosim.unit.protocol import Array
from diagnosis.candidates.registry import candidate
from diagnosis.faults.model import with_faults
from diagnosis.judge.acceptance import accept
from diagnosis.judge.adequacy import adequacy
from diagnosis.judge.diagnosis import Domain, Finding, Searched, Standing, Verdict
from diagnosis.judge.findings import findings
from diagnosis.judge.of_a_day import is_shown_there_alone
from diagnosis.judge.unfitted import HeldOutReadings, left_out_readings, left_out_stretches
from diagnosis.judge.verdict import verdict
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.recording.recording import Recording
from diagnosis.search.search import Settings, search
from tests.faults.rig import NAMES, NOISE, blank, scenario

LAWS = [candidate(name) for name in ("second_mass", "sensor_bias")]
TRIED = Searched((Domain("thermal", 1, 0, 1), Domain("measurement", 1, 0, 1)))
#: Heat capacity [J/K] and losses [W/K] of the parameter set, room [K].
CAPACITY, LOSS, ROOM = 2.0, 0.012, 294.15
#: Power of the first heater: instants [s] and what holds from then on [W]. It is hot early, never, and late.
PROGRAMMES = {
    "first": ((30.0, 0.75), (250.0, 0.2)),
    "second": ((60.0, 0.3), (400.0, 0.15)),
    "judge": ((30.0, 0.2), (300.0, 0.75), (500.0, 0.1)),
}


def _power(title: str, time: Array) -> Array:
    found = np.zeros_like(time)
    for instant, watt in PROGRAMMES[title]:
        found = np.where(time >= instant, watt, found)
    return found


def _recorded(made: Scenario, title: str, above: float, fault: float, seed: int) -> Recording:
    """A recording of two bodies, C dT/dt = P - h A (T - T_room) - above * max(T - 315 K, 0), by Heun's method.

    Args:
        made: Its scenario.
        title: Which programme.
        above: More losses of the first body above 315 K [W/K].
        fault: Share by which its power is less than stated from 60 to 250 s of the first recording.
        seed: Of the noise.
    """
    empty = blank(made, title)
    points = [["0 s", "0 W"], *([f"{t:g} s", f"{p:g} W"] for t, p in PROGRAMMES[title])]
    empty = replace(empty, overrides={"components": {"drive": {"outputs": {"power_1": {"points": points}}}}})
    step = 0.1
    time = np.arange(0.0, 600.0 + step / 2, step)
    power = np.stack([_power(title, time), np.select([time >= 350.0, time >= 100.0], [0.1, 0.4], 0.0)], axis=1)
    if title == "first":
        power[(time >= 60.0) & (time < 250.0), 0] *= 1.0 - fault
    more = np.array([above, 0.0])

    def rate(warm: Array, given: Array) -> Array:
        return np.asarray((given - LOSS * (warm - ROOM) - more * np.maximum(warm - 315.0, 0.0)) / CAPACITY)

    course = [np.full(2, ROOM)]
    for given in power[:-1]:
        first = rate(course[-1], given)
        course.append(course[-1] + 0.5 * step * (first + rate(course[-1] + step * first, given)))
    random = np.random.default_rng(seed)
    read = {
        name: np.interp(c.times, time, np.array(course)[:, n]) + NOISE * random.standard_normal(len(c.times))
        for n, (name, c) in enumerate(empty.channels.items())
    }
    return replace(empty, channels={n: replace(c, values=read[n]) for n, c in empty.channels.items()})


def _diagnosed(folder: Path, above: float, fault: float) -> tuple[Verdict, tuple[Finding, ...]]:
    made = scenario(folder)
    *training, judge = (_recorded(made, t, above, fault, n) for n, t in enumerate(PROGRAMMES))
    network = CoilNetworkModel(made, training, LAWS)
    model = with_faults(network)
    outcome = search(model, model.terms(), Settings(nulls=1, most_terms=2), model.groups())
    known = {t: v for e in (*outcome.rivals, outcome.best) for t, v in e.fit.point.terms.items()}
    held_out = CoilNetworkModel(made, [judge], LAWS, timeline=network.timeline)
    unfitted, titles = HeldOutReadings(held_out, model, [judge]), [r.title for r in training]
    accepted = accept(
        model,
        outcome,
        unfitted,
        left_out_stretches(model, titles),
        lambda t: is_shown_there_alone(t, known[t], model, held_out),
        lambda: left_out_readings(model, titles),
    )
    told = findings(model, outcome, accepted, titles)
    return verdict(outcome, told, adequacy(accepted, unfitted.readings, ()), TRIED), told


def test_an_input_that_gave_less_in_an_interval_is_named(tmp_path: Path) -> None:
    word, told = _diagnosed(tmp_path, above=0.0, fault=0.15)
    (found,) = [f for f in told if f.is_accepted]
    assert found.effect == "input_gain_in_interval"
    assert found.standing is Standing.NAMED
    assert found.parameters[0].value == pytest.approx(-0.15, abs=0.03)
    assert word is Verdict.MEASUREMENT_FAULT


@pytest.mark.parametrize("above", [0.003, 0.012])
def test_a_law_of_the_hot_rig_is_no_fault_of_an_input(tmp_path: Path, above: float) -> None:
    word, told = _diagnosed(tmp_path, above=above, fault=0.0)
    blamed = [f for f in told if f.is_accepted and f.effect == "input_gain_in_interval"]
    assert not [f for f in blamed if f.standing is not Standing.UNNAMED]
    assert word is not Verdict.MEASUREMENT_FAULT
    assert word is not Verdict.MISSING_PHYSICS or NAMES[0].split(".")[0] in told[0].place
