"""Thirtieth set: an accelerator's cavity, a sputtering chamber, a hybrid rocket, a slab caster, a chair that turns, the
wet end of a paper machine, a freeze dryer, a tassel of coils.

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
from evaluation.strangers.eleventh_set import telegraph
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

#: Fall [m/s^2], pressure of the air [bar].
FALL, AIR = 9.81, 1.013
#: Laws that are true where something is stored of which the model knows nothing.
STORED = ("hidden_state", "hidden_mass", "hidden_capacity", "second_mass", "hidden_storage", "memory", "relaxation")
#: Laws that are true where a number depends on a state.
RATED = ("nonlinear_rate", "rate_of_state", "state_dependent_rate", "parameter_of_state", "interaction")
#: Laws that are true where a field presses its walls, and detunes what holds it.
PRESSED = (
    *STORED,
    *RATED,
    "detuning",
    "feedback",
    "cross_coupling",
    "coupling",
    "nonlinear_stiffness",
    "stiffness_of_state",
    "frequency_of_state",
    "kerr",
)
#: Laws that are true where walls take up a gas until they are full.
GETTERED = (*STORED, *RATED, "leakage", "leak", "nonlinear_leakage", "adsorption", "sorption", "saturation", "loss")
#: Laws that are true where something wears, or grows over, with what has passed it.
WORN = (
    *STORED,
    *RATED,
    "wear",
    "erosion",
    "fouling",
    "clogging",
    "ageing",
    "aging",
    "degradation",
    "drift_of_parameter",
    "gain_of_state",
    "state_dependent_gain",
    "resistance_of_state",
    "growing_resistance",
)
#: Laws that are true where an input does less against what it has built up.
OPPOSED = (
    *RATED,
    "feedback",
    "back_pressure",
    "gain_of_input",
    "gain_of_state",
    "state_dependent_gain",
    "nonlinear_gain",
    "saturation",
    "load_dependence",
)
#: Laws that are true where a nozzle passes more from an instant on.
BROKEN = (*WORN, "step_of_parameter", "conductance_of_time", "parameter_of_time", "gain_of_time")
#: Laws that are true where a brain keeps a signal.
KEPT = (*STORED, "slow_input", "lag", "integrator", "feedback", "adaptation", "delay")
#: Laws that are true where water stands in a corner, and mixes slowly with the rest.
STAGNANT = (*STORED, "exchange", "mixing", "dead_volume", "stagnant_zone", "coupling", "delay", "lag")
#: Laws that are true where less is held back the more there is.
HELD_BACK = (
    *RATED,
    "gain_of_state",
    "state_dependent_gain",
    "nonlinear_gain",
    "nonlinear_loss",
    "quadratic_loss",
    "nonlinear_leakage",
    "feedback",
    "second_order",
)
#: Laws that are true where what covers a body takes heat for a while.
WRAPPED = (*STORED, *RATED, "exchange", "thermal_coupling", "wall_capacity", "hidden_heat_capacity", "heat_loss")


# --- a superconducting cavity of an accelerator, FMI 3 Model Exchange; ms, s, MV, V
CAVITY = OdeModel(
    "cavity",
    {
        "w_h": (1360.0, "1/s"),
        "k_p": (25.0, "1/(V*s)"),
        "d_0": (150.0, "1/s"),
        "g_d": (1.0, ""),
        "tau_p": (2e-3, "s"),
        "tau_k": (2.5e-4, "s"),
    },
    {"drive_i": "V", "drive_q": "V", "tuner": "V"},
    {
        "F_i": ("V", "0.0", "(g_d*drive_i - F_i)/tau_k"),
        "F_q": ("V", "0.0", "(g_d*drive_q - F_q)/tau_k"),
        "d": ("1/s", "d_0", "(d_0 + k_p*tuner - d)/tau_p"),
        "V_i": ("V", "0.0", "w_h*(F_i - V_i) - d*V_q"),
        "V_q": ("V", "0.0", "w_h*(F_q - V_q) + d*V_i"),
    },
    {"probe_i": ("V", "V_i"), "probe_q": ("V", "V_q"), "reflected": ("V", "V_i - F_i")},
    1e-5,
)
CAVITY_KNOWN = {"w_h": 0.04, "k_p": 0.06, "d_0": 0.1, "g_d": 0.02, "tau_p": 0.08, "tau_k": 0.08}


def _cavity(
    folder: Path,
    rng: Rng,
    presses: tuple[float, float, float] = (0.0, 1.0, 1.0),
    is_swapped: bool = False,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The field may press the walls: it detunes by -presses[0] |V|^2 [rad/(s*MV^2)] through a mode of the walls.

    The mode's frequency is presses[1] [rad/s], its damping presses[2]. The columns of the probe may be swapped in the
    second recording.
    """
    build3(CAVITY, folder, has_co_simulation=False)
    names = (("vector_i", "drive_i", "MV"), ("vector_q", "drive_q", "MV"), ("piezo", "tuner", "V"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("module", "cavity")
    wires = "".join(f"  - {c}.{n} -> module.{n}\n" for c, n, _ in names)
    scenario(folder, "A superconducting cavity", 0.36, 1e-4, 3e-4, parts, wires)
    data_sheet(folder, CAVITY, CAVITY_KNOWN)
    w_h, k_p, d_0, g_d, tau_p, tau_k = drawn(rng, CAVITY, CAVITY_KNOWN)
    presses_by, mode, damps = presses

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Fields are in MV; the last two are what the walls detune [rad/s] and its rate over the mode's frequency."""
        f_i, f_q, d, v_i, v_q, pressed, moves = (float(s) for s in x)
        off = d + pressed
        return [
            (g_d * float(u[0]) - f_i) / tau_k,
            (g_d * float(u[1]) - f_q) / tau_k,
            (d_0 + k_p * float(u[2]) - d) / tau_p,
            w_h * (f_i - v_i) - off * v_q,
            w_h * (f_q - v_q) + off * v_i,
            mode * moves,
            -mode * (pressed + presses_by * (v_i**2 + v_q**2)) - 2.0 * damps * mode * moves,
        ]

    def reflected(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(x[:, 3] - x[:, 0])

    for number, (name, stop) in enumerate((("first", 0.36), ("second", 0.27), ("third", 0.3))):
        drive_i = drawn_steps(rng, stop, 6e-3, 2.0, 11.0, 3e-4)
        if name == "third":
            drive_i = telegraph(rng, stop, 6e-3, 2.5, 10.5, 3e-4)
        drive_q = drawn_steps(rng, stop, 8e-3, -5.0, 5.0, 3e-4)
        tuner = drawn_steps(rng, stop, 0.015, -20.0, 20.0, 3e-4)
        drive_i, drive_q, tuner = (later(s, 1e-4) for s in (drive_i, drive_q, tuner))
        t, x = integrated(rates, (0.0, 0.0, d_0, 0.0, 0.0, 0.0, 0.0), (drive_i, drive_q, tuner), stop, 1e-4)
        first, second = (4, 3) if is_swapped and name == "second" else (3, 4)
        sensors = [
            Sensor("module.probe_i", "Probe I", "MV", scaled(first, 1.0), 0.05, 3e-4, noise_stated, 0.01, colour),
            Sensor("module.probe_q", "Probe Q", "MV", scaled(second, 1.0), 0.05, 3e-4, noise_stated, 0.01, colour),
            Sensor("module.reflected", "Refl I", "MV", reflected, 0.08, 3e-4, noise_stated, 0.01, colour),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"vector_i.drive_i": (drive_i, "MV"), "vector_q.drive_q": (drive_q, "MV"), "piezo.tuner": (tuner, "V")},
            loggers[number % len(loggers)],
            recorded=["piezo.tuner"],
        )
        write(folder / name, rng, made)


def cavity_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=12.0), Logger("s", empty=0.02), Logger("ms", zero=-5.0, gap=(0.11, 0.122)))
    _cavity(folder, rng, colour=0.1, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.1 and is stated rightly, a "
        "column of an input, empty cells, a gap of 12 ms, loggers of ms and s, FMI 3",
        FINE,
    )


