"""Spring."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="stiffness",
    name="spring",
    role=Role.VELOCITY,
    formula="-stiffness * x",
    numbers=(Number("stiffness", "rate/x", "acceleration per distance", (0.03, -0.03, 0.3), 1000.0, None),),
    source="Hooke; Inman, Engineering Vibration, Pearson 2014, section 1.1",
    confused_with={
        "cubic_spring": "positions far from rest decide: how the force grows with the distance",
    },
)
