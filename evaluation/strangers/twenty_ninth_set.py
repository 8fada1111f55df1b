"""Twenty-ninth set: a muscle on a lever, a ship that rolls, an irrigation canal, an anaesthesia, a belt conveyor, an
ozoniser of water, optical tweezers, a comb of coils.

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
from evaluation.strangers.fourth_set import between, bursts, data_sheet, scaled
from evaluation.strangers.lab import Logger, Sensor, Steps, Written, drawn_steps, write
from evaluation.strangers.sixteenth_set import later
from evaluation.strangers.tenth_set import stairs
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.thirteenth_set import wandering
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth

#: Fall [m/s^2], imperial gallons in a US gallon's place.
FALL, GALLONS = 9.81, 4.54609 / 3.785412
#: Laws that are true where something is stored of which the model knows nothing.
STORED = ("hidden_state", "hidden_mass", "hidden_capacity", "second_mass", "hidden_storage", "memory", "relaxation")
#: Laws that are true where a number depends on a state.
RATED = ("nonlinear_rate", "rate_of_state", "state_dependent_rate", "parameter_of_state", "interaction")
#: Laws that are true where something begins at a value.
BEGINNING = ("threshold", "dead_zone", "dead_band", "onset")
#: Laws that are true where a muscle tires and recovers.
TIRING = (
    *STORED,
    *RATED,
    "fatigue",
    "adaptation",
    "wear",
    "ageing",
    "aging",
    "degradation",
    "gain_of_state",
    "state_dependent_gain",
    "desensitisation",
)
#: Laws that are true where something pulls with speed.
DRAGGED = (
    *RATED,
    "drag",
    "quadratic_drag",
    "quadratic_damping",
    "nonlinear_damping",
    "viscous_friction",
    "friction",
    "quadratic_loss",
    "nonlinear_loss",
    "gain_of_state",
)
#: Laws that are true where water seeps away above a level.
SEEPING = (*BEGINNING, *RATED, "leakage", "leak", "nonlinear_leakage", "overflow", "bypass", "saturation", "loss")
#: Laws that are true where a body clears less the less blood flows.
CLEARING = (
    *RATED,
    "clearance",
    "feedback",
    "rate_of_input",
    "gain_of_state",
    "conductance_of_state",
    "nonlinear_loss",
    "nonlinear_leakage",
)
#: Laws that are true where a material clings to what carries it.
CLINGING = (*STORED, *RATED, "delay", "lag", "dead_time", "adhesion", "hysteresis", "slow_input")
#: Laws that are true where something decays with itself.
DECAYING = (*RATED, "second_order", "quadratic_loss", "nonlinear_loss", "side_reaction", "gain_of_state", "decay")
#: Laws that are true where a source yields less once it is warm.
WARMING = (
    *STORED,
    *RATED,
    "self_heating",
    "temperature_dependence",
    "gain_of_input",
    "nonlinear_gain",
    "saturation",
    "gain_of_state",
    "state_dependent_gain",
    "parameter_of_input",
    "derating",
)
#: Laws that are true where light heats what it holds, and thins it.
THINNED = (*WARMING, "viscosity", "rate_of_input", "damping_of_state", "nonlinear_damping", "viscous_friction")
#: Laws that are true where two bodies exchange heat.
EXCHANGED = (
    *RATED,
    "exchange",
    "coupling",
    "thermal_coupling",
    "neighbour",
    "neighbor",
    "conduction",
    "cross_talk",
    "crosstalk",
    "heat_exchange",
    "heat_loss",
    "mixing",
)


# --- a frog's muscle in an organ bath, on a lever, FMI 2 Model Exchange; s, ms, 1/s, mN, mm
MUSCLE = OdeModel(
    "muscle",
    {
        "f_h": (22.0, "1/s"),
        "tau_c": (0.06, "s"),
        "tau_a": (0.09, "s"),
        "F_0": (0.35, "N"),
        "w": (0.018, "m"),
        "k_p": (25.0, "N/m"),
        "k_t": (150.0, "N/m"),
        "b_0": (4.0, "N*s/m"),
        "b_1": (12.0, "N*s/m"),
        "m": (0.02, "kg"),
        "d": (0.7, "N*s/m"),
        "tau_l": (0.03, "s"),
    },
    {"stimulus": "1/s", "load": "N"},
    {
        "c": ("", "0.0", "(stimulus/(fabs(stimulus) + f_h) - c)/tau_c"),
        "a": ("", "0.0", "(c - a)/tau_a"),
        "F_l": ("N", "0.0", "(load - F_l)/tau_l"),
        "l": ("m", "0.0", "(k_t*(x - l) - k_p*l - F_0*a*exp(-l*l/(w*w)))/(b_0 + b_1*a)"),
        "x": ("m", "0.0", "v"),
        "v": ("m/s", "0.0", "(F_l - k_t*(x - l) - d*v)/m"),
    },
    {"position": ("m", "x"), "force": ("N", "k_t*(x - l)")},
    1e-3,
)
MUSCLE_KNOWN = {
    "f_h": 0.06,
    "tau_c": 0.08,
    "tau_a": 0.08,
    "F_0": 0.05,
    "w": 0.06,
    "k_p": 0.05,
    "k_t": 0.05,
    "b_0": 0.08,
    "b_1": 0.08,
    "m": 0.02,
    "d": 0.1,
    "tau_l": 0.08,
}


def _muscle(
    folder: Path,
    rng: Rng,
    tires: tuple[float, float] = (0.0, 1.0),
    knocked: tuple[float, float, float] = (0.0, 0.0, 0.0),
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The muscle may tire: its force falls by tires[0] a of what is left [1/s], and recovers within tires[1] [s].

    The sensor of the lever may be off in the second recording: from when to when [s], and by how much [mm].
    """
    MUSCLE.build(folder)
    parts = programme("stimulator", ("stimulus", "1/s")) + programme("motor", ("load", "mN"))
    parts += with_numbers("bath", "muscle")
    wires = "  - stimulator.stimulus -> bath.stimulus\n  - motor.load -> bath.load\n"
    scenario(folder, "A muscle on a lever", 44.0, 0.01, 0.04, parts, wires)
    data_sheet(folder, MUSCLE, MUSCLE_KNOWN)
    f_h, tau_c, tau_a, f_0, w, k_p, k_t, b_0, b_1, m, d, tau_l = drawn(rng, MUSCLE, MUSCLE_KNOWN)
    falls, recovers = tires

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Forces are in mN, lengths in mm; the last is the share of the force that is left."""
        c, a, load, inner, outer, v, left = (float(s) for s in x)
        tendon = k_t * (outer - inner)
        active = 1e3 * f_0 * left * a * np.exp(-((1e-3 * inner / w) ** 2))
        return [
            (float(u[0]) / (float(u[0]) + f_h) - c) / tau_c,
            (c - a) / tau_a,
            (float(u[1]) - load) / tau_l,
            (tendon - k_p * inner - active) / (b_0 + b_1 * a),
            v,
            (load - tendon - d * v) / m,
            (1.0 - left) / recovers - falls * a * left,
        ]

    def force(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(k_t * (x[:, 4] - x[:, 3]))

    for number, (name, stop) in enumerate((("first", 44.0), ("second", 36.0), ("third", 40.0))):
        stimulus = drawn_steps(rng, stop, 1.1, 0.0, 60.0, 0.04)
        if name == "third":
            stimulus = bursts(rng, stop, 0.9, 1.2, 12.0, 58.0, 0.04)
        load = drawn_steps(rng, stop, 1.6, 15.0, 190.0, 0.04)
        stimulus, load = later(stimulus, 0.02), later(load, 0.02)
        t, x = integrated(rates, (*(0.0,) * 6, 1.0), (stimulus, load), stop, 0.01)

        def spoil(column: str, t: Array, v: Array, now: bool = name == "second") -> Array:
            begin, end, by = knocked
            return np.where((t >= begin) & (t < end), v + by, v) if now and column == "Hebel mm" else v

        sensors = [
            Sensor("bath.position", "Hebel mm", "mm", scaled(4, 1.0), 0.06, 0.04, noise_stated, 0.01),
            Sensor("bath.force", "Kraft mN", "mN", force, 1.5, 0.04, noise_stated, 0.2),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"stimulator.stimulus": (stimulus, "1/s"), "motor.load": (load, "mN")},
            loggers[number % len(loggers)],
            spoil=spoil,
        )
        write(folder / name, rng, made)


def muscle_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=500.0), Logger("s", zero=-2.0, empty=0.02), Logger("s", gap=(17.0, 18.6)))
    _muscle(folder, rng, noise_stated=None, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, empty cells, a gap of 1.6 s, loggers of s and ms", FINE
    )


def muscle_tires(folder: Path, rng: Rng) -> Truth:
    falls, recovers = rng.uniform(0.03, 0.05), rng.uniform(40.0, 70.0)
    _muscle(folder, rng, tires=(falls, recovers), loggers=(PLAIN, Logger("ms", zero=80.0)))
    return Truth(
        f"the muscle tires: its force falls by {falls:.4f}/s a of what is left, and recovers with a time constant of "
        f"{recovers:.1f} s",
        PHYSICS,
        TIRING,
    )


def muscle_knocked(folder: Path, rng: Rng) -> Truth:
    begin = 0.04 * round(rng.uniform(9.0, 14.0) / 0.04)
    end = begin + 0.04 * round(rng.uniform(7.0, 11.0) / 0.04)
    by = rng.uniform(0.5, 0.8)
    _muscle(folder, rng, knocked=(begin, end, by), loggers=(Logger("s", zero=1.0), PLAIN, Logger("ms")))
    return Truth(
        f"the sensor of the lever was knocked in the second recording, and shows {by:.3f} mm too much from {begin:.2f} "
        f"s to {end:.2f} s",
        (*RECORDING, *SENSOR),
    )


# --- a model of a ferry that rolls, with a tank against it, FMI 3 Model Exchange; s, ms, N m, deg, deg/s, mm
FERRY = OdeModel(
    "ferry",
    {
        "I": (0.9, "kg*m^2"),
        "D": (0.3, "N*m*s/rad"),
        "C": (22.0, "N*m/rad"),
        "I_t": (0.05, "kg*m^2"),
        "D_t": (0.09, "N*m*s/rad"),
        "C_t": (1.2, "N*m/rad"),
        "C_c": (0.8, "N*m/rad"),
        "r_t": (0.2, "m"),
        "tau_w": (0.12, "s"),
        "tau_p": (0.3, "s"),
    },
    {"wave": "N*m", "pump": "N*m"},
    {
        "M": ("N*m", "0.0", "(wave - M)/tau_w"),
        "P": ("N*m", "0.0", "(pump - P)/tau_p"),
        "phi": ("rad", "0.0", "p"),
        "p": ("rad/s", "0.0", "(M - D*p - C*phi + C_c*q)/I"),
        "q": ("rad", "0.0", "s"),
        "s": ("rad/s", "0.0", "(P - D_t*s - C_t*q + C_c*phi)/I_t"),
    },
    {"roll": ("rad", "phi"), "rate": ("rad/s", "p"), "level": ("m", "r_t*q")},
    2e-3,
)
FERRY_KNOWN = {
    "I": 0.02,
    "D": 0.08,
    "C": 0.02,
    "I_t": 0.03,
    "D_t": 0.08,
    "C_t": 0.03,
    "C_c": 0.05,
    "r_t": 0.01,
    "tau_w": 0.08,
    "tau_p": 0.08,
}


def _ferry(
    folder: Path,
    rng: Rng,
    keels: float = 0.0,
    is_reversed: bool = False,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Bilge keels may brake the roll: keels p |p| [N*m*s^2/rad^2]; the gyro may be reversed in the second recording."""
    build3(FERRY, folder, has_co_simulation=False)
    parts = programme("maker", ("wave", "N*m")) + programme("tank", ("pump", "N*m")) + with_numbers("hull", "ferry")
    wires = "  - maker.wave -> hull.wave\n  - tank.pump -> hull.pump\n"
    scenario(folder, "A ferry that rolls", 64.0, 0.01, 0.05, parts, wires)
    data_sheet(folder, FERRY, FERRY_KNOWN)
    inertia, d, c, i_t, d_t, c_t, c_c, r_t, tau_w, tau_p = drawn(rng, FERRY, FERRY_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        moment, pump, phi, p, q, s = (float(v) for v in x)
        return [
            (float(u[0]) - moment) / tau_w,
            (float(u[1]) - pump) / tau_p,
            p,
            (moment - d * p - keels * p * abs(p) - c * phi + c_c * q) / inertia,
            s,
            (pump - d_t * s - c_t * q + c_c * phi) / i_t,
        ]

    for number, (name, stop) in enumerate((("first", 64.0), ("second", 50.0), ("third", 56.0))):
        wave = drawn_steps(rng, stop, 0.9, -3.2, 3.2, 0.05)
        if name == "third":
            wave = telegraph(rng, stop, 0.9, -2.2, 2.2, 0.05)
        pump = drawn_steps(rng, stop, 2.5, -0.12, 0.12, 0.05)
        wave, pump = later(wave, 0.02), later(pump, 0.02)
        t, x = integrated(rates, (0.0,) * 6, (wave, pump), stop, 0.01)
        sign = -1.0 if is_reversed and name == "second" else 1.0
        sensors = [
            Sensor("hull.roll", "Krängung", "deg", scaled(2, DEGREES), 0.15, 0.05, noise_stated, 0.02, colour),
            Sensor("hull.rate", "Gyro deg/s", "deg/s", scaled(3, sign * DEGREES), 0.5, 0.05, noise_stated, 0.1, colour),
            Sensor("hull.level", "Tank mm", "mm", scaled(4, 1e3 * r_t), 1.0, 0.1, noise_stated, 0.2, colour),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"maker.wave": (wave, "N*m"), "tank.pump": (pump, "N*m")},
            loggers[number % len(loggers)],
            recorded=["tank.pump"],
        )
        write(folder / name, rng, made)


