"""A current that cannot turn round, as behind a diode."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="rectifier",
    name="current that cannot turn round (diode)",
    role=Role.CURRENT,
    formula="blocking * max(-i, 0 * i)",
    numbers=(Number("blocking", "rate/i", "rate of rise per current that flows back", (0.5, 5.0), 1e4),),
    source="Horowitz and Hill, The Art of Electronics, Cambridge 2015, section 1.6",
    confused_with={
        "contact_drop": "a small current to and fro decides",
    },
)
