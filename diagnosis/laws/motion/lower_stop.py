"""Elastic stop at the lower end."""

from diagnosis.laws.law import Law, Number, Role

LAW = Law(
    identifier="lower_stop",
    name="elastic stop at the lower end",
    role=Role.VELOCITY,
    formula="stop_stiffness * max(stop - x, 0 * x)",
    numbers=(
        Number("stop_stiffness", "rate/x", "acceleration per distance beyond the stop", (3.0, 30.0), 1e4),
        Number("stop", "x", "position of the stop", (0.35, 0.2), 2.0, -2.0, "x"),
    ),
    source="Shaw and Holmes, Journal of Sound and Vibration 90 (1983) 129",
    confused_with={
        "cubic_spring": "positions far from rest decide: how the force grows with the distance",
    },
)
