"""Twenty-seventh set: an axon, a wheelset, a smelting pot, a tunnel, espresso, a column, a diesel, a fork of coils.

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
from typing import Any

import numpy as np

from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.strangers.eighth_set import idle_column
from evaluation.strangers.eleventh_set import RPM, telegraph
from evaluation.strangers.fifteenth_set import ramped
from evaluation.strangers.fifth_set import integrated
from evaluation.strangers.first_set import PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import between, bursts, data_sheet, scaled
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Steps, Written, celsius, drawn_steps, write
from evaluation.strangers.sixteenth_set import later
from evaluation.strangers.tenth_set import stairs
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.thirteenth_set import wandering
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth

#: Alumina that a coulomb takes [kg/C], density [kg/m^3] and heat [J/(kg*K)] of water, gas constant of air [J/(kg*K)].
ALUMINA, WATER, HEAT, AIR = 1.7614e-7, 1000.0, 4180.0, 287.0
#: Density of diesel fuel [kg/L].
FUEL = 0.835
#: Laws that are true where something is stored of which the model knows nothing.
STORED = ("hidden_state", "hidden_mass", "hidden_capacity", "second_mass", "hidden_storage", "memory", "relaxation")
#: Laws that are true where something begins at a value.
BEGINNING = ("threshold", "dead_zone", "dead_band", "onset")
#: Laws that are true where a number depends on a state.
RATED = ("nonlinear_rate", "rate_of_state", "state_dependent_rate", "parameter_of_state", "interaction")
#: Laws that are true where channels close slowly once they were open.
CLOSING = (*STORED, *RATED, "inactivation", "adaptation", "fatigue", "desensitisation", "hysteresis")
#: Laws that are true where a flange meets a rail.
TOUCHING = (*BEGINNING, "hard_stop", "stop", "end_stop", "contact", "impact", "nonlinear_stiffness", "stiffening")
#: Laws that are true where what was given lies at the bottom for a while.
SETTLING = (*STORED, *RATED, "delay", "lag", "dead_time", "slow_input", "sedimentation")
#: Laws that are true where less of a current counts with heat.
WASTING = (*RATED, "gain_of_state", "state_dependent_gain", "gain_of_input", "side_reaction", "leakage")
#: Laws that are true where wind stands on one end, for a while.
BLOWN = (
    "draught",
    "wind",
    "disturbance",
    "unknown_force",
    "constant_force",
    "force",
    "gust",
    "head_wind",
    "unknown_input",
    "bias_of_rate",
)
#: Laws that are true where something is pressed together.
PRESSED = (
    *RATED,
    "compaction",
    "nonlinear_conductance",
    "nonlinear_resistance",
    "conductance_of_state",
    "resistance_of_state",
    "quadratic_loss",
    "turbulent_flow",
    "saturation",
    "nonlinear_loss",
)
#: Laws that are true where a film is thinner the faster it is passed.
FILMED = (
    *RATED,
    "boundary_layer",
    "film_transfer",
    "forced_convection",
    "rate_of_flow",
    "mass_transfer",
    "rate_of_input",
)
#: Laws that are true where a valve opens above a pressure.
OPENING = (*BEGINNING, *RATED, "leakage", "leak", "nonlinear_leakage", "relief_valve", "bypass", "saturation")
#: Laws that are true where walls take heat for a while.
WALLED = (*STORED, "heat_loss", "wall_capacity", "hidden_heat_capacity", "nonlinear_loss", *RATED)
#: Laws that are true where a joint grows warm, and its resistance with it.
JOINED = (
    *STORED,
    *RATED,
    "lead",
    "contact",
    "source_resistance",
    "resistance_of_state",
    "self_heating",
    "nonlinear_resistance",
)

Rates = Callable[[float, Array, Array], list[float]]


# --- a squid's axon under voltage clamp (Hodgkin, Huxley 1952), FMI 2 Model Exchange, without units; ms, mV, uA/cm^2
_A_M = "(fabs(V + 40.0) < 1e-7 ? 1.0 : 0.1*(V + 40.0)/(1.0 - exp(-(V + 40.0)/10.0)))"
_A_N = "(fabs(V + 55.0) < 1e-7 ? 0.1 : 0.01*(V + 55.0)/(1.0 - exp(-(V + 55.0)/10.0)))"
_QUICK = "1000.0*pow(q10, 0.1*(Bain - 6.3))"
AXON = OdeModel(
    "axone_7b",
    {
        "g_Na": (120.0, ""),
        "g_K": (36.0, ""),
        "g_fuite": (0.3, ""),
        "E_Na": (50.0, ""),
        "E_K": (-77.0, ""),
        "E_fuite": (-54.4, ""),
        "C_m": (1.0, ""),
        "R_serie": (0.012, ""),
        "q10": (3.0, ""),
        "tau_filtre": (0.15, ""),
        "V_0": (-65.0, ""),
        "m_0": (0.0529, ""),
        "h_0": (0.596, ""),
        "n_0": (0.3177, ""),
    },
    {"Consigne": "", "Bain": ""},
    {
        "V": (
            "",
            "V_0",
            "1000.0*((Consigne - V)/R_serie - g_Na*m*m*m*h*(V - E_Na) - g_K*n*n*n*n*(V - E_K)"
            " - g_fuite*(V - E_fuite))/C_m",
        ),
        "m": ("", "m_0", f"{_QUICK}*({_A_M}*(1.0 - m) - 4.0*exp(-(V + 65.0)/18.0)*m)"),
        "h": (
            "",
            "h_0",
            f"{_QUICK}*(0.07*exp(-(V + 65.0)/20.0)*(1.0 - h) - h/(1.0 + exp(-(V + 35.0)/10.0)))",
        ),
        "n": ("", "n_0", f"{_QUICK}*({_A_N}*(1.0 - n) - 0.125*exp(-(V + 65.0)/80.0)*n)"),
        "F": ("", "0.0", "1000.0*((Consigne - V)/R_serie - F)/tau_filtre"),
    },
    {"Courant": ("", "F"), "Membrane": ("", "V")},
    1e-5,
)
AXON_KNOWN = {
    "g_Na": 0.06,
    "g_K": 0.06,
    "g_fuite": 0.1,
    "E_Na": 0.02,
    "E_K": 0.01,
    "C_m": 0.04,
    "R_serie": 0.06,
    "q10": 0.02,
    "tau_filtre": 0.04,
}


def _axon(
    folder: Path,
    rng: Rng,
    slow: tuple[float, float] | None = None,
    hum: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """Channels of sodium may close slowly as well: time constant [s], and the share that can close.

    The amplifier of the second recording may pick up the mains, of an amplitude `hum` [uA/cm^2].
    """
    AXON.build(folder)
    names = (("Ampli", "Consigne"), ("Cuve", "Bain"))
    parts = "".join(programme(c, (n, "")) for c, n in names) + with_numbers("Axone", "axone_7b")
    wires = "".join(f"  - {c}.{n} -> Axone.{n}\n" for c, n in names)
    scenario(folder, "Axone sous tension imposee", 0.4, 5e-5, 2e-4, parts, wires)
    data_sheet(folder, AXON, AXON_KNOWN)
    g_na, g_k, g_l, e_na, e_k, e_l, c_m, r_s, q10, tau_f, *begins = drawn(rng, AXON, AXON_KNOWN)
    v_0, m_0, h_0, n_0 = begins
    tau_s, share = slow if slow is not None else (1.0, 0.0)

    def open_slowly(v: float) -> float:
        """Share of the channels that stay open at last."""
        return 1.0 - share / (1.0 + float(np.exp(-(v + 50.0) / 7.0)))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        v, m, h, n, shown, slowly = (float(s) for s in x)
        a_m = 1.0 if abs(v + 40.0) < 1e-7 else 0.1 * (v + 40.0) / (1.0 - np.exp(-(v + 40.0) / 10.0))
        a_n = 0.1 if abs(v + 55.0) < 1e-7 else 0.01 * (v + 55.0) / (1.0 - np.exp(-(v + 55.0) / 10.0))
        quick = 1e3 * q10 ** (0.1 * (float(u[1]) - 6.3))
        given = (float(u[0]) - v) / r_s
        through = g_na * slowly / open_slowly(-65.0) * m**3 * h * (v - e_na) + g_k * n**4 * (v - e_k)
        return [
            1e3 * (given - through - g_l * (v - e_l)) / c_m,
            quick * (a_m * (1.0 - m) - 4.0 * np.exp(-(v + 65.0) / 18.0) * m),
            quick * (0.07 * np.exp(-(v + 65.0) / 20.0) * (1.0 - h) - h / (1.0 + np.exp(-(v + 35.0) / 10.0))),
            quick * (a_n * (1.0 - n) - 0.125 * np.exp(-(v + 65.0) / 80.0) * n),
            1e3 * (given - shown) / tau_f,
            (open_slowly(v) - slowly) / tau_s,
        ]

    for number, (name, stop) in enumerate((("first", 0.4), ("second", 0.32), ("third", 0.36))):
        command = drawn_steps(rng, stop, 9e-3, -95.0, 25.0, 2e-4)
        if name == "third":
            command = telegraph(rng, stop, 7e-3, -85.0, 5.0, 2e-4)
        command = later(command, 1e-4)
        command = Steps(tuple(round(t, 7) for t in command.times), (-65.0, *command.levels[1:]))
        bath = ramped(rng, stop, 0.08, 5.5, 8.5, 4e-3)
        start = (v_0, m_0, h_0, n_0, 0.0, open_slowly(-65.0))
        t, x = integrated(rates, start, (command, bath), stop, 1e-4)

        def spoil(column: str, t: Array, v: Array, wave: float = hum if name == "second" else 0.0) -> Array:
            return v + wave * np.sin(2.0 * np.pi * 50.0 * t + 0.7) if column == "I" else v

        sensors = [
            Sensor("Axone.Courant", "I", "1", scaled(4, 1.0), 5.0, 2e-4, noise_stated, 0.5),
            Sensor("Axone.Membrane", "V electrode 2", "1", scaled(0, 1.0), 0.3, 2e-4, noise_stated, 0.05),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"Ampli.Consigne": (command, ""), "Cuve.Bain": (bath, "")},
            loggers[number % len(loggers)],
            recorded=["Cuve.Bain"],
            spoil=spoil,
        )
        write(folder / name, rng, made)


def axon_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=1200.0, is_comma=True), Logger("ms", is_comma=True), Logger("s", is_comma=True))
    _axon(folder, rng, noise_stated=1.05, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.05 times too large, no units, a column of an input, decimal "
        "commas, loggers of ms and s",
        FINE,
    )


def axon_closes(folder: Path, rng: Rng) -> Truth:
    tau, share = rng.uniform(0.04, 0.07), rng.uniform(0.4, 0.6)
    _axon(folder, rng, slow=(tau, share), loggers=(Logger("ms"), Logger("s", zero=2.0)))
    return Truth(
        f"up to {share:.3f} of the channels of sodium close slowly as well at voltages above -50 mV, time constant "
        f"{1e3 * tau:.1f} ms",
        PHYSICS,
        CLOSING,
    )


def axon_hum(folder: Path, rng: Rng) -> Truth:
    hum = rng.uniform(14.0, 24.0)
    _axon(folder, rng, hum=hum, loggers=(Logger("ms", zero=50.0), Logger("ms")))
    return Truth(
        f"the current of the second recording has the hum of the mains upon it: 50 Hz, amplitude {hum:.2f} uA/cm^2",
        (*RECORDING, *SENSOR),
    )


# --- a wheelset with a frame on a roller rig, FMI 2 Model Exchange; s, ms, km/h, N, mm, mrad, kN
WHEELSET = OdeModel(
    "wheelset",
    {
        "m": (32.0, "kg"),
        "I": (1.5, "kg*m^2"),
        "f": (4e4, "N"),
        "b": (0.15, "m"),
        "r": (0.1, "m"),
        "cone": (0.05, ""),
        "k_y": (4e4, "N/m"),
        "c_y": (150.0, "N*s/m"),
        "k_p": (900.0, "N*m/rad"),
        "m_f": (70.0, "kg"),
        "k_f": (2.8e4, "N/m"),
        "c_f": (420.0, "N*s/m"),
        "tau_v": (1.6, "s"),
        "tau_s": (0.03, "s"),
        "v_begin": (5.0, "m/s"),
    },
    {"drum": "m/s", "shaker": "N"},
    {
        "v": ("m/s", "v_begin", "(drum - v)/tau_v"),
        "F": ("N", "0.0", "(shaker - F)/tau_s"),
        "y": ("m", "0.0", "vy"),
        "vy": ("m/s", "0.0", "(F - 2.0*f*(vy/v - psi) - k_y*(y - y_f) - c_y*(vy - v_f))/m"),
        "psi": ("rad", "0.0", "w"),
        "w": ("rad/s", "0.0", "(-2.0*f*(cone*b/r*y + b*b*w/v) - k_p*psi)/I"),
        "y_f": ("m", "0.0", "v_f"),
        "v_f": ("m/s", "0.0", "(k_y*(y - y_f) + c_y*(vy - v_f) - k_f*y_f - c_f*v_f)/m_f"),
    },
    {
        "lateral": ("m", "y"),
        "yaw": ("rad", "psi"),
        "primary": ("N", "k_y*(y - y_f) + c_y*(vy - v_f)"),
        "speed": ("m/s", "v"),
    },
    1e-3,
)
WHEELSET_KNOWN = {
    "m": 0.02,
    "I": 0.03,
    "f": 0.08,
    "b": 5e-3,
    "cone": 0.05,
    "k_y": 0.04,
    "c_y": 0.1,
    "k_p": 0.05,
    "m_f": 0.02,
    "k_f": 0.04,
    "c_f": 0.08,
    "tau_v": 0.05,
    "tau_s": 0.08,
}


def _wheelset(
    folder: Path,
    rng: Rng,
    flange: tuple[float, float] = (0.0, 1.0),
    halted: tuple[float, float] = (np.inf, 0.0),
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Flanges may touch: flange[0] (|y| - flange[1]) above flange[1], in N/m and m.

    The clock of the second recording may stand still once: instant and span [s].
    """
    WHEELSET.build(folder)
    parts = programme("rollers", ("drum", "km/h")) + programme("exciter", ("shaker", "N"))
    parts += with_numbers("set", "wheelset")
    wires = "  - rollers.drum -> set.drum\n  - exciter.shaker -> set.shaker\n"
    scenario(folder, "A wheelset on rollers", 40.0, 0.005, 0.02, parts, wires)
    data_sheet(folder, WHEELSET, WHEELSET_KNOWN)
    m, inertia, f, b, r, cone, k_y, c_y, k_p, m_f, k_f, c_f, tau_v, tau_s, v_begin = drawn(
        rng, WHEELSET, WHEELSET_KNOWN
    )
    hard, clearance = flange

    def rates(t: float, x: Array, u: Array) -> list[float]:
        v, force, y, vy, psi, w, y_f, v_f = (float(s) for s in x)
        primary = k_y * (y - y_f) + c_y * (vy - v_f)
        touch = hard * np.sign(y) * max(abs(y) - clearance, 0.0)
        return [
            (float(u[0]) / 3.6 - v) / tau_v,
            (float(u[1]) - force) / tau_s,
            vy,
            (force - 2.0 * f * (vy / v - psi) - primary - touch) / m,
            w,
            (-2.0 * f * (cone * b / r * y + b * b * w / v) - k_p * psi) / inertia,
            v_f,
            (primary - k_f * y_f - c_f * v_f) / m_f,
        ]

    def primary(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(1e-3 * (k_y * (x[:, 2] - x[:, 6]) + c_y * (x[:, 3] - x[:, 7])))

    for number, (name, stop) in enumerate((("first", 40.0), ("second", 32.0), ("third", 36.0))):
        drum = drawn_steps(rng, stop, 4.0, 12.0, 40.0, 0.02)
        shaker = drawn_steps(rng, stop, 0.45, -520.0, 520.0, 0.02)
        if name == "third":
            shaker = telegraph(rng, stop, 0.5, -370.0, 370.0, 0.02)
        drum, shaker = later(drum, 0.01), later(shaker, 0.01)
        instant, span = halted if name == "second" else (np.inf, 0.0)
        t, x = integrated(rates, (v_begin, *(0.0,) * 7), (drum, shaker), round(stop + span, 6), 5e-3)
        if span:
            kept = (t <= instant + 1e-9) | (t > instant + span + 1e-9)
            t, x = t[: kept.sum()], x[kept]
        sensors = [
            Sensor("set.lateral", "y Laser mm", "mm", scaled(2, 1e3), 0.04, 0.02, noise_stated, 0.01, colour),
            Sensor("set.yaw", "Wendewinkel mrad", "mrad", scaled(4, 1e3), 0.15, 0.02, noise_stated, 0.02, colour),
            Sensor("set.primary", "Fy kN", "kN", primary, 1e-3, 0.02, noise_stated, 2e-4, colour),
            Sensor("set.speed", "v Rolle", "km/h", scaled(0, 3.6), 0.08, 0.1, noise_stated, 0.02, colour),
        ]
        programmes = {"rollers.drum": (drum, "km/h"), "exciter.shaker": (shaker, "N")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def wheelset_null(folder: Path, rng: Rng) -> Truth:
    loggers = (
        Logger("s", zero=3.0, jitter=0.1),
        Logger("ms", zero=-2e3, empty=0.02),
        Logger("s", gap=(15.0, 16.6)),
    )
    _wheelset(folder, rng, noise_stated=None, colour=0.15, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.15 and is not stated, two "
        "rates, jitter, empty cells, a gap of 1.6 s, loggers of s and ms",
        FINE,
    )


def wheelset_touches(folder: Path, rng: Rng) -> Truth:
    hard, clearance = rng.uniform(6e4, 1e5), rng.uniform(1.8e-3, 2.4e-3)
    _wheelset(folder, rng, flange=(hard, clearance), loggers=(Logger("ms"), PLAIN))
    return Truth(
        f"a flange touches the rail at {1e3 * clearance:.3f} mm to either side, and pushes back with {hard:.0f} N/m "
        f"(|y| - {1e3 * clearance:.3f} mm)",
        PHYSICS,
        TOUCHING,
    )


def wheelset_halted(folder: Path, rng: Rng) -> Truth:
    instant, span = 0.02 * round(rng.uniform(10.0, 17.0) / 0.02), 0.02 * round(rng.uniform(0.06, 0.12) / 0.02)
    _wheelset(folder, rng, halted=(instant, span), loggers=(PLAIN, Logger("s", zero=8.0), Logger("ms")))
    return Truth(
        f"the logger of the second recording stops for {span:.2f} s at {instant:.2f} s and its clock with it: readings "
        "from there on were taken that much later than it says",
        (*RECORDING, *SENSOR),
    )


# --- a pot that smelts aluminium, FMI 2 Model Exchange; h, kA, kg/min, mm, degC, V
POT = OdeModel(
    "smelter",
    {
        "U_0": (1.62, "V"),
        "R_0": (6.0e-6, "ohm"),
        "r_b": (3.9e-4, "ohm*m"),
        "area": (1.0, "m^2"),
        "k_w": (2.0, ""),
        "k_t": (2.5e-3, "1/K"),
        "g_a": (1.2e-7, "ohm"),
        "M": (5000.0, "kg"),
        "eff": (0.93, ""),
        "tau_d": (900.0, "s"),
        "tau_b": (240.0, "s"),
        "U_e": (2.05, "V"),
        "h_f": (1.6e6, "J/kg"),
        "C": (1.5e7, "J/K"),
        "G": (330.0, "W/K"),
        "C_s": (5.0e6, "J/K"),
        "G_o": (880.0, "W/K"),
        "x_begin": (150.0, "kg"),
        "D_begin": (0.045, "m"),
        "T_begin": (1231.15, "K"),
        "S_begin": (545.15, "K"),
    },
    {"line": "A", "shots": "kg/s", "beam": "m", "hall": "K"},
    {
        "X_u": ("kg", "0.1*x_begin", "shots - X_u/tau_d"),
        "X": ("kg", "x_begin", f"X_u/tau_d - eff*{ALUMINA}*line"),
        "D": ("m", "D_begin", "(beam - D)/tau_b"),
        "T": (
            "K",
            "T_begin",
            "(line*(U_0 - U_e + line*(R_0 + r_b*D/area*(1.0 + k_w*X/M)*(1.0 - k_t*(T - 1233.15)) + g_a*M/(X + 1e-9)))"
            " - h_f*X_u/tau_d - G*(T - T_s))/C",
        ),
        "T_s": ("K", "S_begin", "(G*(T - T_s) - G_o*(T_s - hall))/C_s"),
    },
    {
        "voltage": ("V", "U_0 + line*(R_0 + r_b*D/area*(1.0 + k_w*X/M)*(1.0 - k_t*(T - 1233.15)) + g_a*M/(X + 1e-9))"),
        "bath": ("K", "T"),
        "shell": ("K", "T_s"),
    },
    5.0,
)
POT_KNOWN = {
    "U_0": 0.01,
    "R_0": 0.03,
    "r_b": 0.03,
    "k_w": 0.08,
    "k_t": 0.1,
    "g_a": 0.06,
    "M": 0.03,
    "eff": 0.01,
    "tau_d": 0.1,
    "tau_b": 0.08,
    "U_e": 5e-3,
    "h_f": 0.08,
    "C": 0.04,
    "G": 0.02,
    "C_s": 0.06,
    "G_o": 0.04,
    "x_begin": 0.02,
}


def _fed(rng: Rng, stop: float, line: Steps, is_telegraph: bool) -> Steps:
    """Shots [kg/min] that feed too much and too little in turn, and keep what is solved within 30 kg by the numbers."""
    t = np.arange(0.0, stop, 60.0)
    uses = 60e3 * POT.parameters["eff"][0] * ALUMINA * line.at(t)
    while True:
        shots = drawn_steps(rng, stop, 2700.0, 0.5, 1.5, 60.0)
        if is_telegraph:
            shots = telegraph(rng, stop, 3000.0, 0.6, 1.35, 60.0)
        if np.abs(np.cumsum(shots.at(t) - uses)).max() < 30.0:
            return shots


def _smelter(
    folder: Path,
    rng: Rng,
    sludge: tuple[float, float] = (0.0, 1e4),
    wastes: float = 0.0,
    drift: float = 0.0,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (Logger("h"),),
) -> None:
    """A share of the alumina may settle and dissolve slowly: the share, and a time constant [s].

    Less of the current may count the hotter the bath is: 1 - wastes (T - 1233.15 K), wastes in 1/K. The thermocouple of
    the second recording may drift, by `drift` [K] until its end.
    """
    POT.build(folder)
    names = (
        ("substation", "line", "kA"),
        ("hopper", "shots", "kg/min"),
        ("jack", "beam", "mm"),
        ("potroom", "hall", "degC"),
    )
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("pot", "smelter")
    wires = "".join(f"  - {c}.{n} -> pot.{n}\n" for c, n, _ in names)
    scenario(folder, "A pot that smelts aluminium", 57600.0, 30, 60, parts, wires)
    data_sheet(folder, POT, POT_KNOWN)
    u_0, r_0, r_b, area, k_w, k_t, g_a, mass, eff, tau_d, tau_b, u_e, h_f, *more = drawn(rng, POT, POT_KNOWN)
    c_bath, passes, c_shell, g_out, x_begin, d_begin, t_begin, s_begin = more
    share, slowly = sludge

    def voltage(x: Array, line: Any) -> Any:
        """Of states (..., 6) and a current [A]."""
        bath = r_b * x[..., 2] / area * (1.0 + k_w * x[..., 1] / mass) * (1.0 - k_t * (x[..., 3] - 1233.15))
        return u_0 + line * (r_0 + bath + g_a * mass / x[..., 1])

    def rates(t: float, x: Array, u: Array) -> list[float]:
        loose, _, gap, bath, shell, lying = (float(s) for s in x)
        line, shots = 1e3 * float(u[0]), float(u[1]) / 60.0
        counts = 1.0 - wastes * (bath - 1233.15)
        heat = line * (float(voltage(np.asarray(x), line)) - u_e * counts)
        back = lying / slowly
        return [
            shots - loose / tau_d,
            (1.0 - share) * loose / tau_d + back - eff * counts * ALUMINA * line,
            (1e-3 * float(u[2]) - gap) / tau_b,
            (heat - h_f * loose / tau_d - passes * (bath - shell)) / c_bath,
            (passes * (bath - shell) - g_out * (shell - float(u[3]) - CELSIUS)) / c_shell,
            share * loose / tau_d - back,
        ]

    for number, (name, stop) in enumerate((("first", 57600.0), ("second", 46800.0), ("third", 50400.0))):
        line = drawn_steps(rng, stop, 4200.0, 92.0, 108.0, 60.0)
        shots = _fed(rng, stop, line, name == "third")
        beam = drawn_steps(rng, stop, 5400.0, 40.0, 50.0, 60.0)
        line, shots, beam = later(line, 30.0), later(shots, 30.0), later(beam, 30.0)
        hall = ramped(rng, stop, 10800.0, 18.0, 34.0, 600.0)
        start = (0.1 * x_begin, x_begin, d_begin, t_begin, s_begin, 0.0)
        t, x = integrated(rates, start, (line, shots, beam, hall), stop, 30.0)

        def volts(t: Array, x: Array, u: Array) -> Array:
            return np.asarray(voltage(x, 1e3 * u[:, 0]))

        def spoil(
            column: str, t: Array, v: Array, by: float = drift if name == "second" else 0.0, end: float = stop
        ) -> Array:
            return v + by * t / end if column == "Bad degC" else v

        sensors = [
            Sensor("pot.voltage", "U V", "V", volts, 8e-3, 60.0, noise_stated, 1e-3, wild=wild),
            Sensor("pot.bath", "Bad degC", "degC", celsius(3), 0.8, 60.0, noise_stated, 0.1, wild=wild),
            Sensor("pot.shell", "Wanne degC", "degC", celsius(4), 0.6, 120.0, noise_stated, 0.1, wild=wild),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "substation.line": (line, "kA"),
                "hopper.shots": (shots, "kg/min"),
                "jack.beam": (beam, "mm"),
                "potroom.hall": (hall, "degC"),
            },
            loggers[number % len(loggers)],
            recorded=["potroom.hall"],
            spoil=spoil,
        )
        write(folder / name, rng, made)


def smelter_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("h", zero=6.0), Logger("min", zero=-30.0, empty=0.03), Logger("h", gap=(21000.0, 23400.0)))
    _smelter(folder, rng, wild=0.004, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated rightly, wild readings, two rates, a column of an input, empty "
        "cells, a gap of 40 min, loggers of h and min",
        FINE,
    )