def cavity_presses(folder: Path, rng: Rng) -> Truth:
    by, mode, damps = rng.uniform(1.6, 2.5), rng.uniform(1250.0, 1600.0), rng.uniform(0.15, 0.25)
    _cavity(folder, rng, presses=(by, mode, damps), loggers=(Logger("ms"), Logger("s", zero=0.5)))
    return Truth(
        f"the field presses the walls (Lorentz's force), and detunes the cavity by -{by:.3f} rad/(s MV^2) |V|^2, "
        f"through a mode of the walls of {mode:.0f} rad/s with a damping of {damps:.3f}",
        PHYSICS,
        PRESSED,
    )


def cavity_swapped(folder: Path, rng: Rng) -> Truth:
    _cavity(folder, rng, is_swapped=True, loggers=(Logger("s"), Logger("ms", zero=3.0), Logger("ms")))
    return Truth(
        "the columns of the probe are swapped in the second recording: what is said to be I is Q, and the other way "
        "round",
        (*RECORDING, *SENSOR),
    )


# --- a chamber of reactive sputtering (Berg 1987), FMI 2 Model Exchange; s, min, mbar L/s, A, mPa, V, nm/s
SPUTTER = OdeModel(
    "sputter",
    {
        "V": (0.05, "m^3"),
        "S": (0.2, "m^3/s"),
        "p_a": (0.35, "Pa"),
        "g_t": (0.05, "m^3/s"),
        "g_s": (0.2, "m^3/s"),
        "a_t": (6.0, "1/(Pa*s)"),
        "b_t": (0.1, "1/(A*s)"),
        "a_s": (3.0, "1/(Pa*s)"),
        "b_s": (0.03, "1/(A*s)"),
        "c_s": (0.09, "1/(A*s)"),
        "U_m": (420.0, "V"),
        "U_d": (130.0, "V"),
        "r_m": (0.6, "nm/(A*s)"),
        "r_o": (0.15, "nm/(A*s)"),
        "tau_i": (0.2, "s"),
        "tau_q": (0.8, "s"),
    },
    {"oxygen": "Pa*m^3/s", "current": "A"},
    {
        "I": ("A", "0.0", "(current - I)/tau_i"),
        "p": ("Pa", "0.0", "(oxygen - S*p - g_t*p*(1.0 - A) - g_s*p*(1.0 - B))/V"),
        "A": ("", "0.0", "a_t*p*(1.0 - A) - b_t*I*A"),
        "B": ("", "0.0", "a_s*p*(1.0 - B) + b_s*I*A*(1.0 - B) - c_s*I*(1.0 - A)*B"),
        "R": ("nm/s", "0.0", "((r_m*(1.0 - A) + r_o*A)*I - R)/tau_q"),
    },
    {"pressure": ("Pa", "p_a + p"), "voltage": ("V", "U_m - U_d*A"), "growth": ("nm/s", "R")},
    5e-3,
)
SPUTTER_KNOWN = {
    "V": 0.02,
    "S": 0.04,
    "p_a": 5e-3,
    "g_t": 0.08,
    "g_s": 0.06,
    "a_t": 0.06,
    "b_t": 0.05,
    "a_s": 0.06,
    "b_s": 0.1,
    "c_s": 0.08,
    "U_m": 5e-3,
    "U_d": 0.04,
    "r_m": 0.03,
    "r_o": 0.06,
    "tau_i": 0.1,
    "tau_q": 0.08,
}


