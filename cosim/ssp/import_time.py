"""Times and algorithm of an imported system: what the SSP says, what the user gave, and what neither says."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from cosim.components import nanoseconds
from cosim.scenario import default_checkpoint_step
from cosim.ssp.model import Structure
from cosim.unit.quantity import PhysicalValue


@dataclass(frozen=True)
class TimeRequest:
    """What the user gives where an SSP leaves it open, or instead of what it says.

    Args:
        start: Start time, for example `0 s`.
        stop: Stop time.
        macro_step: Communication step.
        output_step: Interval of recorded values.
        algorithm: Kind of algorithm.
    """

    start: str | None = None
    stop: str | None = None
    macro_step: str | None = None
    output_step: str | None = None
    algorithm: str | None = None


def times(structure: Structure, request: TimeRequest, can_serialise: bool, notes: list[str]) -> dict[str, Any]:
    """`time` of the scenario.

    Raises:
        InputError: Neither the SSP nor the request gives a stop time or a step.
    """
    own = dict(structure.own.get("time", {}))
    if structure.start is not None:
        own.setdefault("start", f"{structure.start!r} s")
    if structure.stop is not None:
        own["stop"] = own.get("stop", f"{structure.stop!r} s")
    if structure.step is not None and "macro_step" not in own:
        own["macro_step"] = f"{structure.step!r} s"
        notes.append(f"macro_step {structure.step:g} s: from another tool's annotation")
    for key in ("start", "stop", "macro_step", "output_step"):
        if getattr(request, key) is not None:
            own[key] = getattr(request, key)
    for key, option in (("stop", "--stop"), ("macro_step", "--step")):
        if key not in own:
            raise structure.place.error(
                f"the SSP gives no {'stop time' if key == 'stop' else 'step size'}",
                f"import it with `cosim ssp import`, and give `{option}`",
            )
    if "output_step" not in own:
        own["output_step"] = own["macro_step"]
    if "checkpoint_step" not in own:
        own["checkpoint_step"] = _checkpoint_step(own, can_serialise, notes)
    return {key: own[key] for key in ("start", "stop", "macro_step", "output_step", "checkpoint_step") if key in own}


def _checkpoint_step(time: dict[str, Any], can_serialise: bool, notes: list[str]) -> str:
    """The scenario's own default; beyond the end where an FMU cannot write its state."""
    start, stop, output = (
        nanoseconds(PhysicalValue.parse(time.get(k, "0 s"))) for k in ("start", "stop", "output_step")
    )
    if can_serialise:
        return f"{default_checkpoint_step(stop - start, output) / 1e9!r} s"
    notes.append("no checkpoints: an FMU cannot serialise its state, so an interrupted run begins once more")
    return f"{-(-max(stop - start, output) // output) * output / 1e9!r} s"


def algorithm(structure: Structure, request: TimeRequest, notes: list[str]) -> dict[str, Any]:
    """`algorithm` of the scenario; Jacobi where nothing says, for it alone does not depend on the order of elements."""
    if request.algorithm is not None:
        return {"kind": request.algorithm}
    own = structure.own.get("algorithm")
    if own is not None:
        return dict(own)
    notes.append("algorithm jacobi: SSP does not say how the components are stepped")
    return {"kind": "jacobi"}
