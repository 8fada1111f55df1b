"""Seventeenth set: a sewing machine, a triboelectric cloth, a blimp, a filter, a bath, a cuff, a bus, a motor driver.

Written without a look at the library of laws, its proof, its tests or its thresholds, and without a diagnosis of any of
its cases; of the earlier sets, the author had read the last two and the helpers that these take from the others.
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
from evaluation.strangers.eighth_set import idle_column
from evaluation.strangers.eleventh_set import DEGREES, LEAKING, RPM, telegraph
from evaluation.strangers.fifteenth_set import ramped
from evaluation.strangers.fifth_set import GRAVITY, integrated
from evaluation.strangers.first_set import PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import between, bursts, data_sheet, scaled
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Written, celsius, drawn_steps, write
from evaluation.strangers.sixteenth_set import WARMER, later
from evaluation.strangers.tenth_set import stairs, swept
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.thirteenth_set import wandering
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth
from evaluation.strangers.twelfth_set import SQUARE

#: Permittivity of air [F/m]; newton metres in an inch-pound.
PERMITTIVITY, INCH_POUND = 8.854e-12, 0.112985


# --- main shaft of a sewing machine, its belt and its speed drive, FMI 2 Model Exchange; ms, rpm, N m, deg
SEWING = OdeModel(
    "sewing_machine",
    {
        "J_m": (1.2e-4, "kg*m^2"),
        "J_s": (6e-4, "kg*m^2"),
        "k": (12.0, "N*m/rad"),
        "c": (4e-3, "N*m*s/rad"),
        "d": (1.5e-3, "N*m*s/rad"),
        "k_p": (0.06, "N*m*s/rad"),
    },
    {"pedal": "rad/s", "cloth": "N*m"},
    {
        "w_m": ("rad/s", "0.0", "(k_p*(pedal - w_m) - k*twist - c*(w_m - w_s))/J_m"),
        "twist": ("rad", "0.0", "w_m - w_s"),
        "w_s": ("rad/s", "0.0", "(k*twist + c*(w_m - w_s) - d*w_s - cloth)/J_s"),
        "turned": ("rad", "0.0", "w_s"),
    },
    {"motor": ("rad/s", "w_m"), "shaft": ("rad", "turned"), "belt": ("N*m", "k*twist + c*(w_m - w_s)")},
    5e-4,
)
SEWING_KNOWN = {"J_m": 0.04, "J_s": 0.05, "k": 0.06, "c": 0.15, "d": 0.1, "k_p": 0.03}


def _sewing(
    folder: Path,
    rng: Rng,
    bar: float = 0.0,
    is_inch_pound: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """The needle bar may weigh, so that the inertia is J_s - bar cos(2 turned) [kg m^2].

    The torque of the second recording may have been logged in inch-pounds.
    """
    SEWING.build(folder)
    parts = programme("drive", ("pedal", "rpm")) + programme("brake", ("cloth", "N*m"))
    parts += with_numbers("machine", "sewing_machine")
    wires = "  - drive.pedal -> machine.pedal\n  - brake.cloth -> machine.cloth\n"
    scenario(folder, "Main shaft of a sewing machine", 6.4, 2e-3, 4e-3, parts, wires)
    data_sheet(folder, SEWING, SEWING_KNOWN)
    j_m, j_s, k, c, d, k_p = drawn(rng, SEWING, SEWING_KNOWN)

    def belt(x: Array) -> Array:
        """Torque of the belt [N m]."""
        return np.asarray(k * x[..., 1] + c * (x[..., 0] - x[..., 2]))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        w_m, _, w_s, turned = (float(s) for s in x)
        pulled = float(belt(x))
        thrown = bar * np.sin(2.0 * turned) * w_s * w_s
        return [
            (k_p * (float(u[0]) / RPM - w_m) - pulled) / j_m,
            w_m - w_s,
            (pulled - d * w_s - float(u[1]) - thrown) / (j_s - bar * np.cos(2.0 * turned)),
            w_s,
        ]

    for number, (name, stop) in enumerate((("first", 6.4), ("second", 5.2), ("third", 5.8))):
        pedal = drawn_steps(rng, stop, 0.45, 180.0, 900.0, 4e-3)
        if name == "third":
            pedal = swept(stop, 220.0, 860.0, 1.8, 0.7, 8e-3)
        cloth = bursts(rng, stop, 0.3, 0.3, 0.05, 0.6, 4e-3)
        pedal, cloth = later(pedal, 2e-3), later(cloth, 2e-3)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0), (pedal, cloth), stop, 1e-3)
        unit = INCH_POUND if is_inch_pound and name == "second" else 1.0

        def spoil(column: str, t: Array, v: Array, unit: float = unit) -> Array:
            return v / unit if column == "M Riemen" else v

        sensors = [
            Sensor("machine.motor", "tacho rpm", "rpm", scaled(0, RPM), 2.5, 4e-3, noise_stated, 0.5),
            Sensor("machine.shaft", "encoder", "deg", scaled(3, DEGREES), 0.8, 4e-3, noise_stated, 0.5),
            Sensor("machine.belt", "M Riemen", "N*m", lambda t, x, u: belt(x), 0.012, 4e-3, noise_stated, 2e-3),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"drive.pedal": (pedal, "rpm"), "brake.cloth": (cloth, "N*m")},
            loggers[number % len(loggers)],
            spoil=spoil,
        )
        write(folder / name, rng, made)


def sewing_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=-320.0), Logger("s", zero=61.0, gap=(2.4, 2.9)), Logger("ms", zero=1e4, jitter=0.2))
    _sewing(folder, rng, noise_stated=1.2, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.2 times too large, a gap of 0.5 s, jitter, three loggers of ms "
        "and s",
        FINE,
    )


def sewing_bar(folder: Path, rng: Rng) -> Truth:
    bar = rng.uniform(2.5e-5, 4.5e-5)
    _sewing(folder, rng, bar=bar, loggers=(Logger("s", zero=2.0), Logger("ms")))
    return Truth(
        f"the needle bar weighs: the shaft's inertia is J_s - {bar:.2e} kg m^2 cos(2 angle), with its torque of the "
        "square of the speed",
        PHYSICS,
    )


def sewing_unit(folder: Path, rng: Rng) -> Truth:
    _sewing(folder, rng, is_inch_pound=True, loggers=(Logger("ms"), Logger("s", zero=-1.0)))
    return Truth("the torque of the second recording is in inch-pounds, said to be in N m", (*RECORDING, *SENSOR))


# --- two triboelectric cloths on a shaker, contact and separation, FMI 3 Co-Simulation; ms, mm, nS, V, nC
TRIBO = OdeModel(
    "tribo_cloth",
    {
        "S": (0.01, "m^2"),
        "sigma": (3e-6, "C/m^2"),
        "d": (1.5e-4, "m"),
        "T": (0.015, "s"),
    },
    {"shaker": "m", "load": "S"},
    {
        "z": ("m", "0.0", "(shaker - z)/T"),
        "q": ("C", "0.0", f"load*(sigma*z - q*(d + z)/S)/{PERMITTIVITY}"),
    },
    {"volts": ("V", f"(sigma*z - q*(d + z)/S)/{PERMITTIVITY}"), "charge": ("C", "q"), "gap": ("m", "z")},
    5e-4,
)
TRIBO_KNOWN = {"S": 0.03, "sigma": 0.06, "d": 0.08, "T": 0.06}


def _tribo(
    folder: Path,
    rng: Rng,
    stray: float = 0.0,
    share: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """The leads may have a capacitance, `stray` pF, parallel to the load.

    The electrometer may end, in the first recording, at what is exceeded for a `share` of the time.
    """
    build3(TRIBO, folder, has_exchange=False)
    parts = programme("table", ("shaker", "mm")) + programme("decade", ("load", "nS"))
    parts += with_numbers("cloth", "tribo_cloth", "internal")
    wires = "  - table.shaker -> cloth.shaker\n  - decade.load -> cloth.load\n"
    scenario(folder, "A triboelectric cloth on a shaker", 8.0, 2.5e-3, 5e-3, parts, wires)
    data_sheet(folder, TRIBO, TRIBO_KNOWN)
    area, sigma, d, lag = drawn(rng, TRIBO, TRIBO_KNOWN)

    def volts(x: Array) -> Array:
        """Voltage of gap [mm] and charge [nC]."""
        z, q = 1e-3 * x[..., 0], 1e-9 * x[..., 1]
        return np.asarray((sigma * z - q * (d + z) / area) / PERMITTIVITY)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        z, q = (float(s) for s in x)
        moving = (float(u[0]) - z) / lag
        through = float(u[1]) * float(volts(x))
        elastance = (d + 1e-3 * z) / (PERMITTIVITY * area)
        driven = 1e-3 * moving * (sigma - 1e-9 * q / area) / PERMITTIVITY
        return [moving, (through + 1e-3 * stray * driven) / (1.0 + 1e-12 * stray * elastance)]

    for number, (name, stop) in enumerate((("first", 8.0), ("second", 6.5), ("third", 7.2))):
        shaker = drawn_steps(rng, stop, 0.16, 0.05, 1.5, 5e-3)
        if name == "third":
            shaker = telegraph(rng, stop, 0.14, 0.08, 1.45, 5e-3)
        load = drawn_steps(rng, stop, 0.9, 0.3, 2.5, 5e-3)
        t, x = integrated(rates, (0.0, 0.0), (shaker, load), stop, 1.25e-3)
        end = np.inf
        if share and name == "first":
            end = float(f"{np.quantile(np.abs(volts(x)), 1.0 - share):.0f}")

        def spoil(column: str, t: Array, v: Array, end: float = end) -> Array:
            return np.clip(v, -end, end) if column == "Keithley V" else v

        sensors = [
            Sensor("cloth.volts", "Keithley V", "V", lambda t, x, u: volts(x), 1.5, 5e-3, noise_stated, 0.5),
            Sensor("cloth.charge", "Q (nC)", "nC", scaled(1, 1.0), 0.08, 5e-3, noise_stated, 0.02),
            Sensor("cloth.gap", "optoNCDT", "mm", scaled(0, 1.0), 0.012, 5e-3, noise_stated, 5e-3),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"table.shaker": (shaker, "mm"), "decade.load": (load, "nS")},
            loggers[number % len(loggers)],
            spoil=spoil,
        )
        write(folder / name, rng, made)


def tribo_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=777.0, empty=0.02), Logger("s", zero=-0.4), Logger("min", zero=3.0))
    _tribo(folder, rng, noise_stated=None, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, empty cells, three loggers of ms, s and min, "
        "Co-Simulation",
        FINE,
    )


def tribo_stray(folder: Path, rng: Rng) -> Truth:
    stray = rng.uniform(25.0, 45.0)
    _tribo(folder, rng, stray=stray, loggers=(Logger("ms"), Logger("s", zero=8.0)))
    return Truth(f"the leads have a capacitance of {stray:.1f} pF parallel to the load", PHYSICS)


def tribo_clipped(folder: Path, rng: Rng) -> Truth:
    share = rng.uniform(0.1, 0.18)
    _tribo(folder, rng, share=share, loggers=(Logger("s"), Logger("ms", zero=-90.0)))
    return Truth(
        f"the electrometer ends at what {100 * share:.0f} % of the first recording exceed, either way, which is not "
        "stated",
        SENSOR,
    )


# --- a blimp of cloth in a hall, held by a chain that lies on the floor, FMI 2 Co-Simulation; m, N, W; room is a column
BLIMP = OdeModel(
    "blimp",
    {
        "m": (1.75, "kg"),
        "B": (14.1, "N"),
        "L": (4.3, "N"),
        "lam": (0.15, "kg/m"),
        "d": (0.9, "N*s/m"),
        "C": (1350.0, "J/K"),
        "h": (33.0, "W/K"),
        "z_begin": (2.6, "m"),
        "T_begin": (294.15, "K"),
    },
    {"thrust": "N", "lamp": "W", "room": "K"},
    {
        "z": ("m", "z_begin", "v"),
        "v": (
            "m/s",
            "0.0",
            f"(L + B*(T - room)/fmax(room, 250.0) + thrust - lam*{GRAVITY}*z - d*v)/m",
        ),
        "T": ("K", "T_begin", "(lamp - h*(T - room))/C"),
    },
    {"height": ("m", "z"), "gas": ("K", "T")},
    0.02,
)
BLIMP_KNOWN = {"m": 0.04, "L": 0.04, "lam": 0.03, "d": 0.1, "C": 0.06, "h": 0.06}


def _blimp(
    folder: Path,
    rng: Rng,
    drag: float = 0.0,
    lost: float = 0.0,
    lag: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Air may drag besides, drag v^2 [N s^2/m^2], and helium may get out, so that lift falls by `lost` N/s.

    Helium is filled up before each recording. The altimeter of the second may follow with a lag [s].
    """
    BLIMP.build(folder)
    names = (("rotor", "thrust", "N"), ("spot", "lamp", "W"), ("hall", "room", "degC"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("balloon", "blimp", "internal")
    wires = "".join(f"  - {c}.{n} -> balloon.{n}\n" for c, n, _ in names)
    scenario(folder, "A blimp with a chain", 600.0, 0.25, 0.5, parts, wires)
    data_sheet(folder, BLIMP, BLIMP_KNOWN)
    m, b, lift, chain, d, c, h, z_begin, t_begin = drawn(rng, BLIMP, BLIMP_KNOWN)

    for number, (name, stop) in enumerate((("first", 600.0), ("second", 480.0), ("third", 540.0))):
        thrust = drawn_steps(rng, stop, 9.0, -1.4, 1.9, 0.5)
        if name == "third":
            thrust = stairs(rng, stop, 8.0, -1.2, 1.7, 4, 0.5)
        lamp = bursts(rng, stop, 60.0, 60.0, 120.0, 420.0, 0.5)
        room = ramped(rng, stop, 120.0, 19.0, 23.0, 5.0)
        late = lag if name == "second" else 0.0

        def rates(t: float, x: Array, u: Array, late: float = late) -> list[float]:
            z, v, gas, shown = (float(s) for s in x)
            warm = float(u[2]) + CELSIUS
            up = lift - lost * t + b * (gas - warm) / warm + float(u[0])
            return [
                v,
                (up - chain * GRAVITY * z - d * v - drag * v * abs(v)) / m,
                (float(u[1]) - h * (gas - warm)) / c,
                (z - shown) / late if late else v,
            ]

        t, x = integrated(rates, (z_begin, 0.0, t_begin, z_begin), (thrust, lamp, room), stop, 0.125)
        sensors = [
            Sensor("balloon.height", "ToF m", "m", scaled(3, 1.0), 0.01, 0.5, noise_stated, 5e-3),
            Sensor("balloon.gas", "Pt He", "degC", celsius(2), 0.12, 0.5, noise_stated, 0.05),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"rotor.thrust": (thrust, "N"), "spot.lamp": (lamp, "W"), "hall.room": (room, "degC")},
            loggers[number % len(loggers)],
            recorded=["hall.room"],
        )
        write(folder / name, rng, made)


def blimp_drag(folder: Path, rng: Rng) -> Truth:
    drag = rng.uniform(0.5, 0.85)
    _blimp(folder, rng, drag=drag, loggers=(Logger("s", zero=120.0), Logger("min")))
    return Truth(f"air drags besides, {drag:.3f} N s^2/m^2 v^2", PHYSICS, SQUARE)


def blimp_two(folder: Path, rng: Rng) -> Truth:
    drag, lost = rng.uniform(0.5, 0.85), rng.uniform(6e-4, 1.1e-3)
    _blimp(folder, rng, drag=drag, lost=lost, loggers=(Logger("min", zero=-1.0), Logger("s", zero=9.0), PLAIN))
    return Truth(
        f"air drags besides, {drag:.3f} N s^2/m^2 v^2, and helium gets out, lift falls by {1e3 * lost:.3f} mN/s in "
        "each recording anew",
        PHYSICS,
        (*SQUARE, *LEAKING, "hidden_state", "hidden_source"),
    )


def blimp_lag(folder: Path, rng: Rng) -> Truth:
    lag = rng.uniform(0.7, 1.3)
    _blimp(folder, rng, lag=lag, loggers=(PLAIN, Logger("ms", zero=5e3), Logger("min")))
    return Truth(f"the altimeter follows with a lag of {lag:.2f} s in the second recording (its filter was on)", SENSOR)


# --- a membrane that filters dye water, a cake grows on it, FMI 2 Co-Simulation; bar, L/h, g/L, h; degC a column
MEMBRANE = OdeModel(
    "membrane",
    {
        "A": (0.5, "m^2"),
        "V": (0.03, "m^3"),
        "mu": (1e-3, "Pa*s"),
        "R_m": (4e12, "1/m"),
        "alpha": (8e13, "m/kg"),
        "k_e": (1e-3, "1/m"),
        "c_feed": (1.2, "kg/m^3"),
        "c_begin": (2.0, "kg/m^3"),
    },
    {"pressure": "Pa", "cross": "m/s", "bleed": "m^3/s", "warmth": "K"},
    {
        "c": (
            "kg/m^3",
            "c_begin",
            "(bleed*(c_feed - c) + A*k_e*cross*cake"
            " + A*(c_feed - c)*pressure/(mu*exp(-0.024*(warmth - 293.15))*(R_m + alpha*cake)))/V",
        ),
        "cake": (
            "kg/m^2",
            "0.0",
            "c*pressure/(mu*exp(-0.024*(warmth - 293.15))*(R_m + alpha*cake)) - k_e*cross*cake",
        ),
    },
    {
        "permeate": ("m^3/s", "A*pressure/(mu*exp(-0.024*(warmth - 293.15))*(R_m + alpha*cake))"),
        "dye": ("kg/m^3", "c"),
    },
    15.0,
)
MEMBRANE_KNOWN = {"V": 0.02, "R_m": 0.06, "alpha": 0.08, "k_e": 0.08, "c_feed": 0.02}


def _membrane(
    folder: Path,
    rng: Rng,
    power: float = 0.0,
    fast: float = 0.0,
    strayed: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> None:
    """The cake may be compressible, alpha (pressure/1 bar)^power; a clock that is `fast` is the logger's.

    `strayed` is by how much [g/L] the dye at each begin is off (deviation), which is stated.
    """
    MEMBRANE.build(folder)
    names = (("pump", "pressure", "bar"), ("loop", "cross", "m/s"), ("drain", "bleed", "L/h"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + programme("bath", ("warmth", "degC"))
    parts += with_numbers("module", "membrane", "internal")
    wires = "".join(f"  - {c}.{n} -> module.{n}\n" for c, n, _ in names) + "  - bath.warmth -> module.warmth\n"
    scenario(folder, "A membrane for dye water", 28800.0, 15, 30, parts, wires)
    data_sheet(folder, MEMBRANE, MEMBRANE_KNOWN)
    area, volume, mu, r_m, alpha, k_e, c_feed, usual = drawn(rng, MEMBRANE, MEMBRANE_KNOWN)

    def flux(cake: Array, u: Array) -> Array:
        """Through the membrane [m/s]; cake in g/m^2."""
        viscosity = mu * np.exp(-0.024 * (u[..., 3] + CELSIUS - 293.15))
        resistance = r_m + alpha * np.asarray(u[..., 0]) ** power * 1e-3 * cake
        return np.asarray(1e5 * u[..., 0] / (viscosity * resistance))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        c, cake = float(x[0]), float(x[1])
        through = float(flux(x[1], u))
        eroded = k_e * float(u[1]) * cake
        bleed = float(u[2]) / 3.6e6
        return [
            (bleed * (c_feed - c) + area * (through * (c_feed - c) + 1e-3 * eroded)) / volume,
            1e3 * c * through - eroded,
        ]

    for number, (name, stop) in enumerate((("first", 28800.0), ("second", 23400.0), ("third", 25800.0))):
        pressure = drawn_steps(rng, stop, 1100.0, 0.5, 2.0, 30.0)
        if name == "third":
            pressure = stairs(rng, stop, 1000.0, 0.6, 1.9, 5, 30.0)
        cross = drawn_steps(rng, stop, 2600.0, 0.4, 1.6, 30.0)
        bleed = drawn_steps(rng, stop, 4200.0, 8.0, 30.0, 30.0)
        pressure, cross, bleed = later(pressure, 15.0), later(cross, 15.0), later(bleed, 15.0)
        warmth = later(ramped(rng, stop, 3600.0, 18.0, 27.0, 60.0), 15.0)
        said = float(f"{usual + rng.uniform(-0.5, 1.0):.3g}") if strayed else usual
        start = (said + strayed * float(rng.normal()), 0.0)
        t, x = integrated(rates, start, (pressure, cross, bleed, warmth), stop, 15.0)
        sensors = [
            Sensor(
                "module.permeate",
                "FI-201 L/h",
                "L/h",
                lambda t, x, u: 3.6e6 * area * flux(x[:, 1], u),
                0.35,
                30.0,
                noise_stated,
                0.1,
            ),
            Sensor("module.dye", "Photometer g/L", "g/L", scaled(0, 1.0), 0.04, 60.0, noise_stated, 0.01),
        ]
        sidecar: dict[str, Any] = {}
        if strayed:
            sidecar["components"] = {"module": {"parameters": {"c_begin": f"{said:.6g} kg/m^3"}}}
            sidecar["uncertain"] = {"module.c_begin": f"{strayed:g} kg/m^3"}
        made = Written(
            t,
            x,
            sensors,
            {
                "pump.pressure": (pressure, "bar"),
                "loop.cross": (cross, "m/s"),
                "drain.bleed": (bleed, "L/h"),
                "bath.warmth": (warmth, "degC"),
            },
            loggers[number % len(loggers)],
            recorded=["bath.warmth"],
            sidecar=sidecar,
        )
        write(folder / name, rng, made)


def membrane_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("h", zero=7.5, gap=(10800.0, 12600.0)), Logger("min", zero=-20.0), Logger("s", zero=86400.0))
    _membrane(folder, rng, strayed=0.25, noise_stated=0.87, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, dye at the begin is stated and off by 0.25 g/L (deviation), which is stated "
        "too, noise stated 1.15 times too small, two rates, a gap of 30 min, three loggers of h, min and s, "
        "Co-Simulation",
        FINE,
    )


def membrane_cake(folder: Path, rng: Rng) -> Truth:
    power = rng.uniform(0.5, 0.8)
    _membrane(folder, rng, power=power, loggers=(Logger("min", zero=5.0), Logger("h")))
    return Truth(
        f"the cake is compressible: alpha (pressure/1 bar)^{power:.3f}",
        PHYSICS,
        ("nonlinear_conductance", "conductance_of_state", "state_dependent_conductance"),
    )


def membrane_clock(folder: Path, rng: Rng) -> Truth:
    fast = rng.uniform(8e-3, 1.4e-2)
    _membrane(folder, rng, loggers=(Logger("h", rate=1.0 + fast), Logger("min", zero=12.0), Logger("h")))
    return Truth(
        f"the clock of the first recording is {100 * fast:.2f} % fast, which is not stated", (*RECORDING, *SENSOR)
    )


# --- a bath that plates a skein with copper, FMI 3, both interfaces, without units; A, g/L, g, V, mL/min
PLATING = OdeModel(
    "plating_bath",
    {
        "V": (2.0, ""),
        "k": (3.293e-4, ""),
        "eta": (0.96, ""),
        "c_feed": (180.0, ""),
        "k_m": (0.45, ""),
        "tau": (20.0, ""),
        "E": (1.25, ""),
        "R": (0.12, ""),
        "b": (0.055, ""),
        "i_0": (0.3, ""),
        "c_begin": (35.0, ""),
    },
    {"current": "", "feed": ""},
    {
        "c": ("", "c_begin", "(feed/6e4*(c_feed - c) - k*eta*current)/V"),
        "c_s": ("", "c_begin", "(c - c_s - current/k_m)/tau"),
        "m": ("", "0.0", "k*eta*current"),
    },
    {
        "copper": ("", "c"),
        "skein": ("", "m"),
        "volts": ("", "E + R*current + b*asinh(current/(2.0*i_0*sqrt(fmax(c_s, 0.5)/30.0)))"),
    },
    1.0,
)
PLATING_KNOWN = {"V": 0.03, "eta": 0.015, "c_feed": 0.02, "k_m": 0.06, "tau": 0.1, "R": 0.05, "b": 0.06}


def _plating(
    folder: Path,
    rng: Rng,
    gassing: float = np.inf,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The larger the current, the larger may be its share that makes hydrogen, eta/(1 + (current/gassing)^2).

    The second recording may have the column of the current of another run.
    """
    build3(PLATING, folder)
    parts = programme("rectifier", ("current", "")) + programme("doser", ("feed", ""))
    parts += with_numbers("bath", "plating_bath")
    wires = "  - rectifier.current -> bath.current\n  - doser.feed -> bath.feed\n"
    scenario(folder, "A bath that plates a skein", 7200.0, 3, 6, parts, wires)
    data_sheet(folder, PLATING, PLATING_KNOWN)
    volume, k, eta, c_feed, k_m, tau, e, r, b, i_0, begin = drawn(rng, PLATING, PLATING_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        c, surface, _ = (float(s) for s in x)
        share = 1.0 / (1.0 + (float(u[0]) / gassing) ** 2)
        plated = k * eta * share * float(u[0])
        return [
            (float(u[1]) / 6e4 * (c_feed - c) - plated) / volume,
            (c - surface - share * float(u[0]) / k_m) / tau,
            plated,
        ]

    def volts(t: Array, x: Array, u: Array) -> Array:
        exchanged = 2.0 * i_0 * np.sqrt(np.maximum(x[:, 1], 0.5) / 30.0)
        return np.asarray(e + r * u[:, 0] + b * np.arcsinh(u[:, 0] / exchanged))

    other = later(drawn_steps(rng, 6000.0, 330.0, 0.8, 8.0, 6.0), 3.0)
    for number, (name, stop) in enumerate((("first", 7200.0), ("second", 6000.0), ("third", 6600.0))):
        current = drawn_steps(rng, stop, 330.0, 0.8, 8.0, 6.0)
        if name == "third":
            current = wandering(rng, stop, 280.0, 0.9, 7.8, 6.0)
        feed = drawn_steps(rng, stop, 800.0, 0.0, 1.2, 6.0)
        current, feed = later(current, 3.0), later(feed, 3.0)
        t, x = integrated(rates, (begin, begin, 0.0), (current, feed), stop, 3.0)
        sensors = [
            Sensor("bath.copper", "Cu [g/L]", "1", scaled(0, 1.0), 0.25, 6.0, noise_stated, 0.05, colour),
            Sensor("bath.skein", "Waage", "1", scaled(2, 1.0), 0.012, 6.0, noise_stated, 0.01, colour),
            Sensor("bath.volts", "U_Zelle", "1", volts, 8e-3, 6.0, noise_stated, 1e-3, colour),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"rectifier.current": (current, ""), "doser.feed": (feed, "")},
            loggers[number % len(loggers)],
            recorded=["rectifier.current"],
            told={"rectifier.current": other} if is_other and name == "second" else {},
        )
        write(folder / name, rng, made)
        idle_column(folder / name, "bath degC", lambda n: np.asarray(24.0 + 0.1 * rng.standard_normal(n)))


def plating_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=-60.0, empty=0.02), Logger("min", zero=545.0), Logger("h", zero=0.3))
    _plating(folder, rng, noise_stated=0.86, colour=0.5, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, no units, noise of neighbouring readings correlates by 0.5 and is stated 1.16 "
        "times too small, a column that nothing names, empty cells, three loggers of s, min and h",
        FINE,
    )


def plating_gassing(folder: Path, rng: Rng) -> Truth:
    gassing = rng.uniform(13.0, 19.0)
    _plating(folder, rng, gassing=gassing, loggers=(Logger("min", zero=2.0), PLAIN))
    return Truth(
        f"a share of the current makes hydrogen: eta/(1 + (current/{gassing:.2f})^2)",
        PHYSICS,
        ("saturation", "saturating_gain", "nonlinear_rate"),
    )


def plating_other_run(folder: Path, rng: Rng) -> Truth:
    _plating(folder, rng, is_other=True, loggers=(Logger("s", zero=400.0), Logger("min"), PLAIN))
    return Truth("the second recording has the current of another run", (*RECORDING, *SENSOR))


# --- a compression cuff around a calf, its pump and its valve, FMI 2 Model Exchange; %, kPa, mL
CUFF = OdeModel(
    "cuff",
    {
        "V_0": (4e-4, "m^3"),
        "c_e": (8e-9, "m^3/Pa"),
        "Q": (2.5e-5, "m^3/s"),
        "p_max": (4e4, "Pa"),
        "c_v": (4e-9, "m^3/s/Pa"),
        "C_t": (6e-9, "m^3/Pa"),
        "tau": (22.0, "s"),
        "p_room": (1.013e5, "Pa"),
    },
    {"pump": "", "valve": ""},
    {
        "p": (
            "Pa",
            "0.0",
            "(p_room*(Q*pump*(1.0 - p/p_max) - c_v*valve*p) - (p_room + p)*(C_t*p - V_t)/tau)"
            "/(V_0 + V_t + c_e*p + (p_room + p)*c_e)",
        ),
        "V_t": ("m^3", "0.0", "(C_t*p - V_t)/tau"),
    },
    {"pressure": ("Pa", "p"), "calf": ("m^3", "V_t")},
    0.05,
)
CUFF_KNOWN = {"V_0": 0.06, "c_e": 0.06, "Q": 0.04, "p_max": 0.05, "c_v": 0.06, "C_t": 0.06, "tau": 0.08}


def _cuff(
    folder: Path,
    rng: Rng,
    stiff: float = np.inf,
    unplugged: tuple[float, float] | None = None,
    quantum: float = 0.02,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Tissue may stiffen, it gives way to C_t p/(1 + p/stiff) at last, stiff in kPa.

    Unplugged is begin and end [s] of a stretch of the first recording in which the pump stands still.
    """
    CUFF.build(folder)
    names = (("driver_1", "pump"), ("driver_2", "valve"))
    parts = "".join(programme(c, (n, "'%'")).replace("0 '%'", "0 %") for c, n in names) + with_numbers("sleeve", "cuff")
    wires = "".join(f"  - {c}.{n} -> sleeve.{n}\n" for c, n in names)
    scenario(folder, "A compression cuff", 450.0, 0.25, 0.5, parts, wires)
    data_sheet(folder, CUFF, CUFF_KNOWN)
    v_0, c_e, q, p_max, c_v, c_t, tau, p_room = drawn(rng, CUFF, CUFF_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Pressure is in kPa, volume in mL."""
        p, tissue = (float(s) for s in x)
        giving = (1e9 * c_t * p / (1.0 + max(p, 0.0) / stiff) - tissue) / tau
        blown = 1e6 * q * 0.01 * float(u[0]) * (1.0 - 1e3 * p / p_max) - 1e9 * c_v * 0.01 * float(u[1]) * p
        whole = 1e-3 * p_room + p
        room = 1e6 * v_0 + tissue + 1e9 * c_e * (p + whole)
        return [(1e-3 * p_room * blown - whole * giving) / room, giving]

    for number, (name, stop) in enumerate((("first", 450.0), ("second", 360.0), ("third", 400.0))):
        pump = drawn_steps(rng, stop, 11.0, 8.0, 80.0, 0.5)
        if name == "third":
            pump = telegraph(rng, stop, 9.0, 12.0, 74.0, 0.5)
        valve = drawn_steps(rng, stop, 17.0, 18.0, 100.0, 0.5)
        run = pump
        if unplugged is not None and name == "first":
            run = between(pump, unplugged[0], unplugged[1], lambda v: 0.0 * v)
        t, x = integrated(rates, (0.0, 0.0), (run, valve), stop, 0.125)
        sensors = [
            Sensor("sleeve.pressure", "MPX kPa", "kPa", scaled(0, 1.0), 0.05, 0.5, 1.0, quantum),
            Sensor("sleeve.calf", "Dehnband (mL)", "mL", scaled(1, 1.0), 0.4, 0.5, 1.0, 0.1),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"driver_1.pump": (run, "%"), "driver_2.valve": (valve, "%")},
            loggers[number % len(loggers)],
            told={} if run is pump else {"driver_1.pump": pump},
        )
        write(folder / name, rng, made)


def cuff_null(folder: Path, rng: Rng) -> Truth:
    loggers = (
        Logger("min", zero=100.0, is_comma=True),
        Logger("s", zero=-7.5, is_comma=True, empty=0.03),
        Logger("ms", zero=2.5e5, is_comma=True, gap=(190.0, 221.0)),
    )
    _cuff(folder, rng, quantum=0.15, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, a coarse reading of the pressure, decimal commas, empty cells, a gap of 31 s, "
        "three loggers of min, s and ms",
        FINE,
    )


def cuff_tissue(folder: Path, rng: Rng) -> Truth:
    stiff = rng.uniform(9.0, 16.0)
    _cuff(folder, rng, stiff=stiff, loggers=(PLAIN, Logger("min", zero=6.0)))
    return Truth(
        f"tissue stiffens: it gives way to C_t p/(1 + p/{stiff:.2f} kPa) at last",
        PHYSICS,
        (
            "saturation",
            "saturating_gain",
            "hardening",
            "hardening_spring",
            "nonlinear_spring",
            "stiffening",
        ),
    )


def cuff_unplugged(folder: Path, rng: Rng) -> Truth:
    begin = 10.0 * round(rng.uniform(8.0, 28.0))
    _cuff(folder, rng, unplugged=(begin, begin + 70.0), loggers=(Logger("s", zero=33.0), Logger("ms"), PLAIN))
    return Truth(
        f"the pump stands still, {begin:g} s to {begin + 70.0:g} s of the first recording, and is said to run",
        SENSOR,
        ("input_fault",),
    )


# --- DC bus of knitting machines behind a choke, loads of constant power, FMI 3 Model Exchange; ms, V, A, W
BUS = OdeModel(
    "dc_bus",
    {
        "R": (0.25, "ohm"),
        "L": (2e-3, "H"),
        "C": (3e-3, "F"),
        "G": (0.02, "S"),
        "v_begin": (48.0, "V"),
    },
    {"source": "V", "power": "W"},
    {
        "i": ("A", "0.0", "(source - R*i - v)/L"),
        "v": ("V", "v_begin", "(i - G*v - power/fmax(v, 5.0))/C"),
    },
    {"bus": ("V", "v"), "choke": ("A", "i")},
    1e-4,
)
BUS_KNOWN = {"R": 0.05, "L": 0.06, "C": 0.06, "G": 0.1}


def _bus(
    folder: Path,
    rng: Rng,
    knee: float = np.inf,
    is_reversed: bool = False,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """The choke may saturate, its inductance is L/(1 + (i/knee)^2).

    The clamp may be the other way round in the second recording.
    """
    build3(BUS, folder, has_co_simulation=False)
    parts = programme("rectifier", ("source", "V")) + programme("machines", ("power", "W"))
    parts += with_numbers("rail", "dc_bus")
    wires = "  - rectifier.source -> rail.source\n  - machines.power -> rail.power\n"
    scenario(folder, "A bus of direct current", 2.4, 5e-4, 1e-3, parts, wires)
    data_sheet(folder, BUS, BUS_KNOWN)
    r, inductance, c, g, begin = drawn(rng, BUS, BUS_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        i, v = (float(s) for s in x)
        left = inductance / (1.0 + (i / knee) ** 2)
        return [(float(u[0]) - r * i - v) / left, (i - g * v - float(u[1]) / max(v, 5.0)) / c]

    for number, (name, stop) in enumerate((("first", 2.4), ("second", 2.0), ("third", 2.2))):
        source = drawn_steps(rng, stop, 0.06, 42.0, 54.0, 1e-3)
        if name == "third":
            source = stairs(rng, stop, 0.05, 42.5, 53.5, 3, 1e-3)
        power = drawn_steps(rng, stop, 0.09, 15.0, 380.0, 1e-3)
        source, power = later(source, 5e-4), later(power, 5e-4)
        t, x = integrated(rates, (0.0, begin), (source, power), stop, 2.5e-4)
        sign = -1.0 if is_reversed and name == "second" else 1.0
        sensors = [
            Sensor("rail.bus", "U_ZK", "V", scaled(1, 1.0), 0.08, 1e-3, noise_stated, 0.02, wild=wild),
            Sensor("rail.choke", "clamp A", "A", scaled(0, sign), 0.12, 1e-3, noise_stated, 0.02, wild=wild),
        ]
        programmes = {"rectifier.source": (source, "V"), "machines.power": (power, "W")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def bus_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=250.0), Logger("s", zero=-0.1, gap=(0.9, 1.02)), Logger("ms", zero=9.9e4))
    _bus(folder, rng, noise_stated=1.2, wild=0.008, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, wild readings, noise stated 1.2 times too large, a gap of 0.12 s, three "
        "loggers of ms and s",
        FINE,
    )


def bus_choke(folder: Path, rng: Rng) -> Truth:
    knee = rng.uniform(13.0, 19.0)
    _bus(folder, rng, knee=knee, loggers=(Logger("s", zero=3.0), Logger("ms")))
    return Truth(
        f"the choke saturates: L/(1 + (i/{knee:.2f} A)^2)",
        PHYSICS,
        ("saturation", "magnetic_saturation", "saturable_inductance", "inductance_of_current"),
    )


def bus_reversed(folder: Path, rng: Rng) -> Truth:
    _bus(folder, rng, is_reversed=True, loggers=(Logger("ms", zero=-15.0), Logger("s")))
    return Truth(
        "the clamp is the other way round in the second recording: current has the other sign",
        (*RECORDING, *SENSOR),
    )


# --- driver of an exosuit's motor (FMI 2, Model Exchange) and its heat sink (FMI 3, Co-Simulation); A, %, degC, V
DRIVER = OdeModel(
    "motor_driver",
    {
        "R_on": (0.06, "ohm"),
        "k_sw": (0.4, "W/A"),
        "G": (1.8, "W/K"),
        "C": (40.0, "J/K"),
        "T_begin": (297.15, "K"),
    },
    {"amperes": "A", "base": "K"},
    {"T_j": ("K", "T_begin", "(R_on*amperes*amperes + k_sw*amperes - G*(T_j - base))/C")},
    {"chip": ("K", "T_j"), "drop": ("V", "R_on*amperes"), "heat": ("W", "G*(T_j - base)")},
    0.5,
)
SINK = OdeModel(
    "heat_sink",
    {
        "C_s": (900.0, "J/K"),
        "h_0": (0.8, "W/K"),
        "h_fan": (1.9, "W/K"),
        "T_begin": (297.15, "K"),
    },
    {"heat": "W", "fan": "", "room": "K"},
    {"T_s": ("K", "T_begin", "(heat - (h_0 + h_fan*fan)*(T_s - room))/C_s")},
    {"metal": ("K", "T_s")},
    0.5,
)
DRIVER_KNOWN = {"R_on": 0.04, "k_sw": 0.08, "G": 0.06, "C": 0.06}
SINK_KNOWN = {"C_s": 0.05, "h_0": 0.06, "h_fan": 0.06}


def _driver(
    folder: Path,
    rng: Rng,
    warmer: float = 0.0,
    board: float = 0.0,
    loose: float | None = None,
    hold: float = 0.6,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Two FMUs; R_on may rise, R_on (1 + warmer (T_j - 298 K)); chips may lose board (T_j - room) W to the board.

    Loose is when [s] the thermocouple of the heat sink comes loose in the second recording: it then shows `hold` of
    what the metal is warmer than the room.
    """
    DRIVER.build(folder)
    build3(SINK, folder, has_exchange=False)
    data_sheet(folder, SINK, SINK_KNOWN)
    (folder / "numbers.yaml").rename(folder / "sink.yaml")
    data_sheet(folder, DRIVER, DRIVER_KNOWN)
    parts = (
        programme("suit", ("amperes", "A"))
        + programme("blower", ("fan", "'%'")).replace("0 '%'", "0 %")
        + programme("lab", ("room", "degC"))
        + with_numbers("bridge", "motor_driver")
        + with_numbers("fins", "heat_sink", "internal").replace("numbers.yaml", "sink.yaml")
    )
    wires = (
        "  - suit.amperes -> bridge.amperes\n  - blower.fan -> fins.fan\n  - lab.room -> fins.room\n"
        "  - bridge.heat -> fins.heat\n  - fins.metal -> bridge.base\n"
    )
    scenario(folder, "A motor driver and its heat sink", 4500.0, 1.5, 6, parts, wires)
    r_on, k_sw, g, c, begin = drawn(rng, DRIVER, DRIVER_KNOWN)
    c_s, h_0, h_fan, _ = drawn(rng, SINK, SINK_KNOWN)

    def resistance(x: Array) -> Array:
        return np.asarray(r_on * (1.0 + warmer * (x[..., 0] - 298.0)))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        chip, metal = (float(s) for s in x)
        amperes, room = float(u[0]), float(u[2]) + CELSIUS
        heat = g * (chip - metal)
        made = float(resistance(x)) * amperes**2 + k_sw * amperes
        cooled = (h_0 + h_fan * 0.01 * float(u[1])) * (metal - room)
        return [(made - heat - board * (chip - room)) / c, (heat - cooled) / c_s]

    for number, (name, stop) in enumerate((("first", 4500.0), ("second", 3600.0), ("third", 4020.0))):
        amperes = drawn_steps(rng, stop, 130.0, 4.0, 27.0, 6.0)
        if name == "third":
            amperes = telegraph(rng, stop, 110.0, 6.0, 25.0, 6.0)
        amperes = later(amperes, 3.0)
        fan = drawn_steps(rng, stop, 500.0, 5.0, 100.0, 6.0)
        room = ramped(rng, stop, 1200.0, 22.0, 26.0, 30.0)
        t, x = integrated(rates, (begin, begin), (amperes, fan, room), stop, 1.5)
        off = loose if loose is not None and name == "second" else np.inf

        def metal(t: Array, x: Array, u: Array, off: float = off) -> Array:
            air = u[:, 2]
            warm = x[:, 1] - CELSIUS
            return np.asarray(np.where(t >= off, air + hold * (warm - air), warm))

        sensors = [
            Sensor("bridge.chip", "NTC Modul", "degC", celsius(0), 0.3, 6.0, noise_stated, 0.1, wild=wild),
            Sensor(
                "bridge.drop",
                "U_on (mV)",
                "mV",
                lambda t, x, u: 1e3 * resistance(x) * u[:, 0],
                12.0,
                6.0,
                noise_stated,
                5.0,
                wild=wild,
            ),
            Sensor("fins.metal", "TC K 2", "degC", metal, 0.2, 12.0, noise_stated, 0.1, wild=wild),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"suit.amperes": (amperes, "A"), "blower.fan": (fan, "%"), "lab.room": (room, "degC")},
            loggers[number % len(loggers)],
            recorded=["lab.room"],
        )
        write(folder / name, rng, made)


def driver_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=-2.0, jitter=0.1), Logger("h", zero=13.0), Logger("s", gap=(1800.0, 2190.0)))
    _driver(folder, rng, noise_stated=1.25, wild=0.008, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, two FMUs, wild readings, noise stated 1.25 times too large, two rates, "
        "jitter, a gap of 6.5 min, three loggers of min, h and s",
        FINE,
    )


def driver_warm(folder: Path, rng: Rng) -> Truth:
    warmer = rng.uniform(4.5e-3, 7.5e-3)
    _driver(folder, rng, warmer=warmer, loggers=(PLAIN, Logger("min", zero=44.0)))
    return Truth(
        f"the resistance of the transistors rises: R_on (1 + {warmer:.5f}/K (T_j - 298 K))",
        PHYSICS,
        WARMER,
    )


def driver_two(folder: Path, rng: Rng) -> Truth:
    warmer, board = rng.uniform(4.5e-3, 7.5e-3), rng.uniform(0.2, 0.35)
    _driver(folder, rng, warmer=warmer, board=board, loggers=(Logger("h", zero=1.0), Logger("s", zero=600.0)))
    return Truth(
        f"the resistance of the transistors rises, R_on (1 + {warmer:.5f}/K (T_j - 298 K)), and they lose {board:.3f} "
        "W/K to the room through the board",
        PHYSICS,
        (*WARMER, *LEAKING, "heat_exchange"),
    )


def driver_loose(folder: Path, rng: Rng) -> Truth:
    off, hold = 60.0 * round(rng.uniform(18.0, 36.0)) + 1.0, rng.uniform(0.5, 0.7)
    _driver(folder, rng, loose=off, hold=hold, loggers=(Logger("min"), PLAIN, Logger("h")))
    return Truth(
        f"the thermocouple of the heat sink comes loose at {off:g} s of the second recording and then shows {hold:.2f} "
        "of what the metal is warmer than the room",
        SENSOR,
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    sewing_bar,
    tribo_null,
    blimp_lag,
    membrane_cake,
    plating_null,
    cuff_unplugged,
    bus_choke,
    driver_null,
    sewing_null,
    tribo_clipped,
    blimp_drag,
    membrane_clock,
    plating_gassing,
    cuff_null,
    bus_reversed,
    driver_warm,
    sewing_unit,
    tribo_stray,
    blimp_two,
    membrane_null,
    plating_other_run,
    cuff_tissue,
    bus_null,
    driver_loose,
    driver_two,
)
