"""Viscous damping."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="viscous_damping",
    name="viscous damping",
    role=Role.VELOCITY,
    formula="-damping * v",
    numbers=(Number("damping", "rate/v", "deceleration per velocity", (0.03, 0.3)),),
    source="D'Alembert; Inman, Engineering Vibration, Pearson 2014, section 1.3",
    confused_with={
        "dry_friction": "motions of different sizes decide: how the loss depends on the speed",
        "quadratic_drag": "motions of different sizes decide: how the loss depends on the speed",
    },
)
