"""A heater that is switched on where the recording begins, and follows its power late: it was cold, or on before."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cosim.run import run
from cosim.scenario import load_scenario, parse_scenario
from cosim.unit.protocol import Array
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.judge.estimates import estimates
from diagnosis.laws.library import library
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.places import fits, places_of
from diagnosis.recording.recording import load_recording
from diagnosis.search.fit import fit
from diagnosis.search.problem import Point
from diagnosis.search.search import Settings
from tests.search.line_model import TIME, WAVE
from tests.systems.rigs import LUMP, LUMP_SCENARIO, LUMP_STEP, ROOM, held, write_recording
from tests.verdict.lines import Lines

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


@pytest.mark.parametrize(("integrator", "best"), [("cvode", LATE), ("internal", LATE - 0.5 * LUMP_STEP)])
def test_a_lag_before_a_co_simulation_fmu_is_short_by_half_a_macro_step(
    tmp_path: Path, integrator: str, best: float
) -> None:
    """What it passes is held over a macro-step of 2 s, and late by half of it in the mean; a state is not held."""
    LUMP.build(tmp_path)
    seconds = LUMP_STEP * np.arange(COUNT)
    changes = np.arange(0.0, COUNT * LUMP_STEP, 100.0)
    watt = np.random.default_rng(3).uniform(2.0, 25.0, len(changes))

    def rate(x: Array, given: float) -> Array:
        return np.array([(x[1] - 0.4 * (x[0] - ROOM)) / 50.0, (given - x[1]) / LATE])

    power = watt[(seconds // 100.0).astype(int)]
    truth = held(rate, np.array([300.0, 0.0]), power, LUMP_STEP)[:, 0]
    points = str([[f"{t} s", f"{w} W"] for t, w in zip(changes, watt)]).replace("'", "")
    term = "{to: power, formula: passed - power, parameters: {lag: LAG s}, states: {passed: "
    term += "{rate: (power - passed) / lag, start: 0 * power, unit: W}}}"
    text = LUMP_SCENARIO.replace("constant: 0 W", f"points: {points}").replace(
        "integrator: cvode", f"integrator: {integrator}, added_terms: [{term}]"
    )
    squares = []
    for lag in best + np.array([-1.0, 0.0, 1.0]):
        results = run(parse_scenario(text.replace("LAG", str(lag)), tmp_path / "scenario.yaml"))
        squares.append(float(np.mean((results["lump.temperature"].values[:COUNT] - truth) ** 2)))
    least = 0.5 * (squares[0] - squares[2]) / (squares[0] - 2.0 * squares[1] + squares[2])
    assert abs(least) < 0.1  # the vertex of the parabola through the three [s]


def test_the_interval_of_a_lag_before_a_co_simulation_fmu_counts_half_a_macro_step(tmp_path: Path) -> None:
    """As what is spread evenly over a macro-step: of a dead time, which is in closed form, of a state, nothing."""
    LUMP.build(tmp_path)
    seen = {}
    for integrator in ("cvode", "internal"):
        (tmp_path / "scenario.yaml").write_text(LUMP_SCENARIO.replace("cvode", integrator), encoding="utf-8")
        system = FastSystem(load_scenario(tmp_path / "scenario.yaml"))
        for place in fits(places_of([system]), library(), LUMP_STEP, 2.0):
            if place.law.identifier in ("input_lag", "input_dead_time") and place.placed.to == "power":
                seen[integrator, place.law.identifier] = place.term.parameters[0].resolution
    assert seen["internal", "input_lag"] == pytest.approx(2.0 / np.sqrt(12.0))
    assert seen["internal", "input_dead_time"] == seen["cvode", "input_lag"] == 0.0


def test_an_interval_holds_what_the_coupling_leaves_open() -> None:
    line = Lines(0.3 + np.sin(25.0 * TIME), 3)
    term = next(t for t in line.terms() if t.identifier == WAVE.identifier)
    coarse = replace(term, parameters=(replace(term.parameters[0], resolution=0.2), *term.parameters[1:]))
    found = fit(line, Point(np.zeros(len(line.parameters)), {term: (1.0,)}))
    sharp = estimates(found, term)[0]
    wide = estimates(replace(found, point=Point(found.point.base, {coarse: found.point.terms[term]})), coarse)[0]
    half = float(np.hypot(sharp.upper - sharp.value, 1.96 * 0.2))
    assert wide.upper - wide.value == pytest.approx(half, rel=1e-3)


@pytest.mark.parametrize("first", ["0 W", "20 W"])
def test_it_has_a_place_where_an_input_is_on_and_no_temperature(tmp_path: Path, first: str) -> None:
    """From an input that begins at 0 both lags are one; a room that is said to be 0 K before is none."""
    LUMP.build(tmp_path)
    text = LUMP_SCENARIO.replace("constant: 0 W", f"points: [[0 s, {first}], [200 s, 30 W], [400 s, 0 W]]")
    (tmp_path / "scenario.yaml").write_text(text, encoding="utf-8")
    placed = fits(places_of([FastSystem(load_scenario(tmp_path / "scenario.yaml"))]), library(), LUMP_STEP)
    found = {fit.placed.to for fit in placed if fit.law.identifier == LAW}
    assert found == ({"power"} if first == "20 W" else set())
