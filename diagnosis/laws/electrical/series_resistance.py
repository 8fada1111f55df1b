"""Resistance in series."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="series_resistance",
    name="resistance in series",
    role=Role.CURRENT,
    formula="-resistance * i",
    numbers=(Number("resistance", "rate/i", "rate of fall per current", (0.05, 0.5)),),
    source="Ohm's law",
    confused_with={
        "contact_drop": "currents of different size decide",
    },
)