def _sputter(
    folder: Path,
    rng: Rng,
    getters: tuple[float, float, float] = (0.0, 0.0, 1.0),
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    has_idle: bool = False,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Shields may take up oxygen: getters[0] p (1 - w) [m^3/s]; w rises by getters[1] p (1 - w) [1/(Pa*s)].

    Fresh metal buries w within getters[2] [s]. What is said of oxygen in the second recording may be another run's.
    """
    SPUTTER.build(folder)
    parts = programme("mass_flow", ("oxygen", "mbar*L/s")) + programme("generator", ("current", "A"))
    parts += with_numbers("chamber", "sputter")
    wires = "  - mass_flow.oxygen -> chamber.oxygen\n  - generator.current -> chamber.current\n"
    scenario(folder, "A chamber of reactive sputtering", 150.0, 0.05, 0.2, parts, wires)
    data_sheet(folder, SPUTTER, SPUTTER_KNOWN)
    volume, s, p_a, g_t, g_s, a_t, b_t, a_s, b_s, c_s, u_m, u_d, r_m, r_o, tau_i, tau_q = drawn(
        rng, SPUTTER, SPUTTER_KNOWN
    )
    shields, fills, buries = getters

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """The last is how full the shields are."""
        amps, p, at, on, shown, full = (float(v) for v in x)
        return [
            (float(u[1]) - amps) / tau_i,
            (0.1 * float(u[0]) - (s + g_t * (1.0 - at) + g_s * (1.0 - on) + shields * (1.0 - full)) * p) / volume,
            a_t * p * (1.0 - at) - b_t * amps * at,
            a_s * p * (1.0 - on) + b_s * amps * at * (1.0 - on) - c_s * amps * (1.0 - at) * on,
            ((r_m * (1.0 - at) + r_o * at) * amps - shown) / tau_q,
            fills * p * (1.0 - full) - full / buries,
        ]

    def pressure(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(1e3 * (p_a + x[:, 1]))

    def voltage(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(u_m - u_d * x[:, 2])

    for number, (name, stop) in enumerate((("first", 150.0), ("second", 120.0), ("third", 132.0))):
        oxygen = drawn_steps(rng, stop, 6.0, 0.04, 0.3, 0.2)
        other = later(drawn_steps(rng, stop, 6.0, 0.04, 0.3, 0.2), 0.05)
        if name == "third":
            oxygen = stairs(rng, stop, 5.0, 0.05, 0.28, 5, 0.2)
        current = drawn_steps(rng, stop, 8.0, 1.5, 5.0, 0.2)
        oxygen, current = later(oxygen, 0.05), later(current, 0.05)
        t, x = integrated(rates, (0.0,) * 6, (oxygen, current), stop, 0.05)
        sensors = [
            Sensor("chamber.pressure", "p mPa", "mPa", pressure, 0.6, 0.2, noise_stated, 0.1, wild=wild),
            Sensor("chamber.voltage", "U Target", "V", voltage, 1.2, 0.2, noise_stated, 0.5, wild=wild),
            Sensor("chamber.growth", "QCM nm/s", "nm/s", scaled(4, 1.0), 0.02, 0.4, noise_stated, 5e-3, wild=wild),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"mass_flow.oxygen": (oxygen, "mbar*L/s"), "generator.current": (current, "A")},
            loggers[number % len(loggers)],
            recorded=["generator.current"],
            told={"mass_flow.oxygen": other} if is_other and name == "second" else {},
        )
        write(folder / name, rng, made)
        if has_idle:
            idle_column(folder / name, "T Wasser", lambda n: np.asarray(18.2 + 0.1 * (np.arange(n) % 5)))


def sputter_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=30.0, jitter=0.1), Logger("min"), Logger("s", gap=(52.0, 57.0)))
    _sputter(folder, rng, noise_stated=None, wild=0.003, has_idle=True, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, wild readings, two rates, a column of an input, a column "
        "that nobody uses, jitter, a gap of 5 s, loggers of s and min",
        FINE,
    )


def sputter_getters(folder: Path, rng: Rng) -> Truth:
    shields, fills, buries = rng.uniform(0.14, 0.2), rng.uniform(0.8, 1.2), rng.uniform(35.0, 55.0)
    _sputter(folder, rng, getters=(shields, fills, buries), loggers=(PLAIN, Logger("min", zero=1.0)))
    return Truth(
        f"the shields of the chamber take up oxygen, {shields:.4f} m^3/s p as long as they are bare; they fill by "
        f"{fills:.3f}/(Pa s) p, and fresh metal buries what they took within {buries:.1f} s",
        PHYSICS,
        GETTERED,
    )


def sputter_other_run(folder: Path, rng: Rng) -> Truth:
    _sputter(folder, rng, is_other=True, loggers=(Logger("s", zero=-4.0), PLAIN, Logger("min")))
    return Truth(
        "what is said of the flow of oxygen in the second recording is that of another run",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- a hybrid rocket's motor on a stand, FMI 2 Co-Simulation that hides its states; s, ms, g/s, bar, N, degF
_PORT = "(0.25*3.14159265358979*D*D)"
_BURN = f"(a_r*pow(fmax(q, 1e-6)/{_PORT}/100.0, n))"
ROCKET = OdeModel(
    "rocket",
    {
        "tau_v": (0.08, "s"),
        "a_r": (2.6e-4, "m/s"),
        "n": (0.6, ""),
        "rho": (920.0, "kg/m^3"),
        "L": (0.5, "m"),
        "D_begin": (0.06, "m"),
        "c_star": (1500.0, "m/s"),
        "A_t": (2e-4, "m^2"),
        "RT": (1e6, "J/kg"),
        "V_c": (2.5e-3, "m^3"),
        "C_F": (1.35, ""),
        "tau_f": (0.05, "s"),
        "h_n": (2e-3, "1/s"),
        "k_n": (6e-3, "1/s"),
        "T_g": (2900.0, "K"),
        "T_air": (293.15, "K"),
        "q_begin": (0.12, "kg/s"),
        "p_begin": (1e6, "Pa"),
    },
    {"oxidiser": "kg/s"},
    {
        "q": ("kg/s", "q_begin", "(oxidiser - q)/tau_v"),
        "D": ("m", "D_begin", f"2.0*{_BURN}"),
        "p": ("Pa", "p_begin", f"RT/V_c*(q + rho*3.14159265358979*D*L*{_BURN} - p*A_t/c_star)"),
        "F": ("N", "C_F*p_begin*A_t", "(C_F*p*A_t - F)/tau_f"),
        "T": ("K", "T_air", "h_n*pow(fmax(p, 1.0)/2e6, 0.8)*(T_g - T) - k_n*(T - T_air)"),
    },
    {"chamber": ("Pa", "p"), "thrust": ("N", "F"), "nozzle": ("K", "T")},
)
ROCKET_KNOWN = {
    "tau_v": 0.08,
    "a_r": 0.05,
    "n": 0.03,
    "rho": 0.01,
    "L": 5e-3,
    "D_begin": 5e-3,
    "c_star": 0.03,
    "A_t": 0.01,
    "RT": 0.05,
    "V_c": 0.03,
    "C_F": 0.03,
    "tau_f": 0.1,
    "h_n": 0.06,
    "k_n": 0.1,
}


def _rocket(
    folder: Path,
    rng: Rng,
    erodes: float = 0.0,
    feed: float = np.inf,
    short: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The throat may erode: by erodes p [mm^2/(s*bar)]. The flow may fall as the chamber presses against a feed [bar].

    The flow is then that of the valve at a chamber of 14 bar. The second recording's pressure may be too little [bar].
    """
    ROCKET.build(folder)
    parts = programme("valve", ("oxidiser", "g/s")).replace("constant: 0 g/s", "constant: 120 g/s")
    parts += with_numbers("motor", "rocket", "internal")
    scenario(
        folder, "A hybrid rocket's motor on a stand", 36.0, 0.02, 0.04, parts, "  - valve.oxidiser -> motor.oxidiser\n"
    )
    data_sheet(folder, ROCKET, ROCKET_KNOWN)
    tau_v, a_r, n, rho, length, d_begin, c_star, a_t, gas, v_c, c_f, tau_f, h_n, k_n, t_g, t_air, q_begin, p_begin = (
        drawn(rng, ROCKET, ROCKET_KNOWN)
    )

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """The port is in mm, the pressure in bar, the throat in mm^2."""
        q, port, p, thrust, hot, throat = (float(s) for s in x)
        wide = 1e-3 * port
        burns = a_r * (max(q, 1e-6) / (0.25 * np.pi * wide**2) / 100.0) ** n
        flow = 1e-3 * float(u[0])
        if np.isfinite(feed):
            flow *= float(np.sqrt(max(feed - p, 0.0) / (feed - 14.0)))
        fed = q + rho * np.pi * wide * length * burns
        return [
            (flow - q) / tau_v,
            2e3 * burns,
            1e-5 * gas / v_c * (fed - 0.1 * p * throat / c_star),
            (0.1 * c_f * p * throat - thrust) / tau_f,
            h_n * (max(p, 1e-5) / 20.0) ** 0.8 * (t_g - hot) - k_n * (hot - t_air),
            erodes * p,
        ]

    def fahrenheit(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(1.8 * (x[:, 4] - CELSIUS) + 32.0)

    for number, (name, stop) in enumerate((("first", 36.0), ("second", 28.0), ("third", 32.0))):
        oxidiser = drawn_steps(rng, stop, 1.4, 80.0, 260.0, 0.04)
        if name == "third":
            oxidiser = wandering(rng, stop, 1.1, 85.0, 255.0, 0.04)
        oxidiser = later(oxidiser, 0.02)
        start = (q_begin, 1e3 * d_begin, 1e-5 * p_begin, c_f * p_begin * a_t, t_air, 1e6 * a_t)
        t, x = integrated(rates, start, (oxidiser,), stop, 0.01)

        def spoil(column: str, t: Array, v: Array, now: bool = name == "second") -> Array:
            return v - short if now and column == "Pc bar" else v

        sensors = [
            Sensor("motor.chamber", "Pc bar", "bar", scaled(2, 1.0), 0.08, 0.04, noise_stated, 0.01),
            Sensor("motor.thrust", "F N", "N", scaled(3, 1.0), 3.0, 0.04, noise_stated, 0.5),
            Sensor("motor.nozzle", "T nozzle", "degF", fahrenheit, 1.5, 0.2, noise_stated, 0.5),
        ]
        programmes = {"valve.oxidiser": (oxidiser, "g/s")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)], spoil=spoil))


def rocket_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=-200.0, empty=0.02), Logger("s", zero=5.0), Logger("s", gap=(14.0, 15.2)))
    _rocket(folder, rng, noise_stated=1.0 / 3.0, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 3 times too small, degF, two rates, empty cells, a gap of 1.2 s, "
        "loggers of ms and s, Co-Simulation",
        FINE,
    )


def rocket_erodes(folder: Path, rng: Rng) -> Truth:
    erodes = rng.uniform(0.04, 0.06)
    _rocket(folder, rng, erodes=erodes, loggers=(PLAIN, Logger("ms", zero=50.0)))
    return Truth(f"the throat of the nozzle erodes by {erodes:.4f} mm^2/(s bar) p", PHYSICS, WORN)


def rocket_two(folder: Path, rng: Rng) -> Truth:
    erodes, feed = rng.uniform(0.04, 0.06), rng.uniform(38.0, 48.0)
    _rocket(folder, rng, erodes=erodes, feed=feed, loggers=(Logger("s", zero=1.0), Logger("ms")))
    return Truth(
        f"the throat of the nozzle erodes by {erodes:.4f} mm^2/(s bar) p; and the chamber presses against a feed of "
        f"{feed:.2f} bar: the flow is sqrt((feed - p)/(feed - 14 bar)) of the valve's",
        PHYSICS,
        (*WORN, *OPPOSED),
    )


def rocket_gauge(folder: Path, rng: Rng) -> Truth:
    _rocket(folder, rng, short=AIR, loggers=(Logger("s", zero=-1.0), PLAIN, Logger("ms")))
    return Truth(
        f"the pressure of the second recording is that above the air's and not the absolute one: {AIR:.3f} bar too "
        "little",
        (*RECORDING, *SENSOR),
    )


