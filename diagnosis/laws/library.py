"""All laws, from one file each, and laws without a name that follow a pattern."""

from __future__ import annotations

import functools
import importlib
import pkgutil
from dataclasses import replace

import diagnosis.laws as package
from diagnosis.laws.across import across
from diagnosis.laws.at_inputs import at_inputs
from diagnosis.laws.completing import completing
from diagnosis.laws.law import Law, Number, OwnState, Role

#: Folders of laws with a file each, in the order in which they are tried; others that are there come after them.
FOLDERS = ("motion", "heat", "fluid", "electrical", "signal")
_FORM = "form of the formula: a power series of what is missing"
#: Form to its formula over one quantity o, the product of symbols that divides its strength, and its name.
_FORMS = {
    "linear": ("o", "o"),
    "squared": ("o ** 2", "o**2"),
    "signed_square": ("abs(o) * o", "o**2"),
    "cubed": ("o ** 3", "o**3"),
}


def folders() -> list[str]:
    """Folders of laws with a file each: every package in `diagnosis/laws/` but that of patterns."""
    there = [m.name for m in pkgutil.iter_modules(package.__path__) if m.ispkg and m.name != "generic"]
    return sorted(there, key=lambda name: (FOLDERS.index(name) if name in FOLDERS else len(FOLDERS), name))


@functools.cache
def library() -> tuple[Law, ...]:
    """Every law: those with a name, those without, and the basis that completes a description.

    >>> next(law.name for law in library() if law.identifier == "cubic_spring")
    'spring that hardens or softens (Duffing)'
    """
    named = []
    for folder in folders():
        where = importlib.import_module(f"{package.__name__}.{folder}")
        for module in sorted(m.name for m in pkgutil.iter_modules(where.__path__)):
            named.append(importlib.import_module(f"{where.__name__}.{module}").LAW)
    return (
        *sorted((*named, *at_inputs(named), *_generic()), key=lambda law: not law.is_named),
        *completing(),
        *across(),
    )


def _generic() -> list[Law]:
    """Laws without a name: constants, powers and products."""
    found = [_law("constant", "constant rate", Role.STATE, "a", "rate")]
    for name, (formula, power) in _FORMS.items():
        own = formula.replace("o", "s"), power.replace("o", "s")
        forms = [
            _law(f"rate_{name}", "law of its own state", Role.STATE, f"a * {own[0]}", f"rate/({own[1]})"),
            _law(f"coupling_{name}", "law of another quantity", Role.PAIR, f"a * {formula}", f"rate/({power})"),
            _law(f"port_{name}", "law of an output at an input", Role.PORT, f"a * {formula}", f"u/({power})"),
        ]
        # A slope stays one about 0: where a law with a name is the same, only that one is tried.
        found += [replace(law, series_of=() if name == "linear" else (of,)) for law, of in zip(forms, ("s", "o", "o"))]
    product = _law("rate_of_product", "law of a product", Role.PAIR, "a * s * o", "rate/s/o")
    found += [replace(product, series_of=("s", "o")), *_modulated()]
    sign = {"rounding": ("s", 0.01)}
    found.append(
        _law("rate_of_sign", "law of the sign of its own state", Role.STATE, "a * tanh(s / rounding)", "rate", sign)
    )
    sign = {"rounding": ("o", 0.01)}
    found.append(_law("port_of_sign", "law of the sign of an output", Role.PORT, "a * tanh(o / rounding)", "u", sign))
    return [*found, *_scaled(), _changing(), _worn(), *_read(), _beside_a_state(), *_with_memory(), *_corrections()]


def _read() -> list[Law]:
    """What the equation of an output lacks: a force that stretches what is measured, a current that is no state."""
    found = []
    for name, (formula, power) in _FORMS.items():
        words = "law of a state or input in an output"
        law = _law(f"reading_{name}", words, Role.READING, f"a * {formula}", f"y/({power})")
        found.append(replace(law, series_of=() if name == "linear" else ("o",)))
    return found


def _modulated() -> list[Law]:
    """An exchange that is there, and that a third quantity drives: heat that a flow carries, a valve, a clutch."""
    words = "exchange that grows or falls with a third quantity"
    ratio = Number("ratio", "d/d", "what the other part gets, as a multiple", (0.3, 1.0, 3.0), 1e3, 1e-3)
    inside = _law("modulated_exchange", words, Role.MODULATED, "-a * d * o", "rate/d/o")
    outside = _law("modulated_loss", words, Role.MODULATED_BY_INPUT, "-a * (s - r) * o", "rate/s/o")
    numbers = (*inside.numbers, ratio)
    inside = replace(inside, numbers=numbers, reaction="ratio * a * d * o", reacts_on="r")
    return [replace(law, series_of=("o",)) for law in (inside, outside)]


def _scaled() -> list[Law]:
    """A capacity or an inertia that changes: the whole derivative grows or falls, by its state or another quantity."""
    own = _law("rate_scaled", "capacity or inertia that changes with its state", Role.STATE, "a * s", "1/s")
    other = _law("rate_scaled", "capacity or inertia that changes with another quantity", Role.PAIR, "a * o", "1/o")
    other = replace(other, identifier="rate_scaled_by_another")
    return [replace(law, is_share=True, series_of=(of,)) for law, of in ((own, "s"), (other, "o"))]


def _changing() -> Law:
    """A parameter that is no constant: a resistance that grows with the temperature, a valve's coefficient, a gap."""
    words = "parameter that changes with a quantity"
    strength = Number("a", "1/o_peak", "change over the parameter's value", (-0.1, 0.1), 2.0, None)
    formula, series = "a * o", ("o",)
    return Law(
        "parameter_change",
        words,
        Role.PARAMETER,
        formula,
        (strength,),
        _FORM,
        is_named=False,
        is_share=True,
        series_of=series,
    )


