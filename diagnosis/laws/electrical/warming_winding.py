"""A winding whose resistance rises as its own current warms it."""

from diagnosis.laws.law import Law, Number, OwnState, Role

LAW = Law(
    identifier="warming_winding",
    name="winding whose resistance rises as it warms up",
    role=Role.CURRENT,
    formula="-rise * warmth * i",
    numbers=(
        Number("rise", "rate/i**3", "rate of fall per current and warmth, a mean square of the current", (0.05, 0.3)),
        Number("settling_time", "i/rate", "time in which the winding warms up", (30.0, 1000.0), 1e6, 1.0),
    ),
    source="copper rises by 0.39 % per K: Fitzgerald, Electric Machinery, McGraw-Hill 2003, appendix D",
    states=(OwnState("warmth", "(i * i - warmth) / settling_time", "0 * i * i", "i**2"),),
    confused_with={
        "series_resistance": "a long pulse decides: the winding is cold at its begin",
    },
)
