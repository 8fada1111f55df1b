"""The search fits any scenario that runs through the co-simulation; shown on a pendulum with a known friction."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.run import run
from cosim.scenario import Scenario, load_scenario
from cosim.unit.errors import InputError
from diagnosis.recording.readings import read_results
from diagnosis.recording.recording import Recording, load_recording
from diagnosis.recording.sensor import SensorFile
from diagnosis.recording.write import Notes, write_recording
from diagnosis.search.cosim_model import CosimModel, Free, free_parameters
from diagnosis.search.fit import fit
from diagnosis.search.pendulum_terms import pendulum_terms
from diagnosis.search.problem import Parameter, Point

NOISE = 1e-3  # rad


def made(folder: Path, seed: int, **truth: str) -> Recording:
    """A recording of the shipped pendulum for 4 s, with other parameters than the scenario says."""
    from cosim.unit.quantity import PhysicalValue

    base = load_scenario("pendulum")
    arm = base.components["arm"]
    changed = arm.model_copy(
        update={"parameters": {**arm.parameters, **{k: PhysicalValue.parse(v) for k, v in truth.items()}}}
    )
    time = base.time.model_copy(update={"stop": PhysicalValue(4.0, "s"), "checkpoint_step": PhysicalValue(1.0, "s")})
    scenario = base.model_copy(update={"components": {"arm": changed}, "time": time})
    sensors = SensorFile.model_validate({"default": {"rate": "50 Hz", "noise": f"{NOISE} rad", "unit": "rad"}})
    write_recording(folder, read_results(run(scenario), ["arm.angle"], sensors, seed, folder), Notes("swing"))
    return load_recording(folder)


@pytest.fixture(scope="module")
def damped(tmp_path_factory) -> Recording:
    return made(tmp_path_factory.mktemp("r") / "r", 1, viscous_damping="2e-4 N*m*s/rad", centre_distance="118 mm")


def model(recording: Recording, scenario: Scenario | None = None) -> CosimModel:
    base = scenario or load_scenario("pendulum")
    return CosimModel(base, [recording], free_parameters(base, [recording]), pendulum_terms("arm"))


def test_parameters_are_free_where_their_set_states_an_uncertainty(damped):
    assert [(f.parameter.name, f.parameter.unit, f.parameter.nominal) for f in model(damped).free] == [
        ("arm.centre_distance", "m", pytest.approx(0.115))
    ]


def test_the_right_law_is_recovered_within_its_interval_and_leaves_noise(damped):
    found = model(damped)
    damping = next(t for t in found.terms() if t.identifier == "viscous_damping")
    result = fit(found, Point(np.zeros(1), {damping: (1e-4,)}))
    deviation = np.sqrt(np.diag(result.covariance))
    value = result.point.terms[damping][0]
    assert value == pytest.approx(2e-4, abs=4 * deviation[1])
    assert deviation[1] < 2e-6
    assert found.free[0].parameter.value(result.point.base[0]) == pytest.approx(0.118, rel=1e-3)
    assert np.mean(result.residuals**2) == pytest.approx(1.0, abs=0.3)  # 201 readings: deviation 0.1


def test_without_the_law_the_fit_leaves_structure(damped):
    result = fit(model(damped), Point(np.zeros(1)))
    assert np.mean(result.residuals**2) > 100.0


def test_derivatives_agree_with_differences_of_residuals(damped):
    found = model(damped)
    point = Point(np.array([0.3]))
    jacobian = found.base_jacobian(point)[:, 0]
    high, low = found.residuals([Point(np.array([0.31])), Point(np.array([0.29]))])
    np.testing.assert_allclose(jacobian, (high - low) / 0.02, atol=2e-3 * np.max(np.abs(jacobian)))


def test_what_cannot_be_simulated_is_infinite(damped):
    free = [Free(Parameter("arm.mass", "kg", 0.1, 0.1, is_relative=False), "arm", "mass")]
    found = CosimModel(load_scenario("pendulum"), [damped], free)
    assert np.isinf(found.residuals([Point(np.array([-2.0]))])).all()  # a mass of -0.1 kg


def test_every_law_of_the_pendulum_changes_what_is_read(damped):
    found = model(damped)
    at_rest = found.residuals([Point(np.zeros(1))])[0]
    for term in found.terms():
        values = tuple(p.starts[-1] for p in term.parameters)
        assert np.max(np.abs(found.residuals([Point(np.zeros(1), {term: values})])[0] - at_rest)) > 0.5, term


def test_a_channel_that_the_scenario_does_not_have_is_one_error(damped):
    found = CosimModel(load_scenario("tclab"), [damped], [])
    with pytest.raises(InputError, match="no such quantity"):
        found.residuals([Point(np.zeros(0))])
