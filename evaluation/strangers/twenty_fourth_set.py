"""Twenty-fourth set: a float, a telescope, an oak in a pot, clay, smoke, a mash tun, a milking machine, one coil.

Written by an author who had read neither the library of laws nor its proof nor its tests nor its thresholds, and who
had not run a diagnosis, of these cases or of any other; of the earlier sets, the author had read two and the helpers
that these take from the others. Truths are integrated from equations that stand here, by scipy or, of the coil, by a
scheme of its own. How large an effect is, and how far the numbers are off, is drawn; the deviations of the numbers are
those that a parameter set states. Recordings of a rig differ in length and in logger; the one that is held out was
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
from evaluation.strangers.eleventh_set import DEGREES, RPM, telegraph
from evaluation.strangers.fifteenth_set import ramped
from evaluation.strangers.fifth_set import GRAVITY, integrated
from evaluation.strangers.first_set import PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import between, bursts, data_sheet, scaled
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Steps, Written, celsius, drawn_steps, write
from evaluation.strangers.sixteenth_set import later
from evaluation.strangers.tenth_set import stairs
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.thirteenth_set import wandering
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth

#: Pressure of the air [Pa], a cubic foot a minute [m^3/h], density of the brine in the float's tank [kg/m^3].
ATMOSPHERE, CUBIC_FOOT_A_MINUTE, BRINE = 101325.0, 1.69901082, 1005.0
#: Laws that are true where something is stored of which the model knows nothing.
STORED = ("hidden_state", "hidden_mass", "hidden_capacity", "second_mass", "hidden_storage")
#: Laws that are true where a force relaxes.
RELAXING = (*STORED, "relaxation", "viscoelasticity", "viscoelastic", "stress_relaxation", "creep", "maxwell")
#: Laws that are true where a torque comes again with the angle.
PERIODIC = (
    "cogging",
    "torque_ripple",
    "periodic_force",
    "periodic_torque",
    "position_dependent_force",
    "force_of_place",
)
#: Laws that are true where something wears with what went through it.
WORN = ("wear", "fouling", "clogging", "ageing", "aging", "degradation", "drift_of_parameter", "hidden_state")
#: Laws that are true where something begins at a value.
BEGINNING = ("threshold", "dead_zone", "dead_band", "onset")
#: Laws that are true where something leaks from a value on.
LEAKING = (*BEGINNING, "leakage", "leak", "nonlinear_leakage", "nonlinear_loss")
#: Laws that are true where a rate depends on what there is of something.
RATED = ("reaction_order", "nonlinear_rate", "rate_of_state", "state_dependent_rate", "parameter_of_state")
#: Laws that are true where things meet in pairs and are lost.
PAIRED = (*RATED, "second_order_rate", "quadratic_loss", "nonlinear_loss", "coagulation", "recombination")
#: Laws that are true where heat passes less well where there is more of something.
THICKENED = (*RATED, "state_dependent_conductance", "conductance_of_state", "heat_transfer_of_state", "thickening")
#: Laws that are true where an input counts less with a state.
CLOSING = (*BEGINNING, "saturation", "state_dependent_gain", "gain_of_state", "gain_of_input", *RATED)
#: Laws that are true where something slides on something dry.
RUBBING = ("dry_friction", "coulomb_friction", "stribeck_friction", "friction", "hysteresis", "backlash", "stiction")


# --- a profiling float in a tank of brine that is denser below, FMI 2 Model Exchange; s, mL/min, degC, cm, mL
PROFILER = OdeModel(
    "profiler",
    {
        "m": (38.0, "kg"),
        "d": (2.0, "N*s/m"),
        "c": (45.0, "N*s^2/m^2"),
        "k": (0.55, "N/m"),
        "eta": (0.95, ""),
        "beta": (1.7e-6, "m^3/K"),
        "tau": (240.0, "s"),
        "z_n": (4.0, "m"),
        "T_trim": (288.15, "K"),
    },
    {"pump": "m^3/s", "water": "K"},
    {
        "z": ("m", "z_n", "v"),
        "v": (
            "m/s",
            "0.0",
            f"(k*(z_n - z) - {BRINE}*{GRAVITY}*(V + beta*(T_h - T_trim)) - d*v - c*v*fabs(v))/m",
        ),
        "V": ("m^3", "0.0", "eta*pump"),
        "T_h": ("K", "T_trim", "(water - T_h)/tau"),
    },
    {"depth": ("m", "z"), "oil": ("m^3", "V"), "hull": ("K", "T_h")},
    0.05,
)
PROFILER_KNOWN = {"m": 0.03, "d": 0.1, "c": 0.08, "k": 0.05, "eta": 0.03, "beta": 0.08, "tau": 0.08, "z_n": 5e-3}


def strokes(rng: Rng, stop: float, pause: float, ends: float, is_to_and_fro: bool, grid: float) -> Steps:
    """Flows of a pump [mL/min] that bring a bladder from one volume to another between -ends and ends [mL]."""
    times, flows, t, volume, count = [0.0], [0.0], 0.0, 0.0, 0
    while True:
        t += grid * max(1, round(rng.uniform(0.5, 1.5) * pause / grid))
        count += 1
        wanted = rng.uniform(0.6, 1.0) * ends * (-1) ** count if is_to_and_fro else rng.uniform(-ends, ends)
        flow = float(f"{np.sign(wanted - volume) * rng.uniform(90.0, 180.0):.3g}")
        end = t + grid * max(1, round(60.0 * (wanted - volume) / flow / grid))
        if end >= stop - pause / 4:
            return Steps(tuple(times), tuple(flows))
        times += [t, end]
        flows += [flow, 0.0]
        volume += flow * (end - t) / 60.0
        t = end


def _missed(pump: Steps, stop: float) -> tuple[float, float]:
    """Begin and end [s] of a stroke of about 60 mL in the middle, with some of the pause before it."""
    found = [
        (abs(abs(level) * (end - begin) / 60.0 - 60.0), begin, end)
        for begin, end, level in zip(pump.times, pump.times[1:], pump.levels)
        if level and 0.3 * stop < begin < 0.6 * stop
    ]
    _, begin, end = min(found)
    return begin - 10.0, end + 5.0


def _float(
    folder: Path,
    rng: Rng,
    cowl: tuple[float, float] | None = None,
    is_idle: bool = False,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> tuple[float, float]:
    """Brine in the cowl may be that of where the float was: a force k_c (z - z_c), with k_c [N/m] and a lag [s].

    The pump may stand still over a stroke of the first recording, against what is said; begin and end [s] come back.
    """
    PROFILER.build(folder)
    parts = programme("controller", ("pump", "mL/min")) + programme("tank", ("water", "degC"))
    parts += with_numbers("probe", "profiler")
    wires = "  - controller.pump -> probe.pump\n  - tank.water -> probe.water\n"
    scenario(folder, "A profiling float in a tank", 1500.0, 0.5, 1, parts, wires)
    data_sheet(folder, PROFILER, PROFILER_KNOWN)
    mass, d, c, k, eta, beta, tau, trim, warm_trim = drawn(rng, PROFILER, PROFILER_KNOWN)
    k_c, lag = cowl if cowl is not None else (0.0, 60.0)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Oil is in mL; the last is the depth [m] of which the brine in the cowl is."""
        z, v, oil, hull, held = (float(s) for s in x)
        lifted = 1e-6 * BRINE * GRAVITY * (oil + 1e6 * beta * (hull - warm_trim))
        return [
            v,
            (k * (trim - z) - k_c * (z - held) - lifted - d * v - c * v * abs(v)) / mass,
            eta * float(u[0]) / 60.0,
            (float(u[1]) + CELSIUS - hull) / tau,
            (z - held) / lag,
        ]

    stretch = (0.0, 0.0)
    for number, (name, stop) in enumerate((("first", 1500.0), ("second", 1200.0), ("third", 1350.0))):
        pump = later(strokes(rng, stop, 35.0, 100.0, name == "third", 1.0), 0.5)
        water = ramped(rng, stop, 260.0, 11.0, 20.0, 5.0)
        run = pump
        if is_idle and name == "first":
            stretch = _missed(pump, stop)
            run = between(pump, *stretch, lambda v: 0.0)
        t, x = integrated(rates, (trim, 0.0, 0.0, warm_trim, trim), (run, water), stop, 0.5)
        sensors = [
            Sensor("probe.depth", "Tiefe cm", "cm", scaled(0, 100.0), 1.5, 1.0, noise_stated, 0.5, wild=wild),
            Sensor("probe.oil", "Öl mL", "mL", scaled(2, 1.0), 0.8, 1.0, noise_stated, 0.5, wild=wild),
            Sensor("probe.hull", "NTC Rumpf", "degC", celsius(3), 0.05, 2.0, noise_stated, 0.02, wild=wild),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"controller.pump": (run, "mL/min"), "tank.water": (water, "degC")},
            loggers[number % len(loggers)],
            recorded=["tank.water"],
            told={} if run is pump else {"controller.pump": pump},
        )
        write(folder / name, rng, made)
    return stretch


