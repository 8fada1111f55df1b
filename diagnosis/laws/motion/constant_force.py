"""Constant force."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="constant_force",
    name="constant force",
    role=Role.VELOCITY,
    formula="force",
    numbers=(Number("force", "rate", "acceleration", (0.05, -0.05), 100.0, None),),
    source="Newton's second law",
    confused_with={
        "input_offset": "nothing tells an offset of the force from a constant force",
        "stiffness": "positions far from rest decide: how the force grows with the distance",
    },
)
