"""Mechanical effects that the plain fabric leaves out; each is absent at 0. No engine here."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np

from cosim.unit.protocol import Array


class OutOfRange(ValueError):
    """A number of a design that cannot be.

    Args:
        name: Of the number.
        value: What it is, in SI.
        remedy: What to give.
    """

    def __init__(self, name: str, value: float, remedy: str) -> None:
        self.name, self.value, self.remedy = name, value, remedy
        super().__init__(f"{name} is {value}: {remedy}")


@dataclass(frozen=True)
class LinkEffects:
    """What one link has besides, or lacks.

    Args:
        steel_loss: Share of the stiffness of both steel springs that is missing: 1 where they are left out.
        coil_loss: Share of the stiffness of both coils that is missing: 0.5 where one of them is broken.
        heat_loss: Share that is missing of the stiffness of both coils beyond `cold_stiffness`: 1 where they stay cold.
        slide_friction: Dry friction in its slide beyond that of every slide [N]: a link that jams has much.

    Raises:
        OutOfRange: A share outside 0 to 1, or a friction below 0 or not finite.
    """

    steel_loss: float = 0.0
    coil_loss: float = 0.0
    heat_loss: float = 0.0
    slide_friction: float = 0.0

    def __post_init__(self) -> None:
        for name in ("steel_loss", "coil_loss", "heat_loss"):
            value = getattr(self, name)
            if not 0.0 <= value <= 1.0:
                raise OutOfRange(name, value, "give a share from 0 to 1")
        if not (math.isfinite(self.slide_friction) and self.slide_friction >= 0):
            raise OutOfRange("slide_friction", self.slide_friction, "give zero or a positive number")


@dataclass(frozen=True)
class AddedEffects:
    """Effects beyond rigid links, ideal springs and Coulomb friction between links.

    All of them take energy or store it, so none may be negative; a negative friction would drive the fabric.

    Args:
        slide_friction: Dry friction in the slide of every link [N]: it holds what it can, and takes no more than this.
        slide_damping: c in the force -c v against the speed v of every slide [N s/m].
        hinge_friction: Lever b of the dry torque b N against rolling in a contact that carries N [m].
        wire_stiffness: Spring from the last link of every row to where it was woven: the supply wires [N/m].
        coil_play: Play of the coils in their pins [m]: they pull only beyond it.
        coil_contraction: By how much the coils' rest length shrinks per stiffness beyond `cold_stiffness` [m^2/N].
        cold_stiffness: Stiffness at which they have the rest length given [N/m].
        added_friction: Friction between links beyond `friction` of the design, a coefficient of a pair.
        payload: Mass hung on the links of the last row [kg], carried as its weight.
        links: Number of a link, from 0, and what it has besides; at most once each.

    Raises:
        ValueError: A number is negative or not finite.

    Source: Coulomb and viscous friction: B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, Automatica 30 (1994)
    1083-1138. Rolling friction: K. L. Johnson, Contact Mechanics, Cambridge 1985, section 9.6. Contraction: two-way
    effect in proportion to the transformed fraction, K. Otsuka, C. M. Wayman, Shape Memory Materials, Cambridge 1998,
    chapter 1, with the stiffness linear in that fraction; 157.1 N/m: paper, table 1.
    """

    slide_friction: float = 0.0
    slide_damping: float = 0.0
    hinge_friction: float = 0.0
    wire_stiffness: float = 0.0
    coil_play: float = 0.0
    coil_contraction: float = 0.0
    cold_stiffness: float = 157.1
    added_friction: float = 0.0
    payload: float = 0.0
    links: tuple[tuple[int, LinkEffects], ...] = ()

    def __post_init__(self) -> None:
        for field in fields(self):
            if field.name == "links":
                continue
            value = getattr(self, field.name)
            if not (math.isfinite(value) and value >= 0):
                raise OutOfRange(field.name, value, "give zero or a positive number")

    def steel_kept(self, links: int) -> Array:
        """Share of the stiffness of the steel springs that every link has, shape (link,).

        Args:
            links: Number of links of the fabric.
        """
        return self._of_links(links, 1.0, lambda own: 1.0 - own.steel_loss)

    def coil_stiffness(self, stiffness: Array) -> Array:
        """Stiffness of every coil with what its link lacks [N/m], shape (coil,).

        Args:
            stiffness: As the actuator gives it, shape (coil,) [N/m].
        """
        if not self.links:
            return stiffness
        links = len(stiffness) // 2
        kept = np.repeat(self._of_links(links, 1.0, lambda own: 1.0 - own.coil_loss), 2)
        cold = np.repeat(self._of_links(links, 0.0, lambda own: own.heat_loss), 2)
        return np.asarray(kept * (stiffness - cold * np.maximum(stiffness - self.cold_stiffness, 0.0)))

    def slide_frictions(self, links: int) -> Array:
        """Dry friction in the slide of every link [N], shape (link,).

        Args:
            links: Number of links of the fabric.
        """
        return self._of_links(links, self.slide_friction, lambda own: self.slide_friction + own.slide_friction)

    def _of_links(self, links: int, plain: float, own: Callable[[LinkEffects], float]) -> Array:
        found = np.full(links, plain)
        for number, effects in self.links:
            found[number] = own(effects)
        return found

    def rest_length(self, stiffness: Array, rest_length: Array) -> Array:
        """Length at which each coil begins to pull [m], shape (coil,).

        Args:
            stiffness: Shape (coil,) [N/m].
            rest_length: Unloaded length of the cold coil between its pins, shape (coil,) [m].
        """
        if self.coil_play == 0.0 and self.coil_contraction == 0.0:
            return rest_length
        shrunk = rest_length - self.coil_contraction * np.maximum(stiffness - self.cold_stiffness, 0.0)
        return np.asarray(np.maximum(shrunk, 0.0) + self.coil_play)


#: The plain fabric.
NO_EFFECTS = AddedEffects()


def tilted(gravity: tuple[float, float, float], tilt: float, roll: float) -> tuple[float, float, float]:
    """Gravity as a fabric sees it whose stand leans.

    Args:
        gravity: In the level frame [m/s^2].
        tilt: By how much the free end of the stand's y axis is raised, a turn about x [rad].
        roll: Turn about y, which follows the tilt [rad].

    Returns:
        In the frame of the fabric.

    >>> [round(g, 3) for g in tilted((0.0, 0.0, -10.0), 0.1, 0.0)]
    [0.0, -0.998, -9.95]
    """
    if tilt == 0.0 and roll == 0.0:
        return gravity
    x, y, z = gravity
    y, z = math.cos(tilt) * y + math.sin(tilt) * z, -math.sin(tilt) * y + math.cos(tilt) * z
    x, z = math.cos(roll) * x - math.sin(roll) * z, math.sin(roll) * x + math.cos(roll) * z
    return x, y, z