def float_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=300.0, gap=(620.0, 655.0)), Logger("min", zero=-2.0, jitter=0.2), PLAIN)
    _float(folder, rng, noise_stated=None, wild=0.005, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, wild readings, two rates, a column of an input, jitter, "
        "a gap of 35 s, loggers of s and min",
        FINE,
    )


def float_cowl(folder: Path, rng: Rng) -> Truth:
    k_c, lag = rng.uniform(0.11, 0.18), rng.uniform(45.0, 80.0)
    _float(folder, rng, cowl=(k_c, lag), loggers=(Logger("s", zero=12.0), Logger("min")))
    return Truth(
        f"brine in the cowl is that of where the float was: it pulls back with {k_c:.4f} N/m (z - z_c), and z_c "
        f"follows the depth z with a time constant of {lag:.1f} s",
        PHYSICS,
        RELAXING,
    )


def float_idle(folder: Path, rng: Rng) -> Truth:
    begin, end = _float(folder, rng, is_idle=True, loggers=(PLAIN, Logger("min", zero=5.0)))
    return Truth(
        f"from {begin:g} s to {end:g} s of the first recording the pump stands still, and is said to make a stroke",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- altitude axis of a telescope with a soft worm gear, FMI 2 Model Exchange; ms, V, m/s, deg, deg/s
MOUNT = OdeModel(
    "mount",
    {
        "J_m": (18.0, "kg*m^2"),
        "J_t": (60.0, "kg*m^2"),
        "k": (9000.0, "N*m/rad"),
        "c": (70.0, "N*m*s/rad"),
        "K": (12.0, "N*m/V"),
        "b": (300.0, "N*m*s/rad"),
        "d": (20.0, "N*m*s/rad"),
        "U": (40.0, "N*m"),
        "A": (0.1, "N*m*s^2/m^2"),
    },
    {"volts": "V", "wind": "m/s"},
    {
        "q_m": ("rad", "0.0", "w_m"),
        "w_m": ("rad/s", "0.0", "(K*volts - b*w_m - k*(q_m - q_t) - c*(w_m - w_t))/J_m"),
        "q_t": ("rad", "0.0", "w_t"),
        "w_t": (
            "rad/s",
            "0.0",
            "(k*(q_m - q_t) + c*(w_m - w_t) - d*w_t - U*sin(q_t) + A*wind*wind*cos(q_t))/J_t",
        ),
    },
    {"worm": ("rad", "q_m"), "tube": ("rad", "q_t"), "gyro": ("rad/s", "w_t")},
    1e-3,
)
MOUNT_KNOWN = {
    "J_m": 0.05,
    "J_t": 0.03,
    "k": 0.06,
    "c": 0.12,
    "K": 0.03,
    "b": 0.06,
    "d": 0.12,
    "U": 0.04,
    "A": 0.08,
}


def _mount(
    folder: Path,
    rng: Rng,
    cogging: tuple[float, float, float] | None = None,
    lost: tuple[float, float] | None = None,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """The worm wheel may be uneven: a torque [N m] that comes again so many times a turn, with a phase [rad].

    Lost are an instant of the second recording [s] at which its clock stands still for a while, and that while [s].
    """
    MOUNT.build(folder)
    parts = programme("amplifier", ("volts", "V")) + programme("anemometer", ("wind", "m/s"))
    parts += with_numbers("axis", "mount")
    wires = "  - amplifier.volts -> axis.volts\n  - anemometer.wind -> axis.wind\n"
    scenario(folder, "Altitude axis of a telescope", 48.0, 0.01, 0.02, parts, wires)
    data_sheet(folder, MOUNT, MOUNT_KNOWN)
    j_m, j_t, k, c, gain, b, d, uneven, area = drawn(rng, MOUNT, MOUNT_KNOWN)
    torque, teeth, phase = cogging if cogging is not None else (0.0, 1.0, 0.0)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        q_m, w_m, q_t, w_t = (float(s) for s in x)
        held = k * (q_m - q_t) + c * (w_m - w_t)
        blown = area * float(u[1]) ** 2 * np.cos(q_t)
        return [
            w_m,
            (gain * float(u[0]) - b * w_m - held + torque * np.sin(teeth * q_m + phase)) / j_m,
            w_t,
            (held - d * w_t - uneven * np.sin(q_t) + blown) / j_t,
        ]

    for number, (name, stop) in enumerate((("first", 48.0), ("second", 40.0), ("third", 45.0))):
        volts = drawn_steps(rng, stop, 2.2, -3.0, 3.0, 0.02)
        if name == "third":
            volts = telegraph(rng, stop, 2.6, -2.8, 2.8, 0.02)
        volts = later(volts, 0.01)
        wind = ramped(rng, stop, 4.0, 0.0, 11.0, 0.1)
        instant, span = lost if lost is not None and name == "second" else (stop, 0.0)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0), (volts, wind), stop + span, 5e-3)
        if span:
            skipped = round(span / 5e-3)
            count = len(t) - skipped
            x = np.where(t[:count, None] < instant, x[:count], x[skipped:])
            t = t[:count]
        sensors = [
            Sensor("axis.worm", "Encoder 1", "deg", scaled(0, DEGREES), 0.03, 0.02, noise_stated, 0.01),
            Sensor("axis.tube", "Encoder 2", "deg", scaled(2, DEGREES), 0.03, 0.02, noise_stated, 0.01),
            Sensor("axis.gyro", "Gyro", "deg/s", scaled(3, DEGREES), 0.12, 0.02, noise_stated, 0.02),
        ]
        programmes = {"amplifier.volts": (volts, "V"), "anemometer.wind": (wind, "m/s")}
        made = Written(t, x, sensors, programmes, loggers[number % len(loggers)], recorded=["anemometer.wind"])
        write(folder / name, rng, made)


def mount_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=4e4, gap=(21.0, 23.0)), Logger("s", zero=-3.0, jitter=0.15), Logger("s", empty=0.02))
    _mount(folder, rng, noise_stated=1.1, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.1 times too large, a column of an input, jitter, empty cells, "
        "a gap of 2 s, loggers of ms and s",
        FINE,
    )


def mount_cogging(folder: Path, rng: Rng) -> Truth:
    torque, teeth, phase = rng.uniform(1.2, 1.7), float(rng.integers(20, 25)), rng.uniform(-1.5, 1.5)
    _mount(folder, rng, cogging=(torque, teeth, phase), loggers=(Logger("ms"), Logger("s", zero=60.0)))
    return Truth(
        f"the worm wheel is uneven: a torque {torque:.3f} N m sin({teeth:g} q_m {phase:+.3f}) of the angle q_m of the "
        "worm side",
        PHYSICS,
        PERIODIC,
    )


