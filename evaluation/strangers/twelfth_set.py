"""Twelfth set: an exosuit's cable, a spindle, a drug patch, a hot end, a balloon, a steamer, a U-tube, an ion pump.

Written without a look at the library of laws, its proof, its tests or its thresholds, and without a diagnosis of any of
its cases; of what was reported on the earlier sets, the author had read nothing but the titles of the last commits.
Truths are integrated by scipy from equations that stand here. How large an effect is, and how far the numbers are off,
is drawn; the deviations of the numbers are those that a parameter set states. Recordings of a rig differ in length and
in logger; the one that is held out was partly made with a programme of another kind, within the range of the others.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.strangers.eighth_set import second_clock
from evaluation.strangers.eleventh_set import DEGREES, LEAKING, RPM, RUBBING, ramps, telegraph
from evaluation.strangers.fifth_set import FOUR, FOUR_SPLIT, GRAVITY, integrated
from evaluation.strangers.first_set import PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import between, bursts, data_sheet, scaled
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Steps, Written, celsius, drawn_steps, write
from evaluation.strangers.tenth_set import stairs, swept, within
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth

#: Feet in a metre; density of water [kg/m^3].
FEET, DENSITY = 3.28084, 1000.0
#: Laws that are true where a resistance grows with the square of a speed.
SQUARE = (
    "quadratic_drag",
    "quadratic_damping",
    "quadratic_loss",
    "turbulent_loss",
    "minor_loss",
    "air_drag",
    "windage",
)


# --- an elbow of an exosuit, pulled by a drum through a cable in a sheath, FMI 2 Model Exchange; N m, deg, N; two rates
EXOSUIT = OdeModel(
    "exosuit",
    {
        "J_drum": (4e-3, "kg*m^2"),
        "b_drum": (0.05, "N*m*s/rad"),
        "r_drum": (0.02, "m"),
        "k_cable": (2e4, "N/m"),
        "d_cable": (60.0, "N*s/m"),
        "r_elbow": (0.05, "m"),
        "J_arm": (0.06, "kg*m^2"),
        "k_sleeve": (4.0, "N*m/rad"),
        "d_sleeve": (0.4, "N*m*s/rad"),
    },
    {"torque": "N*m", "load": "N*m"},
    {
        "theta": ("rad", "0.0", "w"),
        "w": (
            "rad/s",
            "0.0",
            "(torque - b_drum*w - r_drum*(k_cable*(r_drum*theta - r_elbow*phi) + d_cable*(r_drum*w - r_elbow*rate)))"
            "/J_drum",
        ),
        "phi": ("rad", "0.0", "rate"),
        "rate": (
            "rad/s",
            "0.0",
            "(r_elbow*(k_cable*(r_drum*theta - r_elbow*phi) + d_cable*(r_drum*w - r_elbow*rate)) - k_sleeve*phi"
            " - d_sleeve*rate - load)/J_arm",
        ),
    },
    {
        "drum": ("rad", "theta"),
        "elbow": ("rad", "phi"),
        "tension": ("N", "k_cable*(r_drum*theta - r_elbow*phi) + d_cable*(r_drum*w - r_elbow*rate)"),
    },
    1e-3,
)
EXOSUIT_KNOWN = {
    "J_drum": 0.05,
    "b_drum": 0.1,
    "k_cable": 0.06,
    "d_cable": 0.1,
    "r_elbow": 0.02,
    "J_arm": 0.05,
    "k_sleeve": 0.05,
    "d_sleeve": 0.1,
}


def _exosuit(
    folder: Path,
    rng: Rng,
    share: float = 0.0,
    is_exchanged: bool = False,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The cable may lose a share of its tension to the bent sheath, against its motion (Euler and Eytelwein).

    The encoders of drum and elbow may be exchanged in the second recording.
    """
    EXOSUIT.build(folder)
    parts = programme("drive", ("torque", "N*m")) + programme("hand", ("load", "N*m")) + with_numbers("suit", "exosuit")
    wires = "  - drive.torque -> suit.torque\n  - hand.load -> suit.load\n"
    scenario(folder, "An elbow on a Bowden cable", 30.0, 0.01, 0.01, parts, wires)
    data_sheet(folder, EXOSUIT, EXOSUIT_KNOWN)
    j_drum, b_drum, r_drum, k_cable, d_cable, r_elbow, j_arm, k_sleeve, d_sleeve = drawn(rng, EXOSUIT, EXOSUIT_KNOWN)

    def tension(x: Array) -> Array:
        paid = r_drum * x[..., 0] - r_elbow * x[..., 2]
        return np.asarray(k_cable * paid + d_cable * (r_drum * x[..., 1] - r_elbow * x[..., 3]))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        _, w, phi, rate = (float(s) for s in x)
        pull = float(tension(x))
        arrived = pull - share * abs(pull) * np.tanh(r_elbow * rate / 4e-3)
        return [
            w,
            (float(u[0]) - b_drum * w - r_drum * pull) / j_drum,
            rate,
            (r_elbow * arrived - k_sleeve * phi - d_sleeve * rate - float(u[1])) / j_arm,
        ]

    for number, (name, stop) in enumerate((("first", 30.0), ("second", 24.0), ("third", 26.0))):
        torque = drawn_steps(rng, stop, 1.3, 0.2, 1.5, 0.01)
        if name == "third":
            torque = swept(stop, 0.25, 1.45, 5.0, 1.0, 0.1)
        load = drawn_steps(rng, stop, 2.9, 0.0, 0.8, 0.01)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0), (torque, load), stop, 2.5e-3)
        one, two = (2, 0) if is_exchanged and name == "second" else (0, 2)
        sensors = [
            Sensor("suit.drum", "enc_M [deg]", "deg", scaled(one, DEGREES), 0.6, 0.01, noise_stated, 0.1, wild=wild),
            Sensor("suit.elbow", "enc_J [deg]", "deg", scaled(two, DEGREES), 0.3, 0.01, noise_stated, 0.1, wild=wild),
            Sensor("suit.tension", "S-beam", "N", lambda t, x, u: tension(x), 0.8, 0.05, noise_stated, 0.1),
        ]
        programmes = {"drive.torque": (torque, "N*m"), "hand.load": (load, "N*m")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def exosuit_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=412.0, jitter=0.25), Logger("ms", zero=-75.0), Logger("s", empty=0.02))
    _exosuit(folder, rng, noise_stated=0.8, wild=0.008, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.25 times too small, wild readings of both encoders, jitter, "
        "empty cells, two rates, three loggers",
        FINE,
    )


