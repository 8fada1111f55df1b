"""Dead time of an actuator."""

from diagnosis.laws.law import Delay, Law, Number, Role

LAW = Law(
    identifier="input_dead_time",
    name="dead time of an actuator",
    role=Role.INPUT,
    formula="late - u",
    numbers=(Number("dead_time", "u/rate", "time by which what passes is late", (2.0, 10.0), 1000.0, 0.0),),
    source="dead time of a process, exp(-sT): Astrom and Hagglund, Advanced PID Control, ISA 2006, section 2.4",
    delays=(Delay("late", "u", "dead_time"),),
    confused_with={
        "input_lag": "sharp steps decide: a lag begins to answer at once",
        "input_rate_limit": "steps of different height decide: a dead time is the same for all",
    },
)
