"""A fault of an input that ends beyond a stretch in which the input is nearly zero, and tells nothing of it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from cosim.scenario import load_scenario
from diagnosis.candidates.registry import catalogue
from diagnosis.faults.model import with_faults
from diagnosis.judge.estimates import estimated, estimates
from diagnosis.judge.events import ends_by_likelihood
from diagnosis.models.build import model_of
from diagnosis.recording.recording import load_recording
from diagnosis.search.fit import fit
from diagnosis.search.problem import Point
from tests.systems.rigs import held, tank, write_recording

STEP, COUNT = 0.5, 400
#: Samples between which the pump of the second recording gives 15 % more, and those between which it hardly runs.
WRONG, IDLE = (100, 241), (150, 237)


def _recording(folder: Path, number: int, wrong: tuple[int, int] | None) -> Path:
    rng = np.random.default_rng(10 + number)
    stated = np.repeat(rng.uniform(0.01, 0.03, COUNT // 10), 10)
    if wrong:
        stated[slice(*IDLE)] = 1e-5
    given = stated.copy()
    if wrong:
        given[slice(*wrong)] *= 1.15
    level = held(lambda h, q: (q - 0.0203 * h) / 0.495, np.array([0.4]), given, STEP)[:, 0]
    columns = {"t": STEP * np.arange(COUNT), "q": stated, "h": level + 1e-3 * rng.standard_normal(COUNT)}
    return write_recording(
        folder / f"run_{number}", columns, {"pump.inflow": ("q", "m^3/s")}, {"tank.level": ("h", "m", "1 mm")}
    )


def test_ends_are_tried_where_the_input_runs_again(tmp_path: Path) -> None:
    tank(tmp_path, "200 s", "500 ms")
    recordings = [load_recording(_recording(tmp_path, n, WRONG if n == 1 else None)) for n in range(2)]
    model = with_faults(model_of(load_scenario(str(tmp_path / "scenario.yaml")), recordings, catalogue()))
    (term,) = [t for t in model.faults() if str(t) == "input_gain_in_interval at pump.inflow (run_1)"]
    begin, idle = STEP * WRONG[0], STEP * (IDLE[0] + 10)
    point = Point(np.zeros(len(model.parameters)), {term: (0.15, begin, idle)})
    near = [p.terms[term] for p in model.near_intervals(point)]
    assert len(set(near)) == len(near)
    assert all(b < e for _, b, e in near)
    assert any(b == pytest.approx(begin, abs=STEP) and e > STEP * IDLE[1] for _, b, e in near)
    costs = fit(model, point, 0).cost, min(fit(model, Point(point.base, {term: n}), 0).cost for n in near)
    assert costs[1] < costs[0] - 100.0


def test_an_interval_that_ends_between_two_strokes_is_tried_up_to_the_end_of_the_recording(tmp_path: Path) -> None:
    """A pump that delivers 1.15 times what is stated: samples near an end between two strokes say nothing."""
    rng = np.random.default_rng(6)
    stated = np.zeros(COUNT)
    for begin, end in ((20, 80), (300, 360)):
        stated[begin:end] = 0.02
    level = held(lambda h, q: (q - 0.0203 * h) / 0.495, np.array([0.4]), 1.15 * stated, STEP)[:, 0]
    columns = {"t": STEP * np.arange(COUNT), "q": stated, "h": level + 1e-3 * rng.standard_normal(COUNT)}
    path = write_recording(
        tmp_path / "run", columns, {"pump.inflow": ("q", "m^3/s")}, {"tank.level": ("h", "m", "1 mm")}
    )
    tank(tmp_path, "200 s", "500 ms")
    model = with_faults(model_of(load_scenario(str(tmp_path / "scenario.yaml")), [load_recording(path)], catalogue()))
    (term,) = [t for t in model.faults() if t.identifier == "input_gain_in_interval"]
    point = Point(np.zeros(len(model.parameters)), {term: (0.15, 5.0, 80.0)})
    near = [p.terms[term] for p in model.near_intervals(point)]
    assert len(set(near)) == len(near)
    costs = {(begin, end): fit(model, Point(point.base, {term: (g, begin, end)}), 0).cost for g, begin, end in near}
    _, best_end = min(costs, key=lambda k: costs[k])
    assert best_end == max(end for _, end in costs) > STEP * 360
    nearby = [c for (_, end), c in costs.items() if end < STEP * 300]
    assert min(nearby) > min(costs.values()) + 100.0


def test_a_sensor_that_repeats_a_value_is_tried_as_one_that_stands_still(tmp_path: Path) -> None:
    """A gain over two such stretches was found first, and stayed."""
    path = _recording(tmp_path, 0, None)
    table = pd.read_csv(path / "data.csv")
    table.loc[100:180, "h"] = table.loc[100, "h"]
    table.to_csv(path / "data.csv", index=False)
    tank(tmp_path, "200 s", "500 ms")
    model = with_faults(model_of(load_scenario(str(tmp_path / "scenario.yaml")), [load_recording(path)], catalogue()))
    (gain,) = [t for t in model.faults() if t.identifier == "sensor_gain_in_interval" and "again" not in t.place]
    (still,) = [t for t in model.faults() if t.identifier == "sensor_stuck_in_interval" and "again" not in t.place]
    point = Point(np.zeros(len(model.parameters)), {gain: (-0.2, STEP * 105, STEP * 200)})
    (other,) = [p for p in model.near_intervals(point) if still in p.terms]
    assert gain not in other.terms
    assert other.terms[still] == (1.0, pytest.approx(STEP * 99.5), pytest.approx(STEP * 180.5))
    assert not any(still in p.terms for p in model.near_intervals(point.plus(gain, (-0.2, STEP * 10, STEP * 90))))
    assert not any(gain in p.terms for p in model.near_intervals(other))


def test_a_sensor_that_stands_still_may_begin_to_while_it_would_have_read_the_same(tmp_path: Path) -> None:
    """A level that rests until the pump runs: the curvature says nothing of the begin, and the end is known."""
    stated = np.zeros(COUNT)
    stated[150:] = 0.02
    level = held(lambda h, q: (q - 0.0002 * h) / 0.495, np.array([0.0]), stated, STEP)[:, 0]
    level[150:220] = level[100]
    columns = {"t": STEP * np.arange(COUNT), "q": stated, "h": level}
    path = write_recording(
        tmp_path / "run", columns, {"pump.inflow": ("q", "m^3/s")}, {"tank.level": ("h", "m", "1 mm")}
    )
    tank(tmp_path, "200 s", "500 ms")
    model = with_faults(model_of(load_scenario(str(tmp_path / "scenario.yaml")), [load_recording(path)], catalogue()))
    (still,) = [t for t in model.faults() if t.identifier == "sensor_stuck_in_interval" and "again" not in t.place]
    point = Point(np.zeros(len(model.parameters)), {still: (1.0, STEP * 99.5, STEP * 219.5)})
    found = fit(model, point, 60)
    wide = [replace(e, lower=p.lower, upper=p.upper) for e, p in zip(estimates(found, still), still.parameters)]
    begin, end = ends_by_likelihood(wide, still, found, model)[1:]
    assert begin.upper < STEP * 170  # in truth at 150
    assert STEP * 215 < end.lower < end.upper < STEP * 224
    told = [replace(e, lower=e.value - 0.1, upper=e.value + 0.1) for e in wide]
    assert list(ends_by_likelihood(told, still, found, model)) == told  # the curvature says something of a sensor


def test_ends_that_change_nothing_are_as_good_and_the_interval_holds_them(tmp_path: Path) -> None:
    """A pump that misses its second stroke was off before it or since the first one ended: no reading says."""
    stated = np.zeros(COUNT)
    strokes = ((20, 80), (160, 220), (300, 360))
    for begin, end in strokes:
        stated[begin:end] = 0.02
    given = stated.copy()
    given[slice(*strokes[1])] = 0.0
    tank(tmp_path, "200 s", "500 ms")
    rng = np.random.default_rng(5)
    level = held(lambda h, q: (q - 0.0203 * h) / 0.495, np.array([0.4]), given, STEP)[:, 0]
    columns = {"t": STEP * np.arange(COUNT), "q": stated, "h": level + 1e-3 * rng.standard_normal(COUNT)}
    path = write_recording(
        tmp_path / "run", columns, {"pump.inflow": ("q", "m^3/s")}, {"tank.level": ("h", "m", "1 mm")}
    )
    model = with_faults(model_of(load_scenario(str(tmp_path / "scenario.yaml")), [load_recording(path)], catalogue()))
    (term,) = [t for t in model.faults() if t.identifier == "input_gain_in_interval"]
    found = fit(model, Point(np.zeros(len(model.parameters)), {term: (-1.0, 65.0, 120.0)}), 10)
    gain, begin, end = estimated(model, found, term, 1.0)
    assert gain.value == pytest.approx(-1.0, abs=0.02)
    # wider by at most the distance of two instants that are tried, 0.15 of the way
    for found_end, lower, upper in ((begin, strokes[0][1], strokes[1][0]), (end, strokes[1][1], strokes[2][0])):
        way = 0.15 * STEP * (upper - lower) + 3.0 * STEP
        assert STEP * lower - way < found_end.lower < STEP * lower + 3.0 * STEP
        assert STEP * upper - 3.0 * STEP < found_end.upper < STEP * upper + way


def test_an_input_that_stayed_did_so_from_an_instant_at_which_it_was_not_to_move(tmp_path: Path) -> None:
    """Between two steps of what is stated no reading says when it got stuck; before the first one it had moved."""
    stated = np.repeat(np.random.default_rng(3).uniform(0.01, 0.03, COUNT // 40), 40)
    given = stated.copy()
    stuck, free = 160, 230
    given[stuck:free] = stated[stuck - 1]
    tank(tmp_path, "200 s", "500 ms")
    level = held(lambda h, q: (q - 0.0203 * h) / 0.495, np.array([0.4]), given, STEP)[:, 0]
    noise = 1e-3 * np.random.default_rng(4).standard_normal(COUNT)
    columns = {"t": STEP * np.arange(COUNT), "q": stated, "h": level + noise}
    path = write_recording(
        tmp_path / "run", columns, {"pump.inflow": ("q", "m^3/s")}, {"tank.level": ("h", "m", "1 mm")}
    )
    model = with_faults(model_of(load_scenario(str(tmp_path / "scenario.yaml")), [load_recording(path)], catalogue()))
    (term,) = [t for t in model.faults() if t.identifier == "input_held_in_interval"]
    found = fit(model, Point(np.zeros(len(model.parameters)), {term: (1.0, 70.0, 115.0)}), 10)
    _, begin, end = estimated(model, found, term, 1.0)
    way = 0.15 * STEP * 40 + 3.0 * STEP
    assert STEP * (stuck - 40) - way < begin.lower < STEP * (stuck - 40) + 3.0 * STEP
    assert STEP * stuck - 3.0 * STEP < begin.upper < STEP * stuck + way
    assert end.lower < STEP * free < end.upper
    assert end.upper - end.lower < 3.0 * STEP
    # A derivative that is nearly zero says as little as one that is: an interval as wide as the bounds is none.
    wide = [replace(e, lower=p.lower, upper=p.upper) for e, p in zip(estimates(found, term), term.parameters)]
    assert wide[1].upper - wide[1].lower > 190.0
    told = ends_by_likelihood(wide, term, found, model)[1]
    assert (told.lower, told.upper) == (begin.lower, begin.upper)
