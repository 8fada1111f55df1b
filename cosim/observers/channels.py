"""Which variables of a system are recorded, and over which dimensions."""

from __future__ import annotations

from dataclasses import dataclass

from cosim.system import System
from cosim.unit.protocol import Causality, Variable

_RECORDED = {Causality.OUTPUT, Causality.LOCAL}


@dataclass(frozen=True)
class Channel:
    """One recorded variable.

    Args:
        unit: Component.
        variable: Its variable.
        dims: Dimension names in the dataset (a component's name is put before a dimension that others use with
            another size).
    """

    unit: str
    variable: Variable
    dims: tuple[str, ...]

    @property
    def name(self) -> str:
        """Name in the dataset, `component.variable`."""
        return f"{self.unit}.{self.variable.name}"


def recorded_channels(system: System) -> list[Channel]:
    """What a trace of a system holds."""
    sizes: dict[str, int] = {}
    result = []
    for name, unit in system.units.items():
        for variable in unit.variables.values():
            if variable.causality not in _RECORDED or not variable.recorded:
                continue
            dims = []
            for dim, size in zip(variable.dims, variable.shape, strict=True):
                shared = dim if sizes.setdefault(dim, size) == size else f"{name}_{dim}"
                dims.append(shared)
            result.append(Channel(name, variable, tuple(dims)))
    return result
