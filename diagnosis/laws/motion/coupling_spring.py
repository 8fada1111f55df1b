"""A spring between two parts."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="coupling_spring",
    name="spring between two parts",
    role=Role.COUPLED_VELOCITY,
    formula="-stiffness * d",
    numbers=(
        Number("stiffness", "rate/d", "acceleration per distance apart", (0.05, 0.5)),
        Number(
            "ratio",
            "d/d",
            "what the other part gets, as a multiple: the ratio of inertias",
            (0.3, 1.0, 3.0),
            1e3,
            1e-3,
        ),
    ),
    source="Hooke; Inman, Engineering Vibration, Pearson 2014, section 4.1",
    confused_with={
        "stiffness": "the motion of the other part decides",
    },
    reaction="ratio * stiffness * d",
    reacts_on="v_2",
)
