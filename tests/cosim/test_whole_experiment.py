"""The paper's experiment from begin to end, circuit and actuators without the fabric: nothing feeds back from it."""

import functools

import numpy as np
import pytest

from cosim.run import RunStopped, run

from .short_runs import with_parameters, without_fabric

VARIANTS = ("prototype_cantilever", "prototype_cantilever_instant")


def experiment(name, warm=False):
    """With `warm` the resistance rises by 1e-3 per kelvin, so that circuit and actuators depend on each other."""
    scenario = without_fabric(name)
    coefficient = {"resistance_temperature_coefficient": "1e-3 1/K"}
    return with_parameters(scenario, "actuator", **coefficient) if warm else scenario


@functools.cache
def whole_run(name, warm=False):
    """Results that nothing interrupted; nobody changes them."""
    return run(experiment(name, warm))


@pytest.mark.parametrize(("name", "warm"), [(VARIANTS[0], False), (VARIANTS[0], True), (VARIANTS[1], False)])
def test_electrical_energy_is_stored_or_given_to_the_air_to_the_last_joule(name, warm):
    result = whole_run(name, warm)
    paid = result.attrs["energy_electrical_J"]
    if not warm:
        # 36 coils at 1 V and 2.2 ohm from 0.37 s to 12.6 s.
        assert paid == pytest.approx(36 * 1.0**2 / 2.2 * 12.23, rel=1e-9)
    assert result.attrs["energy_stored_J"] + result.attrs["energy_convected_J"] == pytest.approx(paid, rel=1e-11)
    assert abs(result.attrs["energy_residual"]) < 1e-11
    # The same balance from the recorded series alone, by every coil.
    stored, convected = (result[f"actuator.{n}_energy"].values[-1] for n in ("stored", "convected"))
    power = result["circuit.power"].values
    assert result["time"].values[1] - result["time"].values[0] == pytest.approx(0.02)
    if warm:
        return  # power then changes between two outputs
    # A power recorded at the end of an output step held for both of its macro-steps, but for the switches:
    # 0.37 s falls between two outputs, so half a step is missing there.
    steps = 0.02 * power[1:].sum(axis=0) - 0.01 * power.max(axis=0)
    assert stored + convected == pytest.approx(steps, rel=1e-9)


@pytest.mark.parametrize(("name", "warm"), [(VARIANTS[0], True), (VARIANTS[1], False)])
def test_kirchhoff_holds_at_every_recorded_moment_of_the_whole_run(name, warm):
    result = whole_run(name, warm)
    current, voltage = (result[f"circuit.{n}"].values.reshape(-1, 6, 6) for n in ("current", "voltage"))
    strings, supply = result["circuit.string_current"].values, result["circuit.supply_current"].values
    given = result["supply.voltage"].values
    assert set(np.unique(given)) == {0.0, 6.0}
    # The circuit unit itself refuses what is off by more than 1e-9 of the scale.
    np.testing.assert_allclose(current, np.repeat(strings[:, :, None], 6, axis=2), rtol=0, atol=1e-9)
    np.testing.assert_allclose(voltage.sum(axis=2), np.repeat(given[:, None], 6, axis=1), rtol=0, atol=1e-8)
    np.testing.assert_allclose(strings.sum(axis=1), supply, rtol=0, atol=3e-9)
    np.testing.assert_allclose(result["circuit.supply_power"].values, given * supply, rtol=0, atol=2e-8)
    np.testing.assert_allclose(result["circuit.power"].values.reshape(-1, 6, 6), current * voltage, rtol=0, atol=1e-9)


def test_ohms_law_holds_with_the_resistance_that_the_actuator_reported_one_step_before():
    scenario = experiment(VARIANTS[0], warm=True)
    clock = scenario.time.model_copy(update={"output_step": scenario.time.macro_step})
    result = run(scenario.model_copy(update={"time": clock}))
    current, voltage = (result[f"circuit.{n}"].values for n in ("current", "voltage"))
    resistance = result["actuator.resistance"].values
    is_on = result["supply.voltage"].values[1:] > 0
    np.testing.assert_allclose(voltage[1:][is_on], (resistance[:-1] * current[1:])[is_on], rtol=1e-9)
    assert np.ptp(resistance) > 0.05


@pytest.mark.parametrize("share", [0.1, 0.25, 0.6])
def test_power_switches_and_feedback_survive_a_resumption_to_the_last_bit(tmp_path, share):
    def interrupt(progress):
        if progress.done >= share * progress.total:
            raise KeyboardInterrupt

    scenario = experiment(VARIANTS[0], warm=True)
    with pytest.raises(RunStopped):
        run(scenario, tmp_path / "run", on_progress=interrupt)
    resumed, whole = run(scenario, tmp_path / "run", resume=True), whole_run(VARIANTS[0], True)
    for name in whole.data_vars:
        assert np.array_equal(resumed[name].values, whole[name].values), name
    assert resumed.attrs["energy_residual"] == whole.attrs["energy_residual"]


def test_power_comes_and_goes_at_the_moments_of_the_paper():
    result = whole_run(VARIANTS[1])
    power = result["circuit.supply_power"]
    on = result["time"].values[power.values > 0]
    # Outputs stand every 20 ms at the end of a step; 0.37 s is between two of them, and 12.6 s still belongs to on.
    assert (on[0], on[-1]) == (pytest.approx(0.38), pytest.approx(12.6))
    assert float(power.max()) == pytest.approx(36 / 2.2, rel=1e-9)
    stiffness = result["actuator.stiffness"].values[:, 0]
    assert set(stiffness) == {157.1, 356.0}
