"""A damper that resists one direction more than the other."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="uneven_damping",
    name="damper that resists one direction more than the other",
    role=Role.VELOCITY,
    formula="-unevenness * abs(v)",
    numbers=(
        Number("unevenness", "rate/v", "half of the difference of both damping constants", (0.05, -0.05), 1e3, None),
    ),
    source="shock absorbers: Dixon, The Shock Absorber Handbook, Wiley 2007, chapter 5",
    confused_with={
        "one_sided_damping_of_forward_motion": "the damping that is stated decides: of one direction, or on average",
        "one_sided_damping_of_backward_motion": "the damping that is stated decides: of one direction, or on average",
        "quadratic_spring": "fast and slow motion over the same way decide",
        "constant_force": "rest decides: there a damper does nothing",
    },
)
