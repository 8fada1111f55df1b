"""Stiffness of a NiTi coil against temperature: the paper's two branches, with a loop of the proving ground's own.

Nearly all of the answer is a population of plays whose loops scatter in width (Prandtl and Ishlinskii); the rest
follows Duhem's differential form, which leaves a branch at once when the temperature turns. On a full loop both give
the paper's branches.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from evaluation.proving.rig import Array, Rig

CELSIUS = 273.15  # [K]
# Equation (2) of the paper, [N/m] and [1/K], T in degrees Celsius.
RISING = (230.5, 17443.0, 0.1669, 157.1)
FALLING = (199.6, 696.0, 0.1549, 157.9)
#: Cold and hot ends of the loop [N/m].
SOFTEST, STIFFEST = RISING[3], RISING[0] + RISING[3]


def branch(abcd: tuple[float, float, float, float], celsius: Array) -> Array:
    """Equation (2): k = a exp(-b exp(-c T)) + d [N/m]."""
    a, b, c, d = abcd
    return a * np.exp(-b * np.exp(-c * celsius)) + d


def lower(celsius: Array) -> Array:
    """Stiffness on heating [N/m]."""
    return branch(RISING, celsius)


def upper(celsius: Array) -> Array:
    """Stiffness on cooling [N/m]; where the fitted branches cross, the loop is closed."""
    return np.maximum(branch(FALLING, celsius), branch(RISING, celsius))


class Loop:
    """Stiffness of every piece of wire, with its history.

    Args:
        rig: Share of Duhem's part, scatter of the plays.
        cells: Pieces of each wire.
        temperature: At the start [K], shape (coils,): never heated before, so on the branch of rising temperature.
        duhem: Share of Duhem's part, shape (coils,); default: that of the rig.
    """

    def __init__(self, rig: Rig, cells: int, temperature: Array, duhem: Array | None = None) -> None:
        coils = temperature.size
        self._duhem_share = (np.full(coils, rig.duhem) if duhem is None else duhem)[:, None]
        offsets = rig.spread * np.sqrt(1.5) * np.array([-1.0, 0.0, 1.0]) if rig.spread > 0.0 else np.zeros(1)
        self._offset = offsets[:, None, None]
        self._celsius = np.broadcast_to((temperature - CELSIUS)[:, None], (coils, cells)).copy()
        self._plays = np.broadcast_to(lower(self._celsius - self._offset), (offsets.size, coils, cells)).copy()
        self._duhem = lower(self._celsius)

    def stiffness(self, celsius: Array) -> Array:
        """Of each piece at a temperature that it reaches without turning [N/m], shape (coils, cells)."""
        return self._mixed(self._moved_plays(celsius), self._moved_duhem(celsius))

    def is_warmer(self, celsius: Array) -> npt.NDArray[np.bool_]:
        """Which pieces are at least as warm as at the end of the step before."""
        return np.asarray(celsius >= self._celsius)

    def accept(self, celsius: Array) -> Array:
        """The same, kept as history."""
        self._plays, self._duhem = self._moved_plays(celsius), self._moved_duhem(celsius)
        self._celsius = np.array(celsius)
        return self._mixed(self._plays, self._duhem)

    def _mixed(self, plays: Array, duhem: Array) -> Array:
        mean: Array = plays.mean(axis=0)
        return mean + self._duhem_share * (duhem - mean)

    def _moved_plays(self, celsius: Array) -> Array:
        # A piece that transforms late on heating transforms late on cooling too: its loop has another width.
        low = lower(celsius - self._offset)
        return np.clip(self._plays, low, np.maximum(upper(celsius + self._offset), low))

    def _moved_duhem(self, celsius: Array) -> Array:
        """Heating shrinks the distance to the hot end as the branch does, cooling that to the cold end; closed form."""
        if not self._duhem_share.any():
            return self._duhem
        old, new = lower(self._celsius), lower(celsius)
        heated = STIFFEST - (STIFFEST - self._duhem) * _ratio(STIFFEST - new, STIFFEST - old)
        old, new = upper(self._celsius), upper(celsius)
        floor = FALLING[3]
        cooled = np.minimum(floor + (self._duhem - floor) * _ratio(new - floor, old - floor), self._duhem)
        moved = np.where(celsius >= self._celsius, np.maximum(heated, self._duhem), cooled)
        return np.clip(moved, lower(celsius), upper(celsius))


def _ratio(over: Array, under: Array) -> Array:
    return np.where(under > 1e-9, over / np.maximum(under, 1e-9), 1.0)


def phase(stiffness: Array) -> Array:
    """Share of austenite that a stiffness stands for, 0 to 1."""
    return np.clip((stiffness - SOFTEST) / (STIFFEST - SOFTEST), 0.0, 1.0)
