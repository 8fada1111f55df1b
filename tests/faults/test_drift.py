"""A sensor whose zero moves in one recording."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.diagnose import Options, diagnose
from diagnosis.faults.intervals import Pieces, best_ramp
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.recording.recording import load_recording
from diagnosis.search.search import Settings
from tests.systems.rigs import held, tank, write_recording

STEP, COUNT = 0.5, 400
TIMES = STEP * np.arange(COUNT)


def test_the_best_ramp_is_the_best_of_all_least_squares_fits() -> None:
    random, count = np.random.default_rng(0), 30
    nuisance = np.stack([np.ones(count), np.cos(np.arange(count))], axis=1)
    values, noise = random.standard_normal(count), random.standard_normal((count, 3))
    values[8:24] += 9.0 * (np.arange(16) + 0.5) / 16
    edges = np.linspace(0.0, 1.0, count + 1)
    middle = 0.5 * (edges[1:] + edges[:-1])
    left = np.eye(count) - nuisance @ np.linalg.pinv(nuisance)
    slopes = -np.vstack([np.eye(count), np.diag(middle)])
    pieces = Pieces(
        slopes @ left @ slopes.T, slopes @ slopes.T, slopes @ left @ values, slopes @ left @ noise, np.ones(count, int)
    )
    found = best_ramp(pieces, edges, 8, (-100.0, 100.0))
    assert found is not None
    for column, gain in zip((values, *noise.T), (found.gain, *found.chance)):
        best, where = 0.0, (0, 0, 0.0)
        for a, b in itertools.combinations(range(count + 1), 2):
            if b - a >= 8:
                ramp = np.where((middle > edges[a]) & (middle < edges[b]), middle - edges[a], 0.0)
                both = np.column_stack([nuisance, ramp / (edges[b] - edges[a])])
                fits = [np.linalg.lstsq(m, column, rcond=None) for m in (nuisance, both)]
                if fits[0][1][0] - fits[1][1][0] > best:
                    best, where = fits[0][1][0] - fits[1][1][0], (a, b, fits[1][0][-1])
        assert gain == pytest.approx(best, rel=1e-6)
        if column is values:
            assert (found.first, found.last, found.amount) == pytest.approx(where)
    assert found.amount == pytest.approx(9.0, abs=2.0)


def _diagnosed(folder: Path, error: Callable[[int, Array], Array], outflow: float = 0.0) -> Diagnosis:
    """Three runs of a tank whose valve goes to another place every 8 s; its numbers are 2 % off, noise 1 mm.

    Args:
        folder: Where the files go.
        error: Of the level's sensor: number of the recording and readings to what is added [m].
        outflow: Share of the outflow that goes over a root of the level [m^2.5/s].
    """
    tank(folder, "200 s", "500 ms")
    every = []
    for number in range(3):
        rng = np.random.default_rng(30 + number)
        inflow = np.repeat(rng.uniform(0.005, 0.03, COUNT // 16), 16)
        level = held(
            lambda h, q: (q - 0.0203 * h - outflow * np.sqrt(np.maximum(h, 0.0))) / 0.495, np.array([0.4]), inflow, STEP
        )[:, 0]
        readings = level + error(number, level) + 1e-3 * rng.standard_normal(COUNT)
        inputs, channels = {"pump.inflow": ("q", "m^3/s")}, {"tank.level": ("h", "m", "1 mm")}
        columns = {"t": TIMES, "q": inflow, "h": readings}
        every.append(load_recording(write_recording(folder / f"run_{number}", columns, inputs, channels)))
    scenario = load_scenario(str(folder / "scenario.yaml"))
    return diagnose(scenario, every[:2], every[2:], Settings(), options=Options(is_brief=True)).diagnosis


@pytest.mark.parametrize("begin", [0.0, 90.0])
def test_a_sensor_that_drifts_in_one_recording_is_found(tmp_path: Path, begin: float) -> None:
    def error(number: int, level: Array) -> Array:
        return 0.02 * np.clip((TIMES - begin) / (200.0 - begin), 0.0, 1.0) * (number == 1)

    found = _diagnosed(tmp_path, error)
    assert found.verdict is Verdict.MEASUREMENT_FAULT
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert (finding.effect, finding.place) == ("sensor_drift_in_interval", "tank.level (run_1)")
    offset, start, end = finding.parameters
    assert offset.value == pytest.approx(0.02, abs=0.002)
    assert offset.lower < 0.02 < offset.upper
    assert start.value == pytest.approx(begin, abs=12.0)
    assert end.value == pytest.approx(200.0, abs=1.0)
    name = "sensor that drifted for a while" if start.lower > TIMES[0] else "sensor that drifted"
    assert finding.statement == f"{name}, tank.level (run_1)"
    assert start.lower > TIMES[0] or begin == 0.0


def test_a_sensor_that_drifts_in_all_recordings_is_none_of_one(tmp_path: Path) -> None:
    found = _diagnosed(tmp_path, lambda number, level: 1e-4 * TIMES)
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert finding.effect == "sensor_drift"


def test_a_sensor_that_is_right_does_not_drift(tmp_path: Path) -> None:
    found = _diagnosed(tmp_path, lambda number, level: np.zeros(COUNT))
    assert not [f for f in found.findings if f.is_accepted]