def smelter_sludge(folder: Path, rng: Rng) -> Truth:
    share, slowly = rng.uniform(0.25, 0.4), rng.uniform(9000.0, 16000.0)
    _smelter(folder, rng, sludge=(share, slowly), loggers=(Logger("min"), Logger("h", zero=2.0)))
    return Truth(
        f"{share:.3f} of the alumina settles as sludge and dissolves slowly, time constant {slowly / 3600.0:.2f} h",
        PHYSICS,
        SETTLING,
    )


def smelter_two(folder: Path, rng: Rng) -> Truth:
    share, slowly, wastes = rng.uniform(0.25, 0.4), rng.uniform(9000.0, 16000.0), rng.uniform(1e-3, 1.5e-3)
    _smelter(folder, rng, sludge=(share, slowly), wastes=wastes, loggers=(Logger("h", zero=1.0), Logger("s")))
    return Truth(
        f"{share:.3f} of the alumina settles as sludge and dissolves slowly, time constant {slowly / 3600.0:.2f} h; "
        f"and {100.0 * wastes:.3f} % less of the current counts for each kelvin that the bath is hotter than 960 degC",
        PHYSICS,
        (*SETTLING, *WASTING),
    )


def smelter_drift(folder: Path, rng: Rng) -> Truth:
    drift = -rng.uniform(9.0, 14.0)
    _smelter(folder, rng, drift=drift, loggers=(Logger("h"), Logger("min", zero=10.0), Logger("s")))
    return Truth(
        f"the thermocouple in the bath corrodes in the second recording: it drifts by {drift:.2f} K, in proportion to "
        "time",
        (*RECORDING, *SENSOR),
    )


