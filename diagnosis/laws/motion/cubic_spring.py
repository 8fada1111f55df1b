"""Spring that hardens or softens (Duffing)."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="cubic_spring",
    name="spring that hardens or softens (Duffing)",
    role=Role.VELOCITY,
    formula="-stiffness_3 * x ** 3",
    numbers=(
        Number("stiffness_3", "rate/x**3", "acceleration per cube of the distance", (0.03, -0.03, 0.3), 1000.0, None),
    ),
    source="Duffing; Nayfeh and Mook, Nonlinear Oscillations, Wiley 1979, section 4.1",
    confused_with={
        "quadratic_spring": "positions far from rest decide: how the force grows with the distance",
        "upper_stop": "positions far from rest decide: how the force grows with the distance",
    },
)