def mount_lost(folder: Path, rng: Rng) -> Truth:
    instant = 0.02 * round(rng.uniform(12.0, 22.0) / 0.02) + 0.01
    span = 0.02 * round(rng.uniform(0.18, 0.3) / 0.02)
    _mount(folder, rng, lost=(instant, span), loggers=(Logger("s"), Logger("ms", zero=-80.0), Logger("s")))
    return Truth(
        f"the clock of the second recording stands still at {instant:.2f} s for {span:.2f} s: later readings are said "
        "to have been taken earlier than they were",
        (*RECORDING, *SENSOR),
    )


# --- an oak in a pot under lamps, FMI 2 Model Exchange, without units and with a gardener's names; two rates
OAK = OdeModel(
    "Eiche_3",
    {
        "W_voll": (3600.0, ""),
        "W_0": (3200.0, ""),
        "p_e": (0.03, ""),
        "b": (5.0, ""),
        "K_Wurzel": (0.02, ""),
        "K_Stamm": (0.03, ""),
        "C_Stamm": (300.0, ""),
        "C_Blatt": (40.0, ""),
        "g_Blatt": (8e-3, ""),
        "L_halb": (280.0, ""),
        "M_leer": (5400.0, ""),
        "PS_0": (-0.25, ""),
        "PB_0": (-0.35, ""),
    },
    {"Licht": "", "VPD": "", "Guss": ""},
    {
        "W": ("", "W_0", "Guss/60.0 - K_Wurzel*(-p_e*pow(W_voll/W, b) - PS)"),
        "PS": ("", "PS_0", "(K_Wurzel*(-p_e*pow(W_voll/W, b) - PS) - K_Stamm*(PS - PB))/C_Stamm"),
        "PB": ("", "PB_0", "(K_Stamm*(PS - PB) - g_Blatt*VPD*(0.05 + Licht/(Licht + L_halb)))/C_Blatt"),
    },
    {
        "Waage": ("", "M_leer + W + C_Stamm*PS + C_Blatt*PB"),
        "Saftfluss": ("", "3600.0*K_Stamm*(PS - PB)"),
        "Psi_Stamm": ("", "PS"),
    },
    30.0,
)
OAK_KNOWN = {
    "W_0": 0.01,
    "p_e": 0.08,
    "b": 0.04,
    "K_Wurzel": 0.06,
    "K_Stamm": 0.06,
    "C_Stamm": 0.06,
    "C_Blatt": 0.08,
    "g_Blatt": 0.05,
    "L_halb": 0.08,
    "M_leer": 2e-3,
}


def _oak(
    folder: Path,
    rng: Rng,
    closes: float = np.inf,
    stuck: tuple[float, float] | None = None,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (Logger("h"),),
) -> None:
    """Stomata may close as the leaf dries, 1/(1 + (PB/closes)^4), closes in MPa.

    Stuck are begin and end [s] of a stretch of the second recording in which the psychrometer shows one value.
    """
    OAK.build(folder)
    parts = programme("Kammer", ("Licht", ""), ("VPD", "")) + programme("Kanne", ("Guss", ""))
    parts += with_numbers("Eiche", "Eiche_3")
    wires = "  - Kammer.Licht -> Eiche.Licht\n  - Kammer.VPD -> Eiche.VPD\n  - Kanne.Guss -> Eiche.Guss\n"
    scenario(folder, "Eiche 3 im Topf", 237600.0, 150, 300, parts, wires)
    data_sheet(folder, OAK, OAK_KNOWN)
    full, w_0, p_e, b, root, trunk, c_s, c_b, leaf, half, empty, ps_0, pb_0 = drawn(rng, OAK, OAK_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        water, stem, dry = (float(s) for s in x)
        drunk, risen = root * (-p_e * (full / water) ** b - stem), trunk * (stem - dry)
        breathed = leaf * float(u[1]) * (0.05 + float(u[0]) / (float(u[0]) + half)) / (1.0 + (dry / closes) ** 4)
        return [float(u[2]) / 60.0 - drunk, (drunk - risen) / c_s, (risen - breathed) / c_b]

    for number, (name, stop) in enumerate((("first", 237600.0), ("second", 187200.0), ("third", 216000.0))):
        light = drawn_steps(rng, stop, 6000.0, 0.0, 950.0, 300.0)
        if name == "third":
            light = stairs(rng, stop, 5400.0, 20.0, 930.0, 5, 300.0)
        poured = bursts(rng, stop, 27000.0, 1200.0, 8.0, 18.0, 300.0)
        light, poured = later(light, 150.0), later(poured, 150.0)
        dryness = ramped(rng, stop, 14400.0, 0.6, 2.3, 900.0)
        t, x = integrated(rates, (w_0, ps_0, pb_0), (light, dryness, poured), stop, 75.0)
        stretch = stuck if stuck is not None and name == "second" else (np.inf, np.inf)

        def spoil(column: str, t: Array, v: Array, stretch: tuple[float, float] = stretch) -> Array:
            if column != "Psi Stamm MPa" or not np.isfinite(stretch[0]):
                return v
            held = (t >= stretch[0]) & (t < stretch[1])
            return np.where(held, v[np.argmax(held)], v)

        def weighed(t: Array, x: Array, u: Array) -> Array:
            return np.asarray(empty + x[:, 0] + c_s * x[:, 1] + c_b * x[:, 2])

        def flow(t: Array, x: Array, u: Array) -> Array:
            return np.asarray(3600.0 * trunk * (x[:, 1] - x[:, 2]))

        sensors = [
            Sensor("Eiche.Waage", "Waage g", "1", weighed, 3.0, 300.0, noise_stated, 1.0, colour),
            Sensor("Eiche.Saftfluss", "Saftfluss g/h", "1", flow, 0.8, 300.0, noise_stated, 0.1, colour),
            Sensor("Eiche.Psi_Stamm", "Psi Stamm MPa", "1", scaled(1, 1.0), 8e-3, 600.0, noise_stated, 5e-3, colour),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"Kammer.Licht": (light, ""), "Kammer.VPD": (dryness, ""), "Kanne.Guss": (poured, "")},
            loggers[number % len(loggers)],
            recorded=["Kammer.VPD"],
            spoil=spoil,
        )
        write(folder / name, rng, made)


def oak_null(folder: Path, rng: Rng) -> Truth:
    loggers = (
        Logger("h", zero=7.5, is_comma=True),
        Logger("min", zero=450.0, is_comma=True, empty=0.03),
        Logger("s", is_comma=True, gap=(80000.0, 88000.0)),
    )
    _oak(folder, rng, colour=0.2, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.2 and is stated rightly, no "
        "units, two rates, a column of an input, decimal commas, empty cells, a gap of 2.2 h, three loggers of h, min "
        "and s",
        FINE,
    )


def oak_closes(folder: Path, rng: Rng) -> Truth:
    closes = rng.uniform(1.15, 1.4)
    _oak(folder, rng, closes=closes, loggers=(Logger("min"), Logger("h", zero=6.0)))
    return Truth(
        f"stomata close as the leaf dries: it breathes 1/(1 + (PB/{closes:.3f} MPa)^4) of what the model says",
        PHYSICS,
        CLOSING,
    )


def oak_stuck(folder: Path, rng: Rng) -> Truth:
    begin = 600.0 * round(rng.uniform(50000.0, 110000.0) / 600.0) - 300.0
    _oak(folder, rng, stuck=(begin, begin + 36000.0), loggers=(Logger("h"), Logger("min", zero=-15.0)))
    return Truth(
        f"for 10 h from {begin:g} s of the second recording on, the psychrometer of the stem shows one value",
        (*RECORDING, *SENSOR),
    )