def ferry_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=40.0, jitter=0.1), Logger("ms", empty=0.03), Logger("s", gap=(22.0, 24.0)))
    _ferry(folder, rng, colour=0.1, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.1 and is stated rightly, two "
        "rates, a column of an input, jitter, empty cells, a gap of 2 s, loggers of s and ms, FMI 3",
        FINE,
    )


def ferry_keels(folder: Path, rng: Rng) -> Truth:
    keels = rng.uniform(0.4, 0.7)
    _ferry(folder, rng, keels=keels, loggers=(PLAIN, Logger("s", zero=7.0)))
    return Truth(f"bilge keels brake the roll with {keels:.3f} N m s^2/rad^2 p |p| more", PHYSICS, DRAGGED)


def ferry_reversed(folder: Path, rng: Rng) -> Truth:
    _ferry(folder, rng, is_reversed=True, loggers=(Logger("ms", zero=60.0), PLAIN, Logger("s", zero=-1.0)))
    return Truth(
        "the gyro was mounted the other way round in the second recording: its rate has the opposite sign",
        (*RECORDING, *SENSOR),
    )


# --- an irrigation canal of three reaches, FMI 2 Co-Simulation that hides its states; min, h, L/s, mm, cm
_GATE_1 = f"c_g*b_g*G_1*sqrt(2.0*{FALL})*(h_1 - h_2)/sqrt(fabs(h_1 - h_2) + 0.005)"
_GATE_2 = f"c_g*b_g*G_2*sqrt(2.0*{FALL})*(h_2 - h_3)/sqrt(fabs(h_2 - h_3) + 0.005)"
CANAL = OdeModel(
    "canal",
    {
        "A_1": (170.0, "m^2"),
        "A_2": (150.0, "m^2"),
        "A_3": (190.0, "m^2"),
        "b_g": (0.8, "m"),
        "c_g": (0.6, ""),
        "c_w": (2.1, "m^(3/2)/s"),
        "p_w": (0.6, "m"),
        "tau_g": (20.0, "s"),
        "tau_q": (60.0, "s"),
        "h1_begin": (1.45, "m"),
        "h2_begin": (1.15, "m"),
        "h3_begin": (0.86, "m"),
        "G_begin": (0.28, "m"),
        "q_begin": (0.28, "m^3/s"),
    },
    {"inflow": "m^3/s", "upper": "m", "lower": "m", "offtake": "m^3/s"},
    {
        "q": ("m^3/s", "q_begin", "(inflow - q)/tau_q"),
        "G_1": ("m", "G_begin", "(upper - G_1)/tau_g"),
        "G_2": ("m", "G_begin", "(lower - G_2)/tau_g"),
        "h_1": ("m", "h1_begin", f"(q - {_GATE_1})/A_1"),
        "h_2": ("m", "h2_begin", f"({_GATE_1} - {_GATE_2} - offtake)/A_2"),
        "h_3": ("m", "h3_begin", f"({_GATE_2} - c_w*pow(fmax(h_3 - p_w, 0.0), 1.5))/A_3"),
    },
    {"level_1": ("m", "h_1"), "level_2": ("m", "h_2"), "level_3": ("m", "h_3")},
    1.0,
)
CANAL_KNOWN = {
    "A_1": 0.03,
    "A_2": 0.03,
    "A_3": 0.03,
    "c_g": 0.03,
    "c_w": 0.03,
    "p_w": 5e-3,
    "tau_g": 0.1,
    "tau_q": 0.1,
    "h1_begin": 4e-3,
    "h2_begin": 4e-3,
    "h3_begin": 4e-3,
}


