"""Distortion of an input with its square."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="input_square",
    name="distortion of an input with its square",
    role=Role.INPUT,
    formula="bend * abs(u) * u",
    numbers=(Number("bend", "1/u", "change of the factor per size of the input", (0.05, -0.05), 3.0, None),),
    source="Taylor series of a characteristic",
    is_named=False,
    series_of=("u",),
)