# --- clay in an oedometer, drained above, FMI 2 Co-Simulation that hides its states; min, kPa, mm
OEDOMETER = OdeModel(
    "oedometer",
    {
        "h": (6.667e-3, "m"),
        "kk": (1e-13, "m^2/(Pa*s)"),
        "k_d": (2.6e-11, "m/(Pa*s)"),
        "m_1": (4.5e-7, "1/Pa"),
        "m_2": (5e-7, "1/Pa"),
        "m_3": (5.5e-7, "1/Pa"),
        "tau": (12.0, "s"),
        "p_begin": (2e4, "Pa"),
    },
    {"load": "Pa", "back": "Pa"},
    {
        "p": ("Pa", "p_begin", "(load - p)/tau"),
        "e_1": ("", "m_1*p_begin", "(k_d*(p - e_1/m_1 - back) - kk/h*((p - e_2/m_2) - (p - e_1/m_1)))/h"),
        "e_2": ("", "m_2*p_begin", "kk/h*(((p - e_2/m_2) - (p - e_1/m_1)) - ((p - e_3/m_3) - (p - e_2/m_2)))/h"),
        "e_3": ("", "m_3*p_begin", "kk/h*((p - e_3/m_3) - (p - e_2/m_2))/h"),
    },
    {"settled": ("m", "h*(e_1 + e_2 + e_3)"), "upper": ("Pa", "p - e_1/m_1"), "lower": ("Pa", "p - e_3/m_3")},
    1.0,
)
OEDOMETER_KNOWN = {"kk": 0.08, "k_d": 0.08, "m_1": 0.05, "m_2": 0.05, "m_3": 0.05, "tau": 0.08}


def _oedometer(
    folder: Path,
    rng: Rng,
    clogs: float = np.inf,
    is_swapped: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> None:
    """The stone above may clog in the second recording: k_d exp(-Q/clogs), Q the water that went through it [mm].

    The columns of both pore pressures may be swapped in the second recording.
    """
    OEDOMETER.build(folder)
    parts = programme("press", ("load", "kPa")) + programme("burette", ("back", "kPa"))
    parts += with_numbers("clay", "oedometer", "internal")
    wires = "  - press.load -> clay.load\n  - burette.back -> clay.back\n"
    scenario(folder, "Clay in an oedometer", 14400.0, 5, 10, parts, wires)
    data_sheet(folder, OEDOMETER, OEDOMETER_KNOWN)
    h, kk, k_d, *soft, tau, begin = drawn(rng, OEDOMETER, OEDOMETER_KNOWN)
    # Lengths are in mm, pressures in kPa.
    thick, passes, drains, wide = 1e3 * h, 1e9 * kk, 1e6 * k_d, 1e3 * np.asarray(soft)

    def pressure(layer: int) -> Callable[[Array, Array, Array], Array]:
        """Of the water in a layer [kPa]."""
        return lambda t, x, u: np.asarray(x[:, 0] - x[:, 1 + layer] / wide[layer])

    for number, (name, stop) in enumerate((("first", 14400.0), ("second", 10800.0), ("third", 12600.0))):
        blocks = clogs if name == "second" else np.inf

        def rates(t: float, x: Array, u: Array, blocks: float = blocks) -> list[float]:
            """Pressure of the ram, strains, and the water that went through the stone, either way [mm]."""
            water = x[0] - x[1:4] / wide
            up = passes / thick * np.diff(water)
            out = drains * np.exp(-x[4] / blocks) * (water[0] - u[1])
            return [
                float(u[0] - x[0]) / tau,
                float(out - up[0]) / thick,
                float(up[0] - up[1]) / thick,
                float(up[1]) / thick,
                abs(float(out)),
            ]

        load = drawn_steps(rng, stop, 800.0, 25.0, 120.0, 10.0)
        if name == "third":
            load = stairs(rng, stop, 700.0, 28.0, 116.0, 5, 10.0)
        back = drawn_steps(rng, stop, 1500.0, 0.0, 24.0, 10.0)
        load, back = later(load, 5.0), later(back, 5.0)
        first = 1e-3 * begin
        t, x = integrated(rates, (first, *(first * wide), 0.0), (load, back), stop, 2.5)

        def settled(t: Array, x: Array, u: Array) -> Array:
            return np.asarray(thick * x[:, 1:4].sum(axis=1))

        above, below = (2, 0) if is_swapped and name == "second" else (0, 2)
        sensors = [
            Sensor("clay.settled", "Setzung mm", "mm", settled, 4e-3, 10.0, noise_stated, 1e-3),
            Sensor("clay.upper", "PWD oben kPa", "kPa", pressure(above), 0.4, 10.0, noise_stated, 0.1),
            Sensor("clay.lower", "PWD unten kPa", "kPa", pressure(below), 0.4, 10.0, noise_stated, 0.1),
        ]
        programmes = {"press.load": (load, "kPa"), "burette.back": (back, "kPa")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def oedometer_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=10.0), Logger("h", zero=9.0, empty=0.02), Logger("s", gap=(5000.0, 5500.0)))
    _oedometer(folder, rng, noise_stated=0.9, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.1 times too small, empty cells, a gap of 500 s, three loggers "
        "of min, h and s, Co-Simulation",
        FINE,
    )


def oedometer_clogged(folder: Path, rng: Rng) -> Truth:
    clogs = rng.uniform(1.6, 2.4)
    _oedometer(folder, rng, clogs=clogs, loggers=(Logger("s", zero=20.0), Logger("min"), Logger("min")))
    return Truth(
        "in the second recording alone, the stone above clogs with the water Q that went through it: k_d "
        f"exp(-Q/{clogs:.3f} mm)",
        (*PHYSICS, *RECORDING),
        (*WORN, *RATED),
    )


def oedometer_swapped(folder: Path, rng: Rng) -> Truth:
    _oedometer(folder, rng, is_swapped=True, loggers=(PLAIN, Logger("min", zero=-4.0)))
    return Truth("the columns of both pore pressures are swapped in the second recording", (*RECORDING, *SENSOR))


# --- smoke in a chamber for detectors, FMI 2 Co-Simulation that hides its states; s, 1/s, m^3/h, rpm, 1/cm^3
CHAMBER = OdeModel(
    "chamber",
    {
        "V_u": (1.0, "m^3"),
        "V_l": (1.4, "m^3"),
        "mix_0": (3e-3, "m^3/s"),
        "mix_s": (2.5e-4, "m^3/rad"),
        "leak": (8e-4, "m^3/s"),
        "dep_0": (8e-5, "1/s"),
        "dep_s": (8e-6, "1/rad"),
        "tau": (26.0, "s"),
    },
    {"smoke": "1/s", "exhaust": "m^3/s", "stir": "rad/s"},
    {
        "N_u": ("1/m^3", "0.0", "(smoke - (mix_0 + mix_s*stir)*(N_u - N_l))/V_u - (dep_0 + dep_s*stir)*N_u"),
        "N_l": (
            "1/m^3",
            "0.0",
            "((mix_0 + mix_s*stir)*(N_u - N_l) - (exhaust + leak)*N_l)/V_l - (dep_0 + dep_s*stir)*N_l",
        ),
        "N_d": ("1/m^3", "0.0", "(N_u - N_d)/tau"),
    },
    {"ceiling": ("1/m^3", "N_u"), "counter": ("1/m^3", "N_l"), "detector": ("1/m^3", "N_d")},
    0.5,
)
CHAMBER_KNOWN = {"V_u": 0.03, "V_l": 0.03, "mix_0": 0.1, "mix_s": 0.06, "leak": 0.08, "dep_0": 0.1, "dep_s": 0.1}
CHAMBER_KNOWN |= {"tau": 0.08}


