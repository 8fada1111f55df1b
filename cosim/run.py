"""Run a scenario: `run(load_scenario(path))` returns an xarray dataset."""

from __future__ import annotations

import logging
import time as clock
from collections.abc import Callable, Mapping, Sequence
from contextlib import chdir
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from cosim.alone import alone
from cosim.assemble import Assembly, assemble
from cosim.components import nanoseconds
from cosim.estimate import recorded_bytes, refuse_too_large
from cosim.interrupt import Interrupt, deferred_interrupt
from cosim.loop import Loop, Watched, choose_loop
from cosim.native.plan import Grid
from cosim.observers.energy_balance import EnergyMeter
from cosim.observers.ranges import outside_ranges
from cosim.observers.trace import Trace
from cosim.run_folder import RunFolder, read_checkpoint, useless_checkpoint
from cosim.scenario import Scenario
from cosim.system import ConnectionFault, System
from cosim.unit.errors import InputError
from cosim.unit.protocol import StepStatus, UnitError, seconds

_LOG = logging.getLogger(__name__)


@dataclass(frozen=True)
class Progress:
    """How far a run is.

    Args:
        done: Macro-steps made.
        total: Macro-steps in all.
        time: Simulated time [s].
        elapsed: Wall time since the start or the resumption [s].
        simulated: Simulated time since then [s].
        step: Macro-step [s].
    """

    done: int
    total: int
    time: float
    elapsed: float
    simulated: float
    step: float

    @property
    def remaining(self) -> float:
        """Estimated wall time left [s]."""
        made = self.simulated / self.step
        return (self.total - self.done) * self.elapsed / made if made else 0.0


class RunStopped(Exception):
    """The run stopped before its end; what was computed is kept.

    Args:
        reason: What, where and when.
        recorded: What was recorded so far.
        is_interrupt: Whether the user interrupted it.
    """

    def __init__(self, reason: str, recorded: Recorded, is_interrupt: bool) -> None:
        super().__init__(reason)
        self.reason, self.is_interrupt, self.recorded = reason, is_interrupt, recorded

    @cached_property
    def dataset(self) -> xr.Dataset:
        """Values recorded so far."""
        return self.recorded.dataset()


@dataclass(frozen=True)
class Recorded:
    """What a run has recorded.

    Args:
        trace: Values and times.
        attributes: Title, status, wall times, energy balance.
        outside: What left its declared range, a sentence each.
    """

    trace: Trace
    attributes: Mapping[str, Any]
    outside: Sequence[str]

    def dataset(self) -> xr.Dataset:
        """As `run` returns it."""
        dataset = self.trace.dataset()
        dataset.attrs.update(self.attributes)
        return dataset


@dataclass
class _Clockwork:
    """State of a run in progress."""

    scenario: Scenario
    assembly: Assembly
    trace: Trace
    meter: EnergyMeter
    start: int
    macro: int
    loop: Loop
    index: int = 0
    written: int = 0
    is_resumed: bool = False
    #: Wall time of the checkpoints, and how many [s].
    checkpoint_time: float = 0.0
    checkpoint_count: int = 0
    begin: float = field(default_factory=clock.perf_counter)
    first_index: int = 0

    @property
    def total(self) -> int:
        return (nanoseconds(self.scenario.time.stop) - self.start) // self.macro

    @property
    def now(self) -> int:
        return self.start + self.index * self.macro


def run(
    scenario: Scenario,
    out: Path | None = None,
    resume: bool = False,
    on_progress: Callable[[Progress], None] | None = None,
    csv: bool = False,
    overwrite: bool = False,
) -> xr.Dataset:
    """Run a scenario to its end.

    Args:
        scenario: What to run.
        out: Run folder; None keeps everything in memory.
        resume: Go on from the last checkpoint in `out`.
        on_progress: Called about twenty times a second, or after every macro-step that takes longer.
        csv: Write all recorded values to `out` as CSV too, also those of a run that stops early.
        overwrite: Replace the run that `out` holds, once this one has begun.

    Returns:
        Every recorded variable `component.name` with dimension `time` [s] first; attributes hold title, wall time of
        every unit [s] and the energy balance [J].

    Raises:
        InputError: Something in the scenario, an FMU or the folder is wrong.
        RunStopped: A unit failed, the disk is full or the user interrupted; the values so far are in it and, where
            they could be written, in the folder.
    """
    return record(scenario, out, resume, on_progress, csv, overwrite).dataset()


