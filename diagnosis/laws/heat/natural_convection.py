"""Natural convection beyond the linear loss."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="natural_convection",
    name="natural convection beyond the linear loss",
    role=Role.TEMPERATURE,
    formula="-convection * abs(T - T_a) ** 0.25 * (T - T_a)",
    numbers=(Number("convection", "rate/T**1.25", "rate of cooling per difference to the power of 1.25", (0.1,)),),
    source="Churchill and Chu, Int. J. Heat Mass Transfer 18 (1975) 1049",
    confused_with={
        "heat_loss": "differences of different size decide",
        "radiation": "high temperatures decide",
    },
)
