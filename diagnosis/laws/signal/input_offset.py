"""Offset of an input."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="input_offset",
    name="offset of an input",
    role=Role.INPUT,
    formula="offset",
    numbers=(Number("offset", "u", "what is added", (0.05, -0.05), 3.0, None),),
    source="calibration of an actuator",
)