def _canal(
    folder: Path,
    rng: Rng,
    seeps: tuple[float, float] = (0.0, 9.0),
    jams: tuple[float, float, float] | None = None,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The bank of the second reach may seep: seeps[0] (h_2 - seeps[1]) above seeps[1] [m^2/s, m].

    The lower gate may be jammed in the second recording: from when to when [s], and at what opening [mm].
    """
    CANAL.build(folder)
    names = (
        ("head", "inflow", "L/s"),
        ("gate_1", "upper", "mm"),
        ("gate_2", "lower", "mm"),
        ("farm", "offtake", "L/s"),
    )
    parts = "".join(programme(c, (n, u)) for c, n, u in names).replace("constant: 0 mm", "constant: 280 mm")
    parts += with_numbers("canal", "canal", "internal")
    wires = "".join(f"  - {c}.{n} -> canal.{n}\n" for c, n, _ in names)
    scenario(folder, "An irrigation canal", 14400.0, 5, 15, parts, wires)
    data_sheet(folder, CANAL, CANAL_KNOWN)
    a_1, a_2, a_3, b_g, c_g, c_w, p_w, tau_g, tau_q, *begins = drawn(rng, CANAL, CANAL_KNOWN)
    h_begins, g_begin, q_begin = begins[:3], begins[3], begins[4]
    loses, least = seeps

    def through(opening: float, head: float) -> float:
        return float(c_g * b_g * opening * np.sqrt(2.0 * FALL) * head / np.sqrt(abs(head) + 0.005))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        q, g_1, g_2, h_1, h_2, h_3 = (float(s) for s in x)
        first, second = through(g_1, h_1 - h_2), through(g_2, h_2 - h_3)
        return [
            (1e-3 * float(u[0]) - q) / tau_q,
            (1e-3 * float(u[1]) - g_1) / tau_g,
            (1e-3 * float(u[2]) - g_2) / tau_g,
            (q - first) / a_1,
            (first - second - 1e-3 * float(u[3]) - loses * max(h_2 - least, 0.0)) / a_2,
            (second - c_w * max(h_3 - p_w, 0.0) ** 1.5) / a_3,
        ]

    for number, (name, stop) in enumerate((("first", 14400.0), ("second", 11700.0), ("third", 12600.0))):
        inflow = drawn_steps(rng, stop, 900.0, 190.0, 370.0, 15.0)
        if name == "third":
            inflow = wandering(rng, stop, 700.0, 200.0, 360.0, 15.0)
        upper = drawn_steps(rng, stop, 700.0, 220.0, 350.0, 15.0)
        lower = drawn_steps(rng, stop, 800.0, 220.0, 350.0, 15.0)
        offtake = bursts(rng, stop, 900.0, 800.0, 20.0, 70.0, 15.0)
        inflow, upper, lower, offtake = (later(s, 5.0) for s in (inflow, upper, lower, offtake))
        stands = lower
        if jams is not None and name == "second":
            at = jams[2]
            stands = between(lower, jams[0], jams[1], lambda v, at=at: at)  # type: ignore[misc]
        start = (q_begin, g_begin, g_begin, *h_begins)
        t, x = integrated(rates, start, (inflow, upper, stands, offtake), stop, 5.0)
        sensors = [
            Sensor(f"canal.level_{n}", f"Pegel {n} cm", "cm", scaled(2 + n, 100.0), 0.4, 15.0, noise_stated, 0.1)
            for n in (1, 2, 3)
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "head.inflow": (inflow, "L/s"),
                "gate_1.upper": (upper, "mm"),
                "gate_2.lower": (stands, "mm"),
                "farm.offtake": (offtake, "L/s"),
            },
            loggers[number % len(loggers)],
            recorded=["head.inflow"],
            told={"gate_2.lower": lower},
        )
        write(folder / name, rng, made)


def canal_null(folder: Path, rng: Rng) -> Truth:
    loggers = (
        Logger("min", zero=15.0, is_comma=True),
        Logger("h", is_comma=True),
        Logger("s", is_comma=True, gap=(5400.0, 6000.0)),
    )
    _canal(folder, rng, noise_stated=1.0 / 3.0, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 3 times too small, a column of an input, decimal commas, a gap "
        "of 10 min, loggers of min, h and s, Co-Simulation",
        FINE,
    )


def canal_seeps(folder: Path, rng: Rng) -> Truth:
    loses, least = rng.uniform(0.2, 0.3), rng.uniform(1.02, 1.1)
    _canal(folder, rng, seeps=(loses, least), loggers=(Logger("min"), Logger("s", zero=600.0)))
    return Truth(
        f"water seeps through the bank of the second reach above a level of {100.0 * least:.2f} cm, "
        f"{10.0 * loses:.3f} L/s for each centimetre above",
        PHYSICS,
        SEEPING,
    )


def canal_jams(folder: Path, rng: Rng) -> Truth:
    begin = 15.0 * round(rng.uniform(3000.0, 4000.0) / 15.0)
    end, at = begin + 15.0 * round(rng.uniform(3200.0, 4200.0) / 15.0), rng.uniform(195.0, 215.0)
    _canal(folder, rng, jams=(begin, end, at), loggers=(Logger("s"), Logger("min"), Logger("h", zero=2.0)))
    return Truth(
        f"a branch jams the lower gate in the second recording, at {at:.1f} mm from {begin:.0f} s to {end:.0f} s, and "
        "the gate is said to have moved as it was told",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- a pig under two anaesthetics, FMI 2 Model Exchange, without units and with its keeper's names; min, h
_DOSIS = "(Ce/c50_p + Re/c50_r + 1e-9)"
SLEEP = OdeModel(
    "cerdo_4",
    {
        "V_p": (4.3, ""),
        "k_10": (0.38, ""),
        "k_12": (0.3, ""),
        "k_21": (0.2, ""),
        "k_e0": (0.456, ""),
        "V_r": (5.1, ""),
        "r_10": (0.5, ""),
        "r_12": (0.37, ""),
        "r_21": (0.2, ""),
        "r_e0": (0.6, ""),
        "c50_p": (4.5, ""),
        "c50_r": (16.0, ""),
        "pendiente": (2.2, ""),
        "B_0": (96.0, ""),
        "P_0": (92.0, ""),
        "a_p": (0.5, ""),
        "a_r": (0.35, ""),
        "tau_pres": (100.0, ""),
        "tau_bis": (25.0, ""),
    },
    {"Propofol": "", "Remi": ""},
    {
        "C1": ("", "0.0", "(Propofol/V_p - (k_10 + k_12)*C1 + k_21*C2)/60.0"),
        "C2": ("", "0.0", "(k_12*C1 - k_21*C2)/60.0"),
        "Ce": ("", "0.0", "k_e0*(C1 - Ce)/60.0"),
        "R1": ("", "0.0", "(Remi/V_r - (r_10 + r_12)*R1 + r_21*R2)/60.0"),
        "R2": ("", "0.0", "(r_12*R1 - r_21*R2)/60.0"),
        "Re": ("", "0.0", "r_e0*(R1 - Re)/60.0"),
        "Bs": ("", "B_0", f"(B_0/(1.0 + pow(fabs({_DOSIS}), pendiente)) - Bs)/tau_bis"),
        "P": ("", "P_0", "(P_0*(1.0 - a_p*Ce/(Ce + 4.0) - a_r*Re/(Re + 10.0)) - P)/tau_pres"),
    },
    {"Indice": ("", "Bs"), "Presion": ("", "P"), "Plasma": ("", "C1")},
    1.0,
)
SLEEP_KNOWN = {
    "V_p": 0.05,
    "k_10": 0.06,
    "k_12": 0.08,
    "k_21": 0.08,
    "k_e0": 0.06,
    "V_r": 0.05,
    "r_10": 0.08,
    "r_12": 0.08,
    "r_21": 0.08,
    "r_e0": 0.08,
    "c50_p": 0.06,
    "c50_r": 0.06,
    "pendiente": 0.05,
    "B_0": 0.01,
    "P_0": 0.01,
    "a_p": 0.06,
    "a_r": 0.06,
    "tau_pres": 0.1,
    "tau_bis": 0.1,
}


def _sleep(
    folder: Path,
    rng: Rng,
    slows: float = 0.0,
    is_swapped: bool = False,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> None:
    """The liver may clear less the less pressure there is: k_10 (1 - slows (1 - P/P_0)).

    What is said of the two pumps in the second recording may be swapped.
    """
    SLEEP.build(folder)
    names = (("Bomba_1", "Propofol"), ("Bomba_2", "Remi"))
    parts = "".join(programme(c, (n, "")) for c, n in names) + with_numbers("Cerdo", "cerdo_4")
    wires = "".join(f"  - {c}.{n} -> Cerdo.{n}\n" for c, n in names)
    scenario(folder, "Un cerdo bajo dos anestesicos", 10800.0, 5, 15, parts, wires)
    data_sheet(folder, SLEEP, SLEEP_KNOWN)
    v_p, k_10, k_12, k_21, k_e0, v_r, r_10, r_12, r_21, r_e0, c50_p, c50_r, steep, *more = drawn(
        rng, SLEEP, SLEEP_KNOWN
    )
    b_0, p_0, a_p, a_r, tau_p, tau_b = more

    def rates(t: float, x: Array, u: Array) -> list[float]:
        c_1, c_2, c_e, r_1, r_2, r_e, shown, pressure = (float(s) for s in x)
        clears = k_10 * (1.0 - slows * (1.0 - pressure / p_0))
        dose = abs(c_e / c50_p + r_e / c50_r + 1e-9)
        return [
            (float(u[0]) / v_p - (clears + k_12) * c_1 + k_21 * c_2) / 60.0,
            (k_12 * c_1 - k_21 * c_2) / 60.0,
            k_e0 * (c_1 - c_e) / 60.0,
            (float(u[1]) / v_r - (r_10 + r_12) * r_1 + r_21 * r_2) / 60.0,
            (r_12 * r_1 - r_21 * r_2) / 60.0,
            r_e0 * (r_1 - r_e) / 60.0,
            (b_0 / (1.0 + dose**steep) - shown) / tau_b,
            (p_0 * (1.0 - a_p * c_e / (c_e + 4.0) - a_r * r_e / (r_e + 10.0)) - pressure) / tau_p,
        ]

    for number, (name, stop) in enumerate((("first", 10800.0), ("second", 9000.0), ("third", 9900.0))):
        sleeps = drawn_steps(rng, stop, 500.0, 1.0, 13.0, 15.0)
        if name == "third":
            sleeps = stairs(rng, stop, 450.0, 1.5, 12.5, 4, 15.0)
        numbs = drawn_steps(rng, stop, 600.0, 2.0, 20.0, 15.0)
        sleeps, numbs = later(sleeps, 5.0), later(numbs, 5.0)
        t, x = integrated(rates, (*(0.0,) * 6, b_0, p_0), (sleeps, numbs), stop, 5.0)
        told = {"Bomba_1.Propofol": numbs, "Bomba_2.Remi": sleeps} if is_swapped and name == "second" else {}
        sensors = [
            Sensor("Cerdo.Indice", "BIS", "1", scaled(6, 1.0), 1.2, 15.0, noise_stated, 0.1, wild=wild),
            Sensor("Cerdo.Presion", "PAM", "1", scaled(7, 1.0), 0.8, 15.0, noise_stated, 0.1, wild=wild),
            Sensor("Cerdo.Plasma", "C plasma", "1", scaled(0, 1.0), 0.06, 30.0, noise_stated, 0.01, wild=wild),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"Bomba_1.Propofol": (sleeps, ""), "Bomba_2.Remi": (numbs, "")},
            loggers[number % len(loggers)],
            told=told,
        )
        write(folder / name, rng, made)


def sleep_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=-4.0), Logger("h", zero=9.0, empty=0.03), Logger("s", gap=(4200.0, 4620.0)))
    _sleep(folder, rng, wild=0.004, noise_stated=1.05, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.05 times too large, wild readings, no units, two rates, empty "
        "cells, a gap of 7 min, loggers of min, h and s",
        FINE,
    )


def sleep_slows(folder: Path, rng: Rng) -> Truth:
    slows = rng.uniform(1.0, 1.4)
    _sleep(folder, rng, slows=slows, loggers=(Logger("min"), Logger("s", zero=300.0)))
    return Truth(
        f"the liver clears less propofol the lower the pressure: k_10 (1 - {slows:.3f} (1 - P/P_0))", PHYSICS, CLEARING
    )


def sleep_swapped(folder: Path, rng: Rng) -> Truth:
    _sleep(folder, rng, is_swapped=True, loggers=(Logger("min", zero=3.0), Logger("s"), Logger("h")))
    return Truth(
        "the courses of the two pumps are swapped in what is said of the second recording: that of propofol is said of "
        "remifentanil, and the other way round",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- a drive (FMI 2, Model Exchange) and a conveyor's belt (FMI 2, Co-Simulation); s, ms, rpm, kg/s, m/s, N m, kg
MOTOR = OdeModel(
    "belt_drive",
    {
        "k_r": (0.3, "N*m*s/rad"),
        "tau_t": (0.06, "s"),
        "J": (0.06, "kg*m^2"),
        "b": (2e-3, "N*m*s/rad"),
        "gear": (20.0, ""),
        "w_begin": (120.0, "rad/s"),
    },
    {"command": "rad/s", "pull": "N*m"},
    {
        "T": ("N*m", "1.5", "(k_r*(command - w) - T)/tau_t"),
        "w": ("rad/s", "w_begin", "(T - b*w - pull/gear)/J"),
    },
    {"drum": ("rad/s", "w/gear"), "speed": ("rad/s", "w"), "torque": ("N*m", "T")},
)
BELT = OdeModel(
    "belt",
    {
        "r": (0.2, "m"),
        "k": (2.5e4, "N/m"),
        "c": (1500.0, "N*s/m"),
        "m_b": (180.0, "kg"),
        "f": (0.045, ""),
        "length": (20.0, "m"),
        "tau_s": (0.8, "s"),
        "v_begin": (1.2, "m/s"),
        "M_begin": (180.0, "kg"),
    },
    {"drum": "rad/s", "feed": "kg/s"},
    {
        "e": ("m", "6e-3", "r*drum - v"),
        "v": ("m/s", "v_begin", f"(k*e + c*(r*drum - v) - f*{FALL}*(m_b + M)*tanh(v/0.1))/(m_b + fabs(M))"),
        "M": ("kg", "M_begin", "feed - M*v/length"),
        "Y": ("kg", "M_begin", "(M - Y)/tau_s"),
    },
    {"pull": ("N*m", "r*(k*e + c*(r*drum - v))"), "travel": ("m/s", "v"), "load": ("kg", "Y")},
    2e-3,
)
MOTOR_KNOWN = {"k_r": 0.03, "tau_t": 0.1, "J": 0.04, "b": 0.1}
BELT_KNOWN = {"r": 5e-3, "k": 0.06, "c": 0.08, "m_b": 0.02, "f": 0.06, "length": 0.01, "tau_s": 0.08, "M_begin": 0.02}


def _belt(
    folder: Path,
    rng: Rng,
    drag: float = 0.0,
    clings: tuple[float, float] = (0.0, 1.0),
    fast: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Two FMUs; skirts may brake the belt with drag v^2 [N*s^2/m^2].

    A share of what is fed may cling to the belt, and fall off within a time constant: share, and that [s]. The clock
    of the second recording may be fast, by that share.
    """
    MOTOR.build(folder)
    BELT.build(folder)
    data_sheet(folder, MOTOR, MOTOR_KNOWN)
    (folder / "numbers.yaml").rename(folder / "drive.yaml")
    data_sheet(folder, BELT, BELT_KNOWN)
    parts = (
        programme("inverter", ("command", "rpm"))
        + programme("hopper", ("feed", "kg/s"))
        + with_numbers("drive", "belt_drive").replace("numbers.yaml", "drive.yaml")
        + with_numbers("belt", "belt", "internal")
    )
    parts = parts.replace("constant: 0 rpm", "constant: 1150 rpm").replace("constant: 0 kg/s", "constant: 11 kg/s")
    wires = "  - inverter.command -> drive.command\n  - hopper.feed -> belt.feed\n"
    wires += "  - drive.drum -> belt.drum\n  - belt.pull -> drive.pull\n"
    scenario(folder, "A belt conveyor", 90.0, 0.01, 0.1, parts, wires)
    k_r, tau_t, inertia, b, gear, w_begin = drawn(rng, MOTOR, MOTOR_KNOWN)
    r, k, c, m_b, f, length, tau_s, v_begin, m_begin = drawn(rng, BELT, BELT_KNOWN)
    share, falls = clings

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """The stretch is in mm; the last is what clings [kg]."""
        torque, w, milli, v, load, shown, stuck = (float(s) for s in x)
        drum = w / gear
        tension = 1e-3 * k * milli + c * (r * drum - v)
        carried = m_b + load + stuck
        return [
            (k_r * (float(u[0]) / RPM - w) - torque) / tau_t,
            (torque - b * w - r * tension / gear) / inertia,
            1e3 * (r * drum - v),
            (tension - f * FALL * carried * np.tanh(v / 0.1) - drag * v * abs(v)) / carried,
            (1.0 - share) * float(u[1]) - load * v / length,
            (load + stuck - shown) / tau_s,
            share * float(u[1]) - stuck / falls,
        ]

    for number, (name, stop) in enumerate((("first", 90.0), ("second", 70.0), ("third", 80.0))):
        command = drawn_steps(rng, stop, 3.5, 800.0, 1700.0, 0.1)
        if name == "third":
            command = stairs(rng, stop, 3.0, 850.0, 1650.0, 5, 0.1)
        feed = drawn_steps(rng, stop, 6.0, 4.0, 20.0, 0.1)
        command, feed = later(command, 0.05), later(feed, 0.05)
        start = (1.5, w_begin, 6.0, v_begin, m_begin, m_begin, 0.0)
        t, x = integrated(rates, start, (command, feed), stop, 0.01)
        logger = loggers[number % len(loggers)]
        if fast and name == "second":
            logger = Logger(logger.unit, logger.zero, 1.0 + fast, logger.jitter)
        sensors = [
            Sensor("drive.speed", "n rpm", "rpm", scaled(1, RPM), 2.5, 0.1, noise_stated, 0.5),
            Sensor("drive.torque", "M Nm", "N*m", scaled(0, 1.0), 0.03, 0.1, noise_stated, 0.01),
            Sensor("belt.travel", "v Band", "m/s", scaled(3, 1.0), 5e-3, 0.1, noise_stated, 1e-3),
            Sensor("belt.load", "Waage kg", "kg", scaled(5, 1.0), 2.0, 0.2, noise_stated, 0.5),
        ]
        programmes = {"inverter.command": (command, "rpm"), "hopper.feed": (feed, "kg/s")}
        write(folder / name, rng, Written(t, x, sensors, programmes, logger, recorded=["hopper.feed"]))


def belt_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=12.0), Logger("ms", zero=-300.0, empty=0.02), Logger("s", gap=(31.0, 33.5)))
    _belt(folder, rng, noise_stated=0.95, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.05 times too small, two rates, a column of an input, empty "
        "cells, a gap of 2.5 s, loggers of s and ms, two FMUs",
        FINE,
    )


