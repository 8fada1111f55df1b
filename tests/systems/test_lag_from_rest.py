"""A heater that is switched on where the recording begins, and follows its power late: it was cold, or on before."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.laws.library import library
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.places import fits, places_of
from diagnosis.recording.recording import load_recording
from diagnosis.search.search import Settings
from tests.systems.rigs import LUMP, LUMP_SCENARIO, LUMP_STEP, ROOM, held, write_recording

#: Time constant of the heater [s].
LATE, COUNT = 25.0, 500
LAW = "input_lag_from_rest"


def answer(folder: Path, is_cold: bool) -> Diagnosis:
    """The diagnosis of three recordings that begin with the power on, of which the last judges."""
    LUMP.build(folder)
    (folder / "scenario.yaml").write_text(LUMP_SCENARIO, encoding="utf-8")
    recordings = []
    for number, first in enumerate((20.0, 14.0, 17.0)):
        rng = np.random.default_rng([5, number])
        power = np.repeat(np.concatenate([[first], rng.uniform(2.0, 25.0, COUNT // 50 - 1)]), 50)

        def rate(x: Array, watt: float) -> Array:
            return np.array([(x[1] - 0.41 * (x[0] - ROOM)) / 49.0, (watt - x[1]) / LATE])

        start = np.array([300.0, 0.0 if is_cold else first])
        values = held(rate, start, power, LUMP_STEP)[:, 0] + 0.1 * rng.standard_normal(COUNT)
        columns = {"t": LUMP_STEP * np.arange(COUNT), "P": power, "T": values}
        channels = {"lump.temperature": ("T", "K", "0.1 K")}
        recordings.append(
            load_recording(write_recording(folder / f"run_{number}", columns, {"drive.power": ("P", "W")}, channels))
        )
    scenario = load_scenario(folder / "scenario.yaml")
    made = diagnose(scenario, recordings[:2], recordings[2:], Settings(), options=Options(is_brief=True))
    return made.diagnosis


@pytest.mark.parametrize(("is_cold", "law"), [(True, LAW), (False, "input_lag")])
def test_a_heater_that_follows_late_is_named_with_how_it_began(tmp_path: Path, is_cold: bool, law: str) -> None:
    found = answer(tmp_path, is_cold)
    assert found.verdict is Verdict.MISSING_PHYSICS
    (one,) = found.accepted
    assert one.effect == law
    assert one.place == "lump.power"
    assert one.parameters[0].value == pytest.approx(LATE, rel=0.1)
    assert law not in one.ambiguous_with


@pytest.mark.parametrize("first", ["0 W", "20 W"])
def test_it_has_a_place_where_an_input_is_on_and_no_temperature(tmp_path: Path, first: str) -> None:
    """From an input that begins at 0 both lags are one; a room that is said to be 0 K before is none."""
    LUMP.build(tmp_path)
    text = LUMP_SCENARIO.replace("constant: 0 W", f"points: [[0 s, {first}], [200 s, 30 W], [400 s, 0 W]]")
    (tmp_path / "scenario.yaml").write_text(text, encoding="utf-8")
    placed = fits(places_of([FastSystem(load_scenario(tmp_path / "scenario.yaml"))]), library(), LUMP_STEP)
    found = {fit.placed.to for fit in placed if fit.law.identifier == LAW}
    assert found == ({"power"} if first == "20 W" else set())
