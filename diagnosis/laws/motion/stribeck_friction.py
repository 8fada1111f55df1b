"""Stiction that falls with speed (Stribeck)."""

from diagnosis.laws.law import Law, Number, Role, sets_in

LAW = Law(
    identifier="stribeck_friction",
    name="stiction that falls with speed (Stribeck)",
    role=Role.VELOCITY,
    formula="-stiction * exp(-(v / stribeck_speed) ** 2) * tanh(v / rounding)",
    numbers=(
        Number("stiction", "rate", "deceleration at rest beyond the dry friction", (0.1,)),
        Number("stribeck_speed", "v", "speed at which it has fallen to 37 %", (0.1, 0.3), 3.0, 0.02),
        sets_in("v", "speed"),
    ),
    source="Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30 (1994) 1083, equation 9",
    confused_with={
        "dry_friction": "fast motion decides: there stiction does nothing",
    },
)
