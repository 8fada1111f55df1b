"""Builds the FMU of models/scripted.c: its description, and one binary for each FMI version."""

from __future__ import annotations

import re
import subprocess
import zipfile
from enum import IntEnum
from pathlib import Path

import fmpy

SOURCE = Path(__file__).parent / "models" / "scripted.c"

#: Name, FMI 3.0 type, value reference, number of elements; inputs, then outputs.
INPUTS = (
    ("u", "Float64", 1, 1),
    ("ua", "Float64", 2, 3),
    ("uf", "Float32", 5, 1),
    ("ui", "Int32", 6, 1),
    ("ub", "Boolean", 7, 1),
)
OUTPUTS = (
    ("y", "Float64", 11, 1),
    ("ya", "Float64", 12, 3),
    ("yf", "Float32", 15, 1),
    ("yi", "Int32", 16, 1),
    ("yb", "Boolean", 17, 1),
    ("z", "Float64", 18, 1),
)
PARAMETERS = (("rate", 21, 1.0), ("moment", 22, 0.0), ("kind", 23, 0.0), ("gain", 24, 1.0), ("fixed_step", 25, 0.0))
FMI2_TYPES = {"Float64": "Real", "Float32": "Real", "Int32": "Integer", "Boolean": "Boolean"}


class Fault(IntEnum):
    """What the FMU does from its parameter `moment` on."""

    NONE = 0
    STEP_ERROR = 1
    STEP_DISCARD = 2
    NAN_ELEMENT = 3
    GET_ERROR = 4
    SET_ERROR = 5
    EARLY = 6
    TERMINATE = 7
    WARNING = 8
    INFINITE = 9
    FATAL = 10


def fmu_path(folder: Path, version: int, has_event_mode: bool = False) -> Path:
    """Where `build` puts the FMU."""
    return folder / f"scripted{'_events' * has_event_mode}_fmi{version}.fmu"


def build(folder: Path, version: int, has_event_mode: bool = False) -> Path:
    """Compile and zip the FMU of one FMI version; with Event Mode (FMI 3.0) it has a time event at `moment`."""
    platform = fmpy.platform if version == 2 else fmpy.platform_tuple
    library, fmu = folder / f"scripted{version}.so", fmu_path(folder, version, has_event_mode)
    headers = Path(fmpy.__file__).parent / "c-code"
    # fmpy wants every function of the standard to be there; those that the model lacks return an error.
    names = re.findall(r"TYPE\s+(fmi\d\w+);", (headers / f"fmi{version}Functions.h").read_text())
    absent = folder / f"absent{version}.c"
    absent.write_text("".join(f"__attribute__((weak)) int {n}(void) {{ return 3; }}\n" for n in names))
    command = [
        "gcc",
        "-std=c99",
        "-O2",
        f"-DFMI_VERSION={version}",
        "-fPIC",
        "-shared",
        "-isystem",
        headers,
        "-o",
        library,
        SOURCE,
        absent,
        "-lm",
    ]
    subprocess.run(command, check=True)
    with zipfile.ZipFile(fmu, "w") as archive:
        archive.writestr("modelDescription.xml", _fmi2() if version == 2 else _fmi3(has_event_mode))
        archive.write(library, f"binaries/{platform}/scripted{fmpy.sharedLibraryExtension}")
    return fmu


def _start(kind: str, count: int = 1) -> str:
    return " ".join(["false" if kind == "Boolean" else "0"] * count)


def _fmi3(has_event_mode: bool) -> str:
    variables = ['<Float64 name="time" valueReference="0" causality="independent" variability="continuous"/>']
    for causality, rows in (("input", INPUTS), ("output", OUTPUTS)):
        for name, kind, reference, count in rows:
            start = f' start="{_start(kind, count)}"' if causality == "input" else ""
            discrete = "" if kind.startswith("Float") else ' variability="discrete"'
            dimension = f'<Dimension start="{count}"/>' if count > 1 else ""
            variables.append(
                f'<{kind} name="{name}" valueReference="{reference}" causality="{causality}"'
                f"{discrete}{start}>{dimension}</{kind}>"
            )
    for name, reference, start in PARAMETERS:
        variables.append(
            f'<Float64 name="{name}" valueReference="{reference}" causality="parameter" '
            f'variability="fixed" start="{start}"/>'
        )
    structure = "".join(
        f'<{element} valueReference="{reference}" dependencies="{"1" if name == "z" else ""}"/>'
        for element in ("Output", "InitialUnknown")
        for name, _, reference, _ in OUTPUTS
    )
    return (
        f'<?xml version="1.0" encoding="UTF-8"?><fmiModelDescription fmiVersion="3.0" modelName="scripted" '
        f'instantiationToken="scripted"><CoSimulation modelIdentifier="scripted" '
        f'canHandleVariableCommunicationStepSize="true" mightReturnEarlyFromDoStep="true" '
        f'hasEventMode="{str(has_event_mode).lower()}"/>'
        f"<ModelVariables>{''.join(variables)}</ModelVariables><ModelStructure>{structure}</ModelStructure>"
        f"</fmiModelDescription>"
    )


def _fmi2() -> str:
    variables, outputs = [], []
    for causality, rows in (("input", INPUTS), ("output", OUTPUTS)):
        for name, kind, reference, count in rows:
            for i in range(count):
                label = f"{name}[{i + 1}]" if count > 1 else name
                start = f' start="{_start(kind)}"' if causality == "input" else ""
                variability = "continuous" if kind.startswith("Float") else "discrete"
                variables.append(
                    f'<ScalarVariable name="{label}" valueReference="{reference + i}" '
                    f'causality="{causality}" variability="{variability}"><{FMI2_TYPES[kind]}{start}/>'
                    "</ScalarVariable>"
                )
                if causality == "output":
                    outputs.append(f'<Unknown index="{len(variables)}" dependencies="{"1" if name == "z" else ""}"/>')
    for name, reference, start in PARAMETERS:
        variables.append(
            f'<ScalarVariable name="{name}" valueReference="{reference}" causality="parameter" '
            f'variability="fixed"><Real start="{start}"/></ScalarVariable>'
        )
    return (
        f'<?xml version="1.0" encoding="UTF-8"?><fmiModelDescription fmiVersion="2.0" modelName="scripted" '
        f'guid="scripted"><CoSimulation modelIdentifier="scripted" canHandleVariableCommunicationStepSize="true"/>'
        f"<ModelVariables>{''.join(variables)}</ModelVariables>"
        f"<ModelStructure><Outputs>{''.join(outputs)}</Outputs>"
        f"<InitialUnknowns>{''.join(outputs)}</InitialUnknowns></ModelStructure>"
        f"</fmiModelDescription>"
    )
