"""Changes of a recorded voltage or power stand in the row after them: what that explains is no law of coils."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import Scenario
from diagnosis.candidates.registry import catalogue
from diagnosis.judge.acceptance import _Judge, _of_rows
from diagnosis.judge.unfitted import left_out_readings
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.recording.recording import Input, Recording
from diagnosis.search.fit import fit
from diagnosis.search.problem import Point
from diagnosis.search.search import Explanation
from tests.faults.rig import PERIOD, STOP, blank, scenario

#: Seconds from row to row of the powers, and by how many a change came before its row.
ROW, EARLY, NOISE = 6.0, 4.0, 0.02
LAWS = ("second_mass", "sensor_lag", "sensor_clock_offset", "radiation", "uneven_cooling", "draught")


def powers(number: int) -> np.ndarray:
    """Powers in each row [W], shape (2, rows): 40 changes of each heater, more than have instants of their own."""
    random = np.random.default_rng([3, number])
    rows = int(STOP / ROW) + 1
    return np.array([np.repeat(random.uniform(0.1, 1.2, rows), 3)[:rows] for _ in range(2)])


def with_inputs(recording: Recording, number: int, early: float) -> Recording:
    """With the powers as they were applied, or, `early` being 0, as their rows say."""
    given = powers(number)
    times = ROW * np.arange(given.shape[1])
    times[1:] -= early
    return replace(recording, inputs=tuple(Input("drive", f"power_{n + 1}", "W", times, given[n]) for n in range(2)))


def recorded(made: Scenario, early: float, term: str = "", values: tuple[float, ...] = ()) -> list[Recording]:
    """Two recordings by a finer simulation with the inputs as they were applied, with the rows that say so later."""
    laws = [c for c in catalogue() if c.identifier in LAWS]
    found = []
    for number in range(2):
        empty = replace(blank(made, f"run {number}"), order=number + 1)
        empty = replace(empty, channels={n: replace(c, deviation=NOISE) for n, c in empty.channels.items()})
        model = CoilNetworkModel(made, [with_inputs(empty, number, early)], laws)
        terms = {next(t for t in model.terms() if str(t) == term): values} if term else {}
        values_of = model.predict(Point(np.zeros(len(model.parameters)), terms), 0)
        random = np.random.default_rng([9, number])
        channels = {
            name: replace(c, values=v + NOISE * random.standard_normal(len(v)))
            for (name, c), v in zip(empty.channels.items(), values_of)
        }
        found.append(with_inputs(replace(empty, channels=channels), number, 0.0))
    return found


@pytest.fixture
def made(tmp_path: Path) -> Scenario:
    return scenario(tmp_path)


def model_of(made: Scenario, recordings: list[Recording]) -> CoilNetworkModel:
    return CoilNetworkModel(made, recordings, [c for c in catalogue() if c.identifier in LAWS])


def test_the_shift_of_half_a_row_is_that_of_a_power_that_came_so_much_earlier(made: Scenario) -> None:
    """4 s are 4/3 of half a row: so many times the shift leaves what the true inputs leave, which is noise."""
    model = model_of(made, recorded(made, EARLY))
    zero = Point(np.zeros(len(model.parameters)))
    shifts = model.row_shifts(zero)
    count = len(np.arange(PERIOD, STOP + 1e-9, PERIOD))
    assert shifts.shape == (4, 4 * count)  # two powers of two recordings
    assert [int(np.flatnonzero(s).min() // (2 * count)) for s in shifts] == [0, 1, 0, 1]
    assert [int(np.flatnonzero(s).max() // (2 * count)) for s in shifts] == [0, 1, 0, 1]
    left = model.residuals([zero])[0]
    assert np.mean(left**2) > 5.0
    assert np.mean((left + EARLY / (0.5 * ROW) * shifts.sum(axis=0)) ** 2) == pytest.approx(1.0, abs=0.15)


def best_law(model: CoilNetworkModel) -> tuple[_Judge, tuple]:
    without = fit(model, Point(np.zeros(len(model.parameters))))
    found = [
        (law, fit(model, without.point.plus(law, tuple(p.starts[0] for p in law.parameters)))) for law in model.terms()
    ]
    law, best = min(found, key=lambda pair: pair[1].cost)
    judge = _Judge(model, left_out_readings(model, ["1", "2"]), None)
    return judge, (law, Explanation(best), without, 20.0)


def test_a_law_that_gains_as_earlier_changes_do_is_refused(made: Scenario) -> None:
    judge, given = best_law(model_of(made, recorded(made, EARLY)))
    (why,) = _of_rows(judge, *given)
    assert "changes of recorded inputs stand in the row after them" in why
    assert judge.rows == {given[0]}


def test_a_second_mass_is_none_of_rows(made: Scenario) -> None:
    judge, given = best_law(model_of(made, recorded(made, EARLY, "second_mass at all coils", (0.01, 2.0))))
    assert given[0].identifier == "second_mass"
    assert _of_rows(judge, *given) == []


def test_programmes_that_nobody_recorded_have_no_rows(made: Scenario) -> None:
    recordings = [replace(r, inputs=()) for r in recorded(made, 0.0)]
    model = model_of(made, recordings)
    assert model.row_shifts(Point(np.zeros(len(model.parameters)))).shape == (0, len(model.layout.time))
