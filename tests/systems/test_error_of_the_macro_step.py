"""What two FMUs exchange is late by a macro-step: laws that move readings no farther than that are not accepted."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from cosim.scenario import load_scenario
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.acceptance import _Judge, _of_solving
from diagnosis.judge.diagnosis import Verdict
from diagnosis.judge.unfitted import left_out_readings
from diagnosis.models.cosimulation.model import ClosedLoopModel
from diagnosis.recording.recording import Recording, load_recording
from diagnosis.report.undecided import what_decides
from diagnosis.search.fit import fit
from diagnosis.search.problem import Point
from diagnosis.search.search import Explanation, Settings
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import held, write_recording

#: A seat on a spring, with a damper that is a component of its own and answers with a lag.
MASS, SPRING, DAMPING, LAG = 20.0, 8000.0, 250.0, 4e-3
STEP, COUNT, NOISE = 0.01, 800, 5e-5
SEAT = OdeModel(
    "seat",
    {"m": (MASS, "kg"), "k": (SPRING, "N/m")},
    {"push": "N", "braking": "N"},
    {"x": ("m", "0", "v"), "v": ("m/s", "0", "(push - braking - k*x)/m")},
    {"rise": ("m", "x"), "speed": ("m/s", "v")},
)
DAMPER = OdeModel(
    "damper",
    {"c": (DAMPING, "N*s/m"), "lag": (LAG, "s")},
    {"speed": "m/s"},
    {"f": ("N", "0", "(c*speed - f)/lag")},
    {"force": ("N", "f")},
)
SCENARIO = """\
title: A seat on a damper
time: {stop: 8 s, macro_step: MACRO, output_step: 10 ms}
components:
  shaker: {kind: programme, outputs: {push: {unit: N, constant: 0 N}}}
  seat: {kind: fmu, fmu: seat.fmu, integrator: cvode}
  damper: {kind: fmu, fmu: damper.fmu, integrator: cvode}
connections: [shaker.push -> seat.push, seat.speed -> damper.speed, damper.force -> seat.braking]
"""


def recorded(folder: Path, hardening: float) -> list[Recording]:
    """Both parts integrated together, with a spring that hardens by so much [1/m^2/s^2]."""
    SEAT.build(folder)
    DAMPER.build(folder)

    def rate(x: np.ndarray, push: float) -> np.ndarray:
        pull = SPRING / MASS * x[0] + hardening * x[0] ** 3
        return np.array([x[1], (push - x[2]) / MASS - pull, (DAMPING * x[1] - x[2]) / LAG])

    found = []
    for number in range(3):
        rng = np.random.default_rng([3, number])
        push = np.repeat(rng.uniform(-120.0, 120.0, COUNT // 20), 20)
        x = held(rate, np.zeros(3), push, STEP)[:, 0]
        columns = {"t": STEP * np.arange(COUNT), "F": push, "x": x + NOISE * rng.standard_normal(COUNT)}
        channels = {"seat.rise": ("x", "m", f"{1e6 * NOISE:g} um")}
        found.append(
            load_recording(write_recording(folder / f"run_{number}", columns, {"shaker.push": ("F", "N")}, channels))
        )
    return found


def scenario(folder: Path, macro: str, uncertainty: float = 0.05) -> Path:
    sets = {
        "seat": {"m": (MASS, "kg"), "k": (SPRING, "N/m")},
        "damper": {"c": (DAMPING, "N*s/m"), "lag": (LAG, "s")},
    }
    text = SCENARIO.replace("MACRO", macro)
    for name, numbers in sets.items():
        own = {
            n: {"value": v, "unit": u, "source": "test", "uncertainty": uncertainty} for n, (v, u) in numbers.items()
        }
        given = yaml.safe_dump({"title": name, "parameters": own})
        (folder / f"{name}_{uncertainty}.yaml").write_text(given, encoding="utf-8")
        text = text.replace(
            f"{name}.fmu, integrator: cvode", f"{name}.fmu, integrator: cvode, parameter_set: {name}_{uncertainty}.yaml"
        )
    path = folder / f"scenario_{macro.replace(' ', '')}_{uncertainty}.yaml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[Recording]]:
    folder = tmp_path_factory.mktemp("seat")
    return folder, recorded(folder, 0.0)


def test_the_error_is_about_what_a_joint_integration_differs_by(plain: tuple[Path, list[Recording]]) -> None:
    folder, recordings = plain
    coarse = ClosedLoopModel(load_scenario(scenario(folder, "10 ms")), recordings)
    zero = Point(np.zeros(len(coarse.parameters)))
    # The recordings are those of a joint integration, so residuals are that error and noise of one deviation.
    left = coarse.residuals([zero])[0]
    error = coarse.solving_error(zero)
    assert error is not None
    assert np.mean(left**2) > 5.0
    assert np.mean((left + error) ** 2) < 0.3 * np.mean(left**2)
    fine = ClosedLoopModel(load_scenario(scenario(folder, "1 ms")), recordings)
    small = fine.solving_error(zero)
    assert small is not None
    assert np.mean(small**2) < 0.02 * np.mean(error**2)


def test_a_law_within_the_error_is_refused_and_one_beyond_it_is_not(plain: tuple[Path, list[Recording]]) -> None:
    folder, recordings = plain
    model = ClosedLoopModel(load_scenario(scenario(folder, "10 ms")), recordings)
    (law,) = [t for t in model.terms() if t.identifier == "cubic_spring" and t.place == "seat.v"]
    without = fit(model, Point(np.zeros(len(model.parameters))))
    for strength, is_refused in ((0.02, True), (200.0, False)):
        fitted = fit(model, without.point.plus(law, (law.parameters[0].starts[0] * strength,)), 0)
        judge = _Judge(model, left_out_readings(model, ["1", "2", "3"]), None)
        why = _of_solving(judge, law, Explanation(fitted), without)
        assert bool(why) == is_refused
        assert judge.coarse == ({law} if is_refused else set())
        assert not is_refused or "time.macro_step" in why[0]


def test_a_seat_that_lacks_nothing_gets_no_law_because_its_damper_is_late(plain: tuple[Path, list[Recording]]) -> None:
    folder, recordings = plain
    path, options = scenario(folder, "10 ms", 1e-3), Options(is_brief=True)
    answer = diagnose(load_scenario(path), recordings[:2], recordings[2:], Settings(), options=options).diagnosis
    assert not answer.accepted, [f.effect for f in answer.accepted]
    assert answer.verdict is Verdict.CANNOT_TELL
    assert [f.is_coarse for f in answer.suggestions] == [True]
    assert "time.macro_step is too long to tell" in answer.statement
    assert what_decides(answer).startswith("Halve time.macro_step")


def test_a_spring_that_hardens_is_found_with_short_macro_steps(tmp_path: Path) -> None:
    recordings = recorded(tmp_path, 8e5)
    path, options = scenario(tmp_path, "1 ms"), Options(is_brief=True)
    answer = diagnose(load_scenario(path), recordings[:2], recordings[2:], Settings(), options=options).diagnosis
    assert [f.effect for f in answer.accepted] == ["cubic_spring"]
    strength = answer.accepted[0].parameters[0]
    assert strength.value == pytest.approx(8e5, rel=0.05)
