"""Lag of an actuator."""

from diagnosis.laws.law import Law, Number, OwnState, Role

LAW = Law(
    identifier="input_lag",
    name="lag of an actuator",
    role=Role.INPUT,
    # A lag of several steps is one of first order, to 1e-4 from nine of them on; one of none is none.
    formula="(passed - u) * (1 - exp(-lag_time / step))",
    numbers=(Number("lag_time", "u/rate", "time constant", (1.0, 5.0), 1000.0, 0.0),),
    source="first-order actuator: Astrom and Hagglund, Advanced PID Control, ISA 2006, section 2.4",
    constants={"step": ("u/rate", 0.2)},
    states=(OwnState("passed", "(u - passed) / (lag_time + step * exp(-lag_time / step))", "u", "u"),),
)
