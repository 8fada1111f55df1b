"""Laws that complete a description: free-knot splines of every quantity, at once or delayed, and hysteresis.

The laws without a name of `diagnosis.laws.library` are few, so that one of them can be told from a law with a name.
Where everything that was tried leaves more than noise, a sum of terms of one systematic basis describes what is left:
at every rate and input, and in every parameter, each quantity through a piecewise linear function with two free knots,
constant outside them, so that it does not run away beyond what was recorded; at rates and inputs the same behind a
first-order delay. What depends on the course and not on time is the elastoplastic (stop) operator of each quantity: it
follows a turn over a width, then stays. Products of two quantities are laws of the library already. Coil networks have
the same basis but for hysteresis (`diagnosis.candidates.unnamed_completing`).

Source: D. L. B. Jupp, SIAM J. Numerical Analysis 15 (1978) 328-343 (splines with free knots); J. H. Friedman, Annals of
Statistics 19 (1991) 1-67 (sums of such functions); K. S. Narendra and P. G. Gallman, IEEE Trans. Automatic Control 11
(1966) 546-550 (a function of one variable, then a linear memory); M. Brokate, J. Sprekels, Hysteresis and Phase
Transitions, Springer 1996, section 2.1 (the stop operator).
"""

from __future__ import annotations

from collections.abc import Iterator

from diagnosis.laws.law import Law, Number, OwnState, Role

_SOURCE = (
    "D. L. B. Jupp, SIAM J. Numerical Analysis 15 (1978) 328-343; J. H. Friedman, Annals of Statistics 19 (1991) 1-67; "
    "K. S. Narendra and P. G. Gallman, IEEE Trans. Automatic Control 11 (1966) 546-550"
)
_STOP_SOURCE = "M. Brokate, J. Sprekels, Hysteresis and Phase Transitions, Springer 1996, section 2.1 (stop operator)"
#: Widths after a turn over which hysteresis is passed through, in sizes of the quantity.
_TURNS = (0.1, 0.6)
#: Where the first knot begins, in shares of what the quantity goes through, and how far the second one is from it, in
#: sizes of the quantity: of what swings about where it begins, three pieces that together span what it reaches.
_ONSETS, _WIDTH = (0.1, 0.4, 0.7), 0.8
#: Knots stay within so many sizes of the value about which the quantity moves.
_FARTHEST = 4.0
#: Of a delay by what its law is added to: product that is a time, meaning, starts, largest and smallest value. A state
#: at `rate` needs `s/rate` for its own size; at an input `u/rate` is the time between two readings.
_TIMES = {
    "rate": ("s/rate", "time in which it follows", (0.3, 3.0), 1000.0, 0.01),
    "u": ("u/rate", "time in which it follows", (10.0, 100.0), 3000.0, 1.0),
}
#: Role to the symbol that the function is of, the unit of what it is added to, and words.
_OF = {
    Role.STATE: ("s", "rate", "its own state"),
    Role.PAIR: ("o", "rate", "another quantity"),
    Role.PORT: ("o", "u", "an output"),
}


def completing() -> Iterator[Law]:
    """Every law of the basis.

    >>> [law.identifier for law in completing()][:2]
    ['rate_spline', 'rate_delayed_spline']
    """
    for role, prefix in ((Role.STATE, "rate"), (Role.PAIR, "coupling"), (Role.PORT, "port")):
        symbol, target, words = _OF[role]
        ramp = _ramp(symbol)
        strength = Number("a", target, "strength", (0.1, -0.1), 1000.0, None)
        onset, width = _onset(symbol), _width(symbol)
        yield Law(
            f"{prefix}_spline",
            f"piecewise linear function of {words}",
            role,
            f"a * {ramp}",
            (strength, onset, width),
            _SOURCE,
            is_named=False,
            is_completing=True,
        )
        delay = Number("settling_time", *_TIMES[target])
        yield Law(
            f"{prefix}_delayed_spline",
            f"piecewise linear function of {words}, delayed",
            role,
            "a * behind",
            (strength, onset, width, delay),
            _SOURCE,
            states=(OwnState("behind", f"({ramp} - behind) / settling_time", ramp, f"{symbol}/{symbol}"),),
            is_named=False,
            is_completing=True,
        )
        yield _hysteresis(role, prefix, symbol, words, strength)
    yield _spline_of_a_parameter()


def _spline_of_a_parameter() -> Law:
    """A parameter that is another one beyond a value of a quantity; what is left of it is more than nothing."""
    share = Number("a", "o/o", "change over the parameter's value", (0.3, -0.3), 10.0, -0.95)
    return Law(
        "parameter_spline",
        "parameter that is a piecewise linear function of a quantity",
        Role.PARAMETER,
        f"a * {_ramp('o')}",
        (share, _onset("o"), _width("o")),
        _SOURCE,
        is_named=False,
        is_completing=True,
        is_share=True,
    )


def _ramp(symbol: str) -> str:
    """0 below the first knot, 1 above the second one."""
    return f"min(max(({symbol} - onset) / width, 0), 1)"


def _onset(symbol: str) -> Number:
    return Number("onset", symbol, "value at which it sets in", _ONSETS, _FARTHEST, -_FARTHEST, symbol)


def _width(symbol: str) -> Number:
    return Number("width", symbol, "over which it rises to its full size", (_WIDTH,), 2 * _FARTHEST, 0.02)


def _hysteresis(role: Role, prefix: str, symbol: str, words: str, strength: Number) -> Law:
    """The stop operator: the follower is dragged along at both ends of the width, behind half a reading."""
    ahead, back = f"max({symbol} - follower - width, 0 * {symbol})", f"min({symbol} - follower + width, 0 * {symbol})"
    return Law(
        f"{prefix}_hysteresis",
        f"hysteresis of {words}",
        role,
        f"a * min(max(({symbol} - follower) / width, -1), 1)",
        (strength, Number("width", symbol, "half of the way between the two ends after a turn", _TURNS, 4.0, 0.01)),
        _STOP_SOURCE,
        constants={"step": ("reading", 0.5)},
        states=(OwnState("follower", f"({ahead} + {back}) / step", symbol, symbol),),
        is_named=False,
        is_completing=True,
    )
