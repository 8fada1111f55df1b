"""Thirty-first set: a model glider in pitch, an eye at a pump, a crystalliser, a gas pipeline and its gate, apples in a
box, a small turbojet, a pupil in the light, a frill of coils.

Written by an author who had read neither the library of laws nor its proof nor its tests nor its thresholds, and who
had not run a diagnosis, of these cases or of any other; of the earlier sets, the author had read two and the helpers
that these take from the others. Truths are integrated from equations that stand here, by scipy or, of the coils, by a
scheme of their own. How large an effect is, and how far the numbers are off, is drawn; the deviations of the numbers
are those that a parameter set states. Recordings of a rig differ in length and in logger; the one that is held out was
partly made with a programme of another kind, within the range of the others.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.strangers.eighth_set import idle_column
from evaluation.strangers.eleventh_set import DEGREES, RPM, telegraph
from evaluation.strangers.fifteenth_set import ramped
from evaluation.strangers.fifth_set import integrated
from evaluation.strangers.first_set import PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import bursts, data_sheet, scaled
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Steps, Written, drawn_steps, write
from evaluation.strangers.sixteenth_set import later
from evaluation.strangers.tenth_set import stairs
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.thirteenth_set import wandering
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth

#: Partial pressures of oxygen and carbon dioxide in air, and the air's pressure [kPa].
OXYGEN, CARBON, AIR = 21.2, 0.04, 101.325
#: Laws that are true where something is stored of which the model knows nothing.
STORED = ("hidden_state", "hidden_mass", "hidden_capacity", "second_mass", "hidden_storage", "memory", "relaxation")
#: Laws that are true where a number depends on a state.
RATED = ("nonlinear_rate", "rate_of_state", "state_dependent_rate", "parameter_of_state", "interaction")
#: Laws that are true where a wing's lift bends as it stalls.
STALLING = (
    *RATED,
    "saturation",
    "nonlinear_gain",
    "gain_of_state",
    "state_dependent_gain",
    "nonlinear_stiffness",
    "nonlinear_damping",
    "stiffness_of_state",
    "quadratic_loss",
    "nonlinear_loss",
    "nonlinear_drag",
    "stall",
)
#: Laws that are true where a body's balance is another from an instant on.
SHIFTED = (
    *RATED,
    "step_of_parameter",
    "stiffness_of_time",
    "parameter_of_time",
    "gain_of_time",
    "nonlinear_stiffness",
    "stiffness_of_state",
)
#: Laws that are true where a drain narrows as pressure grows.
NARROWED = (
    *RATED,
    "leakage",
    "leak",
    "nonlinear_leakage",
    "conductance_of_state",
    "resistance_of_state",
    "nonlinear_loss",
    "quadratic_loss",
    "saturation",
    "flow_resistance",
    "gain_of_state",
    "state_dependent_gain",
)
#: Laws that are true where a wall yields slowly.
CREEPING = (*STORED, *RATED, "creep", "viscoelasticity", "viscoelastic", "stress_relaxation", "leakage", "leak")
#: Laws that are true where a wall is covered with time, and passes less heat.
COVERED = (
    *STORED,
    *RATED,
    "wear",
    "fouling",
    "clogging",
    "ageing",
    "aging",
    "degradation",
    "drift_of_parameter",
    "conductance_of_state",
    "resistance_of_state",
    "growing_resistance",
    "heat_loss",
)
#: Laws that are true where a rate has another order.
ORDERED = (
    *RATED,
    "second_order",
    "order_of_rate",
    "reaction_order",
    "power_law",
    "gain_of_state",
    "state_dependent_gain",
    "nonlinear_gain",
    "quadratic_loss",
    "nonlinear_loss",
)
#: Laws that are true where a pipe has a branch that ends blind.
BRANCHED = (*STORED, "exchange", "coupling", "dead_volume", "stagnant_zone", "mixing", "lag", "leak", "leakage")
#: Laws that are true where what is made slows its making.
INHIBITED = (
    *RATED,
    "inhibition",
    "product_inhibition",
    "feedback",
    "gain_of_state",
    "state_dependent_gain",
    "nonlinear_loss",
    "nonlinear_gain",
    "cross_coupling",
    "coupling",
    "saturation",
)
#: Laws that are true where metal takes heat from a gas, and gives it back.
SOAKED = (
    *STORED,
    *RATED,
    "exchange",
    "thermal_coupling",
    "wall_capacity",
    "hidden_heat_capacity",
    "heat_loss",
    "lag",
    "slow_input",
    "warming",
    "self_heating",
    "gain_of_state",
    "state_dependent_gain",
)
#: Laws that are true where a slow sense acts beside a fast one.
SLOW = (*STORED, "slow_input", "lag", "integrator", "feedback", "adaptation", "delay", "gain_of_state")
#: Laws that are true where a body loses more heat for each kelvin the warmer it is.
LOSING = (
    *RATED,
    "radiation",
    "natural_convection",
    "convection",
    "heat_loss",
    "nonlinear_loss",
    "quadratic_loss",
    "nonlinear_cooling",
    "conductance_of_state",
    "temperature_dependence",
)


# --- a model glider in pitch, FMI 3 Model Exchange; s, ms, deg, deg/s, m/s^2
GLIDER = OdeModel(
    "glider",
    {
        "V": (25.0, "m/s"),
        "Z_a": (3.5, "1/s"),
        "Z_e": (0.2, "1/s"),
        "Z_f": (0.9, "1/s"),
        "M_a": (34.0, "1/s^2"),
        "M_q": (4.2, "1/s"),
        "M_e": (30.0, "1/s^2"),
        "M_f": (3.0, "1/s^2"),
        "tau_e": (0.06, "s"),
        "tau_f": (0.25, "s"),
        "tau_v": (0.05, "s"),
    },
    {"stick": "rad", "lever": "rad"},
    {
        "e": ("rad", "0.0", "(stick - e)/tau_e"),
        "f": ("rad", "0.0", "(lever - f)/tau_f"),
        "a": ("rad", "0.0", "q - Z_a*a - Z_e*e - Z_f*f"),
        "q": ("rad/s", "0.0", "M_e*e - M_f*f - M_a*a - M_q*q"),
        "y": ("rad", "0.0", "(a - y)/tau_v"),
    },
    {"rate": ("rad/s", "q"), "vane": ("rad", "y"), "lift": ("m/s^2", "V*(Z_a*a + Z_e*e + Z_f*f)")},
    2e-3,
)
GLIDER_KNOWN = {
    "V": 0.01,
    "Z_a": 0.05,
    "Z_e": 0.15,
    "Z_f": 0.08,
    "M_a": 0.05,
    "M_q": 0.06,
    "M_e": 0.04,
    "M_f": 0.1,
    "tau_e": 0.08,
    "tau_f": 0.08,
    "tau_v": 0.08,
}


def _glider(
    folder: Path,
    rng: Rng,
    stalls: float = 0.0,
    slides: tuple[float, float] = (np.inf, 0.0),
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The lift of the angle of attack may bend: Z_a a/(1 + stalls a^2) [1/rad^2].

    Ballast may slide from an instant [s] of the second recording on, and take that share of M_a away.
    """
    build3(GLIDER, folder, has_co_simulation=False)
    parts = programme("servo", ("stick", "deg")) + programme("flaps", ("lever", "deg"))
    parts += with_numbers("glider", "glider")
    wires = "  - servo.stick -> glider.stick\n  - flaps.lever -> glider.lever\n"
    scenario(folder, "A model glider in pitch", 56.0, 0.01, 0.04, parts, wires)
    data_sheet(folder, GLIDER, GLIDER_KNOWN)
    v, z_a, z_e, z_f, m_a, m_q, m_e, m_f, tau_e, tau_f, tau_v = drawn(rng, GLIDER, GLIDER_KNOWN)

    def bent(a: Array) -> Array:
        return np.asarray(a / (1.0 + stalls * a**2))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        e, f, a, q, y = (float(s) for s in x)
        return [
            (float(u[0]) / DEGREES - e) / tau_e,
            (float(u[1]) / DEGREES - f) / tau_f,
            q - z_a * a / (1.0 + stalls * a**2) - z_e * e - z_f * f,
            m_e * e - m_f * f - m_a * float(u[2]) * a - m_q * q,
            (a - y) / tau_v,
        ]

    def lift(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(v * (z_a * bent(x[:, 2]) + z_e * x[:, 0] + z_f * x[:, 1]))

    for number, (name, stop) in enumerate((("first", 56.0), ("second", 44.0), ("third", 48.0))):
        stick = drawn_steps(rng, stop, 0.9, -16.0, 16.0, 0.04)
        if name == "third":
            stick = telegraph(rng, stop, 0.7, -12.5, 12.5, 0.04)
        lever = drawn_steps(rng, stop, 2.6, -6.0, 9.0, 0.04)
        stick, lever = later(stick, 0.02), later(lever, 0.02)
        holds = Steps((0.0,), (1.0,))
        if name == "second" and np.isfinite(slides[0]):
            holds = Steps((0.0, slides[0]), (1.0, 1.0 - slides[1]))
        t, x = integrated(rates, (0.0,) * 5, (stick, lever, holds), stop, 0.01)
        sensors = [
            Sensor("glider.rate", "Gyro deg/s", "deg/s", scaled(3, DEGREES), 0.5, 0.04, noise_stated, 0.1, colour),
            Sensor("glider.vane", "Vane deg", "deg", scaled(4, DEGREES), 0.1, 0.08, noise_stated, 0.05, colour),
            Sensor("glider.lift", "az", "m/s^2", lift, 0.12, 0.04, noise_stated, 0.02, colour),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"servo.stick": (stick, "deg"), "flaps.lever": (lever, "deg")},
            loggers[number % len(loggers)],
            recorded=["flaps.lever"],
        )
        write(folder / name, rng, made)


