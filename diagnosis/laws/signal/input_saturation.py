"""Saturation of an input."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="input_saturation",
    name="saturation of an input",
    role=Role.INPUT,
    formula="-cut * (max(u - limit, 0 * u) + min(u + limit, 0 * u))",
    numbers=(
        Number("cut", "u/u", "share of what exceeds the limit that is cut", (0.5, 1.0), 1.0, 0.0),
        Number("limit", "u", "largest size that passes", (0.5, 0.9, 1.3), 10.0, 0.01),
    ),
    source="Astrom and Hagglund, Advanced PID Control, ISA 2006, section 3.5",
    confused_with={
        "input_gain": "inputs of different size decide",
    },
)
