"""Leak in proportion to the level or pressure."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="leak",
    name="leak in proportion to the level or pressure",
    role=Role.LEVEL,
    formula="-leak * h",
    numbers=(Number("leak", "rate/h", "rate of fall per level", (0.05, 0.5)),),
    source="Hagen and Poiseuille; Batchelor, An Introduction to Fluid Dynamics, Cambridge 1967, section 4.2",
    confused_with={
        "free_outflow": "levels of different height decide",
    },
)