def glider_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=2500.0), Logger("s", zero=-3.0, jitter=0.1), Logger("s", empty=0.02, gap=(19.0, 20.6)))
    _glider(folder, rng, colour=0.1, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.1 and is stated rightly, two "
        "rates, a column of an input, jitter, empty cells, a gap of 1.6 s, loggers of ms and s, FMI 3",
        FINE,
    )


def glider_stalls(folder: Path, rng: Rng) -> Truth:
    stalls = rng.uniform(9.0, 14.0)
    _glider(folder, rng, stalls=stalls, loggers=(PLAIN, Logger("ms", zero=40.0)))
    return Truth(
        f"the wing stalls as the angle of attack grows: its lift is Z_a a/(1 + {stalls:.3f}/rad^2 a^2)",
        PHYSICS,
        STALLING,
    )


def glider_slides(folder: Path, rng: Rng) -> Truth:
    since, less = 0.04 * round(rng.uniform(13.0, 21.0) / 0.04), rng.uniform(0.16, 0.24)
    _glider(folder, rng, slides=(since, less), loggers=(Logger("s", zero=1.5), PLAIN, Logger("ms")))
    return Truth(
        f"ballast slides to the tail at {since:.2f} s of the second recording, and the moment of the angle of attack "
        f"M_a is {100.0 * less:.2f} % smaller from then on; in the others it stays in place",
        (*PHYSICS, *RECORDING, *SENSOR),
        SHIFTED,
    )


# --- an eye at an infusion pump, FMI 2 Co-Simulation that hides its states; min, h, s, mmHg, uL/min, um
EYE = OdeModel(
    "eye",
    {
        "C": (0.3, "uL/(min*mmHg)"),
        "F_0": (2.2, "uL/min"),
        "K": (0.05, "1/uL"),
        "s_y": (90.0, "um"),
        "p_y": (16.0, "mmHg"),
        "tau_f": (20.0, "s"),
        "tau_v": (35.0, "s"),
        "tau_o": (45.0, "s"),
        "tau_y": (15.0, "s"),
        "p_begin": (16.0, "mmHg"),
        "v_begin": (9.0, "mmHg"),
    },
    {"pump": "uL/min", "cuff": "mmHg"},
    {
        "f": ("uL/min", "0.0", "(pump - f)/tau_f"),
        "v": ("mmHg", "v_begin", "(cuff - v)/tau_v"),
        "p": ("mmHg", "p_begin", "K*fmax(p, 1.0)*(F_0 + f - C*(p - v))/60.0"),
        "o": ("uL/min", "C*(p_begin - v_begin)", "(C*(p - v) - o)/tau_o"),
        "y": ("um", "s_y*log(p_begin/p_y)", "(s_y*log(fmax(p, 1.0)/p_y) - y)/tau_y"),
    },
    {"pressure": ("mmHg", "p"), "outflow": ("uL/min", "o"), "swelling": ("um", "y")},
    0.5,
)
EYE_KNOWN = {
    "C": 0.06,
    "F_0": 0.06,
    "K": 0.06,
    "s_y": 0.05,
    "p_y": 0.01,
    "tau_f": 0.1,
    "tau_v": 0.1,
    "tau_o": 0.08,
    "tau_y": 0.1,
    "p_begin": 0.02,
    "v_begin": 0.02,
}


def _eyeball(
    folder: Path,
    rng: Rng,
    narrows: float = 0.0,
    creeps: tuple[float, float] = (0.0, 1.0),
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The drain may narrow with pressure: C/(1 + narrows (p - v - 7 mmHg)) [1/mmHg].

    The sclera may creep: its volume grows by creeps[0] ln(p/p_y) [uL] within creeps[1] [s].
    """
    EYE.build(folder)
    parts = programme("infusion", ("pump", "uL/min"))
    parts += programme("collar", ("cuff", "mmHg")).replace("constant: 0 mmHg", "constant: 9 mmHg")
    parts += with_numbers("eye", "eye", "internal")
    wires = "  - infusion.pump -> eye.pump\n  - collar.cuff -> eye.cuff\n"
    scenario(folder, "An eye at an infusion pump", 5400.0, 2, 6, parts, wires)
    data_sheet(folder, EYE, EYE_KNOWN)
    c, f_0, k, s_y, p_y, tau_f, tau_v, tau_o, tau_y, p_begin, v_begin = drawn(rng, EYE, EYE_KNOWN)
    by, slow = creeps

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Flows are in uL/min; the last is the volume by which the sclera has crept [uL]."""
        f, v, p, o, y, crept = (float(s) for s in x)
        drains = c * (p - v) / (1.0 + narrows * max(p - v - 7.0, -7.0))
        yields = (by * float(np.log(p / p_y)) - crept) / slow
        return [
            (float(u[0]) - f) / tau_f,
            (float(u[1]) - v) / tau_v,
            k * p * ((f_0 + f - drains) / 60.0 - yields),
            (drains - o) / tau_o,
            (s_y * float(np.log(p / p_y)) - y) / tau_y,
            yields,
        ]

    for number, (name, stop) in enumerate((("first", 5400.0), ("second", 4200.0), ("third", 4800.0))):
        pump = drawn_steps(rng, stop, 260.0, 0.0, 8.0, 6.0)
        if name == "third":
            pump = bursts(rng, stop, 220.0, 300.0, 2.0, 7.8, 6.0)
        cuff = drawn_steps(rng, stop, 420.0, 6.5, 12.5, 6.0)
        pump, cuff = later(pump, 2.0), later(cuff, 2.0)
        low = float(np.log(p_begin / p_y))
        start = (0.0, v_begin, p_begin, c * (p_begin - v_begin), s_y * low, by * low)
        t, x = integrated(rates, start, (pump, cuff), stop, 2.0)
        sensors = [
            Sensor("eye.pressure", "IOP mmHg", "mmHg", scaled(2, 1.0), 0.15, 6.0, noise_stated, 0.05),
            Sensor("eye.outflow", "Drip uL/min", "uL/min", scaled(3, 1.0), 0.08, 12.0, noise_stated, 0.02),
            Sensor("eye.swelling", "Laser um", "um", scaled(4, 1.0), 1.5, 6.0, noise_stated, 0.5),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"infusion.pump": (pump, "uL/min"), "collar.cuff": (cuff, "mmHg")},
            loggers[number % len(loggers)],
            recorded=["collar.cuff"],
        )
        write(folder / name, rng, made)


def eyeball_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=10.0), Logger("s", zero=-60.0, empty=0.02), Logger("h", gap=(1980.0, 2160.0)))
    _eyeball(folder, rng, noise_stated=1.0 / 3.0, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 3 times too small, two rates, a column of an input, empty cells, "
        "a gap of 3 min, loggers of min, s and h, Co-Simulation",
        FINE,
    )


def eyeball_narrows(folder: Path, rng: Rng) -> Truth:
    narrows = rng.uniform(0.011, 0.016)
    _eyeball(folder, rng, narrows=narrows, loggers=(Logger("min"), Logger("s", zero=30.0)))
    return Truth(
        f"the drain of the eye narrows with pressure: C/(1 + {narrows:.5f}/mmHg (p - v - 7 mmHg))", PHYSICS, NARROWED
    )


def eyeball_two(folder: Path, rng: Rng) -> Truth:
    narrows, by, slow = rng.uniform(0.011, 0.016), rng.uniform(10.0, 14.0), rng.uniform(320.0, 480.0)
    _eyeball(
        folder, rng, narrows=narrows, creeps=(by, slow), loggers=(Logger("s", zero=8.0), Logger("min", jitter=0.1))
    )
    return Truth(
        f"the drain of the eye narrows with pressure: C/(1 + {narrows:.5f}/mmHg (p - v - 7 mmHg)); and the sclera "
        f"creeps: its volume grows by {by:.3f} uL ln(p/p_y) with a time constant of {slow:.1f} s",
        PHYSICS,
        (*NARROWED, *CREEPING),
    )