# --- a tundish (FMI 2, Model Exchange) and a slab caster's mould (FMI 2, Co-Simulation); s, min, mm, m/min, t
TUNDISH = OdeModel(
    "tundish",
    {
        "A_t": (3.2, "m^2"),
        "K_t": (0.03, "m^2/s"),
        "q_0": (4.8e-3, "m^3/s"),
        "tau_g": (4.0, "s"),
        "rho": (7000.0, "kg/m^3"),
        "h_begin": (0.9, "m"),
    },
    {"wanted": "m", "drain": "m^3/s"},
    {"q": ("m^3/s", "q_0", "(q_0 + K_t*(wanted - h) - q)/tau_g"), "h": ("m", "h_begin", "(q - drain)/A_t")},
    {"depth": ("m", "h"), "weight": ("kg", "rho*A_t*h")},
    0.02,
)
_NOZZLE = f"c_n*s*sqrt(2.0*{FALL}*fmax(depth + h_n - h, 0.01))"
MOULD = OdeModel(
    "mould",
    {
        "A_m": (0.24, "m^2"),
        "c_n": (0.06, "m"),
        "h_n": (1.2, "m"),
        "K_p": (0.15, ""),
        "K_i": (6e-3, "1/s"),
        "tau_s": (0.4, "s"),
        "tau_y": (0.6, "s"),
        "tau_v": (1.2, "s"),
        "h_begin": (0.8, "m"),
        "s_begin": (0.0158, "m"),
        "v_begin": (0.02, "m/s"),
    },
    {"depth": "m", "level": "m", "casting": "m/s"},
    {
        "v": ("m/s", "v_begin", "(casting - v)/tau_v"),
        "y": ("m", "h_begin", "(h - y)/tau_y"),
        "z": ("m", "s_begin", "K_i*(level - y)"),
        "s": ("m", "s_begin", "(z + K_p*(level - y) - s)/tau_s"),
        "h": ("m", "h_begin", f"({_NOZZLE} - A_m*v)/A_m"),
    },
    {"meniscus": ("m", "y"), "stopper": ("m", "s"), "drain": ("m^3/s", _NOZZLE)},
    0.02,
)
TUNDISH_KNOWN = {"A_t": 0.02, "K_t": 0.06, "q_0": 0.03, "tau_g": 0.1, "rho": 5e-3, "h_begin": 5e-3}
MOULD_KNOWN = {"A_m": 0.01, "c_n": 0.05, "h_n": 0.01, "tau_s": 0.1, "tau_y": 0.08, "tau_v": 0.08, "h_begin": 1e-3}


def _casting(
    folder: Path,
    rng: Rng,
    clogs: float = 0.0,
    breaks: tuple[float, float] = (np.inf, 0.0),
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Two FMUs; alumina may clog the nozzle: by a share of clogs for every cubic metre that has passed.

    Its mouth may break from an instant [s] of the second recording on, and pass that share more.
    """
    TUNDISH.build(folder)
    MOULD.build(folder)
    data_sheet(folder, TUNDISH, TUNDISH_KNOWN)
    (folder / "numbers.yaml").rename(folder / "tundish.yaml")
    data_sheet(folder, MOULD, MOULD_KNOWN)
    parts = (
        programme("ladle", ("wanted", "mm")).replace("constant: 0 mm", "constant: 900 mm")
        + programme("panel", ("level", "mm")).replace("constant: 0 mm", "constant: 800 mm")
        + programme("rolls", ("casting", "m/min")).replace("constant: 0 m/min", "constant: 1.2 m/min")
        + with_numbers("tundish", "tundish").replace("numbers.yaml", "tundish.yaml")
        + with_numbers("mould", "mould", "internal")
    )
    wires = "  - ladle.wanted -> tundish.wanted\n  - panel.level -> mould.level\n  - rolls.casting -> mould.casting\n"
    wires += "  - tundish.depth -> mould.depth\n  - mould.drain -> tundish.drain\n"
    scenario(folder, "A slab caster", 360.0, 0.1, 0.4, parts, wires)
    a_t, k_t, q_0, tau_g, rho, depth_begin = drawn(rng, TUNDISH, TUNDISH_KNOWN)
    a_m, c_n, h_n, k_p, k_i, tau_s, tau_y, tau_v, h_begin, s_begin, v_begin = drawn(rng, MOULD, MOULD_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Levels and lifts are in mm, flows in L/s, speeds in mm/s; the last is the share that is clogged."""
        q, depth, v, shown, keeps, lift, level, clogged = (float(s) for s in x)
        head = max(1e-3 * (depth - level) + h_n, 0.01)
        drain = c_n * lift * float(np.sqrt(2.0 * FALL * head)) * (1.0 - clogged) * float(u[3])
        off = float(u[1]) - shown
        return [
            (1e3 * q_0 + k_t * (float(u[0]) - depth) - q) / tau_g,
            (q - drain) / a_t,
            (1e3 / 60.0 * float(u[2]) - v) / tau_v,
            (level - shown) / tau_y,
            k_i * off,
            (keeps + k_p * off - lift) / tau_s,
            drain / a_m - v,
            1e-3 * clogs * drain,
        ]

    for number, (name, stop) in enumerate((("first", 360.0), ("second", 280.0), ("third", 320.0))):
        casting = drawn_steps(rng, stop, 14.0, 0.9, 1.5, 0.4)
        if name == "third":
            casting = telegraph(rng, stop, 13.0, 0.95, 1.45, 0.4)
        wanted = drawn_steps(rng, stop, 60.0, 800.0, 1000.0, 0.4)
        level = drawn_steps(rng, stop, 35.0, 785.0, 815.0, 0.4)
        casting, wanted, level = (later(s, 0.1) for s in (casting, wanted, level))
        passes = Steps((0.0,), (1.0,))
        if name == "second" and np.isfinite(breaks[0]):
            passes = Steps((0.0, breaks[0]), (1.0, 1.0 + breaks[1]))
        start = (
            1e3 * q_0,
            1e3 * depth_begin,
            1e3 * v_begin,
            1e3 * h_begin,
            1e3 * s_begin,
            1e3 * s_begin,
            1e3 * h_begin,
            0.0,
        )
        t, x = integrated(rates, start, (wanted, level, casting, passes), stop, 0.1)
        sensors = [
            Sensor("tundish.weight", "Verteiler t", "t", scaled(1, 1e-6 * rho * a_t), 0.04, 0.8, noise_stated, 0.01),
            Sensor("mould.meniscus", "Badspiegel mm", "mm", scaled(3, 1.0), 0.5, 0.4, noise_stated, 0.1),
            Sensor("mould.stopper", "Stopfen mm", "mm", scaled(5, 1.0), 0.06, 0.4, noise_stated, 0.01),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"ladle.wanted": (wanted, "mm"), "panel.level": (level, "mm"), "rolls.casting": (casting, "m/min")},
            loggers[number % len(loggers)],
            recorded=["rolls.casting"],
        )
        write(folder / name, rng, made)


def casting_null(folder: Path, rng: Rng) -> Truth:
    loggers = (
        Logger("s", zero=90.0, is_comma=True),
        Logger("min", is_comma=True, empty=0.02),
        Logger("s", is_comma=True, gap=(130.0, 142.0)),
    )
    _casting(folder, rng, noise_stated=0.95, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.05 times too small, two rates, a column of an input, decimal "
        "commas, empty cells, a gap of 12 s, loggers of s and min, two FMUs",
        FINE,
    )


def casting_clogs(folder: Path, rng: Rng) -> Truth:
    clogs = rng.uniform(0.06, 0.1)
    _casting(folder, rng, clogs=clogs, loggers=(PLAIN, Logger("min", zero=2.0)))
    return Truth(
        f"alumina clogs the nozzle of the mould: {clogs:.4f} of it for every cubic metre of steel that has passed",
        PHYSICS,
        WORN,
    )


