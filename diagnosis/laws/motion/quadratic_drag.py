"""Drag with the square of the speed."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="quadratic_drag",
    name="drag with the square of the speed",
    role=Role.VELOCITY,
    formula="-drag * abs(v) * v",
    numbers=(Number("drag", "rate/v**2", "deceleration per square of the velocity", (0.03, 0.3)),),
    source="Newton; Batchelor, An Introduction to Fluid Dynamics, Cambridge 1967, section 5.11",
    confused_with={
        "viscous_damping": "motions of different sizes decide: how the loss depends on the speed",
    },
)