# --- a continuous crystalliser of alum, FMI 2 Model Exchange; min, h, s, mL/s, degC, g/L, um
_OVER = "(c - c_0*exp(k_s*(T - T_0)))"
_GROWN = f"(3.0*r_v*k_g*{_OVER}*A)"
ALUM = OdeModel(
    "alum",
    {
        "V": (0.01, "m^3"),
        "c_f": (260.0, "kg/m^3"),
        "T_f": (318.15, "K"),
        "c_0": (130.0, "kg/m^3"),
        "k_s": (0.035, "1/K"),
        "T_0": (298.15, "K"),
        "k_g": (2e-8, "m^4/(kg*s)"),
        "k_b": (9e4, "m^3/(kg^2*s)"),
        "r_v": (880.0, "kg/m^3"),
        "U": (2.6e-3, "1/s"),
        "h_c": (0.012, "K*m^3/kg"),
        "tau_j": (90.0, "s"),
        "tau_q": (15.0, "s"),
        "T_begin": (302.15, "K"),
        "J_begin": (294.15, "K"),
        "c_begin": (155.0, "kg/m^3"),
        "N_begin": (3.5e10, "1/m^3"),
        "L_begin": (2.8e6, "1/m^2"),
        "A_begin": (450.0, "1/m"),
        "M_begin": (100.0, "kg/m^3"),
        "q_begin": (1.25e-5, "m^3/s"),
    },
    {"feed": "m^3/s", "coolant": "K"},
    {
        "q": ("m^3/s", "q_begin", "(feed - q)/tau_q"),
        "J": ("K", "J_begin", "(coolant - J)/tau_j"),
        "T": ("K", "T_begin", f"q/V*(T_f - T) + U*(J - T) + h_c*{_GROWN}"),
        "c": ("kg/m^3", "c_begin", f"q/V*(c_f - c) - {_GROWN}"),
        "N": ("1/m^3", "N_begin", f"k_b*fmax({_OVER}, 0.0)*M - q/V*N"),
        "L": ("1/m^2", "L_begin", f"k_g*{_OVER}*N - q/V*L"),
        "A": ("1/m", "A_begin", f"2.0*k_g*{_OVER}*L - q/V*A"),
        "M": ("kg/m^3", "M_begin", f"{_GROWN} - q/V*M"),
    },
    {"liquor": ("K", "T"), "dissolved": ("kg/m^3", "c"), "magma": ("kg/m^3", "M"), "size": ("m", "A/fmax(L, 1.0)")},
    1.0,
)
ALUM_KNOWN = {
    "V": 0.01,
    "c_f": 0.01,
    "T_f": 2e-3,
    "c_0": 0.01,
    "k_s": 0.02,
    "k_g": 0.06,
    "k_b": 0.08,
    "r_v": 0.02,
    "U": 0.06,
    "h_c": 0.1,
    "tau_j": 0.1,
    "tau_q": 0.1,
    "T_begin": 1e-3,
    "J_begin": 1e-3,
    "c_begin": 0.01,
    "N_begin": 0.05,
    "L_begin": 0.04,
    "A_begin": 0.03,
    "M_begin": 0.02,
}


def _crystals(
    folder: Path,
    rng: Rng,
    scales: float = 0.0,
    order: float = 1.0,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    has_idle: bool = False,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """A scale may grow on the cooled wall: U/(1 + w), w grows by scales for each h and g/L above what is soluble there.

    Growth may be of another order in supersaturation, with the same rate at 5 g/L. What is said of the feed in the
    second recording may be another run's.
    """
    ALUM.build(folder)
    parts = programme("dosing", ("feed", "mL/s")).replace("constant: 0 mL/s", "constant: 12 mL/s")
    parts += programme("chiller", ("coolant", "degC")).replace("constant: 0 degC", "constant: 21 degC")
    parts += with_numbers("vessel", "alum")
    wires = "  - dosing.feed -> vessel.feed\n  - chiller.coolant -> vessel.coolant\n"
    scenario(folder, "A crystalliser of alum", 23400.0, 10, 20, parts, wires)
    data_sheet(folder, ALUM, ALUM_KNOWN)
    v, c_f, t_f, c_0, k_s, t_0, k_g, k_b, r_v, heat, h_c, tau_j, tau_q, t_begin, j_begin, c_begin, *more = drawn(
        rng, ALUM, ALUM_KNOWN
    )
    n_begin, l_begin, a_begin, m_begin, q_begin = more

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """The flow is in mL/s, numbers in 1e9/m^3, lengths in 1e6/m^2; the last is the scale's share."""
        q, jacket, warm, c, n, length, a, m, scale = (float(s) for s in x)
        over = c - c_0 * float(np.exp(k_s * (warm - t_0)))
        at_wall = c - c_0 * float(np.exp(k_s * (jacket - t_0)))
        grows = k_g * over * (abs(over) / 5.0 + 1e-12) ** (order - 1.0)
        made = 3.0 * r_v * grows * a
        share = 1e-6 * q / v
        return [
            (float(u[0]) - q) / tau_q,
            (float(u[1]) + CELSIUS - jacket) / tau_j,
            share * (t_f - warm) + heat / (1.0 + scale) * (jacket - warm) + h_c * made,
            share * (c_f - c) - made,
            1e-9 * k_b * max(over, 0.0) * m - share * n,
            1e3 * grows * n - share * length,
            2e6 * grows * length - share * a,
            made - share * m,
            scales / 3600.0 * max(at_wall, 0.0),
        ]

    def size(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(x[:, 6] / x[:, 5])

    def kelvin(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(x[:, 2] - CELSIUS)

    for number, (name, stop) in enumerate((("first", 23400.0), ("second", 18000.0), ("third", 20400.0))):
        feed = drawn_steps(rng, stop, 1300.0, 8.0, 17.0, 20.0)
        other = later(drawn_steps(rng, stop, 1300.0, 8.0, 17.0, 20.0), 10.0)
        if name == "third":
            feed = stairs(rng, stop, 1000.0, 8.5, 16.5, 5, 20.0)
        coolant = drawn_steps(rng, stop, 1100.0, 17.0, 25.0, 20.0)
        feed, coolant = later(feed, 10.0), later(coolant, 10.0)
        start = (
            1e6 * q_begin,
            j_begin,
            t_begin,
            c_begin,
            1e-9 * n_begin,
            1e-6 * l_begin,
            a_begin,
            m_begin,
            0.0,
        )
        t, x = integrated(rates, start, (feed, coolant), stop, 10.0)
        sensors = [
            Sensor("vessel.liquor", "T Kessel", "degC", kelvin, 0.1, 20.0, noise_stated, 0.05, wild=wild),
            Sensor("vessel.dissolved", "Refrakto g/L", "g/L", scaled(3, 1.0), 0.6, 20.0, noise_stated, 0.1, wild=wild),
            Sensor("vessel.magma", "Kristall g/L", "g/L", scaled(7, 1.0), 1.0, 40.0, noise_stated, 0.2, wild=wild),
            Sensor("vessel.size", "FBRM um", "um", size, 0.5, 40.0, noise_stated, 0.1, wild=wild),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"dosing.feed": (feed, "mL/s"), "chiller.coolant": (coolant, "degC")},
            loggers[number % len(loggers)],
            recorded=["chiller.coolant"],
            told={"dosing.feed": other} if is_other and name == "second" else {},
        )
        write(folder / name, rng, made)
        if has_idle:
            idle_column(folder / name, "Ruehrer rpm", lambda n: np.asarray(350.0 + (np.arange(n) % 7)))


def crystals_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=5.0), Logger("s", zero=100.0, jitter=0.1), Logger("h", gap=(7800.0, 8520.0)))
    _crystals(folder, rng, noise_stated=None, wild=0.003, has_idle=True, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, wild readings, two rates, a column of an input, a column "
        "that nobody uses, jitter, a gap of 12 min, loggers of min, s and h",
        FINE,
    )


def crystals_scales(folder: Path, rng: Rng) -> Truth:
    scales = rng.uniform(1.3e-3, 2e-3)
    _crystals(folder, rng, scales=scales, loggers=(Logger("min"), Logger("h", zero=1.0)))
    return Truth(
        f"a scale grows on the cooled wall, which passes U/(1 + w): w grows by {1e3 * scales:.4f}e-3 for each hour and "
        "each g/L above what is soluble at the wall",
        PHYSICS,
        COVERED,
    )


