"""Currents in strings of coils on one supply, by Ohm and Kirchhoff."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evaluation.proving.rig import Array

#: An open coil [ohm]: no current that any meter sees.
OPEN = 1e12


@dataclass
class Branches:
    """Resistances of the network at one instant.

    Args:
        coil: Of every coil [ohm], shape (coils,), numbered string by string.
        first: Index of every string's first coil, shape (strings,).
        lead: In series with every string [ohm], shape (strings,).
        drop: Voltage that every string's contact takes whenever current flows [V], shape (strings,).
        leak: Conductance from the middle of every string to the return [S], shape (strings,).
        source: Of the supply [ohm].
        limit: Most current that the supply gives [A].
    """

    coil: Array
    first: np.ndarray[tuple[int], np.dtype[np.int64]]
    lead: Array
    drop: Array
    leak: Array
    source: float = 0.0
    limit: float = np.inf


def solve(branches: Branches, voltage: float | Array) -> tuple[Array, Array]:
    """Currents at a supply voltage.

    Each string is lead + upper half + (lower half beside its leak), so it is one resistance and one counter voltage;
    the supply is a voltage behind its resistance, or the limit of its current if that is less.

    Args:
        branches: The network.
        voltage: Of the supply, not negative [V]; or of a supply for each string, shape (strings,), and then there is
            neither source resistance nor limit.

    Returns:
        Current through every coil [A], shape (coils,), and into every string [A], shape (strings,).

    Source: Kirchhoff's laws; Thevenin's theorem.
    """
    lower_first = branches.first + np.diff(np.append(branches.first, branches.coil.size)) // 2
    knots = np.stack([branches.first, lower_first], axis=1).ravel()
    counts = np.diff(np.append(knots, branches.coil.size))
    halves = (np.add.reduceat(branches.coil, knots) * (counts > 0)).reshape(-1, 2)
    lower = halves[:, 1] / (1.0 + halves[:, 1] * branches.leak)
    string = branches.lead + halves[:, 0] + lower
    bus = (
        voltage if isinstance(voltage, np.ndarray) and voltage.ndim else _bus_voltage(branches, float(voltage), string)
    )
    into = np.maximum(bus - branches.drop, 0.0) / string
    past = into / (1.0 + halves[:, 1] * branches.leak)
    return np.repeat(np.stack([into, past], axis=1).ravel(), counts), into


def _bus_voltage(branches: Branches, voltage: float, string: Array) -> float:
    """Voltage at the strings [V]; strings whose contact blocks are left out, one after the other."""
    is_on = branches.drop < voltage
    bus = 0.0
    for _ in range(string.size + 1):
        conductance = float(np.sum(is_on / string))
        counter = float(np.sum(is_on * branches.drop / string))
        bus = (voltage + branches.source * counter) / (1.0 + branches.source * conductance)
        if conductance > 0.0 and bus * conductance - counter > branches.limit:
            bus = (branches.limit + counter) / conductance
        still = is_on & (branches.drop < bus)
        if np.array_equal(still, is_on):
            break
        is_on = still
    return bus
