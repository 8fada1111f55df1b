"""Second mass that takes part in the heat."""

from diagnosis.laws.law import Law, Number, OwnState, Role

LAW = Law(
    identifier="second_mass",
    name="second mass that takes part in the heat",
    role=Role.TEMPERATURE,
    formula="-coupling * (T - inside)",
    numbers=(
        Number("coupling", "rate/T", "rate of the exchange", (0.1, 1.0)),
        Number("settling_time", "T/rate", "time in which the second mass follows", (0.3, 3.0), 1000.0, 0.01),
    ),
    source="lumped capacities in series: Incropera, Fundamentals of Heat and Mass Transfer, Wiley 2011, section 5.3",
    states=(OwnState("inside", "(T - inside) / settling_time", "T", "T"),),
    confused_with={
        "heat_loss": "the way back to rest decides: heat that was stored returns",
    },
)
