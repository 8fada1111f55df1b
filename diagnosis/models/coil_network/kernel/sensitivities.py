"""Derivatives of all outputs, by differences, in one batch; parts that do not feel each other share a simulation."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from diagnosis.models.coil_network.kernel.independence import Independence
from diagnosis.models.coil_network.kernel.inputs import CoilNetworkInputs
from diagnosis.models.coil_network.kernel.layout import QUANTITIES, QUANTITY_FIELDS, Array
from diagnosis.models.coil_network.kernel.network import CoilNetwork
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters, Packing, active_terms, pack
from diagnosis.models.coil_network.kernel.plan import Plan


@dataclass(frozen=True)
class Direction:
    """A direction in the space of the parameters.

    Args:
        parameter: Base parameter, or `candidate.parameter`.
        mask: Change per unit along the direction at every element of its axis; an array of the values themselves gives
            the derivative with respect to the logarithm.
        step: Length of the difference along the direction.
        is_central: Two simulations and second order, else one (needed where the base lies at a bound).
    """

    parameter: str
    mask: Array
    step: float
    is_central: bool = True


@dataclass
class _Group:
    """Directions of one parameter, step and kind that are simulated together; each has a part of the network."""

    level: str
    members: dict[int, int]  # part to number of the direction; -1: a direction alone

    def takes(self, level: str, part: int) -> bool:
        return self.level == level and part not in self.members


def sensitivities(
    network: CoilNetwork,
    parameters: CoilNetworkParameters,
    inputs: CoilNetworkInputs,
    times: Array | Mapping[str, Array],
    directions: Sequence[Direction],
    threads: int = 1,
) -> tuple[dict[str, Array], dict[str, Array]]:
    """Outputs and their derivatives along directions.

    Args:
        network: The network.
        parameters: Where.
        inputs: Grid of steps and what drives them.
        times: As for `CoilNetwork.simulate`.
        directions: See `Direction`. Directions of the same parameter, step and kind that touch one coil or one string
            each are simulated together where coils or strings do not feel each other (`Independence`).
        threads: Threads that share the simulations.

    Returns:
        Outputs, as `CoilNetwork.simulate`; derivatives by quantity, shape (directions, samples, elements).

    Raises:
        CoilNetworkError: A value stopped being finite.
        KeyError: A direction along a parameter that the network does not have.
    """
    return by_quantity(*flat_sensitivities(network, parameters, inputs, times, directions, threads))


def by_quantity(plan: Plan, outputs: Array, slopes: Array) -> tuple[dict[str, Array], dict[str, Array]]:
    """What `flat_sensitivities` gives, by quantity and without the shares of the strings."""
    result, derivatives = {n: v[0] for n, v in plan.split(outputs[None]).items()}, plan.split(slopes)
    for found in (result, derivatives):
        found.pop("string_share", None)
    return result, derivatives


def flat_sensitivities(
    network: CoilNetwork,
    parameters: CoilNetworkParameters,
    inputs: CoilNetworkInputs,
    times: Array | Mapping[str, Array],
    directions: Sequence[Direction],
    threads: int = 1,
    plan: Plan | None = None,
    outputs: Array | None = None,
) -> tuple[Plan, Array, Array]:
    """As `sensitivities`, but outputs and derivatives as the network lays them out.

    Args:
        network: As for `sensitivities`, and so are the four that follow.
        parameters: Where.
        inputs: Grid of steps and what drives them.
        times: Sample times.
        directions: What to vary.
        threads: Threads that share the simulations.
        plan: What `sharing_plan` made of the same inputs and times, where it is at hand.
        outputs: Outputs at the same parameters under that plan, where they are at hand.

    Returns:
        Plan that splits them by quantity (`string_share` comes last where it is there at all); outputs, shape
        (out_size,); derivatives, shape (directions, out_size).
    """
    active = active_terms(network.terms, parameters)
    active |= {d.parameter.split(".")[0] for d in directions if "." in d.parameter}
    packing = network.packing(active)
    apart = Independence(network.layout, [t for t in network.terms if t.identifier in active], parameters)
    plan = sharing_plan(network, inputs, times) if plan is None else plan
    # What the strings add up to is known by string for the supply's current alone.
    groups = _groups(None if "supply_power" in plan.times else apart, packing, directions)
    base = pack(packing, network.terms, parameters)
    if "string_share" in plan.times:
        _share_sensor(packing, base)
    rows = _perturbed(packing, base, directions, groups)
    if outputs is None:
        rows = np.concatenate([base[None], rows])
    out = network.run(plan, packing, rows, threads)
    if outputs is not None:
        out = np.concatenate([outputs[None], out])
    slopes = _slopes(plan, out, directions, groups)
    if "string_share" in plan.times:
        views = plan.split(slopes)
        grouped = [n for g in groups if g.level in ("coil", "string") for part, n in g.members.items() if part >= 0]
        views["supply_current"][grouped] = views["string_share"][grouped].sum(axis=2, keepdims=True)
    return plan, out[0], slopes


def sharing_plan(network: CoilNetwork, inputs: CoilNetworkInputs, times: Array | Mapping[str, Array]) -> Plan:
    """Plan whose outputs hold the share of every string in the supply's current too, for `flat_sensitivities`."""
    wanted = network.wanted(inputs, times)
    if "supply_current" in wanted:
        wanted = {**wanted, "string_share": wanted["supply_current"]}
    return network.plan(inputs, wanted)