def _smoke(
    folder: Path,
    rng: Rng,
    meets: float = 0.0,
    corner: tuple[float, float] | None = None,
    is_feet: bool = False,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Particles may meet and stick, meets N^2 in each layer, meets in 1e-6 cm^3/s = 1e-12 m^3/s.

    Smoke may stay in a corner: its volume [m^3], and what it exchanges with the lower layer [m^3/s]. The exhaust of
    the second recording may be in cubic feet a minute.
    """
    CHAMBER.build(folder)
    names = (("burner", "smoke", "1/s"), ("fan", "exhaust", "m^3/h"), ("stirrer", "stir", "rpm"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("chamber", "chamber", "internal")
    wires = "".join(f"  - {c}.{n} -> chamber.{n}\n" for c, n, _ in names)
    scenario(folder, "Smoke in a chamber", 4800.0, 2, 4, parts, wires)
    data_sheet(folder, CHAMBER, CHAMBER_KNOWN)
    v_u, v_l, mix_0, mix_s, leak, dep_0, dep_s, tau = drawn(rng, CHAMBER, CHAMBER_KNOWN)
    v_c, passes = corner if corner is not None else (1.0, 0.0)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """In 1e6/cm^3 = 1e12/m^3; the last is that of the corner."""
        upper, lower, shown, held = (float(s) for s in x)
        stir = float(u[2]) / RPM
        mixed, sunk = (mix_0 + mix_s * stir) * (upper - lower), dep_0 + dep_s * stir
        hidden = passes * (lower - held)
        return [
            (1e-12 * float(u[0]) - mixed) / v_u - sunk * upper - meets * upper**2,
            (mixed - (float(u[1]) / 3600.0 + leak) * lower - hidden) / v_l - sunk * lower - meets * lower**2,
            (upper - shown) / tau,
            hidden / v_c,
        ]

    for number, (name, stop) in enumerate((("first", 4800.0), ("second", 3600.0), ("third", 4200.0))):
        smoke = bursts(rng, stop, 90.0, 200.0, 2e9, 1.4e10, 4.0)
        exhaust = drawn_steps(rng, stop, 180.0, 2.0, 26.0, 4.0)
        if name == "third":
            exhaust = wandering(rng, stop, 120.0, 3.0, 25.0, 4.0)
        smoke, exhaust = later(smoke, 2.0), later(exhaust, 2.0)
        stir = ramped(rng, stop, 240.0, 20.0, 260.0, 20.0)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0), (smoke, exhaust, stir), stop, 2.0)
        told = {}
        if is_feet and name == "second":
            feet = tuple(float(f"{v / CUBIC_FOOT_A_MINUTE:.3g}") for v in exhaust.levels)
            told = {"fan.exhaust": Steps(exhaust.times, feet)}
        sensors = [
            Sensor(f"chamber.{n}", c, "1/cm^3", scaled(i, 1e6), 1.5e4, 4.0, noise_stated, 1e3, wild=wild)
            for i, (n, c) in enumerate((("ceiling", "OPC Decke"), ("counter", "OPC Boden"), ("detector", "Melder")))
        ]
        made = Written(
            t,
            x,
            sensors,
            {"burner.smoke": (smoke, "1/s"), "fan.exhaust": (exhaust, "m^3/h"), "stirrer.stir": (stir, "rpm")},
            loggers[number % len(loggers)],
            recorded=["stirrer.stir"],
            told=told,
        )
        write(folder / name, rng, made)


def smoke_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=100.0, empty=0.02), Logger("min", zero=3.0, gap=(1500.0, 1620.0)), Logger("h"))
    _smoke(folder, rng, noise_stated=1.05, wild=0.004, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.05 times too large, wild readings, a column of an input, empty "
        "cells, a gap of 2 min, three loggers of s, min and h, Co-Simulation",
        FINE,
    )


def smoke_sticks(folder: Path, rng: Rng) -> Truth:
    meets = rng.uniform(1.2e-3, 1.9e-3)
    _smoke(folder, rng, meets=meets, loggers=(Logger("min", zero=1.0), PLAIN))
    return Truth(
        f"particles of smoke meet and stick: {1e3 * meets:.4f}e-9 cm^3/s N^2 are lost, in both layers",
        PHYSICS,
        PAIRED,
    )


def smoke_two(folder: Path, rng: Rng) -> Truth:
    meets, volume, passes = rng.uniform(1.2e-3, 1.9e-3), rng.uniform(0.5, 0.8), rng.uniform(1.6e-3, 2.6e-3)
    _smoke(folder, rng, meets=meets, corner=(volume, passes), loggers=(PLAIN, Logger("min", zero=-6.0)))
    return Truth(
        f"particles of smoke meet and stick: {1e3 * meets:.4f}e-9 cm^3/s N^2 are lost, in both layers; and smoke stays "
        f"in a corner of {volume:.3f} m^3, which exchanges {1e3 * passes:.3f} L/s with the lower layer",
        PHYSICS,
        (*PAIRED, *STORED),
    )


def smoke_feet(folder: Path, rng: Rng) -> Truth:
    _smoke(folder, rng, is_feet=True, loggers=(Logger("s", zero=8.0), Logger("min")))
    return Truth(
        "the exhaust of the second recording is in cubic feet a minute, and is said to be in m^3/h",
        (*RECORDING, *SENSOR),
    )


# --- a mash tun, FMI 3 Model Exchange; min, kW, rpm, g/min, L/min, degC, g/L; two rates
MASH = OdeModel(
    "mash_tun",
    {
        "C_j": (2.6e4, "J/K"),
        "C_m": (1.9e5, "J/K"),
        "eta": (0.92, ""),
        "U_0": (90.0, "W/K"),
        "U_s": (6.0, "W*s/(K*rad)"),
        "h_j": (14.0, "W/K"),
        "h_m": (9.0, "W/K"),
        "k_s": (5e-4, "1/s"),
        "b_s": (0.06, "1/K"),
        "k_d": (6e-5, "1/s"),
        "b_d": (0.18, "1/K"),
        "y": (1.05, ""),
        "f_s": (12.0, "1/m^3"),
        "f_e": (0.09, "1/kg"),
        "V": (0.05, "m^3"),
        "T_begin": (321.15, "K"),
        "S_begin": (90.0, "kg/m^3"),
    },
    {"heat": "W", "stir": "rad/s", "malt": "kg/s", "draw": "m^3/s", "room": "K"},
    {
        "T_j": ("K", "T_begin", "(eta*heat - (U_0 + U_s*stir)*(T_j - T_m) - h_j*(T_j - room))/C_j"),
        "T_m": ("K", "T_begin", "((U_0 + U_s*stir)*(T_j - T_m) - h_m*(T_m - room))/C_m"),
        "E": ("", "0.6", "f_e*malt - k_d*exp(b_d*(T_m - 338.15))*E - draw/V*E"),
        "S": ("kg/m^3", "S_begin", "f_s*malt - k_s*exp(b_s*(T_m - 338.15))*E*S - draw/V*S"),
        "M": ("kg/m^3", "0.0", "y*k_s*exp(b_s*(T_m - 338.15))*E*S - draw/V*M"),
    },
    {"jacket": ("K", "T_j"), "mash": ("K", "T_m"), "sugar": ("kg/m^3", "M")},
    1.0,
)
MASH_KNOWN = {
    "C_j": 0.05,
    "C_m": 0.03,
    "eta": 0.03,
    "U_0": 0.06,
    "U_s": 0.08,
    "h_j": 0.08,
    "h_m": 0.08,
    "k_s": 0.08,
    "b_s": 0.05,
    "k_d": 0.1,
    "b_d": 0.05,
    "y": 0.01,
    "f_s": 0.03,
    "f_e": 0.06,
    "V": 0.01,
}


def _mash(
    folder: Path,
    rng: Rng,
    thickens: float = np.inf,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> None:
    """Wort is drawn off, and liquor as warm replaces it; starch may thicken the mash: U/(1 + S/thickens), in g/L.

    The second recording may be said to have had the heating of another run.
    """
    build3(MASH, folder, has_co_simulation=False)
    names = (
        ("element", "heat", "kW"),
        ("paddle", "stir", "rpm"),
        ("hopper", "malt", "g/min"),
        ("tap", "draw", "L/min"),
        ("hall", "room", "degC"),
    )
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("tun", "mash_tun")
    wires = "".join(f"  - {c}.{n} -> tun.{n}\n" for c, n, _ in names)
    scenario(folder, "A mash tun", 7200.0, 5, 10, parts, wires)
    data_sheet(folder, MASH, MASH_KNOWN)
    c_j, c_m, eta, u_0, u_s, h_j, h_m, *more = drawn(rng, MASH, MASH_KNOWN)
    k_s, b_s, k_d, b_d, y, f_s, f_e, volume, begin, starch_0 = more

    def rates(t: float, x: Array, u: Array) -> list[float]:
        jacket, mash, enzyme, starch, sugar = (float(s) for s in x)
        passed = (u_0 + u_s * float(u[1]) / RPM) / (1.0 + starch / thickens) * (jacket - mash)
        malt, out, room = float(u[2]) / 6e4, float(u[3]) / 6e4 / volume, float(u[4]) + CELSIUS
        split = k_s * np.exp(b_s * (mash - 338.15)) * enzyme * starch
        return [
            (1e3 * eta * float(u[0]) - passed - h_j * (jacket - room)) / c_j,
            (passed - h_m * (mash - room)) / c_m,
            f_e * malt - k_d * np.exp(b_d * (mash - 338.15)) * enzyme - out * enzyme,
            f_s * malt - split - out * starch,
            y * split - out * sugar,
        ]

    other = later(drawn_steps(rng, 6000.0, 360.0, 0.1, 3.0, 10.0), 5.0)
    for number, (name, stop) in enumerate((("first", 7200.0), ("second", 6000.0), ("third", 6600.0))):
        heat = drawn_steps(rng, stop, 360.0, 0.1, 3.0, 10.0)
        if name == "third":
            heat = telegraph(rng, stop, 330.0, 0.2, 2.9, 10.0)
        stir = drawn_steps(rng, stop, 500.0, 15.0, 95.0, 10.0)
        malt = bursts(rng, stop, 500.0, 200.0, 400.0, 1200.0, 10.0)
        tapped = bursts(rng, stop, 900.0, 200.0, 4.0, 9.0, 10.0)
        heat, stir, malt, tapped = (later(s, 5.0) for s in (heat, stir, malt, tapped))
        room = ramped(rng, stop, 1500.0, 16.0, 24.0, 60.0)
        t, x = integrated(rates, (begin, begin, 0.6, starch_0, 0.0), (heat, stir, malt, tapped, room), stop, 5.0)
        sensors = [
            Sensor("tun.jacket", "Mantel degC", "degC", celsius(0), 0.15, 10.0, noise_stated, 0.05),
            Sensor("tun.mash", "Maische degC", "degC", celsius(1), 0.08, 10.0, noise_stated, 0.02),
            Sensor("tun.sugar", "Maltose g/L", "g/L", scaled(4, 1.0), 0.4, 20.0, noise_stated, 0.1),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "element.heat": (heat, "kW"),
                "paddle.stir": (stir, "rpm"),
                "hopper.malt": (malt, "g/min"),
                "tap.draw": (tapped, "L/min"),
                "hall.room": (room, "degC"),
            },
            loggers[number % len(loggers)],
            recorded=["hall.room"],
            told={"element.heat": other} if is_other and name == "second" else {},
        )
        write(folder / name, rng, made)
        idle_column(folder / name, "lid", lambda n: np.zeros(n))


def mash_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=-5.0), Logger("s", zero=1800.0, jitter=0.2), Logger("h", gap=(2400.0, 2640.0)))
    _mash(folder, rng, noise_stated=None, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, two rates, a column of an input, a column that nobody "
        "uses, jitter, a gap of 4 min, three loggers of min, s and h",
        FINE,
    )


def mash_thick(folder: Path, rng: Rng) -> Truth:
    thickens = rng.uniform(110.0, 170.0)
    _mash(folder, rng, thickens=thickens, loggers=(Logger("s"), Logger("min", zero=30.0)))
    return Truth(
        f"starch thickens the mash: heat passes from the jacket 1/(1 + S/{thickens:.1f} g/L) as well as the model says",
        PHYSICS,
        THICKENED,
    )


def mash_other_run(folder: Path, rng: Rng) -> Truth:
    _mash(folder, rng, is_other=True, loggers=(Logger("min"), PLAIN))
    return Truth("the second recording is said to have had the heating of another run", (*RECORDING, *SENSOR))


# --- vacuum line (FMI 3, Co-Simulation) and claw (FMI 2, Model Exchange) of a milking machine; s, rpm, L/min, g/s, kPa
VACUUM_LINE = OdeModel(
    "vacuum_line",
    {
        "V": (0.02, "m^3"),
        "D": (1e-5, "m^3/rad"),
        "leak": (3e-9, "m^3/(Pa*s)"),
        "tau": (1.5, "s"),
        "w_begin": (45.0, "rad/s"),
        "p_begin": (4e4, "Pa"),
    },
    {"drive": "rad/s", "taken": "m^3/s"},
    {
        "w": ("rad/s", "w_begin", "(drive - w)/tau"),
        "p": ("Pa", "p_begin", f"{ATMOSPHERE}/V*(D*w*(1.0 - p/{ATMOSPHERE}) - taken - leak*p)"),
    },
    {"vacuum": ("Pa", "p"), "pump": ("rad/s", "w")},
    0.01,
)
CLAW = OdeModel(
    "claw",
    {
        "V_c": (1.5e-3, "m^3"),
        "g": (4e-8, "m^3/(Pa*s)"),
        "m_h": (0.5, "kg"),
        "bleed": (1.3e-9, "m^3/(Pa*s)"),
        "k_m": (3.3e-5, "1/(Pa*s)"),
        "c_begin": (3.6e4, "Pa"),
        "m_begin": (0.15, "kg"),
    },
    {"line": "Pa", "pulse": "m^3/s", "milk": "kg/s"},
    {
        "p_c": ("Pa", "c_begin", f"{ATMOSPHERE}/V_c*(g/(1.0 + m/m_h)*(line - p_c) - bleed*p_c - pulse)"),
        "m": ("kg", "m_begin", "milk - k_m*m*(line - p_c)"),
    },
    {"vacuum": ("Pa", "p_c"), "bowl": ("kg", "m"), "air": ("m^3/s", "g/(1.0 + m/m_h)*(line - p_c)")},
    0.01,
)
VACUUM_LINE_KNOWN = {"V": 0.04, "D": 0.04, "leak": 0.08, "tau": 0.08}
CLAW_KNOWN = {"V_c": 0.05, "g": 0.05, "m_h": 0.08, "bleed": 0.06, "k_m": 0.06}


def _milk(
    folder: Path,
    rng: Rng,
    weeps: float = 0.0,
    begins: float = 40.0,
    foams: float = np.inf,
    lag: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Two FMUs; a valve of the line may weep above a vacuum: weeps (p - begins), weeps in L/s/kPa, begins in kPa.

    Milk may foam: it is drawn off 1/(1 + m/foams) as fast, foams in kg. The gauge of the claw may lag in the second
    recording, with a time constant `lag` [s].
    """
    build3(VACUUM_LINE, folder, has_exchange=False)
    CLAW.build(folder)
    data_sheet(folder, VACUUM_LINE, VACUUM_LINE_KNOWN)
    (folder / "numbers.yaml").rename(folder / "line.yaml")
    data_sheet(folder, CLAW, CLAW_KNOWN)
    parts = (
        programme("inverter", ("drive", "rpm"))
        + programme("pulsator", ("pulse", "L/min"))
        + programme("udder", ("milk", "g/s"))
        + with_numbers("line", "vacuum_line", "internal").replace("numbers.yaml", "line.yaml")
        + with_numbers("claw", "claw")
    )
    wires = (
        "  - inverter.drive -> line.drive\n  - pulsator.pulse -> claw.pulse\n  - udder.milk -> claw.milk\n"
        "  - line.vacuum -> claw.line\n  - claw.air -> line.taken\n"
    )
    scenario(folder, "A milking machine", 300.0, 0.02, 0.2, parts, wires)
    volume, stroke, leak, tau, w_begin, p_begin = drawn(rng, VACUUM_LINE, VACUUM_LINE_KNOWN)
    small, g, m_h, bleed, k_m, c_begin, m_begin = drawn(rng, CLAW, CLAW_KNOWN)
    # Volumes are in L, pressures in kPa.
    volume, stroke, leak, small, g, bleed, k_m = (
        1e3 * volume,
        1e3 * stroke,
        1e6 * leak,
        1e3 * small,
        1e6 * g,
        1e6 * bleed,
        1e3 * k_m,
    )
    air = 1e-3 * ATMOSPHERE

    for number, (name, stop) in enumerate((("first", 300.0), ("second", 240.0), ("third", 270.0))):
        slow = lag if name == "second" else 0.0

        def rates(t: float, x: Array, u: Array, slow: float = slow) -> list[float]:
            """The last is what a slow gauge shows."""
            w, p, p_c, m, shown = (float(s) for s in x)
            taken = g / (1.0 + m / m_h) * (p - p_c)
            return [
                (float(u[0]) / RPM - w) / tau,
                air / volume * (stroke * w * (1.0 - p / air) - taken - leak * p - weeps * max(p - begins, 0.0)),
                air / small * (taken - bleed * p_c - float(u[1]) / 60.0),
                1e-3 * float(u[2]) - k_m * m / (1.0 + m / foams) * (p - p_c),
                (p_c - shown) / slow if slow else 0.0,
            ]

        drive = drawn_steps(rng, stop, 16.0, 200.0, 600.0, 0.2)
        if name == "third":
            drive = wandering(rng, stop, 9.0, 210.0, 590.0, 0.2)
        pulse = drawn_steps(rng, stop, 8.0, 0.5, 6.0, 0.2)
        milk = drawn_steps(rng, stop, 11.0, 5.0, 42.0, 0.2)
        drive, pulse, milk = later(drive, 0.1), later(pulse, 0.1), later(milk, 0.1)
        start = (w_begin, 1e-3 * p_begin, 1e-3 * c_begin, m_begin, 1e-3 * c_begin)
        t, x = integrated(rates, start, (drive, pulse, milk), stop, 0.05)
        sensors = [
            Sensor("line.vacuum", "Leitung kPa", "kPa", scaled(1, 1.0), 0.1, 0.2, noise_stated, 0.05),
            Sensor(
                "claw.vacuum", "Sammelstück kPa", "kPa", scaled(4 if slow else 2, 1.0), 0.1, 0.2, noise_stated, 0.05
            ),
            Sensor("claw.bowl", "Milch g", "g", scaled(3, 1e3), 4.0, 0.2, noise_stated, 1.0),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"inverter.drive": (drive, "rpm"), "pulsator.pulse": (pulse, "L/min"), "udder.milk": (milk, "g/s")},
            loggers[number % len(loggers)],
        )
        write(folder / name, rng, made)