def _worn() -> Law:
    """A parameter that changes by what has passed since the begin: a sorbent is used up, a filter clogs.

    What is used up does not come to less than nothing, so the share ends short of -1.
    """
    return Law(
        "parameter_worn",
        "parameter that changes with what has passed since the begin",
        Role.PARAMETER,
        "max(a * passed, -0.95)",
        (Number("a", "1/(o_peak*duration)", "change for each unit that has passed", (-0.1, 0.1), 100.0, None),),
        "J. F. Archard, J. Applied Physics 24 (1953) 981-988 (wear in proportion to the way)",
        states=(OwnState("passed", "abs(o)", "0 * o * time", "o*duration"),),
        is_named=False,
        is_share=True,
        series_of=("o",),
    )


def _beside_a_state() -> Law:
    """A hidden second state that takes part in what a state does, as `second_mass` in a temperature."""
    time = Number("settling_time", "s/rate", "time in which it follows", (0.3, 3.0), 1000.0, 0.01)
    return Law(
        "rate_hidden_state",
        "hidden state beside a state",
        Role.STATE,
        "a * (s - inside)",
        (Number("a", "rate/s", "strength", (-0.3, 0.3), 1000.0, None), time),
        _FORM,
        states=(OwnState("inside", "(s - inside) / settling_time", "s", "s"),),
        is_named=False,
    )


#: An output behind a delay of one reading, and the derivative of the output that follows from it.
_BEHIND = OwnState("behind", "(o - behind) / step", "o", "o")
_SLOPE = "((o - behind) / step)"
_READING = {"step": ("u/rate", 1.0)}


def _with_memory() -> list[Law]:
    """Laws at an input over the rate of an output or over its past: what hidden states would do."""
    rate = "o*rate/u"
    found = [
        _law("port_of_rate", "law of the rate of an output", Role.PORT, f"a * {_SLOPE}", f"u/({rate})", _READING),
        _law(
            "port_of_squared_rate",
            "law of the squared rate of an output",
            Role.PORT,
            f"a * abs({_SLOPE}) * {_SLOPE}",
            f"u/({rate})**2",
            _READING,
        ),
        _law(
            "port_of_sign_of_rate",
            "law of the sign of the rate of an output",
            Role.PORT,
            f"a * tanh({_SLOPE} / rounding)",
            "u",
            {**_READING, "rounding": (rate, 0.002)},
        ),
    ]
    hidden = Law(
        "port_hidden_state",
        "hidden state beside an output, acting on an input",
        Role.PORT,
        "a * (o - inside)",
        (Number("a", "u/o", "strength", (0.05, -0.05), 1000.0, None), _time("settling_time", "u/rate")),
        _FORM,
        states=(OwnState("inside", "(o - inside) / settling_time", "o", "o"),),
        is_named=False,
    )
    return [
        *(replace(law, states=(_BEHIND,)) for law in found),
        hidden,
        _beyond("above", "o - edge"),
        _beyond("below", "edge - o"),
    ]


def _beyond(side: str, distance: str) -> Law:
    """What an end stop would do, seen at an input."""
    edges = (0.65, 0.8) if side == "above" else (0.35, 0.2)
    numbers = (
        Number("a", "u/o", "strength", (0.5, -0.5), 1e4, None),
        Number("edge", "o", "value from which it acts", edges, 2.0, -2.0, "o"),
    )
    formula = f"a * max({distance}, 0 * o)"
    return Law(
        f"port_{side}_edge", f"law of an output {side} an edge", Role.PORT, formula, numbers, _FORM, is_named=False
    )


def _corrections() -> list[Law]:
    """Laws at an output: static ones, and correction states, which follow an input or output behind a delay."""
    found = [
        _law("output_offset", "offset of an output", Role.OUTPUT, "a", "y"),
    ]
    for name, word, exponent in (("squared", "square", 2), ("cubed", "cube", 3)):
        of = f"1/y**{exponent - 1}"
        law = _law(
            f"output_{name}", f"distortion of an output with its {word}", Role.OUTPUT, f"a * y ** {exponent}", of
        )
        found.append(replace(law, series_of=("y",)))
    for name, (formula, power) in {"linear": ("o", "o"), "squared": ("o ** 2", "o**2")}.items():
        static = _law(
            f"response_{name}",
            "law of another quantity at an output",
            Role.RESPONSE_TO_ANOTHER,
            f"a * {formula}",
            f"y/({power})",
        )
        found.append(static if name == "linear" else replace(static, series_of=("o",)))
        strength = Number("a", f"y/({power})", "strength", (0.05, -0.05), 1000.0, None)
        state = OwnState("correction", f"(a * {formula} - correction) / settling_time", f"a * {formula}", "y")
        found.append(
            Law(
                f"correction_state_{name}",
                "correction state of an output",
                Role.RESPONSE,
                "correction",
                (strength, _time("settling_time", "y/rate")),
                _FORM,
                states=(state,),
                is_named=False,
                series_of=("o",) if name == "squared" else (),
            )
        )
    return found


def _time(name: str, of: str) -> Number:
    return Number(name, of, "time in which it follows", (10.0, 100.0), 3000.0, 1.0)


def _law(
    identifier: str, name: str, role: Role, formula: str, of: str, constants: dict[str, tuple[str, float]] | None = None
) -> Law:
    strength = Number("a", of, "strength", (0.05, -0.05), 1000.0, None)
    return Law(identifier, name, role, formula, (strength,), _FORM, constants or {}, is_named=False)