def exosuit_capstan(folder: Path, rng: Rng) -> Truth:
    share = rng.uniform(0.1, 0.18)
    _exosuit(folder, rng, share=share, loggers=(PLAIN, Logger("min", zero=0.5)))
    return Truth(
        f"the sheath rubs at the cable: {share:.3f} times its tension is lost against its motion",
        PHYSICS,
        (*RUBBING, "load_dependent_friction", "capstan", "capstan_friction", "rope_friction"),
    )


def exosuit_exchanged(folder: Path, rng: Rng) -> Truth:
    _exosuit(folder, rng, is_exchanged=True, loggers=(Logger("ms"), PLAIN))
    return Truth(
        "the encoders of drum and elbow are exchanged in the second recording",
        (*RECORDING, *SENSOR),
    )


# --- a spindle with a permanent-magnet motor in the rotor's frame, FMI 3 Model Exchange; V, A, rpm, ms; four runs
SPINDLE = OdeModel(
    "spindle",
    {
        "pairs": (4.0, ""),
        "R": (0.6, "ohm"),
        "L_d": (1.2e-3, "H"),
        "L_q": (1.7e-3, "H"),
        "psi": (0.011, "Wb"),
        "J": (4e-5, "kg*m^2"),
        "b": (4e-5, "N*m*s/rad"),
    },
    {"u_d": "V", "u_q": "V", "brake": "N*m"},
    {
        "i_d": ("A", "0.0", "(u_d - R*i_d + pairs*w*L_q*i_q)/L_d"),
        "i_q": ("A", "0.0", "(u_q - R*i_q - pairs*w*(L_d*i_d + psi))/L_q"),
        "w": ("rad/s", "0.0", "(1.5*pairs*(psi*i_q + (L_d - L_q)*i_d*i_q) - b*w - brake)/J"),
    },
    {"current_d": ("A", "i_d"), "current_q": ("A", "i_q"), "speed": ("rad/s", "w")},
    5e-5,
)
SPINDLE_KNOWN = {"R": 0.04, "L_d": 0.06, "L_q": 0.06, "psi": 0.03, "J": 0.05, "b": 0.1}


