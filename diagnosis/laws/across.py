"""Laws without a name over a quantity of another component, to which nothing connects the place where they act.

What a scenario leaves out may be a connection: the resistance of a feeder that grows with how far a tram has gone, a
motor that warms the gear beside it. Such a quantity acts in powers of first order alone: added, as a product with what
is there, or as a share of a parameter. They are tried where all other laws leave more than noise, for any quantity of
any component is one more place.
"""

from __future__ import annotations

from collections.abc import Iterator

from diagnosis.laws.law import Law, Number, Role

_FORM = "form of the formula: the first terms of a power series in a quantity of another component"
_SHARE = Number("a", "1/o_peak", "change over the parameter's value", (-0.1, 0.1), 2.0, None)


def across() -> Iterator[Law]:
    """Every such law.

    >>> [law.formula for law in across()]
    ['a * o', 'a * s * o', 'a * o', 'a * o', 'a * u * o', 'a * y * o']
    """
    yield _law("far_linear", "law of a quantity of another component", Role.FAR_RATE, "a * o", "rate/o")
    yield _law(
        "far_product", "law of a product with a quantity of another component", Role.FAR_RATE, "a * s * o", "rate/s/o"
    )
    yield Law(
        "far_parameter_change",
        "parameter that changes with a quantity of another component",
        Role.FAR_PARAMETER,
        "a * o",
        (_SHARE,),
        _FORM,
        is_named=False,
        is_share=True,
        series_of=("o",),
        is_completing=True,
    )
    yield _law("far_input", "law of a quantity of another component at an input", Role.FAR_INPUT, "a * o", "u/o")
    yield _law(
        "far_gain", "input that grows or falls with a quantity of another component", Role.FAR_INPUT, "a * u * o", "1/o"
    )
    words = "product of an output and a quantity of another component, at an input"
    yield _law("far_output_product", words, Role.FAR_PORT, "a * y * o", "u/y/o")


def _law(identifier: str, name: str, role: Role, formula: str, of: str) -> Law:
    strength = Number("a", of, "strength", (0.05, -0.05), 1000.0, None)
    factors = formula.split(" * ")[1:]
    series = tuple(factors) if len(factors) > 1 else ()  # an absolute temperature is no gain by itself
    return Law(
        identifier, name, role, formula, (strength,), _FORM, is_named=False, series_of=series, is_completing=True
    )