def casting_breaks(folder: Path, rng: Rng) -> Truth:
    since, more = 0.4 * round(rng.uniform(90.0, 140.0) / 0.4), rng.uniform(0.07, 0.11)
    _casting(folder, rng, breaks=(since, more), loggers=(Logger("s", zero=3.0), PLAIN, Logger("min")))
    return Truth(
        f"the mouth of the nozzle breaks at {since:.1f} s of the second recording, and passes {100.0 * more:.2f} % "
        "more at the same lift from then on; in the others it is whole",
        (*PHYSICS, *RECORDING, *SENSOR),
        BROKEN,
    )


# --- a person on a chair that turns, FMI 2 Model Exchange, without units and with its keeper's names; s, ms, min
CHAIR = OdeModel(
    "vestibolo_2",
    {
        "tau_sedia": (0.15, ""),
        "tau_cupola": (5.0, ""),
        "g_vor": (0.7, ""),
        "k_okr": (0.6, ""),
        "tau_okr": (0.3, ""),
        "tau_occhio": (0.08, ""),
        "k_eog": (0.18, ""),
        "tau_eog": (0.1, ""),
    },
    {"Sedia": "", "Tamburo": ""},
    {
        "w": ("", "0.0", "(Sedia - w)/tau_sedia"),
        "z": ("", "0.0", "(w - z)/tau_cupola"),
        "o": ("", "0.0", "(k_okr*(Tamburo - w - e) - o)/tau_okr"),
        "e": ("", "0.0", "(-g_vor*(w - z) + o - e)/tau_occhio"),
        "q": ("", "0.0", "(k_eog*e - q)/tau_eog"),
    },
    {"Occhio": ("", "e"), "EOG": ("", "q"), "Tachimetro": ("", "w")},
    2e-3,
)
CHAIR_KNOWN = {
    "tau_sedia": 0.08,
    "tau_cupola": 0.08,
    "g_vor": 0.06,
    "k_okr": 0.08,
    "tau_okr": 0.08,
    "tau_occhio": 0.1,
    "k_eog": 0.04,
    "tau_eog": 0.1,
}


def _chair(
    folder: Path,
    rng: Rng,
    keeps: tuple[float, float] = (0.0, 1.0),
    is_reversed: bool = False,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The brain may keep what the canals say: keeps[0] times it, with a time constant keeps[1] [s].

    The drum may turn the other way than is said in the second recording.
    """
    CHAIR.build(folder)
    names = (("Motore_1", "Sedia"), ("Motore_2", "Tamburo"))
    parts = "".join(programme(c, (n, "")) for c, n in names) + with_numbers("Persona", "vestibolo_2")
    wires = "".join(f"  - {c}.{n} -> Persona.{n}\n" for c, n in names)
    scenario(folder, "Una persona sulla sedia rotante", 140.0, 0.02, 0.1, parts, wires)
    data_sheet(folder, CHAIR, CHAIR_KNOWN)
    tau_w, tau_c, g_vor, k_okr, tau_o, tau_e, k_eog, tau_q = drawn(rng, CHAIR, CHAIR_KNOWN)
    stores, lasts = keeps

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """The last is what the brain keeps."""
        w, z, o, e, q, kept = (float(s) for s in x)
        return [
            (float(u[0]) - w) / tau_w,
            (w - z) / tau_c,
            (k_okr * (float(u[1]) - w - e) - o) / tau_o,
            (-g_vor * (w - z) + kept + o - e) / tau_e,
            (k_eog * e - q) / tau_q,
            (-stores * g_vor * (w - z) - kept) / lasts,
        ]

    for number, (name, stop) in enumerate((("first", 140.0), ("second", 110.0), ("third", 124.0))):
        turns = drawn_steps(rng, stop, 9.0, -70.0, 70.0, 0.1)
        if name == "third":
            turns = telegraph(rng, stop, 7.0, -55.0, 55.0, 0.1)
        drum = drawn_steps(rng, stop, 4.0, -45.0, 45.0, 0.1)
        turns, drum = later(turns, 0.04), later(drum, 0.04)
        t, x = integrated(rates, (0.0,) * 6, (turns, drum), stop, 0.02)
        told = {}
        if is_reversed and name == "second":
            told = {"Motore_2.Tamburo": Steps(drum.times, tuple(-v for v in drum.levels))}
        sensors = [
            Sensor("Persona.Occhio", "Occhio lento", "1", scaled(3, 1.0), 0.6, 0.1, noise_stated, 0.1, colour),
            Sensor("Persona.EOG", "EOG", "1", scaled(4, 1.0), 0.15, 0.1, noise_stated, 0.05, colour),
            Sensor("Persona.Tachimetro", "Tacho", "1", scaled(0, 1.0), 0.6, 0.2, noise_stated, 0.1, colour),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"Motore_1.Sedia": (turns, ""), "Motore_2.Tamburo": (drum, "")},
            loggers[number % len(loggers)],
            told=told,
        )
        write(folder / name, rng, made)


def chair_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=-8.0), Logger("ms", zero=1000.0, jitter=0.1), Logger("min", gap=(60.0, 64.0)))
    _chair(folder, rng, colour=0.15, noise_stated=1.05, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.15 and is stated 1.05 times "
        "too large, no units, two rates, jitter, a gap of 4 s, loggers of s, ms and min",
        FINE,
    )


def chair_keeps(folder: Path, rng: Rng) -> Truth:
    stores, lasts = rng.uniform(1.6, 2.4), rng.uniform(12.0, 18.0)
    _chair(folder, rng, keeps=(stores, lasts), noise_stated=None, loggers=(PLAIN, Logger("ms")))
    return Truth(
        f"the brain keeps what the canals say (storage of velocity), {stores:.3f} times it with a time constant of "
        f"{lasts:.2f} s, and moves the eye by it as well; noise is not stated",
        PHYSICS,
        KEPT,
    )


def chair_reversed(folder: Path, rng: Rng) -> Truth:
    _chair(folder, rng, is_reversed=True, loggers=(Logger("ms"), Logger("s", zero=20.0), PLAIN))
    return Truth(
        "the drum turned the other way in the second recording: what is said of its speed has the opposite sign",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- the wet end of a paper machine, FMI 2 Co-Simulation that hides its states; min, h, s, L/s, g/s, m/min, g/L, g/m^2
_FINES = "(r_0 + r_1*a/(a + a_h))"
PAPER = OdeModel(
    "wet_end",
    {
        "Q_h": (0.5, "m^3/s"),
        "V_h": (5.0, "m^3"),
        "V_w": (60.0, "m^3"),
        "c_x": (26.0, "kg/m^3"),
        "c_f": (9.0, "kg/m^3"),
        "R_x": (0.93, ""),
        "r_0": (0.3, ""),
        "r_1": (0.45, ""),
        "a_h": (0.01, "kg/s"),
        "tau_a": (25.0, "s"),
        "tau_q": (10.0, "s"),
        "tau_b": (20.0, "s"),
        "b": (5.0, "m"),
        "X_begin": (4.5, "kg/m^3"),
        "F_begin": (3.3, "kg/m^3"),
        "a_begin": (0.01, "kg/s"),
        "q_begin": (0.08, "m^3/s"),
        "B_begin": (0.05, "kg/m^2"),
    },
    {"stock": "m^3/s", "aid": "kg/s", "wire": "m/s"},
    {
        "q": ("m^3/s", "q_begin", "(stock - q)/tau_q"),
        "a": ("kg/s", "a_begin", "(aid - a)/tau_a"),
        "X": ("kg/m^3", "X_begin", "(q*c_x + (Q_h - q)*Y - Q_h*X)/V_h"),
        "F": ("kg/m^3", "F_begin", "(q*c_f + (Q_h - q)*G - Q_h*F)/V_h"),
        "Y": ("kg/m^3", "(1.0 - R_x)*X_begin", "Q_h*((1.0 - R_x)*X - Y)/V_w"),
        "G": ("kg/m^3", "0.5*F_begin", f"Q_h*((1.0 - {_FINES})*F - G)/V_w"),
        "B": ("kg/m^2", "B_begin", f"(Q_h*(R_x*X + {_FINES}*F)/(b*fmax(wire, 1.0)) - B)/tau_b"),
    },
    {"headbox": ("kg/m^3", "X + F"), "white": ("kg/m^3", "Y + G"), "basis": ("kg/m^2", "B")},
    0.5,
)
PAPER_KNOWN = {
    "Q_h": 0.02,
    "V_h": 0.05,
    "V_w": 0.05,
    "c_x": 0.02,
    "c_f": 0.04,
    "R_x": 0.01,
    "r_0": 0.05,
    "r_1": 0.06,
    "a_h": 0.08,
    "tau_a": 0.1,
    "tau_q": 0.1,
    "tau_b": 0.08,
    "X_begin": 0.02,
    "F_begin": 0.02,
}


def _paper(
    folder: Path,
    rng: Rng,
    stands: tuple[float, float] = (0.0, 1.0),
    slips: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """A corner of the silo may stand: stands[0] passes between it and the rest [m^3/s], it holds stands[1] [m^3].

    Fewer fines may be held back the more there are in the white water: slips of them for each g/L above 1.2 g/L.
    """
    PAPER.build(folder)
    names = (("valve", "stock", "L/s"), ("doser", "aid", "g/s"), ("machine", "wire", "m/min"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("paper", "wet_end", "internal")
    for zero, begin in (("0 L/s", "80 L/s"), ("0 g/s", "10 g/s"), ("0 m/min", "600 m/min")):
        parts = parts.replace(f"constant: {zero}", f"constant: {begin}")
    wires = "".join(f"  - {c}.{n} -> paper.{n}\n" for c, n, _ in names)
    scenario(folder, "The wet end of a paper machine", 12600.0, 5, 15, parts, wires)
    data_sheet(folder, PAPER, PAPER_KNOWN)
    q_h, v_h, v_w, c_x, c_f, r_x, r_0, r_1, a_h, tau_a, tau_q, tau_b, b, x_begin, f_begin, *more = drawn(
        rng, PAPER, PAPER_KNOWN
    )
    a_begin, q_begin, b_begin = more
    passes, holds = stands

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Flows are in m^3/s and g/s, consistencies in g/L, paper in g/m^2; the last two stand in the corner."""
        q, a, fibre, fines, white_x, white_f, basis, corner_x, corner_f = (float(s) for s in x)
        held = (r_0 + r_1 * a / (a + 1e3 * a_h)) * (1.0 - slips * (white_f - 1.2))
        return [
            (1e-3 * float(u[0]) - q) / tau_q,
            (float(u[1]) - a) / tau_a,
            (q * c_x + (q_h - q) * white_x - q_h * fibre) / v_h,
            (q * c_f + (q_h - q) * white_f - q_h * fines) / v_h,
            (q_h * ((1.0 - r_x) * fibre - white_x) + passes * (corner_x - white_x)) / v_w,
            (q_h * ((1.0 - held) * fines - white_f) + passes * (corner_f - white_f)) / v_w,
            (1e3 * q_h * (r_x * fibre + held * fines) / (b * float(u[2]) / 60.0) - basis) / tau_b,
            passes * (white_x - corner_x) / holds,
            passes * (white_f - corner_f) / holds,
        ]

    def summed(first: int, second: int) -> Callable[[Array, Array, Array], Array]:
        return lambda t, x, u: np.asarray(x[:, first] + x[:, second])

    for number, (name, stop) in enumerate((("first", 12600.0), ("second", 9900.0), ("third", 10800.0))):
        stock = drawn_steps(rng, stop, 500.0, 55.0, 110.0, 15.0)
        aid = drawn_steps(rng, stop, 700.0, 2.0, 30.0, 15.0)
        if name == "third":
            stock = stairs(rng, stop, 450.0, 58.0, 106.0, 5, 15.0)
            aid = bursts(rng, stop, 500.0, 800.0, 8.0, 28.0, 15.0)
        wire = ramped(rng, stop, 2400.0, 520.0, 690.0, 60.0)
        stock, aid = later(stock, 5.0), later(aid, 5.0)
        white = ((1.0 - r_x) * x_begin, 0.5 * f_begin)
        start = (q_begin, 1e3 * a_begin, x_begin, f_begin, *white, 1e3 * b_begin, *white)
        t, x = integrated(rates, start, (stock, aid, wire), stop, 5.0)
        sensors = [
            Sensor("paper.headbox", "Stoffauflauf g/L", "g/L", summed(2, 3), 0.03, 15.0, noise_stated, 0.01),
            Sensor("paper.white", "Siebwasser g/L", "g/L", summed(4, 5), 0.015, 30.0, noise_stated, 0.01),
            Sensor("paper.basis", "Flächengewicht", "g/m^2", scaled(6, 1.0), 0.5, 15.0, noise_stated, 0.1),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"valve.stock": (stock, "L/s"), "doser.aid": (aid, "g/s"), "machine.wire": (wire, "m/min")},
            loggers[number % len(loggers)],
            recorded=["machine.wire"],
        )
        write(folder / name, rng, made)