def record(
    scenario: Scenario,
    out: Path | None = None,
    resume: bool = False,
    on_progress: Callable[[Progress], None] | None = None,
    csv: bool = False,
    overwrite: bool = False,
) -> Recorded:
    """Run a scenario as `run` does; the values are not put together to a dataset, which takes time and memory.

    A long run with a folder keeps its values in a file there while it goes on, not in memory.

    Raises:
        InputError, RunStopped: As `run`.
    """
    if out is None:
        return _run(scenario, None, resume, on_progress)
    # An FMU may change the working folder: files are found all the same, and who called is where he was.
    folder = RunFolder(out.absolute(), csv, overwrite)
    folder.prepare_writing()
    with chdir(Path.cwd()), alone(folder.path, "run"):
        return _run(scenario, folder, resume, on_progress)


def _run(
    scenario: Scenario, folder: RunFolder | None, resume: bool, on_progress: Callable[[Progress], None] | None
) -> Recorded:
    if resume:
        _check_resumable(folder)
    elif folder is not None:
        folder.refuse_existing()
    assembly = assemble(scenario)
    try:
        if folder is not None and resume:
            folder.refuse_other(assembly.scenario, assembly.parameters)
        state = _begin(scenario, assembly, folder, resume)
        # Files are written once all units are initialised: a run that cannot begin leaves none behind.
        if folder is not None and not resume:
            folder.create(assembly.scenario, assembly.parameters, assembly.versions)
        return _run_to_end(state, folder, on_progress)
    finally:
        assembly.system.terminate()


def _check_resumable(folder: RunFolder | None) -> None:
    if folder is None or not folder.scenario.is_file():
        raise InputError(
            folder.path if folder else "run",
            "",
            "there is no run and no checkpoint to resume from",
            "run it without `--resume`",
        )
    if folder.is_complete():
        raise InputError(folder.path, "", "this run is complete", "look at it with `cosim plot`")


