"""Generic terms: a dimensioned amplitude times a dimensionless function, for laws that nobody named.

Each acts on one equation (heat, resistance, stiffness, length). Its function phi takes variables made dimensionless
with the scales stated here, so that amplitudes are comparable and formulas dimensionally consistent (E. Buckingham,
Phys. Rev. 4 (1914) 345-376). A small library of functions of one or two variables is what sparse regression uses (S. L.
Brunton, J. L. Proctor and J. N. Kutz, PNAS 113 (2016) 3932-3937); here each is a term of the running model.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from diagnosis.candidates.candidate import CandidateTerm, Parameter, PlaceKind, State, Unit

_SOURCE = (
    "library: Brunton, Proctor and Kutz, PNAS 113 (2016) 3932-3937; scales: Buckingham, Phys. Rev. 4 (1914) 345-376"
)
#: Why both signs are tried.
SIGN_REASON = "size only: nothing is known about the sign of a law without a name"
_SECOND = "a coil that loses or gains twice what it loses at 30 K is another coil"
_THIRD = "what changes a coil by more than about a third is no correction of its law, but another law"
#: Amplitudes are what is there where the function of the variables is 1.
AT_SCALE = " where the variables are at their scales"
#: A delay behind which a generic term acts: what is far slower than the coil itself is a drift.
DELAY_REASON = "what is thirty times as slow as the coil is a drift over a recording"
#: Places of a law that acts in few coils.
LOCAL: tuple[PlaceKind, ...] = ("all", "string", "coil")
_PLACES: tuple[PlaceKind, ...] = (
    "all",
    "string",
    "coil",
    "row_gradient",
    "column_gradient",
    "string_ends",
    "outer_strings",
    "edge",
)

#: Variable: formula that makes it dimensionless (in C and in Python alike), and its name in words.
VARIABLES: Mapping[str, tuple[str, str]] = {
    "excess": ("(T - T_ambient) / 30.0", "temperature above the surroundings"),
    "power": ("P / 0.4", "electrical power"),
    "rate": ("dTdt / 5.0", "rate of the temperature"),
    "time": ("t / 60.0", "time"),
    "energy": ("energy / 10.0", "electrical energy so far"),
    "stretch": ("extension / 0.005", "extension"),
    "phase": ("phase", "share of austenite"),
    "amperes": ("I / 0.4", "current"),
    "pull": ("tension", "tension (scale 1 N)"),
}

#: Function of one variable: formula.
FORMS: Mapping[str, str] = {
    "linear": "{v}",
    "square": "({v}) * ({v})",
    "cube": "({v}) * ({v}) * ({v})",
    "absolute": "fabs({v})",
    "saturating": "3.0 * ({v}) / (1.0 + 2.0 * fabs({v}))",
}


@dataclass(frozen=True)
class Target:
    """An equation that a generic term may act on.

    Args:
        unit: Part of the model.
        hook: Hook of the network.
        line: C line that adds `a * phi`.
        law: Formula of the same.
        amplitude: Unit of the amplitude.
        bound: Its largest size.
        plausible: Its largest size that is believed, as a multiple of `of`.
        of: Name of a scale of the rig.
        plausible_reason: Why.
        meaning: What the amplitude is.
        single: Variable to forms of it. What a base parameter or a named candidate is already is left out: heat linear
            in the excess is h A, resistance linear in it the temperature coefficient.
        products: Pairs of variables.
        delayed: Variables that act through a first-order delay.
    """

    unit: Unit
    hook: str
    line: str
    law: str
    amplitude: str
    bound: float
    plausible: float
    of: str
    plausible_reason: str
    meaning: str
    single: Mapping[str, tuple[str, ...]]
    products: tuple[tuple[str, str], ...]
    delayed: tuple[str, ...]


TARGETS: Mapping[str, Target] = {
    "heat": Target(
        "thermal",
        "heat",
        "heat += a * ({phi});",
        "heat = a * ({phi})",
        "W",
        2.0,
        1.0,
        "heat",
        _SECOND,
        "change of the heat into a coil" + AT_SCALE,
        {
            "excess": ("square", "cube", "saturating"),
            "power": ("square", "saturating"),
            "rate": ("linear", "absolute"),
            "time": ("linear", "square"),
            "energy": ("linear", "saturating"),
            "stretch": ("linear", "square"),
            "phase": ("linear", "square"),
            "amperes": ("linear",),
        },
        (
            ("excess", "time"),
            ("excess", "energy"),
            ("excess", "stretch"),
            ("excess", "phase"),
            ("excess", "power"),
            ("excess", "rate"),
            ("power", "time"),
            ("power", "energy"),
            ("power", "phase"),
        ),
        ("excess", "power", "stretch", "phase"),
    ),
    "resistance": Target(
        "electrical",
        "resistance",
        "R += a * reference_resistance * ({phi});",
        "R = R_0 + a * reference_resistance * ({phi})",
        "1",
        0.5,
        0.3,
        "",
        _THIRD,
        "change of the resistance, as a share of the reference resistance," + AT_SCALE,
        {
            "excess": ("square", "saturating"),
            "rate": ("linear",),
            "time": ("linear", "square"),
            "energy": ("linear", "saturating"),
            "stretch": ("linear", "square"),
            "power": ("linear",),
            "phase": ("square",),
            "amperes": ("linear", "square"),
            "pull": ("linear",),
        },
        (("excess", "phase"), ("excess", "stretch"), ("excess", "time"), ("stretch", "phase")),
        ("excess", "stretch", "phase"),
    ),
    "stiffness": Target(
        "stiffness",
        "stiffness",
        "added += a * ({phi});",
        "stiffness = stiffness_0 + a * ({phi})",
        "N/m",
        100.0,
        0.3,
        "stiffness",
        _THIRD,
        "change of the stiffness" + AT_SCALE,
        {
            "excess": ("linear", "square"),
            "rate": ("linear",),
            "time": ("linear",),
            "energy": ("linear",),
            "stretch": ("linear", "square"),
            "power": ("linear",),
            "phase": ("linear", "square"),
            "pull": ("linear",),
        },
        (("excess", "phase"), ("excess", "time"), ("stretch", "phase")),
        ("excess", "phase"),
    ),
    "length": Target(
        "mechanical",
        "length",
        "extension += a * ({phi});",
        "extension = extension_0 + a * ({phi})",
        "m",
        0.01,
        0.3,
        "stretch",
        _THIRD,
        "change of the extension" + AT_SCALE,
        {
            "excess": ("square",),
            "rate": ("linear",),
            "time": ("linear", "square"),
            "energy": ("linear",),
            "power": ("linear",),
            "phase": ("linear", "square"),
            "stretch": ("square",),
            "pull": ("square",),
        },
        (("excess", "phase"), ("excess", "stretch")),
        ("excess", "stretch", "phase"),
    ),
}


def _term(equation: str, name: str, phi: str, words: str, delay: Parameter | None = None) -> CandidateTerm:
    target = TARGETS[equation]
    amplitude = Parameter(
        "a",
        target.amplitude,
        -target.bound,
        target.bound,
        SIGN_REASON,
        is_amplitude=True,
        plausible=target.plausible,
        of=target.of,
        plausible_reason=target.plausible_reason,
        meaning=target.meaning,
    )
    lines = {target.hook: target.line.format(phi="delayed" if delay else phi)}
    law = target.law.format(phi="delayed" if delay else phi.replace("fabs", "abs"))
    if delay:
        lines["state"] = f"delayed_inflow = ({phi}) / tau;\ndelayed_rate = 1.0 / tau;"
        law += f"; tau * d(delayed) = {phi} - delayed"
    return CandidateTerm(
        identifier=f"unnamed_{equation}_{name}",
        name=f"unnamed term in {equation}: {words}",
        unit=target.unit,
        law=law,
        source=_SOURCE,
        parameters=(amplitude, delay) if delay else (amplitude,),
        places=_PLACES,
        lines=lines,
        signature=f"What is missing in {equation} follows {words}.",
        states=(State("delayed", "1", "0.0"),) if delay else (),
        is_named=False,
    )


def _terms(equation: str) -> Iterator[CandidateTerm]:
    target = TARGETS[equation]
    for variable, forms in target.single.items():
        formula, words = VARIABLES[variable]
        for form in forms:
            yield _term(equation, f"{form}_{variable}", FORMS[form].format(v=formula), f"{words}, {form}")
    for one, other in target.products:
        phi = f"({VARIABLES[one][0]}) * ({VARIABLES[other][0]})"
        yield _term(equation, f"{one}_times_{other}", phi, f"{VARIABLES[one][1]} times {VARIABLES[other][1]}")
    tau = Parameter(
        "tau",
        "s",
        0.05,
        1e4,
        "a delay is positive",
        plausible=30.0,
        of="time",
        plausible_reason=DELAY_REASON,
        meaning="time constant of the delay",
    )
    for variable in target.delayed:
        formula, words = VARIABLES[variable]
        yield _term(equation, f"delayed_{variable}", formula, f"{words}, delayed", tau)


def _between_neighbours() -> CandidateTerm:
    """Heat that goes from coil to coil: what one loses the other gains."""
    amplitude = Parameter(
        "a",
        "W",
        0.0,
        3.0,
        "heat flows from hot to cold",
        is_amplitude=True,
        plausible=3.0,
        of="heat",
        plausible_reason="coils that touch pass less than a few times what they lose",
        meaning="heat between two coils that touch, at a difference of 30 K",
    )
    return CandidateTerm(
        identifier="unnamed_heat_neighbour",
        name="unnamed term in heat: difference of temperature to coils that touch",
        unit="thermal",
        law="heat_a = -0.5 * (a_a + a_b) * (T_a - T_b) / 30.0; heat_b = -heat_a",
        source=_SOURCE,
        parameters=(amplitude,),
        places=("all", "string"),
        lines={"pairs": "exchange = 0.5 * (a_a + a_b) / 30.0;"},
        signature="What is missing in heat follows the difference of temperature between coils that touch.",
        is_named=False,
        fewest=2,
    )


CANDIDATES = (*(term for equation in TARGETS for term in _terms(equation)), _between_neighbours())