def shared_outputs(network: CoilNetwork, parameters: CoilNetworkParameters, plan: Plan) -> Array:
    """Outputs under a plan of `sharing_plan`, shape (out_size,).

    Raises:
        CoilNetworkError: A value stopped being finite.
    """
    packing = network.packing(active_terms(network.terms, parameters))
    base = pack(packing, network.terms, parameters)
    if "string_share" in plan.times:
        _share_sensor(packing, base)
    return np.asarray(network.run(plan, packing, base[None])[0])


def _share_sensor(packing: Packing, base: Array) -> None:
    """Let every string's share pass through the sensor of the supply's current."""
    layout = packing.layout
    supply, first = layout.channel("supply_current"), layout.channel("string_share")
    for name, axis in packing.axes.items():
        if axis == "channel":
            values = base[packing.where(name)]
            values[first : first + layout.elements("string_share")] = values[supply]
    names = list(QUANTITIES)
    for field in QUANTITY_FIELDS:
        values = base[packing.where(field)]
        values[names.index("string_share")] = values[names.index("supply_current")]


def _groups(apart: Independence | None, packing: Packing, directions: Sequence[Direction]) -> list[_Group]:
    families: dict[tuple[str, float, bool], list[_Group]] = {}
    for number, direction in enumerate(directions):
        level, part = "all", -1
        if apart is not None:
            level, part = apart.part(direction.parameter, packing.axes[direction.parameter], direction.mask)
        family = families.setdefault((direction.parameter, direction.step, direction.is_central), [])
        group = next((g for g in family if part >= 0 and g.takes(level, part)), None)
        if group is None:
            family.append(group := _Group(level, {}))
        group.members[part] = number
    return [g for family in families.values() for g in family]


def _perturbed(packing: Packing, base: Array, directions: Sequence[Direction], groups: Sequence[_Group]) -> Array:
    rows = []
    for group in groups:
        members = [directions[n] for n in group.members.values()]
        mask = np.sum([d.mask for d in members], axis=0)
        place = packing.where(members[0].parameter)
        for sign in (1.0, -1.0) if members[0].is_central else (1.0,):
            rows.append(base.copy())
            packing.write(rows[-1], members[0].parameter, base[place] + sign * members[0].step * mask)
    return np.array(rows).reshape(len(rows), packing.size)


def _slopes(plan: Plan, out: Array, directions: Sequence[Direction], groups: Sequence[_Group]) -> Array:
    levels = {g.level for g in groups} - {"all"}
    for level in levels - plan.owned.keys():
        plan.owned[level] = _owned(plan, level)
    owned = plan.owned
    slopes = np.zeros((len(directions), plan.out_size))
    row = 1
    for group in groups:
        first = directions[next(iter(group.members.values()))]
        other = out[row + 1] if first.is_central else out[0]
        with np.errstate(over="ignore", invalid="ignore"):  # outputs may be anything; so may derivatives
            slope = (out[row] - other) / (first.step * (2.0 if first.is_central else 1.0))
        row += 2 if first.is_central else 1
        for part, number in group.members.items():
            if part < 0:
                slopes[number] = slope
            elif part < len(owned[group.level]):  # else nothing of that part is recorded
                own = owned[group.level][part]
                slopes[number, own] = slope[own]
    return slopes


def _owned(plan: Plan, level: str) -> list[npt.NDArray[np.int64]]:
    """Numbers of a set's output that belong to each coil, string or channel."""
    owners = np.full((1, plan.out_size), -1.0)
    for name, view in plan.split(owners).items():
        axis = QUANTITIES[name].axis
        if level == "channel":
            view[...] = plan.layout.channel(name) + np.arange(view.shape[2])
        elif axis == level:
            view[...] = np.arange(view.shape[2])
        elif axis == "coil" and level == "string":
            view[...] = plan.layout.string_of_coil
    parts = owners[0].astype(np.int64)
    order = np.argsort(parts, kind="stable")
    bounds = np.searchsorted(parts[order], np.arange(parts.max(initial=-1) + 2))
    return [order[a:b] for a, b in itertools.pairwise(bounds)]
