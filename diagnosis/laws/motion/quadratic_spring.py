"""Spring that pulls harder to one side."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="quadratic_spring",
    name="spring that pulls harder to one side",
    role=Role.VELOCITY,
    formula="-stiffness_2 * x ** 2",
    numbers=(
        Number("stiffness_2", "rate/x**2", "acceleration per square of the distance", (0.03, -0.03), 1000.0, None),
    ),
    source="Nayfeh and Mook, Nonlinear Oscillations, Wiley 1979, section 4.1",
    confused_with={
        "cubic_spring": "positions far from rest decide: how the force grows with the distance",
        "constant_force": "positions far from rest decide: how the force grows with the distance",
    },
)
