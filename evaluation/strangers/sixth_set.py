"""Sixth set: a ball on a beam, a levitated mass, an indexing table, a dryer, a cooler, cells, a surge shaft, a rotor.

Written without a look at the library of laws, its proof, its thresholds or what it reported on the earlier sets.
Truths are integrated by scipy from equations that stand here. How large an effect is, and how far the numbers are off,
is drawn; the deviations of the numbers are those that a parameter set states.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np

from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.strangers.fifth_set import FOUR, FOUR_SPLIT, GRAVITY, integrated, saturation_pressure
from evaluation.strangers.first_set import FOLDERS, PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import between, data_sheet, fahrenheit, scaled
from evaluation.strangers.lab import Logger, Sensor, Steps, Written, celsius, drawn_steps, write
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.truth import FINE, OPEN, PHYSICS, RECORDING, SENSOR, Truth

#: Atmospheric pressure [Pa]; ratio of the molar masses of water and air; heat of evaporation [J/kg].
PRESSURE, MOLAR_RATIO, EVAPORATION = 101325.0, 0.622, 2.45e6


def resting(component: str, value: str) -> str:
    """A programme of one output that is held at another value than 0."""
    return re.sub(r"constant: 0 [^}]+", f"constant: {value}", component)


# --- a ball on a beam with a servo and position feedback (Wellstead 1979), FMI 2 Model Exchange; mm, deg
BEAM = OdeModel(
    "beam",
    {
        "g": (GRAVITY, "m/s^2"),
        "share": (5.0 / 7.0, ""),
        "kp": (0.8, "rad/m"),
        "kd": (0.55, "rad*s/m"),
        "tau": (0.09, "s"),
        "c": (0.12, "1/s"),
    },
    {"setpoint": "m"},
    {
        "x": ("m", "0.0", "v"),
        "v": ("m/s", "0.0", "share*g*sin(theta) - c*v"),
        "theta": ("rad", "0.0", "(kp*(setpoint - x) - kd*v - theta)/tau"),
    },
    {"position": ("m", "x"), "angle": ("rad", "theta")},
    2e-3,
)
BEAM_KNOWN = {"share": 0.03, "kp": 0.04, "kd": 0.05, "tau": 0.07, "c": 0.08}


def _beam(
    folder: Path,
    rng: Rng,
    rolling: float = 0.0,
    bump: tuple[float, float, float] | None = None,
    noise_stated: float | None = 1.0,
    logger: Logger = PLAIN,
) -> None:
    """A ball that may roll with a constant resistance, `rolling` m/s^2; `bump` is begin [s], end [s] and shift [mm]."""
    BEAM.build(folder)
    stop = 60.0
    parts = programme("panel", ("setpoint", "m")) + with_numbers("rig", "beam")
    scenario(folder, "A ball on a beam", stop, 0.02, 0.02, parts, "  - panel.setpoint -> rig.setpoint\n")
    data_sheet(folder, BEAM, BEAM_KNOWN)
    g, share, kp, kd, tau, c = drawn(rng, BEAM, BEAM_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        place, v, theta = (float(s) for s in x)
        drag = c * v + rolling * np.tanh(v / 2e-3)
        return [v, share * g * np.sin(theta) - drag, (kp * (float(u[0]) - place) - kd * v - theta) / tau]

    for name in FOLDERS:
        setpoint = drawn_steps(rng, stop, 2.5, -0.25, 0.25, 0.02)
        t, x = integrated(rates, (0.0, 0.0, 0.0), (setpoint,), stop, 0.01)
        sensors = [
            Sensor("rig.position", "camera_mm", "mm", scaled(0, 1e3), 1.5, 0.04, noise_stated, 0.1),
            Sensor("rig.angle", "servo_deg", "deg", scaled(2, 180.0 / np.pi), 0.15, 0.04, noise_stated, 0.05),
        ]

        def spoil(column: str, t: Array, v: Array, name: str = name) -> Array:
            if bump is None or name != "second" or column != "camera_mm":
                return v
            return np.where((t >= bump[0]) & (t < bump[1]), v + bump[2], v)

        programmes = {"panel.setpoint": (setpoint, "m")}
        write(folder / name, rng, Written(t, x, sensors, programmes, logger, spoil=spoil))


def beam_null(folder: Path, rng: Rng) -> Truth:
    _beam(folder, rng, noise_stated=None, logger=Logger(zero=12.5, is_comma=True))
    return Truth(
        "nothing; numbers off as stated, noise is not stated, decimal commas, the clock begins at 12.5 s", FINE
    )


def beam_rolling(folder: Path, rng: Rng) -> Truth:
    rolling = rng.uniform(0.04, 0.07)
    _beam(folder, rng, rolling=rolling)
    return Truth(
        f"rolling resistance that does not depend on the speed, {rolling:.4f} m/s^2",
        PHYSICS,
        ("dry_friction", "coulomb_friction", "stribeck_friction", "rolling_resistance"),
    )


def beam_bumped(folder: Path, rng: Rng) -> Truth:
    begin, shift = 0.5 * round(rng.uniform(40.0, 70.0)), rng.uniform(9.0, 14.0) * rng.choice([-1.0, 1.0])
    _beam(folder, rng, bump=(begin, begin + 14.0, shift))
    return Truth(
        f"the camera reads {shift:+.1f} mm more from {begin:g} s to {begin + 14.0:g} s of the second recording", SENSOR
    )


# --- a mass under an electromagnet, stabilised by its controller, FMI 3 Model Exchange; mm, mA, ms
MAGNET = OdeModel(
    "magnet",
    {
        "m": (0.08, "kg"),
        "g": (GRAVITY, "m/s^2"),
        "C": (5.02e-5, "N*m^2/A^2"),
        "slope": (125.0, "A/m"),
        "kp": (400.0, "A/m"),
        "kd": (6.0, "A*s/m"),
        "tau": (1.8e-3, "s"),
        "d": (0.6, "N*s/m"),
        "y_begin": (8e-3, "m"),
        "i_begin": (1.0, "A"),
    },
    {"setpoint": "m"},
    {
        "y": ("m", "y_begin", "v"),
        "v": ("m/s", "0.0", "g - C*i*i/(m*y*y) - d*v/m"),
        "i": ("A", "i_begin", "(slope*setpoint + kp*(y - setpoint) + kd*v - i)/tau"),
    },
    {"gap": ("m", "y"), "current": ("A", "i")},
    1e-4,
)
MAGNET_KNOWN = {"C": 0.04, "kp": 0.02, "tau": 0.08, "d": 0.08}


def _magnet(
    folder: Path,
    rng: Rng,
    iron: float = 0.0,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    logger: Logger | None = None,
) -> None:
    """The iron of the flux path may act as a further gap, `iron` m; the programme may be the scenario's."""
    build3(MAGNET, folder, has_co_simulation=False)
    stop = 6.0

    def played() -> Steps:
        return drawn_steps(rng, stop, 0.12, 5.5e-3, 10.5e-3, 2e-3)

    written, real = played(), played()
    parts = resting(programme("generator", ("setpoint", "m")), "0.008 m")
    if is_other:
        points = ", ".join(f"[{t:.10g} s, {v:.10g} m]" for t, v in zip(written.times, written.levels))
        parts = f"  generator:\n    kind: programme\n    outputs:\n      setpoint: {{unit: m, points: [{points}]}}\n"
    parts += with_numbers("rig", "magnet")
    scenario(folder, "A levitated mass", stop, 2e-3, 2e-3, parts, "  - generator.setpoint -> rig.setpoint\n")
    data_sheet(folder, MAGNET, MAGNET_KNOWN)
    m, g, c, slope, kp, kd, tau, d, y_begin, i_begin = drawn(rng, MAGNET, MAGNET_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        y, v, i = (float(s) for s in x)
        r = float(u[0])
        return [v, g - (c * (i / (y + iron)) ** 2 + d * v) / m, (slope * r + kp * (y - r) + kd * v - i) / tau]

    for name in FOLDERS:
        setpoint = real if is_other else played()
        t, x = integrated(rates, (y_begin, 0.0, i_begin), (setpoint,), stop, 1e-3)
        sensors = [
            Sensor("rig.gap", "gap_mm", "mm", scaled(0, 1e3), 0.015, 4e-3, noise_stated, 0.005),
            Sensor("rig.current", "I_mA", "mA", scaled(2, 1e3), 12.0, 2e-3, noise_stated, 2.0),
        ]
        programmes = {} if is_other else {"generator.setpoint": (setpoint, "m")}
        write(folder / name, rng, Written(t, x, sensors, programmes, logger or Logger("ms")))


def magnet_null(folder: Path, rng: Rng) -> Truth:
    _magnet(folder, rng, noise_stated=1.5, logger=Logger("ms", zero=4000.0, jitter=0.1))
    return Truth(
        "nothing; numbers off as stated, noise stated 1.5 times too large, jitter, the clock begins at 4000 ms", FINE
    )


def magnet_iron(folder: Path, rng: Rng) -> Truth:
    iron = rng.uniform(0.6e-3, 0.9e-3)
    _magnet(folder, rng, iron=iron)
    return Truth(
        f"the reluctance of the iron acts as a further gap of {1e3 * iron:.3f} mm: the force is C (i/(y + y_iron))^2",
        PHYSICS,
    )


def magnet_programme(folder: Path, rng: Rng) -> Truth:
    _magnet(folder, rng, is_other=True)
    return Truth(
        "the scenario states a programme that was played in none of the recordings; all have one other",
        (*RECORDING, *SENSOR),
    )


# --- an indexing table on a stepper motor with micro-steps, FMI 2 Model Exchange; deg, deg/s, ms
TABLE = OdeModel(
    "table",
    {
        "J": (2e-3, "kg*m^2"),
        "T": (0.4, "N*m"),
        "teeth": (50.0, ""),
        "d": (0.05, "N*m*s/rad"),
    },
    {"command": "rad"},
    {
        "phi": ("rad", "0.0", "w"),
        "w": ("rad/s", "0.0", "(-T*sin(teeth*(phi - command)) - d*w)/J"),
    },
    {"angle": ("rad", "phi"), "rate": ("rad/s", "w")},
    5e-4,
)
TABLE_KNOWN = {"J": 0.05, "T": 0.06, "d": 0.08}


def walk(rng: Rng, stop: float, dwell: float, low: float, high: float, grid: float) -> Steps:
    """A course from 0 whose jumps have random sizes and signs, at random times on a grid of instants [s]."""
    times, levels, t = [0.0], [0.0], 0.0
    while True:
        t += grid * max(1, round(rng.uniform(0.5, 1.5) * dwell / grid))
        if t >= stop - dwell / 4:
            return Steps(tuple(times), tuple(levels))
        times.append(t)
        levels.append(round(levels[-1] + float(rng.uniform(low, high) * rng.choice([-1.0, 1.0])), 3))


def _table(
    folder: Path,
    rng: Rng,
    detent: float = 0.0,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    logger: Logger | None = None,
) -> None:
    """Four runs, one held out; the motor may have a detent torque, `detent` N m, of four periods per tooth."""
    TABLE.build(folder)
    stop = 6.0
    parts = programme("driver", ("command", "deg")) + with_numbers("rig", "table")
    scenario(folder, "An indexing table", stop, 2e-3, 2e-3, parts, "  - driver.command -> rig.command\n")
    data_sheet(folder, TABLE, TABLE_KNOWN)
    inertia, torque, teeth, d = drawn(rng, TABLE, TABLE_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        phi, w = float(x[0]), float(x[1])
        pull = torque * np.sin(teeth * (phi - np.radians(float(u[0])))) + detent * np.sin(4.0 * teeth * phi)
        return [w, -(pull + d * w) / inertia]

    other = walk(rng, stop, 0.14, 0.3, 1.1, 2e-3)
    for name in FOUR:
        command = walk(rng, stop, 0.14, 0.3, 1.1, 2e-3)
        t, x = integrated(rates, (0.0, 0.0), (command,), stop, 1e-3)
        sensors = [
            Sensor("rig.angle", "encoder_deg", "deg", scaled(0, 180.0 / np.pi), 0.02, 4e-3, noise_stated, 0.01),
            Sensor("rig.rate", "gyro_dps", "deg/s", scaled(1, 180.0 / np.pi), 2.0, 2e-3, noise_stated, 0.1),
        ]
        told = {"driver.command": other} if is_other and name == "second" else {}
        programmes = {"driver.command": (command, "deg")}
        write(folder / name, rng, Written(t, x, sensors, programmes, logger or Logger("ms"), told=told))


def table_null(folder: Path, rng: Rng) -> Truth:
    _table(folder, rng, noise_stated=0.7, logger=Logger("ms", zero=-50.0, gap=(2.2, 2.6), empty=0.02))
    return Truth(
        "nothing; numbers off as stated, noise stated 1.4 times too small, a gap of 0.4 s, empty cells",
        (*FINE, *OPEN),
        **FOUR_SPLIT,
    )


def table_detent(folder: Path, rng: Rng) -> Truth:
    detent = rng.uniform(0.018, 0.026)
    _table(folder, rng, detent=detent)
    return Truth(
        f"detent torque of the motor, {detent:.4f} N m with four periods per tooth",
        PHYSICS,
        ("cogging", "cogging_torque", "detent", "detent_torque"),
        **FOUR_SPLIT,
    )


def table_other_run(folder: Path, rng: Rng) -> Truth:
    _table(folder, rng, is_other=True)
    return Truth("the second recording states the command of another run", RECORDING, **FOUR_SPLIT)


# --- a cabinet dryer with the humidity of its air and the mass of its load, FMI 2; degC, g/kg, kg, min
SATURATION = (
    f"({MOLAR_RATIO}*610.94*exp(17.625*(T_p - 273.15)/(T_p - 30.11))"
    f"/({PRESSURE} - 610.94*exp(17.625*(T_p - 273.15)/(T_p - 30.11))))"
)
DRYER = OdeModel(
    "dryer",
    {
        "C_air": (6000.0, "J/K"),
        "C_load": (7500.0, "J/K"),
        "h": (9.0, "W/K"),
        "beta": (9e-3, "kg/s"),
        "U": (6.0, "W/K"),
        "m_air": (0.9, "kg"),
        "cp": (1006.0, "J/(kg*K)"),
        "L": (EVAPORATION, "J/kg"),
        "w_room": (7e-3, ""),
        "T_begin": (294.15, "K"),
        "m_begin": (2.0, "kg"),
    },
    {"power": "W", "vent": "kg/s", "room": "K"},
    {
        "T_a": ("K", "T_begin", "(power - h*(T_a - T_p) - (U + vent*cp)*(T_a - room))/C_air"),
        "T_p": ("K", "T_begin", f"(h*(T_a - T_p) - L*beta*({SATURATION} - w))/C_load"),
        "w": ("", "w_room", f"(beta*({SATURATION} - w) - vent*(w - w_room))/m_air"),
        "m": ("kg", "m_begin", f"-beta*({SATURATION} - w)"),
    },
    {"air": ("K", "T_a"), "humidity": ("", "w"), "mass": ("kg", "m")},
    0.5,
)
DRYER_KNOWN = {"C_air": 0.06, "C_load": 0.06, "h": 0.05, "beta": 0.06, "U": 0.06, "m_air": 0.05}


def _dryer(
    folder: Path,
    rng: Rng,
    critical: float = 0.0,
    in_pounds: bool = False,
    grid: float = 30.0,
    noise_stated: float | None = 1.0,
    logger: Logger | None = None,
    integrator: str = "cvode",
) -> None:
    """Below a critical mass [kg] drying may slow down, in proportion to the water above 0.9 kg."""
    DRYER.build(folder)
    stop = 7200.0
    parts = (
        programme("heater", ("power", "W"))
        + programme("flap", ("vent", "kg/s"))
        + resting(programme("hall", ("room", "K")), "294.15 K")
        + with_numbers("cabinet", "dryer", integrator)
    )
    wires = "  - heater.power -> cabinet.power\n  - flap.vent -> cabinet.vent\n  - hall.room -> cabinet.room\n"
    scenario(folder, "A cabinet dryer", stop, 3, 30, parts, wires)
    data_sheet(folder, DRYER, DRYER_KNOWN)
    c_air, c_load, h, beta, loss, m_air, cp, heat, w_room, begin, m_begin = drawn(rng, DRYER, DRYER_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        air, load, w, m = (float(s) for s in x)
        power, vent, room = (float(v) for v in u)
        vapour = float(saturation_pressure(load))
        slow = min(1.0, max(0.0, (m - 0.9) / (critical - 0.9))) if critical else 1.0
        dried = slow * beta * (MOLAR_RATIO * vapour / (PRESSURE - vapour) - w)
        over = h * (air - load)
        return [
            (power - over - (loss + vent * cp) * (air - room)) / c_air,
            (over - heat * dried) / c_load,
            (dried - vent * (w - w_room)) / m_air,
            -dried,
        ]

    for name in FOLDERS:
        power = drawn_steps(rng, stop, 700.0, 250.0, 1400.0, grid)
        vent = drawn_steps(rng, stop, 1100.0, 4e-3, 0.02, grid)
        room = Steps((0.0,), (round(rng.uniform(291.0, 297.0), 1),))
        t, x = integrated(rates, (begin, begin, w_room, m_begin), (power, vent, room), stop, 3.0)
        factor = 2.20462 if in_pounds else 1.0
        sensors = [
            Sensor("cabinet.air", "T_air", "degC", celsius(0), 0.3, 30.0, noise_stated, 0.1),
            Sensor("cabinet.humidity", "x_g_kg", "g/kg", scaled(2, 1e3), 0.1, 30.0, noise_stated, 0.1),
            Sensor("cabinet.mass", "balance", "kg", scaled(3, factor), 0.003 * factor, 60.0, noise_stated, 1e-3),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"heater.power": (power, "W"), "flap.vent": (vent, "kg/s"), "hall.room": (room, "K")},
            logger or Logger("min"),
            recorded=["heater.power", "flap.vent"],
        )
        write(folder / name, rng, made)


def dryer_null(folder: Path, rng: Rng) -> Truth:
    _dryer(folder, rng, grid=6.0, noise_stated=None, logger=Logger("min", zero=540.0), integrator="internal")
    return Truth(
        "nothing; numbers off as stated, noise is not stated, Co-Simulation, g/kg; inputs change on a grid of 6 s and "
        "are logged each 30 s, the clock begins at 540 min",
        FINE,
    )


def dryer_falling(folder: Path, rng: Rng) -> Truth:
    critical = rng.uniform(1.8, 1.9)
    _dryer(folder, rng, critical=critical)
    return Truth(
        f"falling-rate period: below {critical:.3f} kg the load dries in proportion to what it holds above 0.9 kg",
        PHYSICS,
    )


def dryer_pounds(folder: Path, rng: Rng) -> Truth:
    _dryer(folder, rng, in_pounds=True)
    return Truth("the balance is logged in pounds and stated as kg, in all recordings", (*RECORDING, *SENSOR))


# --- a thermoelectric cooler with its sink, FMI 3, both interfaces; degC, degF, V; current and load are columns
PELTIER = OdeModel(
    "peltier",
    {
        "S": (0.05, "V/K"),
        "R": (2.0, "ohm"),
        "K": (0.5, "W/K"),
        "C_cold": (70.0, "J/K"),
        "C_hot": (260.0, "J/K"),
        "U_cold": (0.15, "W/K"),
        "U_hot": (1.4, "W/K"),
        "T_begin": (295.15, "K"),
    },
    {"current": "A", "load": "W", "room": "K"},
    {
        "T_c": (
            "K",
            "T_begin",
            "(load - S*current*T_c + 0.5*R*current*current + K*(T_h - T_c) + U_cold*(room - T_c))/C_cold",
        ),
        "T_h": (
            "K",
            "T_begin",
            "(S*current*T_h + 0.5*R*current*current - K*(T_h - T_c) - U_hot*(T_h - room))/C_hot",
        ),
    },
    {"cold": ("K", "T_c"), "hot": ("K", "T_h"), "voltage": ("V", "S*(T_h - T_c) + R*current")},
    0.1,
)
PELTIER_KNOWN = {"S": 0.03, "R": 0.04, "K": 0.06, "C_cold": 0.05, "C_hot": 0.05, "U_cold": 0.08, "U_hot": 0.06}


def _peltier(
    folder: Path,
    rng: Rng,
    seebeck: float = 0.0,
    ohmic: float = 0.0,
    convection: float = 0.0,
    is_exchanged: bool = False,
    noise_stated: float | None = 1.0,
    logger: Logger = PLAIN,
    integrator: str = "cvode",
) -> None:
    """Seebeck coefficient and resistance may rise with the mean temperature [1/K]; the sink may lose more when warm.

    The further loss of the sink is `convection` W/K^1.25 times the power 1.25 of its excess.
    """
    build3(PELTIER, folder)
    stop = 2400.0
    parts = (
        programme("source", ("current", "A"))
        + programme("dummy", ("load", "W"))
        + resting(programme("lab", ("room", "K")), "295.15 K")
        + with_numbers("cell", "peltier", integrator)
    )
    wires = "  - source.current -> cell.current\n  - dummy.load -> cell.load\n  - lab.room -> cell.room\n"
    scenario(folder, "A thermoelectric cooler", stop, 1, 2, parts, wires)
    data_sheet(folder, PELTIER, PELTIER_KNOWN)
    s0, r0, k, c_cold, c_hot, u_cold, u_hot, begin = drawn(rng, PELTIER, PELTIER_KNOWN)

    def numbers(cold: Array, hot: Array) -> tuple[Array, Array]:
        warm = 0.5 * (cold + hot) - 295.15
        return s0 * (1.0 + seebeck * warm), r0 * (1.0 + ohmic * warm)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        i, load, room = (float(v) for v in u)
        s, r = numbers(x[0], x[1])
        half, through, over = 0.5 * r * i * i, k * (x[1] - x[0]), x[1] - room
        lost = u_hot * over + convection * np.sign(over) * abs(over) ** 1.25
        return [
            (load - s * i * x[0] + half + through + u_cold * (room - x[0])) / c_cold,
            (s * i * x[1] + half - through - lost) / c_hot,
        ]

    def voltage(t: Array, x: Array, u: Array) -> Array:
        s, r = numbers(x[:, 0], x[:, 1])
        return np.asarray(s * (x[:, 1] - x[:, 0]) + r * u[:, 0])

    for name in FOLDERS:
        current = drawn_steps(rng, stop, 90.0, -0.4, 2.5, 4.0)
        load = drawn_steps(rng, stop, 170.0, 0.0, 18.0, 4.0)
        room = Steps((0.0,), (round(rng.uniform(286.0, 304.0), 1),))
        t, x = integrated(rates, (begin, begin), (current, load, room), stop, 1.0)
        is_swapped = is_exchanged and name == "second"
        sensors = [
            Sensor("cell.cold", "T_cold", "degC", celsius(int(is_swapped)), 0.06, 4.0, noise_stated, 0.05),
            Sensor("cell.hot", "T_sink", "degF", fahrenheit(1 - int(is_swapped)), 0.3, 4.0, noise_stated, 0.1),
            Sensor("cell.voltage", "U_V", "V", voltage, 0.012, 8.0, noise_stated, 0.01),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"source.current": (current, "A"), "dummy.load": (load, "W"), "lab.room": (room, "K")},
            logger,
            recorded=["source.current", "dummy.load"],
        )
        write(folder / name, rng, made)


def peltier_null(folder: Path, rng: Rng) -> Truth:
    _peltier(folder, rng, noise_stated=1.8, logger=Logger("min", empty=0.02, zero=5.0), integrator="internal")
    return Truth(
        "nothing; numbers off as stated, noise stated 1.8 times too large, degF beside degC, minutes, Co-Simulation",
        FINE,
    )


def peltier_seebeck(folder: Path, rng: Rng) -> Truth:
    seebeck = rng.uniform(3.5e-3, 5e-3)
    _peltier(folder, rng, seebeck=seebeck)
    return Truth(f"the Seebeck coefficient rises with the mean temperature, {seebeck:.2e} 1/K", PHYSICS)


def peltier_two(folder: Path, rng: Rng) -> Truth:
    ohmic, convection = rng.uniform(5e-3, 7e-3), rng.uniform(0.15, 0.28)
    _peltier(folder, rng, ohmic=ohmic, convection=convection)
    return Truth(
        f"the resistance rises with the mean temperature, {ohmic:.2e} 1/K, and the sink also loses "
        f"{convection:.3f} W/K^1.25 times the power 1.25 of its excess (natural convection)",
        PHYSICS,
        (
            "temperature_dependent_resistance",
            "resistance_of_temperature",
            "natural_convection",
            "convection",
            "heat_loss",
            "radiation",
        ),
    )


def peltier_exchanged(folder: Path, rng: Rng) -> Truth:
    _peltier(folder, rng, is_exchanged=True)
    return Truth("the thermometers of block and sink are exchanged, in the second recording", RECORDING)


# --- salt in three stirred cells in series with recycle, FMI 3 Co-Simulation, without units; g/l, min
CELLS = OdeModel(
    "cells",
    {
        "V1": (2.0, ""),
        "V2": (2.5, ""),
        "V3": (2.0, ""),
        "recycle": (6e-3, ""),
        "c_begin": (0.0, ""),
    },
    {"flow": "", "feed": ""},
    {
        "c1": ("", "c_begin", "(flow*(feed - c1) + recycle*(c3 - c1))/V1"),
        "c2": ("", "c_begin", "(flow + recycle)*(c1 - c2)/V2"),
        "c3": ("", "c_begin", "(flow + recycle)*(c2 - c3)/V3"),
    },
    {"probe1": ("", "c1"), "probe2": ("", "c2"), "probe3": ("", "c3")},
    0.3,
)
CELLS_KNOWN = {"V1": 0.04, "V2": 0.05, "V3": 0.04, "recycle": 0.08}


def _cells(
    folder: Path,
    rng: Rng,
    stagnant: float = 0.0,
    left: float = 0.0,
    grid: float = 15.0,
    noise_stated: float | None = 1.0,
    logger: Logger | None = None,
) -> None:
    """A share of the second cell may be stagnant and exchange 0.004 l/s with the rest; one run may begin with salt."""
    build3(CELLS, folder, has_exchange=False)
    stop = 3600.0
    parts = programme("pump", ("flow", "")) + programme("dosing", ("feed", ""))
    parts += with_numbers("rig", "cells", "internal")
    wires = "  - pump.flow -> rig.flow\n  - dosing.feed -> rig.feed\n"
    scenario(folder, "Salt in three stirred cells", stop, 1.5, 15, parts, wires)
    data_sheet(folder, CELLS, CELLS_KNOWN)
    v1, v2, v3, recycle, _ = drawn(rng, CELLS, CELLS_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        flow, feed = float(u[0]), float(u[1])
        swap = 0.004 * (x[3] - x[1]) if stagnant else 0.0
        return [
            (flow * (feed - x[0]) + recycle * (x[2] - x[0])) / v1,
            ((flow + recycle) * (x[0] - x[1]) + swap) / ((1.0 - stagnant) * v2),
            (flow + recycle) * (x[1] - x[2]) / v3,
            -swap / (stagnant * v2) if stagnant else 0.0,
        ]

    for name in FOLDERS:
        flow = drawn_steps(rng, stop, 500.0, 0.01, 0.05, grid)
        feed = drawn_steps(rng, stop, 320.0, 0.0, 5.0, grid)
        begin = left if name == "second" else 0.0
        t, x = integrated(rates, [begin] * 4, (flow, feed), stop, 1.5)
        sensors = [
            Sensor(f"rig.probe{i + 1}", f"c{i + 1}_g_l", "1", scaled(i, 1.0), 0.02, 15.0, noise_stated, 0.01)
            for i in range(3)
        ]
        programmes = {"pump.flow": (flow, ""), "dosing.feed": (feed, "")}
        made = Written(t, x, sensors, programmes, logger or Logger("min"), recorded=["pump.flow", "dosing.feed"])
        write(folder / name, rng, made)


def cells_null(folder: Path, rng: Rng) -> Truth:
    _cells(folder, rng, grid=3.0, noise_stated=0.5, logger=Logger("min", jitter=0.15, gap=(1500.0, 1680.0)))
    return Truth(
        "nothing; numbers off as stated, no units, noise stated 2 times too small, jitter, a gap of 3 min; inputs "
        "change on a grid of 3 s and are logged each 15 s",
        (*FINE, *OPEN),
    )


def cells_stagnant(folder: Path, rng: Rng) -> Truth:
    stagnant = rng.uniform(0.34, 0.45)
    _cells(folder, rng, stagnant=stagnant)
    return Truth(f"{stagnant:.3f} of the second cell is stagnant and exchanges 0.004 l/s with the rest of it", PHYSICS)


def cells_start(folder: Path, rng: Rng) -> Truth:
    left = round(rng.uniform(0.8, 1.4), 2)
    _cells(folder, rng, left=left)
    return Truth(
        f"the second recording begins with {left} g/l in all cells, stated are cells without salt",
        (*RECORDING, *SENSOR),
    )


# --- a tunnel with a surge shaft (Jaeger 1977), FMI 2 Model Exchange; cm, L/min; two tables
SHAFT = OdeModel(
    "surge",
    {
        "g": (GRAVITY, "m/s^2"),
        "length": (12.0, "m"),
        "section": (1.963e-3, "m^2"),
        "shaft": (0.02, "m^2"),
        "k": (9.4e4, "s^2/m^5"),
        "H": (1.2, "m"),
    },
    {"outflow": "m^3/s"},
    {
        "Q": ("m^3/s", "0.0", "g*section/length*(H - z - k*Q*fabs(Q))"),
        "z": ("m", "H", "(Q - outflow)/shaft"),
    },
    {"level": ("m", "z"), "flow": ("m^3/s", "Q")},
    0.02,
)
SHAFT_KNOWN = {"length": 0.05, "shaft": 0.03, "k": 0.06}


def _surge(folder: Path, rng: Rng, throttle: float = 0.0, leak: float = 0.0, drift: float = 0.0) -> None:
    """A throttle at the foot of the shaft [s^2/m^5] and a leak there [m^2] may be left out."""
    SHAFT.build(folder)
    stop = 300.0
    parts = programme("valve", ("outflow", "L/min")) + with_numbers("tunnel", "surge")
    scenario(folder, "A tunnel with a surge shaft", stop, 0.1, 0.2, parts, "  - valve.outflow -> tunnel.outflow\n")
    data_sheet(folder, SHAFT, SHAFT_KNOWN)
    g, length, section, shaft, k, head = drawn(rng, SHAFT, SHAFT_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        q, z = float(x[0]), float(x[1])
        lost = leak * np.sqrt(2.0 * g * max(z, 0.0))
        rise = q - float(u[0]) / 6e4 - lost
        return [g * section / length * (head - z - k * q * abs(q) - throttle * rise * abs(rise)), rise / shaft]

    for name in FOLDERS:
        outflow = drawn_steps(rng, stop, 14.0, 5.0, 100.0, 0.2)
        t, x = integrated(rates, (0.0, head), (outflow,), stop, 0.1)
        rate = drift if name == "second" else 0.0

        def meter(t: Array, x: Array, u: Array, times: Array = t, q: Array = x[:, 0], rate: float = rate) -> Array:
            return np.asarray(6e4 * np.interp((1.0 - rate) * t, times, q))

        sensors = [
            Sensor("tunnel.level", "level_cm", "cm", scaled(1, 100.0), 0.3, 0.2, 1.0, 0.1),
            Sensor("tunnel.flow", "Q_L_min", "L/min", meter, 0.9, 0.5, 1.0, 0.1),
        ]
        made = Written(t, x, sensors, {"valve.outflow": (outflow, "L/min")}, Logger(zero=100.0))
        write(folder / name, rng, made)


def surge_throttle(folder: Path, rng: Rng) -> Truth:
    throttle = rng.uniform(6e4, 1e5)
    _surge(folder, rng, throttle=throttle)
    return Truth(
        f"a throttle at the foot of the shaft loses {throttle:.3g} s^2/m^5 times the square of the flow into it",
        PHYSICS,
    )


def surge_two(folder: Path, rng: Rng) -> Truth:
    throttle, leak = rng.uniform(6e4, 1e5), rng.uniform(1.2e-5, 2.2e-5)
    _surge(folder, rng, throttle=throttle, leak=leak)
    return Truth(
        f"a throttle at the foot of the shaft loses {throttle:.3g} s^2/m^5 times the square of the flow into it, and "
        f"the shaft leaks through {1e6 * leak:.1f} mm^2 (Torricelli)",
        PHYSICS,
        ("leak", "orifice_leak", "torricelli", "outflow", "leakage"),
    )


def surge_clock(folder: Path, rng: Rng) -> Truth:
    drift = rng.uniform(0.006, 0.012)
    _surge(folder, rng, drift=drift)
    return Truth(
        f"the clock of the flow meter's table runs {100 * drift:.2f} % fast in the second recording",
        (*RECORDING, *SENSOR),
    )


# --- a rotor in a wind tunnel (FMI 2, Model Exchange) and its generator (FMI 3, Co-Simulation); rpm, A
ROTOR = OdeModel(
    "rotor",
    {
        "J": (0.012, "kg*m^2"),
        "radius": (0.3, "m"),
        "rho": (1.2, "kg/m^3"),
        "q0": (0.02, ""),
        "q1": (0.035, ""),
        "q2": (4.4e-3, ""),
        "b": (4e-4, "N*m*s/rad"),
    },
    {"wind": "m/s", "torque": "N*m"},
    {
        "w": (
            "rad/s",
            "40.0",
            "(1.5707963267948966*rho*radius*radius*radius*(q0*wind*wind + q1*w*radius*wind - q2*w*w*radius*radius)"
            " - b*w - torque)/J",
        )
    },
    {"speed": ("rad/s", "w")},
)
GENERATOR = OdeModel(
    "generator",
    {"ke": (0.08, "V*s/rad"), "R": (0.7, "ohm"), "L": (0.06, "H")},
    {"speed": "rad/s", "load": "ohm"},
    {"i": ("A", "0.0", "(ke*speed - (R + load)*i)/L")},
    {"current": ("A", "i"), "torque": ("N*m", "ke*i")},
    1e-3,
)
ROTOR_KNOWN = {"J": 0.04, "q1": 0.03, "q2": 0.04, "b": 0.08}
GENERATOR_KNOWN = {"ke": 0.03, "R": 0.06, "L": 0.08}


def _rotor(
    folder: Path,
    rng: Rng,
    bridge: float = 0.0,
    gust: tuple[float, float, float] | None = None,
    noise_stated: float | None = 1.0,
    logger: Logger = PLAIN,
) -> None:
    """Two FMUs; a rectifier may take a voltage, `bridge` V; `gust` is begin [s], end [s] and factor."""
    stop = 40.0
    ROTOR.build(folder)
    build3(GENERATOR, folder)
    data_sheet(folder, GENERATOR, GENERATOR_KNOWN)
    (folder / "numbers.yaml").rename(folder / "generator.yaml")
    data_sheet(folder, ROTOR, ROTOR_KNOWN)
    parts = (
        programme("tunnel", ("wind", "m/s"))
        + programme("decade", ("load", "ohm"))
        + with_numbers("rotor", "rotor")
        + with_numbers("generator", "generator", "internal").replace("numbers.yaml", "generator.yaml")
    )
    wires = (
        "  - tunnel.wind -> rotor.wind\n  - rotor.speed -> generator.speed\n"
        "  - decade.load -> generator.load\n  - generator.torque -> rotor.torque\n"
    )
    scenario(folder, "A rotor and its generator", stop, 0.01, 0.02, parts, wires)
    inertia, radius, rho, q0, q1, q2, b = drawn(rng, ROTOR, ROTOR_KNOWN)
    ke, r, inductance = drawn(rng, GENERATOR, GENERATOR_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        w, i = float(x[0]), float(x[1])
        wind, load = float(u[0]), float(u[1])
        tip = w * radius
        pull = 0.5 * np.pi * rho * radius**3 * (q0 * wind**2 + q1 * tip * wind - q2 * tip**2)
        drop = bridge * np.tanh(i / 0.02)
        return [(pull - b * w - ke * i) / inertia, (ke * w - drop - (r + load) * i) / inductance]

    for name in FOUR:
        stated = drawn_steps(rng, stop, 2.2, 5.0, 11.0, 0.02)
        wind = stated
        if gust is not None and name == "third":
            wind = between(stated, gust[0], gust[1], lambda v: gust[2] * v)
        load = drawn_steps(rng, stop, 3.0, 1.2, 6.0, 0.02)
        t, x = integrated(rates, (40.0, 0.0), (wind, load), stop, 0.01)
        sensors = [
            Sensor("rotor.speed", "n_rpm", "rpm", scaled(0, 30.0 / np.pi), 5.0, 0.04, noise_stated, 1.0),
            Sensor("generator.current", "I_A", "A", scaled(1, 1.0), 0.015, 0.02, noise_stated, 0.005),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"tunnel.wind": (wind, "m/s"), "decade.load": (load, "ohm")},
            logger,
            told={} if wind is stated else {"tunnel.wind": stated},
        )
        write(folder / name, rng, made)


def rotor_null(folder: Path, rng: Rng) -> Truth:
    _rotor(folder, rng, noise_stated=None, logger=Logger("ms", zero=250.0, empty=0.03))
    return Truth(
        "nothing; numbers off as stated, two FMUs, noise is not stated, empty cells, rpm, the clock begins at 250 ms",
        FINE,
        **FOUR_SPLIT,
    )


def rotor_bridge(folder: Path, rng: Rng) -> Truth:
    bridge = rng.uniform(0.8, 1.2)
    _rotor(folder, rng, bridge=bridge)
    return Truth(
        f"a rectifier behind the generator takes {bridge:.3f} V",
        PHYSICS,
        ("contact_drop", "diode_drop", "voltage_drop", "rectifier"),
        **FOUR_SPLIT,
    )


def rotor_gust(folder: Path, rng: Rng) -> Truth:
    begin, factor = 0.5 * round(rng.uniform(20.0, 40.0)), rng.uniform(1.08, 1.15)
    _rotor(folder, rng, gust=(begin, begin + 9.0, factor))
    return Truth(
        f"the wind was {factor:.3f} times what is stated, {begin:g} s to {begin + 9.0:g} s of the third recording",
        SENSOR,
        ("input_fault",),
        **FOUR_SPLIT,
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    beam_null,
    magnet_iron,
    surge_clock,
    peltier_null,
    table_detent,
    dryer_pounds,
    rotor_null,
    surge_two,
    cells_start,
    magnet_null,
    beam_rolling,
    peltier_exchanged,
    dryer_null,
    rotor_bridge,
    table_other_run,
    cells_null,
    peltier_seebeck,
    beam_bumped,
    table_null,
    surge_throttle,
    magnet_programme,
    dryer_falling,
    rotor_gust,
    peltier_two,
    cells_stagnant,
)
