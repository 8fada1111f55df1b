"""Dry friction (Coulomb)."""

from diagnosis.laws.law import Law, Number, Role, sets_in

LAW = Law(
    identifier="dry_friction",
    name="dry friction (Coulomb)",
    role=Role.VELOCITY,
    formula="-friction * tanh(v / rounding)",
    numbers=(
        Number("friction", "rate", "deceleration by friction", (0.05, 0.3)),
        sets_in("v", "speed"),
    ),
    source="Coulomb; Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30 (1994) 1083",
    confused_with={
        "viscous_damping": "motions of different sizes decide: how the loss depends on the speed",
        "stribeck_friction": "slow motion decides: there stiction adds to it",
    },
)
