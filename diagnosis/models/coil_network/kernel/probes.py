"""What a candidate would change at each of its places: derivatives by its strength, in few simulations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.models.coil_network.kernel.inputs import CoilNetworkInputs
from diagnosis.models.coil_network.kernel.layout import Array, CoilNetworkLayout
from diagnosis.models.coil_network.kernel.network import CoilNetwork
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from diagnosis.models.coil_network.kernel.places import Place
from diagnosis.models.coil_network.kernel.plan import Plan
from diagnosis.models.coil_network.kernel.sensitivities import Direction, by_quantity, flat_sensitivities


@dataclass(frozen=True)
class Probe:
    """A candidate of a certain shape, tried at places.

    Args:
        term: The candidate.
        shape: Its other parameters than the strength, fixed ones left out; missing ones have their first start value.
        places: Where.
        step: Strength at which it is simulated, with the sign to be tried: small enough for a straight line.
    """

    term: CandidateTerm
    shape: Mapping[str, float]
    places: Sequence[Place]
    step: float


def probe_sensitivities(
    network: CoilNetwork,
    parameters: CoilNetworkParameters,
    inputs: CoilNetworkInputs,
    times: Array | Mapping[str, Array],
    probe: Probe,
    threads: int = 1,
) -> tuple[dict[str, Array], dict[str, Array]]:
    """Outputs without the candidate, and their derivatives by its strength at each place.

    Places that do not feel each other share a simulation: 36 coils need six where the strings are apart, one where the
    coils are; all channels together need one. Two exchanged channels need none.

    Args:
        network: The network; it holds the candidate.
        parameters: Where to probe. The candidate may be on at other places; there it keeps its values.
        inputs: Grid of steps and what drives them.
        times: As for `CoilNetwork.simulate`.
        probe: What to try.
        threads: Threads that share the simulations.

    Returns:
        Outputs, as `CoilNetwork.simulate`; derivatives by quantity, shape (places, samples, elements).

    Raises:
        CoilNetworkError: A value stopped being finite.
    """
    return by_quantity(*_probed(network, parameters, inputs, times, probe, threads))


def flat_probe_sensitivities(
    network: CoilNetwork,
    parameters: CoilNetworkParameters,
    inputs: CoilNetworkInputs,
    times: Array | Mapping[str, Array],
    probe: Probe,
    threads: int = 1,
    plan: Plan | None = None,
    outputs: Array | None = None,
) -> Array:
    """Derivatives as in `probe_sensitivities`, as the network lays them out: shape (places, out_size).

    `plan` and `outputs`: see `flat_sensitivities`.
    """
    return _probed(network, parameters, inputs, times, probe, threads, plan, outputs)[2]


def _probed(
    network: CoilNetwork,
    parameters: CoilNetworkParameters,
    inputs: CoilNetworkInputs,
    times: Array | Mapping[str, Array],
    probe: Probe,
    threads: int,
    plan: Plan | None = None,
    outputs: Array | None = None,
) -> tuple[Plan, Array, Array]:
    term = probe.term
    direct = [n for n, p in enumerate(probe.places) if p.kind != "swap"]
    at = parameters
    if direct:
        found = [probe.places[n] for n in direct]
        at = parameters.with_term(term.identifier, **_values(network.layout, parameters, probe, found))
    name = f"{term.identifier}.{term.amplitude.name}"
    directions = [Direction(name, probe.places[n].mask, probe.step, is_central=False) for n in direct]
    plan, base, slopes = flat_sensitivities(network, at, inputs, times, directions, threads, plan, outputs)
    if len(direct) == len(probe.places):
        return plan, base, slopes
    whole = np.zeros((len(probe.places), plan.out_size))
    whole[direct] = slopes
    found_at, derivatives = by_quantity(plan, base, whole)
    for n in set(range(len(probe.places))) - set(direct):
        _exchange(network.layout, found_at, derivatives, probe.places[n].mask, n)
    return plan, base, whole


def _values(
    layout: CoilNetworkLayout, parameters: CoilNetworkParameters, probe: Probe, found: Sequence[Place]
) -> dict[str, float | Array]:
    """Parameters of the candidate: as they are where it is on, those of the probe elsewhere."""
    term = probe.term
    size = layout.size(term.axis)
    own = parameters.terms.get(term.identifier, {})
    strength = np.broadcast_to(np.asarray(own.get(term.amplitude.name, 0.0), dtype=np.float64), (size,)).copy()
    values: dict[str, float | Array] = {term.amplitude.name: strength}
    for p in term.parameters[1:]:
        array = np.full(size, probe.shape.get(p.name, p.starts[0]))
        for place in found:
            if p.name in place.fixed:
                array = np.where(place.mask != 0.0, place.fixed[p.name], array)
        values[p.name] = np.where(strength != 0.0, np.asarray(own.get(p.name, p.starts[0])), array)
    return values


def _exchange(
    layout: CoilNetworkLayout, base: Mapping[str, Array], slopes: Mapping[str, Array], mask: Array, row: int
) -> None:
    """Two channels that show each other: what their difference is."""
    channels = np.flatnonzero(mask)
    for quantity, values in base.items():
        first = layout.channel(quantity)
        if first <= channels[0] < first + layout.elements(quantity):
            a, b = channels - first
            slopes[quantity][row, :, a] = values[:, b] - values[:, a]
            slopes[quantity][row, :, b] = values[:, a] - values[:, b]