def milk_weeps(folder: Path, rng: Rng) -> Truth:
    weeps, begins = rng.uniform(6e-3, 9e-3), rng.uniform(40.5, 43.0)
    _milk(folder, rng, weeps=weeps, begins=begins, loggers=(Logger("s", zero=40.0), Logger("min")))
    return Truth(
        f"a valve of the line weeps above a vacuum of {begins:.2f} kPa: {1e3 * weeps:.3f} mL/s/kPa (p - {begins:.2f} "
        "kPa)",
        PHYSICS,
        LEAKING,
    )


def milk_two(folder: Path, rng: Rng) -> Truth:
    weeps, begins, foams = rng.uniform(6e-3, 9e-3), rng.uniform(40.5, 43.0), rng.uniform(0.35, 0.55)
    _milk(folder, rng, weeps=weeps, begins=begins, foams=foams, loggers=(Logger("min", zero=2.0), PLAIN))
    return Truth(
        f"a valve of the line weeps above a vacuum of {begins:.2f} kPa: {1e3 * weeps:.3f} mL/s/kPa (p - {begins:.2f} "
        f"kPa); and milk foams in the bowl: it is drawn off 1/(1 + m/{foams:.3f} kg) as fast",
        PHYSICS,
        (*LEAKING, *RATED, "saturation"),
    )


