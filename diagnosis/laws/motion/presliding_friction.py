"""Dry friction that gives way like a spring before it slips (Dahl)."""

from diagnosis.laws.law import Law, Number, OwnState, Role

LAW = Law(
    identifier="presliding_friction",
    name="dry friction that gives way like a spring before it slips (Dahl)",
    role=Role.VELOCITY,
    formula="-friction * bend",
    numbers=(
        Number("friction", "rate", "deceleration by friction while it slips", (0.1, 0.5)),
        Number("slip", "x", "way after a turn over which it sets in", (0.05, 0.3), 10.0, 0.005),
    ),
    source="P. R. Dahl, A Solid Friction Model, Aerospace Corporation TOR-0158(3107-18)-1, 1968; "
    "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30 (1994) 1083",
    # Where a slip is shorter than the way from one reading to the next, it sets in over half of that way.
    constants={"step": ("reading", 0.5)},
    states=(
        OwnState("bend", "(v - abs(v) * bend) / sqrt(slip * slip + step * v * (step * v))", "0 * x / slip", "x/x"),
    ),
    confused_with={
        "dry_friction": "small motions between two turns decide: there this one acts like a spring",
        "maxwell_element": "slow and fast motion decide: how far a spring and damper give way depends on the time",
    },
)
