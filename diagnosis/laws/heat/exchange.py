"""Heat between two parts."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="exchange",
    name="heat between two parts",
    role=Role.COUPLED_TEMPERATURE,
    formula="-exchange * d",
    numbers=(
        Number("exchange", "rate/d", "rate of cooling per difference", (0.05, 0.5)),
        Number(
            "ratio",
            "d/d",
            "what the other part gets, as a multiple: the ratio of heat capacities",
            (0.3, 1.0, 3.0),
            1e3,
            1e-3,
        ),
    ),
    source="Newton's law of cooling; Incropera, Fundamentals of Heat and Mass Transfer, Wiley 2007, section 3.1",
    confused_with={
        "heat_loss": "the temperature of the other part decides",
    },
    reaction="ratio * exchange * d",
    reacts_on="T_2",
)