def belt_drags(folder: Path, rng: Rng) -> Truth:
    drag = rng.uniform(35.0, 55.0)
    _belt(folder, rng, drag=drag, loggers=(PLAIN, Logger("ms", zero=10.0)))
    return Truth(f"skirts brake the belt with {drag:.2f} N (v/(1 m/s))^2 more", PHYSICS, DRAGGED)


def belt_two(folder: Path, rng: Rng) -> Truth:
    drag, share, falls = rng.uniform(35.0, 55.0), rng.uniform(0.12, 0.2), rng.uniform(30.0, 50.0)
    _belt(folder, rng, drag=drag, clings=(share, falls), loggers=(Logger("ms"), Logger("s", zero=4.0)))
    return Truth(
        f"skirts brake the belt with {drag:.2f} N (v/(1 m/s))^2 more; and {share:.3f} of what is fed clings to the "
        f"belt and falls off with a time constant of {falls:.1f} s only",
        PHYSICS,
        (*DRAGGED, *CLINGING),
    )


def belt_clock(folder: Path, rng: Rng) -> Truth:
    fast = rng.uniform(4e-3, 7e-3)
    _belt(folder, rng, fast=fast, loggers=(Logger("s", zero=2.0), PLAIN, Logger("ms")))
    return Truth(f"the clock of the second recording is fast by {100.0 * fast:.3f} %", (*RECORDING, *SENSOR))


