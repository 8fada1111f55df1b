"""Elastic stop at the upper end: that of the lower end from the other side."""

from dataclasses import replace

from diagnosis.laws.motion.lower_stop import LAW as LOWER

LAW = replace(
    LOWER,
    identifier="upper_stop",
    name="elastic stop at the upper end",
    formula="-stop_stiffness * max(x - stop, 0 * x)",
    numbers=(LOWER.numbers[0], replace(LOWER.numbers[1], starts=(0.65, 0.8))),
)
