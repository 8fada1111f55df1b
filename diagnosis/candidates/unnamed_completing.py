"""Generic terms that complete a description: free-knot splines, every product of two variables, every delay.

The laws of `unnamed` and `unnamed_shapes` are few, so that one of them can be told from a law with a name. Where
everything that was tried leaves more than noise, a sum of terms of one systematic basis describes what is left: in
every equation, each variable through a piecewise linear function with two free knots (constant outside them, so that it
does not run away beyond what was recorded), the same behind a first-order delay, and each product of two variables. No
shape stands for any particular law.

Source: D. L. B. Jupp, SIAM J. Numerical Analysis 15 (1978) 328-343 (splines with free knots); J. H. Friedman, Annals of
Statistics 19 (1991) 1-67 (sums of such functions and their products); K. S. Narendra and P. G. Gallman, IEEE Trans.
Automatic Control 11 (1966) 546-550 (a function of one variable, then a linear memory).
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from diagnosis.candidates.candidate import CandidateTerm, Parameter, State, Unit
from diagnosis.candidates.unnamed import AT_SCALE, DELAY_REASON, LOCAL, SIGN_REASON, TARGETS, VARIABLES

_SOURCE = (
    "D. L. B. Jupp, SIAM J. Numerical Analysis 15 (1978) 328-343; J. H. Friedman, Annals of Statistics 19 (1991) 1-67; "
    "K. S. Narendra and P. G. Gallman, IEEE Trans. Automatic Control 11 (1966) 546-550"
)
_INSIDE = "a knot lies within what the variable reaches"
_FIRST, _WIDTH = "at which it sets in", "over which it rises to its full size"


@dataclass(frozen=True)
class Knots:
    """Where knots of a variable may lie.

    Args:
        formula: The variable, SI.
        unit: Its unit.
        reach: What it reaches, as a multiple of `of`.
        of: Name of a scale of the rig.
        is_signed: Whether it goes to both sides of 0.
    """

    formula: str
    unit: str
    reach: float
    of: str = ""
    is_signed: bool = False


#: A step of the power shows the rate that heats by 30 K in a time constant, and up to twice of it.
KNOTS: Mapping[str, Knots] = {
    "excess": Knots("T - T_ambient", "K", 60.0),
    "power": Knots("P", "W", 2.0, "heat"),
    "rate": Knots("dTdt", "K/s", 2.0, "rate", is_signed=True),
    "stretch": Knots("extension", "m", 1.0, "stretch"),
    "phase": Knots("phase", "1", 1.0),
    "amperes": Knots("I", "A", 1.0),
}
#: Variables of which products are taken and that act behind a delay: the course of time has no delay.
_CROSSED = ("excess", "power", "rate", "time", "stretch", "phase", "amperes")


@dataclass(frozen=True)
class Equation:
    """An equation that is completed.

    Args:
        unit: Part of the model.
        hook: Hook of the network.
        line: C line that adds `a * phi`.
        law: Formula of the same.
        amplitude: Its number.
        variables: That may enter.
    """

    unit: Unit
    hook: str
    line: str
    law: str
    amplitude: Parameter
    variables: tuple[str, ...] = _CROSSED


def _amplitude(
    unit: str, bound: float, plausible: float, of: str, why: str, meaning: str, negligible: float = 0.0
) -> Parameter:
    return Parameter(
        "a",
        unit,
        -bound,
        bound,
        SIGN_REASON,
        is_amplitude=True,
        negligible=negligible,
        plausible=plausible,
        of=of,
        plausible_reason=why,
        meaning=meaning,
    )


def _equations() -> dict[str, Equation]:
    found = {
        name: Equation(
            t.unit,
            t.hook,
            t.line,
            t.law,
            _amplitude(t.amplitude, t.bound, t.plausible, t.of, t.plausible_reason, t.meaning),
        )
        for name, t in TARGETS.items()
    }
    found["shift"] = Equation(
        "stiffness",
        "stiffness",
        "shift += a * ({phi});",
        "shift = a * ({phi})",
        _amplitude(
            "K",
            40.0,
            20.0,
            "",
            "neighbouring alloys of one series differ by 20 K",
            "shift of the transformation temperatures" + AT_SCALE,
            0.5,
        ),
    )
    found["force"] = Equation(
        "mechanical",
        "load",
        "tension += a * ({phi});",
        "tension = load + a * ({phi})",
        _amplitude(
            "N",
            1.0,
            0.5,
            "load",
            "what holds more than half of the load lets nothing move",
            "change of the force" + AT_SCALE,
        ),
    )
    return found


EQUATIONS = _equations()


def _as_law(phi: str) -> str:
    """A C expression as a formula."""
    begin, end = "clip(", ", 0.0, 1.0)"
    if not phi.startswith(begin):
        return phi
    return f"min(max({phi.removeprefix(begin).removesuffix(end)}, 0), 1)"


def _term(
    equation: str, name: str, words: str, phi: str, shape: tuple[Parameter, ...] = (), is_delayed: bool = False
) -> CandidateTerm:
    own = EQUATIONS[equation]
    lines = {own.hook: own.line.format(phi="delayed" if is_delayed else phi)}
    law = own.law.format(phi="delayed" if is_delayed else _as_law(phi))
    if is_delayed:
        lines["state"] = f"delayed_inflow = ({phi}) / tau;\ndelayed_rate = 1.0 / tau;"
        law += f"; tau * d(delayed) = {_as_law(phi)} - delayed"
        tau = Parameter(
            "tau",
            "s",
            0.05,
            1e4,
            "a delay is positive",
            plausible=30.0,
            of="time",
            plausible_reason=DELAY_REASON,
            count=2,
            meaning="time constant of the delay",
        )
        shape = (*shape, tau)
    return CandidateTerm(
        identifier=f"unnamed_{equation}_{name}",
        name=f"unnamed term in {equation}: {words}",
        unit=own.unit,
        law=law,
        source=_SOURCE,
        parameters=(own.amplitude, *shape),
        places=LOCAL,
        lines=lines,
        signature=f"What is missing in {equation} follows {words}.",
        states=(State("delayed", "1", "0.0"),) if is_delayed else (),
        is_named=False,
        is_completing=True,
    )


def _ramp(variable: str, widths: int) -> tuple[str, tuple[Parameter, ...]]:
    """Formula of a piecewise linear function with two knots, and their parameters."""
    knots = KNOTS[variable]
    bound = 1e3 if knots.of == "heat" else {"K": 500.0, "K/s": 500.0, "m": 0.2, "1": 1.0, "A": 100.0}[knots.unit]
    of_what = VARIABLES[variable][1] + " "
    onset = Parameter(
        "onset",
        knots.unit,
        -bound if knots.is_signed else 0.0,
        bound,
        _INSIDE,
        plausible=knots.reach,
        of=knots.of,
        plausible_reason=_INSIDE,
        is_position=True,
        meaning=of_what + _FIRST,
    )
    width = Parameter(
        "width",
        knots.unit,
        1e-3 * min(bound, 1.0),
        bound,
        "a function has no jump",
        plausible=knots.reach,
        of=knots.of,
        plausible_reason=_INSIDE,
        count=widths,
        meaning=of_what + _WIDTH,
    )
    return f"clip(({knots.formula} - onset) / width, 0.0, 1.0)", (onset, width)


def _known(equation: str) -> set[str]:
    """Products and delays that the library of generic laws has already."""
    target = TARGETS.get(equation)
    if target is None:
        return {"delayed_excess"} if equation == "shift" else set()
    return {f"{a}_times_{b}" for a, b in target.products} | {f"delayed_{v}" for v in target.delayed}


def _of(equation: str) -> Iterator[CandidateTerm]:
    own, known = EQUATIONS[equation], _known(equation)
    for variable in own.variables:
        if variable in KNOTS:
            words = VARIABLES[variable][1]
            phi, shape = _ramp(variable, 2)
            yield _term(equation, f"spline_{variable}", f"{words}, piecewise linear", phi, shape)
            phi, shape = _ramp(variable, 1)
            yield _term(equation, f"delayed_spline_{variable}", f"{words}, piecewise linear, delayed", phi, shape, True)
    for one, other in itertools.combinations_with_replacement(own.variables, 2):
        if equation == "heat" and one == other == "rate":
            continue  # heat that grows with the square of the rate that it causes has no solution
        if not known & {f"{one}_times_{other}", f"{other}_times_{one}"}:
            phi = f"({VARIABLES[one][0]}) * ({VARIABLES[other][0]})"
            words = f"{VARIABLES[one][1]} times {VARIABLES[other][1]}"
            yield _term(equation, f"{one}_times_{other}", words, phi)


def _of_value() -> Iterator[CandidateTerm]:
    """What a sensor reads, by its own reading and the time."""
    scale = Parameter("scale", "unit of the channel", 1e-9, 1000.0, "given", (10.0,), is_fixed=True)
    pivot = Parameter("pivot", "unit of the channel", -1000.0, 1000.0, "given", (0.0, 295.15), is_fixed=True)
    reading = "(value - pivot) / scale"
    size = _amplitude(
        "1",
        1.0,
        0.3,
        "",
        "off by a third of its range: no sensor",
        "change of the reading, as a share of what the channel typically departs by",
    )
    departure = "change of the reading from its pivot, in typical departures, "
    reach = "six typical departures are all that a channel shows"
    onset = Parameter(
        "onset",
        "1",
        0.0,
        100.0,
        _INSIDE,
        plausible=6.0,
        plausible_reason=reach,
        is_position=True,
        meaning=departure + _FIRST,
    )
    width = Parameter(
        "width", "1", 1e-3, 100.0, "no jump", plausible=6.0, plausible_reason=reach, count=2, meaning=departure + _WIDTH
    )
    for name, words, phi, shape in (
        (
            "spline",
            "the reading itself, piecewise linear",
            f"clip(({reading} - onset) / width, 0.0, 1.0)",
            (onset, width),
        ),
        ("times_time", "the reading itself times time", f"{reading} * t / 60.0", ()),
        ("square_time", "time, square", "t * t / 3600.0", ()),
    ):
        yield CandidateTerm(
            identifier=f"unnamed_value_{name}",
            name=f"unnamed term in value: {words}",
            unit="measurement",
            law=f"value = truth + a * scale * ({_as_law(phi).replace('value', 'truth')})",
            source=_SOURCE,
            parameters=(size, *shape, scale, *((pivot,) if "pivot" in phi else ())),
            places=("channel", "quantity"),
            lines={"sensor": f"value += a * scale * ({phi});"},
            signature=f"What is missing in value follows {words}.",
            is_named=False,
            is_completing=True,
        )


CANDIDATES = (*(term for equation in EQUATIONS for term in _of(equation)), *_of_value())
