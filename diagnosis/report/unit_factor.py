"""A factor on an input or a sensor that is the factor between two units."""

from __future__ import annotations

from diagnosis.judge.diagnosis import Finding
from diagnosis.report.display import number

#: Laws whose only number is the change of a factor.
GAINS = ("input_gain", "sensor_gain")
#: How many of a unit make one of another, in words (The International System of Units, 9th edition, and NIST Special
#: Publication 811, appendix B).
FACTORS = {
    "1 min is 60 s": 60.0,
    "1 h is 3600 s": 3600.0,
    "1 m/s is 3.6 km/h": 3.6,
    "1 mile is 1.609 km": 1.609344,
    "1 m/s is 2.237 miles per hour": 2.236936,
    "1 ft is 0.3048 m": 0.3048,
    "1 in is 25.4 mm": 25.4,
    "1 in is 2.54 cm": 2.54,
    "1 rad is 57.30 deg": 57.29578,
    "1 turn is 6.283 rad": 6.283185,
    "1 rad/s is 9.549 rpm": 9.549297,
    "1 degC is 1.8 degF": 1.8,
    "1 US gallon is 3.785 l": 3.785412,
    "1 imperial gallon is 4.546 l": 4.54609,
    "1 lb is 0.4536 kg": 0.45359237,
    "1 pound-force is 4.448 N": 4.448222,
    "1 kgf is 9.807 N": 9.80665,
    "1 foot-pound is 1.356 N m": 1.355818,
    "1 psi is 6.895 kPa": 6.894757,
    "1 bar is 14.50 psi": 14.50377,
    "1 atm is 101.3 kPa": 101.325,
    "1 BTU is 1.055 kJ": 1.055056,
    "1 kW is 3412 BTU/h": 3412.142,
    "1 hp is 745.7 W": 745.6999,
    "1 cal is 4.184 J": 4.184,
    "prefixes of units differ by 1000": 1000.0,
    "prefixes of units differ by 100": 100.0,
    "prefixes of units differ by 10": 10.0,
}
#: Widest 95 % interval of a factor that points to one of these, relative to it: a wider one points to many.
CLEAR = 0.05


def unit_factor(finding: Finding) -> str:
    """A question about a unit, where a gain that was found is the factor between two units; else nothing.

    Args:
        finding: Any; asked is of gains of inputs and sensors.
    """
    if finding.effect not in GAINS or len(finding.parameters) != 1:
        return ""
    (change,) = finding.parameters
    low, high = 1.0 + change.lower, 1.0 + change.upper
    if not 0.0 < low < high < (1.0 + CLEAR) * low:
        return ""
    for told, factor in FACTORS.items():
        for is_inverse, one in enumerate((factor, 1.0 / factor)):
            if low <= one <= high:
                size = number(1.0 / (1.0 + change.value), 4) if is_inverse else number(1.0 + change.value, 4)
                shown = f"1/{size}" if is_inverse else size
                return f"The factor is {shown}, and {told}: is the unit that is stated for it right?"
    return ""
