"""What can be told of a sweep before its first run: outputs that no run will have, keys that hide each other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from cosim.assemble import Assembly
from cosim.nearest import did_you_mean
from cosim.scenario import Scenario
from cosim.sweep.file import Output, Recorded, SweepFile
from cosim.sweep.keys import parts_of
from cosim.sweep.outputs import ENERGY, ROW_BEND, TIP_SAG
from cosim.unit.errors import InputError
from cosim.unit.protocol import Unit
from cosim.unit.quantity import conversion
from cosim.unit.variable import Causality


def check_keys(keys: Sequence[str], scenario: Scenario, source: Path) -> None:
    """Refuse keys of which one sets what lies below another: what is set would depend on their order.

    Raises:
        InputError: A key is no path, or two keys are the same or lie below each other.
    """
    data = {"components": dict(scenario.components)}
    try:
        paths = {key: parts_of(key, data) for key in keys}
    except ValueError as error:
        raise InputError(source, "axes", str(error), "write the path of a key of the scenario") from error
    for i, key in enumerate(keys):
        for other in keys[i + 1 :]:
            one, two = sorted((key, other), key=lambda k: len(paths[k]))
            if paths[two][: len(paths[one])] == paths[one]:
                same = paths[one] == paths[two]
                problem = (
                    f"`{one}` is set twice, so that one value would never be used"
                    if same
                    else f"`{two}` lies below `{one}`, which sets it too"
                )
                remedy = "let one axis set it; keys that change together belong into one `zip`"
                raise InputError(source, "axes", problem, remedy)


def check_outputs(sweep: SweepFile, assembly: Assembly, path: Path) -> None:
    """Refuse outputs and series that no run can have, by the units of the first run.

    Raises:
        InputError: There is no such quantity, element or time, or its unit is another.
    """
    for kind, given in (("outputs", sweep.outputs), ("series", sweep.series)):
        for name, asked in given.items():
            try:
                check_output(asked, assembly)
            except ValueError as error:
                raise InputError(path, f"{kind}.{name}", str(error), "docs/sweeps.md explains every key") from error


def check_output(asked: Output | Recorded, assembly: Assembly) -> None:
    """Refuse what no run can have; raises ValueError: there is no such quantity, element or time, or another unit."""
    units = assembly.system.units
    unit, size = _kind(asked.quantity, units)
    if isinstance(asked.of, int) and asked.of > size:
        raise ValueError(f"`{asked.quantity}` has {size} elements; there is no element {asked.of}")
    if not isinstance(asked, Output):
        return
    if asked.unit is not None and asked.over != "integral":
        conversion(unit or "1", asked.unit)
    time = assembly.scenario.time
    begin, end = time.start.to("s"), time.stop.to("s")
    slack = 0.5 * time.output_step.to("s")
    for key, moment in (("at", asked.at), ("from", asked.from_), ("to", asked.to)):
        if moment is not None and not begin - slack <= moment.to("s") <= end + slack:
            raise ValueError(f"{key}: {moment} lies outside the run, which goes from {begin:g} s to {end:g} s")
    if asked.from_ is not None and asked.to is not None and asked.from_.to("s") > asked.to.to("s"):
        raise ValueError(f"from: {asked.from_} is later than `to`, {asked.to}")


def unit_of(quantity: str, assembly: Assembly) -> str:
    """Unit of a quantity, as it is recorded; raises ValueError where there is no such quantity."""
    return _kind(quantity, assembly.system.units)[0] or "1"


def _kind(quantity: str, units: Mapping[str, Unit]) -> tuple[str, int]:
    """Unit and number of elements of a quantity."""
    if quantity == ENERGY:
        return "J", 1
    component, _, last = quantity.rpartition(".")
    owner = units.get(component)
    if owner is not None and last in (TIP_SAG, ROW_BEND) and "row_centre" in owner.variables:
        return ("m", 1) if last == TIP_SAG else ("rad", owner.variables["row_centre"].shape[0])
    known = {
        f"{n}.{v.name}": v
        for n, u in units.items()
        for v in u.variables.values()
        if v.causality in (Causality.OUTPUT, Causality.LOCAL) and v.recorded
    }
    if quantity not in known:
        derived = [f"{n}.{q}" for n, u in units.items() if "row_centre" in u.variables for q in (ROW_BEND, TIP_SAG)]
        outputs = (n for n, v in known.items() if v.causality is Causality.OUTPUT)
        found = [*sorted([*outputs, *derived]), ENERGY]
        hint = did_you_mean(quantity, [*known, *derived, ENERGY])
        there = f"{hint} There are" if hint else "; there are"
        raise ValueError(f"no run of this scenario has a quantity `{quantity}`{there}: {', '.join(found)}")
    variable = known[quantity]
    return variable.unit, int(np.prod(variable.shape, dtype=int))
