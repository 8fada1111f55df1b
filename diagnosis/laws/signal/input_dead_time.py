"""Dead time of an actuator."""

from diagnosis.laws.law import Law, Number, OwnState, Role

LAW = Law(
    identifier="input_dead_time",
    name="dead time of an actuator",
    role=Role.INPUT,
    formula="-slope * dead_time / sqrt(dead_time * dead_time + step * step)",
    numbers=(Number("dead_time", "u/rate", "time by which what passes is late", (2.0, 10.0), 1000.0, 0.0),),
    source="Pade approximation of order 2 of a delay T, (1 - sT/2 + (sT)^2/12) / (1 + sT/2 + (sT)^2/12): "
    "Golub and Van Loan, Matrix Computations",
    # With a delay of 0 the states stay as slow as one and a half readings, so that steps stay stable.
    constants={"step": ("u/rate", 1.5)},
    states=(
        OwnState("passed", "slope / sqrt(dead_time * dead_time + step * step)", "u", "u"),
        OwnState("slope", "12 * (u - passed - slope / 2) / sqrt(dead_time * dead_time + step * step)", "0 * u", "u"),
    ),
    confused_with={
        "input_lag": "sharp steps decide: a lag begins to answer at once",
        "input_rate_limit": "steps of different height decide: a dead time is the same for all",
    },
)
