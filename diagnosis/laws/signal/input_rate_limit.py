"""Rate limit of an actuator."""

from diagnosis.laws.law import Law, Number, OwnState, Role

LAW = Law(
    identifier="input_rate_limit",
    name="rate limit of an actuator",
    role=Role.INPUT,
    formula="(passed - u) * slowness * size / sqrt(slowness * size * slowness * size + step * step)",
    numbers=(Number("slowness", "1/rate", "time that it takes for each unit of its way", (3.0, 20.0), 1000.0, 0.0),),
    source="rate limiter: Astrom and Hagglund, Advanced PID Control, ISA 2006, section 3.5",
    constants={"size": ("u", 1.0), "step": ("u/rate", 1.0)},
    # Far away it moves by 1/slowness; within a reading of its aim it goes over into a lag, so that steps stay stable.
    states=(
        OwnState(
            "passed", "(u - passed) / sqrt(step * step + slowness * (u - passed) * slowness * (u - passed))", "u", "u"
        ),
    ),
    confused_with={
        "input_lag": "steps of different height decide: a limit takes longer for the higher",
        "input_dead_time": "steps of different height decide: a limit takes longer for the higher",
    },
)