def crystals_two(folder: Path, rng: Rng) -> Truth:
    scales, order = rng.uniform(1.3e-3, 2e-3), rng.uniform(1.5, 1.8)
    _crystals(folder, rng, scales=scales, order=order, loggers=(Logger("s", zero=30.0), Logger("min")))
    return Truth(
        f"a scale grows on the cooled wall, which passes U/(1 + w): w grows by {1e3 * scales:.4f}e-3 for each hour and "
        f"each g/L above what is soluble at the wall; and crystals grow with the power {order:.3f} of supersaturation, "
        "as fast as with the first at 5 g/L",
        PHYSICS,
        (*COVERED, *ORDERED),
    )


def crystals_other_run(folder: Path, rng: Rng) -> Truth:
    _crystals(folder, rng, is_other=True, loggers=(Logger("h"), Logger("min", zero=-3.0), Logger("s")))
    return Truth(
        "what is said of the feed in the second recording is that of another run",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- a pipeline of gas (FMI 2, Model Exchange) and the gate of a town (FMI 2, Co-Simulation); s, min, bar, kg/s, kW
def _passes(a: str, b: str) -> str:
    """Flow between two nodes of the pipeline."""
    return f"k_p*({a} - {b})*sqrt(fabs({a} + {b}))/sqrt(fabs({a} - {b}) + 2e3)"


PIPELINE = OdeModel(
    "pipeline",
    {
        "V_n": (1900.0, "m^3"),
        "RT": (1.3e5, "J/kg"),
        "k_p": (1.6e-5, "m*s"),
        "K_c": (6e-5, "m*s"),
        "tau_c": (25.0, "s"),
        "m_begin": (18.0, "kg/s"),
        "p_begin": (4.9e6, "Pa"),
        "d_begin": (1.2e5, "Pa"),
    },
    {"wanted": "Pa", "draw": "kg/s"},
    {
        "m": ("kg/s", "m_begin", "(K_c*(wanted - p_1) - m)/tau_c"),
        "p_1": ("Pa", "p_begin", f"RT/V_n*(m - {_passes('p_1', 'p_2')})"),
        "p_2": ("Pa", "p_begin - d_begin", f"RT/V_n*({_passes('p_1', 'p_2')} - {_passes('p_2', 'p_3')})"),
        "p_3": ("Pa", "p_begin - 2.0*d_begin", f"RT/V_n*({_passes('p_2', 'p_3')} - draw)"),
    },
    {"inlet": ("Pa", "p_1"), "middle": ("Pa", "p_2"), "end": ("Pa", "p_3"), "supply": ("kg/s", "m")},
    1.0,
)
TOWN_GATE = OdeModel(
    "town_gate",
    {
        "c_v": (8.3e-6, "m*s"),
        "V_g": (300.0, "m^3"),
        "RT_g": (1.3e5, "J/kg"),
        "p_set": (4e5, "Pa"),
        "K_p": (2e-6, "1/Pa"),
        "K_i": (2e-8, "1/(Pa*s)"),
        "tau_s": (6.0, "s"),
        "tau_d": (30.0, "s"),
        "T_g": (283.15, "K"),
        "mu": (4.5e-6, "K/Pa"),
        "c_p": (2200.0, "J/(kg*K)"),
        "tau_t": (60.0, "s"),
        "d_begin": (18.0, "kg/s"),
        "s_begin": (0.46, ""),
        "T_begin": (278.15, "K"),
    },
    {"upstream": "Pa", "demand": "kg/s", "heater": "W"},
    {
        "d": ("kg/s", "d_begin", "(demand - d)/tau_d"),
        "z": ("", "s_begin", "K_i*(p_set - g)"),
        "s": ("", "s_begin", "(z + K_p*(p_set - g) - s)/tau_s"),
        "g": ("Pa", "p_set", "RT_g/V_g*(c_v*s*upstream - d)"),
        "T": ("K", "T_begin", "(T_g - mu*(upstream - g) + heater/(c_p*fmax(c_v*s*upstream, 2.0)) - T)/tau_t"),
    },
    {"grid": ("Pa", "g"), "gas": ("K", "T"), "draw": ("kg/s", "c_v*s*upstream")},
    1.0,
)
PIPELINE_KNOWN = {
    "V_n": 0.04,
    "RT": 0.01,
    "k_p": 0.05,
    "K_c": 0.06,
    "tau_c": 0.1,
    "m_begin": 0.02,
    "p_begin": 2e-3,
    "d_begin": 0.05,
}
TOWN_GATE_KNOWN = {
    "c_v": 0.04,
    "V_g": 0.06,
    "tau_s": 0.1,
    "tau_d": 0.08,
    "T_g": 2e-3,
    "mu": 0.05,
    "c_p": 0.03,
    "tau_t": 0.08,
    "d_begin": 0.02,
    "s_begin": 0.02,
    "T_begin": 2e-3,
}


def _gaspipe(
    folder: Path,
    rng: Rng,
    branch: tuple[float, float] = (0.0, 1.0),
    is_swapped: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Two FMUs; a blind branch may hang at the middle: branch[0] passes [kg/(s*bar)], it holds branch[1] [m^3].

    The columns of the inlet and the middle may be swapped in the second recording.
    """
    PIPELINE.build(folder)
    TOWN_GATE.build(folder)
    data_sheet(folder, PIPELINE, PIPELINE_KNOWN)
    (folder / "numbers.yaml").rename(folder / "pipeline.yaml")
    data_sheet(folder, TOWN_GATE, TOWN_GATE_KNOWN)
    parts = (
        programme("station", ("wanted", "bar")).replace("constant: 0 bar", "constant: 51 bar")
        + programme("town", ("demand", "kg/s")).replace("constant: 0 kg/s", "constant: 18 kg/s")
        + programme("preheater", ("heater", "kW")).replace("constant: 0 kW", "constant: 500 kW")
        + with_numbers("pipe", "pipeline").replace("numbers.yaml", "pipeline.yaml")
        + with_numbers("gate", "town_gate", "internal")
    )
    wires = "  - station.wanted -> pipe.wanted\n  - town.demand -> gate.demand\n  - preheater.heater -> gate.heater\n"
    wires += "  - pipe.end -> gate.upstream\n  - gate.draw -> pipe.draw\n"
    scenario(folder, "A gas pipeline and the gate of a town", 10800.0, 4, 12, parts, wires)
    v_n, gas, k_p, k_c, tau_c, m_begin, p_begin, d_begin = drawn(rng, PIPELINE, PIPELINE_KNOWN)
    c_v, v_g, gas_g, p_set, prop, integ, tau_s, tau_d, t_g, mu, c_p, tau_t, dem_begin, s_begin, t_begin = drawn(
        rng, TOWN_GATE, TOWN_GATE_KNOWN
    )
    opens, holds = branch

    def passes(a: float, b: float) -> float:
        return float(1e5 * k_p * (a - b) * np.sqrt(a + b) / np.sqrt(abs(a - b) + 0.02))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Pressures are in bar; the last is that of the branch."""
        m, p_1, p_2, p_3, d, z, s, g, warm, blind = (float(v) for v in x)
        draw = 1e5 * c_v * s * p_3
        off = p_set - 1e5 * g
        into = opens * (p_2 - blind)
        return [
            (1e5 * k_c * (float(u[0]) - p_1) - m) / tau_c,
            1e-5 * gas / v_n * (m - passes(p_1, p_2)),
            1e-5 * gas / v_n * (passes(p_1, p_2) - passes(p_2, p_3) - into),
            1e-5 * gas / v_n * (passes(p_2, p_3) - draw),
            (float(u[1]) - d) / tau_d,
            integ * off,
            (z + prop * off - s) / tau_s,
            1e-5 * gas_g / v_g * (draw - d),
            (t_g - 1e5 * mu * (p_3 - g) + 1e3 * float(u[2]) / (c_p * max(draw, 2.0)) - warm) / tau_t,
            1e-5 * gas / holds * into,
        ]

    def kelvin(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(x[:, 8] - CELSIUS)

    for number, (name, stop) in enumerate((("first", 10800.0), ("second", 8400.0), ("third", 9600.0))):
        demand = drawn_steps(rng, stop, 480.0, 10.0, 26.0, 12.0)
        if name == "third":
            demand = wandering(rng, stop, 360.0, 10.5, 25.5, 12.0)
        wanted = drawn_steps(rng, stop, 700.0, 49.5, 53.0, 12.0)
        heater = drawn_steps(rng, stop, 600.0, 250.0, 800.0, 12.0)
        demand, wanted, heater = (later(s, 4.0) for s in (demand, wanted, heater))
        high, falls = 1e-5 * p_begin, 1e-5 * d_begin
        nodes = (high, high - falls, high - 2.0 * falls)
        start = (m_begin, *nodes, dem_begin, s_begin, s_begin, 1e-5 * p_set, t_begin, high - falls)
        t, x = integrated(rates, start, (wanted, demand, heater), stop, 4.0)
        one, two = (2, 1) if is_swapped and name == "second" else (1, 2)
        sensors = [
            Sensor("pipe.inlet", "P1 bar", "bar", scaled(one, 1.0), 0.02, 12.0, noise_stated, 5e-3),
            Sensor("pipe.middle", "P2 bar", "bar", scaled(two, 1.0), 0.02, 12.0, noise_stated, 5e-3),
            Sensor("pipe.supply", "FT kg/s", "kg/s", scaled(0, 1.0), 0.2, 24.0, noise_stated, 0.05),
            Sensor("gate.grid", "Netz bar", "bar", scaled(7, 1.0), 0.004, 12.0, noise_stated, 1e-3),
            Sensor("gate.gas", "T Gas", "degC", kelvin, 0.2, 24.0, noise_stated, 0.1),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"station.wanted": (wanted, "bar"), "town.demand": (demand, "kg/s"), "preheater.heater": (heater, "kW")},
            loggers[number % len(loggers)],
            recorded=["town.demand"],
        )
        write(folder / name, rng, made)


def gaspipe_null(folder: Path, rng: Rng) -> Truth:
    loggers = (
        Logger("min", zero=15.0, is_comma=True),
        Logger("s", is_comma=True, empty=0.02),
        Logger("s", zero=-120.0, is_comma=True, gap=(4200.0, 4560.0)),
    )
    _gaspipe(folder, rng, noise_stated=0.95, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.05 times too small, two rates, a column of an input, decimal "
        "commas, empty cells, a gap of 6 min, loggers of min and s, two FMUs",
        FINE,
    )


def gaspipe_branches(folder: Path, rng: Rng) -> Truth:
    opens, holds = rng.uniform(3.5, 5.0), rng.uniform(2600.0, 3600.0)
    _gaspipe(folder, rng, branch=(opens, holds), loggers=(PLAIN, Logger("min", zero=4.0)))
    return Truth(
        f"a branch that ends blind hangs at the middle of the pipeline: it holds {holds:.1f} m^3, and a valve passes "
        f"{opens:.4f} kg/(s bar) into it and out of it",
        PHYSICS,
        BRANCHED,
    )


def gaspipe_swapped(folder: Path, rng: Rng) -> Truth:
    _gaspipe(folder, rng, is_swapped=True, loggers=(Logger("s", zero=12.0), PLAIN, Logger("min")))
    return Truth(
        "the columns of the pressures are swapped in the second recording: what is said to be the inlet is the middle, "
        "and the other way round",
        (*RECORDING, *SENSOR),
    )


# --- apples in a box of controlled atmosphere, FMI 2 Co-Simulation that hides its states; h, min, L/min, kPa, degC
_BREATH = "(r_m*fmax(O, 0.0)/(fmax(O, 0.0) + K_o)*exp(k_t*(T - T_0)))"
APPLES = OdeModel(
    "apple_box",
    {
        "V": (0.1, "m^3"),
        "m": (20.0, "kg"),
        "r_m": (1.1e-8, "m^3/(kg*s)"),
        "K_o": (3000.0, "Pa"),
        "RQ": (1.05, ""),
        "k_t": (0.09, "1/K"),
        "T_0": (291.15, "K"),
        "h_r": (5800.0, "K*kg/m^3"),
        "tau_f": (9000.0, "s"),
        "tau_a": (700.0, "s"),
        "P": (101325.0, "Pa"),
        "O_air": (21200.0, "Pa"),
        "C_air": (40.0, "Pa"),
        "T_begin": (291.15, "K"),
        "O_begin": (15000.0, "Pa"),
        "C_begin": (2500.0, "Pa"),
    },
    {"air": "m^3/s", "nitrogen": "m^3/s", "chamber": "K"},
    {
        "a": ("K", "T_begin", "(chamber - a)/tau_a"),
        "T": ("K", "T_begin", f"(a - T)/tau_f + h_r*{_BREATH}"),
        "O": ("Pa", "O_begin", f"(air*(O_air - O) - nitrogen*O - m*P*{_BREATH})/V"),
        "C": ("Pa", "C_begin", f"(air*(C_air - C) - nitrogen*C + RQ*m*P*{_BREATH})/V"),
    },
    {"oxygen": ("Pa", "O"), "carbon_dioxide": ("Pa", "C"), "fruit": ("K", "T"), "inside": ("K", "a")},
    20.0,
)
APPLES_KNOWN = {
    "V": 0.02,
    "m": 5e-3,
    "r_m": 0.06,
    "K_o": 0.08,
    "RQ": 0.03,
    "k_t": 0.05,
    "h_r": 0.1,
    "tau_f": 0.06,
    "tau_a": 0.08,
    "T_begin": 5e-4,
    "O_begin": 0.01,
    "C_begin": 0.02,
}


def _apples(
    folder: Path,
    rng: Rng,
    inhibits: float = np.inf,
    fast: float = 0.0,
    draws: tuple[float, float, float] = (0.0, 0.0, 0.0),
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("h"),),
) -> None:
    """Carbon dioxide may slow respiration: by 1/(1 + C/inhibits), inhibits in kPa.

    The clock of the second recording may be fast, by that share. In it, the line of the analysers may draw in air of
    the laboratory: from when to when [s], and which share of the sample.
    """
    APPLES.build(folder)
    names = (("valve_1", "air", "L/min"), ("valve_2", "nitrogen", "L/min"), ("cooling", "chamber", "degC"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("box", "apple_box", "internal")
    parts = parts.replace("constant: 0 L/min", "constant: 0.4 L/min").replace("constant: 0 degC", "constant: 18 degC")
    wires = "".join(f"  - {c}.{n} -> box.{n}\n" for c, n, _ in names)
    scenario(folder, "Apples in a box", 172800.0, 60, 180, parts, wires)
    data_sheet(folder, APPLES, APPLES_KNOWN)
    v, m, r_m, k_o, rq, k_t, t_0, h_r, tau_f, tau_a, around, o_air, c_air, t_begin, o_begin, c_begin = drawn(
        rng, APPLES, APPLES_KNOWN
    )

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Pressures are in kPa."""
        a, warm, o, c = (float(s) for s in x)
        breathes = r_m * max(o, 0.0) / (max(o, 0.0) + 1e-3 * k_o) * float(np.exp(k_t * (warm - t_0)))
        breathes /= 1.0 + c / inhibits
        air, nitrogen = float(u[0]) / 6e4, float(u[1]) / 6e4
        return [
            (float(u[2]) + CELSIUS - a) / tau_a,
            (a - warm) / tau_f + h_r * breathes,
            (air * (1e-3 * o_air - o) - nitrogen * o - 1e-3 * m * around * breathes) / v,
            (air * (1e-3 * c_air - c) - nitrogen * c + 1e-3 * rq * m * around * breathes) / v,
        ]

    def kelvin(state: int) -> Callable[[Array, Array, Array], Array]:
        return lambda t, x, u: np.asarray(x[:, state] - CELSIUS)

    for number, (name, stop) in enumerate((("first", 172800.0), ("second", 129600.0), ("third", 151200.0))):
        air = drawn_steps(rng, stop, 9000.0, 0.15, 0.9, 180.0)
        if name == "third":
            air = telegraph(rng, stop, 8000.0, 0.17, 0.85, 180.0)
        nitrogen = drawn_steps(rng, stop, 13000.0, 0.0, 0.7, 180.0)
        chamber = drawn_steps(rng, stop, 20000.0, 12.0, 24.0, 180.0)
        air, nitrogen, chamber = (later(s, 60.0) for s in (air, nitrogen, chamber))
        t, x = integrated(
            rates, (t_begin, t_begin, 1e-3 * o_begin, 1e-3 * c_begin), (air, nitrogen, chamber), stop, 60.0
        )
        logger = loggers[number % len(loggers)]
        if fast and name == "second":
            logger = Logger(logger.unit, logger.zero, 1.0 + fast, logger.jitter)

        def spoil(column: str, t: Array, v: Array, now: bool = name == "second") -> Array:
            begin, end, share = draws
            outside = {"O2 kPa": OXYGEN, "CO2 kPa": CARBON}
            if not now or column not in outside:
                return v
            return np.where((t >= begin) & (t < end), v + share * (outside[column] - v), v)

        sensors = [
            Sensor("box.oxygen", "O2 kPa", "kPa", scaled(2, 1.0), 0.05, 180.0, noise_stated, 0.02),
            Sensor("box.carbon_dioxide", "CO2 kPa", "kPa", scaled(3, 1.0), 0.02, 180.0, noise_stated, 5e-3),
            Sensor("box.fruit", "T Apfel", "degC", kelvin(1), 0.08, 360.0, noise_stated, 0.02),
            Sensor("box.inside", "T Luft", "degC", kelvin(0), 0.12, 180.0, noise_stated, 0.05),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "valve_1.air": (air, "L/min"),
                "valve_2.nitrogen": (nitrogen, "L/min"),
                "cooling.chamber": (chamber, "degC"),
            },
            logger,
            recorded=["valve_1.air"],
            spoil=spoil,
        )
        write(folder / name, rng, made)


def apples_inhibited(folder: Path, rng: Rng) -> Truth:
    inhibits = rng.uniform(6.0, 9.0)
    _apples(folder, rng, inhibits=inhibits, noise_stated=None, loggers=(Logger("h"), Logger("min", zero=45.0)))
    return Truth(
        f"carbon dioxide slows the respiration of the apples: by 1/(1 + C/{inhibits:.3f} kPa); noise is not stated",
        PHYSICS,
        INHIBITED,
    )


def apples_clock(folder: Path, rng: Rng) -> Truth:
    fast = rng.uniform(7e-3, 0.011)
    _apples(folder, rng, fast=fast, loggers=(Logger("min", zero=20.0), Logger("h"), Logger("h", zero=7.0)))
    return Truth(f"the clock of the second recording is fast by {100.0 * fast:.3f} %", (*RECORDING, *SENSOR))


def apples_line(folder: Path, rng: Rng) -> Truth:
    begin = 180.0 * round(rng.uniform(32000.0, 48000.0) / 180.0)
    end, share = begin + 180.0 * round(rng.uniform(26000.0, 40000.0) / 180.0), rng.uniform(0.09, 0.14)
    _apples(folder, rng, draws=(begin, end, share), loggers=(Logger("h"), Logger("min", zero=2.0), Logger("h")))
    return Truth(
        f"the line of the analysers drew in air of the laboratory in the second recording from {begin:.0f} s to "
        f"{end:.0f} s: {100.0 * share:.2f} % of the sample of both gases was air",
        (*RECORDING, *SENSOR),
    )


# --- a small turbojet on a stand, FMI 2 Model Exchange; s, ms, g/s, W, rpm, degC, bar, N
_TURNS = "fmax(N, 500.0)"
TURBOJET = OdeModel(
    "turbojet",
    {
        "e_w": (2.6e6, "J/kg"),
        "k_c": (1.3e-8, "W*s^3"),
        "I": (6e-5, "kg*m^2"),
        "k_p": (1.2e-8, "s^2"),
        "p_a": (101325.0, "Pa"),
        "k_f": (1e-6, "N*s^2"),
        "h_t": (1.45e9, "K*rad/kg"),
        "k_t": (1e-6, "K*s^2"),
        "T_a": (290.15, "K"),
        "tau_w": (0.12, "s"),
        "tau_p": (0.08, "s"),
        "tau_g": (0.5, "s"),
        "tau_f": (0.1, "s"),
        "w_begin": (2.5e-3, "kg/s"),
        "N_begin": (7900.0, "rad/s"),
    },
    {"fuel": "kg/s", "generator": "W"},
    {
        "w": ("kg/s", "w_begin", "(fuel - w)/tau_w"),
        "N": ("rad/s", "N_begin", f"(e_w*w - generator - k_c*{_TURNS}*{_TURNS}*{_TURNS})/(I*{_TURNS})"),
        "p": ("Pa", "p_a*(1.0 + k_p*N_begin*N_begin)", "(p_a*(1.0 + k_p*N*N) - p)/tau_p"),
        "G": (
            "K",
            "T_a + k_t*N_begin*N_begin + h_t*w_begin/N_begin",
            f"(T_a + k_t*N*N + h_t*w/{_TURNS} - G)/tau_g",
        ),
        "F": ("N", "k_f*N_begin*N_begin", "(k_f*N*N - F)/tau_f"),
    },
    {"speed": ("rad/s", "N"), "case": ("Pa", "p"), "exhaust": ("K", "G"), "thrust": ("N", "F")},
    2e-3,
)
TURBOJET_KNOWN = {
    "e_w": 0.04,
    "k_c": 0.04,
    "I": 0.05,
    "k_p": 0.03,
    "p_a": 2e-3,
    "k_f": 0.03,
    "h_t": 0.03,
    "k_t": 0.08,
    "T_a": 3e-3,
    "tau_w": 0.1,
    "tau_p": 0.1,
    "tau_g": 0.08,
    "tau_f": 0.1,
    "w_begin": 0.02,
    "N_begin": 0.02,
}


def _turbojet(
    folder: Path,
    rng: Rng,
    soaks: tuple[float, float, float] = (0.0, 0.0, 1.0),
    light: float = 1.0,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Metal may take heat: the gas is soaks[0] (gas - metal) colder, the work of the fuel less by soaks[1] of that.

    The latter is in 1/K of (gas - metal); the metal follows the gas within soaks[2] [s]. The fuel of the second
    recording may be light, and less of it by that factor than is said.
    """
    TURBOJET.build(folder)
    parts = programme("pump", ("fuel", "g/s")).replace("constant: 0 g/s", "constant: 2.5 g/s")
    parts += programme("load", ("generator", "W")) + with_numbers("engine", "turbojet")
    wires = "  - pump.fuel -> engine.fuel\n  - load.generator -> engine.generator\n"
    scenario(folder, "A small turbojet on a stand", 66.0, 0.02, 0.06, parts, wires)
    data_sheet(folder, TURBOJET, TURBOJET_KNOWN)
    e_w, k_c, inertia, k_p, p_a, k_f, h_t, k_t, t_a, tau_w, tau_p, tau_g, tau_f, w_begin, n_begin = drawn(
        rng, TURBOJET, TURBOJET_KNOWN
    )
    colder, less, slow = soaks

    def gas_of(w: float, n: float) -> float:
        """Temperature of the gas, w in g/s and n in krad/s [K]."""
        return float(t_a + 1e6 * k_t * n**2 + 1e-6 * h_t * w / n)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """The fuel is in g/s, the speed in krad/s, the pressure in bar; the last is the metal's temperature."""
        w, n, p, shown, thrust, metal = (float(s) for s in x)
        gas = gas_of(w, n)
        power = 1e-3 * e_w * w * (1.0 - less * (gas - metal))
        return [
            (float(u[0]) - w) / tau_w,
            1e-6 * (power - float(u[1]) - 1e9 * k_c * n**3) / (inertia * n),
            (1e-5 * p_a * (1.0 + 1e6 * k_p * n**2) - p) / tau_p,
            (gas - colder * (gas - metal) - shown) / tau_g,
            (1e6 * k_f * n**2 - thrust) / tau_f,
            (gas - metal) / slow,
        ]

    def kelvin(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(x[:, 3] - CELSIUS)

    for number, (name, stop) in enumerate((("first", 66.0), ("second", 54.0), ("third", 60.0))):
        fuel = drawn_steps(rng, stop, 2.6, 1.8, 6.2, 0.06)
        if name == "third":
            fuel = stairs(rng, stop, 2.2, 1.95, 6.0, 6, 0.06)
        generator = drawn_steps(rng, stop, 4.0, 0.0, 1100.0, 0.06)
        fuel, generator = later(fuel, 0.02), later(generator, 0.02)
        burns = fuel
        if name == "second":
            burns = Steps(fuel.times, tuple(light * v for v in fuel.levels))
        w, n = 1e3 * w_begin, 1e-3 * n_begin
        gas = gas_of(w, n)
        start = (w, n, 1e-5 * p_a * (1.0 + 1e6 * k_p * n**2), gas, 1e6 * k_f * n**2, gas)
        t, x = integrated(rates, start, (burns, generator), stop, 0.02)
        sensors = [
            Sensor("engine.speed", "RPM", "rpm", scaled(1, 1e3 * RPM), 100.0, 0.06, noise_stated, 50.0, colour),
            Sensor("engine.case", "P3 bar", "bar", scaled(2, 1.0), 6e-3, 0.06, noise_stated, 1e-3, colour),
            Sensor("engine.exhaust", "EGT", "degC", kelvin, 2.0, 0.12, noise_stated, 1.0, colour),
            Sensor("engine.thrust", "Schub N", "N", scaled(4, 1.0), 0.6, 0.06, noise_stated, 0.1, colour),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"pump.fuel": (burns, "g/s"), "load.generator": (generator, "W")},
            loggers[number % len(loggers)],
            recorded=["load.generator"],
            told={"pump.fuel": fuel},
        )
        write(folder / name, rng, made)


def turbojet_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=12.0, empty=0.02), Logger("ms", zero=-400.0, jitter=0.1), Logger("s", gap=(24.0, 26.4)))
    _turbojet(folder, rng, colour=0.15, noise_stated=1.05, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.15 and is stated 1.05 times "
        "too large, two rates, a column of an input, jitter, empty cells, a gap of 2.4 s, loggers of s and ms",
        FINE,
    )


def turbojet_soaks(folder: Path, rng: Rng) -> Truth:
    colder, less, slow = rng.uniform(0.14, 0.2), rng.uniform(1.5e-4, 2.2e-4), rng.uniform(7.0, 11.0)
    _turbojet(folder, rng, soaks=(colder, less, slow), noise_stated=1.0 / 3.0, loggers=(PLAIN, Logger("ms", zero=90.0)))
    return Truth(
        f"metal of the turbine takes heat from the gas, and gives it back: it follows the gas within {slow:.2f} s, the "
        f"gas is {colder:.4f} (gas - metal) colder, and the work of the fuel less by {1e3 * less:.4f}e-3/K (gas - "
        "metal); noise is stated 3 times too small",
        PHYSICS,
        SOAKED,
    )


def turbojet_light(folder: Path, rng: Rng) -> Truth:
    light = rng.uniform(0.91, 0.94)
    _turbojet(folder, rng, light=light, loggers=(Logger("ms"), Logger("s", zero=2.0), PLAIN))
    return Truth(
        f"the fuel of the second recording was lighter than the one whose density was taken: its flow was {light:.4f} "
        "times what is said",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- a pupil in the light, FMI 2 Model Exchange, without units and with its keeper's names; s, ms, min
_SEEN = "log(1.0 + fmax(l, 0.0)*D*D/l_pol)"
PUPIL = OdeModel(
    "zrenica_3",
    {
        "tau_lampy": (0.1, ""),
        "l_pol": (20.0, ""),
        "tau_siatkowki": (0.2, ""),
        "tau_adaptacji": (6.0, ""),
        "k_adaptacji": (0.3, ""),
        "D_0": (7.0, ""),
        "g_lewa": (0.95, ""),
        "g_prawa": (0.85, ""),
        "k_bliz": (0.3, ""),
        "tau_bliz": (0.4, ""),
        "tau_lewa": (0.35, ""),
        "tau_prawa": (0.4, ""),
    },
    {"Swiatlo": "", "Bliz": ""},
    {
        "l": ("", "0.0", "(Swiatlo - l)/tau_lampy"),
        "r": ("", "0.0", f"({_SEEN} - r)/tau_siatkowki"),
        "z": ("", "0.0", "(r - z)/tau_adaptacji"),
        "n": ("", "0.0", "(Bliz - n)/tau_bliz"),
        "D": ("", "D_0", "(D_0 - g_lewa*(r - k_adaptacji*z) - k_bliz*n - D)/tau_lewa"),
        "E": ("", "D_0", "(D_0 - g_prawa*(r - k_adaptacji*z) - k_bliz*n - E)/tau_prawa"),
    },
    {"Lewa": ("", "D"), "Prawa": ("", "E"), "Refrakcja": ("", "n")},
    2e-3,
)
PUPIL_KNOWN = {
    "tau_lampy": 0.1,
    "l_pol": 0.06,
    "tau_siatkowki": 0.1,
    "tau_adaptacji": 0.08,
    "k_adaptacji": 0.08,
    "D_0": 0.02,
    "g_lewa": 0.05,
    "g_prawa": 0.05,
    "k_bliz": 0.06,
    "tau_bliz": 0.08,
    "tau_lewa": 0.08,
    "tau_prawa": 0.08,
}


def _pupil(
    folder: Path,
    rng: Rng,
    stays: tuple[float, float] = (0.0, 1.0),
    late: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """A slow sense of light may narrow both pupils as well: stays[0] times the signal, within stays[1] [s].

    The lamp of the second recording may follow its programme late [s].
    """
    PUPIL.build(folder)
    names = (("Lampa", "Swiatlo"), ("Tablica", "Bliz"))
    parts = "".join(programme(c, (n, "")) for c, n in names) + with_numbers("Osoba", "zrenica_3")
    wires = "".join(f"  - {c}.{n} -> Osoba.{n}\n" for c, n in names)
    scenario(folder, "Zrenica w swietle", 120.0, 0.02, 0.08, parts, wires)
    data_sheet(folder, PUPIL, PUPIL_KNOWN)
    tau_l, l_half, tau_r, tau_z, k_z, d_0, g_left, g_right, k_n, tau_n, tau_d, tau_e = drawn(rng, PUPIL, PUPIL_KNOWN)
    adds, lasts = stays

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """The last is what the slow sense says."""
        light, r, z, n, left, right, kept = (float(s) for s in x)
        seen = float(np.log(1.0 + max(light, 0.0) * left**2 / l_half))
        narrows = r - k_z * z + adds * kept
        return [
            (float(u[0]) - light) / tau_l,
            (seen - r) / tau_r,
            (r - z) / tau_z,
            (float(u[1]) - n) / tau_n,
            (d_0 - g_left * narrows - k_n * n - left) / tau_d,
            (d_0 - g_right * narrows - k_n * n - right) / tau_e,
            (seen - kept) / lasts,
        ]

    for number, (name, stop) in enumerate((("first", 120.0), ("second", 96.0), ("third", 108.0))):
        light = drawn_steps(rng, stop, 3.5, 0.0, 45.0, 0.08)
        if name == "third":
            light = bursts(rng, stop, 2.5, 3.5, 4.0, 44.0, 0.08)
        near = drawn_steps(rng, stop, 5.0, 0.0, 4.0, 0.08)
        light, near = later(light, 0.04), later(near, 0.04)
        shines = later(light, late) if late and name == "second" else light
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0, d_0, d_0, 0.0), (shines, near), stop, 0.02)
        sensors = [
            Sensor("Osoba.Lewa", "Lewa", "1", scaled(4, 1.0), 0.04, 0.08, noise_stated, 0.01),
            Sensor("Osoba.Prawa", "Prawa", "1", scaled(5, 1.0), 0.05, 0.08, noise_stated, 0.01),
            Sensor("Osoba.Refrakcja", "Refr", "1", scaled(3, 1.0), 0.08, 0.16, noise_stated, 0.02),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"Lampa.Swiatlo": (shines, ""), "Tablica.Bliz": (near, "")},
            loggers[number % len(loggers)],
            told={"Lampa.Swiatlo": light},
        )
        write(folder / name, rng, made)