# --- a road tunnel with jet fans, FMI 2 Co-Simulation that hides its states; s, min, 1/min, km/h, m/s, mg/m^3, 1/km
_AIR_SPEED = (
    "(fan*F_j*(1.0 - w/w_j) + 0.6*length/speed*(cars*A_car + trucks*A_truck)*(speed - w)*fabs(speed - w)"
    " - 0.6*area*zeta*w*fabs(w))/(1.2*area*length)"
)
TUNNEL = OdeModel(
    "road_tunnel",
    {
        "length": (1200.0, "m"),
        "area": (50.0, "m^2"),
        "zeta": (4.9, ""),
        "F_j": (620.0, "N"),
        "w_j": (30.0, "m/s"),
        "tau_j": (25.0, "s"),
        "A_car": (0.9, "m^2"),
        "A_truck": (5.0, "m^2"),
        "e_car": (3e-5, "kg/s"),
        "e_truck": (6e-5, "kg/s"),
        "k_truck": (0.02, "m^2/s"),
        "k_car": (6e-4, "m^2/s"),
        "tau_c": (30.0, "s"),
        "tau_k": (12.0, "s"),
        "w_begin": (3.0, "m/s"),
        "c_begin": (3e-6, "kg/m^3"),
        "s_begin": (5e-4, "1/m"),
    },
    {"cars": "1/s", "trucks": "1/s", "speed": "m/s", "fans": ""},
    {
        "fan": ("", "0.0", "(fans - fan)/tau_j"),
        "w": ("m/s", "w_begin", _AIR_SPEED),
        "c_1": (
            "kg/m^3",
            "0.25*c_begin",
            "-4.0*w*c_1/length + (e_car*cars + e_truck*trucks)*length/speed/(area*length)",
        ),
        "c_2": (
            "kg/m^3",
            "0.5*c_begin",
            "4.0*w*(c_1 - c_2)/length + (e_car*cars + e_truck*trucks)*length/speed/(area*length)",
        ),
        "c_3": (
            "kg/m^3",
            "0.75*c_begin",
            "4.0*w*(c_2 - c_3)/length + (e_car*cars + e_truck*trucks)*length/speed/(area*length)",
        ),
        "c_4": (
            "kg/m^3",
            "c_begin",
            "4.0*w*(c_3 - c_4)/length + (e_car*cars + e_truck*trucks)*length/speed/(area*length)",
        ),
        "s_1": ("1/m", "0.5*s_begin", "-2.0*w*s_1/length + (k_car*cars + k_truck*trucks)/(speed*area)"),
        "s_2": ("1/m", "s_begin", "2.0*w*(s_1 - s_2)/length + (k_car*cars + k_truck*trucks)/(speed*area)"),
        "m_3": ("kg/m^3", "0.75*c_begin", "(c_3 - m_3)/tau_c"),
        "m_4": ("kg/m^3", "c_begin", "(c_4 - m_4)/tau_c"),
        "n_2": ("1/m", "s_begin", "(s_2 - n_2)/tau_k"),
    },
    {"draught": ("m/s", "w"), "co_third": ("kg/m^3", "m_3"), "co_exit": ("kg/m^3", "m_4"), "haze": ("1/m", "n_2")},
    0.25,
)
TUNNEL_KNOWN = {
    "zeta": 0.06,
    "F_j": 0.05,
    "w_j": 0.03,
    "tau_j": 0.1,
    "A_car": 0.06,
    "A_truck": 0.06,
    "e_car": 0.06,
    "e_truck": 0.06,
    "k_truck": 0.06,
    "k_car": 0.1,
    "tau_c": 0.08,
    "tau_k": 0.1,
}


