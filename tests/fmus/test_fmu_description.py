"""modelDescription.xml, and any importer's use of it."""

import csv
import os
from pathlib import Path

import fmpy
import numpy as np
import pint
import pytest
from fmpy import read_model_description, simulate_fmu
from fmpy.validation import validate_fmu
from fmu_runs import STEP, advance, every_fmu

from cosim.paper.laws import Coil

REFERENCE = Path(__file__).resolve().parents[2] / "fmus" / "thermal_stiffness" / "reference.csv"
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
        fmu_file(version=version), fmi_type=interface, start_values=start, stop_time=12.0, output_interval=0.5,
        relative_tolerance=1e-8, output=[name],
    )  # fmt: skip
    assert len(result) == 25
    end = np.ravel(result[name][-1])[-1]
    # Co-Simulation is exact; fmpy's CVODE at rtol 1e-8 of 300 K errs by about 1e-6 K in each of some hundred steps.
    tolerance = 1e-9 if interface == "CoSimulation" else 1e-3
    assert end - 273.15 == pytest.approx(float(Coil().heating(12.0, 1.0)), abs=tolerance)


def test_results_have_not_drifted_from_the_reference(make_unit):
    """`UPDATE_REFERENCE=1` rewrites the file; say in the changelog why."""
    unit = make_unit(coils=3)
    unit.initialise(0)
    unit.exit_initialisation()
    powers = np.repeat([[0.45, 0.2, 0.3], [0.0, 0.4, 0.3], [0.45, 0.0, 0.0], [0.0, 0.0, 0.3]], 10, axis=0)
    outputs = ("temperature", "stiffness", "stored_energy", "convected_energy")
    run = advance(unit, powers, outputs, size=60 * STEP)
    header = ["time", *(f"{name}[{i}]" for name in outputs for i in (1, 2, 3))]
    rows = np.column_stack([0.6 * np.arange(1, 41), run.reshape(40, -1)])
    if os.environ.get("UPDATE_REFERENCE"):
        with REFERENCE.open("w", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(header)
            writer.writerows([[f"{value:.15g}" for value in row] for row in rows])
    with REFERENCE.open() as file:
        assert next(csv.reader(file)) == header
    reference = np.loadtxt(REFERENCE, delimiter=",", skiprows=1)
    # exp and expm1 of other C libraries differ in the last digit; 1e-10 is below any change of an equation.
    np.testing.assert_allclose(rows, reference, rtol=1e-10, atol=1e-13)


def test_the_fmus_are_built_for_this_platform(fmu_file):
    assert fmpy.platform in fmpy.supported_platforms(str(fmu_file(version=2)))
    assert fmpy.platform in fmpy.supported_platforms(str(fmu_file(version=3)))
