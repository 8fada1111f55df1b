"""What the FMUs refuse, and that they say why: values out of range and calls out of order."""

import ctypes

import numpy as np
import pytest
from fmu_runs import drive_of, every_model

from cosim.unit.errors import InputError
from cosim.unit.protocol import UnitError

both_versions = pytest.mark.parametrize("version", [3, 2])


@every_model
@both_versions
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_an_input_that_is_no_number_is_refused_by_name_and_index(make_unit, model, version, bad):
    unit = make_unit(model, version)
    unit.initialise(0)
    drive = drive_of(unit)
    unit.set(drive, np.full(36, 0.4))
    unit.get(drive)[4] = bad  # past the check of the unit itself
    with pytest.raises(UnitError, match=rf"{drive}\[5\] = -?(nan|inf) [WV]: it must be a finite number"):
        unit.writers[drive]()
    unit.get(drive)[4] = 0.4
    unit.do_step(0, 10**9)
    for name in ("stiffness", "rest_length", "stored_energy", "convected_energy"):
        assert np.ptp(unit.get(name)) == 0.0, name  # the refused values were not taken


@every_model
@both_versions
def test_an_ambient_temperature_below_absolute_zero_is_refused(make_unit, model, version):
    unit = make_unit(model, version)
    with pytest.raises(UnitError, match=r"ambient_temperature = -3 K: it must be positive"):
        unit.set("ambient_temperature", -3.0)


@both_versions
@pytest.mark.parametrize(
    ("parameter", "bad", "message"),
    [
        ("volume", 0.0, r"volume\[1\] = 0 m\^3: it must be positive"),
        ("density", -1.0, r"density = -1 kg/m\^3: it must be positive"),
        ("specific_heat", 0.0, r"specific_heat = 0 J/\(kg\*K\): it must be positive"),
        ("area", np.nan, r"area = nan m\^2: it must be a finite number"),
        ("heat_transfer_coefficient", -90.0, r"heat_transfer_coefficient\[1\] = -90 .*: it must be zero or positive"),
        ("cooling_rate", np.inf, r"cooling_rate = inf 1/s: it must be a finite number"),
        ("heating_b", -17443.0, r"heating_b = -17443: it must be positive"),
        ("reference_resistance", 0.0, r"reference_resistance\[1\] = 0 ohm: it must be positive"),
    ],
)
def test_a_parameter_out_of_range_is_refused(make_unit, version, parameter, bad, message):
    with pytest.raises(UnitError, match=message):
        make_unit(version=version, parameters={parameter: bad})


@both_versions
def test_the_element_at_fault_is_named(make_unit, version):
    volume = np.full(36, 7e-9)
    volume[20] = -7e-9
    with pytest.raises(UnitError, match=r"volume\[21\] = -7e-09 m\^3"):
        make_unit(version=version, parameters={"volume": volume})


@both_versions
def test_branches_in_the_wrong_order_are_refused(make_unit, version):
    unit = make_unit(version=version, parameters={"cooling_a": 10.0, "cooling_d": 100.0})
    with pytest.raises(UnitError, match=r"the cooling branch .* lies below the heating branch .* exchange them"):
        unit.initialise(0)


@both_versions
def test_a_resistance_that_falls_below_zero_stops_the_run(make_unit, version):
    unit = make_unit(version=version, parameters={"resistance_temperature_coefficient": -0.02})
    unit.initialise(0)
    unit.set("power", np.where(np.arange(36) == 30, 1.0, 0.1))
    with pytest.raises(UnitError, match=r"resistance\[31\] = -.* ohm: it must be positive.*the step from 0 s by 60 s"):
        unit.do_step(0, 60 * 10**9)
    with pytest.raises(UnitError, match="must not be called in the state Failed"):
        unit.binding.do_step(60.0, 1.0)


@pytest.mark.parametrize("coils", [0, 100_001])
def test_a_number_of_coils_out_of_range_is_refused(make_unit, coils):
    with pytest.raises(InputError, match=f"coils = {coils} is outside 1 to 100000"):
        make_unit(coils=coils)


def test_the_size_of_an_fmi_2_fmu_is_compared_with_the_scenario(fmu_file):
    from cosim.fmu.archive import open_fmu
    from cosim.fmu.co_simulation import CoSimulationUnit
    from cosim.fmu.unit import FmuSettings

    archive = open_fmu(fmu_file(version=2))
    with pytest.raises(InputError, match=r"built for 36 coils .* not for 18"):
        CoSimulationUnit("actuator", archive, FmuSettings({"coils": 18}))
    archive.remove()


