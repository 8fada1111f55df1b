"""Twenty-eighth set: nuclear spins, a pond of two layers, a hydrostatic drive, thermoluminescence, a seismometer,
a tower that draws fibre, a thermocycler, a skein of coils.

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
from evaluation.strangers.eleventh_set import RPM, telegraph
from evaluation.strangers.fifteenth_set import ramped
from evaluation.strangers.fifth_set import integrated
from evaluation.strangers.first_set import PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import bursts, data_sheet, scaled
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Steps, Written, celsius, drawn_steps, write
from evaluation.strangers.sixteenth_set import later
from evaluation.strangers.tenth_set import stairs
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.thirteenth_set import wandering
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth

#: Gyromagnetic ratio of protons [rad/(s*T)], Boltzmann's constant [eV/K], heat of a cubic metre of water [J/(m^3*K)].
GAMMA, BOLTZMANN, WATER = 2.6752e8, 8.617e-5, 4.18e6
#: Density of silica [kg/m^3], metres in a yard.
SILICA, YARD = 2200.0, 0.9144
#: Laws that are true where something is stored of which the model knows nothing.
STORED = ("hidden_state", "hidden_mass", "hidden_capacity", "second_mass", "hidden_storage", "memory", "relaxation")
#: Laws that are true where a number depends on a state.
RATED = ("nonlinear_rate", "rate_of_state", "state_dependent_rate", "parameter_of_state", "interaction")
#: Laws that are true where something begins at a value.
BEGINNING = ("threshold", "dead_zone", "dead_band", "onset")
#: Laws that are true where spins drive the coil, and the coil drives them back.
RINGING = (*RATED, "radiation_damping", "feedback", "nonlinear_loss", "quadratic_loss", "nonlinear_damping")
#: Laws that are true where wind mixes water once it blows hard enough.
MIXING = (*BEGINNING, *RATED, "mixing", "gain_of_input", "rate_of_input", "exchange", "parameter_of_input")
#: Laws that are true where oil leaks more the hotter it is.
LEAKING = (
    *RATED,
    "leakage",
    "leak",
    "nonlinear_leakage",
    "viscosity",
    "temperature_dependence",
    "conductance_of_state",
)
#: Laws that are true where a valve opens above a pressure.
OPENING = (*BEGINNING, *RATED, "leakage", "leak", "nonlinear_leakage", "relief_valve", "bypass", "saturation")
#: Laws that are true where electrons that were freed are caught again.
CAUGHT = (*RATED, "retrapping", "transfer", "exchange", "saturation", "second_order", "gain_of_state")
#: Laws that are true where a spring yields with time and comes back.
CREEPING = (*STORED, "creep", "viscoelasticity", "hysteresis", "maxwell_element", "stiffness_of_state")
#: Laws that are true where a length is another at another speed.
LONGER = (
    *RATED,
    "gain_of_input",
    "gain_of_state",
    "parameter_of_input",
    "rate_of_input",
    "nonlinear_gain",
    "state_dependent_gain",
)
#: Laws that are true where walls take heat for a while.
WALLED = (*STORED, "heat_loss", "wall_capacity", "hidden_heat_capacity", *RATED)
#: Laws that are true where something pulls with speed.
DRAGGED = ("drag", "quadratic_drag", "viscous_friction", "friction", "gain_of_state", *LONGER)
#: Laws that are true where something loses its activity for good.
WORN = (
    *STORED,
    *RATED,
    "wear",
    "fouling",
    "ageing",
    "aging",
    "degradation",
    "deactivation",
    "fatigue",
    "drift_of_parameter",
)
#: Laws that are true where air moves from an instant on.
BLOWN = (
    "draught",
    "wind",
    "forced_convection",
    "convection",
    "heat_loss",
    "conductance_of_time",
    "nonlinear_conductance",
    "step_of_parameter",
)


# --- spins of protons in a rotating frame (Bloch 1946), FMI 2 Model Exchange; s, ms, nT, mV
SPINS = OdeModel(
    "spins",
    {
        "T_1": (1.3, "s"),
        "T_2": (0.55, "s"),
        "c_x": (1.0, ""),
        "c_y": (0.97, ""),
        "drift": (1.1, "rad/s"),
        "tau_b": (0.012, "s"),
        "gain": (0.4, "V"),
        "tau_r": (0.03, "s"),
    },
    {"field_x": "T", "field_y": "T", "shim": "T"},
    {
        "b_x": ("T", "0.0", "(c_x*field_x - b_x)/tau_b"),
        "b_y": ("T", "0.0", "(c_y*field_y - b_y)/tau_b"),
        "M_x": ("", "0.0", f"({GAMMA}*shim + drift)*M_y - {GAMMA}*b_y*M_z - M_x/T_2"),
        "M_y": ("", "0.0", f"{GAMMA}*b_x*M_z - ({GAMMA}*shim + drift)*M_x - M_y/T_2"),
        "M_z": ("", "1.0", f"{GAMMA}*(b_y*M_x - b_x*M_y) - (M_z - 1.0)/T_1"),
        "S_x": ("V", "0.0", "(gain*M_x - S_x)/tau_r"),
        "S_y": ("V", "0.0", "(gain*M_y - S_y)/tau_r"),
    },
    {"in_phase": ("V", "S_x"), "quadrature": ("V", "S_y")},
    2e-3,
)
SPINS_KNOWN = {
    "T_1": 0.05,
    "T_2": 0.05,
    "c_x": 0.03,
    "c_y": 0.03,
    "drift": 0.1,
    "tau_b": 0.08,
    "gain": 0.03,
    "tau_r": 0.06,
}


def _spins(
    folder: Path,
    rng: Rng,
    rings: float = 0.0,
    is_inverted: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The coil may act back on the spins, and turn them towards the field at `rings` M_z [1/s].

    What is said of the field along y may have the other sign in the second recording.
    """
    SPINS.build(folder)
    parts = programme("synth", ("field_x", "nT"), ("field_y", "nT")) + programme("shims", ("shim", "nT"))
    parts += with_numbers("probe", "spins")
    wires = "".join(
        f"  - {c} -> probe.{c.partition('.')[2]}\n" for c in ("synth.field_x", "synth.field_y", "shims.shim")
    )
    scenario(folder, "Spins of protons in a rotating frame", 36.0, 0.004, 0.02, parts, wires)
    data_sheet(folder, SPINS, SPINS_KNOWN)
    t_1, t_2, c_x, c_y, drift, tau_b, gain, tau_r = drawn(rng, SPINS, SPINS_KNOWN)
    nano = 1e-9 * GAMMA

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Fields are in nT, signals in mV."""
        b_x, b_y, m_x, m_y, m_z, s_x, s_y = (float(s) for s in x)
        w_x, w_y, off = nano * b_x, nano * b_y, nano * float(u[2]) + drift
        back = rings * m_z
        return [
            (c_x * float(u[0]) - b_x) / tau_b,
            (c_y * float(u[1]) - b_y) / tau_b,
            off * m_y - w_y * m_z - m_x / t_2 - back * m_x,
            w_x * m_z - off * m_x - m_y / t_2 - back * m_y,
            w_y * m_x - w_x * m_y - (m_z - 1.0) / t_1 + rings * (m_x**2 + m_y**2),
            (1e3 * gain * m_x - s_x) / tau_r,
            (1e3 * gain * m_y - s_y) / tau_r,
        ]

    for number, (name, stop) in enumerate((("first", 36.0), ("second", 28.0), ("third", 32.0))):
        f_x = drawn_steps(rng, stop, 0.7, -22.0, 22.0, 0.02)
        f_y = drawn_steps(rng, stop, 0.9, -20.0, 20.0, 0.02)
        if name == "third":
            f_x = bursts(rng, stop, 0.6, 0.5, -20.0, 20.0, 0.02)
            f_y = telegraph(rng, stop, 0.8, -15.0, 15.0, 0.02)
        f_x, f_y = later(f_x, 0.008), later(f_y, 0.008)
        shim = ramped(rng, stop, 5.0, -12.0, 12.0, 0.1)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0), (f_x, f_y, shim), stop, 4e-3)
        told = {}
        if is_inverted and name == "second":
            told = {"synth.field_y": Steps(f_y.times, tuple(-v for v in f_y.levels))}
        sensors = [
            Sensor("probe.in_phase", "X mV", "mV", scaled(5, 1.0), 3.0, 0.02, noise_stated, 0.5),
            Sensor("probe.quadrature", "Y mV", "mV", scaled(6, 1.0), 3.0, 0.02, noise_stated, 0.5),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"synth.field_x": (f_x, "nT"), "synth.field_y": (f_y, "nT"), "shims.shim": (shim, "nT")},
            loggers[number % len(loggers)],
            recorded=["shims.shim"],
            told=told,
        )
        write(folder / name, rng, made)


def spins_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=250.0), Logger("s", zero=-1.0, empty=0.02), Logger("s", gap=(14.0, 15.2)))
    _spins(folder, rng, noise_stated=None, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, a column of an input, empty cells, a gap of 1.2 s, "
        "loggers of s and ms",
        FINE,
    )


def spins_ring(folder: Path, rng: Rng) -> Truth:
    rings = rng.uniform(1.4, 2.4)
    _spins(folder, rng, rings=rings, loggers=(PLAIN, Logger("ms", zero=30.0)))
    return Truth(
        f"the coil acts back on the spins that drive it: rates {rings:.3f}/s M_z M_x and M_y less, and of M_z "
        f"{rings:.3f}/s (M_x^2 + M_y^2) more",
        PHYSICS,
        RINGING,
    )


def spins_inverted(folder: Path, rng: Rng) -> Truth:
    _spins(folder, rng, is_inverted=True, loggers=(Logger("ms"), PLAIN, Logger("s", zero=5.0)))
    return Truth(
        "the phase of the field along y was turned by half a turn in the second recording, and is said to be as ever",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- a pond of two layers, FMI 2 Model Exchange, without units and with its keeper's names; h, min
_AUSTAUSCH = "(K_ruhe + K_wind*Wind)"
POND = OdeModel(
    "teich_12",
    {
        "z_oben": (1.1, ""),
        "z_unten": (1.6, ""),
        "a_oben": (0.5, ""),
        "a_unten": (0.12, ""),
        "h_luft": (9.0, ""),
        "b_wind": (0.3, ""),
        "g_grund": (3.0, ""),
        "T_grund": (13.0, ""),
        "K_ruhe": (3e-6, ""),
        "K_wind": (6e-7, ""),
        "k_gas": (9e-6, ""),
        "P_algen": (3.2e-7, ""),
        "R_oben": (4.5e-5, ""),
        "R_unten": (3.2e-5, ""),
        "theta": (0.07, ""),
        "tau_sonde": (700.0, ""),
        "To_0": (19.0, ""),
        "Tu_0": (15.0, ""),
        "Oo_0": (8.6, ""),
        "Ou_0": (6.0, ""),
    },
    {"Sonne": "", "Wind": "", "Luft": ""},
    {
        "T_o": (
            "",
            "To_0",
            f"(a_oben*Sonne - h_luft*(1.0 + b_wind*Wind)*(T_o - Luft) - {WATER}*{_AUSTAUSCH}*(T_o - T_u))"
            f"/({WATER}*z_oben)",
        ),
        "T_u": (
            "",
            "Tu_0",
            f"(a_unten*Sonne - g_grund*(T_u - T_grund) + {WATER}*{_AUSTAUSCH}*(T_o - T_u))/({WATER}*z_unten)",
        ),
        "O_o": (
            "",
            "Oo_0",
            "(k_gas*(1.0 + b_wind*Wind)*(12.9 - 0.19*T_o - O_o) + P_algen*Sonne - R_oben*exp(theta*(T_o - 20.0))"
            f" - {_AUSTAUSCH}*(O_o - O_u))/z_oben",
        ),
        "O_u": (
            "",
            "Ou_0",
            f"({_AUSTAUSCH}*(O_o - O_u) - R_unten*exp(theta*(T_u - 15.0))*O_u/(O_u + 0.4))/z_unten",
        ),
        "M_o": ("", "Oo_0", "(O_o - M_o)/tau_sonde"),
        "M_u": ("", "Ou_0", "(O_u - M_u)/tau_sonde"),
    },
    {
        "Temp_oben": ("", "T_o"),
        "Temp_unten": ("", "T_u"),
        "Sauerstoff_oben": ("", "M_o"),
        "Sauerstoff_unten": ("", "M_u"),
    },
    10.0,
)
POND_KNOWN = {
    "z_oben": 0.03,
    "a_oben": 0.04,
    "a_unten": 0.08,
    "h_luft": 0.06,
    "b_wind": 0.08,
    "g_grund": 0.1,
    "K_ruhe": 0.1,
    "K_wind": 0.1,
    "k_gas": 0.06,
    "P_algen": 0.06,
    "R_oben": 0.08,
    "R_unten": 0.08,
    "theta": 0.05,
    "tau_sonde": 0.1,
    "To_0": 4e-3,
    "Tu_0": 4e-3,
    "Oo_0": 0.01,
    "Ou_0": 0.01,
}


def _sun(rng: Rng, stop: float) -> Steps:
    """Sun of days with clouds [W/m^2], each quarter of an hour."""
    t = 900.0 * np.arange(round(stop / 900.0))
    clear = 820.0 * np.maximum(np.sin(2.0 * np.pi * t / 86400.0), 0.0)
    knots = np.arange(0.0, stop + 14400.0, 7200.0)
    clouds = np.interp(t, knots, rng.uniform(0.3, 1.0, len(knots)))
    return Steps(tuple(float(v) for v in t), tuple(float(f"{v:.4g}") for v in clear * clouds))


def _pond(
    folder: Path,
    rng: Rng,
    mixes: tuple[float, float] = (0.0, 99.0),
    is_swapped: bool = False,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (Logger("h"),),
) -> None:
    """Wind may mix the layers once it blows hard: mixes[0] (Wind - mixes[1]) above mixes[1], in m/s each.

    Both probes of oxygen may be swapped in the second recording.
    """
    POND.build(folder)
    names = (("Dach", "Sonne"), ("Mast", "Wind"), ("Huette", "Luft"))
    parts = "".join(programme(c, (n, "")) for c, n in names) + with_numbers("Teich", "teich_12")
    wires = "".join(f"  - {c}.{n} -> Teich.{n}\n" for c, n in names)
    scenario(folder, "Ein Teich mit zwei Schichten", 345600.0, 60, 300, parts, wires)
    data_sheet(folder, POND, POND_KNOWN)
    z_o, z_u, a_o, a_u, h, b, g, ground, k_0, k_w, k_gas, p_a, r_o, r_u, theta, tau, *begins = drawn(
        rng, POND, POND_KNOWN
    )
    more, least = mixes

    def rates(t: float, x: Array, u: Array) -> list[float]:
        upper, lower, o_o, o_u, m_o, m_u = (float(s) for s in x)
        sun, wind, air = (float(v) for v in u)
        k = k_0 + k_w * wind + more * max(wind - least, 0.0)
        blown = 1.0 + b * wind
        return [
            (a_o * sun - h * blown * (upper - air) - WATER * k * (upper - lower)) / (WATER * z_o),
            (a_u * sun - g * (lower - ground) + WATER * k * (upper - lower)) / (WATER * z_u),
            (
                k_gas * blown * (12.9 - 0.19 * upper - o_o)
                + p_a * sun
                - r_o * np.exp(theta * (upper - 20.0))
                - k * (o_o - o_u)
            )
            / z_o,
            (k * (o_o - o_u) - r_u * np.exp(theta * (lower - 15.0)) * o_u / (o_u + 0.4)) / z_u,
            (o_o - m_o) / tau,
            (o_u - m_u) / tau,
        ]

    for number, (name, stop) in enumerate((("first", 345600.0), ("second", 259200.0), ("third", 302400.0))):
        sun = _sun(rng, stop)
        wind = drawn_steps(rng, stop, 9000.0, 0.2, 8.5, 600.0)
        if name == "third":
            wind = wandering(rng, stop, 7200.0, 0.4, 8.2, 600.0)
        wind = later(wind, 300.0)
        air = ramped(rng, stop, 21600.0, 11.0, 26.0, 900.0)
        t, x = integrated(rates, (*begins, *begins[2:]), (sun, wind, air), stop, 60.0)
        upper, lower = (5, 4) if is_swapped and name == "second" else (4, 5)
        sensors = [
            Sensor("Teich.Temp_oben", "T1", "1", scaled(0, 1.0), 0.06, 300.0, noise_stated, 0.02, wild=wild),
            Sensor("Teich.Temp_unten", "T2", "1", scaled(1, 1.0), 0.06, 300.0, noise_stated, 0.02, wild=wild),
            Sensor("Teich.Sauerstoff_oben", "O2 a", "1", scaled(upper, 1.0), 0.05, 600.0, noise_stated, 0.01),
            Sensor("Teich.Sauerstoff_unten", "O2 b", "1", scaled(lower, 1.0), 0.05, 600.0, noise_stated, 0.01),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"Dach.Sonne": (sun, ""), "Mast.Wind": (wind, ""), "Huette.Luft": (air, "")},
            loggers[number % len(loggers)],
            recorded=["Dach.Sonne", "Huette.Luft"],
        )
        write(folder / name, rng, made)


def pond_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("h", zero=30.0), Logger("min", zero=-90.0, empty=0.03), Logger("h", gap=(120000.0, 129600.0)))
    _pond(folder, rng, noise_stated=1.05, wild=0.004, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.05 times too large, wild readings, no units, two rates, "
        "columns of two inputs, empty cells, a gap of 2.7 h, loggers of h and min",
        FINE,
    )


def pond_mixes(folder: Path, rng: Rng) -> Truth:
    more, least = rng.uniform(6e-6, 1e-5), rng.uniform(4.6, 5.6)
    _pond(folder, rng, mixes=(more, least), loggers=(Logger("h"), Logger("min", zero=15.0)))
    return Truth(
        f"waves break and mix the layers while the wind exceeds {least:.2f} m/s: {1e6 * more:.2f} um/s more for each "
        "m/s above",
        PHYSICS,
        MIXING,
    )


def pond_swapped(folder: Path, rng: Rng) -> Truth:
    _pond(folder, rng, is_swapped=True, loggers=(Logger("min"), Logger("h", zero=2.0)))
    return Truth("the probes of oxygen above and below are swapped in the second recording", (*RECORDING, *SENSOR))


# --- a hydrostatic drive of a roller, FMI 2 Co-Simulation that hides its states; s, ms, %, rpm, N m, bar, degC
DRIVE = OdeModel(
    "hydrostat",
    {
        "D_p": (4.46e-6, "m^3"),
        "D_m": (7.16e-6, "m^3"),
        "stiff": (6e11, "Pa/m^3"),
        "c_l": (4.5e-12, "m^3/(s*Pa)"),
        "tau_s": (0.25, "s"),
        "J": (0.4, "kg*m^2"),
        "b": (0.12, "N*m*s/rad"),
        "T_c": (7.0, "N*m"),
        "loss": (0.06, ""),
        "C_o": (3200.0, "J/K"),
        "U_o": (16.0, "W/K"),
        "O_begin": (308.15, "K"),
    },
    {"swash": "", "engine": "rad/s", "load": "N*m", "air": "K"},
    {
        "alpha": ("", "0.0", "(swash - alpha)/tau_s"),
        "p": ("Pa", "0.0", "stiff*(D_p*alpha*engine - D_m*w - c_l*p)"),
        "w": ("rad/s", "0.0", "(D_m*p - (T_c + load)*tanh(w/1.5) - b*w)/J"),
        "T_o": ("K", "O_begin", "(c_l*p*p + loss*fabs(D_p*alpha*engine*p) - U_o*(T_o - air))/C_o"),
    },
    {"pressure": ("Pa", "p"), "speed": ("rad/s", "w"), "oil": ("K", "T_o")},
    5e-3,
)
DRIVE_KNOWN = {
    "D_p": 0.015,
    "D_m": 0.015,
    "stiff": 0.1,
    "c_l": 0.08,
    "tau_s": 0.08,
    "J": 0.04,
    "b": 0.1,
    "T_c": 0.1,
    "loss": 0.1,
    "C_o": 0.05,
    "U_o": 0.06,
}


def _drive(
    folder: Path,
    rng: Rng,
    thins: float = 0.0,
    opens: tuple[float, float] = (0.0, 1e9),
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Oil may leak more the hotter it is: c_l exp(thins (T - 313.15 K)), thins in 1/K.

    A valve may open: opens[0] (p - opens[1]) above opens[1] [m^3/(s*Pa), Pa]. The swash of the second recording may be
    that of another run.
    """
    DRIVE.build(folder)
    names = (("stick", "swash", "%"), ("diesel", "engine", "rpm"), ("drum", "load", "N*m"), ("yard", "air", "degC"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names).replace("unit: %", 'unit: "%"')
    parts = parts.replace("constant: 0 degC", "constant: 20 degC") + with_numbers("drive", "hydrostat", "internal")
    wires = "".join(f"  - {c}.{n} -> drive.{n}\n" for c, n, _ in names)
    scenario(folder, "A hydrostatic drive", 100.0, 0.01, 0.05, parts, wires)
    data_sheet(folder, DRIVE, DRIVE_KNOWN)
    d_p, d_m, stiff, c_l, tau_s, inertia, b, t_c, loss, c_o, u_o, o_begin = drawn(rng, DRIVE, DRIVE_KNOWN)
    valve, least = opens

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Pressure is in bar."""
        alpha, bar, w, oil = (float(s) for s in x)
        p, engine = 1e5 * bar, float(u[1]) / RPM
        leak = c_l * np.exp(thins * (oil - 313.15)) * p
        relief = valve * max(p - least, 0.0)
        return [
            (1e-2 * float(u[0]) - alpha) / tau_s,
            1e-5 * stiff * (d_p * alpha * engine - d_m * w - leak - relief),
            (d_m * p - (t_c + float(u[2])) * np.tanh(w / 1.5) - b * w) / inertia,
            ((leak + relief) * p + loss * abs(d_p * alpha * engine * p) - u_o * (oil - float(u[3]) - CELSIUS)) / c_o,
        ]

    for number, (name, stop) in enumerate((("first", 100.0), ("second", 80.0), ("third", 90.0))):
        swash = drawn_steps(rng, stop, 3.0, 25.0, 95.0, 0.05)
        other = later(drawn_steps(rng, stop, 3.0, 25.0, 95.0, 0.05), 0.02)
        load = drawn_steps(rng, stop, 4.0, 15.0, 125.0, 0.05)
        if name == "third":
            swash = stairs(rng, stop, 2.5, 28.0, 92.0, 5, 0.05)
            load = wandering(rng, stop, 3.0, 20.0, 120.0, 0.05)
        swash, load = later(swash, 0.02), later(load, 0.02)
        engine = drawn_steps(rng, stop, 9.0, 1300.0, 2100.0, 0.5)
        air = ramped(rng, stop, 40.0, 16.0, 24.0, 1.0)
        t, x = integrated(rates, (0.0, 0.0, 0.0, o_begin), (swash, engine, load, air), stop, 0.01)
        sensors = [
            Sensor("drive.pressure", "p bar", "bar", scaled(1, 1.0), 1.2, 0.05, noise_stated, 0.2),
            Sensor("drive.speed", "n rpm", "rpm", scaled(2, RPM), 5.0, 0.05, noise_stated, 1.0),
            Sensor("drive.oil", "T Oel", "degC", celsius(3), 0.15, 0.2, noise_stated, 0.05),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "stick.swash": (swash, "%"),
                "diesel.engine": (engine, "rpm"),
                "drum.load": (load, "N*m"),
                "yard.air": (air, "degC"),
            },
            loggers[number % len(loggers)],
            recorded=["yard.air"],
            told={"stick.swash": other} if is_other and name == "second" else {},
        )
        write(folder / name, rng, made)


def drive_thins(folder: Path, rng: Rng) -> Truth:
    thins = rng.uniform(0.034, 0.046)
    _drive(folder, rng, thins=thins, loggers=(Logger("ms", zero=100.0), PLAIN))
    return Truth(
        f"oil grows thin with heat and leaks more: c_l exp({thins:.4f}/K (T - 40 degC))",
        PHYSICS,
        LEAKING,
    )


def drive_two(folder: Path, rng: Rng) -> Truth:
    thins, valve, least = rng.uniform(0.03, 0.04), rng.uniform(1e-11, 1.6e-11), rng.uniform(1.45e7, 1.6e7)
    _drive(folder, rng, thins=thins, opens=(valve, least), loggers=(PLAIN, Logger("s", zero=12.0, jitter=0.1)))
    return Truth(
        f"oil grows thin with heat and leaks more: c_l exp({thins:.4f}/K (T - 40 degC)); and a valve opens above "
        f"{1e-5 * least:.1f} bar and lets {6e9 * valve:.3f} L/min pass for each bar above",
        PHYSICS,
        (*LEAKING, *OPENING),
    )


def drive_other_run(folder: Path, rng: Rng) -> Truth:
    _drive(folder, rng, is_other=True, loggers=(Logger("s", zero=-3.0), Logger("ms"), PLAIN))
    return Truth(
        "what is said of the swash plate in the second recording is that of another run",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- a reader of thermoluminescence with an X-ray tube, FMI 2 Co-Simulation that hides its states; min, W, mGy/s, degC
_FREED_1 = f"r_1*exp(E_1/{BOLTZMANN}*(1.0/400.0 - 1.0/T))*n_1"
_FREED_2 = f"r_2*exp(E_2/{BOLTZMANN}*(1.0/480.0 - 1.0/T))*n_2"
GLOW = OdeModel(
    "glow_reader",
    {
        "C_p": (5.0, "J/K"),
        "U_p": (0.05, "W/K"),
        "e_p": (3.2e-11, "W/K^4"),
        "room": (295.15, "K"),
        "a_1": (0.035, "1/Gy"),
        "a_2": (0.02, "1/Gy"),
        "r_1": (0.02, "1/s"),
        "r_2": (0.02, "1/s"),
        "E_1": (1.0, ""),
        "E_2": (1.3, ""),
        "g_1": (1.0e5, ""),
        "g_2": (1.4e5, ""),
        "tau_p": (1.5, "s"),
        "n1_begin": (0.0, ""),
        "n2_begin": (0.0, ""),
    },
    {"heater": "W", "dose": "Gy/s"},
    {
        "T": ("K", "room", "(heater - U_p*(T - room) - e_p*(T*T*T*T - room*room*room*room))/C_p"),
        "n_1": ("", "n1_begin", f"a_1*dose*(1.0 - n_1) - {_FREED_1}"),
        "n_2": ("", "n2_begin", f"a_2*dose*(1.0 - n_2) - {_FREED_2}"),
        "L": ("1/s", "0.0", f"(g_1*{_FREED_1} + g_2*{_FREED_2} - L)/tau_p"),
    },
    {"plate": ("K", "T"), "light": ("1/s", "L")},
    0.1,
)
GLOW_KNOWN = {
    "C_p": 0.03,
    "U_p": 0.05,
    "e_p": 0.06,
    "a_1": 0.05,
    "a_2": 0.05,
    "r_1": 0.06,
    "r_2": 0.06,
    "E_1": 0.015,
    "E_2": 0.015,
    "g_1": 0.04,
    "g_2": 0.04,
    "tau_p": 0.08,
}


def _glow(
    folder: Path,
    rng: Rng,
    catches: float = 0.0,
    kept: tuple[float, float] = (0.0, 0.0),
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Electrons that leave the first trap may be caught by the second, as far as it is empty: the share of them.

    The traps of the second recording may be filled at its begin, to `kept`.
    """
    GLOW.build(folder)
    parts = programme("stage", ("heater", "W")) + programme("tube", ("dose", "mGy/s"))
    parts += with_numbers("reader", "glow_reader", "internal")
    wires = "  - stage.heater -> reader.heater\n  - tube.dose -> reader.dose\n"
    scenario(folder, "A reader of thermoluminescence", 1500.0, 0.5, 1.0, parts, wires)
    data_sheet(folder, GLOW, GLOW_KNOWN)
    c_p, u_p, e_p, room, a_1, a_2, r_1, r_2, e_1, e_2, g_1, g_2, tau_p, *_ = drawn(rng, GLOW, GLOW_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Light is in 1000 counts/s."""
        hot, n_1, n_2, light = (float(s) for s in x)
        heater, dose = float(u[0]), 1e-3 * float(u[1])
        freed_1 = r_1 * np.exp(e_1 / BOLTZMANN * (1.0 / 400.0 - 1.0 / hot)) * n_1
        freed_2 = r_2 * np.exp(e_2 / BOLTZMANN * (1.0 / 480.0 - 1.0 / hot)) * n_2
        caught = catches * (1.0 - n_2) * freed_1
        return [
            (heater - u_p * (hot - room) - e_p * (hot**4 - room**4)) / c_p,
            a_1 * dose * (1.0 - n_1) - freed_1,
            a_2 * dose * (1.0 - n_2) - freed_2 + caught,
            (1e-3 * (g_1 * (freed_1 - caught) + g_2 * freed_2) - light) / tau_p,
        ]

    for number, (name, stop) in enumerate((("first", 1500.0), ("second", 1200.0), ("third", 1350.0))):
        heater = bursts(rng, stop, 60.0, 65.0, 10.0, 21.0, 1.0)
        if name == "third":
            heater = stairs(rng, stop, 30.0, 0.0, 18.0, 5, 1.0)
            heater = Steps(heater.times, tuple(max(v, 0.0) for v in heater.levels))
        dose = bursts(rng, stop, 40.0, 50.0, 60.0, 400.0, 1.0)
        heater, dose = later(heater, 0.5), later(dose, 0.5)
        full = kept if name == "second" else (0.0, 0.0)
        t, x = integrated(rates, (room, *full, 0.0), (heater, dose), stop, 0.5)
        sensors = [
            Sensor("reader.plate", "Pt-Rh", "degC", celsius(0), 0.4, 1.0, noise_stated, 0.1),
            Sensor("reader.light", "PM counts/s", "1/s", scaled(3, 1e3), 25.0, 1.0, noise_stated, 5.0),
        ]
        programmes = {"stage.heater": (heater, "W"), "tube.dose": (dose, "mGy/s")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))
        idle_column(folder / name, "HV V", lambda n: np.asarray(820 + np.arange(n) % 3, dtype=np.float64))


def glow_null(folder: Path, rng: Rng) -> Truth:
    loggers = (
        Logger("min", zero=3.0),
        Logger("s", zero=40.0, jitter=0.12),
        Logger("s", gap=(610.0, 640.0), empty=0.02),
    )
    _glow(folder, rng, noise_stated=0.95, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.05 times too small, a column that nobody uses, jitter, empty "
        "cells, a gap of 30 s, loggers of min and s, Co-Simulation",
        FINE,
    )


def glow_caught(folder: Path, rng: Rng) -> Truth:
    catches = rng.uniform(0.3, 0.5)
    _glow(folder, rng, catches=catches, loggers=(PLAIN, Logger("min")))
    return Truth(
        f"of the electrons that leave the first trap, {catches:.3f} (1 - n_2) are caught by the second and give no "
        "light yet",
        PHYSICS,
        CAUGHT,
    )


def glow_kept(folder: Path, rng: Rng) -> Truth:
    kept = (rng.uniform(0.25, 0.35), rng.uniform(0.3, 0.45))
    _glow(folder, rng, kept=kept, loggers=(Logger("s", zero=7.0), PLAIN))
    return Truth(
        "the sample was used on that day and not annealed before the second recording: its traps are filled to "
        f"{kept[0]:.3f} and {kept[1]:.3f} at its begin, and are said to be empty",
        (*RECORDING, *SENSOR),
    )


# --- a seismometer with a coil on a shaking table, FMI 3 Model Exchange; s, ms, mm/s^2, mV, um, uA
SEISMO = OdeModel(
    "seismometer",
    {
        "m": (1.1, "kg"),
        "k": (70.0, "N/m"),
        "d": (2.2, "N*s/m"),
        "G": (32.0, "N/A"),
        "R": (1900.0, "ohm"),
        "L": (38.0, "H"),
        "tau_t": (0.04, "s"),
        "g_d": (1.0, ""),
        "tau_d": (0.05, "s"),
    },
    {"table": "m/s^2", "calibration": "V"},
    {
        "a": ("m/s^2", "0.0", "(table - a)/tau_t"),
        "x": ("m", "0.0", "v"),
        "v": ("m/s", "0.0", "(G*i - k*x - d*v)/m - a"),
        "i": ("A", "0.0", "(calibration - R*i - G*v)/L"),
        "y": ("m", "0.0", "(g_d*x - y)/tau_d"),
    },
    {"position": ("m", "y"), "current": ("A", "i")},
    1e-3,
)
SEISMO_KNOWN = {
    "m": 0.01,
    "k": 0.03,
    "d": 0.1,
    "G": 0.03,
    "R": 0.02,
    "L": 0.06,
    "tau_t": 0.08,
    "g_d": 0.02,
    "tau_d": 0.08,
}


def _seismo(
    folder: Path,
    rng: Rng,
    creeps: tuple[float, float] = (0.0, 1.0),
    fast: float = 0.0,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The spring may yield with time and come back: a second spring, as a share of the first, on a damper [s].

    The clock of the second recording may be fast, by that share.
    """
    build3(SEISMO, folder, has_co_simulation=False)
    parts = programme("shaker", ("table", "mm/s^2")) + programme("calibrator", ("calibration", "mV"))
    parts += with_numbers("seis", "seismometer")
    wires = "  - shaker.table -> seis.table\n  - calibrator.calibration -> seis.calibration\n"
    scenario(folder, "A seismometer on a shaking table", 44.0, 0.005, 0.02, parts, wires)
    data_sheet(folder, SEISMO, SEISMO_KNOWN)
    m, k, d, g, ohm, henry, tau_t, g_d, tau_d = drawn(rng, SEISMO, SEISMO_KNOWN)
    share, lag = creeps

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Lengths are in mm, the current is in mA; the last is where the damper stands [mm]."""
        a, y, v, i, shown, stands = (float(s) for s in x)
        return [
            (float(u[0]) - a) / tau_t,
            v,
            (g * i - k * y - d * v - share * k * (y - stands)) / m - a,
            (float(u[1]) - ohm * i - g * v) / henry,
            (g_d * y - shown) / tau_d,
            (y - stands) / lag,
        ]

    for number, (name, stop) in enumerate((("first", 44.0), ("second", 36.0), ("third", 40.0))):
        table = drawn_steps(rng, stop, 0.8, -60.0, 60.0, 0.02)
        volts = drawn_steps(rng, stop, 1.3, -120.0, 120.0, 0.02)
        if name == "third":
            table = telegraph(rng, stop, 0.9, -45.0, 45.0, 0.02)
        table, volts = later(table, 0.01), later(volts, 0.01)
        t, x = integrated(rates, (0.0,) * 6, (table, volts), stop, 5e-3)
        logger = loggers[number % len(loggers)]
        if fast and name == "second":
            logger = Logger(logger.unit, logger.zero, 1.0 + fast)
        sensors = [
            Sensor("seis.position", "x um", "um", scaled(4, 1e3), 4.0, 0.02, noise_stated, 0.5, colour),
            Sensor("seis.current", "i uA", "uA", scaled(3, 1e3), 0.8, 0.02, noise_stated, 0.1, colour),
        ]
        programmes = {"shaker.table": (table, "mm/s^2"), "calibrator.calibration": (volts, "mV")}
        write(folder / name, rng, Written(t, x, sensors, programmes, logger))


def seismo_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=20.0, jitter=0.1), Logger("ms", zero=-500.0), Logger("s", gap=(18.0, 19.4), empty=0.02))
    _seismo(folder, rng, noise_stated=1.1, colour=0.12, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.1 times too large, that of neighbouring readings correlates by "
        "0.12, jitter, empty cells, a gap of 1.4 s, loggers of s and ms, FMI 3",
        FINE,
    )


def seismo_creeps(folder: Path, rng: Rng) -> Truth:
    share, lag = rng.uniform(0.14, 0.22), rng.uniform(0.6, 1.3)
    _seismo(folder, rng, creeps=(share, lag), loggers=(Logger("ms"), Logger("s", zero=1.0)))
    return Truth(
        f"the spring yields with time and comes back: a second one of {share:.3f} of its stiffness acts through a "
        f"damper, time constant {lag:.3f} s",
        PHYSICS,
        CREEPING,
    )


def seismo_clock(folder: Path, rng: Rng) -> Truth:
    fast = rng.uniform(1.5e-3, 3e-3)
    _seismo(folder, rng, fast=fast, loggers=(PLAIN, Logger("s", zero=4.0), Logger("ms")))
    return Truth(
        f"the clock of the second recording is fast by {100.0 * fast:.3f} %",
        (*RECORDING, *SENSOR),
    )


# --- a furnace (FMI 2, Model Exchange) and the neck of a preform (FMI 2, Co-Simulation), which is drawn to fibre
FURNACE = OdeModel(
    "furnace",
    {
        "C_e": (2400.0, "J/K"),
        "U_o": (4.2, "W/K"),
        "e_g": (2.4e-10, "W/K^4"),
        "C_g": (130.0, "J/K"),
        "c_p": (1150.0, "J/(kg*K)"),
        "room": (300.0, "K"),
        "tau_y": (3.0, "s"),
        "E_begin": (2225.0, "K"),
        "G_begin": (2205.0, "K"),
    },
    {"power": "W", "melts": "kg/s"},
    {
        "T_e": ("K", "E_begin", "(power - U_o*(T_e - room) - e_g*(pow(T_e, 4) - pow(T_g, 4)))/C_e"),
        "T_g": ("K", "G_begin", "(e_g*(pow(T_e, 4) - pow(T_g, 4)) - c_p*melts*(T_g - room))/C_g"),
        "Y": ("K", "E_begin", "(T_e - Y)/tau_y"),
    },
    {"pyrometer": ("K", "Y"), "glass": ("K", "T_g")},
    0.1,
)
NECK = OdeModel(
    "neck",
    {
        "A_p": (4.9e-4, "m^2"),
        "tau_v": (1.2, "s"),
        "tau_c": (0.8, "s"),
        "tau_n": (7.0, "s"),
        "tau_h": (5.0, "s"),
        "eta": (4e4, "Pa*s"),
        "b_e": (6e4, "K"),
        "L_n": (0.055, "m"),
        "tau_f": (1.5, "s"),
        "f_begin": (6.7e-5, "m/s"),
        "d_begin": (2.7, "m/s"),
        "S_begin": (1.216e-8, "m^2"),
        "H_begin": (2205.0, "K"),
        "F_begin": (0.76, "N"),
    },
    {"glass": "K", "feed": "m/s", "capstan": "m/s"},
    {
        "v_f": ("m/s", "f_begin", "(feed - v_f)/tau_v"),
        "v_d": ("m/s", "d_begin", "(capstan - v_d)/tau_c"),
        "S": ("m^2", "S_begin", "(A_p*v_f/(v_d + 1e-9) - S)/tau_n"),
        "T_h": ("K", "H_begin", "(glass - T_h)/tau_h"),
        "F": (
            "N",
            "F_begin",
            "(3.0*eta*exp(b_e*(1.0/T_h - 1.0/2200.0))*S*v_d*log(A_p/(S + 1e-12))/L_n - F)/tau_f",
        ),
    },
    {"melts": ("kg/s", f"{SILICA}*A_p*v_f"), "diameter": ("m", "sqrt(4.0*fabs(S)/M_PI)"), "tension": ("N", "F")},
    0.1,
)
FURNACE_KNOWN = {"C_e": 0.04, "U_o": 6e-3, "e_g": 0.06, "C_g": 0.06, "c_p": 0.04, "tau_y": 0.08}
NECK_KNOWN = {"A_p": 0.01, "tau_v": 0.08, "tau_c": 0.08, "tau_n": 0.06, "tau_h": 0.1, "eta": 0.05, "b_e": 0.04}
NECK_KNOWN |= {"L_n": 0.02, "tau_f": 0.08}


def _preform(
    folder: Path,
    rng: Rng,
    longer: float = 0.0,
    felt: tuple[float, float] = (0.0, 1.0),
    drag: float = 0.0,
    is_yards: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Two FMUs; the neck may be longer the faster it is fed: L_n (1 + longer (v_f/f_begin - 1)).

    Felt may store heat of the element: what passes to it [W/K], and its capacity [J/K]. A die may pull the fibre:
    drag v_d^2 [N*s^2/m^2]. The capstan of the second recording may be said in yards.
    """
    FURNACE.build(folder)
    NECK.build(folder)
    data_sheet(folder, FURNACE, FURNACE_KNOWN)
    (folder / "numbers.yaml").rename(folder / "furnace.yaml")
    data_sheet(folder, NECK, NECK_KNOWN)
    parts = (
        programme("bus", ("power", "kW"))
        + programme("motors", ("feed", "mm/min"), ("capstan", "m/min"))
        + with_numbers("furnace", "furnace").replace("numbers.yaml", "furnace.yaml")
        + with_numbers("neck", "neck", "internal")
    )
    for old, new in (("0 kW", "8.2 kW"), ("0 mm/min", "4 mm/min"), ("0 m/min", "160 m/min")):
        parts = parts.replace(f"constant: {old}", f"constant: {new}")
    wires = "  - bus.power -> furnace.power\n  - motors.feed -> neck.feed\n  - motors.capstan -> neck.capstan\n"
    wires += "  - neck.melts -> furnace.melts\n  - furnace.glass -> neck.glass\n"
    scenario(folder, "A tower that draws fibre", 3000.0, 0.25, 2.5, parts, wires)
    c_e, u_o, e_g, c_g, c_p, room, tau_y, e_begin, g_begin = drawn(rng, FURNACE, FURNACE_KNOWN)
    a_p, tau_v, tau_c, tau_n, tau_h, eta, b_e, l_n, tau_f, *begins = drawn(rng, NECK, NECK_KNOWN)
    f_begin, d_begin, s_begin, h_begin, n_begin = begins
    passes, stores = felt

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """The feed is in um/s, the section of the fibre is in 1e-9 m^2; the last is the temperature of the felt [K]."""
        hot, glass, shown, v_f, v_d, nano, neck, force, around = (float(s) for s in x)
        section, radiated = 1e-9 * nano, e_g * (hot**4 - glass**4)
        length = l_n * (1.0 + longer * (1e-6 * v_f / f_begin - 1.0))
        viscous = 3.0 * eta * np.exp(b_e * (1.0 / neck - 1.0 / 2200.0))
        pulled = viscous * section * v_d * np.log(a_p / section) / length + drag * v_d**2
        into = passes * (hot - around)
        return [
            (1e3 * float(u[0]) - u_o * (hot - room) - radiated - into) / c_e,
            (radiated - c_p * SILICA * a_p * 1e-6 * v_f * (glass - room)) / c_g,
            (hot - shown) / tau_y,
            (1e3 * float(u[1]) / 60.0 - v_f) / tau_v,
            (float(u[2]) / 60.0 - v_d) / tau_c,
            (1e3 * a_p * v_f / v_d - nano) / tau_n,
            (glass - neck) / tau_h,
            (pulled - force) / tau_f,
            into / stores,
        ]

    def diameter(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(1e6 * np.sqrt(4e-9 * x[:, 5] / np.pi))

    for number, (name, stop) in enumerate((("first", 3000.0), ("second", 2400.0), ("third", 2700.0))):
        power = drawn_steps(rng, stop, 150.0, 7.75, 8.75, 2.5)
        feed = drawn_steps(rng, stop, 110.0, 3.0, 5.0, 2.5)
        capstan = drawn_steps(rng, stop, 80.0, 125.0, 195.0, 2.5)
        if name == "third":
            capstan = stairs(rng, stop, 70.0, 130.0, 190.0, 4, 2.5)
        power, feed, capstan = later(power, 1.0), later(feed, 1.0), later(capstan, 1.0)
        start = (e_begin, g_begin, e_begin, 1e6 * f_begin, d_begin, 1e9 * s_begin, h_begin, n_begin, e_begin)
        t, x = integrated(rates, start, (power, feed, capstan), stop, 0.5)
        told = {}
        if is_yards and name == "second":
            told = {"motors.capstan": Steps(capstan.times, tuple(float(f"{v / YARD:.4g}") for v in capstan.levels))}
        sensors = [
            Sensor("furnace.pyrometer", "T Pyro", "degC", celsius(2), 1.0, 2.5, noise_stated, 0.2),
            Sensor("neck.diameter", "d um", "um", diameter, 0.5, 2.5, noise_stated, 0.1),
            Sensor("neck.tension", "F cN", "cN", scaled(7, 100.0), 1.0, 2.5, noise_stated, 0.1),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"bus.power": (power, "kW"), "motors.feed": (feed, "mm/min"), "motors.capstan": (capstan, "m/min")},
            loggers[number % len(loggers)],
            told=told,
        )
        write(folder / name, rng, made)


def preform_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=12.0), Logger("s", zero=-30.0, empty=0.03), Logger("s", gap=(1100.0, 1180.0)))
    _preform(folder, rng, noise_stated=1.05, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.05 times too large, empty cells, a gap of 80 s, loggers of min "
        "and s, two FMUs",
        FINE,
    )


