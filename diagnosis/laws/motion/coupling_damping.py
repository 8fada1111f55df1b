"""A damper between two parts."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="coupling_damping",
    name="damper between two parts",
    role=Role.COUPLED_VELOCITY,
    formula="-damping * w",
    numbers=(
        Number("damping", "rate/w", "deceleration per difference of the velocities", (0.05, 0.3)),
        Number(
            "ratio",
            "w/w",
            "what the other part gets, as a multiple: the ratio of inertias",
            (0.3, 1.0, 3.0, 0.01, 100.0),
            1e5,
            1e-5,
        ),
    ),
    source="Inman, Engineering Vibration, Pearson 2014, section 4.5",
    confused_with={
        "viscous_damping": "motion of both parts together decides",
    },
    reaction="ratio * damping * w",
    reacts_on="v_2",
)
