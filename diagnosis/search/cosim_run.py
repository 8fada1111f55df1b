"""One run of the closed co-simulation with some numbers changed: what another process is given, and what it does."""

from __future__ import annotations

import functools
import hashlib
import json
import time as clock
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

import circuit
import cosim
import diagnosis.recording
import mechanics
from cosim.assemble import assemble
from cosim.components import AddedTermEntry, FmuComponent, ProgrammeOutput
from cosim.compute.result import Result
from cosim.fmu_assembly import find_fmu
from cosim.run import RunStopped, run
from cosim.run_folder import resolved_scenario
from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from cosim.unit.quantity import PhysicalValue
from diagnosis.faults.programme import InputChange, with_changes
from diagnosis.recording.quantity import Target
from diagnosis.recording.recording import Recording
from diagnosis.recording.series import sample, series_of


@dataclass(frozen=True)
class Changes:
    """What differs from a scenario.

    Args:
        parameters: Component to its parameters that have other values.
        shifts: Programme to its outputs that are moved as a whole, and by how much, in the unit of the output.
        lists: Component to its parameters that are lists, each whole.
        faults: Programme to its outputs that were another within an interval.
        added: FMU to terms that are added to those that it has.
    """

    parameters: Mapping[str, Mapping[str, PhysicalValue]] = field(default_factory=dict)
    shifts: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    lists: Mapping[str, Mapping[str, Sequence[PhysicalValue]]] = field(default_factory=dict)
    faults: Mapping[str, Mapping[str, Sequence[InputChange]]] = field(default_factory=dict)
    added: Mapping[str, Sequence[AddedTermEntry]] = field(default_factory=dict)

    def text(self) -> str:
        """Every number to its last bit, in an order that does not depend on how it was put together."""
        parameters = {c: {n: (v.number.hex(), v.unit) for n, v in own.items()} for c, own in self.parameters.items()}
        shifts = {c: {o: float(s).hex() for o, s in own.items()} for c, own in self.shifts.items()}
        lists = {
            c: {n: [(v.number.hex(), v.unit) for v in values] for n, values in own.items()}
            for c, own in self.lists.items()
        }
        faults = {c: {o: [f.key() for f in own[o]] for o in own} for c, own in self.faults.items()}
        added = {c: [t.model_dump(mode="json") for t in terms] for c, terms in self.added.items()}
        more = [lists, faults, added] if added else [lists, faults] if faults else [lists] if lists else []
        return json.dumps([parameters, shifts, *more], sort_keys=True)


@dataclass(frozen=True)
class Setting:
    """One recording, as far as a simulation needs it.

    Args:
        scenario: Under the conditions of the recording.
        targets: What its channels measure.
        times: Times of their samples [s].
        source: File that names the channels, for errors.
        key: Hash of all that and of the program that simulates it.
    """

    scenario: Scenario
    targets: tuple[Target, ...]
    times: tuple[Array, ...]
    source: Path
    key: str

    def task_key(self, changes: Changes) -> str:
        """Hash of a simulation with changes."""
        return hashlib.sha256(f"{self.key} {changes.text()}".encode()).hexdigest()


def setting(scenario: Scenario, recording: Recording) -> Setting:
    """What a simulation of a recording needs.

    Args:
        scenario: Under the conditions of the recording.
        recording: The recording.

    Raises:
        InputError: The scenario cannot be assembled.
    """
    assembly = assemble(scenario)  # later, what cannot be built is a value that makes no sense
    assembly.system.terminate()
    alone = resolved_scenario(scenario, assembly.parameters)
    channels = list(recording.channels.values())
    digest = hashlib.sha256(program_hash().encode())
    digest.update(json.dumps(alone.model_dump(mode="json"), sort_keys=True, default=str).encode())
    for component in scenario.components.values():
        if isinstance(component, FmuComponent):
            digest.update(_content(find_fmu(component, scenario.path or Path())))
    for channel in channels:
        digest.update(str(channel.target).encode() + channel.times.tobytes())
    targets, times = tuple(c.target for c in channels), tuple(c.times for c in channels)
    return Setting(scenario, targets, times, recording.path / "recording.yaml", digest.hexdigest())


