"""Steady flow in or out."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="steady_inflow",
    name="steady flow in or out",
    role=Role.LEVEL,
    formula="flow",
    numbers=(Number("flow", "rate", "rate of the level", (0.05, -0.05), 100.0, None),),
    source="conservation of volume",
)
