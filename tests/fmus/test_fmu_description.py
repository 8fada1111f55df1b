"""modelDescription.xml, and any importer's use of it."""

import fmpy
import numpy as np
import pint
import pytest
from fmpy import read_model_description, simulate_fmu
from fmpy.validation import validate_fmu
from fmu_runs import drive_of, every_fmu, every_model

from chainmail.equations import Coil
from cosim.unit.protocol import Causality

POWER = 1.0 / 2.2


@every_fmu
@pytest.mark.parametrize("coils", [1, 36, 288])
def test_the_description_is_valid(fmu_file, model, version, coils):
    assert validate_fmu(str(fmu_file(model, version, coils))) == []


@every_fmu
def test_both_interfaces_save_and_serialise_their_state(fmu_file, model, version):
    description = read_model_description(fmu_file(model, version))
    for interface in (description.coSimulation, description.modelExchange):
        assert interface.modelIdentifier == model
        assert interface.canGetAndSetFMUstate
        assert interface.canSerializeFMUstate
    assert description.coSimulation.canHandleVariableCommunicationStepSize
    assert (description.numberOfEventIndicators or 0) == 0


@every_fmu
def test_every_variable_has_a_defined_unit_of_the_right_dimension(fmu_file, model, version):
    description = read_model_description(fmu_file(model, version))
    defined = {unit.name: unit.baseUnit for unit in description.unitDefinitions}
    registry = pint.UnitRegistry()
    symbols = {"kg": "kg", "m": "m", "s": "s", "A": "A", "K": "K"}
    for variable in description.modelVariables:
        if variable.type in ("Boolean", "UInt64"):
            continue
        base = defined[variable.unit]
        expected = registry.Quantity(1.0)
        for exponent, symbol in symbols.items():
            expected = expected * registry.Quantity(1.0, symbol) ** int(getattr(base, exponent) or 0)
        assert registry.Quantity(1.0, variable.unit).to_base_units().units == expected.to_base_units().units
        assert variable.description


def structure(description):
    """Name of every output and derivative to the names that it depends on directly."""
    unknowns = [*description.outputs, *description.derivatives]
    return {u.variable.name: {v.name for v in u.dependencies} for u in unknowns}


@every_model
def test_dependencies_are_element_by_element_and_the_same_in_both_versions(fmu_file, model):
    whole = structure(read_model_description(fmu_file(model, 3)))
    single = structure(read_model_description(fmu_file(model, 2)))
    arrays = {v.name for v in read_model_description(fmu_file(model, 3)).modelVariables if v.dimensions}

    def element(name):
        return name if name not in arrays else f"{name[:-1]}[5])" if name.endswith(")") else f"{name}[5]"

    for name, names in whole.items():
        assert single[element(name)] == {element(other) for other in names}, name


@pytest.mark.parametrize(
    ("model", "feedthrough"),
    [
        ("thermal_stiffness", set()),
        ("tcp_muscle", set()),
        ("instant_stiffness", {("stiffness", "power"), ("temperature", "ambient_temperature")}),
        ("polypyrrole_film", {("film_current", "voltage"), ("temperature", "ambient_temperature")}),
        (
            "niti_kinetics",
            {
                (name, "tension")
                for name in (
                    "temperature",
                    "martensite_fraction",
                    "stiffness",
                    "rest_length",
                    "resistance",
                    "latent_energy",
                )
            },
        ),
    ],
)
def test_outputs_that_inputs_reach_at_once_are_named(fmu_file, model, feedthrough):
    """What a master needs to find algebraic loops."""
    description = read_model_description(fmu_file(model, 3))
    inputs = {v.name for v in description.modelVariables if v.causality == "input"}
    outputs = {u.variable.name: {v.name for v in u.dependencies} for u in description.outputs}
    assert {(name, other) for name, others in outputs.items() for other in others & inputs} == feedthrough


@every_model
def test_no_output_depends_on_an_input_that_is_not_named(make_unit, model):
    """Each input is changed alone after a run; outputs that move without a step are those that ModelStructure names."""
    unit = make_unit(model)
    description = unit.archive.description
    unit.initialise(0)
    unit.set("ambient_temperature", np.array(305.0))
    if "tension" in unit.variables:
        unit.set("tension", np.full(36, 4.0))
    unit.set(drive_of(unit), np.full(36, 0.4))
    unit.do_step(0, 5 * 10**9)
    depends = {u.variable.name: {v.name for v in u.dependencies} for u in description.outputs}
    inputs = [n for n, v in unit.variables.items() if v.causality is Causality.INPUT]
    for name in inputs:
        before = {output: unit.get(output).copy() for output in depends}
        old = unit.get(name).copy()
        unit.set(name, np.zeros(36) if unit.variables[name].shape else old + 10.0)
        unit.buffers.read(5 * 10**9)
        moved = {output for output in depends if not np.array_equal(unit.get(output), before[output])}
        assert moved == {output for output, names in depends.items() if name in names}
        unit.set(name, old)
        unit.buffers.read(5 * 10**9)


def test_the_number_of_coils_is_a_structural_parameter(fmu_file):
    description = read_model_description(fmu_file())
    coils = next(v for v in description.modelVariables if v.name == "coils")
    assert (coils.causality, coils.start) == ("structuralParameter", "36")
    arrays = {v.name for v in description.modelVariables if v.dimensions}
    assert {"power", "temperature", "stiffness", "volume", "der(temperature)"} <= arrays
    assert "ambient_temperature" not in arrays


@pytest.mark.parametrize("interface", ["CoSimulation", "ModelExchange"])
@pytest.mark.parametrize("version", [3, 2])
def test_a_plain_importer_reproduces_equation_3(fmu_file, interface, version):
    if version == 3:
        start, name = {"power": np.full(36, POWER)}, "temperature"
    else:
        start, name = {f"power[{i}]": POWER for i in range(1, 37)}, "temperature[36]"
    result = simulate_fmu(
        fmu_file(version=version),
        fmi_type=interface,
        start_values=start,
        stop_time=12.0,
        output_interval=0.5,
        relative_tolerance=1e-8,
        output=[name],
    )
    assert len(result) == 25
    end = np.ravel(result[name][-1])[-1]
    # Co-Simulation is exact; fmpy's CVODE at rtol 1e-8 of 300 K errs by about 1e-6 K in each of some hundred steps.
    tolerance = 1e-9 if interface == "CoSimulation" else 1e-3
    assert end - 273.15 == pytest.approx(float(Coil().heating(12.0, 1.0)), abs=tolerance)


def test_the_fmus_are_built_for_this_platform(fmu_file):
    assert fmpy.platform in fmpy.supported_platforms(str(fmu_file(version=2)))
    assert fmpy.platform in fmpy.supported_platforms(str(fmu_file(version=3)))
