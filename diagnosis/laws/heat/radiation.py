"""Radiation."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="radiation",
    name="radiation",
    role=Role.TEMPERATURE,
    formula="-emission * (T ** 4 - T_a ** 4)",
    numbers=(
        Number("emission", "rate/T/T_abs**3", "rate of cooling per fourth power of the temperature", (0.05, 0.3)),
    ),
    source="Stefan and Boltzmann; Incropera, Fundamentals of Heat and Mass Transfer, Wiley 2011, section 1.2",
    confused_with={
        "heat_loss": "high temperatures decide",
    },
)
