"""Weight of a mass beside the axis of what turns."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="unbalance",
    name="weight of an unbalanced mass",
    role=Role.VELOCITY,
    formula="-unbalance * sin(x - rest_angle)",
    numbers=(
        Number("unbalance", "rate", "largest acceleration by the weight", (0.05, 0.5)),
        Number("rest_angle", "x/x", "angle at which the mass hangs", (0.0, 1.57, 3.14, -1.57), 6.3, None),
    ),
    source="Goldstein, Classical Mechanics, Addison-Wesley 2002, section 1.4 (weight on a turning arm)",
    confused_with={
        "stiffness": "turns of more than a radian decide",
        "constant_force": "a whole turn decides",
    },
)
