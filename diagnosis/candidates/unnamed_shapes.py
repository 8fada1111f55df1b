"""Generic terms beyond sums of smooth functions: thresholds, steps, changes, and equations that only few laws act on.

The same idea as in `unnamed`: an amplitude with a unit times a dimensionless function. A threshold is a hinge
(J. H. Friedman, Annals of Statistics 19 (1991) 1-67), a sign of motion the play operator (M. Brokate and J. Sprekels,
Hysteresis and Phase Transitions, Springer 1996, chapter 2), a change a variable less its own first-order delay. Where a
term can only take energy, its amplitude is not negative.
"""

from __future__ import annotations

from collections.abc import Iterator

from diagnosis.candidates.candidate import CandidateTerm, Parameter, Physical, PlaceKind, State, Unit
from diagnosis.candidates.unnamed import AT_SCALE, DELAY_REASON, LOCAL, SIGN_REASON, VARIABLES

_SOURCE = "J. H. Friedman, Annals of Statistics 19 (1991) 1-67; M. Brokate and J. Sprekels, Hysteresis and Phase "
_SOURCE += "Transitions, Springer 1996, chapter 2"
_PASSIVE = "it only takes energy"
_EVERY: tuple[PlaceKind, ...] = (*LOCAL, "row_gradient", "column_gradient", "string_ends", "outer_strings", "edge")
_TAU = Parameter(
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
_HEAT = "a coil that loses or gains twice what it loses at 30 K is another coil"
_COOLING = Parameter(
    "a",
    "W",
    -0.2,
    2.0,
    "cooling stays cooling",
    is_amplitude=True,
    plausible=1.0,
    of="heat",
    plausible_reason=_HEAT,
    meaning="change of the heat out of a coil, 30 K above the surroundings",
)
_THIRD = "what changes a coil by more than about a third is no correction of its law, but another law"
_HALF = "what holds more than half of the load lets nothing move"
_SERIES = "a contact that takes the heat of three coils on its small surface burns or opens"
_OHMS = "change of the resistance, as a share of the reference resistance," + AT_SCALE
_SLOW = "what lags by more than 20 s is seen by eye"
_INSTANT = Parameter("instant", "s", -1000000.0, 1000000.0, "within the recordings", (10.0,))
#: What changes a heat balance at once comes from outside (a fan, the sun); what changes in a circuit is a fault.
_OF_DAY, _OF_RIG = "heat from the surroundings is of that day", "a fault of a circuit stays until it is repaired"


#: Generic terms whose law is that of a named candidate.
_SAME = {
    "series_step": "loose_contact",
    "series_linear": "contact_resistance",
    "series_cube": "self_heating_lead",
    "supply_linear": "supply_source_resistance",
    "supply_hinge": "supply_current_limit",
    "force_sign_motion": "slide_friction",
    "length_sign_motion": "backlash",
    "heat_excess_times_step": "draught",
    "shift_linear_pull": "stress_dependent_transformation",
    "shift_constant": "transformation_shift",
    "force_linear_stretch": "supply_wire_stiffness",
    "length_linear_excess": "thermal_contraction",
    "resistance_linear_excess": "temperature_dependent_resistance",
    "resistance_linear_phase": "phase_dependent_resistance",
}
#: Temperature above that of the data sheet: what laws of a metal are written in.
_WARMTH = "(T - reference_temperature) / 30.0"


def _amplitude(
    unit: str,
    bound: float,
    plausible: tuple[float, str, str],
    is_passive: bool = False,
    negligible: float = 0.0,
    meaning: str = "",
    physical: Physical = "",
) -> Parameter:
    """The strength of a term; `plausible` is the largest size that is believed, the scale it counts in, and why."""
    most, of, why = plausible
    return Parameter(
        "a",
        unit,
        0.0 if is_passive else -bound,
        bound,
        _PASSIVE if is_passive else SIGN_REASON,
        is_amplitude=True,
        negligible=negligible,
        plausible=most,
        of=of,
        plausible_reason=why,
        meaning=meaning,
        physical=physical,
    )


def _term(
    identity: tuple[Unit, str, str],
    law: str,
    parameters: tuple[Parameter, ...],
    lines: dict[str, str],
    places: tuple[PlaceKind, ...] = LOCAL,
    states: tuple[State, ...] = (),
) -> CandidateTerm:
    unit, name, words = identity
    reason = "" if _INSTANT not in parameters else _OF_DAY if unit == "thermal" else _OF_RIG
    equation = name.split("_", 1)[0]
    return CandidateTerm(
        identifier=f"unnamed_{name}",
        name=f"unnamed term in {equation}: {words}",
        unit=unit,
        law=law,
        source=_SOURCE,
        parameters=parameters,
        places=places,
        lines=lines,
        signature=f"What is missing in {equation} follows {words}.",
        states=states,
        is_named=False,
        same_as=_SAME.get(name, ""),
        scope="day" if reason == _OF_DAY else "rig",
        scope_reason=reason,
    )


def _delayed(formula: str) -> tuple[dict[str, str], tuple[State, ...]]:
    """A variable behind a first-order delay `tau`."""
    line = f"delayed_inflow = ({formula}) / tau;\ndelayed_rate = 1.0 / tau;"
    return {"state": line}, (State("delayed", "1", "0.0"),)


def _of_shift() -> Iterator[CandidateTerm]:
    """Shift of the transformation temperatures [K]."""
    size = _amplitude(
        "K",
        40.0,
        (20.0, "", "neighbouring alloys of one series differ by 20 K"),
        negligible=0.5,
        meaning="shift of the transformation temperatures" + AT_SCALE,
    )  # no rig knows it better
    for form, variable in (
        ("linear", "rate"),
        ("absolute", "rate"),
        ("linear", "time"),
        ("linear", "energy"),
        ("linear", "power"),
        ("linear", "stretch"),
        ("linear", "pull"),
    ):
        formula, words = VARIABLES[variable]
        phi = f"fabs({formula})" if form == "absolute" else formula
        identity: tuple[Unit, str, str] = ("stiffness", f"shift_{form}_{variable}", f"{words}, {form}")
        law = f"shift = a * ({phi.replace('fabs', 'abs')})"
        yield _term(identity, law, (size,), {"stiffness": f"shift += a * ({phi});"})
    yield _term(
        ("stiffness", "shift_constant", "no variable, constant"), "shift = a", (size,), {"stiffness": "shift += a;"}
    )
    formula, words = VARIABLES["excess"]
    lines, states = _delayed(formula)
    yield _term(
        ("stiffness", "shift_delayed_excess", f"{words}, delayed"),
        f"shift = a * delayed; tau * d(delayed) = {formula} - delayed",
        (size, _TAU),
        {"stiffness": "shift += a * delayed;", **lines},
        states=states,
    )


def _of_force() -> Iterator[CandidateTerm]:
    """Force on a coil [N], and what holds its motion."""
    size = _amplitude("N", 1.0, (0.5, "load", _HALF), meaning="change of the force" + AT_SCALE)
    for name, phi, words in (
        ("linear_pull", VARIABLES["pull"][0], "tension (scale 1 N), linear"),
        ("square_amperes", "({v}) * ({v})".format(v=VARIABLES["amperes"][0]), "current, square"),
        ("linear_excess", VARIABLES["excess"][0], "temperature above the surroundings, linear"),
        ("linear_time", VARIABLES["time"][0], "time, linear"),
    ):
        law = f"tension = load + a * ({phi})"
        yield _term(("mechanical", f"force_{name}", words), law, (size,), {"load": f"tension += a * ({phi});"})
    yield _term(
        ("mechanical", "force_hinge_stretch", "extension, beyond a threshold"),
        "tension = stiffness * extension + a * max(extension - onset, 0)",
        (
            _amplitude(
                "N/m",
                5000.0,
                (10.0, "stiffness", "a stop of ten times the coil's stiffness is rigid"),
                is_passive=True,
                meaning="spring constant of the stop",
            ),
            Parameter(
                "onset",
                "m",
                0.0,
                0.05,
                "a threshold that is reached",
                plausible=1.0,
                of="stretch",
                plausible_reason="a threshold on the coil's way",
                is_position=True,
                meaning="extension at which the stop is met",
                count=4,
            ),
        ),
        {"length": "extension -= a * most(extension - onset, 0.0) / (stiffness + a);"},
    )
    yield _term(
        ("mechanical", "force_linear_stretch", "extension, linear"),
        "tension = stiffness * extension + a * (extension - reach)",
        (
            _amplitude(
                "N/m",
                300.0,
                (0.5, "stiffness", "half of the coil's own stiffness carries a third of its load"),
                is_passive=True,
                meaning="spring constant beside the coil",
            ),
            Parameter(
                "reach",
                "m",
                -0.05,
                0.05,
                "extension at which it is slack",
                plausible=1.0,
                of="stretch",
                plausible_reason="it is slack somewhere on the coil's way",
                meaning="extension at which it is slack",
                is_position=True,
            ),
        ),
        {"length": "extension -= a * (extension - reach) / (stiffness + a);"},
    )
    yield _term(
        ("mechanical", "length_linear_excess", "temperature, linear"),
        f"extension = extension_0 + a * {_WARMTH}",
        (_amplitude("m", 0.006, (0.3, "stretch", _THIRD), meaning="change of the extension by 30 K"),),
        {"length": f"extension += a * {_WARMTH};"},
    )
    yield _term(
        ("mechanical", "force_sign_motion", "direction of the motion"),
        "abs(tension - stiffness * extension) <= a",
        (
            _amplitude(
                "N", 1.0, (0.5, "load", _HALF), is_passive=True, meaning="force that is held, of either direction"
            ),
        ),
        {"length": "extension = clip(extension_before, extension - a / stiffness, extension + a / stiffness);"},
    )
    yield _term(
        ("mechanical", "length_delayed", "itself, delayed"),
        "a * d(extension_marker) = extension - extension_marker",
        (_amplitude("s", 100.0, (20.0, "", _SLOW), is_passive=True, meaning="time constant of the motion"),),
        {"length": "extension += (extension_before - extension) * exp(-dt / most(a, 1e-9));"},
    )
    yield _term(
        ("mechanical", "length_sign_motion", "direction of the motion"),
        "abs(extension_marker - extension) <= a",
        (
            _amplitude(
                "m",
                0.005,
                (0.135, "stretch", "half of the largest play that is believed"),
                is_passive=True,
                meaning="half of the play",
            ),
        ),
        {"length": "extension = clip(extension_before, extension - a, extension + a);"},
    )


def _of_heat() -> Iterator[CandidateTerm]:
    """Heat [W]: what no smooth function of the coil's own variables is."""
    watts = _amplitude("W", 2.0, (1.0, "heat", _HEAT), meaning="change of the heat into a coil" + AT_SCALE)
    excess, words = VARIABLES["excess"]
    yield _term(
        ("thermal", "heat_linear_excess", f"{words}, linear"),
        f"heat = -a * ({excess})",
        (_COOLING,),
        {"heat": "conductance += a / 30.0;"},
        _EVERY,
    )
    yield _term(
        ("thermal", "heat_hinge_excess", "temperature beyond a threshold"),
        "heat = a * max(T - onset, 0) / 30.0",
        (
            watts,
            Parameter(
                "onset",
                "K",
                200.0,
                600.0,
                "a threshold that is reached",
                plausible=60.0,
                plausible_reason="a threshold between a room and where the coil has transformed",
                is_position=True,
                origin=295.15,
                meaning="temperature from which it acts",
            ),
        ),
        {"heat": "heat += a * most(T - onset, 0.0) / 30.0;"},
    )
    yield _term(
        ("thermal", "heat_step", "an instant"),
        "heat = a * step(t - instant)",
        (watts, _INSTANT),
        {"heat": "heat += a * share_after(instant, t_begin, t_end);"},
    )
    yield _term(
        ("thermal", "heat_excess_times_step", f"{words} after an instant"),
        f"heat = -a * ({excess}) * step(t - instant)",
        (_COOLING, _INSTANT),
        {"heat": "conductance += a / 30.0 * share_after(instant, t_begin, t_end);"},
    )
    stretch, words = VARIABLES["stretch"]
    lines, states = _delayed(stretch)
    yield _term(
        (
            "thermal",
            "heat_excess_times_change_of_stretch",
            "temperature above the surroundings times change of extension",
        ),
        f"heat = a * ({excess}) * abs({stretch} - delayed) / tau; tau * d(delayed) = {stretch} - delayed",
        (
            _amplitude("W*s", 20.0, (30.0, "capacity", "heat that warms the coil by 30 K"), meaning="heat" + AT_SCALE),
            Parameter(
                "tau",
                "s",
                0.05,
                1e3,
                "a delay is positive",
                plausible=3.0,
                of="time",
                plausible_reason="a change is over once the coil has followed it",
                meaning="time constant of the change",
            ),
        ),
        {"heat": f"heat += a * ({excess}) * fabs({stretch} - delayed) / tau;", **lines},
        states=states,
    )


def _of_resistance() -> Iterator[CandidateTerm]:
    """Resistance of coils, what strings take in series, what a supply gives."""
    yield _term(
        ("electrical", "resistance_step", "an instant"),
        "R = max(R_0 + a * reference_resistance * step(t - instant), 1e-3 * reference_resistance)",
        (
            Parameter(
                "a",
                "1",
                -1.0,
                50.0,
                "what is left is positive",
                is_amplitude=True,
                plausible=3.0,
                plausible_reason="three more coils in one place; beyond, it is open",
                meaning="change of the resistance, as a share of the reference resistance",
            ),
            _INSTANT,
        ),
        {
            "resistance": """
            const double after = R + a * reference_resistance * share_after(instant, t_begin, t_end);
            R = a != 0.0 ? most(after, 1e-3 * reference_resistance) : R;
        """
        },
    )
    for name, phi, words in (
        ("linear_excess", _WARMTH, "temperature, linear"),
        ("linear_phase", "phase", "share of austenite, linear"),
    ):
        yield _term(
            ("electrical", f"resistance_{name}", words),
            f"R = R_0 + a * reference_resistance * {phi}",
            (_amplitude("1", 0.5, (0.3, "", _THIRD), meaning=_OHMS),),
            {"resistance": f"R += a * reference_resistance * {phi};"},
        )
    amperes, words = VARIABLES["amperes"]
    lines, states = _delayed(amperes)
    yield _term(
        ("electrical", "resistance_delayed_amperes", f"{words}, delayed"),
        f"R = R_0 + a * reference_resistance * delayed; tau * d(delayed) = {amperes} - delayed",
        (_amplitude("1", 20.0, (0.3, "", _THIRD), meaning=_OHMS), _TAU),
        {"resistance": "R += a * reference_resistance * delayed;", **lines},
        states=states,
    )
    yield _term(
        ("electrical", "series_constant", "direction of the current"),
        "R_string = R_string_0 + a / (abs(I) + 0.01)",
        (
            _amplitude(
                "V",
                5.0,
                (1.5, "", "two diodes in series"),
                is_passive=True,
                meaning="voltage that is lost at any current",
            ),
        ),
        {"string": "R_string += a / (fabs(I) + 0.01);"},
        ("all", "string"),
    )
    yield _term(
        ("electrical", "series_linear", "current, linear"),
        "R_string = R_string_0 + a",
        (_amplitude("ohm", 20.0, (3.0, "resistance", _SERIES), is_passive=True, meaning="resistance in series"),),
        {"string": "R_string += a;"},
        ("string",),
    )
    yield _term(
        ("electrical", "series_step", "current after an instant"),
        "R_string = R_string_0 + a * step(t - instant)",
        (
            _amplitude(
                "ohm",
                50.0,
                (3.0, "resistance", _SERIES),
                is_passive=True,
                meaning="resistance in series after the instant",
            ),
            _INSTANT,
        ),
        {"string": "R_string += a * share_after(instant, t_begin, t_end);"},
        ("string",),
    )
    yield _term(
        ("electrical", "series_cube", "current, cube"),
        "R_string = R_string_0 + a * I**2",
        (
            _amplitude(
                "V/A^3",
                20.0,
                (4.4, "resistance", "a copper lead as resistive as the coil gains 70 % over 180 K, at 0.4 A"),
                is_passive=True,
                meaning="resistance that is gained per square of the current",
            ),
        ),
        {"string": "R_string += a * I * I;"},
        ("string",),
    )
    yield _term(
        ("electrical", "supply_linear", "current of the supply, linear"),
        "V_terminal = V - a * I_supply",
        (
            _amplitude(
                "ohm",
                20.0,
                (2.0, "resistance", "a supply that loses more than two coils take drives no network"),
                is_passive=True,
                meaning="inner resistance of the supply",
            ),
        ),
        {"supply": "R_supply += a;"},
        ("supply",),
    )
    yield _term(
        ("electrical", "supply_hinge", "current of the supply, beyond a threshold"),
        "I_supply = I_free - a * max(I_free - limit, 0)",
        (
            Parameter(
                "a",
                "1",
                0.0,
                1.0,
                _PASSIVE,
                is_amplitude=True,
                plausible=1.0,
                plausible_reason="all above the threshold is lost",
                meaning="share of the current above the threshold that is lost",
            ),
            Parameter(
                "limit",
                "A",
                0.01,
                1000.0,
                "a threshold is positive",
                plausible=30.0,
                plausible_reason="laboratory supplies are made for 0.3 to 30 A",
                meaning="current of the threshold",
                count=6,
            ),
        ),
        {"supply": "I_limit = a > 0.0 ? limit : I_limit;\nlimited = a > 0.0 ? a : limited;"},
        ("supply", "all"),
    )
    yield _term(
        ("electrical", "supply_delayed", "voltage of the supply, delayed"),
        "a * d(V_terminal) = V - V_terminal",
        (_amplitude("s", 100.0, (20.0, "", _SLOW), is_passive=True, meaning="time constant of the supply"),),
        {
            "source": """
            const double decay = exp(-dt / most(a, 1e-9)), gap = behind_begin - V;
            behind = V + gap * decay;
            V += gap * (1.0 - decay) * a / dt;
        """
        },
        ("supply", "all"),
        (State("behind", "V", "0.0", "memory"),),
    )


def _of_value() -> Iterator[CandidateTerm]:
    """A sensor that is not linear, or that reads something else of its coil too."""
    scale = Parameter("scale", "unit of the channel", 1e-9, 1000.0, "given", (10.0,), is_fixed=True)
    pivot = Parameter("pivot", "unit of the channel", -1000.0, 1000.0, "given", (0.0, 295.15), is_fixed=True)
    yield _term(
        ("measurement", "value_square", "the reading itself, square"),
        "value = truth + a * scale * ((truth - pivot) / scale)**2",
        (
            _amplitude(
                "1",
                0.3,
                (0.3, "", "bent by a third over its range: no sensor"),
                meaning="change of the reading one typical reading above the pivot, as a share of that reading",
                physical="change",
            ),
            scale,
            pivot,
        ),
        {"sensor": "value += a * scale * ((value - pivot) / scale) * ((value - pivot) / scale);"},
        ("channel", "quantity"),
    )
    amperes = VARIABLES["amperes"][0]
    # Up to a whole scale at the typical current: a thermocouple welded to a wire is off by kelvins per ampere.
    yield _term(
        ("measurement", "value_linear_amperes", "current in its coil, linear"),
        f"value = truth + a * scale * ({amperes})",
        (
            _amplitude(
                "1",
                1.0,
                (1.0, "", "a whole scale at the typical current, as of a thermocouple welded to the wire"),
                meaning="change of the reading at 0.4 A, as a share of what the channel typically reads",
                physical="change",
            ),
            scale,
        ),
        {"sensor": f"value += a * scale * ({amperes});"},
        ("channel", "quantity"),
    )


CANDIDATES = (*_of_shift(), *_of_force(), *_of_heat(), *_of_resistance(), *_of_value())
