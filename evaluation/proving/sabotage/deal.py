"""All sabotages with the rigs that each can be done to."""

from __future__ import annotations

from evaluation.proving.sabotage import inputs, pendulum, readings, structure
from evaluation.proving.sabotage.pendulum import ArmSabotage
from evaluation.proving.sabotage.sabotage import Sabotage

#: On benches.
SABOTAGES: tuple[type[Sabotage], ...] = (*inputs.SABOTAGES, *readings.SABOTAGES, *structure.SABOTAGES)
#: On the pendulum.
ARM_SABOTAGES: tuple[type[ArmSabotage], ...] = pendulum.SABOTAGES
#: Every sabotage on every rig that it can be done to, with the name of the rig.
PAIRS: tuple[tuple[type[Sabotage], str], ...] = tuple(
    (kind, setup) for kind in (*SABOTAGES, *ARM_SABOTAGES) for setup in kind.setups
)