def paper_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=60.0), Logger("h", zero=6.0, empty=0.03), Logger("s", gap=(4800.0, 5280.0)))
    _paper(folder, rng, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated rightly, two rates, a column of an input, empty cells, a gap of "
        "8 min, loggers of min, h and s, Co-Simulation",
        FINE,
    )


def paper_stands(folder: Path, rng: Rng) -> Truth:
    passes, holds = rng.uniform(0.12, 0.18), rng.uniform(60.0, 80.0)
    _paper(folder, rng, stands=(passes, holds), loggers=(Logger("min"), Logger("s", zero=-120.0)))
    return Truth(
        f"white water stands in a corner of the silo that holds {holds:.2f} m^3, and exchanges {passes:.4f} m^3/s with "
        "the rest",
        PHYSICS,
        STAGNANT,
    )


def paper_two(folder: Path, rng: Rng) -> Truth:
    passes, holds, slips = rng.uniform(0.12, 0.18), rng.uniform(60.0, 80.0), rng.uniform(0.14, 0.2)
    _paper(folder, rng, stands=(passes, holds), slips=slips, loggers=(Logger("s", zero=5.0), Logger("min", jitter=0.1)))
    return Truth(
        f"white water stands in a corner of the silo that holds {holds:.2f} m^3, and exchanges {passes:.4f} m^3/s with "
        f"the rest; and the wire holds back {slips:.4f} fewer of the fines for each g/L of them in the white water "
        "above 1.2 g/L",
        PHYSICS,
        (*STAGNANT, *HELD_BACK),
    )


# --- a freeze dryer, FMI 2 Model Exchange; min, h, degC, ubar, g/h
_ICE = "exp(28.916 - 6145.0/fmax(T, 150.0))"
DRYER = OdeModel(
    "freeze_dryer",
    {
        "A": (0.5, "m^2"),
        "C": (2.2e4, "J/(m^2*K)"),
        "K_c": (8.0, "W/(m^2*K)"),
        "K_p": (1.2, "W/(m^2*K*Pa)"),
        "U_w": (0.5, "W/(m^2*K)"),
        "T_w": (288.15, "K"),
        "R_p": (2e5, "m/s"),
        "H": (2.84e6, "J/kg"),
        "tau_s": (180.0, "s"),
        "tau_p": (30.0, "s"),
        "tau_m": (25.0, "s"),
        "S_begin": (253.15, "K"),
        "T_begin": (238.15, "K"),
        "p_begin": (10.0, "Pa"),
    },
    {"shelf": "K", "pressure": "Pa"},
    {
        "S": ("K", "S_begin", "(shelf - S)/tau_s"),
        "p": ("Pa", "p_begin", "(pressure - p)/tau_p"),
        "T": ("K", "T_begin", f"((K_c + K_p*p)*(S - T) + U_w*(T_w - T) - H*({_ICE} - p)/R_p)/C"),
        "m": ("kg/s", "0.0", f"(A*({_ICE} - p)/R_p - m)/tau_m"),
    },
    {"product": ("K", "T"), "plate": ("K", "S"), "vapour": ("kg/s", "m")},
    1.0,
)
DRYER_KNOWN = {
    "A": 0.01,
    "C": 0.04,
    "K_c": 0.06,
    "K_p": 0.06,
    "U_w": 0.15,
    "R_p": 0.08,
    "tau_s": 0.08,
    "tau_p": 0.1,
    "tau_m": 0.1,
    "S_begin": 1e-3,
    "T_begin": 1e-3,
}


