"""A factor on an input or a sensor that is the factor between two units."""

from __future__ import annotations

from diagnosis.judge.diagnosis import Finding
from diagnosis.judge.unit_factors import factor_between
from diagnosis.report.display import number

#: Laws whose first number is the change of a factor.
GAINS = ("input_gain", "sensor_gain", "sensor_gain_in_interval", "input_gain_in_interval")
#: Widest 95 % interval of a factor that points to one of these, relative to it: a wider one points to many.
CLEAR = 0.05


def unit_factor(finding: Finding) -> str:
    """A question about a unit, where a gain that was found is the factor between two units; else nothing.

    Args:
        finding: Any; asked is of gains of inputs and sensors.
    """
    if finding.effect not in GAINS or not finding.parameters:
        return ""
    change = finding.parameters[0]
    low, high = 1.0 + change.lower, 1.0 + change.upper
    if not 0.0 < low < high < (1.0 + CLEAR) * low:
        return ""
    found = factor_between(low, high)
    if found is None:
        return ""
    told, is_inverse = found
    size = number(1.0 / (1.0 + change.value), 4) if is_inverse else number(1.0 + change.value, 4)
    return f"The factor is {'1/' if is_inverse else ''}{size}, and {told}: is the unit that is stated for it right?"
