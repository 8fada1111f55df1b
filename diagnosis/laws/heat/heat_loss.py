"""Heat loss to the surroundings."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="heat_loss",
    name="change of the heat loss to the surroundings",
    role=Role.TEMPERATURE,
    formula="-loss * (T - T_a)",
    numbers=(Number("loss", "rate/T", "rate of cooling per difference", (0.1, -0.1), 1000.0, None),),
    source="Newton's law of cooling; Incropera, Fundamentals of Heat and Mass Transfer, Wiley 2011, section 1.2",
    confused_with={
        "radiation": "high temperatures decide",
        "natural_convection": "differences of different size decide",
    },
)
