"""The rig as it really is: every number of the data sheet, each off by a little."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

GRAVITY = 9.81  # [m/s^2]
ROOM = 295.15  # [K]; 22 degC


@dataclass(frozen=True)
class DataSheet:
    """What the builder of the rig believes; the scenario says the same.

    Args:
        strings: Coils of every string, top to bottom.
        resistance: Of one coil [ohm] (paper, section 2.2).
        conductance: h A of one coil [W/K] (paper, section 2.3).
        capacity: rho V c_p of one coil [J/K] (paper, section 2.3).
        mass: Below each coil [kg].
        conduction: k A / length of the wire of one coil [W/K]: 18 W/m/K (austenite; Faulkner, Amalraj, Bhattacharyya,
            Smart Mater. Struct. 9 (2000) 632), 0.30 mm, 104 mm.
        is_per_string: Whether every string has a supply of its own.
        is_bath: Whether a bath gives the temperature and no current flows.
        is_driven_by_power: Whether the heat of every element is given [W] and not a voltage.
    """

    strings: tuple[int, ...] = (6, 6, 6, 6, 6, 6)
    resistance: float = 2.2
    conductance: float = 90.0 * 97.85e-6
    capacity: float = 6450.0 * 7.328e-9 * 837.0
    mass: float = 0.1
    conduction: float = 18.0 * 7.05e-8 / 0.104
    is_per_string: bool = False
    is_bath: bool = False
    is_driven_by_power: bool = False

    @property
    def coils(self) -> int:
        """Number of coils."""
        return sum(self.strings)

    @property
    def string_of_coil(self) -> npt.NDArray[np.int64]:
        """Index of each coil's string, shape (coils,)."""
        return np.repeat(np.arange(len(self.strings)), self.strings).astype(np.int64)

    @property
    def place_in_string(self) -> npt.NDArray[np.int64]:
        """Index of each coil in its string, shape (coils,)."""
        return np.concatenate([np.arange(n) for n in self.strings]).astype(np.int64)


@dataclass(frozen=True)
class Rig:
    """True numbers of one rig; arrays have shape (coils,).

    Args:
        sheet: What is believed.
        resistance: [ohm]
        conductance: h A [W/K].
        capacity: [J/K]
        weight: Load of each coil [N].
        stiffness: Factor on the paper's loop [1].
        shift: Of the transformation temperatures [K].
        end: Conductance from each end of the wire to its pin [W/K].
        thermometer: Where along the wire the thermocouple sits, 0 to 1.
        room: How far the surroundings are off [K]; of every coil, where rigs stand side by side.
        slew: Time in which the supply changes its voltage [s].
        duhem: Share of the loop that answers a reversal at once [1]; see `hysteresis`.
        spread: Scatter of the transformation temperatures within a wire [K].
    """

    sheet: DataSheet
    resistance: Array
    conductance: Array
    capacity: Array
    weight: Array
    stiffness: Array
    shift: Array
    end: Array
    thermometer: Array
    room: float | Array = 0.0
    slew: float = 0.0
    duhem: float = 0.0
    spread: float = 0.0


def ideal_rig(sheet: DataSheet) -> Rig:
    """A rig that is exactly what its data sheet says, with wires that lose nothing at their ends."""
    one = np.ones(sheet.coils)
    return Rig(
        sheet,
        sheet.resistance * one,
        sheet.conductance * one,
        sheet.capacity * one,
        sheet.mass * GRAVITY * one,
        one,
        0.0 * one,
        0.0 * one,
        0.5 * one,
    )


def drawn_rig(sheet: DataSheet, rng: np.random.Generator, scatter: float = 1.0) -> Rig:
    """A rig as it comes from the workshop.

    Deviations (one standard deviation) of every coil: R 2 %, h A 3 %, C 2 %, weight 0.5 %, stiffness 1 %,
    transformation temperature 0.2 K; of all together: R 1 %, h A 3 %, C 2 %, stiffness 1 %, transformation temperature
    0.5 K; surroundings 0.2 K.

    What no data sheet tells is kept below what the sensors see (docs/proving.md): pins between two warm coils take
    little heat, a bench supply settles within 2 to 20 ms, the loop is nearly a play.

    Args:
        sheet: What is believed.
        rng: Source of the draws.
        scatter: Factor on all deviations; 2 for rigs whose parameters are plainly wrong.
    """
    coils = sheet.coils

    def off(shared: float, own: float) -> Array:
        exponent = shared * rng.standard_normal() + own * rng.standard_normal(coils)
        return np.exp(scatter * np.clip(exponent, -3.0 * (shared + own), 3.0 * (shared + own)))

    return Rig(
        sheet,
        resistance=sheet.resistance * off(0.01, 0.02),
        conductance=sheet.conductance * off(0.03, 0.03),
        capacity=sheet.capacity * off(0.02, 0.02),
        weight=sheet.mass * GRAVITY * off(0.0, 0.005),
        stiffness=off(0.01, 0.01),
        shift=scatter * (0.5 * rng.standard_normal() + 0.2 * rng.standard_normal(coils)),
        end=2e-5 * np.exp(0.3 * rng.standard_normal(coils)),
        thermometer=rng.uniform(0.35, 0.65, coils),
        room=scatter * 0.2 * rng.standard_normal(),
        slew=rng.uniform(0.002, 0.02),
        duhem=rng.uniform(0.0, 0.03),
        spread=rng.uniform(0.1, 0.35),
    )