def _spindle(
    folder: Path,
    rng: Rng,
    knee: float = np.inf,
    lost: float = 0.0,
    windage: float = 0.0,
    weak: tuple[float, float, float] | None = None,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """Iron may saturate across the magnets: flux L_q knee atan(i_q/knee), `knee` in A.

    The inverter may lose `lost` V to its dead times, against the current; air may brake with windage w^2 [N m s^2].
    Weak is begin [s], end [s] and gain of the sensor of the current i_q in the second recording.
    """
    build3(SPINDLE, folder, has_co_simulation=False)
    parts = programme("inverter", ("u_d", "V"), ("u_q", "V")) + programme("bobbin", ("brake", "N*m"))
    parts += with_numbers("spindle", "spindle")
    wires = "  - inverter.u_d -> spindle.u_d\n  - inverter.u_q -> spindle.u_q\n  - bobbin.brake -> spindle.brake\n"
    scenario(folder, "A spindle", 0.4, 5e-4, 5e-4, parts, wires)
    data_sheet(folder, SPINDLE, SPINDLE_KNOWN)
    pairs, r, l_d, l_q, psi, inertia, b = drawn(rng, SPINDLE, SPINDLE_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        i_d, i_q, w = (float(s) for s in x)
        share = 1.0 / (1.0 + (i_q / knee) ** 2)
        flux_d = l_d * i_d + psi
        flux_q = l_q * (i_q if np.isinf(knee) else knee * np.arctan(i_q / knee))
        error = lost / np.sqrt(i_d**2 + i_q**2 + 0.05**2)
        torque = 1.5 * pairs * (flux_d * i_q - flux_q * i_d)
        return [
            (float(u[0]) - (r + error) * i_d + pairs * w * flux_q) / l_d,
            (float(u[1]) - (r + error) * i_q - pairs * w * flux_d) / (l_q * share),
            (torque - b * w - windage * w * abs(w) - float(u[2])) / inertia,
        ]

    for number, (name, stop) in enumerate(zip(FOUR, (0.4, 0.3, 0.36, 0.32))):
        u_d = drawn_steps(rng, stop, 0.03, -3.0, 1.5, 1e-3)
        u_q = drawn_steps(rng, stop, 0.022, -11.0, 12.0, 1e-3)
        if name == "fourth":
            u_q = telegraph(rng, stop, 0.028, -9.0, 11.0, 1e-3)
        brake = drawn_steps(rng, stop, 0.045, 0.0, 0.12, 1e-3)
        t, x = integrated(rates, (0.0, 0.0, 0.0), (u_d, u_q, brake), stop, 1e-4)

        def shunt(t: Array, x: Array, u: Array, name: str = name) -> Array:
            gain = np.ones(len(t))
            if weak is not None and name == "second":
                gain[within(weak[:2], t)] = weak[2]
            return np.asarray(gain * x[:, 1])

        sensors = [
            Sensor("spindle.current_d", "i_d/A", "A", scaled(0, 1.0), 0.06, 5e-4, 1.0, 0.01),
            Sensor("spindle.current_q", "i_q/A", "A", shunt, 0.06, 5e-4, 1.0, 0.01),
            Sensor("spindle.speed", "n/(1/min)", "rpm", scaled(2, RPM), 8.0, 5e-4, 1.0, 1.0),
        ]
        programmes = {"inverter.u_d": (u_d, "V"), "inverter.u_q": (u_q, "V"), "bobbin.brake": (brake, "N*m")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def spindle_saturation(folder: Path, rng: Rng) -> Truth:
    knee = rng.uniform(7.0, 10.0)
    _spindle(folder, rng, knee=knee, loggers=(Logger("ms"), Logger("ms", zero=640.0), Logger("s")))
    return Truth(
        f"iron saturates across the magnets: flux L_q {knee:.2f} A atan(i_q/{knee:.2f} A)",
        PHYSICS,
        ("saturation", "magnetic_saturation", "saturable_inductance", "inductance_of_current"),
        **FOUR_SPLIT,
    )


def spindle_two(folder: Path, rng: Rng) -> Truth:
    lost, windage = rng.uniform(0.45, 0.7), rng.uniform(9e-7, 1.4e-6)
    _spindle(folder, rng, lost=lost, windage=windage, loggers=(Logger("s", zero=3.0), Logger("ms")))
    return Truth(
        f"the inverter loses {lost:.3f} V to its dead times against the current, and air brakes with {windage:.2e} "
        "N m s^2 w^2",
        PHYSICS,
        (*SQUARE, "voltage_drop", "contact_drop", "brush_drop", "diode_drop", "inverter_dead_time"),
        **FOUR_SPLIT,
    )


def spindle_shunt(folder: Path, rng: Rng) -> Truth:
    begin, gain = 1e-3 * round(rng.uniform(50.0, 150.0)), rng.uniform(0.72, 0.84)
    _spindle(folder, rng, weak=(begin, begin + 0.11, gain), loggers=(Logger("ms", zero=-2.0), Logger("ms")))
    return Truth(
        f"the sensor of the current i_q shows {gain:.3f} times it, {1e3 * begin:g} ms to {1e3 * begin + 110.0:g} ms of "
        "the second recording",
        SENSOR,
        **FOUR_SPLIT,
    )


# --- a textile patch that drives a drug through skin, with plasma and tissue, FMI 3 Co-Simulation, without units; mg, h
PATCH = OdeModel(
    "patch",
    {
        "given": (2e-3, ""),
        "k_skin": (1.9e-4, ""),
        "V_plasma": (20.0, ""),
        "CL": (1.4e-3, ""),
        "Q": (1.1e-3, ""),
        "V_tissue": (28.0, ""),
        "c_begin": (0.0, ""),
    },
    {"current": "", "drip": ""},
    {
        "s": ("", "0.0", "given*current - k_skin*s"),
        "c": ("", "c_begin", "(k_skin*s + drip/3600.0 - CL*c - Q*(c - ct))/V_plasma"),
        "ct": ("", "c_begin", "Q*(c - ct)/V_tissue"),
    },
    {"depot": ("", "s"), "plasma": ("", "c")},
    20.0,
)
PATCH_KNOWN = {"given": 0.05, "k_skin": 0.06, "V_plasma": 0.05, "CL": 0.06, "Q": 0.1, "V_tissue": 0.08}


def _patch(
    folder: Path,
    rng: Rng,
    half: float = np.inf,
    is_unplayed: bool = False,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (Logger("h"),),
) -> None:
    """Clearance may saturate, CL/(1 + c/half).

    The second recording may state a current of the patch that nobody played.
    """
    build3(PATCH, folder, has_exchange=False)
    parts = programme("driver", ("current", "")) + programme("pump", ("drip", ""))
    parts += with_numbers("body", "patch", "internal")
    wires = "  - driver.current -> body.current\n  - pump.drip -> body.drip\n"
    scenario(folder, "A drug patch", 108000.0, 120, 360, parts, wires)
    data_sheet(folder, PATCH, PATCH_KNOWN)
    supplied, k_skin, v_plasma, cleared, q, v_tissue, begin = drawn(rng, PATCH, PATCH_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        s, c, far = (float(w) for w in x)
        loss, across = cleared * c / (1.0 + c / half), q * (c - far)
        return [
            supplied * float(u[0]) - k_skin * s,
            (k_skin * s + float(u[1]) / 3600.0 - loss - across) / v_plasma,
            across / v_tissue,
        ]

    other = drawn_steps(rng, 86400.0, 9000.0, 0.0, 1.2, 360.0)
    for number, (name, stop) in enumerate((("first", 108000.0), ("second", 86400.0), ("third", 97200.0))):
        current = drawn_steps(rng, stop, 9000.0, 0.0, 1.2, 360.0)
        drip = bursts(rng, stop, 12000.0, 5400.0, 3.0, 9.0, 360.0)
        if name == "third":
            current = stairs(rng, stop, 7200.0, 0.05, 1.15, 5, 360.0)
        t, x = integrated(rates, (0.0, begin, begin), (current, drip), stop, 60.0)
        sensors = [
            Sensor("body.depot", "A_skin", "1", scaled(0, 1.0), 0.14, 360.0, noise_stated, 0.01, colour),
            Sensor("body.plasma", "Conc", "1", scaled(1, 1.0), 0.02, 360.0, noise_stated, 0.001, colour),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"driver.current": (current, ""), "pump.drip": (drip, "")},
            loggers[number % len(loggers)],
            told={"driver.current": other} if is_unplayed and name == "second" else {},
        )
        write(folder / name, rng, made)


def patch_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("h", zero=7.5, is_comma=True), Logger("min", zero=480.0, is_comma=True, empty=0.02))
    _patch(folder, rng, noise_stated=None, colour=0.6, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, no units, noise is not stated and that of neighbouring readings correlates by "
        "0.6, decimal commas, hours from 7.5, minutes from 480, empty cells",
        FINE,
    )


def patch_saturable(folder: Path, rng: Rng) -> Truth:
    half = rng.uniform(0.9, 1.4)
    _patch(folder, rng, half=half, loggers=(Logger("h"), Logger("min", zero=15.0)))
    return Truth(
        f"clearance saturates: CL/(1 + c/{half:.3f})",
        PHYSICS,
        ("michaelis_menten", "saturation", "saturating_loss", "saturating_flow", "saturable_elimination"),
    )


def patch_programme(folder: Path, rng: Rng) -> Truth:
    _patch(folder, rng, is_unplayed=True, loggers=(Logger("min"), Logger("h", zero=9.25)))
    return Truth(
        "the second recording states a current of the patch that was played in no recording",
        (*RECORDING, *SENSOR),
    )


# --- the hot end of a printer: block and nozzle, FMI 3, both interfaces; degC, %, mm/s; two rates
HOT_END = OdeModel(
    "hot_end",
    {
        "U": (24.0, "V"),
        "R": (14.4, "ohm"),
        "C_block": (16.0, "J/K"),
        "C_nozzle": (4.5, "J/K"),
        "G": (0.5, "W/K"),
        "h_block": (0.075, "W/K"),
        "h_nozzle": (0.02, "W/K"),
        "h_fan": (0.05, "W/K"),
        "c_melt": (5.4, "J/(m*K)"),
        "T_room": (296.15, "K"),
        "T_begin": (296.15, "K"),
    },
    {"duty": "", "feed": "m/s", "fan": ""},
    {
        "T_b": ("K", "T_begin", "(duty*U*U/R - G*(T_b - T_n) - h_block*(T_b - T_room))/C_block"),
        "T_n": (
            "K",
            "T_begin",
            "(G*(T_b - T_n) - (h_nozzle + h_fan*fan + c_melt*feed)*(T_n - T_room))/C_nozzle",
        ),
    },
    {"block": ("K", "T_b"), "nozzle": ("K", "T_n")},
    0.05,
)
HOT_END_KNOWN = {
    "R": 0.03,
    "C_block": 0.05,
    "C_nozzle": 0.06,
    "G": 0.06,
    "h_block": 0.06,
    "h_nozzle": 0.1,
    "h_fan": 0.08,
    "c_melt": 0.05,
}


def _hot_end(
    folder: Path,
    rng: Rng,
    alpha: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The heater's wire may rise in resistance, R (1 + alpha (T_block - T_room)), `alpha` in 1/K."""
    build3(HOT_END, folder)
    parts = programme("board", ("duty", "'%'"), ("fan", "'%'")).replace("0 '%'", "0 %")
    parts += programme("extruder", ("feed", "mm/s")) + with_numbers("head", "hot_end")
    names = ("board.duty", "board.fan", "extruder.feed")
    wires = "".join(f"  - {n} -> head.{n.partition('.')[2]}\n" for n in names)
    scenario(folder, "A hot end", 1500.0, 1, 2, parts, wires)
    data_sheet(folder, HOT_END, HOT_END_KNOWN)
    volts, r, c_block, c_nozzle, g, h_block, h_nozzle, h_fan, c_melt, room, begin = drawn(rng, HOT_END, HOT_END_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        block, nozzle = (float(s) for s in x)
        power = 0.01 * float(u[0]) * volts**2 / (r * (1.0 + alpha * (block - room)))
        across, taken = g * (block - nozzle), h_nozzle + h_fan * 0.01 * float(u[1]) + c_melt * 1e-3 * float(u[2])
        return [
            (power - across - h_block * (block - room)) / c_block,
            (across - taken * (nozzle - room)) / c_nozzle,
        ]

    for number, (name, stop) in enumerate((("first", 1500.0), ("second", 1800.0), ("third", 1200.0))):
        duty = drawn_steps(rng, stop, 75.0, 5.0, 100.0, 2.0)
        fan = drawn_steps(rng, stop, 160.0, 0.0, 100.0, 2.0)
        feed = bursts(rng, stop, 45.0, 60.0, 1.0, 6.0, 2.0)
        if name == "third":
            duty = ramps(stop, 10.0, 98.0, 360.0, 10.0)
        t, x = integrated(rates, (begin, begin), (duty, fan, feed), stop, 0.5)
        sensors = [
            Sensor("head.block", "T0", "degC", celsius(0), 0.5, 2.0, noise_stated, 0.1),
            Sensor("head.nozzle", "Düse °C", "degC", celsius(1), 0.7, 5.0, noise_stated, 0.25),
        ]
        programmes = {"board.duty": (duty, "%"), "board.fan": (fan, "%"), "extruder.feed": (feed, "mm/s")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def hot_end_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=-4.0, gap=(610.0, 745.0)), Logger("min", zero=2.0, empty=0.015), Logger("s"))
    _hot_end(folder, rng, noise_stated=1.35, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.35 times too large, a gap of 135 s, empty cells, two rates, "
        "three loggers",
        FINE,
    )


def hot_end_wire(folder: Path, rng: Rng) -> Truth:
    alpha = rng.uniform(9e-4, 1.6e-3)
    _hot_end(folder, rng, alpha=alpha, loggers=(PLAIN, Logger("min", zero=1.5)))
    return Truth(
        f"the heater's wire rises in resistance by {100 * alpha:.4f} % a kelvin over the room's temperature",
        PHYSICS,
        ("temperature_dependent_resistance", "resistance_of_temperature", "self_heating_resistance"),
    )


def hot_end_clock(folder: Path, rng: Rng) -> Truth:
    fast = rng.uniform(0.02, 0.035)
    _hot_end(folder, rng, loggers=(Logger("s", zero=30.0), Logger("s", rate=1.0 + fast), Logger("min")))
    return Truth(f"the logger's clock runs {100 * fast:.2f} % fast in the second recording", RECORDING)


# --- a tethered balloon: its air (FMI 2, Model Exchange), rise (FMI 3, Co-Simulation); kW, degC, m; two rates
ENVELOPE = OdeModel(
    "envelope",
    {
        "C_air": (3e4, "J/K"),
        "h_still": (130.0, "W/K"),
        "h_wind": (40.0, "J/(m*K)"),
        "T_begin": (340.15, "K"),
    },
    {"power": "W", "outside": "K", "climb": "m/s"},
    {"T": ("K", "T_begin", "(power - (h_still + h_wind*fabs(climb))*(T - outside))/C_air")},
    {"inside": ("K", "T")},
    0.05,
)
RISE = OdeModel(
    "rise",
    {
        "m": (45.0, "kg"),
        "V": (30.0, "m^3"),
        "rho": (1.2, "kg/m^3"),
        "g": (GRAVITY, "m/s^2"),
        "weight": (22.0, "N"),
        "rope": (2.5, "N/m"),
        "c": (7.0, "N*s/m"),
        "z_begin": (12.0, "m"),
    },
    {"inside": "K", "outside": "K"},
    {
        "z": ("m", "z_begin", "v"),
        "v": ("m/s", "0.0", "(rho*g*V*(1.0 - outside/inside) - weight - rope*z - c*v)/m"),
    },
    {"altitude": ("m", "z"), "climb": ("m/s", "v")},
    0.05,
)
ENVELOPE_KNOWN = {"C_air": 0.05, "h_still": 0.05, "h_wind": 0.1}
RISE_KNOWN = {"m": 0.05, "V": 0.02, "weight": 0.03, "rope": 0.04, "c": 0.1}


def _balloon(
    folder: Path,
    rng: Rng,
    fabric: tuple[float, float] | None = None,
    strayed: float = 0.0,
    is_feet: bool = False,
    noise_stated: float | None = 1.0,
    clock: tuple[str, float] | None = None,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Two FMUs; fabric of the envelope may take up heat of the air, heat capacity [J/K] and transfer [W/K].

    `strayed` is by how much [K] the air's temperature at the begin is off (deviation), which is stated. The altimeter
    may show feet in the first recording.
    """
    ENVELOPE.build(folder)
    build3(RISE, folder, has_exchange=False)
    data_sheet(folder, RISE, RISE_KNOWN)
    (folder / "numbers.yaml").rename(folder / "flight.yaml")
    data_sheet(folder, ENVELOPE, ENVELOPE_KNOWN)
    parts = (
        programme("burner", ("power", "kW"))
        + programme("hall", ("outside", "degC"))
        + with_numbers("envelope", "envelope")
        + with_numbers("rise", "rise", "internal").replace("numbers.yaml", "flight.yaml")
    )
    wires = (
        "  - burner.power -> envelope.power\n  - hall.outside -> envelope.outside\n  - hall.outside -> rise.outside\n"
        "  - rise.climb -> envelope.climb\n  - envelope.inside -> rise.inside\n"
    )
    scenario(folder, "A tethered balloon", 720.0, 0.25, 1, parts, wires)
    c_air, h_still, h_wind, usual = drawn(rng, ENVELOPE, ENVELOPE_KNOWN)
    m, volume, rho, g, weight, rope, c, z_begin = drawn(rng, RISE, RISE_KNOWN)
    c_fabric, taken = fabric or (1.0, 0.0)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        air, z, v, cloth = (float(s) for s in x)
        outside = float(u[1]) + CELSIUS
        loss, stored = (h_still + h_wind * abs(v)) * (air - outside), taken * (air - cloth)
        lift = rho * g * volume * (1.0 - outside / air)
        return [
            (1e3 * float(u[0]) - loss - stored) / c_air,
            v,
            (lift - weight - rope * z - c * v) / m,
            stored / c_fabric,
        ]

    for number, (name, stop) in enumerate((("first", 720.0), ("second", 600.0), ("third", 660.0))):
        power = drawn_steps(rng, stop, 45.0, 3.0, 12.0, 1.0)
        outside = Steps((0.0,), (float(f"{rng.uniform(15.0, 20.0):.1f}"),))
        said = float(f"{rng.uniform(336.0, 344.0):.1f}") if strayed else usual
        begin = said + strayed * float(rng.normal())
        t, x = integrated(rates, (begin, z_begin, 0.0, begin), (power, outside), stop, 0.25)
        factor = FEET if is_feet and name == "first" else 1.0
        sensors = [
            Sensor("rise.altitude", "Baro-Höhe", "m", scaled(1, factor), 0.06, 1.0, noise_stated, 0.01),
            Sensor("envelope.inside", "T_crown", "degC", celsius(0), 0.2, 3.0, noise_stated, 0.05),
        ]
        sidecar: dict[str, Any] = {}
        if strayed:
            sidecar["components"] = {"envelope": {"parameters": {"T_begin": f"{said:.1f} K"}}}
            sidecar["uncertain"] = {"envelope.T_begin": f"{strayed:g} K"}
        made = Written(
            t,
            x,
            sensors,
            {"burner.power": (power, "kW"), "hall.outside": (outside, "degC")},
            loggers[number % len(loggers)],
            sidecar=sidecar,
        )
        write(folder / name, rng, made)
        if clock is not None:
            second_clock(folder / name, clock[0], clock[1] + 21.5 * number)


def balloon_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=75.0), Logger("s", empty=0.03), Logger("min", zero=-0.5))
    _balloon(folder, rng, strayed=1.5, clock=("h", 14.2), loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, two FMUs, a start of each recording is stated that is off by 1.5 K "
        "(deviation), which is stated too; the thermometer is of a logger with another rate and a clock of its own, in "
        "hours",
        FINE,
    )


def balloon_fabric(folder: Path, rng: Rng) -> Truth:
    capacity, taken = rng.uniform(2e4, 3e4), rng.uniform(230.0, 330.0)
    _balloon(folder, rng, fabric=(capacity, taken), loggers=(PLAIN, Logger("min", zero=11.0)))
    return Truth(
        f"fabric of the envelope takes up heat of the air: {capacity / 1e3:.1f} kJ/K behind {taken:.0f} W/K",
        PHYSICS,
        ("hidden_state", "thermal_mass", "hidden_mass"),
    )


def balloon_feet(folder: Path, rng: Rng) -> Truth:
    _balloon(folder, rng, is_feet=True, loggers=(Logger("ms"), PLAIN))
    return Truth("the altimeter is logged in feet and stated as m, in the first recording", (*RECORDING, *SENSOR))


# --- the boiler of an ironing station on a balance, FMI 2 Co-Simulation; bar, g, W, min; power and valve are columns
STEAMER = OdeModel(
    "steamer",
    {
        "C_shell": (1200.0, "J/K"),
        "c_water": (4250.0, "J/(kg*K)"),
        "L": (2.13e6, "J/kg"),
        "K": (4890.0, "K"),
        "p_air": (101325.0, "Pa"),
        "T_boil": (373.15, "K"),
        "k_valve": (7e-9, "kg/(s*Pa)"),
        "U_room": (3.2, "W/K"),
        "T_room": (295.15, "K"),
        "T_begin": (403.15, "K"),
        "m_begin": (2.6, "kg"),
    },
    {"power": "W", "valve": ""},
    {
        "T": (
            "K",
            "T_begin",
            "(power - U_room*(T - T_room) - L*k_valve*valve*p_air*(exp(K*(1.0/T_boil - 1.0/T)) - 1.0))"
            "/(C_shell + c_water*m)",
        ),
        "m": ("kg", "m_begin", "-k_valve*valve*p_air*(exp(K*(1.0/T_boil - 1.0/T)) - 1.0)"),
    },
    {"pressure": ("Pa", "p_air*exp(K*(1.0/T_boil - 1.0/T))"), "water": ("kg", "m")},
    0.1,
)
STEAMER_KNOWN = {"C_shell": 0.08, "k_valve": 0.05, "U_room": 0.08}


def _steamer(
    folder: Path,
    rng: Rng,
    tau: float = 0.0,
    stronger: tuple[float, float, float] | None = None,
    strayed: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> None:
    """The heating rod may store heat: what the water is given follows the power with a time `tau` [s].

    Stronger is begin [s], end [s] and factor of the power in the first recording. `strayed` is by how much [K] the
    start of each recording is off (deviation), which is stated.
    """
    STEAMER.build(folder)
    parts = programme("heater", ("power", "W")) + programme("iron", ("valve", "'%'")).replace("0 '%'", "0 %")
    wires = "  - heater.power -> boiler.power\n  - iron.valve -> boiler.valve\n"
    parts += with_numbers("boiler", "steamer", "internal")
    scenario(folder, "The boiler of an ironing station", 1800.0, 1, 2, parts, wires)
    data_sheet(folder, STEAMER, STEAMER_KNOWN)
    numbers = drawn(rng, STEAMER, STEAMER_KNOWN)
    c_shell, c_water, latent, k, p_air, boil, k_valve, u_room, room, usual, m_begin = numbers

    def over(x: Array) -> Array:
        """Pressure over that of air, as a share of it."""
        return np.asarray(np.expm1(k * (1.0 / boil - 1.0 / x[..., 0])))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        warm, mass, given = (float(s) for s in x)
        steam = k_valve * 0.01 * float(u[1]) * p_air * float(over(x))
        power = given if tau else float(u[0])
        heating = (power - u_room * (warm - room) - latent * steam) / (c_shell + c_water * mass)
        return [heating, -steam, (float(u[0]) - given) / tau if tau else 0.0]

    for number, (name, stop) in enumerate((("first", 1800.0), ("second", 1500.0), ("third", 1620.0))):
        stated = drawn_steps(rng, stop, 80.0, 0.0, 2400.0, 2.0)
        power = stated
        if stronger is not None and name == "first":
            power = between(stated, stronger[0], stronger[1], lambda v: stronger[2] * v)
        valve = bursts(rng, stop, 40.0, 30.0, 25.0, 100.0, 2.0)
        said = float(f"{rng.uniform(395.0, 408.0):.1f}") if strayed else usual
        begin = said + strayed * float(rng.normal())
        t, x = integrated(rates, (begin, m_begin, 0.0), (power, valve), stop, 0.5)
        sensors = [
            Sensor(
                "boiler.pressure",
                "p_abs",
                "bar",
                lambda t, x, u: 1e-5 * p_air * (1.0 + over(x)),
                0.025,
                2.0,
                noise_stated,
                0.01,
            ),
            Sensor("boiler.water", "Waage", "g", scaled(1, 1e3), 3.0, 2.0, noise_stated, 1.0),
        ]
        sidecar: dict[str, Any] = {}
        if strayed:
            sidecar["components"] = {"boiler": {"parameters": {"T_begin": f"{said:.1f} K"}}}
            sidecar["uncertain"] = {"boiler.T_begin": f"{strayed:g} K"}
        made = Written(
            t,
            x,
            sensors,
            {"heater.power": (power, "W"), "iron.valve": (valve, "%")},
            loggers[number % len(loggers)],
            recorded=["heater.power", "iron.valve"],
            sidecar=sidecar,
            told={} if power is stated else {"heater.power": stated},
        )
        write(folder / name, rng, made)


def steamer_null(folder: Path, rng: Rng) -> Truth:
    _steamer(folder, rng, strayed=2.0, loggers=(Logger("min", zero=-5.0), Logger("s", zero=600.0, empty=0.02)))
    return Truth(
        "nothing; numbers off as stated, a start of each recording is stated that is off by 2 K (deviation), which is "
        "stated too; minutes from -5, seconds from 600, empty cells, Co-Simulation",
        FINE,
    )


def steamer_rod(folder: Path, rng: Rng) -> Truth:
    tau = rng.uniform(18.0, 32.0)
    _steamer(folder, rng, tau=tau, loggers=(Logger("s"), Logger("min", zero=0.75)))
    return Truth(
        f"the heating rod stores heat: what the water is given follows the power with {tau:.1f} s, from 0 W",
        PHYSICS,
        ("input_lag", "actuator_lag", "slow_actuator", "slow_source", "hidden_state", "thermal_mass", "hidden_mass"),
    )


def steamer_power(folder: Path, rng: Rng) -> Truth:
    begin, factor = 20.0 * round(rng.uniform(15.0, 45.0)), rng.uniform(1.15, 1.25)
    _steamer(folder, rng, stronger=(begin, begin + 480.0, factor), loggers=(Logger("min"), Logger("s", zero=45.0)))
    return Truth(
        f"the heater was given {factor:.3f} times the power that is stated, {begin:g} s to {begin + 480.0:g} s of the "
        "first recording",
        SENSOR,
        ("input_fault",),
    )


# --- water in a U-tube below a blower's chamber, FMI 2 Model Exchange; mbar, mm; the blower's pressure is a column
TUBE = OdeModel(
    "tube",
    {
        "C_air": (1.5e-8, "m^3/Pa"),
        "G": (6e-8, "m^3/(s*Pa)"),
        "area": (3e-4, "m^2"),
        "rho": (DENSITY, "kg/m^3"),
        "g": (GRAVITY, "m/s^2"),
        "length": (1.6, "m"),
        "d": (0.35, "1/s"),
    },
    {"blower": "Pa"},
    {
        "p": ("Pa", "0.0", "(G*(blower - p) - area*v)/C_air"),
        "h": ("m", "0.0", "v"),
        "v": ("m/s", "0.0", "(p - 2.0*rho*g*h)/(rho*length) - d*v"),
    },
    {"chamber": ("Pa", "p"), "level": ("m", "h")},
    1e-3,
)
TUBE_KNOWN = {"C_air": 0.05, "G": 0.06, "area": 0.02, "length": 0.03, "d": 0.1}


def _tube(
    folder: Path,
    rng: Rng,
    bend: float = 0.0,
    leak: float = 0.0,
    begin: float = 0.0,
    noise_stated: float | None = 1.0,
    quantum: float = 0.1,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The bend may cost bend/2 rho v^2; the chamber may leak to the room with `leak` m^3/(s Pa).

    Water may stand `begin` mm off at the begin of the second recording.
    """
    TUBE.build(folder)
    parts = programme("fan", ("blower", "mbar")) + with_numbers("tube", "tube")
    scenario(folder, "Water in a U-tube", 50.0, 0.02, 0.02, parts, "  - fan.blower -> tube.blower\n")
    data_sheet(folder, TUBE, TUBE_KNOWN)
    c_air, conductance, area, rho, g, length, d = drawn(rng, TUBE, TUBE_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Pressure is in mbar."""
        p, h, v = (float(s) for s in x)
        lost = 0.5 * bend * v * abs(v) / length
        return [
            0.01 * (100.0 * (conductance * (float(u[0]) - p) - leak * p) - area * v) / c_air,
            v,
            (100.0 * p - 2.0 * rho * g * h) / (rho * length) - d * v - lost,
        ]

    for number, (name, stop) in enumerate((("first", 50.0), ("second", 40.0), ("third", 44.0))):
        blower = drawn_steps(rng, stop, 1.6, -28.0, 30.0, 0.02)
        if name == "third":
            blower = telegraph(rng, stop, 1.1, -22.0, 25.0, 0.02)
        at = 1e-3 * begin if name == "second" else 0.0
        t, x = integrated(rates, (0.0, at, 0.0), (blower,), stop, 0.01)
        sensors = [
            Sensor("tube.chamber", "dp / mbar", "mbar", scaled(0, 1.0), 0.12, 0.02, noise_stated, 0.05),
            Sensor("tube.level", "Pegel", "mm", scaled(1, 1e3), 0.6, 0.02, noise_stated, quantum),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"fan.blower": (blower, "mbar")},
            loggers[number % len(loggers)],
            recorded=["fan.blower"],
        )
        write(folder / name, rng, made)


def tube_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=12000.0), Logger("s", zero=-6.0, empty=0.03))
    _tube(folder, rng, noise_stated=None, quantum=2.5, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, a coarse converter of the level, empty cells, ms from "
        "12000, seconds from -6",
        FINE,
    )


def tube_bend(folder: Path, rng: Rng) -> Truth:
    bend = rng.uniform(7.0, 11.0)
    _tube(folder, rng, bend=bend, loggers=(PLAIN, Logger("ms", zero=90.0)))
    return Truth(f"the bend costs {bend:.2f}/2 rho v^2", PHYSICS, SQUARE)


def tube_two(folder: Path, rng: Rng) -> Truth:
    bend, leak = rng.uniform(7.0, 11.0), rng.uniform(5e-9, 8e-9)
    _tube(folder, rng, bend=bend, leak=leak, loggers=(Logger("s", zero=18.5), PLAIN))
    return Truth(
        f"the bend costs {bend:.2f}/2 rho v^2, and the chamber leaks {leak:.2e} m^3/(s Pa) to the room",
        PHYSICS,
        (*SQUARE, *LEAKING),
    )


def tube_start(folder: Path, rng: Rng) -> Truth:
    begin = float(rng.choice([-1.0, 1.0])) * rng.uniform(35.0, 60.0)
    _tube(folder, rng, begin=begin, loggers=(Logger("ms"), PLAIN))
    return Truth(
        f"water stands {begin:.1f} mm off at the begin of the second recording and is said to be level",
        (*RECORDING, *SENSOR),
    )


# --- a stretchable pump of charged liquid that fills a fibre muscle, FMI 3 Co-Simulation; kV, kPa, mm, N
ION_PUMP = OdeModel(
    "ion_pump",
    {
        "thrust": (3.2e-4, "Pa/V^2"),
        "R": (1.2e11, "Pa*s/m^3"),
        "C_fibre": (3e-11, "m^3/Pa"),
        "gain": (5e-7, "m/Pa"),
        "soft": (8e-4, "m/N"),
        "tau": (0.5, "s"),
    },
    {"voltage": "V", "force": "N"},
    {
        "p": ("Pa", "0.0", "(thrust*voltage*voltage - p)/(R*C_fibre)"),
        "x": ("m", "0.0", "(gain*p - soft*force - x)/tau"),
    },
    {"pressure": ("Pa", "p"), "stroke": ("m", "x")},
    5e-3,
)
ION_PUMP_KNOWN = {"thrust": 0.05, "R": 0.06, "C_fibre": 0.05, "gain": 0.04, "soft": 0.06, "tau": 0.08}


def _ion_pump(
    folder: Path,
    rng: Rng,
    fading: tuple[float, float] | None = None,
    share: float = 0.0,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Thrust may fade: by a share of it at 8 kV, which builds up with the squared voltage in a time [s].

    The pressure sensor may have a smaller range in the second recording: it ends at what is exceeded for a `share` of
    the time.
    """
    build3(ION_PUMP, folder, has_exchange=False)
    parts = programme("amplifier", ("voltage", "kV")) + programme("hook", ("force", "N"))
    parts += with_numbers("muscle", "ion_pump", "internal")
    wires = "  - amplifier.voltage -> muscle.voltage\n  - hook.force -> muscle.force\n"
    scenario(folder, "A pump and a fibre muscle", 100.0, 0.05, 0.05, parts, wires)
    data_sheet(folder, ION_PUMP, ION_PUMP_KNOWN)
    thrust, r, c_fibre, gain, soft, tau = drawn(rng, ION_PUMP, ION_PUMP_KNOWN)
    faded, slow = fading or (0.0, 1.0)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Pressure is in kPa, the stroke in mm; the last state is the charge that screens the electrodes."""
        p, s, screen = (float(w) for w in x)
        square = float(u[0]) ** 2
        driven = 1e3 * thrust * square * (1.0 - faded * screen)
        return [
            (driven - p) / (r * c_fibre),
            (1e6 * gain * p - 1e3 * soft * float(u[1]) - s) / tau,
            (square / 64.0 - screen) / slow,
        ]

    for number, (name, stop) in enumerate((("first", 100.0), ("second", 120.0), ("third", 90.0))):
        voltage = drawn_steps(rng, stop, 5.0, 0.0, 8.0, 0.05)
        force = drawn_steps(rng, stop, 11.0, 0.0, 4.0, 0.05)
        if name == "third":
            voltage = ramps(stop, 0.4, 8.0, 24.0, 0.6)
        t, x = integrated(rates, (0.0, 0.0, 0.0), (voltage, force), stop, 0.025)
        limit = float(f"{np.quantile(x[:, 0], 1.0 - share):.1f}") if share and name == "second" else np.inf

        def spoil(column: str, t: Array, v: Array, limit: float = limit) -> Array:
            return np.minimum(v, limit) if column == "P [kPa]" else v

        sensors = [
            Sensor("muscle.pressure", "P [kPa]", "kPa", scaled(0, 1.0), 0.08, 0.1, noise_stated, 0.02, colour),
            Sensor("muscle.stroke", "keyence", "mm", scaled(1, 1.0), 0.04, 0.1, noise_stated, 0.005, colour),
        ]
        programmes = {"amplifier.voltage": (voltage, "kV"), "hook.force": (force, "N")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)], spoil=spoil))


def ion_pump_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=4000.0, gap=(41.0, 52.0)), Logger("s", zero=2.5, jitter=0.2), Logger("min"))
    _ion_pump(folder, rng, colour=0.85, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.85, a gap of 11 s, jitter, "
        "three loggers, Co-Simulation",
        FINE,
    )


def ion_pump_fading(folder: Path, rng: Rng) -> Truth:
    faded, slow = rng.uniform(0.34, 0.48), rng.uniform(9.0, 16.0)
    _ion_pump(folder, rng, fading=(faded, slow), loggers=(PLAIN, Logger("s", zero=31.0)))
    return Truth(
        f"charge screens the electrodes: thrust fades by {faded:.3f} (U/8 kV)^2 of it with {slow:.1f} s",
        PHYSICS,
        ("hidden_state", "relaxation", "polarisation", "fading", "screening", "space_charge"),
    )


def ion_pump_saturated(folder: Path, rng: Rng) -> Truth:
    share = rng.uniform(0.14, 0.24)
    _ion_pump(folder, rng, share=share, loggers=(Logger("min"), PLAIN))
    return Truth(
        f"the pressure sensor of the second recording ends at what {100 * share:.0f} % of its course exceed, which is "
        "not stated",
        SENSOR,
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    exosuit_capstan,
    spindle_two,
    patch_null,
    hot_end_clock,
    balloon_fabric,
    steamer_power,
    tube_bend,
    ion_pump_null,
    exosuit_exchanged,
    spindle_saturation,
    patch_saturable,
    hot_end_null,
    balloon_feet,
    steamer_rod,
    tube_null,
    ion_pump_fading,
    exosuit_null,
    spindle_shunt,
    patch_programme,
    hot_end_wire,
    balloon_null,
    steamer_null,
    tube_two,
    ion_pump_saturated,
    tube_start,
)
