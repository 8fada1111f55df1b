"""The interface of an actuator: what is refused, and that the error names it."""

import re
import zipfile

import pytest

from cosim.actuator.interface import PORTS, faults
from cosim.assemble import assemble
from cosim.unit.errors import InputError
from cosim.unit.protocol import Causality, Variable, VariableType

from .scenarios import short


def actuator(**changes):
    """Variables of a complete actuator of six coils; a change of None removes one."""
    shape = {False: ((), ()), True: ((6,), ("coil",))}
    made = {
        p.name: Variable(p.name, p.causality, *shape[p.is_per_coil][:1], p.unit, shape[p.is_per_coil][1]) for p in PORTS
    }
    made |= changes
    return {name: v for name, v in made.items() if v is not None}


def output(name, shape=(6,), unit="N/m", **more):
    return Variable(name, more.pop("causality", Causality.OUTPUT), shape, unit, ("coil",) * len(shape), **more)


def test_a_complete_actuator_has_no_faults():
    assert faults(actuator()) == []


def test_what_is_optional_may_be_absent():
    optional = {p.name: None for p in PORTS if not p.is_required}
    assert faults(actuator(**{**optional, "power": actuator()["power"]})) == []
    assert faults(actuator(**{**optional, "voltage": actuator()["voltage"]})) == []


@pytest.mark.parametrize("name", [p.name for p in PORTS if p.is_required])
def test_each_required_variable_that_is_missing_is_named_with_its_unit(name):
    port = next(p for p in PORTS if p.name == name)
    (fault,) = [f for f in faults(actuator(**{name: None})) if name in f]
    assert f"it has no {port.causality.value} `{name}` [{port.unit}]" in fault


@pytest.mark.parametrize(
    ("change", "what"),
    [
        ({"power": None, "voltage": None}, "no input `power` [W] and no input `voltage` [V]"),
        ({"stiffness": output("stiffness", unit="N/mm")}, "its `stiffness` is in `N/mm`, not in N/m"),
        ({"stiffness": output("stiffness", unit="1")}, "its `stiffness` is in `1`, not in N/m"),
        ({"stiffness": output("stiffness", unit="blobs")}, "its `stiffness` is in `blobs`, not in N/m"),
        ({"temperature": output("temperature", unit="degC")}, "its `temperature` is in `degC`, not in K"),
        ({"stiffness": output("stiffness", causality=Causality.LOCAL)}, "of causality local, not output"),
        ({"stiffness": output("stiffness", type=VariableType.INT32)}, "of type Int32, not a floating-point number"),
        ({"resistance": output("resistance", (5,), "ohm")}, "its `resistance` has 5 values, but its `stiffness` has 6"),
        ({"stiffness": output("stiffness", ())}, "its `stiffness` has shape (), not one value per coil"),
        ({"tension": output("tension", (6, 2), "N", causality=Causality.INPUT)}, "its `tension` has shape (6, 2)"),
    ],
)
def test_each_fault_is_named(change, what):
    found = faults(actuator(**change))
    assert [f for f in found if what in f], found
    assert len(found) == 1


def test_units_that_are_the_same_by_another_name_are_accepted():
    assert faults(actuator(resistance=output("resistance", unit="kg*m^2/s^3/A^2"))) == []
    assert faults(actuator(stored_energy=output("stored_energy", unit="N*m"))) == []


def rewritten(source, target, change):
    """Copy of an FMU with its model description changed."""
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w") as new:
        for name in old.namelist():
            data = old.read(name)
            new.writestr(name, change(data.decode()).encode() if name == "modelDescription.xml" else data)
    return target


DEFECTS = {
    "no stiffness": (lambda t: t.replace('name="stiffness"', 'name="rigidity"'), "it has no output `stiffness` [N/m]"),
    "other unit": (
        lambda t: re.sub(r'(name="rest_length"[^>]*?unit=")m"', r'\1K"', t, flags=re.DOTALL),
        "its `rest_length` is in `K`, not in m",
    ),
    "no drive": (
        lambda t: t.replace('name="power"', 'name="force"'),
        "it has no input `power` [W] and no input `voltage`",
    ),
}


@pytest.mark.parametrize("defect", DEFECTS)
def test_a_scenario_with_an_fmu_that_is_no_actuator_is_refused_before_the_run(cosim, fmus, tmp_path, defect):
    change, what = DEFECTS[defect]
    file = rewritten(fmus / "thermal_stiffness_fmi3.fmu", tmp_path / "mine.fmu", change)
    scenario = short(fmu=str(file))
    with pytest.raises(InputError) as caught:
        assemble(scenario)
    assert caught.value.key == "components.actuator.fmu"
    assert f"mine.fmu is no actuator: {what}" in caught.value.problem
    assert "docs/actuators/interface.md" in caught.value.remedy
    (tmp_path / "mine.yaml").write_text(scenario.to_yaml())
    answer = cosim("validate", tmp_path / "mine.yaml")
    assert answer.code == 2
    assert what in answer.err
