"""A damper, or a valve of one, that resists motion in the negative direction more than it is said to."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="one_sided_damping_of_backward_motion",
    name="one-sided damping, of motion in the negative direction",
    role=Role.VELOCITY,
    formula="-damping * min(v, 0 * v)",
    numbers=(Number("damping", "rate/v", "deceleration per velocity, backwards", (0.05, -0.05), 1e3, None),),
    source="valves of rebound and compression: Dixon, The Shock Absorber Handbook, Wiley 2007, chapter 5",
    confused_with={
        "uneven_damping": "the damping that is stated decides: of one direction, or of both on average",
        "viscous_damping": "motion in both directions decides",
    },
)
