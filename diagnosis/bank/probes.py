"""What a candidate would change at each of its places: derivatives by its strength, in few simulations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from diagnosis.bank.bank import Bank
from diagnosis.bank.inputs import BankInputs
from diagnosis.bank.layout import Array, BankLayout
from diagnosis.bank.parameters import BankParameters
from diagnosis.bank.places import Place
from diagnosis.bank.plan import Plan
from diagnosis.bank.sensitivities import Direction, by_quantity, flat_sensitivities
from diagnosis.candidates.candidate import CandidateTerm


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
    bank: Bank,
    parameters: BankParameters,
    inputs: BankInputs,
    times: Array | Mapping[str, Array],
    probe: Probe,
    threads: int = 1,
) -> tuple[dict[str, Array], dict[str, Array]]:  # fmt: skip
    """Outputs without the candidate, and their derivatives by its strength at each place.

    Places that do not feel each other share a simulation: 36 coils need six where the strings are apart, one where the
    coils are; all channels together need one. Two exchanged channels need none.

    Args:
        bank: The bank; it holds the candidate.
        parameters: Where to probe. The candidate may be on at other places; there it keeps its values.
        inputs: Grid of steps and what drives them.
        times: As for `Bank.simulate`.
        probe: What to try.
        threads: Threads that share the simulations.

    Returns:
        Outputs, as `Bank.simulate`; derivatives by quantity, shape (places, samples, elements).

    Raises:
        BankError: A value stopped being finite.
    """
    return by_quantity(*_probed(bank, parameters, inputs, times, probe, threads))


def flat_probe_sensitivities(
    bank: Bank,
    parameters: BankParameters,
    inputs: BankInputs,
    times: Array | Mapping[str, Array],
    probe: Probe,
    threads: int = 1,
    plan: Plan | None = None,
    outputs: Array | None = None,
) -> Array:  # fmt: skip
    """Derivatives as in `probe_sensitivities`, as the bank lays them out: shape (places, out_size).

    `plan` and `outputs`: see `flat_sensitivities`.
    """
    return _probed(bank, parameters, inputs, times, probe, threads, plan, outputs)[2]


def _probed(
    bank: Bank, parameters: BankParameters, inputs: BankInputs, times: Array | Mapping[str, Array], probe: Probe,
    threads: int, plan: Plan | None = None, outputs: Array | None = None,
) -> tuple[Plan, Array, Array]:  # fmt: skip
    term = probe.term
    direct = [n for n, p in enumerate(probe.places) if p.kind != "swap"]
    at = parameters
    if direct:
        found = [probe.places[n] for n in direct]
        at = parameters.with_term(term.identifier, **_values(bank.layout, parameters, probe, found))
    name = f"{term.identifier}.{term.amplitude.name}"
    directions = [Direction(name, probe.places[n].mask, probe.step, is_central=False) for n in direct]
    plan, base, slopes = flat_sensitivities(bank, at, inputs, times, directions, threads, plan, outputs)
    if len(direct) == len(probe.places):
        return plan, base, slopes
    whole = np.zeros((len(probe.places), plan.out_size))
    whole[direct] = slopes
    found_at, derivatives = by_quantity(plan, base, whole)
    for n in set(range(len(probe.places))) - set(direct):
        _exchange(bank.layout, found_at, derivatives, probe.places[n].mask, n)
    return plan, base, whole


def _values(
    layout: BankLayout, parameters: BankParameters, probe: Probe, found: Sequence[Place]
) -> dict[str, float | Array]:  # fmt: skip
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
    layout: BankLayout, base: Mapping[str, Array], slopes: Mapping[str, Array], mask: Array, row: int
) -> None:
    """Two channels that show each other: what their difference is."""
    channels = np.flatnonzero(mask)
    for quantity, values in base.items():
        first = layout.channel(quantity)
        if first <= channels[0] < first + layout.elements(quantity):
            a, b = channels - first
            slopes[quantity][row, :, a] = values[:, b] - values[:, a]
            slopes[quantity][row, :, b] = values[:, a] - values[:, b]
