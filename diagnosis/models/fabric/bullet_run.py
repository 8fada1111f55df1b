"""One run of a fabric alone, driven by the courses that its actuator would give it."""

from __future__ import annotations

import hashlib
import json
import time as clock
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from cosim.components import FabricComponent, nanoseconds
from cosim.compute.result import Result
from cosim.mechanics_assembly import build_fabric
from cosim.parameters import resolve
from cosim.scenario import Scenario
from cosim.unit.protocol import Array, StepStatus, UnitError
from cosim.unit.quantity import PhysicalValue
from diagnosis.recording.quantity import Target
from diagnosis.search.cosim_run import Changes, predicted, program_hash
from mechanics.unit import FabricUnit

#: Outputs of a fabric that channels can measure.
_KEPT = (
    "extension",
    "tension",
    "link_length",
    "position",
    "marker_position",
    "row_centre",
    "max_curvature",
    "fabric_length",
    "kinetic_energy",
    "potential_energy",
)


@dataclass(frozen=True)
class Courses:
    """What acts on a fabric, one row per macro-step.

    Args:
        stiffness: Of every coil [N/m], shape (steps, coils).
        rest_length: Of every coil [m], shape (steps, coils).
    """

    stiffness: Array
    rest_length: Array


@dataclass(frozen=True)
class FabricSetting:
    """A fabric under the conditions of one recording.

    Args:
        scenario: With every parameter set resolved.
        component: Name of the fabric.
        courses: What acts on it.
        strings: Coils of every string, so that `coil[2,5]` can be named.
        targets: What the channels measure.
        times: Times of their samples [s].
        source: File that names the channels, for errors.
    """

    scenario: Scenario
    component: str
    courses: Courses
    strings: tuple[int, ...]
    targets: tuple[Target, ...]
    times: tuple[Array, ...]
    source: Path

    def key(self) -> str:
        """Hash of all that decides what it does."""
        digest = hashlib.sha256(program_hash().encode())
        alone = self.scenario.components[self.component].model_dump(mode="json")
        digest.update(json.dumps([alone, self.scenario.time.model_dump(mode="json")], sort_keys=True).encode())
        digest.update(self.courses.stiffness.tobytes() + self.courses.rest_length.tobytes())
        for target, times in zip(self.targets, self.times):
            digest.update(str(target).encode() + times.tobytes())
        return digest.hexdigest()


def simulate_fabric(settings: Sequence[FabricSetting], given: tuple[int, Changes]) -> Result:
    """Run one fabric with changes: values of every channel at its samples, SI.

    Args:
        settings: Fabrics of a batch.
        given: Number of the fabric, and what differs from its scenario.

    Raises:
        InputError: The fabric has no such quantity.
    """
    number, changes = given
    own, begin = settings[number], clock.perf_counter()
    try:
        unit = _unit(own, changes.parameters.get(own.component, {}))
        try:
            results = _run(unit, own)
        finally:
            unit.terminate()
    except (UnitError, ValueError) as error:  # a value with which it cannot be built, or go on
        return Result((), str(error), clock.perf_counter() - begin)
    arrays = tuple(predicted(results, t, times, own.source) for t, times in zip(own.targets, own.times))
    return Result(arrays, "", clock.perf_counter() - begin)


def _unit(own: FabricSetting, parameters: Mapping[str, PhysicalValue]) -> FabricUnit:
    component = own.scenario.components[own.component]
    assert isinstance(component, FabricComponent)
    component = component.model_copy(update={"parameters": {**component.parameters, **parameters}})
    values = resolve(component.parameter_set, component.parameters, own.scenario.path or Path("scenario.yaml"))
    return build_fabric(own.component, component, values)


def _run(unit: FabricUnit, own: FabricSetting) -> xr.Dataset:
    """As `cosim.run` steps it: constant inputs over a macro-step, checkpoints at the scenario's interval."""
    time, courses = own.scenario.time, own.courses
    start, macro = nanoseconds(time.start), nanoseconds(time.macro_step)
    per_output = nanoseconds(time.output_step) // macro
    per_checkpoint = nanoseconds(time.checkpoint_step) // macro
    _set(unit, courses, 0)
    unit.initialise(start)
    kept: dict[str, list[Array]] = {name: [unit.get(name).copy()] for name in _KEPT}
    steps = len(courses.stiffness)
    for index in range(steps):
        _set(unit, courses, index)
        outcome = unit.do_step(start + index * macro, macro)
        assert outcome.status is StepStatus.OK
        if (index + 1) % per_output == 0:
            for name, values in kept.items():
                values.append(unit.get(name).copy())
        if (index + 1) % per_checkpoint == 0 and index + 1 < steps:
            unit.checkpoint()  # rebuilds Bullet's world, which a run must not depend on
    outputs = 1e-9 * (start + macro * per_output * np.arange(len(kept["position"])))
    found = {
        f"{own.component}.{name}": xr.DataArray(
            np.array(values), dims=("time", *unit.variables[name].dims), attrs={"units": unit.variables[name].unit}
        )
        for name, values in kept.items()
    }
    coil = np.repeat(np.arange(1, len(own.strings) + 1), own.strings)
    coordinates = {"string_of_coil": ("coil", coil)} if own.strings else {}
    return xr.Dataset(found, coords={"time": outputs, **coordinates})


def _set(unit: FabricUnit, courses: Courses, index: int) -> None:
    unit.set("stiffness", courses.stiffness[index])
    unit.set("rest_length", courses.rest_length[index])