# --- an ozoniser of water, FMI 2 Co-Simulation that hides its states; min, s, W, L/min, 1/m, g/m^3
OZONE = OdeModel(
    "ozoniser",
    {
        "Y_g": (8e-9, "kg/J"),
        "Q_g": (4e-4, "m^3/s"),
        "V_g": (0.06, "m^3"),
        "V": (0.4, "m^3"),
        "kla": (0.01, "1/s"),
        "H": (0.3, ""),
        "k_d": (8e-4, "1/s"),
        "k_s": (2e-4, "m/s"),
        "k_u": (1.2, "m^3/(kg*s)"),
        "tau_m": (45.0, "s"),
        "s_begin": (5.0, "1/m"),
    },
    {"power": "W", "water": "m^3/s", "raw": "1/m"},
    {
        "g": ("kg/m^3", "0.0", "(Y_g*power - Q_g*g - kla*V*(H*g - c_1))/V_g"),
        "c_1": ("kg/m^3", "0.0", "-water/V*c_1 + kla*(H*g - c_1) - k_d*c_1 - k_s*s_1*c_1"),
        "c_2": ("kg/m^3", "0.0", "water/V*(c_1 - c_2) - k_d*c_2 - k_s*s_2*c_2"),
        "s_1": ("1/m", "s_begin", "water/V*(raw - s_1) - k_u*c_1*s_1"),
        "s_2": ("1/m", "s_begin", "water/V*(s_1 - s_2) - k_u*c_2*s_2"),
        "m": ("kg/m^3", "0.0", "(c_2 - m)/tau_m"),
    },
    {"offgas": ("kg/m^3", "g"), "contact": ("kg/m^3", "c_1"), "residual": ("kg/m^3", "m"), "uv": ("1/m", "s_2")},
    1.0,
)
OZONE_KNOWN = {
    "Y_g": 0.03,
    "Q_g": 0.02,
    "V_g": 0.06,
    "V": 0.02,
    "kla": 0.06,
    "H": 0.04,
    "k_d": 0.08,
    "k_s": 0.08,
    "k_u": 0.06,
    "tau_m": 0.08,
    "s_begin": 0.03,
}


