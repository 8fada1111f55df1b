"""Gain of an input."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="input_gain",
    name="gain of an input",
    role=Role.INPUT,
    formula="gain * u",
    numbers=(Number("gain", "u/u", "change of the factor", (0.05, -0.05), 1e3, -0.999),),
    source="calibration of an actuator",
    confused_with={
        "a column in another unit": "a factor as 60, 3.6, 3.785 (US gallons), 4.448 (pounds) or 1000 tells",
    },
)
