"""Factors between units that tables of laboratories are written in."""

from __future__ import annotations

#: How many of a unit make one of another, in words (The International System of Units, 9th edition, and NIST Special
#: Publication 811, appendix B).
FACTORS = {
    "1 min is 60 s": 60.0,
    "1 h is 3600 s": 3600.0,
    "1 m/s is 3.6 km/h": 3.6,
    "1 mile is 1.609 km": 1.609344,
    "1 m/s is 2.237 miles per hour": 2.236936,
    "1 ft is 0.3048 m": 0.3048,
    "1 yd is 0.9144 m": 0.9144,
    "1 nautical mile is 1.852 km": 1.852,
    "1 knot is 0.5144 m/s": 0.5144444,
    "1 in is 25.4 mm": 25.4,
    "1 in is 2.54 cm": 2.54,
    "1 rad is 57.30 deg": 57.29578,
    "1 turn is 6.283 rad": 6.283185,
    "1 rad/s is 9.549 rpm": 9.549297,
    "1 degC is 1.8 degF": 1.8,
    "1 US gallon is 3.785 l": 3.785412,
    "1 imperial gallon is 4.546 l": 4.54609,
    "1 cubic foot per minute is 1.699 m^3/h": 1.699011,
    "1 lb is 0.4536 kg": 0.45359237,
    "1 pound-force is 4.448 N": 4.448222,
    "1 kgf is 9.807 N and 1 g of acceleration 9.807 m/s^2": 9.80665,
    "1 foot-pound is 1.356 N m": 1.355818,
    "1 psi is 6.895 kPa": 6.894757,
    "1 bar is 14.50 psi": 14.50377,
    "1 atm is 101.3 kPa": 101.325,
    "1 kPa is 7.501 mmHg": 7.500617,
    "1 inHg is 3.386 kPa": 3.386389,
    "1 Torr is 133.3 Pa": 133.3224,
    "1 inch of water is 249.1 Pa": 249.0889,
    "1 oz is 28.35 g": 28.34952,
    "1 BTU is 1.055 kJ": 1.055056,
    "1 kW is 3412 BTU/h": 3412.142,
    "1 hp is 745.7 W": 745.6999,
    "1 cal is 4.184 J": 4.184,
    "prefixes of units differ by 1000": 1000.0,
    "prefixes of units differ by 100": 100.0,
    "prefixes of units differ by 10": 10.0,
}


def factor_between(low: float, high: float) -> tuple[str, bool] | None:
    """The factor between two units that an interval holds.

    Args:
        low: Lower end.
        high: Upper end.

    Returns:
        The factor in words, and whether the interval holds one over it; None where it holds none.
    """
    for told, factor in FACTORS.items():
        for is_inverse, one in ((False, factor), (True, 1.0 / factor)):
            if low <= one <= high:
                return told, is_inverse
    return None
