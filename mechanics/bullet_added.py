"""Added mechanical effects in a Bullet world: materials set once, and forces of every micro-step."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from cosim.unit.protocol import Array
from mechanics.engine import load
from mechanics.fabric import FabricDesign, Layout
from mechanics.motion import SCALE, woven

pybullet = load()


class AddedForces:
    """What `AddedEffects` does in a world; nothing at all where every effect is 0.

    Args:
        design: Fabric.
        layout: Which links are held.
        client: Bullet's world.
        bodies: Its bodies, one per link.
        sliding: Links whose slide is free.
    """

    def __init__(
        self, design: FabricDesign, layout: Layout, client: int, bodies: Sequence[int], sliding: Sequence[int]
    ) -> None:
        self._client, added = client, design.added
        self._material(design, bodies, sliding)
        per_row = design.links_per_row
        free = [i for i in range(design.links) if not layout.is_fixed[i]]
        #: (body, where it is held to, spring constant) of the wires, in Bullet's units; N/m is the same as kg/s^2.
        self._wires: list[tuple[int, Array, float]] = []
        if added.wire_stiffness:
            seats = woven(design, layout).position
            ends = [i for i in free if layout.link_in_row[i] == per_row - 1]
            self._wires = [(bodies[i], seats[i], added.wire_stiffness) for i in ends]
        last = [i for i in free if layout.row[i] == design.rows - 1]
        weight = SCALE * added.payload * np.array(design.gravity) / max(len(last), 1)
        self._loads = [(bodies[i], weight.tolist()) for i in last] if added.payload else []
        self.is_active = bool(self._wires or self._loads)

    def _material(self, design: FabricDesign, bodies: Sequence[int], sliding: Sequence[int]) -> None:
        added, client = design.added, self._client
        friction = added.slide_frictions(design.links)
        if added.hinge_friction:
            # Bullet adds the products of each body's rolling friction with the other's friction.
            rolling = SCALE * added.hinge_friction / (2 * math.sqrt(design.pair_friction))
            for body in bodies[: design.links]:
                for piece in (-1, 0):
                    pybullet.changeDynamics(body, piece, rollingFriction=rolling, physicsClientId=client)
        for link in sliding:
            body = bodies[link]
            if added.slide_damping:
                pybullet.changeDynamics(body, 0, jointDamping=added.slide_damping, physicsClientId=client)
            if friction[link]:
                # A bounded motor that wants the slide to stand is Coulomb friction, solved with the contacts.
                pybullet.setJointMotorControl2(
                    body,
                    0,
                    pybullet.VELOCITY_CONTROL,
                    targetVelocity=0.0,
                    force=SCALE * float(friction[link]),
                    physicsClientId=client,
                )

    def push(self) -> None:
        """Apply the forces of wires and payload; Bullet forgets them after a step."""
        client = self._client
        for body, seat, stiffness in self._wires:
            place, _ = pybullet.getBasePositionAndOrientation(body, client)
            force = [stiffness * (s - p) for s, p in zip(seat, place)]
            pybullet.applyExternalForce(body, -1, force, place, pybullet.WORLD_FRAME, physicsClientId=client)
        for body, force in self._loads:
            place, _ = pybullet.getBasePositionAndOrientation(body, client)
            pybullet.applyExternalForce(body, -1, force, place, pybullet.WORLD_FRAME, physicsClientId=client)
