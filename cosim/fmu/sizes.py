"""How large an FMU may be: its own numbers decide about memory, so they are checked before any is taken."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cosim.fmu.variables import FmuVariable

#: Elements of one array, and of all inputs, outputs and recorded variables of an FMU (256 MiB of Float64).
MOST_ELEMENTS = 1 << 25
#: Dimensions of one array; numpy has 64, and one is the time.
MOST_DIMENSIONS = 32
#: Bytes of a serialised state, and of one Binary value (1 GiB).
MOST_BYTES = 1 << 30
#: Continuous states, and event indicators (32 MiB of Float64 each, and CVODE holds some ten copies).
MOST_STATES = 1 << 22
#: Bytes of modelDescription.xml; parsed it takes about ten times as much memory.
MOST_XML = 256 << 20


class StructureFault(ValueError):
    """The arrays of an FMU, or the structural parameters that a user gives, do not fit or are too large.

    Args:
        what: What does not fit.
        remedy: What a user can do; empty where the text says so.
    """

    def __init__(self, what: str, remedy: str = "") -> None:
        super().__init__(what)
        self.remedy = remedy


def check_shape(name: str, shape: Sequence[int], sizes: Iterable[str] = ()) -> None:
    """Judge the shape of one array.

    Args:
        name: The variable.
        shape: Number of elements along each dimension.
        sizes: Structural parameters that give some of them.

    Raises:
        StructureFault: It is negative, or too large.
    """
    if not shape:
        return
    given = list(sizes)
    smaller = f"give a smaller {' or '.join(given)} under `structure`" if given else "export it with a smaller array"
    text = " x ".join(f"{n:d}" for n in shape[:8]) + (" x ..." if len(shape) > 8 else "")
    if len(shape) > MOST_DIMENSIONS:
        raise StructureFault(
            f"{name} has {len(shape)} dimensions, more than {MOST_DIMENSIONS}", "export it with fewer dimensions"
        )
    if any(n < 0 for n in shape):
        raise StructureFault(f"{name} has a negative size, {text}", "correct its <Dimension>")
    if math.prod(shape) > MOST_ELEMENTS:
        raise StructureFault(f"{name} has {text} elements, more than {MOST_ELEMENTS}", smaller)


def check_total(variables: Iterable[FmuVariable]) -> None:
    """Judge all that is exchanged with an FMU together; raises StructureFault."""
    found = [(v.variable.size, v.variable.name) for v in variables]
    total = sum(size for size, _ in found)
    if total > MOST_ELEMENTS:
        size, name = max(found)
        raise StructureFault(
            f"its inputs, outputs and recorded variables have {total} elements, more than {MOST_ELEMENTS} (most in "
            f"{name}: {size})",
            "export it with smaller arrays, or record fewer",
        )