def _ozone(
    folder: Path,
    rng: Rng,
    second: float = 0.0,
    warms: tuple[float, float] = (0.0, 1.0),
    is_imperial: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Ozone may decay with itself: second c^2 more, in m^3/(g*s).

    Electrodes may yield less when they are warm: warms[0] of it per kW, after a time constant [s]. The flow of water of
    the second recording may be said with gallons that are too large.
    """
    OZONE.build(folder)
    names = (("generator", "power", "W"), ("main", "water", "L/min"), ("source", "raw", "1/m"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("plant", "ozoniser", "internal")
    wires = "".join(f"  - {c}.{n} -> plant.{n}\n" for c, n, _ in names)
    scenario(folder, "An ozoniser of water", 18000.0, 5, 20, parts, wires)
    data_sheet(folder, OZONE, OZONE_KNOWN)
    y_g, q_g, v_g, v, kla, h, k_d, k_s, k_u, tau_m, s_begin = drawn(rng, OZONE, OZONE_KNOWN)
    lost, slowly = warms

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Ozone is in g/m^3; the last is the power that the electrodes have felt [kW]."""
        gas, c_1, c_2, s_1, s_2, shown, felt = (float(s) for s in x)
        power, water = float(u[0]), float(u[1]) / 6e4
        passes = kla * (h * gas - c_1)
        return [
            (1e3 * y_g * (1.0 - lost * felt) * power - q_g * gas - v * passes) / v_g,
            -water / v * c_1 + passes - k_d * c_1 - k_s * s_1 * c_1 - second * c_1**2,
            water / v * (c_1 - c_2) - k_d * c_2 - k_s * s_2 * c_2 - second * c_2**2,
            water / v * (float(u[2]) - s_1) - 1e-3 * k_u * c_1 * s_1,
            water / v * (s_1 - s_2) - 1e-3 * k_u * c_2 * s_2,
            (c_2 - shown) / tau_m,
            (1e-3 * power - felt) / slowly,
        ]

    for number, (name, stop) in enumerate((("first", 18000.0), ("second", 14400.0), ("third", 16200.0))):
        power = drawn_steps(rng, stop, 700.0, 150.0, 950.0, 20.0)
        if name == "third":
            power = bursts(rng, stop, 500.0, 800.0, 250.0, 900.0, 20.0)
        water = drawn_steps(rng, stop, 1100.0, 28.0, 60.0, 20.0)
        power, water = later(power, 5.0), later(water, 5.0)
        raw = ramped(rng, stop, 3600.0, 6.0, 10.0, 120.0)
        t, x = integrated(rates, (0.0, 0.0, 0.0, s_begin, s_begin, 0.0, 0.0), (power, water, raw), stop, 5.0)
        told = {}
        if is_imperial and name == "second":
            told = {"main.water": Steps(water.times, tuple(float(f"{w * GALLONS:.4g}") for w in water.levels))}
        sensors = [
            Sensor("plant.offgas", "O3 Abgas", "g/m^3", scaled(0, 1.0), 0.06, 20.0, noise_stated, 0.01),
            Sensor("plant.contact", "O3 Kammer 1", "g/m^3", scaled(1, 1.0), 0.02, 20.0, noise_stated, 5e-3),
            Sensor("plant.residual", "O3 Rest", "g/m^3", scaled(5, 1.0), 0.015, 20.0, noise_stated, 5e-3),
            Sensor("plant.uv", "SAK 254", "1/m", scaled(4, 1.0), 0.03, 40.0, noise_stated, 0.01),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"generator.power": (power, "W"), "main.water": (water, "L/min"), "source.raw": (raw, "1/m")},
            loggers[number % len(loggers)],
            recorded=["source.raw"],
            told=told,
        )
        write(folder / name, rng, made)


def ozone_decays(folder: Path, rng: Rng) -> Truth:
    second = rng.uniform(5e-4, 8e-4)
    _ozone(folder, rng, second=second, noise_stated=None, loggers=(Logger("min"), Logger("s", zero=90.0)))
    return Truth(
        f"ozone decays with itself as well: {1e4 * second:.3f}e-4 m^3/(g s) c^2 in both chambers; noise is not stated",
        PHYSICS,
        DECAYING,
    )


def ozone_two(folder: Path, rng: Rng) -> Truth:
    second, lost, slowly = rng.uniform(5e-4, 8e-4), rng.uniform(0.3, 0.45), rng.uniform(900.0, 1500.0)
    _ozone(folder, rng, second=second, warms=(lost, slowly), loggers=(PLAIN, Logger("min", zero=8.0, jitter=0.1)))
    return Truth(
        f"ozone decays with itself as well: {1e4 * second:.3f}e-4 m^3/(g s) c^2 in both chambers; and electrodes yield "
        f"{lost:.3f} less for each kW that has warmed them, time constant {slowly:.0f} s",
        PHYSICS,
        (*DECAYING, *WARMING),
    )


