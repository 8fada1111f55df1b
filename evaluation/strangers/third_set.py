"""Third set: a loudspeaker, an oven with a fan, a quarter of a car, a solenoid, a bellows, a buck converter.

Written by someone who had not read the library of laws. How large an effect is, and how far the numbers are off, is
drawn; the deviations of the numbers are those that a parameter set states, or the 5 % of a rig that states none.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

import numpy as np

from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.strangers.first_set import FOLDERS, Rng, fmu, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.lab import Logger, Sensor, Steps, Written, celsius, course, drawn_steps, write
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth

Spoil = Callable[[str, str, Array, Array], Array]
#: What an FMU without a stated parameter set is taken to be off by.
USUAL = 0.05


def stated(folder: Path, model: OdeModel, uncertainty: Mapping[str, float]) -> None:
    """A parameter set `numbers.yaml` that says how uncertain some numbers are; the others are held."""
    lines = ["title: From data sheets and a tape measure", "parameters:"]
    for name, (value, unit) in model.parameters.items():
        known = f"uncertainty: {uncertainty.get(name, 0.0):g}"
        lines.append(f'  {name}: {{value: {value!r}, unit: {unit}, source: "data sheet", {known}}}')
    (folder / "numbers.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")


def with_numbers(name: str, file: str, integrator: str = "cvode") -> str:
    """A component that is an FMU with that set."""
    return fmu(name, file, integrator).replace("}\n", ", parameter_set: numbers.yaml}\n")


def drawn(rng: Rng, model: OdeModel, uncertainty: Mapping[str, float] | None = None, size: float = 1.0) -> list[float]:
    """True numbers of a model, off by as much as is stated."""
    return [
        value * float(np.exp(size * (USUAL if uncertainty is None else uncertainty.get(name, 0.0)) * rng.normal()))
        for name, (value, _) in model.parameters.items()
    ]


# --- a loudspeaker: current and cone, FMI 3 Model Exchange, ms, mm, mA
SPEAKER = OdeModel(
    "driver",
    {
        "Re": (6.1, "ohm"),
        "Le": (1.2e-3, "H"),
        "Bl": (7.2, "N/A"),
        "Mms": (0.022, "kg"),
        "Rms": (1.9, "N*s/m"),
        "Kms": (1800.0, "N/m"),
    },
    {"u": "V"},
    {
        "i": ("A", "0.0", "(u - Re*i - Bl*v)/Le"),
        "x": ("m", "0.0", "v"),
        "v": ("m/s", "0.0", "(Bl*i - Rms*v - Kms*x)/Mms"),
    },
    {"current": ("A", "i"), "excursion": ("m", "x")},
    1e-5,
)
SPEAKER_KNOWN = {"Re": 0.02, "Bl": 0.06, "Rms": 0.2, "Kms": 0.1}


def _speaker(
    folder: Path,
    rng: Rng,
    fade: float = 0.0,
    hardening: float = 0.0,
    wind: float = 0.0,
    volts: tuple[float, float, float] = (6.0, 6.0, 6.0),
    noise_stated: float | None = 1.0,
) -> None:
    build3(SPEAKER, folder, has_co_simulation=False)
    stop = 0.8
    parts = programme("amp", ("u", "V")) + with_numbers("woofer", "driver")
    scenario(folder, "A woofer on the bench", stop, 5e-4, 5e-4, parts, "  - amp.u -> woofer.u\n")
    stated(folder, SPEAKER, SPEAKER_KNOWN)
    re, le, bl, m, r, k = drawn(rng, SPEAKER, SPEAKER_KNOWN)

    def rates(t: float, x: Array, u: Array) -> tuple[float, float, float]:
        i, z, v = float(x[0]), float(x[1]), float(x[2])
        b = bl * (1.0 - fade * z * z)
        force = b * i - r * v - k * z * (1.0 + hardening * z * z) - wind * v * abs(v)
        return (float(u[0]) - re * i - b * v) / le, v, force / m

    for name, top in zip(FOLDERS, volts):
        volt = drawn_steps(rng, stop, 0.025, -top, top, 5e-4)
        t, x = course(rates, (0.0, 0.0, 0.0), (volt,), stop, 2.5e-5)
        sensors = [
            Sensor("woofer.current", "I_mA", "mA", lambda t, x, u: 1e3 * x[:, 0], 6.0, 5e-4, noise_stated, 4.0),
            Sensor("woofer.excursion", "laser_mm", "mm", lambda t, x, u: 1e3 * x[:, 1], 0.01, 1e-3, noise_stated),
        ]
        write(folder / name, rng, Written(t, x, sensors, {"amp.u": (volt, "V")}, Logger("ms", jitter=0.2)))


def speaker_null(folder: Path, rng: Rng) -> Truth:
    _speaker(folder, rng, noise_stated=None)
    return Truth("nothing; numbers off as stated, noise is not stated", FINE)


def speaker_force_factor(folder: Path, rng: Rng) -> Truth:
    _speaker(folder, rng, fade=rng.uniform(0.5, 0.9) / 6e-3**2)
    return Truth("the force factor falls with excursion, as a motor and as a generator", PHYSICS)


def speaker_two(folder: Path, rng: Rng) -> Truth:
    _speaker(folder, rng, hardening=rng.uniform(0.8, 1.4) / 4e-3**2, wind=rng.uniform(2.0, 4.0))
    return Truth("a suspension that hardens with the cube, and drag of the air", PHYSICS, ("quadratic_drag",))


def speaker_loud(folder: Path, rng: Rng) -> Truth:
    _speaker(folder, rng, hardening=rng.uniform(0.8, 1.4) / 6e-3**2, volts=(2.0, 2.0, 9.0))
    return Truth("a suspension that hardens; held out is 4.5 times as loud", (*PHYSICS, *FINE))


# --- an oven with a fan: element and chamber, FMI 2 Model Exchange; a thermostat switches the heater; degC, %, min
OVEN = OdeModel(
    "oven",
    {
        "C_element": (900.0, "J/K"),
        "C_chamber": (6500.0, "J/K"),
        "still": (2.0, "W/K"),
        "forced": (9.0, "W/K"),
        "walls": (3.2, "W/K"),
        "T_begin": (296.15, "K"),
    },
    {"power": "W", "fan": "1", "ambient": "K"},
    {
        "T_e": ("K", "T_begin", "(power - (still + forced*fan)*(T_e - T_c))/C_element"),
        "T_c": ("K", "T_begin", "((still + forced*fan)*(T_e - T_c) - walls*(T_c - ambient))/C_chamber"),
    },
    {"element": ("K", "T_e"), "chamber": ("K", "T_c")},
)
OVEN_KNOWN = {"C_element": 0.08, "C_chamber": 0.08, "still": 0.15, "forced": 0.1, "walls": 0.1}


def _oven(
    folder: Path,
    rng: Rng,
    power_of_fan: float = 1.0,
    latent: float = 0.0,
    radiation: float = 0.0,
    lag: float = 0.0,
    warm: float = 0.0,
    fan_stated: bool = True,
) -> None:
    OVEN.build(folder)
    stop = 9000.0
    parts = programme("panel", ("power", "W"), ("fan", "'%'")).replace("0 '%'", "0 %") + programme(
        "lab", ("ambient", "K")
    )
    wires = "  - panel.power -> oven.power\n  - panel.fan -> oven.fan\n  - lab.ambient -> oven.ambient\n"
    scenario(folder, "An oven with a fan", stop, 10, 10, parts + with_numbers("oven", "oven"), wires)
    stated(folder, OVEN, OVEN_KNOWN)
    ce, cc, h0, h1, g, begin = drawn(rng, OVEN, OVEN_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        element, chamber, probe = x
        flow = (h0 + h1 * (0.01 * u[1]) ** power_of_fan) * (element - chamber)
        flow += radiation * 5.67e-8 * (element**4 - chamber**4)
        capacity = cc * (1.0 + latent * np.exp(-(((chamber - 371.0) / 4.0) ** 2)))
        return [
            (u[0] - flow) / ce,
            (flow - g * (chamber - u[2])) / capacity,
            (chamber - probe) / lag if lag else 0.0,
        ]

    for i, name in enumerate(FOLDERS):
        fan, wanted = drawn_steps(rng, stop, 1500, 10, 100, 10), drawn_steps(rng, stop, 2400, 340, 450, 10)
        told, ambient = fan, Steps((0.0,), (round(rng.uniform(293, 298), 1),))
        if not fan_stated and i == 0:
            fan = _between(fan, 3200.0, 4400.0, lambda level: 0.3 * level)
        start = begin + warm * rng.normal() if warm else begin
        power = _thermostat(rates, [start] * 3, fan, ambient, wanted, stop)
        t, x = course(rates, [start] * 3, (power, fan, ambient), stop, 5.0)
        sensors = [
            Sensor("oven.element", "element_C", "degC", celsius(0), 1.0, 10.0, 1.0, 0.5),
            Sensor("oven.chamber", "chamber_C", "degC", celsius(2 if lag else 1), 0.3, 10.0, 1.0, 0.25),
        ]
        programmes = {"panel.power": (power, "W"), "panel.fan": (fan, "%"), "lab.ambient": (ambient, "K")}
        write(
            folder / name,
            rng,
            Written(
                t,
                x,
                sensors,
                programmes,
                Logger("min"),
                recorded=["panel.power", "panel.fan"],
                told={} if fan_stated else {"panel.fan": told},
                sidecar={"uncertain": {"oven.T_begin": f"{warm:g} K"}} if warm else {},
            ),
        )


def _between(steps: Steps, begin: float, end: float, change: Callable[[float], float]) -> Steps:
    """A course that is another between two instants."""
    times = sorted({*steps.times, begin, end})
    levels = [float(v) for v in steps.at(np.asarray(times))]
    return Steps(tuple(times), tuple(change(v) if begin <= t < end else v for t, v in zip(times, levels)))


def _thermostat(
    rates: Callable[[float, Array, Array], list[float]],
    start: list[float],
    fan: Steps,
    ambient: Steps,
    wanted: Steps,
    stop: float,
) -> Steps:
    """When 1200 W are on: a relay with 2 K of hysteresis that looks every 10 s."""
    x, times, levels, is_on = np.asarray(start), [0.0], [1200.0], True
    room = ambient.levels[0]
    for t in np.arange(0.0, stop, 10.0):
        goal, speed = float(wanted.at(np.asarray([t]))[0]), float(fan.at(np.asarray([t]))[0])
        is_new = bool(x[1] < goal - 1) or (is_on and bool(x[1] < goal + 1))
        if is_new != is_on:
            times.append(float(t))
            levels.append(1200.0 if is_new else 0.0)
            is_on = is_new
        for _ in range(10):
            x = x + np.asarray(rates(t, x, np.asarray([levels[-1], speed, room])))
    return Steps(tuple(times), tuple(levels))


def oven_warm(folder: Path, rng: Rng) -> Truth:
    _oven(folder, rng, warm=12.0)
    return Truth("nothing; numbers off as stated, the oven begins warm by an unknown amount, which is said", FINE)


def oven_fan_law(folder: Path, rng: Rng) -> Truth:
    _oven(folder, rng, power_of_fan=rng.uniform(0.5, 0.65))
    return Truth("convection rises with the speed of the fan to a power of about 0.6", PHYSICS)


def oven_evaporation(folder: Path, rng: Rng) -> Truth:
    _oven(folder, rng, latent=rng.uniform(4.0, 7.0))
    return Truth("the chamber takes up latent heat around 98 degC", PHYSICS, ("latent_heat",))


def oven_two(folder: Path, rng: Rng) -> Truth:
    _oven(folder, rng, radiation=rng.uniform(0.03, 0.05), lag=rng.uniform(60.0, 100.0))
    return Truth(
        "radiation of the element, and a slow probe in the chamber", (*PHYSICS, *SENSOR), ("radiation", "sensor_lag")
    )


def oven_fan_throttled(folder: Path, rng: Rng) -> Truth:
    _oven(folder, rng, fan_stated=False)
    return Truth("the fan ran at 30 % of what is stated, 3200 s to 4400 s of the first recording", SENSOR)


# --- a quarter of a car on a shaker, FMI 2; the road is a column of the log; mm and m/s^2, two loggers
CAR = OdeModel(
    "quarter_car",
    {
        "m_body": (320.0, "kg"),
        "m_wheel": (42.0, "kg"),
        "spring": (22000.0, "N/m"),
        "damper": (1500.0, "N*s/m"),
        "tyre": (190000.0, "N/m"),
    },
    {"road": "m"},
    {
        "zb": ("m", "0.0", "vb"),
        "vb": ("m/s", "0.0", "(spring*(zw - zb) + damper*(vw - vb))/m_body"),
        "zw": ("m", "0.0", "vw"),
        "vw": ("m/s", "0.0", "(tyre*(road - zw) - spring*(zw - zb) - damper*(vw - vb))/m_wheel"),
    },
    {
        "body": ("m", "zb"),
        "wheel": ("m", "zw"),
        "acceleration": ("m/s^2", "(spring*(zw - zb) + damper*(vw - vb))/m_body"),
    },
    5e-4,
)


def _car(
    folder: Path,
    rng: Rng,
    skew: float = 0.0,
    sizes: tuple[float, float, float] = (6.0, 6.0, 6.0),
    lifts: bool = False,
    swaps: bool = False,
    late: float = 0.0,
    noise_stated: float | None = 1.0,
    integrator: str = "cvode",
) -> None:
    CAR.build(folder)
    stop = 10.0
    parts = programme("shaker", ("road", "mm")) + fmu("corner", "quarter_car", integrator)
    scenario(folder, "A quarter of a car on a shaker", stop, 5e-3, 5e-3, parts, "  - shaker.road -> corner.road\n")
    mb, mw, k, c, kt = drawn(rng, CAR)
    weight = (mb + mw) * 9.81

    def rates(t: float, x: Array, u: Array) -> tuple[float, float, float, float]:
        zb, vb, zw, vw = (float(v) for v in x)
        speed = vw - vb
        inner = k * (zw - zb) + c * (1.0 - skew if speed > 0 else 1.0 + skew) * speed
        tyre = kt * (1e-3 * float(u[0]) - zw)
        if lifts:
            tyre = max(tyre, -weight)
        return vb, inner / mb, vw, (tyre - inner) / mw

    for name, size in zip(FOLDERS, sizes):
        road = _road(rng, stop, size)
        t, x = course(rates, (0.0, 0.0, 0.0, 0.0), (road,), stop, 1e-3)
        body, wheel = (2, 0) if swaps and name == "second" else (0, 2)
        force = np.asarray([rates(0.0, s, np.zeros(1))[1] for s in x])
        sensors = [
            _millimetres("corner.body", "body_mm", body, noise_stated),
            _millimetres("corner.wheel", "wheel_mm", wheel, noise_stated),
            Sensor(
                "corner.acceleration",
                "a_ms2",
                "m/s^2",
                partial(_delayed, t, force, late),
                0.06,
                1e-2,
                noise_stated,
            ),
        ]
        made = Written(t, x, sensors, {"shaker.road": (road, "mm")}, Logger("s"), recorded=["shaker.road"])
        write(folder / name, rng, made)


def _millimetres(name: str, column: str, state: int, noise_stated: float | None) -> Sensor:
    return Sensor(name, column, "mm", lambda t, x, u: 1e3 * x[:, state], 0.15, 5e-3, noise_stated, 0.05)


def _delayed(times: Array, values: Array, late: float, t: Array, x: Array, u: Array) -> Array:
    """What a logger reads whose clock is late."""
    return np.asarray(np.interp(t - late, times, values))


def _road(rng: Rng, stop: float, size: float) -> Steps:
    """A rough road [mm], held over 5 ms."""
    count, values, slow = round(stop / 5e-3), [], 0.0
    now = 0.0
    for _ in range(count):
        slow += 5e-3 * (-slow / 0.5) + np.sqrt(5e-3 * 2 / 0.5) * rng.normal()
        now += 5e-3 * (slow - now) / 0.03
        values.append(round(size * now, 2))
    return Steps(tuple(5e-3 * i for i in range(count)), tuple(values))


def car_null(folder: Path, rng: Rng) -> Truth:
    _car(folder, rng, noise_stated=None, integrator="internal")
    return Truth("nothing; noise is not stated, numbers 5 % off, Co-Simulation", FINE)


def car_damper(folder: Path, rng: Rng) -> Truth:
    _car(folder, rng, skew=rng.uniform(0.35, 0.5))
    return Truth("the damper is softer in bump than in rebound", PHYSICS)


def car_lift(folder: Path, rng: Rng) -> Truth:
    _car(folder, rng, sizes=(4.0, 4.0, 60.0), lifts=True)
    return Truth(
        "the wheel leaves the road, in the held-out recording alone, which is 15 times as rough", PHYSICS + FINE
    )


def car_swapped(folder: Path, rng: Rng) -> Truth:
    _car(folder, rng, swaps=True)
    return Truth("body and wheel are exchanged in the second recording", RECORDING)


def car_late(folder: Path, rng: Rng) -> Truth:
    _car(folder, rng, late=rng.uniform(0.03, 0.06))
    return Truth("the clock of the accelerometer is 30 to 60 ms late", RECORDING + SENSOR)


# --- a proportional solenoid: flux linkage and plunger, FMI 3 Model Exchange
SOLENOID = OdeModel(
    "solenoid",
    {
        "R": (24.0, "ohm"),
        "kL": (7.2e-4, "H*m"),
        "gap": (6e-3, "m"),
        "k": (6000.0, "N/m"),
        "m": (0.05, "kg"),
        "d": (12.0, "N*s/m"),
    },
    {"u": "V"},
    {
        "flux": ("V*s", "0.0", "u - R*flux*(gap - s)/kL"),
        "s": ("m", "0.0", "v"),
        "v": ("m/s", "0.0", "(flux*flux/(2*kL) - k*s - d*v)/m"),
    },
    {"current": ("A", "flux*(gap - s)/kL"), "stroke": ("m", "s")},
    1e-4,
)
SOLENOID_KNOWN = {"R": 0.03, "kL": 0.05, "k": 0.04, "d": 0.2}


def _solenoid(
    folder: Path, rng: Rng, copper: float = 0.0, iron: float = 0.0, spoil: Spoil | None = None, size: float = 1.0
) -> None:
    build3(SOLENOID, folder, has_co_simulation=False)
    stop = 5.0
    parts = programme("driver", ("u", "V")) + with_numbers("valve", "solenoid")
    scenario(folder, "A proportional solenoid", stop, 2e-3, 2e-3, parts, "  - driver.u -> valve.u\n")
    stated(folder, SOLENOID, SOLENOID_KNOWN)
    r, kl, gap, k, m, d = drawn(rng, SOLENOID, SOLENOID_KNOWN, size)

    def rates(t: float, x: Array, u: Array) -> tuple[float, float, float, float]:
        flux, s, v, warm = (float(w) for w in x)
        now = r * (1.0 + copper * warm)
        magnet = flux * (gap - s) / kl
        # eddy currents of the iron carry (d flux/dt)/iron beside the magnetising current
        induced = (float(u[0]) - now * magnet) / (1.0 + now / iron) if iron else float(u[0]) - now * magnet
        total = (float(u[0]) - induced) / now
        return induced, v, (flux * flux / (2 * kl) - k * s - d * v) / m, (now * total**2 - warm / 9.0) / 0.9

    def current(t: Array, x: Array, u: Array) -> Array:
        magnet = x[:, 0] * (gap - x[:, 1]) / kl
        warm = r * (1.0 + copper * x[:, 3])
        induced = (u[:, 0] - warm * magnet) / (1.0 + warm / iron) if iron else u[:, 0] - warm * magnet
        return np.asarray(1e3 * (u[:, 0] - induced) / warm)

    for name in FOLDERS:
        volt = drawn_steps(rng, stop, 0.15, 2.0, 15.0, 2e-3)
        t, x = course(rates, (0.0, 0.0, 0.0, 0.0), (volt,), stop, 2.5e-4)
        sensors = [
            Sensor("valve.current", "I_mA", "mA", current, 3.0, 4e-3, 1.0, 2.0),
            Sensor("valve.stroke", "s_mm", "mm", lambda t, x, u: 1e3 * x[:, 1], 0.006, 4e-3, 1.0, 0.01),
        ]
        write(
            folder / name,
            rng,
            Written(
                t,
                x,
                sensors,
                {"driver.u": (volt, "V")},
                Logger("s", zero=100.0, jitter=0.3, gap=(3.1, 3.4)),
                spoil=None if spoil is None else partial(spoil, name),
            ),
        )


def solenoid_null(folder: Path, rng: Rng) -> Truth:
    _solenoid(folder, rng, size=1.3)
    return Truth("nothing; numbers off by 1.3 times what is stated, a gap, jitter", FINE)


def solenoid_hot(folder: Path, rng: Rng) -> Truth:
    _solenoid(folder, rng, copper=0.0039)
    return Truth(
        "the winding heats itself and its resistance rises",
        PHYSICS,
        ("self_heating_resistance", "temperature_dependent_resistance", "resistance_of_temperature"),
    )


def solenoid_eddy(folder: Path, rng: Rng) -> Truth:
    _solenoid(folder, rng, iron=rng.uniform(40.0, 80.0))
    return Truth("eddy currents in the iron, a resistance beside the magnetising branch", PHYSICS)


def solenoid_stuck(folder: Path, rng: Rng) -> Truth:
    begin = rng.uniform(1.0, 2.0)

    def spoil(name: str, column: str, t: Array, v: Array) -> Array:
        held = (t > begin) & (t < begin + 0.7)
        return np.where(held, v[np.argmax(held)], v) if name == "first" and column == "s_mm" else v

    _solenoid(folder, rng, spoil=spoil)
    return Truth(f"the stroke sensor is stuck for 0.7 s from {begin:.2f} s of the first recording", SENSOR)


# --- a pneumatic bellows behind a regulator, FMI 2 Model Exchange; bar and mm
BELLOWS = OdeModel(
    "bellows",
    {
        "c": (4e-4, "m^3/s"),
        "V0": (1.2e-4, "m^3"),
        "A": (8e-4, "m^2"),
        "k": (2400.0, "N/m"),
        "d": (60.0, "N*s/m"),
        "M": (1.5, "kg"),
    },
    {"supply": "Pa"},
    {
        "p": ("Pa", "0.0", "(c*(supply - p) - (p + 101325.0)*A*v)/(V0 + A*x)"),
        "x": ("m", "0.0", "v"),
        "v": ("m/s", "0.0", "(A*p - k*x - d*v)/M"),
    },
    {"pressure": ("Pa", "p"), "extension": ("m", "x")},
    1e-3,
)
BELLOWS_KNOWN = {"c": 0.15, "V0": 0.05, "k": 0.05, "d": 0.2}


def _bellows(
    folder: Path,
    rng: Rng,
    leak: float = 0.0,
    rubber: float = 0.0,
    spoil: Spoil | None = None,
    inflated: float = 0.0,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
) -> None:
    BELLOWS.build(folder)
    stop = 20.0
    parts = programme("regulator", ("supply", "bar")) + with_numbers("finger", "bellows")
    scenario(folder, "A bellows", stop, 0.01, 0.02, parts, "  - regulator.supply -> finger.supply\n")
    stated(folder, BELLOWS, BELLOWS_KNOWN)
    c, v0, a, k, d, m = drawn(rng, BELLOWS, BELLOWS_KNOWN)

    def rates(t: float, x: Array, u: Array) -> tuple[float, float, float, float]:
        p, s, v, z = (float(w) for w in x)
        flow = c * (1e5 * float(u[0]) - p) - leak * p - (p + 101325.0) * a * v
        return flow / (v0 + a * s), v, (a * p - k * s - d * v - rubber * z) / m, v - z / 2.5

    other: Steps | None = None
    for name in FOLDERS:
        bar = drawn_steps(rng, stop, 1.5, 0.0, 1.2, 0.02)
        if name == "first":
            other = drawn_steps(rng, stop, 1.5, 0.0, 1.2, 0.02) if is_other else None
        start = 1e5 * inflated * rng.uniform(0.5, 1.0) if name != "third" else 0.0
        t, x = course(rates, (start, a * start / k, 0.0, 0.0), (bar,), stop, 2e-3)
        sensors = [
            Sensor("finger.pressure", "p_bar", "bar", lambda t, x, u: 1e-5 * x[:, 0], 0.004, 0.02, noise_stated, 0.005),
            Sensor("finger.extension", "ext_mm", "mm", lambda t, x, u: 1e3 * x[:, 1], 0.08, 0.04, noise_stated),
        ]
        told = {"regulator.supply": other} if other is not None and name == "first" else {}
        write(
            folder / name,
            rng,
            Written(
                t,
                x,
                sensors,
                {"regulator.supply": (bar, "bar")},
                told=told,
                spoil=None if spoil is None else partial(spoil, name),
            ),
        )


def bellows_inflated(folder: Path, rng: Rng) -> Truth:
    _bellows(folder, rng, inflated=0.8, noise_stated=None)
    return Truth(
        "nothing; both fitted recordings begin inflated, which is not said; noise is not stated",
        FINE + RECORDING + SENSOR,
    )


def bellows_leak(folder: Path, rng: Rng) -> Truth:
    _bellows(folder, rng, leak=rng.uniform(3e-5, 8e-5))
    return Truth("a leak to the air in proportion to the pressure", PHYSICS, ("leakage",))


def bellows_rubber(folder: Path, rng: Rng) -> Truth:
    _bellows(folder, rng, rubber=rng.uniform(400.0, 800.0))
    return Truth("the rubber relaxes: a spring and a dashpot in series beside the spring", PHYSICS)


def bellows_absolute(folder: Path, rng: Rng) -> Truth:
    _bellows(folder, rng, spoil=lambda name, column, t, v: v + 1.013 if column == "p_bar" else v)
    return Truth("the pressure is absolute and taken for gauge: 1.013 bar too much", RECORDING + SENSOR)


def bellows_other_run(folder: Path, rng: Rng) -> Truth:
    _bellows(folder, rng, is_other=True)
    return Truth("the first recording states the regulator of another run", RECORDING)


# --- a buck converter, averaged, FMI 2 Co-Simulation or Model Exchange; ms and %
BUCK = OdeModel(
    "buck",
    {"L": (1e-3, "H"), "C": (4.7e-4, "F"), "R": (0.15, "ohm"), "R_load": (30.0, "ohm")},
    {"duty": "1", "input": "V", "load": "A"},
    {
        "i": ("A", "0.0", "(duty*input - R*i - v)/L"),
        "v": ("V", "0.0", "(i - v/R_load - load)/C"),
    },
    {"current": ("A", "i"), "voltage": ("V", "v")},
    1e-5,
)


def _buck(
    folder: Path,
    rng: Rng,
    diode: bool = False,
    saturation: float = 0.0,
    noise_stated: float | None = 1.0,
    integrator: str = "cvode",
) -> None:
    BUCK.build(folder)
    stop = 0.12
    parts = (
        programme("control", ("duty", "'%'")).replace("0 '%'", "0 %")
        + programme("source", ("input", "V"))
        + programme("sink", ("load", "A"))
    )
    wires = "  - control.duty -> stage.duty\n  - source.input -> stage.input\n  - sink.load -> stage.load\n"
    scenario(folder, "A buck converter", stop, 1e-4, 1e-4, parts + fmu("stage", "buck", integrator), wires)
    inductance, c, r, rl = drawn(rng, BUCK)

    def rates(t: float, x: Array, u: Array) -> tuple[float, float]:
        i, v = float(x[0]), float(x[1])
        rise = (0.01 * float(u[0]) * float(u[1]) - r * i - v) / inductance * (1.0 + saturation * i * i)
        if diode:  # the current cannot turn round; it comes to rest within 10 us
            rise = max(rise, -i / 1e-5)
        return rise, (i - v / rl - float(u[2])) / c

    for name in FOLDERS:
        duty, load = drawn_steps(rng, stop, 6e-3, 20, 80, 1e-4), drawn_steps(rng, stop, 9e-3, 0.0, 2.0, 1e-4)
        source = Steps((0.0,), (12.0,))
        t, x = course(rates, (0.0, 0.0), (duty, source, load), stop, 1e-5)
        sensors = [
            Sensor("stage.current", "iL", "A", lambda t, x, u: x[:, 0], 0.02, 1e-4, noise_stated, 0.01),
            Sensor("stage.voltage", "Vout", "V", lambda t, x, u: x[:, 1], 0.015, 1e-4, noise_stated),
        ]
        programmes = {"control.duty": (duty, "%"), "source.input": (source, "V"), "sink.load": (load, "A")}
        write(folder / name, rng, Written(t, x, sensors, programmes, Logger("ms", zero=250.0)))


def buck_null(folder: Path, rng: Rng) -> Truth:
    _buck(folder, rng, noise_stated=None, integrator="internal")
    return Truth("nothing; noise is not stated, the clock begins at 250 ms, Co-Simulation", FINE)


def buck_diode(folder: Path, rng: Rng) -> Truth:
    _buck(folder, rng, diode=True)
    return Truth("the current cannot turn round (a diode, no synchronous switch)", PHYSICS)


def buck_saturation(folder: Path, rng: Rng) -> Truth:
    _buck(folder, rng, saturation=rng.uniform(0.04, 0.08))
    return Truth("the inductance falls with the square of the current", PHYSICS)


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    buck_null,
    speaker_force_factor,
    oven_fan_throttled,
    car_damper,
    solenoid_stuck,
    bellows_leak,
    oven_warm,
    car_swapped,
    solenoid_hot,
    bellows_absolute,
    speaker_two,
    buck_diode,
    car_null,
    oven_fan_law,
    bellows_other_run,
    speaker_loud,
    solenoid_null,
    car_late,
    bellows_rubber,
    oven_evaporation,
    speaker_null,
    oven_two,
    car_lift,
    solenoid_eddy,
    bellows_inflated,
    buck_saturation,
)
