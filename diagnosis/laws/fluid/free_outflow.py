"""Outflow through an opening (Torricelli)."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="free_outflow",
    name="outflow through an opening (Torricelli)",
    role=Role.LEVEL,
    formula="-opening * sqrt(max(h, 0 * h))",
    numbers=(Number("opening", "rate/h**0.5", "rate of fall per root of the level", (0.05, 0.5)),),
    source="Torricelli; Batchelor, An Introduction to Fluid Dynamics, Cambridge 1967, section 5.3",
    confused_with={
        "leak": "levels of different height decide",
    },
)
