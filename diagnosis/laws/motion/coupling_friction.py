"""Dry friction between two parts."""

from diagnosis.laws.law import Law, Number, Role, sets_in

LAW = Law(
    identifier="coupling_friction",
    name="dry friction between two parts",
    role=Role.COUPLED_VELOCITY,
    formula="-friction * tanh(w / rounding)",
    numbers=(
        Number("friction", "rate", "deceleration by friction", (0.05, 0.3)),
        Number(
            "ratio",
            "w/w",
            "what the other part gets, as a multiple: the ratio of inertias",
            (0.3, 1.0, 3.0, 0.01, 100.0),
            1e5,
            1e-5,
        ),
        sets_in("w", "speed"),
    ),
    source="Coulomb; den Hartog, Mechanical Vibrations, McGraw-Hill 1956, section 8.7",
    confused_with={
        "dry_friction": "motion of both parts together decides",
        "coupling_damping": "motions of different sizes decide",
    },
    reaction="ratio * friction * tanh(w / rounding)",
    reacts_on="v_2",
)
