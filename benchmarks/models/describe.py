"""From a model's variables: the C header with their indices, and modelDescription.xml of FMI 2.0 and 3.0."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any
from xml.etree import ElementTree as ET

FMI2, FMI3 = 2, 3
#: Exponents of the SI base units of every unit that the models use.
UNITS: dict[str, dict[str, int]] = {
    "1": {},
    "m": {"m": 1},
    "kg": {"kg": 1},
    "s": {"s": 1},
    "Hz": {"s": -1},
    "m/s": {"m": 1, "s": -1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N/m": {"kg": 1, "s": -2},
    "N.s/m": {"kg": 1, "s": -1},
}
STRUCTURAL = "structuralParameter"


@dataclass(frozen=True)
class Model:
    """What `model.toml` says.

    Args:
        name: Folder and model identifier.
        description: One sentence.
        token: Instantiation token.
        versions: FMI versions to build.
        variables: Name to causality, unit, start, size, depends and description; value references count from 1 in
            this order, 0 is time.
        has_events: Whether it has time events.
    """

    name: str
    description: str
    token: str
    versions: tuple[int, ...]
    variables: dict[str, dict[str, Any]]
    has_events: bool = False

    def reference(self, name: str) -> int:
        """Value reference of a variable."""
        return 1 + list(self.variables).index(name)


def header(model: Model) -> str:
    """`variables.h`: indices, start values and roles."""
    rows = list(model.variables.values())
    names = ", ".join(["TIME", *(name.upper() for name in model.variables), "COUNT"])
    sizes = [model.reference(row["size"]) if "size" in row else -1 for row in rows]

    def table(kind: str, name: str, first: int, values: list[Any]) -> str:
        body = ", ".join(str(v) for v in [first, *values])
        return f"static const {kind} {name}[COUNT] __attribute__((unused)) = {{{body}}};\n"

    def roles(*causalities: str) -> list[int]:
        return [int(row["causality"] in causalities) for row in rows]

    return (
        f"/* Generated from model.toml. */\n#ifndef VARIABLES_H\n#define VARIABLES_H\n\nenum {{ {names} }};\n"
        f'#define MODEL_IDENTIFIER "{model.name}"\n#define INSTANTIATION_TOKEN "{model.token}"\n'
        + table("double", "START", 0, [float(row.get("start", 0)) for row in rows])
        + table("int", "SIZED_BY", -1, sizes)
        + table("int", "IS_INPUT", 0, roles("input"))
        + table("int", "IS_SETTABLE", 0, roles("input", "parameter"))
        + table("int", "IS_STRUCTURAL", 0, roles(STRUCTURAL))
        + "\n#endif\n"
    )


def describe(model: Model, version: int) -> str:
    """modelDescription.xml."""
    root = ET.Element("fmiModelDescription", fmiVersion="2.0" if version == FMI2 else "3.0", modelName=model.name)
    root.set("guid" if version == FMI2 else "instantiationToken", model.token)
    root.set("description", model.description)
    interface = ET.SubElement(root, "CoSimulation", modelIdentifier=model.name)
    interface.set("canHandleVariableCommunicationStepSize", "true")
    interface.set("canGetAndSetFMUstate" if version == FMI2 else "canGetAndSetFMUState", "true")
    interface.set("canSerializeFMUstate" if version == FMI2 else "canSerializeFMUState", "true")
    if version == FMI3:
        interface.set("hasEventMode", str(model.has_events).lower())
    _units(root)
    variables = ET.SubElement(root, "ModelVariables")
    (_variables2 if version == FMI2 else _variables3)(model, variables)
    _structure(model, ET.SubElement(root, "ModelStructure"), version)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode", xml_declaration=True)


def _units(root: ET.Element) -> None:
    definitions = ET.SubElement(root, "UnitDefinitions")
    for name, exponents in UNITS.items():
        unit = ET.SubElement(definitions, "Unit", name=name)
        ET.SubElement(unit, "BaseUnit", {base: str(power) for base, power in exponents.items()})


def _variability(row: dict[str, Any]) -> str:
    return "fixed" if row["causality"] in {"parameter", STRUCTURAL} else "continuous"


def _variables2(model: Model, parent: ET.Element) -> None:
    time = ET.SubElement(
        parent, "ScalarVariable", name="time", valueReference="0", causality="independent", variability="continuous"
    )
    ET.SubElement(time, "Real", unit="s")
    for name, row in model.variables.items():
        attributes = {
            "name": name,
            "valueReference": str(model.reference(name)),
            "causality": row["causality"],
            "variability": _variability(row),
            "description": row["description"],
        }
        if row["causality"] in {"output", "local"}:
            attributes["initial"] = "calculated"
        variable = ET.SubElement(parent, "ScalarVariable", attributes)
        real = ET.SubElement(variable, "Real", unit=row["unit"])
        if row["causality"] in {"input", "parameter"}:
            real.set("start", repr(row["start"]))


def _variables3(model: Model, parent: ET.Element) -> None:
    ET.SubElement(
        parent, "Float64", name="time", valueReference="0", causality="independent", variability="continuous", unit="s"
    )
    for name, row in model.variables.items():
        is_structural = row["causality"] == STRUCTURAL
        attributes = {
            "name": name,
            "valueReference": str(model.reference(name)),
            "causality": row["causality"],
            "variability": _variability(row),
            "description": row["description"],
        }
        variable = ET.SubElement(parent, "UInt64" if is_structural else "Float64", attributes)
        if not is_structural:
            variable.set("unit", row["unit"])
        if row["causality"] in {"output", "local"}:
            variable.set("initial", "calculated")
        else:
            count = model.variables[row["size"]]["start"] if "size" in row else 1
            variable.set("start", " ".join([repr(row["start"])] * count))
        if "size" in row:
            ET.SubElement(variable, "Dimension", valueReference=str(model.reference(row["size"])))


def _structure(model: Model, parent: ET.Element, version: int) -> None:
    """Outputs with their dependencies on inputs; FMI 2.0 counts variables from 1, FMI 3.0 names value references."""
    group, shift, key = (parent, 0, "valueReference") if version == FMI3 else (None, 1, "index")
    for name, tag2, tag3 in (("outputs", "Outputs", "Output"), ("initial", "InitialUnknowns", "InitialUnknown")):
        if version == FMI2:
            group = ET.SubElement(parent, tag2)
        assert group is not None
        for variable, row in model.variables.items():
            if row["causality"] != "output":
                continue
            known = list(row["depends"])
            if name == "initial":
                known += [other for other, r in model.variables.items() if r["causality"] == "parameter"]
            element = ET.SubElement(group, "Unknown" if version == FMI2 else tag3)
            element.set(key, str(model.reference(variable) + shift))
            element.set("dependencies", " ".join(str(model.reference(other) + shift) for other in known))
