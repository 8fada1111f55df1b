"""An opening between two vessels."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="turbulent_exchange_flow",
    name="turbulent flow between two vessels",
    role=Role.COUPLED_LEVEL,
    formula="-flow * sqrt(abs(d)) * tanh(d / rounding)",
    numbers=(
        Number("flow", "rate/d**0.5", "rate of fall per root of the difference", (0.05, 0.5)),
        Number(
            "ratio",
            "d/d",
            "what the other part gets, as a multiple: the ratio of cross sections",
            (0.3, 1.0, 3.0),
            1e3,
            1e-3,
        ),
    ),
    source="Torricelli; Batchelor, An Introduction to Fluid Dynamics, Cambridge 1967, section 5.3",
    constants={"rounding": ("d", 0.01)},
    confused_with={
        "exchange_flow": "differences of different size decide",
    },
    reaction="ratio * flow * sqrt(abs(d)) * tanh(d / rounding)",
    reacts_on="h_2",
)