def ozone_gallons(folder: Path, rng: Rng) -> Truth:
    _ozone(folder, rng, is_imperial=True, loggers=(Logger("s", zero=-60.0), PLAIN, Logger("min")))
    return Truth(
        "the meter of water counted US gallons in the second recording, and what is said was converted as imperial "
        f"ones: {GALLONS:.4f} times too much",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- a bead in optical tweezers, in glycerol and water, FMI 2 Model Exchange; s, ms, mW, um, um/s, mV
BEAD = OdeModel(
    "tweezers",
    {
        "kappa": (2e-4, "N/(m*W)"),
        "gamma": (9.4e-7, "N*s/m"),
        "tau_l": (0.05, "s"),
        "tau_b": (0.03, "s"),
        "tau_f": (0.12, "s"),
        "s_q": (4e5, "V/m"),
        "tau_q": (0.02, "s"),
        "P_begin": (0.1, "W"),
    },
    {"laser": "W", "trap": "m", "flow": "m/s"},
    {
        "P": ("W", "P_begin", "(laser - P)/tau_l"),
        "b": ("m", "0.0", "(trap - b)/tau_b"),
        "v": ("m/s", "0.0", "(flow - v)/tau_f"),
        "x": ("m", "0.0", "v - kappa*P*(x - b)/gamma"),
        "q": ("V", "0.0", "(s_q*(x - b) - q)/tau_q"),
    },
    {"bead": ("m", "x"), "diode": ("V", "q"), "monitor": ("W", "P")},
    1e-3,
)
BEAD_KNOWN = {
    "kappa": 0.06,
    "gamma": 0.05,
    "tau_l": 0.08,
    "tau_b": 0.08,
    "tau_f": 0.08,
    "s_q": 0.03,
    "tau_q": 0.08,
    "P_begin": 0.02,
}


def _bead(
    folder: Path,
    rng: Rng,
    heats: tuple[float, float] = (0.0, 1.0),
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    has_idle: bool = False,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Light may heat the liquid: heats[0] P [K/W], time constant heats[1] [s]; its drag falls by exp(-0.05/K).

    What is said of the flow in the second recording may be that of another run.
    """
    BEAD.build(folder)
    names = (("diode_laser", "laser", "mW"), ("deflector", "trap", "um"), ("pump", "flow", "um/s"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names).replace("constant: 0 mW", "constant: 100 mW")
    parts += with_numbers("cell", "tweezers")
    wires = "".join(f"  - {c}.{n} -> cell.{n}\n" for c, n, _ in names)
    scenario(folder, "A bead in optical tweezers", 36.0, 0.005, 0.03, parts, wires)
    data_sheet(folder, BEAD, BEAD_KNOWN)
    kappa, gamma, tau_l, tau_b, tau_f, s_q, tau_q, p_begin = drawn(rng, BEAD, BEAD_KNOWN)
    warms, slowly = heats

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Lengths are in um, signals in mV; the last is how much warmer the liquid is [K]."""
        power, b, v, at, shown, warm = (float(s) for s in x)
        return [
            (1e-3 * float(u[0]) - power) / tau_l,
            (float(u[1]) - b) / tau_b,
            (float(u[2]) - v) / tau_f,
            v - kappa * power * (at - b) / (gamma * np.exp(-0.05 * warm)),
            (1e-3 * s_q * (at - b) - shown) / tau_q,
            (warms * power - warm) / slowly,
        ]

    for number, (name, stop) in enumerate((("first", 36.0), ("second", 28.0), ("third", 32.0))):
        laser = drawn_steps(rng, stop, 1.8, 50.0, 190.0, 0.03)
        trap = drawn_steps(rng, stop, 0.9, -1.2, 1.2, 0.03)
        flow = drawn_steps(rng, stop, 1.1, -14.0, 14.0, 0.03)
        other = later(drawn_steps(rng, stop, 1.1, -14.0, 14.0, 0.03), 0.01)
        if name == "third":
            flow = telegraph(rng, stop, 1.0, -11.0, 11.0, 0.03)
        laser, trap, flow = later(laser, 0.01), later(trap, 0.01), later(flow, 0.01)
        t, x = integrated(rates, (p_begin, 0.0, 0.0, 0.0, 0.0, warms * p_begin), (laser, trap, flow), stop, 5e-3)
        sensors = [
            Sensor("cell.bead", "x Kamera um", "um", scaled(3, 1.0), 0.02, 0.03, noise_stated, 5e-3),
            Sensor("cell.diode", "QPD mV", "mV", scaled(4, 1.0), 8.0, 0.03, noise_stated, 1.0),
            Sensor("cell.monitor", "P mW", "mW", scaled(0, 1e3), 1.0, 0.06, noise_stated, 0.2),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"diode_laser.laser": (laser, "mW"), "deflector.trap": (trap, "um"), "pump.flow": (flow, "um/s")},
            loggers[number % len(loggers)],
            recorded=["deflector.trap"],
            told={"pump.flow": other} if is_other and name == "second" else {},
        )
        write(folder / name, rng, made)
        if has_idle:
            idle_column(folder / name, "T Labor", lambda n: np.asarray(21.4 + 0.1 * (np.arange(n) % 4)))


def bead_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=100.0), Logger("s", zero=3.0, jitter=0.1), Logger("s", gap=(12.0, 13.0), empty=0.02))
    _bead(folder, rng, has_idle=True, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated rightly, two rates, a column of an input, a column that nobody "
        "uses, jitter, empty cells, a gap of 1 s, loggers of s and ms",
        FINE,
    )


def bead_heats(folder: Path, rng: Rng) -> Truth:
    warms, slowly = rng.uniform(55.0, 80.0), rng.uniform(1.5, 2.5)
    _bead(folder, rng, heats=(warms, slowly), loggers=(PLAIN, Logger("ms")))
    return Truth(
        f"light heats the liquid by {warms:.2f} K/W, time constant {slowly:.3f} s, and its drag on the bead falls by "
        "exp(-0.05/K)",
        PHYSICS,
        THINNED,
    )