def _portal(
    folder: Path,
    rng: Rng,
    wind: tuple[float, float] = (np.inf, 0.0),
    is_swapped: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Wind may stand on the exit in the second recording: since when [s], and its pressure [Pa].

    The two columns of carbon monoxide of the second recording may be swapped.
    """
    TUNNEL.build(folder)
    names = (("loop", "cars", "1/min"), ("loop_2", "trucks", "1/min"), ("radar", "speed", "km/h"), ("jets", "fans", ""))
    parts = "".join(programme(c, (n, u)) for c, n, u in names)
    parts = parts.replace("constant: 0 km/h", "constant: 60 km/h") + with_numbers("tube", "road_tunnel", "internal")
    wires = "".join(f"  - {c}.{n} -> tube.{n}\n" for c, n, _ in names)
    scenario(folder, "A road tunnel with jet fans", 5400.0, 1, 5, parts, wires)
    data_sheet(folder, TUNNEL, TUNNEL_KNOWN)
    length, area, zeta, f_j, w_j, tau_j, a_car, a_truck, e_car, e_truck, k_truck, k_car, *more = drawn(
        rng, TUNNEL, TUNNEL_KNOWN
    )
    tau_c, tau_k, w_begin, c_begin, s_begin = more

    for number, (name, stop) in enumerate((("first", 5400.0), ("second", 4500.0), ("third", 4800.0))):
        since, pressure = wind if name == "second" else (np.inf, 0.0)
        blown = Steps((0.0, since), (0.0, pressure)) if pressure else Steps((0.0,), (0.0,))

        def rates(t: float, x: Array, u: Array) -> list[float]:
            fan, w, c_1, c_2, c_3, c_4, s_1, s_2, m_3, m_4, n_2 = (float(s) for s in x)
            cars, trucks, speed, fans = float(u[0]) / 60.0, float(u[1]) / 60.0, float(u[2]) / 3.6, float(u[3])
            slip = speed - w
            pushed = 0.6 * length / speed * (cars * a_car + trucks * a_truck) * slip * abs(slip)
            force = fan * f_j * (1.0 - w / w_j) + pushed - 0.6 * area * zeta * w * abs(w) - area * float(u[4])
            fumes = 1e6 * (e_car * cars + e_truck * trucks) / speed / area
            soot = 1e3 * (k_car * cars + k_truck * trucks) / speed / area
            quick, slow = 4.0 * w / length, 2.0 * w / length
            return [
                (fans - fan) / tau_j,
                force / (1.2 * area * length),
                fumes - quick * c_1,
                fumes + quick * (c_1 - c_2),
                fumes + quick * (c_2 - c_3),
                fumes + quick * (c_3 - c_4),
                soot - slow * s_1,
                soot + slow * (s_1 - s_2),
                (c_3 - m_3) / tau_c,
                (c_4 - m_4) / tau_c,
                (s_2 - n_2) / tau_k,
            ]

        cars = drawn_steps(rng, stop, 260.0, 4.0, 34.0, 5.0)
        trucks = drawn_steps(rng, stop, 330.0, 0.0, 5.0, 5.0)
        fans = drawn_steps(rng, stop, 420.0, -0.4, 6.4, 5.0)
        if name == "third":
            fans = stairs(rng, stop, 300.0, 0.0, 6.0, 4, 5.0)
        cars, trucks, fans = later(cars, 2.0), later(trucks, 2.0), later(fans, 2.0)
        fans = Steps(fans.times, tuple(float(abs(round(v))) for v in fans.levels))
        speed = ramped(rng, stop, 700.0, 42.0, 82.0, 20.0)
        carbon, soot = 1e6 * c_begin, 1e3 * s_begin
        cells = (*(share * carbon for share in (0.25, 0.5, 0.75, 1.0)), 0.5 * soot, soot)
        start = (0.0, w_begin, *cells, 0.75 * carbon, carbon, soot)
        t, x = integrated(rates, start, (cars, trucks, speed, fans, blown), stop, 1.25)
        third, last = (9, 8) if is_swapped and name == "second" else (8, 9)
        sensors = [
            Sensor("tube.draught", "u Luft", "m/s", scaled(1, 1.0), 0.06, 5.0, noise_stated, 0.02),
            Sensor("tube.co_third", "CO MS3", "mg/m^3", scaled(third, 1.0), 0.08, 5.0, noise_stated, 0.02),
            Sensor("tube.co_exit", "CO Portal", "mg/m^3", scaled(last, 1.0), 0.08, 5.0, noise_stated, 0.02),
            Sensor("tube.haze", "Truebung", "1/km", scaled(10, 1.0), 0.03, 10.0, noise_stated, 0.01),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "loop.cars": (cars, "1/min"),
                "loop_2.trucks": (trucks, "1/min"),
                "radar.speed": (speed, "km/h"),
                "jets.fans": (fans, ""),
            },
            loggers[number % len(loggers)],
            recorded=["radar.speed"],
        )
        write(folder / name, rng, made)


def portal_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=420.0), Logger("s", zero=-20.0, empty=0.02), Logger("s", gap=(2100.0, 2280.0)))
    _portal(folder, rng, noise_stated=0.95, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.05 times too small, two rates, a column of an input, empty "
        "cells, a gap of 3 min, loggers of min and s, Co-Simulation",
        FINE,
    )


def portal_wind(folder: Path, rng: Rng) -> Truth:
    since, pressure = 1.0 * round(rng.uniform(1300.0, 2000.0)), rng.uniform(14.0, 22.0)
    _portal(folder, rng, wind=(since, pressure), loggers=(PLAIN, Logger("min", zero=4.0)))
    return Truth(
        f"from {since:.0f} s of the second recording on, wind stands on the exit of the tunnel and pushes back with "
        f"{pressure:.2f} Pa; in the others there is none",
        (*PHYSICS, *RECORDING),
        (*BLOWN, *RATED, *STORED),
    )


def portal_swapped(folder: Path, rng: Rng) -> Truth:
    _portal(folder, rng, is_swapped=True, loggers=(Logger("s", zero=60.0), PLAIN, Logger("min")))
    return Truth(
        "the columns of carbon monoxide at the third station and at the exit are swapped in the second recording",
        (*RECORDING, *SENSOR),
    )


# --- an espresso machine with a sieve, FMI 2 Co-Simulation that hides its states; s, ms, W, %, bar, degC, g
ESPRESSO = OdeModel(
    "espresso",
    {
        "q_max": (9e-6, "m^3/s"),
        "p_max": (1.5e6, "Pa"),
        "C_p": (1.1e-11, "m^3/Pa"),
        "G": (4.6e-12, "m^3/(s*Pa)"),
        "b": (0.02, "1/K"),
        "C_b": (1500.0, "J/K"),
        "U_w": (60.0, "W/K"),
        "U_l": (0.7, "W/K"),
        "C_w": (140.0, "J/K"),
        "C_g": (420.0, "J/K"),
        "U_g": (1.4, "W/K"),
        "room": (295.15, "K"),
        "B_begin": (373.15, "K"),
        "W_begin": (367.15, "K"),
        "H_begin": (353.15, "K"),
    },
    {"heater": "W", "pump": "", "tank": "K"},
    {
        "p": ("Pa", "0.0", "(q_max*pump*(1.0 - p/p_max) - G*exp(b*(T_g - 358.15))*p)/C_p"),
        "T_b": ("K", "B_begin", "(heater - U_w*(T_b - T_w) - U_l*(T_b - room))/C_b"),
        "T_w": (
            "K",
            "W_begin",
            f"(U_w*(T_b - T_w) - {WATER * HEAT}*G*exp(b*(T_g - 358.15))*p*(T_w - tank))/C_w",
        ),
        "T_g": (
            "K",
            "H_begin",
            f"({WATER * HEAT}*G*exp(b*(T_g - 358.15))*p*(T_w - T_g) - U_g*(T_g - room))/C_g",
        ),
        "cup": ("kg", "0.0", f"{WATER}*G*exp(b*(T_g - 358.15))*p"),
    },
    {"gauge": ("Pa", "p"), "block": ("K", "T_b"), "group": ("K", "T_g"), "scale": ("kg", "cup")},
    0.01,
)
ESPRESSO_KNOWN = {
    "q_max": 0.04,
    "p_max": 0.02,
    "C_p": 0.08,
    "G": 0.05,
    "b": 0.08,
    "C_b": 0.04,
    "U_w": 0.06,
    "U_l": 0.1,
    "C_w": 0.06,
    "C_g": 0.05,
    "U_g": 0.08,
}


def _espresso(
    folder: Path,
    rng: Rng,
    presses: float = np.inf,
    dry: tuple[float, float] | None = None,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The cake may be pressed together: G/(1 + (p/presses)^2), presses in Pa.

    The pump may run dry for a while in the first recording, and be said to have pumped: begin and end [s].
    """
    ESPRESSO.build(folder)
    names = (("triac", "heater", "W"), ("vibrator", "pump", "%"), ("vessel", "tank", "degC"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("machine", "espresso", "internal")
    parts = parts.replace("unit: %", 'unit: "%"')
    wires = "".join(f"  - {c}.{n} -> machine.{n}\n" for c, n, _ in names)
    scenario(folder, "An espresso machine", 300.0, 0.05, 0.25, parts, wires)
    data_sheet(folder, ESPRESSO, ESPRESSO_KNOWN)
    q_max, p_max, c_p, g, b, c_b, u_w, u_l, c_w, c_g, u_g, room, *begins = drawn(rng, ESPRESSO, ESPRESSO_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Pressure is in bar, the cup in g."""
        bar, block, water, group, _ = (float(s) for s in x)
        p = 1e5 * bar
        flow = g / (1.0 + (p / presses) ** 2) * np.exp(b * (group - 358.15)) * p
        carried = WATER * HEAT * flow
        heated = u_w * (block - water)
        return [
            1e-5 * (q_max * 1e-2 * float(u[1]) * (1.0 - p / p_max) - flow) / c_p,
            (float(u[0]) - heated - u_l * (block - room)) / c_b,
            (heated - carried * (water - float(u[2]) - CELSIUS)) / c_w,
            (carried * (water - group) - u_g * (group - room)) / c_g,
            1e3 * WATER * flow,
        ]

    for number, (name, stop) in enumerate((("first", 300.0), ("second", 240.0), ("third", 270.0))):
        heater = drawn_steps(rng, stop, 14.0, 250.0, 1500.0, 0.25)
        pump = drawn_steps(rng, stop, 8.0, 0.0, 100.0, 0.25)
        if name == "third":
            pump = telegraph(rng, stop, 7.0, 8.0, 90.0, 0.25)
        heater, pump = later(heater, 0.1), later(pump, 0.1)
        tank = ramped(rng, stop, 80.0, 16.0, 24.0, 5.0)
        run = pump
        if dry is not None and name == "first":
            run = between(pump, *dry, lambda v: 0.0)
        t, x = integrated(rates, (0.0, *begins, 0.0), (heater, run, tank), stop, 0.05)
        sensors = [
            Sensor("machine.gauge", "p bar", "bar", scaled(0, 1.0), 0.06, 0.25, noise_stated, 0.02),
            Sensor("machine.block", "NTC Block", "degC", celsius(1), 0.2, 0.25, noise_stated, 0.05),
            Sensor("machine.group", "TC Gruppe", "degC", celsius(3), 0.2, 0.25, noise_stated, 0.05),
            Sensor("machine.scale", "Waage g", "g", scaled(4, 1.0), 0.4, 0.5, noise_stated, 0.1),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"triac.heater": (heater, "W"), "vibrator.pump": (run, "%"), "vessel.tank": (tank, "degC")},
            loggers[number % len(loggers)],
            recorded=["vessel.tank"],
            told={} if run is pump else {"vibrator.pump": pump},
        )
        write(folder / name, rng, made)


def espresso_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=10.0, jitter=0.12), Logger("ms", zero=5e3), Logger("s", empty=0.03, gap=(90.0, 99.0)))
    _espresso(folder, rng, noise_stated=1.1, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.1 times too large, two rates, a column of an input, jitter, "
        "empty cells, a gap of 9 s, loggers of s and ms, Co-Simulation",
        FINE,
    )


def espresso_pressed(folder: Path, rng: Rng) -> Truth:
    presses = rng.uniform(1.1e6, 1.5e6)
    _espresso(folder, rng, presses=presses, loggers=(Logger("ms"), PLAIN))
    return Truth(
        f"the cake of coffee is pressed together while there is pressure: G/(1 + (p/{1e-5 * presses:.2f} bar)^2)",
        PHYSICS,
        PRESSED,
    )


def espresso_dry(folder: Path, rng: Rng) -> Truth:
    begin = 0.25 * round(rng.uniform(100.0, 170.0) / 0.25) + 0.1
    end = round(begin + 0.25 * round(rng.uniform(9.0, 13.0) / 0.25), 6)
    _espresso(folder, rng, dry=(begin, end), loggers=(PLAIN, Logger("ms", zero=100.0)))
    return Truth(
        f"from {begin:.10g} s to {end:.10g} s of the first recording the pump draws air and pumps nothing, and is said "
        "to have pumped",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- a chromatographic column of five cells, FMI 3 Co-Simulation that hides its states; min, mL/min, g/L, mmol/L, mAU
_FLOW = "F/(eps*V/5.0)"
_BOUND = "q_m*K_0*(0.1/s_{0})*(0.1/s_{0})*c_{0}/(1.0 + K_0*(0.1/s_{0})*(0.1/s_{0})*c_{0})"


def _cell(i: int) -> dict[str, tuple[str, str, str]]:
    """States of a cell: protein and salt that flow, protein that is bound."""
    before_c, before_s = (f"c_{i - 1}", f"s_{i - 1}") if i > 1 else ("protein", "x_s")
    taken = f"k*({_BOUND.format(i)} - q_{i})"
    return {
        f"c_{i}": ("g/L", "0.0", f"{_FLOW}*({before_c} - c_{i}) - (1.0 - eps)/eps*{taken}"),
        f"s_{i}": ("mol/L", "s_begin", f"{_FLOW}*({before_s} - s_{i})"),
        f"q_{i}": ("g/L", "0.0", taken),
    }


COLUMN = OdeModel(
    "chromatograph",
    {
        "V": (5.0, "mL"),
        "eps": (0.4, ""),
        "q_m": (60.0, "g/L"),
        "K_0": (0.12, "L/g"),
        "k": (8e-3, "1/s"),
        "tau_p": (4.0, "s"),
        "V_m": (0.6, "mL"),
        "a_uv": (900.0, "L/g"),
        "k_s": (11.0, "L/mol"),
        "r": (9e6, "Pa*s/mL"),
        "r_q": (0.03, "L/g"),
        "s_begin": (0.1, "mol/L"),
    },
    {"flow": "mL/s", "protein": "g/L", "salt": "mol/L"},
    {
        "F": ("mL/s", "0.0", "(flow - F)/tau_p"),
        "x_s": ("mol/L", "s_begin", "F/V_m*(salt - x_s)"),
        **{name: state for i in range(1, 6) for name, state in _cell(i).items()},
    },
    {
        "absorbance": ("", "a_uv*c_5"),
        "conductivity": ("", "k_s*s_5"),
        "pressure": ("Pa", "r*F*(1.0 + r_q*0.2*(q_1 + q_2 + q_3 + q_4 + q_5))"),
    },
    0.5,
)
COLUMN_KNOWN = {
    "eps": 0.03,
    "q_m": 0.04,
    "K_0": 0.06,
    "k": 0.08,
    "tau_p": 0.1,
    "V_m": 0.06,
    "a_uv": 0.02,
    "k_s": 0.02,
    "r": 0.04,
    "r_q": 0.08,
}


def _column(
    folder: Path,
    rng: Rng,
    film: float = 0.0,
    laden: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> None:
    """Protein may bind faster the faster it flows: k (F/(1 mL/min))^film.

    The column of the second recording may be laden at its begin, with `laden` [g/L].
    """
    build3(COLUMN, folder, has_exchange=False)
    names = (("pump", "flow", "mL/min"), ("valve", "protein", "g/L"), ("mixer", "salt", "mmol/L"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names)
    parts = parts.replace("constant: 0 mmol/L", "constant: 100 mmol/L")
    parts += with_numbers("column", "chromatograph", "internal")
    wires = "".join(f"  - {c}.{n} -> column.{n}\n" for c, n, _ in names)
    scenario(folder, "A chromatographic column", 6000.0, 1, 5, parts, wires)
    data_sheet(folder, COLUMN, COLUMN_KNOWN)
    volume, eps, q_m, k_0, k, tau_p, v_m, a_uv, k_s, r, r_q, s_begin = drawn(rng, COLUMN, COLUMN_KNOWN)

    def rates(t: float, x: Array, u: Array) -> Array:
        """Flow, salt before the column; then protein, salt, bound protein of all cells."""
        flow = max(float(x[0]), 1e-9)
        c, s, q = x[2:7], x[7:12], x[12:17]
        holds = k_0 * (0.1 / s) ** 2 * c
        taken = k * (60.0 * flow) ** film * (q_m * holds / (1.0 + holds) - q)
        passes = flow / (eps * volume / 5.0)
        return np.concatenate(
            [
                [(float(u[0]) / 60.0 - flow) / tau_p, flow / v_m * (1e-3 * float(u[2]) - float(x[1]))],
                passes * (np.concatenate([[float(u[1])], c[:-1]]) - c) - (1.0 - eps) / eps * taken,
                passes * (np.concatenate([x[1:2], s[:-1]]) - s),
                taken,
            ]
        )

    def pressure(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(1e-5 * r * x[:, 0] * (1.0 + r_q * x[:, 12:17].mean(axis=1)))

    for number, (name, stop) in enumerate((("first", 6000.0), ("second", 4800.0), ("third", 5400.0))):
        flow = drawn_steps(rng, stop, 420.0, 0.5, 2.0, 5.0)
        protein = bursts(rng, stop, 260.0, 360.0, 0.4, 2.2, 5.0)
        salt = drawn_steps(rng, stop, 500.0, 90.0, 260.0, 5.0)
        if name == "third":
            salt = wandering(rng, stop, 320.0, 95.0, 250.0, 5.0)
        flow, protein, salt = later(flow, 2.0), later(protein, 2.0), later(salt, 2.0)
        bound = laden if name == "second" else 0.0
        start = [0.0, s_begin, *(0.0,) * 5, *(s_begin,) * 5, *(bound,) * 5]
        t, x = integrated(rates, start, (flow, protein, salt), stop, 1.25)
        sensors = [
            Sensor("column.absorbance", "UV280 mAU", "1", scaled(6, a_uv), 6.0, 5.0, noise_stated, 1.0),
            Sensor("column.conductivity", "Lf mS/cm", "1", scaled(11, k_s), 0.01, 5.0, noise_stated, 2e-3),
            Sensor("column.pressure", "dp bar", "bar", pressure, 0.02, 10.0, noise_stated, 0.01),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"pump.flow": (flow, "mL/min"), "valve.protein": (protein, "g/L"), "mixer.salt": (salt, "mmol/L")},
            loggers[number % len(loggers)],
        )
        write(folder / name, rng, made)
        idle_column(folder / name, "Fraktion", lambda n: np.floor(np.arange(n) / 60.0) + 1.0)


def column_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=5.0), Logger("h", zero=1.0, empty=0.02), Logger("s", gap=(2600.0, 2780.0)))
    _column(folder, rng, noise_stated=None, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, two rates, a column that nobody uses, empty cells, a gap "
        "of 3 min, loggers of min, h and s, Co-Simulation of FMI 3",
        FINE,
    )


def column_film(folder: Path, rng: Rng) -> Truth:
    film = rng.uniform(0.7, 1.0)
    _column(folder, rng, film=film, loggers=(PLAIN, Logger("min", zero=12.0)))
    return Truth(
        f"protein binds and leaves faster the faster it flows, by films around the grains: k (F/(1 mL/min))^{film:.2f}",
        PHYSICS,
        FILMED,
    )


def column_laden(folder: Path, rng: Rng) -> Truth:
    laden = rng.uniform(4.0, 7.0)
    _column(folder, rng, laden=laden, loggers=(Logger("min"), Logger("s", zero=30.0)))
    return Truth(
        f"the column was used and not washed before the second recording: {laden:.3f} g/L are bound at its begin, and "
        "nothing is said to be",
        (*RECORDING, *SENSOR),
    )


# --- a diesel (FMI 2, Model Exchange) and its turbocharger (FMI 2, Co-Simulation); s, ms, mg, %, rpm, kPa, degC
DIESEL = OdeModel(
    "diesel",
    {
        "V_d": (6e-3, "m^3"),
        "fill": (0.9, ""),
        "H": (4.3e7, "J/kg"),
        "eta": (0.46, ""),
        "b_l": (0.9, ""),
        "f_0": (40.0, "N*m"),
        "f_1": (0.25, "N*m*s/rad"),
        "k_b": (0.036, "N*m*s^2/rad^2"),
        "J": (3.2, "kg*m^2"),
        "tau_f": (0.12, "s"),
        "tau_t": (0.8, "s"),
        "a_e": (0.36, ""),
        "T_i": (320.0, "K"),
        "w_begin": (150.0, "rad/s"),
        "m_begin": (5e-5, "kg"),
        "M_begin": (720.0, "K"),
    },
    {"rack": "kg", "gate": "", "p_i": "Pa"},
    {
        "m": ("kg", "m_begin", "(rack - m)/tau_f"),
        "w": (
            "rad/s",
            "w_begin",
            "(eta*tanh(b_l*fill*V_d*p_i/(287.0*T_i*14.5*6.0*(m + 1e-15)))*H*m*6.0/(4.0*M_PI)"
            " - f_0 - f_1*w - k_b*gate*w*w)/J",
        ),
        "T_m": ("K", "M_begin", "(T_i + a_e*H*m*6.0/(1100.0*(fill*V_d*p_i/(287.0*T_i) + 6.0*m + 1e-12)) - T_m)/tau_t"),
    },
    {
        "speed": ("rad/s", "w"),
        "exhaust_temperature": ("K", "T_m"),
        "drawn": ("kg/s", "fill*V_d*w/(4.0*M_PI)*p_i/(287.0*T_i)"),
        "passed": ("kg/s", "w/(4.0*M_PI)*(fill*V_d*p_i/(287.0*T_i) + 6.0*m)"),
        "hot": ("K", "T_i + a_e*H*m*6.0/(1100.0*(fill*V_d*p_i/(287.0*T_i) + 6.0*m + 1e-12))"),
    },
    1e-3,
)
TURBO = OdeModel(
    "turbo",
    {
        "V_i": (8e-3, "m^3"),
        "V_e": (4e-3, "m^3"),
        "T_i": (320.0, "K"),
        "T_a": (295.0, "K"),
        "p_a": (1e5, "Pa"),
        "a_c": (2.2e-8, "s^2/rad^2"),
        "k_c": (0.28, "kg/s"),
        "eta_c": (0.7, ""),
        "k_t": (2.7e-5, "m*s*K^0.5"),
        "eta_t": (0.66, ""),
        "J_t": (2e-4, "kg*m^2"),
        "d_t": (4e-5, "N*m*s/rad"),
        "s_begin": (7000.0, "rad/s"),
        "i_begin": (1.8e5, "Pa"),
        "e_begin": (1.8e5, "Pa"),
    },
    {"drawn": "kg/s", "passed": "kg/s", "hot": "K"},
    {
        "p_i": (
            "Pa",
            "i_begin",
            "287.0*T_i/V_i*(k_c*fmax(1.0 + a_c*s*s - p_i/p_a, 0.0) - drawn)",
        ),
        "p_e": (
            "Pa",
            "e_begin",
            "287.0*hot/V_e*(passed - k_t*p_e/sqrt(hot)*sqrt(fmax(1.0 - p_a/p_e, 1e-6)))",
        ),
        "s": (
            "rad/s",
            "s_begin",
            "(eta_t*k_t*p_e/sqrt(hot)*sqrt(fmax(1.0 - p_a/p_e, 1e-6))*1100.0*hot*(1.0 - pow(p_a/p_e, 0.25))"
            " - k_c*fmax(1.0 + a_c*s*s - p_i/p_a, 0.0)*1005.0*T_a*(pow(p_i/p_a, 0.286) - 1.0)/eta_c)/(J_t*s)"
            " - d_t*s/J_t",
        ),
    },
    {"boost": ("Pa", "p_i"), "back": ("Pa", "p_e"), "shaft": ("rad/s", "s")},
    1e-3,
)
DIESEL_KNOWN = {"fill": 0.02, "eta": 0.03, "b_l": 0.05, "f_0": 0.1, "f_1": 0.1, "k_b": 0.03, "J": 0.03, "tau_f": 0.1}
DIESEL_KNOWN |= {"tau_t": 0.06, "a_e": 0.03}
TURBO_KNOWN = {"V_i": 0.05, "V_e": 0.06, "a_c": 0.03, "k_c": 0.04, "eta_c": 0.03, "k_t": 0.03, "eta_t": 0.03}
TURBO_KNOWN |= {"J_t": 0.05, "d_t": 0.1}


def _diesel(
    folder: Path,
    rng: Rng,
    opens: tuple[float, float] = (0.0, 1e5),
    wall: tuple[float, float] = (0.0, 1.0),
    is_volume: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Two FMUs; a valve may let gas pass the turbine above a pressure of air: opens[0] (p_i - opens[1]) p_e/sqrt(T).

    The manifold may store heat: what passes to it [W/K], and its capacity [J/K]. The rack of the second recording may
    be said in mm^3.
    """
    DIESEL.build(folder)
    TURBO.build(folder)
    data_sheet(folder, DIESEL, DIESEL_KNOWN)
    (folder / "numbers.yaml").rename(folder / "diesel.yaml")
    data_sheet(folder, TURBO, TURBO_KNOWN)
    parts = (
        programme("governor", ("rack", "mg"))
        + programme("brake", ("gate", "%")).replace("unit: %", 'unit: "%"')
        + with_numbers("engine", "diesel").replace("numbers.yaml", "diesel.yaml")
        + with_numbers("turbo", "turbo", "internal")
    )
    parts = parts.replace("constant: 0 mg", "constant: 50 mg").replace("constant: 0 %", "constant: 50 %")
    wires = "  - governor.rack -> engine.rack\n  - brake.gate -> engine.gate\n  - turbo.boost -> engine.p_i\n"
    wires += "".join(f"  - engine.{n} -> turbo.{n}\n" for n in ("drawn", "passed", "hot"))
    scenario(folder, "A diesel and its turbocharger", 44.0, 0.004, 0.04, parts, wires)
    v_d, fill, heat, eta, b_l, f_0, f_1, k_b, inertia, tau_f, tau_t, a_e, t_i, w_begin, m_begin, t_begin = drawn(
        rng, DIESEL, DIESEL_KNOWN
    )
    v_i, v_e, _, t_a, p_a, a_c, k_c, eta_c, k_t, eta_t, j_t, d_t, *begins = drawn(rng, TURBO, TURBO_KNOWN)
    leaks, lifts = opens
    walled, stores = wall

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Fuel is in mg, pressures are in kPa; the last is the temperature of the manifold [K]."""
        milli, w, shown, kilo_i, kilo_e, s, warm = (float(v) for v in x)
        m, p_i, p_e = 1e-6 * milli, 1e3 * kilo_i, 1e3 * kilo_e
        air = fill * v_d * p_i / (AIR * t_i)
        torque = eta * np.tanh(b_l * air / (14.5 * 6.0 * m)) * heat * m * 6.0 / (4.0 * np.pi)
        burnt = t_i + a_e * heat * m * 6.0 / (1100.0 * (air + 6.0 * m))
        drawn_in, passed = w / (4.0 * np.pi) * air, w / (4.0 * np.pi) * (air + 6.0 * m)
        lost = walled * (burnt - warm)
        hot = burnt - lost / (1100.0 * passed)
        pushed = p_e / np.sqrt(hot) * np.sqrt(max(1.0 - p_a / p_e, 1e-6))
        pressed = k_c * max(1.0 + a_c * s * s - p_i / p_a, 0.0)
        given = eta_t * k_t * pushed * 1100.0 * hot * (1.0 - (p_a / p_e) ** 0.25)
        taken = pressed * 1005.0 * t_a * ((p_i / p_a) ** 0.286 - 1.0) / eta_c
        return [
            (float(u[0]) - milli) / tau_f,
            (torque - f_0 - f_1 * w - k_b * 1e-2 * float(u[1]) * w * w) / inertia,
            (burnt - shown) / tau_t,
            1e-3 * AIR * t_i / v_i * (pressed - drawn_in),
            1e-3 * AIR * hot / v_e * (passed - (k_t + leaks * max(p_i - lifts, 0.0)) * pushed),
            (given - taken) / (j_t * s) - d_t * s / j_t,
            (lost - 0.15 * walled * (warm - t_a)) / stores,
        ]

    for number, (name, stop) in enumerate((("first", 44.0), ("second", 36.0), ("third", 40.0))):
        rack = drawn_steps(rng, stop, 2.2, 24.0, 82.0, 0.04)
        if name == "third":
            rack = stairs(rng, stop, 1.6, 26.0, 80.0, 5, 0.04)
        gate = drawn_steps(rng, stop, 3.0, 25.0, 90.0, 0.04)
        rack, gate = later(rack, 0.02), later(gate, 0.02)
        start = (1e6 * m_begin, w_begin, t_begin, 1e-3 * begins[1], 1e-3 * begins[2], begins[0], 560.0)
        t, x = integrated(rates, start, (rack, gate), stop, 0.01)
        told = {}
        if is_volume and name == "second":
            told = {"governor.rack": Steps(rack.times, tuple(float(f"{v / FUEL:.4g}") for v in rack.levels))}
        sensors = [
            Sensor("engine.speed", "n rpm", "rpm", scaled(1, RPM), 4.0, 0.04, noise_stated, 1.0),
            Sensor("engine.exhaust_temperature", "T Abgas", "degC", celsius(2), 1.5, 0.08, noise_stated, 0.25),
            Sensor("turbo.boost", "p Lader kPa", "kPa", scaled(3, 1.0), 0.6, 0.04, noise_stated, 0.1),
            Sensor("turbo.shaft", "n Lader rpm", "rpm", scaled(5, RPM), 150.0, 0.04, noise_stated, 50.0),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"governor.rack": (rack, "mg"), "brake.gate": (gate, "%")},
            loggers[number % len(loggers)],
            told=told,
        )
        write(folder / name, rng, made)


def diesel_opens(folder: Path, rng: Rng) -> Truth:
    leaks, lifts = rng.uniform(1.2e-10, 1.8e-10), rng.uniform(1.75e5, 1.95e5)
    _diesel(folder, rng, opens=(leaks, lifts), loggers=(PLAIN, Logger("ms", zero=400.0)))
    return Truth(
        f"a valve beside the turbine opens once the air has more than {1e-3 * lifts:.2f} kPa: its area is "
        f"{1e5 * leaks / 2.7e-5:.3f} % of the turbine's for each kPa above",
        PHYSICS,
        OPENING,
    )


def diesel_two(folder: Path, rng: Rng) -> Truth:
    leaks, lifts = rng.uniform(1.2e-10, 1.8e-10), rng.uniform(1.75e5, 1.95e5)
    walled, stores = rng.uniform(35.0, 50.0), rng.uniform(150.0, 260.0)
    _diesel(folder, rng, opens=(leaks, lifts), wall=(walled, stores), loggers=(Logger("ms"), Logger("s", zero=3.0)))
    return Truth(
        f"a valve beside the turbine opens once the air has more than {1e-3 * lifts:.2f} kPa: its area is "
        f"{1e5 * leaks / 2.7e-5:.3f} % of the turbine's for each kPa above; and the manifold takes heat of the gas, "
        f"{walled:.2f} W/K, and stores {stores:.1f} J/K",
        PHYSICS,
        (*OPENING, *WALLED),
    )


def diesel_volume(folder: Path, rng: Rng) -> Truth:
    _diesel(folder, rng, is_volume=True, loggers=(Logger("s", zero=-4.0), PLAIN, Logger("ms")))
    return Truth(
        f"the rack of the second recording is in mm^3 of fuel, {FUEL:g} mg each, and is said to be in mg",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- a fork of coils at one supply: one behind a ballast, four of which one is bridged, two; the tool's own units
FORK = {
    "reference_resistance": (2.1, "ohm", 0.02, 0.02),
    "heat_transfer_coefficient": (95.0, "W/(m^2*K)", 0.05, 0.02),
    "area": (120.0, "mm^2", 0.0, 0.0),
    "volume": (9.4, "mm^3", 0.0, 0.0),
    "density": (6450.0, "kg/m^3", 0.0, 0.0),
    "specific_heat": (830.0, "J/(kg*K)", 0.05, 0.02),
}
#: Coils in series, the one that is bridged (from 0), resistances of wires, ballasts, and the supply [ohm].
FORK_STRINGS, FORK_BRIDGED, FORK_WIRES, FORK_BALLAST, FORK_INNER = (1, 4, 2), 2, 0.15, (3.2, 0.0, 1.1), 0.25
#: Limit of the supply [A], rise of resistance [1/K].
FORK_LIMIT, FORK_RISE = 1.6, 8e-4


def _fork_files(folder: Path) -> None:
    """Scenario and parameter set of the seven coils."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = ["title: Coils of a fork", "parameters:"]
    for name, (value, unit, uncertainty, scatter) in FORK.items():
        known = f"uncertainty: {uncertainty:g}, scatter: {scatter:g}"
        lines.append(f'  {name}: {{value: {value:g}, unit: {unit}, source: "own measurement", {known}}}')
    lines += [
        '  use_regressed_cooling_rate: {value: false, source: "cools as it heats"}',
        '  initial_temperature: {value: 21, unit: degC, source: "room"}',
        '  reference_temperature: {value: 21, unit: degC, source: "room"}',
        f'  resistance_temperature_coefficient: {{value: {FORK_RISE:g}, unit: 1/K, source: "own measurement"}}',
    ]
    (folder / "numbers.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    elements = [f"{{kind: current_limit, supply: 1, limit: {FORK_LIMIT} A, share: 1}}"]
    elements += [
        f"{{kind: contact, string: {s}, resistance: {ohm} ohm}}" for s, ohm in enumerate(FORK_BALLAST, start=1) if ohm
    ]
    parts = (
        programme("bench", ("voltage", "V"))
        + programme("room", ("temperature", "degC")).replace("constant: 0 degC", "constant: 21 degC")
        + f"  circuit:\n    kind: ngspice\n    strings: [{', '.join(str(n) for n in FORK_STRINGS)}]\n"
        f"    supply: common\n    supply_resistance: {FORK_INNER} ohm\n    string_resistance: {FORK_WIRES} ohm\n"
        f"    shorted_coils: [{FORK_BRIDGED + 1}]\n    elements:\n"
        + "".join(f"      - {e}\n" for e in elements)
        + "    start: {resistance: 2.1 ohm}\n"
        "  coils: {kind: actuator, fmu: thermal_stiffness, electrical: circuit, ambient: room, "
        "parameter_set: numbers.yaml}\n"
    )
    scenario(folder, "A fork of coils", 110.0, 0.05, 0.1, parts, "  - bench.voltage -> circuit.supply_voltage\n")


def _fork_off(rng: Rng, name: str) -> Array:
    """A number of each coil as it is."""
    value, _, uncertainty, scatter = FORK[name]
    return np.asarray(value * np.exp(uncertainty * rng.normal() + scatter * rng.normal(size=sum(FORK_STRINGS))))


def _fork_course(
    numbers: Sequence[Array], volts: Steps, room: Steps, start: float, stop: float, step: float, joint: Sequence[float]
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
        joint: Of the third string: resistance that heat of its current adds at last [ohm/A^2], time constant [s].
    """
    cold, loses, holds = numbers
    rises, lag = joint
    times: Array = step * np.arange(round(stop / step) + 1, dtype=np.float64)
    emf, around = volts.at(times), room.at(times)
    string = np.repeat(np.arange(len(FORK_STRINGS)), FORK_STRINGS)
    works = np.arange(len(string)) != FORK_BRIDGED

    def currents(hot: Array, v: float, added: float) -> tuple[Array, float]:
        ohms = np.bincount(string, hot * works) + FORK_WIRES + np.asarray(FORK_BALLAST) + np.asarray([0.0, 0.0, added])
        together = float(np.sum(1.0 / ohms))
        total = min(v / (FORK_INNER + 1.0 / together), FORK_LIMIT)
        return np.asarray(total / together / ohms), total / together

    def relaxed(warm: Array, at: Array, v: float, outside: float, span: float, added: float) -> Array:
        hot = cold * (1.0 + FORK_RISE * (at - 21.0))
        end = outside + currents(hot, v, added)[0][string] ** 2 * hot * works / loses
        return np.asarray(end + (warm - end) * np.exp(-loses * span / holds))

    warm, added = np.full(len(string), start), 0.0
    found = np.empty((len(times), len(string) + len(FORK_STRINGS) + 1))
    for i, (v, outside) in enumerate(zip(emf, around)):
        amps, terminal = currents(cold * (1.0 + FORK_RISE * (warm - 21.0)), float(v), added)
        found[i] = (*warm, *amps, terminal)
        middle = relaxed(warm, warm, float(v), float(outside), step / 2, added)
        warm = relaxed(warm, middle, float(v), float(outside), step, added)
        added += (rises * float(amps[2]) ** 2 - added) * (1.0 - np.exp(-step / lag))
    return times, found


def _fork(
    folder: Path,
    rng: Rng,
    joint: tuple[float, float] = (0.0, 1.0),
    holds: Sequence[tuple[float, float]] = (),
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """A joint of the third string may grow warm: resistance that heat adds at last [ohm/A^2], time constant [s].

    The second ammeter may hold its reading over stretches of the second recording [s].
    """
    _fork_files(folder)
    conductance = 1e-6 * _fork_off(rng, "area") * _fork_off(rng, "heat_transfer_coefficient")
    capacity = 1e-9 * _fork_off(rng, "density") * _fork_off(rng, "volume") * _fork_off(rng, "specific_heat")
    numbers = (_fork_off(rng, "reference_resistance"), conductance, capacity)

    for number, (name, stop) in enumerate((("first", 110.0), ("second", 90.0), ("third", 100.0))):
        volts = drawn_steps(rng, stop, 6.0, 0.0, 4.6, 0.1)
        if name == "third":
            volts = wandering(rng, stop, 4.0, 0.2, 4.4, 0.1)
        volts = later(volts, 0.05)
        room = ramped(rng, stop, 35.0, 19.5, 24.0, 0.5)
        said = room.levels[0]
        t, x = _fork_course(numbers, volts, room, said + 0.2 * float(rng.normal()), stop, 0.0125, joint)

        def spoil(column: str, t: Array, v: Array, now: bool = name == "second") -> Array:
            for begin, end in holds if now and column == "A2 mA" else ():
                stuck = (t >= begin) & (t < end)
                v = np.where(stuck, v[np.argmax(stuck)], v)
            return v

        sensors = [
            Sensor(f"string[{s}].current", f"A{s} mA", "mA", scaled(6 + s, 1e3), 1.5, 0.1, noise_stated, 0.5)
            for s in (1, 2, 3)
        ]
        sensors += [Sensor("supply.voltage", "U Klemme", "V", scaled(10, 1.0), 8e-3, 0.1, noise_stated, 2e-3)]
        sensors += [
            Sensor(f"coil[{c}].temperature", f"Pt {c}", "degC", scaled(c - 1, 1.0), 0.25, 0.2, noise_stated, 0.1)
            for c in (1, 2, 5, 7)
        ]
        made = Written(
            t,
            x,
            sensors,
            {"bench.voltage": (volts, "V"), "room.temperature": (room, "degC")},
            loggers[number % len(loggers)],
            recorded=["room.temperature"],
            sidecar={"components": {"coils": {"parameters": {"initial_temperature": f"{said:g} degC"}}}},
            spoil=spoil,
        )
        write(folder / name, rng, made)


def fork_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=-900.0), Logger("s", zero=2.0, empty=0.02), Logger("s", gap=(51.0, 54.0)))
    _fork(folder, rng, noise_stated=1.05, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, coil by coil too, start off by 0.2 K (deviation), noise stated 1.05 times too "
        "large, two rates, a column of an input, empty cells, a gap of 3 s, loggers of s and ms",
        FINE,
    )


def fork_joint(folder: Path, rng: Rng) -> Truth:
    rises, lag = rng.uniform(2.5, 4.5), rng.uniform(4.0, 8.0)
    _fork(folder, rng, joint=(rises, lag), loggers=(PLAIN, Logger("ms", zero=20.0)))
    return Truth(
        f"a joint of the third string grows warm, and its resistance with it: by {rises:.3f} ohm/A^2 at last, time "
        f"constant {lag:.2f} s",
        PHYSICS,
        JOINED,
    )


def fork_holds(folder: Path, rng: Rng) -> Truth:
    first = 0.1 * round(rng.uniform(20.0, 28.0) / 0.1) + 0.05
    later_on = 0.1 * round(rng.uniform(52.0, 62.0) / 0.1) + 0.05
    spans = [0.1 * round(rng.uniform(9.0, 13.0) / 0.1) for _ in range(2)]
    holds = ((first, first + spans[0]), (later_on, later_on + spans[1]))
    _fork(folder, rng, holds=holds, loggers=(Logger("s", zero=6.0), PLAIN, Logger("ms")))
    return Truth(
        "the ammeter of the second string holds its reading in the second recording, from "
        + " and from ".join(f"{a:.2f} s to {b:.2f} s" for a, b in holds),
        (*RECORDING, *SENSOR),
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    portal_wind,
    axon_null,
    espresso_dry,
    diesel_two,
    wheelset_touches,
    column_null,
    smelter_drift,
    fork_joint,
    portal_null,
    axon_hum,
    smelter_sludge,
    espresso_null,
    diesel_volume,
    wheelset_null,
    column_laden,
    fork_null,
    axon_closes,
    smelter_two,
    portal_swapped,
    wheelset_halted,
    espresso_pressed,
    smelter_null,
    fork_holds,
    column_film,
    diesel_opens,
)
