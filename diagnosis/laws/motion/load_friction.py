"""Friction in proportion to a load: of a rope, a sheath, a screw, a pair of gears."""

from diagnosis.laws.law import Law, Number, Role, sets_in

LAW = Law(
    identifier="load_friction",
    name="friction in proportion to a load (Amontons; Euler and Eytelwein)",
    role=Role.LOADED_VELOCITY,
    formula="-friction * abs(o) * tanh(v / rounding)",
    numbers=(
        Number("friction", "rate/o", "deceleration by friction for each unit of the load", (0.05, 0.3)),
        sets_in("v", "speed"),
    ),
    source="Beer, Johnston, Vector Mechanics for Engineers: Statics, McGraw-Hill, chapter 8: friction, screws, belts",
    confused_with={
        "dry_friction": "loads of different sizes decide",
        "viscous_damping": "motions of different sizes decide: how the loss depends on the speed",
        "stribeck_friction": "loads of different sizes decide",
    },
)