def bead_other_run(folder: Path, rng: Rng) -> Truth:
    _bead(folder, rng, is_other=True, loggers=(Logger("s", zero=-2.0), Logger("ms", zero=40.0), PLAIN))
    return Truth(
        "what is said of the flow in the second recording is that of another run",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- a comb of coils at one supply: two, one behind a ballast, two; the tool's own units
COMB = {
    "reference_resistance": (1.9, "ohm", 0.02, 0.02),
    "heat_transfer_coefficient": (80.0, "W/(m^2*K)", 0.05, 0.02),
    "area": (135.0, "mm^2", 0.0, 0.0),
    "volume": (10.5, "mm^3", 0.0, 0.0),
    "density": (6450.0, "kg/m^3", 0.0, 0.0),
    "specific_heat": (740.0, "J/(kg*K)", 0.05, 0.02),
}
#: Coils in series, resistances of wires, ballasts, and the supply [ohm].
COMB_STRINGS, COMB_WIRES, COMB_BALLAST, COMB_INNER = (2, 1, 2), 0.18, (0.0, 0.6, 0.9), 0.3
#: Limit of the supply [A], rise of resistance [1/K], temperature that the numbers are for [degC].
COMB_LIMIT, COMB_RISE, COMB_COLD = 2.4, 7e-4, 20.0


def _comb_files(folder: Path) -> None:
    """Scenario and parameter set of the five coils."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = ["title: Coils of a comb", "parameters:"]
    for name, (value, unit, uncertainty, scatter) in COMB.items():
        known = f"uncertainty: {uncertainty:g}, scatter: {scatter:g}"
        lines.append(f'  {name}: {{value: {value:g}, unit: {unit}, source: "own measurement", {known}}}')
    lines += [
        '  use_regressed_cooling_rate: {value: false, source: "cools as it heats"}',
        f'  initial_temperature: {{value: {COMB_COLD:g}, unit: degC, source: "room"}}',
        f'  reference_temperature: {{value: {COMB_COLD:g}, unit: degC, source: "room"}}',
        f'  resistance_temperature_coefficient: {{value: {COMB_RISE:g}, unit: 1/K, source: "own measurement"}}',
    ]
    (folder / "numbers.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    elements = [f"{{kind: current_limit, supply: 1, limit: {COMB_LIMIT} A, share: 1}}"]
    elements += [
        f"{{kind: contact, string: {s}, resistance: {ohm} ohm}}" for s, ohm in enumerate(COMB_BALLAST, start=1) if ohm
    ]
    parts = (
        programme("bench", ("voltage", "V"))
        + programme("room", ("temperature", "degC")).replace("constant: 0 degC", f"constant: {COMB_COLD:g} degC")
        + f"  circuit:\n    kind: ngspice\n    strings: [{', '.join(str(n) for n in COMB_STRINGS)}]\n"
        f"    supply: common\n    supply_resistance: {COMB_INNER} ohm\n    string_resistance: {COMB_WIRES} ohm\n"
        "    elements:\n"
        + "".join(f"      - {e}\n" for e in elements)
        + f"    start: {{resistance: {COMB['reference_resistance'][0]} ohm}}\n"
        "  coils: {kind: actuator, fmu: thermal_stiffness, electrical: circuit, ambient: room, "
        "parameter_set: numbers.yaml}\n"
    )
    scenario(folder, "A comb of coils", 120.0, 0.05, 0.1, parts, "  - bench.voltage -> circuit.supply_voltage\n")


def _comb_off(rng: Rng, name: str) -> Array:
    """A number of each coil as it is."""
    value, _, uncertainty, scatter = COMB[name]
    return np.asarray(value * np.exp(uncertainty * rng.normal() + scatter * rng.normal(size=sum(COMB_STRINGS))))


def _comb_course(
    numbers: Sequence[Array], volts: Steps, room: Steps, start: float, stop: float, step: float, passes: float
) -> tuple[Array, Array]:
    """Times [s], and temperatures of the coils [degC], currents of the strings [A], voltage of the terminals [V].

    Heat by the exponential of equation (3) over a step, with the currents of its middle.

    Args:
        numbers: Resistances [ohm], conductances [W/K], capacities [J/K] of the coils.
        volts: Of the supply.
        room: Its temperature [degC].
        start: Temperature of the coils at 0 [degC].
        stop: End [s].
        step: Of time [s].
        passes: Between the second and the third coil [W/K].
    """
    cold, loses, holds = numbers
    times: Array = step * np.arange(round(stop / step) + 1, dtype=np.float64)
    emf, around = volts.at(times), room.at(times)
    string = np.repeat(np.arange(len(COMB_STRINGS)), COMB_STRINGS)

    def currents(hot: Array, v: float) -> tuple[Array, float]:
        ohms = np.bincount(string, hot) + COMB_WIRES + np.asarray(COMB_BALLAST)
        together = float(np.sum(1.0 / ohms))
        terminal = min(v / (COMB_INNER + 1.0 / together), COMB_LIMIT) / together
        return np.asarray(terminal / ohms), terminal

    def relaxed(warm: Array, at: Array, v: float, outside: float, span: float) -> Array:
        hot = cold * (1.0 + COMB_RISE * (at - COMB_COLD))
        given = currents(hot, v)[0][string] ** 2 * hot
        over = passes * (at[1] - at[2])
        given[1] -= over
        given[2] += over
        end = outside + given / loses
        return np.asarray(end + (warm - end) * np.exp(-loses * span / holds))

    warm = np.full(len(string), start)
    found = np.empty((len(times), len(string) + len(COMB_STRINGS) + 1))
    for i, (v, outside) in enumerate(zip(emf, around)):
        amps, terminal = currents(cold * (1.0 + COMB_RISE * (warm - COMB_COLD)), float(v))
        found[i] = (*warm, *amps, terminal)
        middle = relaxed(warm, warm, float(v), float(outside), step / 2)
        warm = relaxed(warm, middle, float(v), float(outside), step)
    return times, found


def _comb(
    folder: Path,
    rng: Rng,
    passes: float = 0.0,
    shunt: float = 1.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The second and the third coil may touch: what passes between them [W/K].

    The first ammeter may show more or less in the second recording, by a factor.
    """
    _comb_files(folder)
    conductance = 1e-6 * _comb_off(rng, "area") * _comb_off(rng, "heat_transfer_coefficient")
    capacity = 1e-9 * _comb_off(rng, "density") * _comb_off(rng, "volume") * _comb_off(rng, "specific_heat")
    numbers = (_comb_off(rng, "reference_resistance"), conductance, capacity)

    for number, (name, stop) in enumerate((("first", 120.0), ("second", 95.0), ("third", 105.0))):
        volts = drawn_steps(rng, stop, 6.5, 0.0, 4.4, 0.1)
        if name == "third":
            volts = wandering(rng, stop, 4.5, 0.2, 4.2, 0.1)
        volts = later(volts, 0.05)
        room = ramped(rng, stop, 35.0, 18.5, 23.0, 0.5)
        said = room.levels[0]
        t, x = _comb_course(numbers, volts, room, said + 0.2 * float(rng.normal()), stop, 0.0125, passes)
        factor = shunt if name == "second" else 1.0
        sensors = [
            Sensor(
                f"string[{s}].current",
                f"I{s} mA",
                "mA",
                scaled(4 + s, 1e3 * (factor if s == 1 else 1.0)),
                1.5,
                0.1,
                noise_stated,
                0.5,
            )
            for s in (1, 2, 3)
        ]
        sensors += [Sensor("supply.voltage", "U mV", "mV", scaled(8, 1e3), 6.0, 0.1, noise_stated, 2.0)]
        sensors += [
            Sensor(f"coil[{c}].temperature", f"T{c}", "degC", scaled(c - 1, 1.0), 0.25, 0.2, noise_stated, 0.1)
            for c in (1, 2, 3, 5)
        ]
        made = Written(
            t,
            x,
            sensors,
            {"bench.voltage": (volts, "V"), "room.temperature": (room, "degC")},
            loggers[number % len(loggers)],
            recorded=["room.temperature"],
            sidecar={"components": {"coils": {"parameters": {"initial_temperature": f"{said:g} degC"}}}},
        )
        write(folder / name, rng, made)


def comb_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=-6.0), Logger("ms", zero=200.0, empty=0.02), Logger("s", gap=(48.0, 51.0)))
    _comb(folder, rng, noise_stated=1.05, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, coil by coil too, start off by 0.2 K (deviation), noise stated 1.05 times too "
        "large, two rates, a column of an input, empty cells, a gap of 3 s, loggers of s and ms",
        FINE,
    )


def comb_touches(folder: Path, rng: Rng) -> Truth:
    passes = rng.uniform(4e-3, 6e-3)
    _comb(folder, rng, passes=passes, loggers=(Logger("ms", zero=15.0), PLAIN))
    return Truth(
        f"the second and the third coil touch, and {1e3 * passes:.3f} mW/K pass from the warmer to the colder",
        PHYSICS,
        EXCHANGED,
    )


def comb_shunt(folder: Path, rng: Rng) -> Truth:
    shunt = rng.uniform(1.07, 1.11)
    _comb(folder, rng, shunt=shunt, loggers=(PLAIN, Logger("s", zero=9.0), Logger("ms")))
    return Truth(
        f"the ammeter of the first string has another shunt in the second recording, and shows {shunt:.4f} times the "
        "current",
        (*RECORDING, *SENSOR),
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    canal_jams,
    bead_null,
    ozone_decays,
    muscle_knocked,
    comb_touches,
    belt_null,
    sleep_slows,
    ferry_reversed,
    belt_two,
    muscle_null,
    canal_seeps,
    bead_other_run,
    comb_null,
    ozone_gallons,
    ferry_keels,
    sleep_null,
    belt_clock,
    muscle_tires,
    canal_null,
    comb_shunt,
    bead_heats,
    sleep_swapped,
    ozone_two,
    ferry_null,
    belt_drags,
)
