"""Which outputs follow which inputs at once, asked of the FMUs themselves.

An FMU that lists no dependencies is taken to have them all (FMI 2.0 section 2.2.8, FMI 3.0 section 2.4.8). Two such
FMUs that drive each other would be an algebraic loop, although hardly any is: many tools export none of the lists.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cosim.fmu.unit import FmuUnit
from cosim.system import System
from cosim.unit.protocol import AnyArray

#: Changes of an input that are tried, in its size and in its unit: a small one, and one that leaves a dead zone.
CHANGES = (1e-3, -1e-3, 1.0, -1.0)


def follow_at_once(unit: FmuUnit) -> Mapping[str, frozenset[str]]:
    """Output to the inputs that change it while no time passes, of those that its description allows.

    Inputs that are no floating-point numbers stay as the description has them.

    Args:
        unit: Initialised; its inputs are set back.
    """
    found: dict[str, set[str]] = {output: set() for output in unit.feedthrough}
    for name in sorted(set().union(*unit.feedthrough.values())):
        before = np.array(unit.get(name))
        outputs = [o for o, inputs in unit.feedthrough.items() if name in inputs]
        is_real = before.dtype == np.float64
        for output in _changed(unit, name, before, outputs) if is_real else outputs:
            found[output].add(name)
    return {output: frozenset(inputs) for output, inputs in found.items() if inputs}


def _changed(unit: FmuUnit, name: str, before: AnyArray, outputs: list[str]) -> list[str]:
    """Outputs that another value of an input changes."""
    unit.refresh()
    first = {o: np.array(unit.get(o)) for o in outputs}
    found = []
    for change in CHANGES:
        unit.set(name, before + change * np.maximum(np.abs(before), 1.0))
        unit.refresh()
        found += [o for o in outputs if o not in found and not np.array_equal(unit.get(o), first[o])]
    unit.set(name, before)
    unit.refresh()
    return found


def with_measured_feedthrough(system: System) -> System:
    """The system with the direct feedthrough that its FMUs show, in place of what they declare.

    Args:
        system: Initialised, its simulation not begun.
    """
    for unit in system.units.values():
        if isinstance(unit, FmuUnit) and unit.feedthrough:
            unit.feedthrough = dict(follow_at_once(unit))
    return System(system.units, system.connections, system.sources)
