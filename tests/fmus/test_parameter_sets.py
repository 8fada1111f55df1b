"""The shipped parameter sets of the new actuators say what their FMUs start with, every number with its source."""

from pathlib import Path

import pint
import pytest
import yaml
from fmpy import read_model_description

SETS = Path(__file__).resolve().parents[2] / "scenarios" / "parameter_sets"


@pytest.mark.parametrize("model", ["niti_kinetics", "tcp_muscle", "polypyrrole_film"])
def test_a_parameter_set_holds_every_parameter_at_its_start_value(fmu_file, model):
    registry = pint.UnitRegistry(autoconvert_offset_to_baseunit=True)
    registry.define("uohm = 1e-6 ohm")
    entries = yaml.safe_load((SETS / f"{model}.yaml").read_text())["parameters"]
    variables = read_model_description(fmu_file(model, 3)).modelVariables
    parameters = {v.name: v for v in variables if v.causality == "parameter"}
    assert set(entries) == set(parameters)
    for name, entry in entries.items():
        value = registry.Quantity(entry["value"], entry["unit"]).to(parameters[name].unit).magnitude
        # Temperatures are rounded to 0.01 K in both.
        assert value == pytest.approx(float(parameters[name].start), rel=1e-9), name
        assert len(entry["source"]) > 10