def _lyo(
    folder: Path,
    rng: Rng,
    cakes: float = 0.0,
    slow: float = 0.0,
    stopped: tuple[float, float, float] | None = None,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> None:
    """The dry cake may resist more the thicker it is: R_p (1 + cakes l/(1 + l/4 mm)), cakes in 1/mm.

    The clock of the second recording may be slow, by that share. The shelf's cooler may have stopped in it: from when
    to when [s], and at what temperature of the fluid [degC].
    """
    DRYER.build(folder)
    parts = programme("cooler", ("shelf", "degC")).replace("constant: 0 degC", "constant: -20 degC")
    parts += programme("bleed", ("pressure", "ubar")).replace("constant: 0 ubar", "constant: 100 ubar")
    parts += with_numbers("dryer", "freeze_dryer")
    wires = "  - cooler.shelf -> dryer.shelf\n  - bleed.pressure -> dryer.pressure\n"
    scenario(folder, "A freeze dryer", 28800.0, 10, 30, parts, wires)
    data_sheet(folder, DRYER, DRYER_KNOWN)
    area, c, k_c, k_p, u_w, t_w, r_p, heat, tau_s, tau_p, tau_m, s_begin, t_begin, p_begin = drawn(
        rng, DRYER, DRYER_KNOWN
    )

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """The flow of vapour is in g/h, the last is the thickness of the dry cake [mm]."""
        plate, p, product, shown, thick = (float(s) for s in x)
        resists = r_p * (1.0 + cakes * thick / (1.0 + thick / 4.0))
        leaves = (float(np.exp(28.916 - 6145.0 / product)) - p) / resists
        return [
            (float(u[0]) + CELSIUS - plate) / tau_s,
            (0.1 * float(u[1]) - p) / tau_p,
            ((k_c + k_p * p) * (plate - product) + u_w * (t_w - product) - heat * leaves) / c,
            (3.6e6 * area * leaves - shown) / tau_m,
            1e3 * leaves / 870.0,
        ]

    for number, (name, stop) in enumerate((("first", 28800.0), ("second", 21600.0), ("third", 25200.0))):
        shelf = drawn_steps(rng, stop, 1600.0, -32.0, 4.0, 30.0)
        if name == "third":
            shelf = wandering(rng, stop, 1200.0, -30.0, 3.0, 30.0)
        bleed = drawn_steps(rng, stop, 1300.0, 50.0, 160.0, 30.0)
        shelf, bleed = later(shelf, 10.0), later(bleed, 10.0)
        stands = shelf
        if stopped is not None and name == "second":
            at = stopped[2]
            stands = between(shelf, stopped[0], stopped[1], lambda v, at=at: at)  # type: ignore[misc]
        t, x = integrated(rates, (s_begin, p_begin, t_begin, 0.0, 0.0), (stands, bleed), stop, 10.0)
        logger = loggers[number % len(loggers)]
        if slow and name == "second":
            logger = Logger(logger.unit, logger.zero, 1.0 - slow, logger.jitter)
        sensors = [
            Sensor("dryer.product", "T Produkt", "degC", celsius(2), 0.15, 30.0, noise_stated, 0.05),
            Sensor("dryer.plate", "T Platte", "degC", celsius(0), 0.2, 60.0, noise_stated, 0.1),
            Sensor("dryer.vapour", "Dampf g/h", "g/h", scaled(3, 1.0), 1.0, 30.0, noise_stated, 0.2),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"cooler.shelf": (stands, "degC"), "bleed.pressure": (bleed, "ubar")},
            logger,
            recorded=["bleed.pressure"],
            told={"cooler.shelf": shelf},
        )
        write(folder / name, rng, made)


def lyo_cakes(folder: Path, rng: Rng) -> Truth:
    cakes = rng.uniform(0.35, 0.55)
    _lyo(folder, rng, cakes=cakes, noise_stated=1.0 / 3.0, loggers=(Logger("h"), Logger("min", zero=30.0)))
    return Truth(
        f"the cake that has dried resists the vapour: R_p (1 + {cakes:.4f}/mm l/(1 + l/4 mm)), with its thickness l; "
        "noise is stated 3 times too small",
        PHYSICS,
        WORN,
    )


def lyo_clock(folder: Path, rng: Rng) -> Truth:
    slow = rng.uniform(6e-3, 9e-3)
    _lyo(folder, rng, slow=slow, loggers=(Logger("min", zero=10.0), Logger("s"), Logger("h")))
    return Truth(f"the clock of the second recording is slow by {100.0 * slow:.3f} %", (*RECORDING, *SENSOR))


