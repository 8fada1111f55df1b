"""Checks of an FMU that run it; each one in a process of its own (`cosim.fmu_tools.isolated`)."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np

from cosim.fmu.archive import FmuArchive, open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.model_exchange import ModelExchangeUnit
from cosim.fmu.unit import FmuSettings, FmuUnit
from cosim.fmu_tools.file_checks import is_actuator
from cosim.fmu_tools.isolated import Skipped
from cosim.unit.protocol import NANOSECONDS, AnyArray, Causality, UnitError

#: What an actuator is driven with; other FMUs keep their start values.
DRIVE = {"power": 0.4, "voltage": 0.8, "tension": 1.0, "extension": 0.005, "ambient_temperature": 295.15}
STEP, STEPS = NANOSECONDS // 100, 20
#: Largest difference between the interfaces, relative to the largest value. CVODE's tolerance is 1e-8 of a state's
#: nominal value; energies are a hundredth of theirs after these steps, and errors add up over 20 of them.
SAME = 2e-5

Trace = dict[str, list[AnyArray]]


def _unit(path: Path, interface: str | None = None, archive: FmuArchive | None = None) -> FmuUnit:
    archive = archive or open_fmu(path, is_shared=False)
    has_cs = archive.description.coSimulation is not None
    kind = ModelExchangeUnit if interface == "model_exchange" or not has_cs else CoSimulationUnit
    unit = kind(path.stem, archive, FmuSettings())
    if is_actuator(path):
        for name, value in DRIVE.items():
            if name in unit.variables:
                unit.set(name, np.full(unit.variables[name].shape, value))
    return unit


def _begun(path: Path, interface: str | None = None) -> FmuUnit:
    unit = _unit(path, interface)
    unit.initialise(0)
    unit.exit_initialisation()
    return unit


def _advance(unit: FmuUnit, first: int, steps: int) -> Trace:
    outputs = [n for n, v in unit.variables.items() if v.causality is Causality.OUTPUT]
    trace: Trace = {n: [] for n in outputs}
    for index in range(first, first + steps):
        unit.do_step(index * STEP, STEP)
        unit.refresh()
        for name in outputs:
            trace[name].append(np.array(unit.get(name)))
    return trace


def _trace(path: Path, interface: str) -> Trace:
    unit = _begun(path, interface)
    trace = _advance(unit, 0, STEPS)
    unit.terminate()
    return trace


def _first_difference(one: Trace, other: Trace) -> str | None:
    for name, values in one.items():
        for step, (a, b) in enumerate(zip(values, other[name], strict=True), start=1):
            if not np.array_equal(a, b):
                return f"{name} differs at step {step}"
    return None


def steps(path: Path) -> str:
    """It initialises, steps, and gives finite outputs."""
    unit = _begun(path)
    _advance(unit, 0, STEPS)
    unit.terminate()
    return f"{STEPS} steps of {STEP / NANOSECONDS:g} s"


def repeats(path: Path) -> str:
    """Two instances in one process, stepped in turn, give the same values to the last bit."""
    archive = open_fmu(path)
    kind = archive.description.coSimulation or archive.description.modelExchange
    archive.remove()
    if kind.canBeInstantiatedOnlyOncePerProcess:
        raise Skipped("it allows one instance per process")
    # Both share the extracted files: the library is loaded once, with one set of global variables. Each unit gives its
    # own archive up; the library is closed with the last.
    one, other = (_unit(path, archive=open_fmu(path)) for _ in range(2))
    for unit in (one, other):
        unit.initialise(0)
        unit.exit_initialisation()
    for index in range(STEPS):
        difference = _first_difference(_advance(one, index, 1), _advance(other, index, 1))
        if difference:
            raise ValueError(f"instances share something: {difference} (step {index + 1} of the run)")
    one.terminate()
    other.terminate()
    return "two instances side by side agree to the last bit"


def refuses_nan(path: Path) -> str:
    """Every floating-point input refuses NaN and infinity, and goes on afterwards."""
    unit = _begun(path)
    inputs = [n for n, v in unit.variables.items() if v.causality is Causality.INPUT and v.type.is_float]
    if not inputs:
        raise Skipped("no floating-point input")
    rest = "and the next step is good"
    for name, bad in itertools.product(inputs, (np.nan, np.inf)):
        buffer = unit.buffers.values[name]
        before = np.array(buffer)
        buffer.reshape(-1)[-1:] = bad
        try:
            unit.writers[name]()
        except UnitError as error:
            if "fatal" in error.what:  # FMI allows no further call to this instance
                unit, rest = _begun(path), "fatally: the run ends there"
            else:
                buffer[...] = before
        else:
            raise ValueError(f"it takes {name} = {bad}")
    _advance(unit, 0, 1)
    unit.terminate()
    return f"{', '.join(inputs)}: NaN and infinity refused, {rest}"


def refuses_wrong_order(path: Path) -> str:
    """A step before initialisation returns an error."""
    unit = _unit(path, "co_simulation")
    if not isinstance(unit, CoSimulationUnit):
        raise Skipped("no Co-Simulation")
    try:
        unit.binding.do_step(0.0, 0.01)
    except UnitError as error:
        unit.terminate()
        return " ".join(error.what.split())
    raise ValueError("it steps before it is initialised")


def replays(path: Path) -> str:
    """A restored state has the same future, to the last bit; so has a serialised one in a fresh instance."""
    unit = _begun(path)
    if not unit.can_restore:
        raise Skipped("it declares no canGetAndSetFMUState")
    _advance(unit, 0, 5)
    saved = unit.save()
    future = _advance(unit, 5, STEPS)
    unit.restore(saved, 5 * STEP)
    difference = _first_difference(future, _advance(unit, 5, STEPS))
    if difference:
        raise ValueError(f"after restoring, {difference}")
    unit.release(saved)
    said = "restored"
    if unit.binding.capabilities.canSerializeFMUstate:
        unit.terminate()
        first = _begun(path)
        _advance(first, 0, 5)
        checkpoint = first.checkpoint()
        first.terminate()
        fresh = _unit(path)
        fresh.resume(checkpoint, 5 * STEP)
        difference = _first_difference(future, _advance(fresh, 5, STEPS))
        if difference:
            raise ValueError(f"after serialising, {difference}")
        said = "restored and serialised"
    return f"{said}: the next {STEPS} steps are the same to the last bit"


def interfaces_agree(path: Path) -> str:
    """Co-Simulation and Model Exchange (CVODE) give the same outputs."""
    archive = open_fmu(path)
    both = archive.description.coSimulation is not None and archive.description.modelExchange is not None
    archive.remove()
    if not both:
        raise Skipped("it has one interface only")
    one, other = (_trace(path, interface) for interface in ("co_simulation", "model_exchange"))
    worst, where = 0.0, ""
    for name, values in one.items():
        off = _difference(np.array(values), np.array(other[name]))
        if off > worst:
            worst, where = off, name
    if worst > SAME:
        size = f"by {worst:.1e} of its size, more than {SAME:g}" if np.isfinite(worst) else "between them"
        raise ValueError(f"{where} differs {size}")
    return f"largest difference {worst:.1e} of the size" + (f" ({where})" if where else "")


def _difference(one: AnyArray, other: AnyArray) -> float:
    """Largest difference relative to the largest value; infinite where one alone is no finite number, or no number."""
    if one.dtype.kind != "f":
        return 0.0 if np.array_equal(one, other) else np.inf
    if np.array_equal(one, other, equal_nan=True):
        return 0.0
    off = float(np.abs(one - other).max()) / (float(np.abs(one).max()) or 1.0)
    return off if np.isfinite(off) else np.inf