def simulate(settings: Sequence[Setting], given: tuple[int, Changes]) -> Result:
    """Run one recording's scenario with changes: values of every channel at its samples, SI.

    Args:
        settings: Of all recordings.
        given: Number of the recording, and what differs.

    Returns:
        One array per channel, or why the run stopped.

    Raises:
        InputError: The run has no such quantity.
        KeyboardInterrupt: The user stopped it.
    """
    number, changes = given
    own = settings[number]
    begin = clock.perf_counter()
    try:
        results = run(changed(own.scenario, changes))
    except RunStopped as stop:
        if stop.is_interrupt:
            raise KeyboardInterrupt from stop
        return Result((), stop.reason, clock.perf_counter() - begin)
    except InputError as error:  # a value at which the unit cannot be built
        return Result((), str(error), clock.perf_counter() - begin)
    arrays = tuple(predicted(results, t, times, own.source) for t, times in zip(own.targets, own.times))
    return Result(arrays, "", clock.perf_counter() - begin)


def predicted(results: xr.Dataset, target: Target, times: Array, source: Path) -> Array:
    """What a run says at the samples of a channel, SI, shape (samples,).

    Raises:
        InputError: The run has no such quantity.
    """
    return sample(series_of(results, target, source), times)


def changed(scenario: Scenario, changes: Changes) -> Scenario:
    """The scenario with other parameters, and with outputs of programmes moved."""
    components: dict[str, Any] = dict(scenario.components)
    for name, values in changes.parameters.items():
        own = components[name]
        components[name] = own.model_copy(update={"parameters": {**own.parameters, **values}})
    for name, lists in changes.lists.items():
        own = components[name]
        whole = {n: list(values) for n, values in lists.items()}
        components[name] = own.model_copy(update={"parameters": {**own.parameters, **whole}})
    for name, moved in changes.shifts.items():
        own = components[name]
        outputs = {o: shifted(g, moved.get(o, 0.0)) for o, g in own.outputs.items()}
        components[name] = own.model_copy(update={"outputs": outputs})
    for name, faults in changes.faults.items():
        own = components[name]
        outputs = {o: with_changes(g, faults[o], scenario) if o in faults else g for o, g in own.outputs.items()}
        components[name] = own.model_copy(update={"outputs": outputs})
    for name, terms in changes.added.items():
        own = components[name]
        components[name] = own.model_copy(update={"added_terms": [*own.added_terms, *terms]})
    return scenario.model_copy(update={"components": components})


def shifted(given: ProgrammeOutput, amount: float) -> ProgrammeOutput:
    """The output moved as a whole, by an amount in its unit."""
    if not amount:
        return given

    def later(value: PhysicalValue | list[PhysicalValue]) -> PhysicalValue | list[PhysicalValue]:
        if isinstance(value, list):
            return [PhysicalValue(v.to(given.unit) + amount, given.unit) for v in value]
        return PhysicalValue(value.to(given.unit) + amount, given.unit)

    if given.constant is not None:
        return given.model_copy(update={"constant": later(given.constant)})
    return given.model_copy(update={"points": [(t, later(v)) for t, v in given.points or []]})


@functools.cache
def program_hash() -> str:
    """Hash of every file that a simulation runs through: a result of another program is not taken from the disk."""
    digest = hashlib.sha256(np.__version__.encode())
    for package in (circuit, cosim, mechanics, diagnosis.recording):
        for file in _sources(Path(str(package.__file__)).parent):
            digest.update(file.name.encode() + file.read_bytes())
    return digest.hexdigest()


def _sources(folder: Path) -> Iterator[Path]:
    return iter(sorted(p for p in folder.rglob("*") if p.suffix in (".py", ".c", ".h")))


def _content(path: Path) -> bytes:
    """Content of an FMU, packed or unpacked."""
    files = [path] if path.is_file() else sorted(p for p in path.rglob("*") if p.is_file())
    return b"".join(file.read_bytes() for file in files)