def milk_lag(folder: Path, rng: Rng) -> Truth:
    lag = rng.uniform(1.6, 2.6)
    _milk(folder, rng, lag=lag, loggers=(PLAIN, Logger("ms", zero=2e3)))
    return Truth(
        f"milk stands in the tube of the claw's gauge in the second recording: it lags, time constant {lag:.2f} s",
        (*RECORDING, *SENSOR),
    )


# --- a weight on one coil in a climate cabinet, from a source with inner resistance; the tool's own units
WINDING = {
    "reference_resistance": (3.4, "ohm", 0.02),
    "heat_transfer_coefficient": (80.0, "W/(m^2*K)", 0.05),
    "area": (130.0, "mm^2", 0.0),
    "volume": (11.0, "mm^3", 0.0),
    "density": (6450.0, "kg/m^3", 0.0),
    "specific_heat": (830.0, "J/(kg*K)", 0.05),
    "heating_a": (0.235, "N/mm", 0.02),
    "heating_b": (17443.0, '"1"', None),
    "heating_c": (0.1669, "1/K", None),
    "heating_d": (0.166, "N/mm", 0.01),
    "cooling_a": (0.206, "N/mm", 0.02),
    "cooling_b": (696.0, '"1"', None),
    "cooling_c": (0.1549, "1/K", None),
    "cooling_d": (0.167, "N/mm", None),
}
#: Resistances of the wires and of the source [ohm], weight [kg], rise of the coil's resistance [1/K].
WINDING_WIRES, WINDING_INNER, WINDING_MASS, WINDING_RISE = 0.2, 0.6, 0.3, 8e-4


