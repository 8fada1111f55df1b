"""Force of the spring pair in each arm: a NiTi coil that pulls and a steel coil that pushes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array


@dataclass(frozen=True)
class SteelSpring:
    """Compression spring around each NiTi coil.

    Args:
        stiffness: k_s [N/m].
        rest_length: b, unloaded length between the same pins as the coil [m].
    """

    stiffness: float
    rest_length: float


def coil_tension(stiffness: Array, extension: Array) -> Array:
    """Tension of each coil [N]: k times extension; a coil cannot push, so a slack one carries nothing.

    Args:
        stiffness: Shape (coil,) [N/m].
        extension: Shape (coil,), length less rest length [m].

    Source: paper, section 2.2 (a tensile NiTi coil nested in a compressive steel coil).
    """
    return np.asarray(stiffness * np.maximum(extension, 0.0))


def spring_energy(
    stiffness: Array, extension: Array, length: Array, steel: SteelSpring, kept: Array | float = 1.0
) -> float:
    """Energy of all coils and steel springs [J].

    Args:
        stiffness: Shape (coil,) [N/m].
        extension: Shape (coil,) [m].
        length: Shape (coil,), length of the arm's coil and steel spring [m].
        steel: The steel spring.
        kept: Share of its stiffness that each arm's spring has, shape (coil,).
    """
    coils = 0.5 * stiffness * np.maximum(extension, 0.0) ** 2
    pushed = np.maximum(steel.rest_length - length, 0.0)
    return float(np.sum(coils) + 0.5 * steel.stiffness * np.sum(kept * pushed**2))
