"""What was simulated is asked for once: sensors read it again, and derivatives go to one side."""

from __future__ import annotations

import numpy as np
import pytest

from cosim.scenario import load_scenario
from diagnosis.models.cosimulation.model import ClosedLoopModel
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.model import MOST_COURSES, SystemModel
from diagnosis.recording.recording import load_recording
from diagnosis.search.problem import Point, Term
from tests.systems.rigs import oscillator, oscillator_recordings


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> tuple[SystemModel, Term]:
    """Of two recordings of an oscillator, and the gain of its sensor."""
    folder = tmp_path_factory.mktemp("oscillator")
    scenario = load_scenario(str(oscillator(folder)))
    found = ClosedLoopModel(scenario, [load_recording(r) for r in oscillator_recordings(folder, lambda x, v: 0.0)[:2]])
    assert isinstance(found.model, SystemModel)
    (gain,) = [t for t in found.terms() if t.identifier == "sensor_gain"]
    return found.model, gain


@pytest.fixture
def model(rig: tuple[SystemModel, Term]) -> SystemModel:
    """The model alone."""
    return rig[0]


@pytest.fixture
def simulated(model: SystemModel, monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Numbers of recordings, in the order in which they are simulated."""
    found: list[int] = []
    plain = FastSystem.simulate
    numbers = {id(fast): n for n, fast in enumerate(model._fast)}

    def counted(self: FastSystem, *given: object) -> object:
        found.append(numbers[id(self)])
        return plain(self, *given)  # type: ignore[arg-type]

    monkeypatch.setattr(FastSystem, "simulate", counted)
    return found


def at(model: SystemModel, shift: float) -> Point:
    """A point that no other test asks for."""
    return Point(np.full(len(model.free), shift))


def test_points_that_differ_in_a_sensor_alone_are_simulated_once(
    rig: tuple[SystemModel, Term], simulated: list[int]
) -> None:
    model, gain = rig
    plain = at(model, 0.011)
    rows = model.residuals([plain, plain.plus(gain, (0.1,)), plain.plus(gain, (0.2,))])
    assert sorted(simulated) == [0, 1]
    np.testing.assert_allclose(rows[2] - rows[0], 2.0 * (rows[1] - rows[0]), atol=1e-9)  # a gain is a straight line
    assert np.abs(rows[1] - rows[0]).max() > 1.0


def test_another_number_of_the_model_is_simulated_anew(model: SystemModel, simulated: list[int]) -> None:
    first, second = model.residuals([at(model, 0.021), at(model, 0.022)])
    assert len(simulated) == 4
    assert np.abs(first - second).max() > 0.0


def test_few_courses_are_kept(model: SystemModel) -> None:
    model.residuals([at(model, 0.1 + 1e-3 * n) for n in range(MOST_COURSES)])
    assert len(model._courses) == MOST_COURSES


def test_derivatives_take_one_simulation_for_each_number(model: SystemModel, simulated: list[int]) -> None:
    point = at(model, 0.031)
    here = model.residuals([point])[0]
    simulated.clear()
    found = model.base_jacobian(point)
    assert sorted(simulated) == sorted([0, 1] * len(model.free))
    for column in range(len(model.free)):
        step = np.zeros(len(model.free))
        step[column] = 1e-3
        ahead, behind = (model.residuals([Point(point.base + sign * step)])[0] for sign in (1.0, -1.0))
        central = (ahead - behind) / 2e-3
        scale = np.abs(central).max()
        np.testing.assert_allclose(found[:, column] / scale, central / scale, rtol=0, atol=1e-3)
    assert np.isfinite(here).all()
