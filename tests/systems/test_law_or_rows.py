"""Changes of a recorded input stand in the row after them: what that explains is no law of the rig."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.acceptance import _Judge, _of_rows
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.judge.unfitted import left_out_readings
from diagnosis.judge.verdict import _ROWS, _unaccepted
from diagnosis.models.cosimulation.model import ClosedLoopModel
from diagnosis.recording.recording import Recording, load_recording
from diagnosis.report.undecided import what_decides
from diagnosis.search.fit import fit
from diagnosis.search.problem import Point
from diagnosis.search.search import Explanation, Settings
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import held, write_recording

#: A pump that answers with a lag, and a level that follows it.
LAG, SETTLING, NOISE = 0.3, 1.5, 0.012
PUMP = OdeModel(
    "pump",
    {"lag": (LAG, "s"), "settling": (SETTLING, "s")},
    {"given": "m^3/s"},
    {"q": ("m^3/s", "0", "(given - q)/lag"), "h": ("m^3/s", "0", "(q - h)/settling")},
    {"flow": ("m^3/s", "h")},
)
SCENARIO = """\
title: A pump
time: {stop: 180 s, macro_step: 20 ms, output_step: 0.1 s}
components:
  desk: {kind: programme, outputs: {flow: {unit: m^3/s, constant: 0 m^3/s}}}
  pump: {kind: fmu, fmu: pump.fmu, integrator: cvode, parameter_set: numbers.yaml}
connections: [desk.flow -> pump.given]
"""
#: Readings and rows of the input are so many seconds apart; the truth has finer steps.
ROW, FINE, COUNT = 0.1, 0.02, 1800


def recorded(folder: Path, late: int, drag: float) -> list[Recording]:
    """Three recordings whose input changed `late` fine steps before the row that says so, with drag in the pump."""
    PUMP.build(folder)
    own = {
        name: {"value": value, "unit": "s", "source": "test", "uncertainty": 0.05}
        for name, value in (("lag", LAG), ("settling", SETTLING))
    }
    (folder / "numbers.yaml").write_text(yaml.safe_dump({"title": "pump", "parameters": own}), encoding="utf-8")
    (folder / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")

    def rate(x: Array, given: float) -> Array:
        return np.array([(given - x[0]) / LAG - drag * x[0] * abs(x[0]), (x[0] - x[1]) / SETTLING])

    found, per = [], round(ROW / FINE)
    for number in range(3):
        rng = np.random.default_rng([7, number])
        rows = np.repeat(rng.uniform(0.2, 1.0, COUNT // 20), 20)  # 89 changes: more than have instants of their own
        fine = np.roll(np.repeat(rows, per), -late)
        x = held(rate, np.zeros(2), fine, FINE)[::per, 1]
        columns = {"t": ROW * np.arange(COUNT), "q": rows, "h": x + NOISE * rng.standard_normal(COUNT)}
        channels = {"pump.flow": ("h", "m^3/s", f"{NOISE:g} m^3/s")}
        inputs = {"desk.flow": ("q", "m^3/s")}
        found.append(load_recording(write_recording(folder / f"run_{number}", columns, inputs, channels)))
    return found


def answer(folder: Path, recordings: list[Recording]) -> Diagnosis:
    scenario, options = load_scenario(folder / "scenario.yaml"), Options(is_brief=True)
    return diagnose(scenario, recordings[:2], recordings[2:], Settings(), options=options).diagnosis


@pytest.fixture(scope="module")
def early(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[Recording]]:
    """Changes came 0.08 s before their rows; nothing else is missing."""
    folder = tmp_path_factory.mktemp("early")
    return folder, recorded(folder, 4, 0.0)


def test_the_shift_of_half_a_row_is_that_of_an_input_that_came_so_much_earlier(
    early: tuple[Path, list[Recording]],
) -> None:
    """0.08 s are 1.6 halves of a row, so that 1.6 times the shift leaves what the true numbers leave: noise."""
    folder, recordings = early
    model = ClosedLoopModel(load_scenario(folder / "scenario.yaml"), recordings)
    zero = Point(np.zeros(len(model.parameters)))
    shifts = model.row_shifts(zero)
    assert shifts.shape == (3, 3 * COUNT)
    assert [np.flatnonzero(s).min() // COUNT for s in shifts] == [0, 1, 2]  # each in its own recording
    assert [np.flatnonzero(s).max() // COUNT for s in shifts] == [0, 1, 2]
    left = model.residuals([zero])[0]
    assert np.mean(left**2) > 1.15
    assert np.mean((left + 1.6 * shifts.sum(axis=0)) ** 2) == pytest.approx(1.0, abs=0.07)


def test_a_law_that_gains_as_earlier_changes_do_is_refused(early: tuple[Path, list[Recording]]) -> None:
    folder, recordings = early
    model = ClosedLoopModel(load_scenario(folder / "scenario.yaml"), recordings)
    without = fit(model, Point(np.zeros(len(model.parameters))))
    best = None
    for law in (t for t in model.terms() if t.place == "pump.q" and len(t.parameters) == 1):
        found = fit(model, without.point.plus(law, (law.parameters[0].starts[0],)))
        if best is None or found.cost < best[1].cost:
            best = law, found
    assert best is not None
    judge = _Judge(model, left_out_readings(model, ["1", "2", "3"]), None)
    why = _of_rows(judge, best[0], Explanation(best[1]), without, 20.0)
    assert "changes of recorded inputs stand in the row after them" in why[0]
    assert judge.rows == {best[0]}


def test_nothing_is_missing_where_changes_came_before_their_rows(early: tuple[Path, list[Recording]]) -> None:
    folder, recordings = early
    found = answer(folder, recordings)
    assert not found.accepted, [f.effect for f in found.accepted]
    assert [f.is_within_rows for f in found.suggestions] == [True]
    assert _unaccepted(found.suggestions) == _ROWS
    assert found.verdict is Verdict.CANNOT_TELL  # the training readings reject a model without instants of changes
    assert _ROWS in found.statement
    assert what_decides(found).startswith("Record the inputs with shorter rows")


def test_a_drag_is_found_beside_an_input_in_rows(tmp_path: Path) -> None:
    found = answer(tmp_path, recorded(tmp_path, 3, 1.0))
    assert any(f.place == "pump.q" for f in found.accepted), [f.statement for f in found.findings]