@every_model
@both_versions
def test_calls_out_of_order_are_refused(make_unit, model, version):
    unit = make_unit(model, version)
    binding, fmu = unit.binding, unit.binding.fmu
    with pytest.raises(UnitError, match="DoStep must not be called in the state Instantiated"):
        binding.do_step(0.0, 1.0)
    with pytest.raises(UnitError, match="ExitInitializationMode must not be called in the state Instantiated"):
        binding.call(fmu.exitInitializationMode)
    with pytest.raises(UnitError, match="Terminate must not be called in the state Instantiated"):
        binding.call(fmu.terminate)
    with pytest.raises(UnitError, match="temperature has no value in the state Instantiated"):
        next(r for r in unit.readers if r.variable.variable.name == "temperature")()
    unit.initialise(0)
    unit.exit_initialisation()
    with pytest.raises(UnitError, match="EnterInitializationMode must not be called in the state Step Mode"):
        binding.call(fmu.enterInitializationMode)
    with pytest.raises(UnitError, match="coil_rest_length must not be set in the state Step Mode"):
        unit.set_parameters({"coil_rest_length": 0.01})
    unit.do_step(0, 10**9)
    binding.call(fmu.terminate)
    with pytest.raises(UnitError, match="DoStep must not be called in the state Terminated"):
        binding.do_step(1.0, 1.0)
    binding.call(fmu.reset)
    unit.initialise(0)
    unit.do_step(0, 10**9)


@both_versions
def test_model_exchange_calls_out_of_order_are_refused(make_unit, version):
    unit = make_unit("thermal_stiffness", version, "model_exchange")
    binding, fmu = unit.binding, unit.binding.fmu
    with pytest.raises(UnitError, match="EnterContinuousTimeMode must not be called in the state Instantiated"):
        binding.call(fmu.enterContinuousTimeMode)
    unit.initialise(0)
    unit.exit_initialisation()
    states = np.full(72, 300.0)
    pointer = states.ctypes.data_as(ctypes.POINTER(ctypes.c_double))
    with pytest.raises(UnitError, match="71 values for 72 continuous states"):
        binding.call(fmu.setContinuousStates, pointer, 71)
    states[40] = np.nan
    with pytest.raises(UnitError, match=r"convected_energy\[5\] = nan is not a finite number"):
        binding.call(fmu.setContinuousStates, pointer, 72)
    binding.call(fmu.enterEventMode)
    states[40] = 0.0
    with pytest.raises(UnitError, match="SetContinuousStates must not be called in the state Event Mode"):
        binding.call(fmu.setContinuousStates, pointer, 72)


@both_versions
def test_outputs_cannot_be_set_and_unknown_references_are_refused(make_unit, version):
    unit = make_unit("thermal_stiffness", version)
    setter = unit.binding.fmu.setFloat64 if version == 3 else unit.binding.fmu.setReal
    stiffness = unit.table.all["stiffness"].value_references[:1]
    values = [200.0] * (36 if version == 3 else 1)
    with pytest.raises(UnitError, match="stiffness must not be set in the state Instantiated"):
        unit.binding.call(setter, stiffness, values)
    with pytest.raises(UnitError, match="value reference 999999 is no variable of this type"):
        unit.binding.call(setter, [999_999], [1.0])


def test_an_array_of_the_wrong_length_is_refused(make_unit):
    unit = make_unit()
    with pytest.raises(UnitError, match="35 values for variables of 36 values"):
        unit.binding.call(unit.binding.fmu.setFloat64, unit.table.all["power"].value_references, [0.1] * 35)


@both_versions
def test_a_step_beyond_the_stop_time_is_refused(make_unit, version):
    unit = make_unit("thermal_stiffness", version)
    binding, fmu = unit.binding, unit.binding.fmu
    if version == 3:
        binding.call(lambda: fmu.enterInitializationMode(startTime=0.0, stopTime=1.0))
    else:
        binding.call(lambda: fmu.setupExperiment(startTime=0.0, stopTime=1.0))
        binding.call(fmu.enterInitializationMode)
    binding.exit_initialisation()
    assert binding.do_step(0.0, 1.0).reached == 1.0
    with pytest.raises(UnitError, match=r"ends at 1\.1 s, after the stop time 1 s"):
        binding.do_step(1.0, 0.1)
