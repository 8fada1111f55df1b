"""Voltage that a contact takes whatever its current."""

from diagnosis.laws.law import Law, Number, Role, sets_in

LAW = Law(
    identifier="contact_drop",
    name="voltage that a contact takes whatever its current",
    role=Role.CURRENT,
    formula="-drop * tanh(i / rounding)",
    numbers=(
        Number("drop", "rate", "rate of fall", (0.05, 0.3)),
        sets_in("i", "current"),
    ),
    source="brushes of machines: Fitzgerald, Electric Machinery, McGraw-Hill 2003, section 7.2",
    confused_with={
        "series_resistance": "currents of different size decide",
    },
)
