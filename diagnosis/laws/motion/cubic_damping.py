"""Damping with the cube of the speed."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="cubic_damping",
    name="damping with the cube of the speed",
    role=Role.VELOCITY,
    formula="-damping_3 * v ** 3",
    numbers=(Number("damping_3", "rate/v**3", "deceleration per cube of the velocity", (0.03, 0.3)),),
    source="Nayfeh and Mook, Nonlinear Oscillations, Wiley 1979, section 3.3",
    confused_with={
        "quadratic_drag": "motions of different sizes decide: how the loss depends on the speed",
    },
    is_named=False,
)
