"""Gain of an input."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="input_gain",
    name="gain of an input",
    role=Role.INPUT,
    formula="gain * u",
    numbers=(Number("gain", "u/u", "change of the factor", (0.05, -0.05), 0.9, None),),
    source="calibration of an actuator",
)