def pupil_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=3.0, jitter=0.1), Logger("min"), Logger("ms", zero=-700.0, gap=(51.0, 54.2)))
    _pupil(folder, rng, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated rightly, no units, two rates, jitter, a gap of 3.2 s, loggers of "
        "s, min and ms",
        FINE,
    )


def pupil_stays(folder: Path, rng: Rng) -> Truth:
    adds, lasts = rng.uniform(0.22, 0.32), rng.uniform(18.0, 28.0)
    _pupil(folder, rng, stays=(adds, lasts), loggers=(Logger("ms", zero=20.0), PLAIN))
    return Truth(
        f"a slow sense of light (melanopsin) narrows both pupils as well: {adds:.4f} times the signal, with a time "
        f"constant of {lasts:.2f} s",
        PHYSICS,
        SLOW,
    )


def pupil_late(folder: Path, rng: Rng) -> Truth:
    late = 0.02 * round(rng.uniform(0.5, 0.8) / 0.02)
    _pupil(folder, rng, late=late, loggers=(PLAIN, Logger("s", zero=-5.0), Logger("ms")))
    return Truth(
        f"the lamp followed its programme {late:.2f} s late in the second recording, and is said to have followed it "
        "at once",
        (*RECORDING, *SENSOR),
        ("input_fault", "delay", "dead_time", "lag", "slow_input"),
    )