def _begin(scenario: Scenario, assembly: Assembly, folder: RunFolder | None, resume: bool) -> _Clockwork:
    start, stop = nanoseconds(scenario.time.start), nanoseconds(scenario.time.stop)
    output = nanoseconds(scenario.time.output_step)
    macro = nanoseconds(scenario.time.macro_step)
    outputs = range(start, stop + 1, output)
    if not resume:  # of one that goes on, the checkpoints are there already
        where = None if folder is None else folder.path
        refuse_too_large(scenario, recorded_bytes(assembly.system, len(outputs)), len(outputs), where)
    trace = _trace(scenario, assembly.system, outputs, folder)
    meter = EnergyMeter(assembly.system)
    if assembly.algorithm.divides_steps:
        meter.units = []
    watched = Watched(assembly.system, trace, meter, Grid(start, macro, output // macro))
    # A run that was interrupted before its first checkpoint starts once more.
    files = folder.checkpoints() if folder is not None and resume else []
    if not files:
        _initialise(assembly, start, scenario.path or "scenario")
        trace.record(start)
    loop = choose_loop(watched, assembly.algorithm, scenario.algorithm.kind)
    state = _Clockwork(scenario, assembly, trace, meter, start, macro, loop)
    if files:
        _restore(state, files)
    state.begin, state.first_index = clock.perf_counter(), state.index
    return state


def _initialise(assembly: Assembly, start: int, source: object) -> None:
    try:
        assembly.system.initialise(start, assembly.start)
    except ConnectionFault as error:
        raise InputError(source, "connections", str(error), "correct the connection") from error
    except UnitError as error:
        remedy = error.remedy or "correct this component"
        raise InputError(source, f"components.{error.unit}", f"it cannot begin: {error.what}", remedy) from error


def _trace(scenario: Scenario, system: System, times: range, folder: RunFolder | None) -> Trace:
    try:
        return Trace(system, times, None if folder is None else folder.path)
    except (MemoryError, OSError, OverflowError, ValueError) as error:
        where = "memory" if folder is None or isinstance(error, MemoryError) else str(folder.path)
        raise InputError(
            scenario.path or "scenario",
            "time.output_step",
            f"{len(times)} outputs do not fit into {where}",
            "take a longer output_step or a nearer stop" + ("" if where == "memory" else ", or make room"),
        ) from error


def _restore(state: _Clockwork, files: Sequence[Path]) -> None:
    """Everything as it was at the last checkpoint.

    Raises:
        InputError: A checkpoint is missing or useless, or a unit does not take its state.
    """
    content: dict[str, np.ndarray[Any, Any]] = {}
    for file in files:
        content = read_checkpoint(file)
        try:
            index, values = int(content["index"]), _part(content, "trace/")
            wanted = index // (nanoseconds(state.scenario.time.output_step) // state.macro) + 1
            rows = {len(v) for v in values.values()}
            if set(values) != set(state.trace.rows) or rows not in ({wanted - state.trace.count}, set()):
                raise useless_checkpoint(file, f"does not go on from the one before, at output {state.trace.count}")
            state.trace.load(values)
            state.trace.count = wanted
        except (KeyError, ValueError, TypeError) as error:
            raise useless_checkpoint(file, f"lacks something or has too much: {error}") from error
    last = files[-1]
    try:
        state.index = int(content["index"])
        state.meter.electrical, state.meter.largest = content["energy"].tolist()
        for name, unit in state.assembly.system.units.items():
            unit.resume(_part(content, f"unit/{name}/"), state.now)
            state.assembly.system.wall_time[name] = float(content[f"wall/{name}"])
        state.assembly.algorithm.resume(_part(content, "algorithm/"))
    except (KeyError, ValueError, TypeError) as error:
        raise useless_checkpoint(last, f"lacks something or has too much: {error}") from error
    except UnitError as error:
        raise useless_checkpoint(last, f"is refused by {error.unit}: {error.what}") from error
    state.written, state.is_resumed = state.trace.count, True


def _part(content: Mapping[str, np.ndarray[Any, Any]], prefix: str) -> dict[str, np.ndarray[Any, Any]]:
    return {key.removeprefix(prefix): value for key, value in content.items() if key.startswith(prefix)}


def _checkpoint(state: _Clockwork, folder: RunFolder | None) -> None:
    """Every unit passes through its checkpoint even without a folder: a run must not depend on whether it is kept."""
    system = state.assembly.system
    content: dict[str, np.ndarray[Any, Any]] = {"index": np.array(state.index)}
    content["energy"] = np.array([state.meter.electrical, state.meter.largest])
    content.update({f"algorithm/{k}": v for k, v in state.assembly.algorithm.checkpoint().items()})
    for name, unit in system.units.items():
        content.update({f"unit/{name}/{k}": v for k, v in unit.checkpoint().items()})
        content[f"wall/{name}"] = np.array(system.wall_time[name])
    if folder is not None:
        content.update({f"trace/{k}": v for k, v in state.trace.chunk(state.written).items()})
        folder.write_checkpoint(state.index, content)
        state.written = state.trace.count


def _run_to_end(
    state: _Clockwork, folder: RunFolder | None, on_progress: Callable[[Progress], None] | None
) -> Recorded:
    reason, is_interrupt = "", False
    try:
        # Every value is checked for being finite, so numpy's warnings of overflow and NaN would only repeat the error.
        with np.errstate(invalid="ignore", over="ignore"), deferred_interrupt() as interrupt:
            _step_to_end(state, folder, on_progress, interrupt)
    except UnitError as error:  # one raised while values are exchanged does not know the time
        moment = state.now if error.time is None else error.time
        reason = str(UnitError(error.unit, error.what, moment, error.remedy))
    except InputError as error:  # a checkpoint that cannot be written
        reason = f"at t = {seconds(state.now):.6g} s: {error}"
    except KeyboardInterrupt:
        reason, is_interrupt = f"interrupted at t = {seconds(state.now):.6g} s", True
    outside = outside_ranges(state.trace)
    recorded = Recorded(state.trace, _attributes(state, reason, outside), outside)
    if folder is not None:
        try:
            folder.write_results(state.trace, recorded.attributes, _summary(state, reason) | {"outside_range": outside})
        except InputError as error:
            reason, is_interrupt = reason or f"at t = {seconds(state.now):.6g} s: {error}", False
    if reason:
        raise RunStopped(reason, recorded, is_interrupt)
    return recorded


def _step_to_end(
    state: _Clockwork, folder: RunFolder | None, on_progress: Callable[[Progress], None] | None, interrupt: Interrupt
) -> None:
    per_checkpoint = nanoseconds(state.scenario.time.checkpoint_step) // state.macro
    has_checkpoints = state.total <= per_checkpoint or _can_checkpoint(state, folder is not None)
    while state.index < state.total:
        due = min((state.index // per_checkpoint + 1) * per_checkpoint, state.total)
        try:
            outcome = state.loop.advance(state.index, due)
        finally:
            state.index = state.loop.index
        if outcome.status is not StepStatus.OK:
            raise UnitError(
                "algorithm",
                f"{outcome.message or outcome.status.value}; {state.scenario.algorithm.kind} cannot repeat a step",
                outcome.time,
                "use a smaller macro_step, or `kind: step_doubling`",
            )
        if state.index == due < state.total and has_checkpoints:
            begin = clock.perf_counter()
            _checkpoint(state, folder)
            state.checkpoint_time += clock.perf_counter() - begin
            state.checkpoint_count += 1
        state.trace.release()
        if on_progress is not None:
            elapsed = clock.perf_counter() - state.begin
            simulated = seconds((state.index - state.first_index) * state.macro)
            on_progress(
                Progress(state.index, state.total, seconds(state.now), elapsed, simulated, seconds(state.macro))
            )
        interrupt.check()


def _can_checkpoint(state: _Clockwork, is_kept: bool) -> bool:
    """Whether all units can write their state; else a run that is kept says so once."""
    unable = [name for name, unit in state.assembly.system.units.items() if not unit.can_checkpoint]
    if unable and is_kept:
        _LOG.warning(
            "%s: an FMU that cannot serialise its state (canSerializeFMUstate), so there are no checkpoints: "
            "a run that is interrupted keeps its results and begins anew",
            ", ".join(unable),
        )
    return not unable


def _attributes(state: _Clockwork, reason: str, outside: Sequence[str]) -> dict[str, Any]:
    found: dict[str, Any] = {
        "title": state.scenario.title,
        "status": reason or "complete",
        "algorithm": state.scenario.algorithm.kind,
        "macro_step_s": seconds(state.macro),
        **{f"wall_time_{name}_s": s for name, s in state.assembly.system.wall_time.items()},
    }
    balance = None if reason else state.meter.balance()
    if balance is not None:
        found |= {
            "energy_electrical_J": balance.electrical,
            "energy_stored_J": balance.stored,
            "energy_convected_J": balance.convected,
            "energy_residual": balance.residual,
        }
    return found | ({"outside_range": "; ".join(outside)} if outside else {})


def _summary(state: _Clockwork, reason: str) -> dict[str, Any]:
    units = dict(state.assembly.system.wall_time)
    balance = None if reason else state.meter.balance()
    return {
        "title": state.scenario.title,
        "status": reason or "complete",
        "simulated_until_s": seconds(state.now),
        "macro_steps": state.index,
        "algorithm": {"kind": state.scenario.algorithm.kind, **state.assembly.algorithm.counts()},
        "loop": state.loop.language,
        "loop_without_python": state.loop.native_share,
        "resumed": state.is_resumed,
        "checkpoints": state.checkpoint_count,
        "wall_time_s": {
            "since_start_or_resumption": clock.perf_counter() - state.begin,
            "checkpoints": state.checkpoint_time,
            "units": units,
        },
        "energy_J": None
        if balance is None
        else {
            "electrical": balance.electrical,
            "stored": balance.stored,
            "convected": balance.convected,
            "relative_residual": balance.residual,
        },
    }