def _weight_files(folder: Path) -> None:
    """Scenario and parameter set of the one coil."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = ["title: A coil of our own winding", "parameters:"]
    for name, (value, unit, uncertainty) in WINDING.items():
        known = "" if uncertainty is None else f", uncertainty: {uncertainty:g}"
        lines.append(f'  {name}: {{value: {value:g}, unit: {unit}, source: "own winding"{known}}}')
    lines += [
        '  use_regressed_cooling_rate: {value: false, source: "cools as it heats"}',
        '  initial_temperature: {value: 23, unit: degC, source: "cabinet"}',
        '  reference_temperature: {value: 23, unit: degC, source: "cabinet"}',
        f'  resistance_temperature_coefficient: {{value: {WINDING_RISE:g}, unit: 1/K, source: "own measurement"}}',
        '  coil_rest_length: {value: 14, unit: mm, source: "calliper"}',
    ]
    (folder / "numbers.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    parts = (
        "  source:\n    kind: programme\n    outputs:\n      voltage: {unit: V, points: [[0 s, 0 V]]}\n"
        + programme("cabinet", ("temperature", "degC")).replace("constant: 0 degC", "constant: 23 degC")
        + f"  circuit: {{kind: ngspice, strings: [1], supply: common, supply_resistance: {WINDING_INNER} ohm, "
        f"string_resistance: {WINDING_WIRES} ohm, start: {{resistance: 3.4 ohm}}}}\n"
        "  coil: {kind: actuator, fmu: thermal_stiffness, electrical: circuit, ambient: cabinet, mechanical: weight, "
        "parameter_set: numbers.yaml}\n"
        f"  weight: {{kind: hanging_mass, coils: 1, mass: {1e3 * WINDING_MASS:g} g}}\n"
    )
    wires = "  - source.voltage -> circuit.supply_voltage\n"
    scenario(folder, "A weight on one coil in a climate cabinet", 110.0, 0.05, 0.1, parts, wires)


def _branch(numbers: Sequence[float], warm: float | Array) -> Array:
    """Equation (2) of the paper [N/mm], of temperatures [degC]."""
    a, b, c, d = numbers
    return np.asarray(a * np.exp(-b * np.exp(-c * np.asarray(warm))) + d)


def _weight_course(
    numbers: dict[str, Any],
    volts: Steps,
    cabinet: Steps,
    start: tuple[float, bool],
    stop: float,
    step: float,
    rubs: float,
) -> tuple[Array, Array]:
    """Times [s], and temperature [degC], extension [mm], current [A] and voltage at the terminals [V].

    Args:
        numbers: Resistance, conductance [W/K], capacity [J/K], branches.
        volts: Of the source.
        cabinet: Its temperature [degC].
        start: Temperature of the coil [degC], and whether it comes from above.
        stop: End [s].
        step: Of time [s].
        rubs: Friction of the guide of the weight [N].
    """
    times: Array = step * np.arange(round(stop / step) + 1, dtype=np.float64)
    emf, around = volts.at(times), cabinet.at(times)
    heating, cooling = numbers["heating"], numbers["cooling"]
    scan = np.arange(200.0, 0.0, -0.01)
    is_above = _branch(cooling, scan) >= _branch(heating, scan)
    crossing = float(scan[np.argmax(is_above)]) if is_above.any() else -np.inf

    def resistance(warm: float) -> float:
        return float(numbers["resistance"] * (1.0 + WINDING_RISE * (warm - 23.0)))

    def current(warm: float, v: float) -> float:
        return v / (WINDING_INNER + WINDING_WIRES + resistance(warm))

    def relaxed(warm: float, at: float, v: float, room: float, span: float) -> float:
        end = room + current(at, v) ** 2 * resistance(at) / numbers["conductance"]
        return float(end + (warm - end) * np.exp(-numbers["conductance"] * span / numbers["capacity"]))

    warm = start[0]
    stiff = float(_branch(cooling if start[1] else heating, warm))
    weight = WINDING_MASS * GRAVITY
    extended = weight / stiff
    found = np.empty((len(times), 4))
    for i, (v, room) in enumerate(zip(emf, around)):
        up, down = float(_branch(heating, warm)), float(_branch(cooling, warm))
        stiff = up if warm >= crossing else min(max(stiff, min(up, down)), max(up, down))
        extended = min(max(extended, (weight - rubs) / stiff), (weight + rubs) / stiff)
        amps = current(warm, float(v))
        found[i] = (warm, extended, amps, float(v) - WINDING_INNER * amps)
        middle = relaxed(warm, warm, float(v), float(room), step / 2)
        warm = relaxed(warm, middle, float(v), float(room), step)
    return times, found


def _weight(
    folder: Path,
    rng: Rng,
    rubs: float = 0.0,
    begins: float | None = None,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The weight may rub in its guide, with a force [N].

    The coil may still be warm at the begin of the second recording, of a run before it: `begins` [degC].
    """
    _weight_files(folder)

    def off(name: str) -> float:
        """A number as it is."""
        value, _, uncertainty = WINDING[name]
        return float(value * np.exp((uncertainty or 0.0) * rng.normal()))

    numbers = {
        "resistance": off("reference_resistance"),
        "conductance": 1e-6 * off("area") * off("heat_transfer_coefficient"),
        "capacity": 1e-9 * off("density") * off("volume") * off("specific_heat"),
        "heating": [off(f"heating_{n}") for n in "abcd"],
        "cooling": [off(f"cooling_{n}") for n in "abcd"],
    }

    for number, (name, stop) in enumerate((("first", 110.0), ("second", 90.0), ("third", 100.0))):
        volts = drawn_steps(rng, stop, 7.0, 0.0, 2.0, 0.1)
        if name == "third":
            volts = ramped(rng, stop, 7.0, 0.05, 1.95, 0.2)
        volts = later(volts, 0.05)
        cabinet = ramped(rng, stop, 25.0, 20.0, 31.0, 0.5)
        said = cabinet.levels[0]
        start = (said + 0.2 * float(rng.normal()), False)
        if begins is not None and name == "second":
            start = (begins, True)
        t, x = _weight_course(numbers, volts, cabinet, start, stop, 0.0125, rubs)
        sensors = [
            Sensor("supply.current", "I mA", "mA", scaled(2, 1e3), 1.5, 0.1, noise_stated, 0.5),
            Sensor("supply.voltage", "U V", "V", scaled(3, 1.0), 4e-3, 0.1, noise_stated, 1e-3),
            Sensor("coil[1].temperature", "Pyrometer", "degC", scaled(0, 1.0), 0.25, 0.2, noise_stated, 0.1),
            Sensor("coil[1].extension", "Laser mm", "mm", scaled(1, 1.0), 0.05, 0.1, noise_stated, 0.01),
        ]
        points = [[f"{s:.10g} s", f"{v:.10g} V"] for s, v in zip(volts.times, volts.levels)]
        sidecar: dict[str, Any] = {
            "components": {
                "source": {"outputs": {"voltage": {"points": points}}},
                "coil": {"parameters": {"initial_temperature": f"{said:g} degC"}},
            }
        }
        made = Written(
            t,
            x,
            sensors,
            {"cabinet.temperature": (cabinet, "degC")},
            loggers[number % len(loggers)],
            recorded=["cabinet.temperature"],
            sidecar=sidecar,
        )
        write(folder / name, rng, made)


def weight_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=7.0, empty=0.02), Logger("ms", zero=-400.0), Logger("s", gap=(52.0, 55.0)))
    _weight(folder, rng, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, start off by 0.2 K (deviation), noise stated rightly, two rates, a column of "
        "an input, empty cells, a gap of 3 s, loggers of s and ms",
        FINE,
    )


def weight_rubs(folder: Path, rng: Rng) -> Truth:
    rubs = rng.uniform(0.11, 0.18)
    _weight(folder, rng, rubs=rubs, loggers=(PLAIN, Logger("ms", zero=250.0)))
    return Truth(
        f"the weight rubs in its guide with {rubs:.4f} N ({100.0 * rubs / (WINDING_MASS * GRAVITY):.1f} % of it): it "
        "moves only once the coil pulls by that much more or less",
        PHYSICS,
        RUBBING,
    )


def weight_warm(folder: Path, rng: Rng) -> Truth:
    begins = rng.uniform(47.0, 55.0)
    _weight(folder, rng, begins=begins, loggers=(Logger("ms"), Logger("s", zero=2.0)))
    return Truth(
        f"the second recording was begun after another run: the coil is still {begins:.1f} degC warm, coming from "
        "above, and is said to be as warm as the cabinet",
        (*RECORDING, *SENSOR),
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    smoke_two,
    oak_null,
    weight_warm,
    float_cowl,
    mash_null,
    oedometer_swapped,
    milk_weeps,
    mount_null,
    oak_stuck,
    weight_null,
    mash_thick,
    smoke_feet,
    float_null,
    mount_lost,
    oedometer_clogged,
    milk_lag,
    smoke_null,
    weight_rubs,
    float_idle,
    oak_closes,
    milk_two,
    mash_other_run,
    oedometer_null,
    mount_cogging,
    smoke_sticks,
)
