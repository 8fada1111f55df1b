"""A narrow connection between two vessels."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="exchange_flow",
    name="laminar flow between two vessels",
    role=Role.COUPLED_LEVEL,
    formula="-flow * d",
    numbers=(
        Number("flow", "rate/d", "rate of fall per difference", (0.05, 0.5)),
        Number(
            "ratio",
            "d/d",
            "what the other part gets, as a multiple: the ratio of cross sections",
            (0.3, 1.0, 3.0),
            1e3,
            1e-3,
        ),
    ),
    source="Hagen and Poiseuille; Batchelor, An Introduction to Fluid Dynamics, Cambridge 1967, section 4.2",
    confused_with={
        "leak": "the level of the other vessel decides",
        "turbulent_exchange_flow": "differences of different size decide",
    },
    reaction="ratio * flow * d",
    reacts_on="h_2",
)
