"""What the fabric asks of an engine: rigid links driven by their springs. No engine here."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from cosim.unit.protocol import Array
from mechanics.motion import Motion


@dataclass(frozen=True)
class Contacts:
    """Contacts between links.

    Args:
        count: Number of contact points.
        penetration: Deepest overlap [m], 0 if none.
        links: The two links of the deepest overlap.
    """

    count: int
    penetration: float
    links: tuple[int, int]


class Divergence(Exception):
    """The engine cannot go on; the text says why."""


class World(Protocol):
    """Links of a fabric in an engine, made from a `Motion`; two worlds made from the same one move alike to the bit."""

    #: Name of the engine, as users read it.
    engine: str

    def advance(self, steps: int, stiffness: Array, rest_length: Array) -> None:
        """Make micro-steps with constant springs.

        Args:
            steps: Number of micro-steps.
            stiffness: Of every coil [N/m], shape (coil,).
            rest_length: Of every coil [m], shape (coil,).

        Raises:
            Divergence: The engine says that it cannot go on.
        """
        ...

    def motion(self) -> Motion:
        """Current state; the arrays are overwritten by the next call."""
        ...

    def contacts(self) -> Contacts:
        """Contact points between links, as the engine found them in its last step."""
        ...

    def close(self) -> None:
        """Free the world; safe to call twice."""
        ...