# --- a frill of coils at one supply: two strings of two, one behind a ballast; the tool's own units
FRILL = {
    "reference_resistance": (1.7, "ohm", 0.02, 0.02),
    "heat_transfer_coefficient": (80.0, "W/(m^2*K)", 0.05, 0.02),
    "area": (130.0, "mm^2", 0.0, 0.0),
    "volume": (10.0, "mm^3", 0.0, 0.0),
    "density": (6450.0, "kg/m^3", 0.0, 0.0),
    "specific_heat": (700.0, "J/(kg*K)", 0.05, 0.02),
}
#: Coils in series, resistances of wires, ballasts, and the supply [ohm].
FRILL_STRINGS, FRILL_WIRES, FRILL_BALLAST, FRILL_INNER = (2, 2), 0.16, (0.0, 0.9), 0.22
#: Limit of the supply [A], rise of resistance [1/K], temperature that the numbers are for [degC].
FRILL_LIMIT, FRILL_RISE, FRILL_COLD = 1.75, 7.5e-4, 21.0


def _frill_files(folder: Path) -> None:
    """Scenario and parameter set of the four coils."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = ["title: Coils of a frill", "parameters:"]
    for name, (value, unit, uncertainty, scatter) in FRILL.items():
        known = f"uncertainty: {uncertainty:g}, scatter: {scatter:g}"
        lines.append(f'  {name}: {{value: {value:g}, unit: {unit}, source: "own measurement", {known}}}')
    lines += [
        '  use_regressed_cooling_rate: {value: false, source: "cools as it heats"}',
        f'  initial_temperature: {{value: {FRILL_COLD:g}, unit: degC, source: "room"}}',
        f'  reference_temperature: {{value: {FRILL_COLD:g}, unit: degC, source: "room"}}',
        f'  resistance_temperature_coefficient: {{value: {FRILL_RISE:g}, unit: 1/K, source: "own measurement"}}',
    ]
    (folder / "numbers.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    elements = [f"{{kind: current_limit, supply: 1, limit: {FRILL_LIMIT} A, share: 1}}"]
    elements += [
        f"{{kind: contact, string: {s}, resistance: {ohm} ohm}}" for s, ohm in enumerate(FRILL_BALLAST, start=1) if ohm
    ]
    parts = (
        programme("bench", ("voltage", "V"))
        + programme("room", ("temperature", "degC")).replace("constant: 0 degC", f"constant: {FRILL_COLD:g} degC")
        + f"  circuit:\n    kind: ngspice\n    strings: [{', '.join(str(n) for n in FRILL_STRINGS)}]\n"
        f"    supply: common\n    supply_resistance: {FRILL_INNER} ohm\n    string_resistance: {FRILL_WIRES} ohm\n"
        "    elements:\n"
        + "".join(f"      - {e}\n" for e in elements)
        + f"    start: {{resistance: {FRILL['reference_resistance'][0]} ohm}}\n"
        "  coils: {kind: actuator, fmu: thermal_stiffness, electrical: circuit, ambient: room, "
        "parameter_set: numbers.yaml}\n"
    )
    scenario(folder, "A frill of coils", 105.0, 0.05, 0.1, parts, "  - bench.voltage -> circuit.supply_voltage\n")


def _frill_off(rng: Rng, name: str) -> Array:
    """A number of each coil as it is."""
    value, _, uncertainty, scatter = FRILL[name]
    return np.asarray(value * np.exp(uncertainty * rng.normal() + scatter * rng.normal(size=sum(FRILL_STRINGS))))


def _frill_course(
    numbers: Sequence[Array], volts: Steps, room: Steps, start: float, stop: float, step: float, sheds: float
) -> tuple[Array, Array]:
    """Times [s], and temperatures of the coils [degC], currents of the strings [A], voltage of the terminals [V].

    Heat by the exponential of equation (3) over a step, with the currents and the conductances of its middle.

    Args:
        numbers: Resistances [ohm], conductances [W/K], capacities [J/K] of the coils.
        volts: Of the supply.
        room: Its temperature [degC].
        start: Temperature of the coils at 0 [degC].
        stop: End [s].
        step: Of time [s].
        sheds: Share by which a conductance grows for each kelvin above the room [1/K].
    """
    cold, loses, holds = numbers
    times: Array = step * np.arange(round(stop / step) + 1, dtype=np.float64)
    emf, around = volts.at(times), room.at(times)
    string = np.repeat(np.arange(len(FRILL_STRINGS)), FRILL_STRINGS)

    def currents(hot: Array, v: float) -> tuple[Array, float]:
        ohms = np.bincount(string, hot) + FRILL_WIRES + np.asarray(FRILL_BALLAST)
        together = float(np.sum(1.0 / ohms))
        terminal = min(v / (FRILL_INNER + 1.0 / together), FRILL_LIMIT) / together
        return np.asarray(terminal / ohms), terminal

    def relaxed(warm: Array, at: Array, v: float, outside: float, span: float) -> Array:
        hot = cold * (1.0 + FRILL_RISE * (at - FRILL_COLD))
        given = currents(hot, v)[0][string] ** 2 * hot
        passes = loses * (1.0 + sheds * np.maximum(at - outside, 0.0))
        end = outside + given / passes
        return np.asarray(end + (warm - end) * np.exp(-passes * span / holds))

    warm = np.full(len(string), start)
    found = np.empty((len(times), len(string) + len(FRILL_STRINGS) + 1))
    for i, (v, outside) in enumerate(zip(emf, around)):
        amps, terminal = currents(cold * (1.0 + FRILL_RISE * (warm - FRILL_COLD)), float(v))
        found[i] = (*warm, *amps, terminal)
        middle = relaxed(warm, warm, float(v), float(outside), step / 2)
        warm = relaxed(warm, middle, float(v), float(outside), step)
    return times, found


def _frill(
    folder: Path,
    rng: Rng,
    sheds: float = 0.0,
    lifted: tuple[float, float, float] = (0.0, 0.0, 1.0),
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Coils may lose more heat the warmer they are: sheds is by which share for each kelvin above the room [1/K].

    The thermometer of the second coil may stand off in the second recording: from when to when [s], and which share of
    what the coil is above the room it shows.
    """
    _frill_files(folder)
    conductance = 1e-6 * _frill_off(rng, "area") * _frill_off(rng, "heat_transfer_coefficient")
    capacity = 1e-9 * _frill_off(rng, "density") * _frill_off(rng, "volume") * _frill_off(rng, "specific_heat")
    numbers = (_frill_off(rng, "reference_resistance"), conductance, capacity)

    for number, (name, stop) in enumerate((("first", 105.0), ("second", 85.0), ("third", 95.0))):
        volts = drawn_steps(rng, stop, 6.0, 0.0, 4.6, 0.1)
        if name == "third":
            volts = telegraph(rng, stop, 5.0, 0.3, 4.2, 0.1)
        volts = later(volts, 0.05)
        room = ramped(rng, stop, 32.0, 19.5, 23.5, 0.5)
        said = room.levels[0]
        t, x = _frill_course(numbers, volts, room, said + 0.2 * float(rng.normal()), stop, 0.0125, sheds)

        def spoil(column: str, t: Array, v: Array, now: bool = name == "second", room: Steps = room) -> Array:
            begin, end, share = lifted
            outside = room.at(t)
            off = (t >= begin) & (t < end)
            return np.where(off, outside + share * (v - outside), v) if now and column == "T2" else v

        sensors = [
            Sensor(f"string[{s}].current", f"I{s} mA", "mA", scaled(3 + s, 1e3), 1.5, 0.1, noise_stated, 0.5)
            for s in (1, 2)
        ]
        sensors += [Sensor("supply.voltage", "U mV", "mV", scaled(6, 1e3), 6.0, 0.1, noise_stated, 2.0)]
        sensors += [
            Sensor(f"coil[{c}].temperature", f"T{c}", "degC", scaled(c - 1, 1.0), 0.25, 0.2, noise_stated, 0.1)
            for c in (1, 2, 3, 4)
        ]
        made = Written(
            t,
            x,
            sensors,
            {"bench.voltage": (volts, "V"), "room.temperature": (room, "degC")},
            loggers[number % len(loggers)],
            recorded=["room.temperature"],
            spoil=spoil,
            sidecar={"components": {"coils": {"parameters": {"initial_temperature": f"{said:g} degC"}}}},
        )
        write(folder / name, rng, made)