def preform_longer(folder: Path, rng: Rng) -> Truth:
    longer = rng.uniform(0.5, 0.8)
    _preform(folder, rng, longer=longer, loggers=(PLAIN, Logger("min", zero=1.0)))
    return Truth(
        f"the neck is longer the faster it is fed: L_n (1 + {longer:.3f} (v_f/(67 um/s) - 1))",
        PHYSICS,
        LONGER,
    )


def preform_two(folder: Path, rng: Rng) -> Truth:
    passes, stores, drag = rng.uniform(4.0, 6.0), rng.uniform(1200.0, 2200.0), rng.uniform(0.015, 0.025)
    _preform(folder, rng, felt=(passes, stores), drag=drag, loggers=(Logger("s", zero=9.0), PLAIN))
    return Truth(
        f"felt around the element takes {passes:.2f} W/K and stores {stores:.0f} J/K; and a die pulls the fibre with "
        f"{100.0 * drag:.3f} cN (v_d/(1 m/s))^2",
        PHYSICS,
        (*WALLED, *DRAGGED),
    )


def preform_yards(folder: Path, rng: Rng) -> Truth:
    _preform(folder, rng, is_yards=True, loggers=(Logger("min"), PLAIN, Logger("s", zero=2.0)))
    return Truth(
        "the speed of the capstan of the second recording is in yards per minute, and is said to be in m/min",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- a thermocycler that multiplies DNA, FMI 2 Model Exchange; s, min, degC
_MELTS = "0.5*k_m*(1.0 + tanh((T_s - T_m)/2.0))"
_COPIES = "k_x*exp(-(T_s - 343.15)*(T_s - 343.15)/(w_x*w_x))*S*P"
CYCLER = OdeModel(
    "thermocycler",
    {
        "tau_b": (3.0, "s"),
        "tau_s": (3.5, "s"),
        "s_l": (0.03, ""),
        "k_m": (0.9, "1/s"),
        "T_m": (359.65, "K"),
        "k_x": (0.2, "1/s"),
        "w_x": (9.0, "K"),
        "g_f": (1.0, ""),
        "b_f": (6e-3, "1/K"),
        "F_0": (0.08, ""),
        "B_begin": (335.15, "K"),
        "D_begin": (4e-3, ""),
        "P_begin": (1.0, ""),
    },
    {"setpoint": "K", "lid": "K"},
    {
        "T_b": ("K", "B_begin", "(setpoint - T_b)/tau_b"),
        "T_s": ("K", "B_begin", "(T_b - T_s + s_l*(lid - T_s))/tau_s"),
        "D": ("", "D_begin", f"{_COPIES} - {_MELTS}*D"),
        "S": ("", "0.0", f"2.0*{_MELTS}*D - {_COPIES}"),
        "P": ("", "P_begin", f"-{_COPIES}"),
    },
    {"block": ("K", "T_b"), "tube": ("K", "T_s"), "dye": ("", "F_0 + g_f*D*(1.0 - b_f*(T_s - 333.15))")},
    0.1,
)
CYCLER_KNOWN = {
    "tau_b": 0.05,
    "tau_s": 0.05,
    "s_l": 0.1,
    "k_m": 0.06,
    "T_m": 8e-4,
    "k_x": 0.05,
    "w_x": 0.04,
    "g_f": 0.03,
    "b_f": 0.05,
    "F_0": 0.05,
    "D_begin": 0.08,
}


def _cycles(rng: Rng, stop: float, is_short: bool) -> Steps:
    """Setpoint [degC]: melt, anneal, extend, over and over; of two steps where it is short."""
    times, levels, t = [0.0], [62.0], 6.0
    while t < stop - 45.0:
        melt, anneal = rng.uniform(92.0, 97.0), rng.uniform(56.0, 66.0)
        warm = (1e-9 if is_short else 1.0) * rng.uniform(10.0, 16.0)
        plan = [(melt, rng.uniform(10.0, 15.0)), (anneal, rng.uniform(10.0, 16.0)), (rng.uniform(69.0, 74.0), warm)]
        if is_short:
            plan = [plan[0], (rng.uniform(64.0, 70.0), rng.uniform(20.0, 28.0))]
        for level, length in plan:
            times.append(t)
            levels.append(float(f"{level:.3g}"))
            t += 0.5 * round(length / 0.5)
    return Steps(tuple(times), tuple(levels))


def _thermocycler(
    folder: Path,
    rng: Rng,
    tires: float = 0.0,
    holds: Sequence[tuple[float, float]] = (),
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The enzyme may lose activity for good: tires exp((T - 368.15 K)/8 K) of it, tires in 1/s.

    The thermometer of the tube may hold its reading over stretches of the second recording [s].
    """
    CYCLER.build(folder)
    parts = programme("recipe", ("setpoint", "degC")) + programme("cover", ("lid", "degC"))
    parts = parts.replace("constant: 0 degC", "constant: 62 degC") + with_numbers("cycler", "thermocycler")
    wires = "  - recipe.setpoint -> cycler.setpoint\n  - cover.lid -> cycler.lid\n"
    scenario(folder, "A thermocycler", 900.0, 0.25, 0.5, parts, wires)
    data_sheet(folder, CYCLER, CYCLER_KNOWN)
    tau_b, tau_s, s_l, k_m, t_m, k_x, w_x, g_f, b_f, f_0, b_begin, d_begin, p_begin = drawn(rng, CYCLER, CYCLER_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """The last is the activity of the enzyme."""
        block, tube, double, single, primer, active = (float(s) for s in x)
        melts = 0.5 * k_m * (1.0 + np.tanh((tube - t_m) / 2.0)) * double
        copies = active * k_x * np.exp(-(((tube - 343.15) / w_x) ** 2)) * single * primer
        return [
            (float(u[0]) + CELSIUS - block) / tau_b,
            (block - tube + s_l * (float(u[1]) + CELSIUS - tube)) / tau_s,
            copies - melts,
            2.0 * melts - copies,
            -copies,
            -tires * np.exp((tube - 368.15) / 8.0) * active,
        ]

    def dye(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(f_0 + g_f * x[:, 2] * (1.0 - b_f * (x[:, 1] - 333.15)))

    for number, (name, stop) in enumerate((("first", 900.0), ("second", 780.0), ("third", 840.0))):
        recipe = later(_cycles(rng, stop, name == "third"), 0.25)
        lid = ramped(rng, stop, 200.0, 98.0, 110.0, 5.0)
        t, x = integrated(rates, (b_begin, b_begin, d_begin, 0.0, p_begin, 1.0), (recipe, lid), stop, 0.25)

        def spoil(column: str, t: Array, v: Array, now: bool = name == "second") -> Array:
            for begin, end in holds if now and column == "T Probe" else ():
                stuck = (t >= begin) & (t < end)
                v = np.where(stuck, v[np.argmax(stuck)], v)
            return v

        sensors = [
            Sensor("cycler.block", "T Block", "degC", celsius(0), 0.15, 0.5, noise_stated, 0.05),
            Sensor("cycler.tube", "T Probe", "degC", celsius(1), 0.15, 0.5, noise_stated, 0.05),
            Sensor("cycler.dye", "SYBR", "1", dye, 5e-3, 1.0, noise_stated, 1e-3),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"recipe.setpoint": (recipe, "degC"), "cover.lid": (lid, "degC")},
            loggers[number % len(loggers)],
            recorded=["cover.lid"],
            spoil=spoil,
        )
        write(folder / name, rng, made)


def cycler_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=2.0), Logger("s", zero=15.0, jitter=0.1), Logger("s", gap=(410.0, 425.0), empty=0.02))
    _thermocycler(folder, rng, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated rightly, two rates, a column of an input, jitter, empty cells, a "
        "gap of 15 s, loggers of min and s",
        FINE,
    )


def cycler_tires(folder: Path, rng: Rng) -> Truth:
    tires = rng.uniform(8e-3, 1.2e-2)
    _thermocycler(folder, rng, tires=tires, loggers=(PLAIN, Logger("min")))
    return Truth(
        f"the enzyme loses its activity for good while it is hot: {tires:.5f}/s exp((T - 95 degC)/8 K) of it",
        PHYSICS,
        WORN,
    )


def cycler_stuck(folder: Path, rng: Rng) -> Truth:
    begins = 0.5 * round(rng.uniform(180.0, 260.0) / 0.5), 0.5 * round(rng.uniform(480.0, 560.0) / 0.5)
    holds = tuple((b, b + 0.5 * round(rng.uniform(55.0, 80.0) / 0.5)) for b in begins)
    _thermocycler(folder, rng, holds=holds, loggers=(Logger("s", zero=3.0), PLAIN, Logger("min")))
    return Truth(
        "the thermometer of the tube holds its reading in the second recording, from "
        + " and from ".join(f"{a:.1f} s to {b:.1f} s" for a, b in holds),
        (*RECORDING, *SENSOR),
    )


# --- a skein of coils behind a slow supply: three of which one is bridged, one behind a ballast, two, and two of which
# one is broken; the tool's own units
SKEIN = {
    "reference_resistance": (1.7, "ohm", 0.02, 0.02),
    "heat_transfer_coefficient": (70.0, "W/(m^2*K)", 0.05, 0.02),
    "area": (150.0, "mm^2", 0.0, 0.0),
    "volume": (12.0, "mm^3", 0.0, 0.0),
    "density": (6450.0, "kg/m^3", 0.0, 0.0),
    "specific_heat": (690.0, "J/(kg*K)", 0.05, 0.02),
}
#: Coils in series, bridged and broken ones (from 0), resistances of wires, ballasts, and the supply [ohm].
SKEIN_STRINGS, SKEIN_BRIDGED, SKEIN_BROKEN, SKEIN_WIRES, SKEIN_INNER = (3, 1, 2, 2), 1, 7, 0.2, 0.3
SKEIN_BALLAST = (0.0, 2.6, 0.4, 0.0)
#: Limit of the supply [A], its delay [s], rise of resistance [1/K], temperature that the numbers are for [degC].
SKEIN_LIMIT, SKEIN_DELAY, SKEIN_RISE, SKEIN_COLD = 2.3, 0.8, 6e-4, 20.0


def _skein_files(folder: Path) -> None:
    """Scenario and parameter set of the eight coils."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = ["title: Coils of a skein", "parameters:"]
    for name, (value, unit, uncertainty, scatter) in SKEIN.items():
        known = f"uncertainty: {uncertainty:g}, scatter: {scatter:g}"
        lines.append(f'  {name}: {{value: {value:g}, unit: {unit}, source: "own measurement", {known}}}')
    lines += [
        '  use_regressed_cooling_rate: {value: false, source: "cools as it heats"}',
        f'  initial_temperature: {{value: {SKEIN_COLD:g}, unit: degC, source: "room"}}',
        f'  reference_temperature: {{value: {SKEIN_COLD:g}, unit: degC, source: "room"}}',
        f'  resistance_temperature_coefficient: {{value: {SKEIN_RISE:g}, unit: 1/K, source: "own measurement"}}',
    ]
    (folder / "numbers.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    elements = [f"{{kind: current_limit, supply: 1, limit: {SKEIN_LIMIT} A, share: 1}}"]
    elements += [f"{{kind: slow_source, supply: 1, delay: {SKEIN_DELAY} s}}"]
    elements += [
        f"{{kind: contact, string: {s}, resistance: {ohm} ohm}}" for s, ohm in enumerate(SKEIN_BALLAST, start=1) if ohm
    ]
    parts = (
        programme("bench", ("voltage", "V"))
        + programme("room", ("temperature", "degC")).replace("constant: 0 degC", f"constant: {SKEIN_COLD:g} degC")
        + f"  circuit:\n    kind: ngspice\n    strings: [{', '.join(str(n) for n in SKEIN_STRINGS)}]\n"
        f"    supply: common\n    supply_resistance: {SKEIN_INNER} ohm\n    string_resistance: {SKEIN_WIRES} ohm\n"
        f"    shorted_coils: [{SKEIN_BRIDGED + 1}]\n    open_coils: [{SKEIN_BROKEN + 1}]\n    elements:\n"
        + "".join(f"      - {e}\n" for e in elements)
        + f"    start: {{resistance: {SKEIN['reference_resistance'][0]} ohm}}\n"
        "  coils: {kind: actuator, fmu: thermal_stiffness, electrical: circuit, ambient: room, "
        "parameter_set: numbers.yaml}\n"
    )
    scenario(folder, "A skein of coils", 130.0, 0.05, 0.1, parts, "  - bench.voltage -> circuit.supply_voltage\n")


def _skein_off(rng: Rng, name: str) -> Array:
    """A number of each coil as it is."""
    value, _, uncertainty, scatter = SKEIN[name]
    return np.asarray(value * np.exp(uncertainty * rng.normal() + scatter * rng.normal(size=sum(SKEIN_STRINGS))))


def _skein_course(
    numbers: Sequence[Array], volts: Steps, room: Steps, start: float, stop: float, step: float, blows: Steps
) -> tuple[Array, Array]:
    """Times [s], and temperatures of the coils [degC], currents of the strings [A], voltage of the terminals [V].

    Heat by the exponential of equation (3) over a step, with the currents of its middle.

    Args:
        numbers: Resistances [ohm], conductances [W/K], capacities [J/K] of the coils.
        volts: Of the supply, as it was set.
        room: Its temperature [degC].
        start: Temperature of the coils at 0 [degC].
        stop: End [s].
        step: Of time [s].
        blows: Factor of the conductances.
    """
    cold, loses, holds = numbers
    times: Array = step * np.arange(round(stop / step) + 1, dtype=np.float64)
    wanted, around, blown = volts.at(times), room.at(times), blows.at(times)
    string = np.repeat(np.arange(len(SKEIN_STRINGS)), SKEIN_STRINGS)
    works = np.arange(len(string)) != SKEIN_BRIDGED
    closed = np.bincount(string, np.arange(len(string)) == SKEIN_BROKEN) == 0

    def currents(hot: Array, v: float) -> tuple[Array, float]:
        ohms = np.bincount(string, hot * works) + SKEIN_WIRES + np.asarray(SKEIN_BALLAST)
        carries = closed / ohms
        together = float(np.sum(carries))
        terminal = min(v / (SKEIN_INNER + 1.0 / together), SKEIN_LIMIT) / together
        return np.asarray(terminal * carries), terminal

    def relaxed(warm: Array, at: Array, v: float, outside: float, span: float, wind: float) -> Array:
        hot = cold * (1.0 + SKEIN_RISE * (at - SKEIN_COLD))
        end = outside + currents(hot, v)[0][string] ** 2 * hot * works / (wind * loses)
        return np.asarray(end + (warm - end) * np.exp(-wind * loses * span / holds))

    warm, emf, decay = np.full(len(string), start), 0.0, float(np.exp(-0.5 * step / SKEIN_DELAY))
    found = np.empty((len(times), len(string) + len(SKEIN_STRINGS) + 1))
    for i, (v, outside, wind) in enumerate(zip(wanted, around, blown)):
        amps, terminal = currents(cold * (1.0 + SKEIN_RISE * (warm - SKEIN_COLD)), emf)
        found[i] = (*warm, *amps, terminal)
        half = float(v) + (emf - float(v)) * decay
        middle = relaxed(warm, warm, 0.5 * (emf + half), float(outside), step / 2, float(wind))
        warm = relaxed(warm, middle, half, float(outside), step, float(wind))
        emf = float(v) + (emf - float(v)) * decay**2
    return times, found


def _skein(
    folder: Path,
    rng: Rng,
    draught: tuple[float, float] = (np.inf, 0.0),
    lag: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Air may move from an instant [s] of the second recording on, and take that share of heat more.

    The thermometer of the fifth coil may lag in the second recording: time constant [s]. The meters of currents and of
    the voltage show means of the last 50 ms, as integrating ones do; the supply is slow, but not that slow.
    """
    _skein_files(folder)
    conductance = 1e-6 * _skein_off(rng, "area") * _skein_off(rng, "heat_transfer_coefficient")
    capacity = 1e-9 * _skein_off(rng, "density") * _skein_off(rng, "volume") * _skein_off(rng, "specific_heat")
    numbers = (_skein_off(rng, "reference_resistance"), conductance, capacity)

    for number, (name, stop) in enumerate((("first", 130.0), ("second", 105.0), ("third", 115.0))):
        volts = drawn_steps(rng, stop, 7.0, 0.0, 4.4, 0.1)
        if name == "third":
            volts = wandering(rng, stop, 4.5, 0.2, 4.2, 0.1)
        volts = later(volts, 0.05)
        room = ramped(rng, stop, 40.0, 18.5, 23.0, 0.5)
        said = room.levels[0]
        since, more = draught if name == "second" else (np.inf, 0.0)
        blows = Steps((0.0, since), (1.0, 1.0 + more)) if more else Steps((0.0,), (1.0,))
        t, x = _skein_course(numbers, volts, room, said + 0.2 * float(rng.normal()), stop, 0.0125, blows)
        slow = x[:, 4].copy()
        if lag and name == "second":
            for i in range(1, len(t)):
                slow[i] = x[i, 4] + (slow[i - 1] - x[i, 4]) * np.exp(-(t[i] - t[i - 1]) / lag)
        total = np.vstack([np.zeros(5), np.cumsum(0.5 * (x[1:, 8:] + x[:-1, 8:]), axis=0)])
        x[4:, 8:] = 0.25 * (total[4:] - total[:-4])
        x = np.column_stack([x, slow])
        sensors = [
            Sensor(f"string[{s}].current", f"I{s} mA", "mA", scaled(7 + s, 1e3), 1.5, 0.1, noise_stated, 0.5)
            for s in (1, 2, 3)
        ]
        sensors += [Sensor("supply.voltage", "U V", "V", scaled(12, 1.0), 6e-3, 0.1, noise_stated, 2e-3)]
        sensors += [
            Sensor(f"coil[{c}].temperature", f"TC{c}", "degC", scaled(s, 1.0), 0.25, 0.2, noise_stated, 0.1)
            for c, s in ((1, 0), (3, 2), (4, 3), (5, 13), (6, 5))
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


def skein_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=11.0), Logger("ms", zero=700.0, empty=0.02), Logger("s", gap=(60.0, 63.5)))
    _skein(folder, rng, noise_stated=0.95, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, coil by coil too, start off by 0.2 K (deviation), noise stated 1.05 times too "
        "small, two rates, a column of an input, empty cells, a gap of 3.5 s, loggers of s and ms",
        FINE,
    )


def skein_draught(folder: Path, rng: Rng) -> Truth:
    since, more = 0.1 * round(rng.uniform(25.0, 40.0) / 0.1), rng.uniform(0.25, 0.4)
    _skein(folder, rng, draught=(since, more), loggers=(PLAIN, Logger("s", zero=2.0)))
    return Truth(
        f"air moves from {since:.1f} s of the second recording on, and takes {100.0 * more:.2f} % more heat of all "
        "coils; in the others there is none",
        (*PHYSICS, *RECORDING),
        (*BLOWN, *RATED),
    )


def skein_lags(folder: Path, rng: Rng) -> Truth:
    lag = rng.uniform(2.0, 3.5)
    _skein(folder, rng, lag=lag, loggers=(Logger("ms"), PLAIN, Logger("s", zero=-2.0)))
    return Truth(
        f"the thermometer of the fifth coil has come loose in the second recording, and lags: time constant "
        f"{lag:.3f} s",
        (*RECORDING, *SENSOR),
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    preform_yards,
    spins_ring,
    skein_null,
    drive_two,
    pond_swapped,
    glow_null,
    cycler_tires,
    seismo_clock,
    pond_null,
    preform_longer,
    spins_inverted,
    skein_draught,
    drive_thins,
    seismo_null,
    glow_kept,
    cycler_null,
    preform_two,
    pond_mixes,
    drive_other_run,
    spins_null,
    skein_lags,
    seismo_creeps,
    cycler_stuck,
    preform_null,
    glow_caught,
)