def lyo_stopped(folder: Path, rng: Rng) -> Truth:
    begin = 30.0 * round(rng.uniform(6000.0, 8000.0) / 30.0)
    end, at = begin + 30.0 * round(rng.uniform(4500.0, 6500.0) / 30.0), rng.uniform(3.0, 6.0)
    _lyo(folder, rng, stopped=(begin, end, at), loggers=(Logger("min"), Logger("h", zero=1.0), Logger("s")))
    return Truth(
        f"the cooler of the shelf stopped in the second recording from {begin:.0f} s to {end:.0f} s, its fluid was at "
        f"{at:.2f} degC, and the shelf is said to have been cooled as it was set",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- a tassel of coils at one supply: one behind a ballast, two, one; the tool's own units
TASSEL = {
    "reference_resistance": (2.2, "ohm", 0.02, 0.02),
    "heat_transfer_coefficient": (75.0, "W/(m^2*K)", 0.05, 0.02),
    "area": (140.0, "mm^2", 0.0, 0.0),
    "volume": (11.0, "mm^3", 0.0, 0.0),
    "density": (6450.0, "kg/m^3", 0.0, 0.0),
    "specific_heat": (720.0, "J/(kg*K)", 0.05, 0.02),
}
#: Coils in series, resistances of wires, ballasts, and the supply [ohm].
TASSEL_STRINGS, TASSEL_WIRES, TASSEL_BALLAST, TASSEL_INNER = (1, 2, 1), 0.15, (1.1, 0.0, 1.4), 0.25
#: Limit of the supply [A], rise of resistance [1/K], temperature that the numbers are for [degC].
TASSEL_LIMIT, TASSEL_RISE, TASSEL_COLD = 2.6, 8e-4, 22.0


def _tassel_files(folder: Path) -> None:
    """Scenario and parameter set of the four coils."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = ["title: Coils of a tassel", "parameters:"]
    for name, (value, unit, uncertainty, scatter) in TASSEL.items():
        known = f"uncertainty: {uncertainty:g}, scatter: {scatter:g}"
        lines.append(f'  {name}: {{value: {value:g}, unit: {unit}, source: "own measurement", {known}}}')
    lines += [
        '  use_regressed_cooling_rate: {value: false, source: "cools as it heats"}',
        f'  initial_temperature: {{value: {TASSEL_COLD:g}, unit: degC, source: "room"}}',
        f'  reference_temperature: {{value: {TASSEL_COLD:g}, unit: degC, source: "room"}}',
        f'  resistance_temperature_coefficient: {{value: {TASSEL_RISE:g}, unit: 1/K, source: "own measurement"}}',
    ]
    (folder / "numbers.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    elements = [f"{{kind: current_limit, supply: 1, limit: {TASSEL_LIMIT} A, share: 1}}"]
    elements += [
        f"{{kind: contact, string: {s}, resistance: {ohm} ohm}}" for s, ohm in enumerate(TASSEL_BALLAST, start=1) if ohm
    ]
    parts = (
        programme("bench", ("voltage", "V"))
        + programme("room", ("temperature", "degC")).replace("constant: 0 degC", f"constant: {TASSEL_COLD:g} degC")
        + f"  circuit:\n    kind: ngspice\n    strings: [{', '.join(str(n) for n in TASSEL_STRINGS)}]\n"
        f"    supply: common\n    supply_resistance: {TASSEL_INNER} ohm\n    string_resistance: {TASSEL_WIRES} ohm\n"
        "    elements:\n"
        + "".join(f"      - {e}\n" for e in elements)
        + f"    start: {{resistance: {TASSEL['reference_resistance'][0]} ohm}}\n"
        "  coils: {kind: actuator, fmu: thermal_stiffness, electrical: circuit, ambient: room, "
        "parameter_set: numbers.yaml}\n"
    )
    scenario(folder, "A tassel of coils", 110.0, 0.05, 0.1, parts, "  - bench.voltage -> circuit.supply_voltage\n")


def _tassel_off(rng: Rng, name: str) -> Array:
    """A number of each coil as it is."""
    value, _, uncertainty, scatter = TASSEL[name]
    return np.asarray(value * np.exp(uncertainty * rng.normal() + scatter * rng.normal(size=sum(TASSEL_STRINGS))))


def _tassel_course(
    numbers: Sequence[Array],
    volts: Steps,
    room: Steps,
    start: float,
    stop: float,
    step: float,
    sleeve: tuple[float, float],
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
        sleeve: Between the second coil and its sleeve [W/K], and what that holds [J/K].
    """
    cold, loses, holds = numbers
    passes, keeps = sleeve
    times: Array = step * np.arange(round(stop / step) + 1, dtype=np.float64)
    emf, around = volts.at(times), room.at(times)
    string = np.repeat(np.arange(len(TASSEL_STRINGS)), TASSEL_STRINGS)

    def currents(hot: Array, v: float) -> tuple[Array, float]:
        ohms = np.bincount(string, hot) + TASSEL_WIRES + np.asarray(TASSEL_BALLAST)
        together = float(np.sum(1.0 / ohms))
        terminal = min(v / (TASSEL_INNER + 1.0 / together), TASSEL_LIMIT) / together
        return np.asarray(terminal / ohms), terminal

    def relaxed(warm: Array, at: Array, wrapped: float, v: float, outside: float, span: float) -> Array:
        hot = cold * (1.0 + TASSEL_RISE * (at - TASSEL_COLD))
        given = currents(hot, v)[0][string] ** 2 * hot
        given[1] -= passes * (at[1] - wrapped)
        end = outside + given / loses
        return np.asarray(end + (warm - end) * np.exp(-loses * span / holds))

    warm, wrapped = np.full(len(string), start), start
    found = np.empty((len(times), len(string) + len(TASSEL_STRINGS) + 1))
    for i, (v, outside) in enumerate(zip(emf, around)):
        amps, terminal = currents(cold * (1.0 + TASSEL_RISE * (warm - TASSEL_COLD)), float(v))
        found[i] = (*warm, *amps, terminal)
        middle = relaxed(warm, warm, wrapped, float(v), float(outside), step / 2)
        half = wrapped + 0.5 * step * passes * (float(warm[1]) - wrapped) / keeps
        warm = relaxed(warm, middle, half, float(v), float(outside), step)
        wrapped += step * passes * (float(middle[1]) - half) / keeps
    return times, found


def _tassel(
    folder: Path,
    rng: Rng,
    sleeve: tuple[float, float] = (0.0, 1.0),
    stuck: tuple[float, float] = (np.inf, np.inf),
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The second coil may have a sleeve that loses nothing but to the coil: what passes [W/K], what it holds [J/K].

    The thermometer of the third coil may be stuck in the second recording: from when to when [s].
    """
    _tassel_files(folder)
    conductance = 1e-6 * _tassel_off(rng, "area") * _tassel_off(rng, "heat_transfer_coefficient")
    capacity = 1e-9 * _tassel_off(rng, "density") * _tassel_off(rng, "volume") * _tassel_off(rng, "specific_heat")
    numbers = (_tassel_off(rng, "reference_resistance"), conductance, capacity)

    for number, (name, stop) in enumerate((("first", 110.0), ("second", 90.0), ("third", 100.0))):
        volts = drawn_steps(rng, stop, 6.0, 0.0, 4.2, 0.1)
        if name == "third":
            volts = bursts(rng, stop, 4.0, 7.0, 1.0, 4.0, 0.1)
        volts = later(volts, 0.05)
        room = ramped(rng, stop, 30.0, 20.5, 24.5, 0.5)
        said = room.levels[0]
        t, x = _tassel_course(numbers, volts, room, said + 0.2 * float(rng.normal()), stop, 0.0125, sleeve)

        def spoil(column: str, t: Array, v: Array, now: bool = name == "second") -> Array:
            begin, end = stuck
            is_held = (t >= begin) & (t < end)
            return np.where(is_held, v[np.argmax(is_held)], v) if now and column == "T3" else v

        sensors = [
            Sensor(f"string[{s}].current", f"I{s} mA", "mA", scaled(3 + s, 1e3), 1.5, 0.1, noise_stated, 0.5)
            for s in (1, 2, 3)
        ]
        sensors += [Sensor("supply.voltage", "U mV", "mV", scaled(7, 1e3), 6.0, 0.1, noise_stated, 2.0)]
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


def tassel_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=300.0), Logger("s", zero=4.0, empty=0.02), Logger("s", gap=(37.0, 40.0)))
    _tassel(folder, rng, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, coil by coil too, start off by 0.2 K (deviation), noise stated rightly, two "
        "rates, a column of an input, empty cells, a gap of 3 s, loggers of ms and s",
        FINE,
    )


def tassel_sleeve(folder: Path, rng: Rng) -> Truth:
    passes, keeps = rng.uniform(5e-3, 7e-3), rng.uniform(0.08, 0.12)
    _tassel(folder, rng, sleeve=(passes, keeps), loggers=(PLAIN, Logger("ms", zero=-40.0)))
    return Truth(
        f"the second coil has a sleeve that takes heat and gives it back: {1e3 * passes:.3f} mW/K pass, and it holds "
        f"{1e3 * keeps:.2f} mJ/K",
        PHYSICS,
        WRAPPED,
    )


def tassel_stuck(folder: Path, rng: Rng) -> Truth:
    begin = 0.2 * round(rng.uniform(25.0, 35.0) / 0.2)
    end = begin + 0.2 * round(rng.uniform(18.0, 28.0) / 0.2)
    _tassel(folder, rng, stuck=(begin, end), loggers=(Logger("s", zero=1.0), PLAIN, Logger("ms")))
    return Truth(
        f"the thermometer of the third coil is stuck in the second recording from {begin:.1f} s to {end:.1f} s",
        (*RECORDING, *SENSOR),
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    paper_stands,
    chair_null,
    rocket_gauge,
    lyo_cakes,
    tassel_null,
    sputter_other_run,
    casting_clogs,
    cavity_null,
    rocket_two,
    lyo_clock,
    paper_null,
    chair_reversed,
    cavity_presses,
    tassel_stuck,
    sputter_null,
    casting_breaks,
    rocket_erodes,
    lyo_stopped,
    casting_null,
    chair_keeps,
    cavity_swapped,
    paper_two,
    tassel_sleeve,
    rocket_null,
    sputter_getters,
)