def frill_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=7.0, empty=0.02), Logger("ms", zero=-150.0), Logger("s", gap=(41.0, 44.5)))
    _frill(folder, rng, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, coil by coil too, start off by 0.2 K (deviation), noise stated rightly, two "
        "rates, a column of an input, empty cells, a gap of 3.5 s, loggers of s and ms",
        FINE,
    )


def frill_sheds(folder: Path, rng: Rng) -> Truth:
    sheds = rng.uniform(2.4e-3, 3.6e-3)
    _frill(folder, rng, sheds=sheds, loggers=(Logger("ms"), Logger("s", zero=2.0)))
    return Truth(
        f"every coil loses more heat the warmer it is (rising air, radiation): its conductance grows by "
        f"{100.0 * sheds:.4f} % for each kelvin above the room",
        PHYSICS,
        LOSING,
    )


def frill_lifted(folder: Path, rng: Rng) -> Truth:
    begin = 0.2 * round(rng.uniform(22.0, 32.0) / 0.2)
    end, share = begin + 0.2 * round(rng.uniform(20.0, 30.0) / 0.2), rng.uniform(0.8, 0.88)
    _frill(folder, rng, lifted=(begin, end, share), loggers=(PLAIN, Logger("s", zero=-3.0), Logger("ms")))
    return Truth(
        f"the thermometer of the second coil stood off in the second recording from {begin:.1f} s to {end:.1f} s, and "
        f"showed {share:.4f} of what the coil was above the room",
        (*RECORDING, *SENSOR),
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    apples_line,
    pupil_null,
    crystals_scales,
    gaspipe_swapped,
    frill_sheds,
    eyeball_null,
    turbojet_light,
    glider_stalls,
    crystals_null,
    pupil_late,
    gaspipe_branches,
    apples_clock,
    frill_null,
    glider_slides,
    eyeball_two,
    turbojet_null,
    crystals_other_run,
    pupil_stays,
    gaspipe_null,
    apples_inhibited,
    glider_null,
    frill_lifted,
    turbojet_soaks,
    crystals_two,
    eyeball_narrows,
)
