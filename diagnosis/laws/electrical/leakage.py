"""Leakage of a capacity."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="leakage",
    name="leakage of a capacity",
    role=Role.VOLTAGE,
    formula="-leakage * q",
    numbers=(Number("leakage", "rate/q", "rate of fall per voltage", (0.05, 0.5)),),
    source="Ohm's law",
)
