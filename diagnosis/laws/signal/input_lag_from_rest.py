"""Lag of an actuator that is at rest where a recording begins, though its input is not."""

from diagnosis.laws.law import Law, Number, OwnState, Role

LAW = Law(
    identifier="input_lag_from_rest",
    name="lag of an actuator that begins at rest",
    role=Role.STARTED_INPUT,
    formula="(passed - u) * lag_time / (lag_time + step)",
    numbers=(Number("lag_time", "u/rate", "time constant", (1.0, 5.0), 1000.0, 0.0),),
    source="first-order actuator: Astrom and Hagglund, Advanced PID Control, ISA 2006, section 2.4",
    constants={"step": ("u/rate", 0.2)},
    states=(OwnState("passed", "(u - passed) / (lag_time + step)", "0 * u", "u"),),
    confused_with={"input_lag": "the begin decides: was the input on before, or switched on there"},
)
