"""Figures ask for `actuator.temperature`, `circuit.current` and so on; scenarios call components as they like."""

from __future__ import annotations

from collections.abc import Callable

import xarray as xr

#: Role to what tells a component that has it: names of its variables, and whether they are given for each coil.
_ROLES: dict[str, Callable[[dict[str, xr.DataArray]], bool]] = {
    "fabric": lambda own: {"max_curvature", "link_length", "marker_position"} <= own.keys(),
    "actuator": lambda own: (
        {"temperature", "stiffness"} <= own.keys() and str(own["temperature"].dims[-1]).endswith("coil")
    ),
    "circuit": lambda own: {"current", "supply_current", "supply_power"} <= own.keys(),
    "supply": lambda own: "voltage" in own and "coil" not in own["voltage"].dims and "current" not in own,
}


def with_usual_names(run: xr.Dataset) -> xr.Dataset:
    """The results with the components named by what they do, where exactly one does it and none is called so.

    >>> run = xr.Dataset({"net.current": 0.1, "net.supply_current": 0.2, "net.supply_power": 1.0})
    >>> sorted(with_usual_names(run))
    ['circuit.current', 'circuit.supply_current', 'circuit.supply_power']
    """
    components: dict[str, dict[str, xr.DataArray]] = {}
    for name, values in run.data_vars.items():
        component, _, variable = str(name).partition(".")
        components.setdefault(component, {})[variable] = values
    renamed: dict[str, str] = {}
    for role, tells in _ROLES.items():
        found = [c for c, own in components.items() if tells(own)]
        if role not in components and len(found) == 1 and found[0] not in _ROLES:
            renamed |= {f"{found[0]}.{variable}": f"{role}.{variable}" for variable in components[found[0]]}
    return run.rename_vars(renamed)
