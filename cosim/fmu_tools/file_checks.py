"""Checks of an FMU that execute nothing in it: description, binary, symbols, libraries, interface."""

from __future__ import annotations

import platform
import re
import shutil
import subprocess
from pathlib import Path

import fmpy
from fmpy.validation import validate_fmu

from cosim.actuator.interface import faults
from cosim.fmu.archive import FmuArchive, open_fmu
from cosim.fmu.gathering import fmu_variables
from cosim.fmu.shared_library import fault_of_name, library
from cosim.fmu.units import UnitNames
from cosim.fmu_tools.info import looks_like_actuator
from cosim.fmu_tools.isolated import Skipped
from cosim.unit.protocol import Variable

_CONTINUOUS = {
    "EnterContinuousTimeMode",
    "CompletedIntegratorStep",
    "SetTime",
    "SetContinuousStates",
    "GetEventIndicators",
    "GetContinuousStates",
    "GetNominalsOfContinuousStates",
}
#: Functions that only one interface has, by version (FMI 2.0.4, sections 3.2 and 4.2; FMI 3.0, sections 3.2 and 4.2).
MODEL_EXCHANGE = {
    "2": _CONTINUOUS | {"EnterEventMode", "NewDiscreteStates", "GetDerivatives"},
    "3": _CONTINUOUS
    | {
        "InstantiateModelExchange",
        "GetContinuousStateDerivatives",
        "GetNumberOfContinuousStates",
        "GetNumberOfEventIndicators",
    },
}
CO_SIMULATION = {
    "2": {
        "SetRealInputDerivatives",
        "GetRealOutputDerivatives",
        "DoStep",
        "CancelStep",
        "GetStatus",
        "GetRealStatus",
        "GetIntegerStatus",
        "GetBooleanStatus",
        "GetStringStatus",
    },
    "3": {"InstantiateCoSimulation", "EnterStepMode", "GetOutputDerivatives", "DoStep"},
}


def description(path: Path) -> str:
    """modelDescription.xml passes fmpy's validation (schema, references, units, start values)."""
    problems = validate_fmu(str(path))
    if problems:
        raise ValueError("; ".join(" ".join(p.split()) for p in problems[:3]))
    return "fmpy finds no problems"


def _binary(archive: FmuArchive) -> Path:
    d = archive.description
    kind = d.coSimulation or d.modelExchange or d.scheduledExecution
    if kind is None:
        raise ValueError("it declares no interface")
    file = library(archive, kind.modelIdentifier)
    if file is None:
        raise ValueError(fault_of_name(archive, kind.modelIdentifier))
    return file


def binary(path: Path) -> str:
    """There is a shared library for this platform, named after the model identifier."""
    archive = open_fmu(path)
    try:
        return str(_binary(archive).relative_to(archive.directory))
    finally:
        archive.remove()


def symbols(path: Path) -> str:
    """The library exports the functions of its FMI version."""
    if shutil.which("nm") is None or platform.system() != "Linux":
        raise Skipped("needs nm on Linux")
    archive = open_fmu(path)
    try:
        listing = subprocess.run(
            ["nm", "-D", "--defined-only", _binary(archive)], capture_output=True, text=True, check=True
        ).stdout
    finally:
        archive.remove()
    exported = {line.split()[-1] for line in listing.splitlines() if line}
    version = archive.description.fmiVersion[0]
    standard = _standard(version)
    wanted = standard - {f"fmi{version}{name}" for name in _not_offered(archive, version)}
    missing = sorted(wanted - exported)
    if missing:
        raise ValueError(f"{len(missing)} of {len(wanted)} functions are missing: {', '.join(missing[:4])}")
    others = len(exported - standard)
    return f"all {len(wanted)} functions of FMI {version}" + (f", and {others} other symbols" if others else "")


def _standard(version: str) -> set[str]:
    """All functions of a version of FMI, from its header."""
    header = (Path(fmpy.__file__).parent / "c-code" / f"fmi{version}Functions.h").read_text()
    return set(re.findall(rf"#define (fmi{version}\w+)\s+fmi{version}FullName\(fmi{version}\w+\)", header))


def _not_offered(archive: FmuArchive, version: str) -> set[str]:
    """Functions that belong to interfaces which the FMU does not declare, so that it need not have them."""
    d, left = archive.description, set()
    if d.modelExchange is None:
        left |= MODEL_EXCHANGE[version]
    if d.coSimulation is None:
        left |= CO_SIMULATION[version]
    if version == "3" and d.scheduledExecution is None:
        left |= {"InstantiateScheduledExecution", "ActivateModelPartition"}
    return left


def libraries(path: Path) -> str:
    """Every library that the binary needs is found."""
    if shutil.which("ldd") is None:
        raise Skipped("needs ldd")
    archive = open_fmu(path)
    try:
        done = subprocess.run(["ldd", _binary(archive)], capture_output=True, text=True, check=False)
    finally:
        archive.remove()
    missing = [line.split()[0] for line in done.stdout.splitlines() if "not found" in line]
    if missing:
        raise ValueError(f"not found: {', '.join(missing)}")
    needed = [line.split()[0] for line in done.stdout.splitlines() if "=>" in line]
    return "needs " + (", ".join(needed) or "nothing")


def _variables(path: Path) -> dict[str, Variable]:
    archive = open_fmu(path)
    try:
        found = fmu_variables(archive.description, {}, UnitNames(archive.description))
    finally:
        archive.remove()
    return {n: v.variable for n, v in found.items()}


def is_actuator(path: Path) -> bool:
    """Whether its outputs say that it is meant to be an actuator."""
    return looks_like_actuator(_variables(path))


def interface(path: Path) -> str:
    """It has the interface of an actuator."""
    variables = _variables(path)
    if not looks_like_actuator(variables):
        raise Skipped("no actuator: it has none of the outputs stiffness, rest_length, resistance")
    wrong = faults(variables)
    if wrong:
        raise ValueError("; ".join(wrong))
    return "interchangeable with the shipped actuators"
