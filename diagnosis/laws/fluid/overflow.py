"""Outflow above a level: over a weir, or through a valve that opens."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="overflow",
    name="outflow above a level (weir, relief valve)",
    role=Role.LEVEL,
    formula="-overflow * max(h - edge, 0 * h) ** 1.5",
    numbers=(
        Number("overflow", "rate/h**1.5", "rate of fall per height above it to the power of 1.5", (0.5, 5.0), 1e4),
        Number("edge", "h", "level of the edge", (0.6, 0.8, 0.4), 3.0, -3.0, "h"),
    ),
    source="Poleni; Chow, Open-Channel Hydraulics, McGraw-Hill 1959, section 14.1",
    confused_with={
        "free_outflow": "a level below the edge decides",
    },
)
