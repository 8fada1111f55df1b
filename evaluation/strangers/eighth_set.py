"""Eighth set: a glucose clamp, a MEMS mirror, an engine's intake, a cold room, a lysimeter, a muffler, vacuum, a dye.

Written without a look at the library of laws, its proof or its thresholds, and without a diagnosis of any of its cases;
of what was reported on the earlier sets, the author had read the tables of verdicts and what was corrected since.
Truths are integrated by scipy from equations that stand here. How large an effect is, and how far the numbers are off,
is drawn; the deviations of the numbers are those that a parameter set states.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.strangers.fifth_set import FOUR, FOUR_SPLIT, integrated
from evaluation.strangers.first_set import FOLDERS, PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import between, bursts, data_sheet, scaled
from evaluation.strangers.lab import CELSIUS, SECONDS, Logger, Sensor, Steps, Written, celsius, drawn_steps, write
from evaluation.strangers.seventh_set import DEGREES, clocked
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.truth import FINE, OPEN, PHYSICS, RECORDING, SENSOR, Truth

#: Millimetres of mercury in a millibar; millimetres per hour in a metre per second.
MERCURY, PER_HOUR = 0.750062, 3.6e6


def second_clock(folder: Path, unit: str, zero: float) -> None:
    """The second table of a recording is from a logger with a clock of its own, in another unit, and says so."""
    file, table = folder / "recording.yaml", folder / "data_2.csv"
    keys = yaml.safe_load(file.read_text(encoding="utf-8"))
    old = keys["time"]
    lines = table.read_text(encoding="utf-8").splitlines()
    rows = [line.partition(",") for line in lines[1:]]
    factor = SECONDS[old["unit"]] / SECONDS[unit]
    heads = [f"clock_{unit},{lines[0].partition(',')[2]}"]
    heads += [f"{zero + factor * (float(t) - old['zero']):.10g},{rest}" for t, _, rest in rows]
    table.write_text("\n".join(heads) + "\n", encoding="utf-8")
    for entry in keys["channels"].values():
        if entry.get("table") == "data_2.csv":
            entry["time"] = {"column": f"clock_{unit}", "unit": unit, "zero": zero}
    file.write_text(yaml.safe_dump(keys, sort_keys=False, allow_unicode=True), encoding="utf-8")


def idle_column(folder: Path, header: str, values: Callable[[int], Array]) -> None:
    """A column at the end of the first table that the sidecar does not name."""
    table = folder / "data.csv"
    lines = table.read_text(encoding="utf-8").splitlines()
    more = [f"{v:.4g}" for v in values(len(lines) - 1)]
    table.write_text("\n".join(f"{a},{b}" for a, b in zip(lines, [header, *more])) + "\n", encoding="utf-8")


def tailed(rng: Rng, column: str, noise: float, share: float, quantum: float) -> Callable[[str, Array, Array], Array]:
    """Some readings of a column are wild by a long tail: Student's t of 1.5 degrees of freedom, times 6 deviations."""

    def spoil(name: str, t: Array, v: Array) -> Array:
        if name != column:
            return v
        wild = v + 6.0 * noise * rng.standard_t(1.5, len(v))
        return np.where(rng.random(len(v)) < share, np.round(wild / quantum) * quantum, v)

    return spoil


# --- glucose and insulin of an animal under infusions (Bergman 1979), FMI 3 Model Exchange, without units; min, h
CLAMP = OdeModel(
    "clamp",
    {
        "p1": (4.2e-4, ""),
        "p2": (6e-4, ""),
        "p3": (5e-9, ""),
        "n": (2.6e-3, ""),
        "V_glucose": (14.0, ""),
        "V_insulin": (10.0, ""),
        "basal_glucose": (5.2, ""),
        "basal_insulin": (9.0, ""),
        "glucose_begin": (5.2, ""),
    },
    {"dextrose": "", "insulin": ""},
    {
        "G": ("", "glucose_begin", "-p1*(G - basal_glucose) - X*G + dextrose/(60.0*V_glucose)"),
        "X": ("", "0.0", "-p2*X + p3*(I - basal_insulin)"),
        "I": ("", "basal_insulin", "-n*(I - basal_insulin) + insulin/(60.0*V_insulin)"),
    },
    {"glucose": ("", "G"), "plasma": ("", "I")},
    2.0,
)
CLAMP_KNOWN = {"p1": 0.06, "p2": 0.06, "p3": 0.06, "n": 0.05, "V_glucose": 0.03, "V_insulin": 0.04}


def _clamp(
    folder: Path,
    rng: Rng,
    renal: float = 0.0,
    threshold: float = 10.0,
    risen: float = 0.0,
    noise_stated: float | None = 1.0,
    zero: float = 0.0,
) -> None:
    """Kidneys may excrete glucose above a threshold [mmol/L], `renal` in 1/s; `risen` is what one start is above.

    Each day has a glucose of its own at the begin, which is stated; insulin is of an assay with a clock of its own.
    """
    build3(CLAMP, folder, has_co_simulation=False)
    stop = 36000.0
    parts = programme("pumps", ("dextrose", ""), ("insulin", "")) + with_numbers("animal", "clamp")
    wires = "  - pumps.dextrose -> animal.dextrose\n  - pumps.insulin -> animal.insulin\n"
    scenario(folder, "A glucose clamp", stop, 15, 30, parts, wires)
    data_sheet(folder, CLAMP, CLAMP_KNOWN)
    p1, p2, p3, n, v_glucose, v_insulin, basal, level, _ = drawn(rng, CLAMP, CLAMP_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        glucose, action, insulin = (float(s) for s in x)
        excreted = renal * max(0.0, glucose - threshold)
        return [
            -p1 * (glucose - basal) - action * glucose + float(u[0]) / (60.0 * v_glucose) - excreted,
            -p2 * action + p3 * (insulin - level),
            -n * (insulin - level) + float(u[1]) / (60.0 * v_insulin),
        ]

    for name in FOLDERS:
        dextrose = drawn_steps(rng, stop, 1800.0, 0.0, 9.0, 15.0)
        insulin = drawn_steps(rng, stop, 2700.0, 0.0, 110.0, 15.0)
        stated = float(f"{rng.uniform(4.6, 6.4):.2f}")
        begin = stated + (risen if name == "second" else 0.0)
        t, x = integrated(rates, (begin, 0.0, level), (dextrose, insulin), stop, 15.0)
        sensors = [
            Sensor("animal.glucose", "G_mmol_L", "1", scaled(0, 1.0), 0.12, 60.0, noise_stated, 0.05),
            Sensor("animal.plasma", "I_mU_L", "1", scaled(2, 1.0), 1.2, 300.0, noise_stated, 0.1),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"pumps.dextrose": (dextrose, ""), "pumps.insulin": (insulin, "")},
            Logger("min", zero=zero),
            sidecar={"components": {"animal": {"parameters": {"glucose_begin": stated}}}},
        )
        write(folder / name, rng, made)
        second_clock(folder / name, "h", float(round(rng.uniform(7.0, 10.0), 2)))


def clamp_null(folder: Path, rng: Rng) -> Truth:
    _clamp(folder, rng, noise_stated=None, zero=30.0)
    return Truth(
        "nothing; numbers off as stated, no units, noise is not stated, a start of its own each day, the assay's table "
        "has a clock of its own in hours",
        FINE,
    )


def clamp_renal(folder: Path, rng: Rng) -> Truth:
    renal, threshold = rng.uniform(3e-4, 4.5e-4), rng.uniform(8.5, 9.5)
    _clamp(folder, rng, renal=renal, threshold=threshold)
    return Truth(
        f"kidneys excrete glucose above {threshold:.2f} mmol/L, {renal:.3e} 1/s times the excess",
        PHYSICS,
        ("threshold", "overflow", "dead_zone", "one_sided_outflow"),
    )


def clamp_start(folder: Path, rng: Rng) -> Truth:
    risen = float(f"{rng.uniform(3.0, 4.5):.2f}")
    _clamp(folder, rng, risen=risen)
    return Truth(f"the second recording begins with {risen:.2f} mmol/L more than stated", (*RECORDING, *SENSOR))


# --- a torsional MEMS mirror with a comb drive and its amplifier, FMI 2 Model Exchange; deg, V, ms; two clocks
MIRROR = OdeModel(
    "mirror",
    {
        "w0": (2400.0, "rad/s"),
        "zeta": (0.045, ""),
        "gain": (3e-5, "rad/V^2"),
        "tau": (4e-4, "s"),
    },
    {"command": "V"},
    {
        "phi": ("rad", "0.0", "w"),
        "w": ("rad/s", "0.0", "w0*w0*(gain*a*a - phi) - 2.0*zeta*w0*w"),
        "a": ("V", "0.0", "(command - a)/tau"),
    },
    {"angle": ("rad", "phi"), "drive": ("V", "a")},
    2e-5,
)
MIRROR_KNOWN = {"w0": 0.03, "zeta": 0.08, "gain": 0.05, "tau": 0.08}


def _mirror(
    folder: Path,
    rng: Rng,
    gap: float = 0.0,
    fast: float = 0.0,
    noise_stated: float | None = 1.0,
    quantum: float = 0.01,
    wild: float = 0.0,
    zero: float = 0.0,
) -> None:
    """Damping may be that of a squeezed film whose gap closes at `gap` rad; the detector's clock may run fast."""
    MIRROR.build(folder)
    stop = 0.25
    parts = programme("generator", ("command", "V")) + with_numbers("mirror", "mirror")
    scenario(folder, "A scanning mirror", stop, 1e-4, 1e-4, parts, "  - generator.command -> mirror.command\n")
    data_sheet(folder, MIRROR, MIRROR_KNOWN)
    w0, zeta, gain, tau = drawn(rng, MIRROR, MIRROR_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        phi, w, a = (float(s) for s in x)
        film = (1.0 - phi / gap) ** -3 if gap else 1.0
        return [w, w0**2 * (gain * a * a - phi) - 2.0 * zeta * w0 * film * w, (float(u[0]) - a) / tau]

    for name in FOLDERS:
        command = drawn_steps(rng, stop, 8e-3, 5.0, 55.0, 1e-4)
        t, x = integrated(rates, (0.0, 0.0, 0.0), (command,), stop, 5e-5)
        angle = clocked(0, DEGREES, t, x, fast if name == "second" else 0.0)
        sensors = [
            Sensor("mirror.angle", "psd_deg", "deg", angle, 0.06, 1e-4, noise_stated, quantum),
            Sensor("mirror.drive", "U_drive", "V", scaled(2, 1.0), 0.3, 5e-4, noise_stated, 0.1),
        ]
        spoil = tailed(rng, "psd_deg", 0.06, wild, quantum) if wild else None
        made = Written(
            t, x, sensors, {"generator.command": (command, "V")}, Logger("ms", zero=zero, jitter=0.1), spoil=spoil
        )
        write(folder / name, rng, made)
        second_clock(folder / name, "s", float(round(rng.uniform(3.0, 60.0), 3)))


def mirror_null(folder: Path, rng: Rng) -> Truth:
    _mirror(folder, rng, noise_stated=1.5, quantum=0.1, wild=0.012, zero=-12.5)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.5 times too large, a long tail of wild readings, a coarse "
        "converter, jitter, two tables with clocks of their own",
        FINE,
    )


def mirror_film(folder: Path, rng: Rng) -> Truth:
    gap = rng.uniform(0.23, 0.28)
    _mirror(folder, rng, gap=gap)
    return Truth(
        f"damping of a squeezed film: divided by (1 - phi/{gap:.4f} rad)^3",
        PHYSICS,
        ("squeeze_film", "nonlinear_damping", "position_dependent_damping"),
    )


def mirror_clock(folder: Path, rng: Rng) -> Truth:
    fast = rng.uniform(0.003, 0.006)
    _mirror(folder, rng, fast=fast)
    return Truth(
        f"the clock of the detector's table runs {100 * fast:.2f} % fast in the second recording", (*RECORDING, *SENSOR)
    )


# --- intake manifold and crankshaft of an idling engine (Hendricks and Sorenson 1990), FMI 3; rpm, kPa
ENGINE = OdeModel(
    "engine",
    {
        "V_m": (2.4e-3, "m^3"),
        "V_d": (1.4e-3, "m^3"),
        "eta": (0.8, ""),
        "k_th": (0.06, "kg/s"),
        "p0": (1e5, "Pa"),
        "RT": (8.75e4, "J/kg"),
        "H": (9e5, "J/kg"),
        "J": (0.14, "kg*m^2"),
        "M0": (12.0, "N*m"),
        "b": (0.08, "N*m*s/rad"),
    },
    {"throttle": "", "load": "N*m"},
    {
        "p": (
            "Pa",
            "4.0e4",
            "RT/V_m*(k_th*throttle*(p > 0.5*p0 ? 2.0*sqrt(fmax(p/p0*(1.0 - p/p0), 1e-9)) : 1.0)"
            " - eta*V_d/(12.566370614359172*RT)*w*p)",
        ),
        "w": ("rad/s", "120.0", "(H*eta*V_d/(12.566370614359172*RT)*p - M0 - b*w - load)/J"),
    },
    {"pressure": ("Pa", "p"), "speed": ("rad/s", "w")},
    1e-3,
)
ENGINE_KNOWN = {"V_m": 0.06, "eta": 0.04, "k_th": 0.05, "H": 0.03, "J": 0.06, "M0": 0.08, "b": 0.08}


def _engine(
    folder: Path,
    rng: Rng,
    ram: float = 0.0,
    tuned: float = 180.0,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    logger: Logger = PLAIN,
    has_idle: bool = False,
) -> None:
    """Four runs; a tuned intake may fill the cylinders by a share `ram` more near `tuned` rad/s (within 22 rad/s).

    One run may state the throttle of another one; `has_idle` adds the voltage of the battery to the log.
    """
    build3(ENGINE, folder)
    stop = 60.0
    parts = programme("bench", ("throttle", ""), ("load", "N*m")) + with_numbers("engine", "engine")
    wires = "  - bench.throttle -> engine.throttle\n  - bench.load -> engine.load\n"
    scenario(folder, "Intake and crankshaft", stop, 0.02, 0.02, parts, wires)
    data_sheet(folder, ENGINE, ENGINE_KNOWN)
    v_m, v_d, eta, k_th, p0, rt, heat, inertia, m0, b = drawn(rng, ENGINE, ENGINE_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Pressure is in kPa."""
        p, w = 1e3 * float(x[0]), float(x[1])
        share = p / p0
        inflow = k_th * float(u[0]) * (2.0 * np.sqrt(max(share * (1.0 - share), 1e-9)) if share > 0.5 else 1.0)
        filled = eta * (1.0 + ram * np.exp(-(((w - tuned) / 22.0) ** 2)))
        drawn_in = filled * v_d / (4.0 * np.pi * rt) * p
        return [1e-3 * rt / v_m * (inflow - drawn_in * w), (heat * drawn_in - m0 - b * w - float(u[1])) / inertia]

    other = drawn_steps(rng, stop, 2.5, 0.06, 0.16, 0.02)
    for name in FOUR:
        throttle = drawn_steps(rng, stop, 2.5, 0.06, 0.16, 0.02)
        load = drawn_steps(rng, stop, 3.5, 4.0, 22.0, 0.02)
        t, x = integrated(rates, (40.0, 120.0), (throttle, load), stop, 0.01)
        sensors = [
            Sensor("engine.pressure", "MAP_kPa", "kPa", scaled(0, 1.0), 0.3, 0.02, noise_stated, 0.1),
            Sensor("engine.speed", "n_rpm", "rpm", scaled(1, 30.0 / np.pi), 8.0, 0.04, noise_stated, 1.0),
        ]
        told = {"bench.throttle": other} if is_other and name == "second" else {}
        programmes = {"bench.throttle": (throttle, ""), "bench.load": (load, "N*m")}
        write(folder / name, rng, Written(t, x, sensors, programmes, logger, told=told))
        if has_idle:
            idle_column(folder / name, "U_batt", lambda n: np.asarray(13.8 + 0.05 * rng.standard_normal(n)))


def engine_null(folder: Path, rng: Rng) -> Truth:
    logger = Logger("ms", zero=60000.0, empty=0.03, gap=(22.0, 24.5))
    _engine(folder, rng, noise_stated=1.7, logger=logger, has_idle=True)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.7 times too large, empty cells, a gap of 2.5 s, a column that "
        "nobody needs, the clock begins at 60000 ms",
        FINE,
        **FOUR_SPLIT,
    )


def engine_ram(folder: Path, rng: Rng) -> Truth:
    ram, tuned = rng.uniform(0.08, 0.13), rng.uniform(150.0, 180.0)
    _engine(folder, rng, ram=ram, tuned=tuned)
    return Truth(
        f"a tuned intake fills the cylinders by up to {100 * ram:.2f} % more near {tuned:.1f} rad/s, within 22 rad/s",
        PHYSICS,
        **FOUR_SPLIT,
    )


def engine_other_run(folder: Path, rng: Rng) -> Truth:
    _engine(folder, rng, is_other=True)
    return Truth("the second recording states the throttle of another run", RECORDING, **FOUR_SPLIT)


# --- a cold room: evaporator, air and goods, FMI 2 Co-Simulation; degC, h; cooling and door are columns of the log
COLDROOM = OdeModel(
    "coldroom",
    {
        "C_e": (3e4, "J/K"),
        "C_a": (1.2e5, "J/K"),
        "C_g": (1.2e6, "J/K"),
        "UA_e": (130.0, "W/K"),
        "U_g": (45.0, "W/K"),
        "U_w": (26.0, "W/K"),
        "T_hall": (293.15, "K"),
        "T_begin": (278.15, "K"),
        "T_goods": (279.15, "K"),
    },
    {"cooling": "W", "door": "W/K"},
    {
        "T_e": ("K", "T_begin", "(UA_e*(T_a - T_e) - cooling)/C_e"),
        "T_a": ("K", "T_begin", "((U_w + door)*(T_hall - T_a) - UA_e*(T_a - T_e) - U_g*(T_a - T_g))/C_a"),
        "T_g": ("K", "T_goods", "U_g*(T_a - T_g)/C_g"),
    },
    {"evaporator": ("K", "T_e"), "air": ("K", "T_a"), "goods": ("K", "T_g")},
    2.0,
)
COLDROOM_KNOWN = {"C_e": 0.06, "C_a": 0.08, "C_g": 0.06, "UA_e": 0.05, "U_g": 0.06, "U_w": 0.05}


def _coldroom(
    folder: Path,
    rng: Rng,
    frost: float = 0.0,
    is_exchanged: bool = False,
    strayed: float = 0.0,
    noise_stated: float | None = 1.0,
    logger: Logger | None = None,
) -> None:
    """Below 0 degC frost may grow on the evaporator and insulate it: UA_e/(1 + m), m' = frost (T_a - T_e) [1/(K*s)].

    Each day has goods of its own temperature, which is stated, and is off by a deviation of `strayed` K that is too.
    """
    COLDROOM.build(folder)
    stop = 86400.0
    parts = programme("plant", ("cooling", "W"), ("door", "W/K")) + with_numbers("room", "coldroom", "internal")
    wires = "  - plant.cooling -> room.cooling\n  - plant.door -> room.door\n"
    scenario(folder, "A cold room", stop, 30, 60, parts, wires)
    data_sheet(folder, COLDROOM, COLDROOM_KNOWN)
    c_e, c_a, c_g, ua, u_g, u_w, hall, begin, _ = drawn(rng, COLDROOM, COLDROOM_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        coil, air, goods, ice = (float(s) for s in x)
        taken = ua / (1.0 + ice) * (air - coil)
        stored = u_g * (air - goods)
        return [
            (taken - float(u[0])) / c_e,
            ((u_w + float(u[1])) * (hall - air) - taken - stored) / c_a,
            stored / c_g,
            frost * max(0.0, air - coil) if coil < CELSIUS else 0.0,
        ]

    for name in FOLDERS:
        cooling = drawn_steps(rng, stop, 3600.0, 100.0, 1500.0, 60.0)
        door = drawn_steps(rng, stop, 4500.0, 0.0, 35.0, 60.0)
        stated = float(f"{rng.uniform(277.0, 283.0):.2f}")
        goods = stated + strayed * float(rng.normal())
        t, x = integrated(rates, (begin, begin, goods, 0.0), (cooling, door), stop, 30.0)
        one, two = (2, 1) if is_exchanged and name == "second" else (1, 2)
        sensors = [
            Sensor("room.evaporator", "T_evap", "degC", celsius(0), 0.3, 60.0, noise_stated, 0.1),
            Sensor("room.air", "T_air", "degC", celsius(one), 0.2, 60.0, noise_stated, 0.1),
            Sensor("room.goods", "T_core", "degC", celsius(two), 0.12, 60.0, noise_stated, 0.05),
        ]
        sidecar: dict[str, Any] = {"components": {"room": {"parameters": {"T_goods": f"{stated:.2f} K"}}}}
        if strayed:
            sidecar["uncertain"] = {"room.T_goods": f"{strayed:g} K"}
        made = Written(
            t,
            x,
            sensors,
            {"plant.cooling": (cooling, "W"), "plant.door": (door, "W/K")},
            logger or Logger("min"),
            recorded=["plant.cooling", "plant.door"],
            sidecar=sidecar,
        )
        write(folder / name, rng, made)


def coldroom_null(folder: Path, rng: Rng) -> Truth:
    _coldroom(folder, rng, strayed=0.8, noise_stated=None, logger=Logger("h", zero=6.5, is_comma=True))
    return Truth(
        "nothing; numbers off as stated, noise is not stated, decimal commas, hours from 6.5 h, goods of each day "
        "begin 0.8 K (deviation) from what is stated, which is stated too, Co-Simulation",
        FINE,
    )


def coldroom_frost(folder: Path, rng: Rng) -> Truth:
    frost = rng.uniform(7.5e-7, 1.1e-6)
    _coldroom(folder, rng, frost=frost)
    return Truth(
        f"frost grows on the evaporator below 0 degC and divides UA_e by 1 + m, m' = {frost:.3e} (T_a - T_e) 1/(K s)",
        PHYSICS,
        ("fouling", "ageing", "degradation", "drift_of_parameter"),
    )


def coldroom_exchanged(folder: Path, rng: Rng) -> Truth:
    _coldroom(folder, rng, is_exchanged=True)
    return Truth("the thermometers of air and goods are exchanged, in the second recording", RECORDING)


# --- a lysimeter under a sprinkler: root zone and subsoil, FMI 2 Model Exchange; mm, mm/h, h; two clocks
LYSIMETER = OdeModel(
    "lysimeter",
    {
        "tau1": (1.1e5, "s"),
        "tau2": (1.6e5, "s"),
        "crop": (0.9, ""),
        "depth": (0.3, "m"),
        "S1_begin": (0.03, "m"),
        "S2_begin": (0.04, "m"),
    },
    {"sprinkler": "m/s", "demand": "m/s"},
    {
        "S1": ("m", "S1_begin", "sprinkler - crop*demand - S1/tau1"),
        "S2": ("m", "S2_begin", "S1/tau1 - S2/tau2"),
    },
    {"store": ("m", "S1 + S2"), "moisture": ("", "S1/depth"), "drainage": ("m/s", "S2/tau2")},
    60.0,
)
LYSIMETER_KNOWN = {"tau1": 0.08, "tau2": 0.06, "crop": 0.06, "depth": 0.03}


def _lysimeter(
    folder: Path,
    rng: Rng,
    power: float = 1.0,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    zero: float = 0.0,
) -> None:
    """The root zone may drain by a power law (Brooks and Corey): S1/tau1 (S1/0.04 m)^(power - 1).

    The programme of the sprinkler may be the scenario's alone, which was played in no recording.
    """
    LYSIMETER.build(folder)
    stop = 1.728e6

    def watered() -> Steps:
        return bursts(rng, stop, 5.5e4, 2.4e4, 1.0, 5.0, 1200.0)

    written, real = watered(), watered()
    sky = programme("weather", ("demand", "mm/h"))
    parts = programme("pump", ("sprinkler", "mm/h"))
    if is_other:
        points = ", ".join(f"[{t:.10g} s, {v:.10g} mm/h]" for t, v in zip(written.times, written.levels))
        parts = f"  pump:\n    kind: programme\n    outputs:\n      sprinkler: {{unit: mm/h, points: [{points}]}}\n"
    parts += sky + with_numbers("soil", "lysimeter")
    wires = "  - pump.sprinkler -> soil.sprinkler\n  - weather.demand -> soil.demand\n"
    scenario(folder, "A weighing lysimeter", stop, 600, 1200, parts, wires)
    data_sheet(folder, LYSIMETER, LYSIMETER_KNOWN)
    tau1, tau2, crop, depth, begin1, begin2 = drawn(rng, LYSIMETER, LYSIMETER_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Stores are in mm."""
        root, sub = float(x[0]), float(x[1])
        down = root / tau1 * (max(root, 0.0) / 40.0) ** (power - 1.0)
        return [(float(u[0]) - crop * float(u[1])) / 3600.0 - down, down - sub / tau2]

    for name in FOLDERS:
        sprinkler = real if is_other else watered()
        demand = drawn_steps(rng, stop, 2.2e4, 0.0, 0.45, 1200.0)
        t, x = integrated(rates, (1e3 * begin1, 1e3 * begin2), (sprinkler, demand), stop, 600.0)

        def store(t: Array, x: Array, u: Array) -> Array:
            return np.asarray(x[:, 0] + x[:, 1])

        sensors = [
            Sensor("soil.store", "balance_mm", "mm", store, 0.4, 1200.0, noise_stated, 0.1, colour),
            Sensor("soil.moisture", "tdr", "1", scaled(0, 1e-3 / depth), 3e-3, 1200.0, noise_stated, 1e-3),
            Sensor("soil.drainage", "q_mm_h", "mm/h", scaled(1, 3600.0 / tau2), 0.02, 3600.0, noise_stated, 0.01),
        ]
        programmes = {} if is_other else {"pump.sprinkler": (sprinkler, "mm/h")}
        programmes["weather.demand"] = (demand, "mm/h")
        write(folder / name, rng, Written(t, x, sensors, programmes, Logger("h", zero=zero)))
        second_clock(folder / name, "min", float(round(rng.uniform(0.0, 1440.0))))


def lysimeter_null(folder: Path, rng: Rng) -> Truth:
    _lysimeter(folder, rng, noise_stated=0.65, zero=2160.0)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.5 times too small, the clock begins at 2160 h and that of the "
        "drainage's table, in minutes, elsewhere",
        (*FINE, *OPEN),
    )


def lysimeter_seepage(folder: Path, rng: Rng) -> Truth:
    power = rng.uniform(1.5, 2.0)
    _lysimeter(folder, rng, power=power)
    return Truth(
        f"the root zone drains with the power {power:.3f} of its water (Brooks and Corey), as stated at 40 mm", PHYSICS
    )


def lysimeter_programme(folder: Path, rng: Rng) -> Truth:
    _lysimeter(folder, rng, is_other=True)
    return Truth(
        "the scenario states a programme of the sprinkler that was played in none of the recordings; all have one "
        "other",
        (*RECORDING, *SENSOR),
    )


# --- a muffler of two chambers and two necks behind a piston, FMI 3 Model Exchange; Pa, m/s, ms
MUFFLER = OdeModel(
    "muffler",
    {
        "rho": (1.2, "kg/m^3"),
        "c": (343.0, "m/s"),
        "V1": (4e-3, "m^3"),
        "V2": (3e-3, "m^3"),
        "S1": (8e-4, "m^2"),
        "S2": (8e-4, "m^2"),
        "l1": (0.08, "m"),
        "l2": (0.1, "m"),
        "r1": (4.0, "Pa*s/m"),
        "r2": (5.0, "Pa*s/m"),
        "S_piston": (5e-3, "m^2"),
    },
    {"piston": "m/s"},
    {
        "p1": ("Pa", "0.0", "rho*c*c/V1*(S_piston*piston - S1*v1)"),
        "v1": ("m/s", "0.0", "(p1 - p2 - r1*v1)/(rho*l1)"),
        "p2": ("Pa", "0.0", "rho*c*c/V2*(S1*v1 - S2*v2)"),
        "v2": ("m/s", "0.0", "(p2 - r2*v2)/(rho*l2)"),
    },
    {"first": ("Pa", "p1"), "second": ("Pa", "p2"), "outlet": ("m/s", "v2")},
    5e-5,
)
MUFFLER_KNOWN = {"V1": 0.04, "V2": 0.04, "l1": 0.06, "l2": 0.06, "r1": 0.08, "r2": 0.08}


def _muffler(
    folder: Path,
    rng: Rng,
    jet: float = 0.0,
    panel: float = 0.0,
    off: tuple[float, float] | None = None,
    noise_stated: float | None = 1.0,
    logger: Logger | None = None,
) -> None:
    """Necks may lose `jet` times the dynamic pressure of their flow; a panel of the second chamber may give way.

    The panel adds a share `panel` to the compliance of the air behind it, up to its resonance at 190 Hz; `off` is begin
    and end [s] of a loose plug of the second microphone.
    """
    build3(MUFFLER, folder, has_co_simulation=False)
    stop = 0.8
    parts = programme("shaker", ("piston", "m/s")) + with_numbers("muffler", "muffler")
    scenario(folder, "A muffler", stop, 2.5e-4, 2.5e-4, parts, "  - shaker.piston -> muffler.piston\n")
    data_sheet(folder, MUFFLER, MUFFLER_KNOWN)
    rho, c, v_one, v_two, s1, s2, l1, l2, r1, r2, area = drawn(rng, MUFFLER, MUFFLER_KNOWN)
    stiff, omega = rho * c * c, 2.0 * np.pi * 190.0

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """The panel's course is in litres."""
        p1, v1, p2, v2, moved, speed = (float(s) for s in x)
        given = omega**2 * (1e3 * panel * v_two / stiff * p2 - moved) - 0.06 * omega * speed if panel else 0.0
        return [
            stiff / v_one * (area * float(u[0]) - s1 * v1),
            (p1 - p2 - r1 * v1 - 0.5 * rho * jet * abs(v1) * v1) / (rho * l1),
            stiff / v_two * (s1 * v1 - s2 * v2 - 1e-3 * speed),
            (p2 - r2 * v2 - 0.5 * rho * jet * abs(v2) * v2) / (rho * l2),
            speed,
            given,
        ]

    for name in FOLDERS:
        piston = drawn_steps(rng, stop, 8e-3, -0.4, 0.4, 2.5e-4)
        t, x = integrated(rates, [0.0] * 6, (piston,), stop, 1.25e-4)
        sensors = [
            Sensor("muffler.first", "mic1_Pa", "Pa", scaled(0, 1.0), 2.5, 2.5e-4, noise_stated, 0.1),
            Sensor("muffler.second", "mic2_Pa", "Pa", scaled(2, 1.0), 2.5, 2.5e-4, noise_stated, 0.1),
            Sensor("muffler.outlet", "hotwire", "m/s", scaled(3, 1.0), 0.06, 5e-4, noise_stated, 0.01),
        ]
        hum = 0.3 * rng.standard_normal(round(stop / 2.5e-4) + 1)

        def spoil(column: str, t: Array, v: Array, name: str = name, hum: Array = hum) -> Array:
            if off is None or name != "second" or column != "mic2_Pa":
                return v
            return np.where((t >= off[0]) & (t < off[1]), np.round(hum[: len(t)], 1), v)

        made = Written(t, x, sensors, {"shaker.piston": (piston, "m/s")}, logger or Logger("ms"), spoil=spoil)
        write(folder / name, rng, made)


def muffler_jet(folder: Path, rng: Rng) -> Truth:
    jet = rng.uniform(0.6, 1.0)
    _muffler(folder, rng, jet=jet)
    return Truth(
        f"flow separates at both necks, which lose {jet:.3f} times its dynamic pressure",
        PHYSICS,
        ("quadratic_drag", "quadratic_damping", "turbulent_loss", "quadratic_loss", "minor_loss"),
    )


def muffler_two(folder: Path, rng: Rng) -> Truth:
    jet, panel = rng.uniform(0.4, 0.65), rng.uniform(0.05, 0.08)
    _muffler(folder, rng, jet=jet, panel=panel)
    return Truth(
        f"flow separates at both necks, which lose {jet:.3f} times its dynamic pressure, and a panel of the second "
        f"chamber, resonant at 190 Hz, adds {100 * panel:.1f} % to the compliance of its air",
        PHYSICS,
        (
            "quadratic_drag",
            "quadratic_damping",
            "turbulent_loss",
            "quadratic_loss",
            "minor_loss",
            "second_mass",
            "hidden_mass",
            "hidden_oscillator",
        ),
    )


def muffler_plug(folder: Path, rng: Rng) -> Truth:
    begin = 0.01 * round(rng.uniform(20.0, 50.0))
    _muffler(folder, rng, off=(begin, begin + 0.1))
    return Truth(
        f"the plug of the second microphone is loose from {begin:.2f} s to {begin + 0.1:.2f} s of the second "
        "recording: it shows 0 Pa and a little noise",
        SENSOR,
    )


# --- a vacuum chamber (FMI 2, Model Exchange) and its pump (FMI 2, Co-Simulation); mbar, mbar L/s; two clocks
CHAMBER = OdeModel(
    "chamber",
    {"V": (0.16, "m^3"), "C": (0.05, "m^3/s")},
    {"gas": "Pa*m^3/s", "behind": "Pa"},
    {"p": ("Pa", "2.0", "(gas - C*(p - behind))/V")},
    {"pressure": ("Pa", "p"), "flow": ("Pa*m^3/s", "C*(p - behind)")},
    0.01,
)
PUMP = OdeModel(
    "pump",
    {"V": (0.08, "m^3"), "S": (0.09, "m^3/s"), "ultimate": (0.5, "Pa"), "tau": (2.5, "s")},
    {"flow": "Pa*m^3/s", "speed": ""},
    {
        "p": ("Pa", "2.0", "(flow - S*turning*(p - ultimate))/V"),
        "turning": ("", "1.0", "(speed - turning)/tau"),
    },
    {"pressure": ("Pa", "p")},
    5e-3,
)
CHAMBER_KNOWN, PUMP_KNOWN = {"V": 0.04, "C": 0.06}, {"V": 0.06, "S": 0.05, "tau": 0.08}


def _vacuum(
    folder: Path,
    rng: Rng,
    viscous: float = 0.0,
    in_mercury: bool = False,
    noise_stated: float | None = 1.0,
    logger: Logger = PLAIN,
) -> None:
    """Two FMUs; conductance may rise with the mean pressure, C (1 + viscous (p1 + p2)/2), `viscous` in 1/Pa."""
    stop = 44.0
    CHAMBER.build(folder)
    PUMP.build(folder)
    data_sheet(folder, PUMP, PUMP_KNOWN)
    (folder / "numbers.yaml").rename(folder / "pump.yaml")
    data_sheet(folder, CHAMBER, CHAMBER_KNOWN)
    parts = (
        programme("controller", ("gas", "mbar*L/s"))
        + programme("inverter", ("speed", ""))
        + with_numbers("chamber", "chamber")
        + with_numbers("pump", "pump", "internal").replace("numbers.yaml", "pump.yaml")
    )
    wires = (
        "  - controller.gas -> chamber.gas\n  - inverter.speed -> pump.speed\n"
        "  - chamber.flow -> pump.flow\n  - pump.pressure -> chamber.behind\n"
    )
    scenario(folder, "A vacuum chamber", stop, 0.02, 0.02, parts, wires)
    v_one, conductance = drawn(rng, CHAMBER, CHAMBER_KNOWN)
    v_two, s, ultimate, tau = drawn(rng, PUMP, PUMP_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        p1, p2, turning = (float(s) for s in x)
        flow = conductance * (1.0 + 0.5 * viscous * (p1 + p2)) * (p1 - p2)
        return [
            (0.1 * float(u[0]) - flow) / v_one,
            (flow - s * turning * (p2 - ultimate)) / v_two,
            (float(u[1]) - turning) / tau,
        ]

    for name in FOUR:
        gas = drawn_steps(rng, stop, 4.0, 0.0, 20.0, 0.04)
        speed = drawn_steps(rng, stop, 6.0, 0.5, 1.0, 0.04)
        t, x = integrated(rates, (2.0, 2.0, 1.0), (gas, speed), stop, 0.02)
        factor = MERCURY if in_mercury and name == "second" else 1.0
        sensors = [
            Sensor("chamber.pressure", "p_mbar", "mbar", scaled(0, 0.01 * factor), 4e-3, 0.04, noise_stated, 1e-3),
            Sensor("pump.pressure", "pirani", "mbar", scaled(1, 0.01), 4e-3, 0.2, noise_stated, 1e-3),
        ]
        made = Written(t, x, sensors, {"controller.gas": (gas, "mbar*L/s"), "inverter.speed": (speed, "")}, logger)
        write(folder / name, rng, made)
        second_clock(folder / name, "min", float(round(rng.uniform(0.0, 50.0), 2)))


def vacuum_null(folder: Path, rng: Rng) -> Truth:
    _vacuum(folder, rng, noise_stated=1.4, logger=Logger("s", zero=-10.0, gap=(20.0, 22.5)))
    return Truth(
        "nothing; numbers off as stated, two FMUs, noise stated 1.4 times too large, a gap of 2.5 s, two tables with "
        "clocks of their own, one in minutes",
        FINE,
        **FOUR_SPLIT,
    )


def vacuum_viscous(folder: Path, rng: Rng) -> Truth:
    viscous = rng.uniform(0.01, 0.016)
    _vacuum(folder, rng, viscous=viscous)
    return Truth(
        f"flow of the pipe turns viscous: C (1 + {viscous:.5f} 1/Pa (p1 + p2)/2)",
        PHYSICS,
        ("quadratic_leak", "orifice", "quadratic_outflow"),
        **FOUR_SPLIT,
    )


def vacuum_torr(folder: Path, rng: Rng) -> Truth:
    _vacuum(folder, rng, in_mercury=True)
    return Truth(
        "the chamber's gauge is logged in Torr and stated as mbar, in the second recording",
        (*RECORDING, *SENSOR),
        **FOUR_SPLIT,
    )


# --- a dye that bleaches in a lit cell, pumped round a reservoir, FMI 3, both interfaces; mg/L, mL/min, min
DYE = OdeModel(
    "dye",
    {
        "V_cell": (1e-4, "m^3"),
        "V_store": (5e-4, "m^3"),
        "loop": (5e-6, "m^3/s"),
        "k": (8e-6, "m^2/J"),
        "feed_dye": (0.02, "kg/m^3"),
        "begin": (0.01, "kg/m^3"),
    },
    {"light": "W/m^2", "feed": "m^3/s"},
    {
        "c_cell": ("kg/m^3", "begin", "loop/V_cell*(c_store - c_cell) - k*light*c_cell"),
        "c_store": ("kg/m^3", "begin", "(loop*(c_cell - c_store) + feed*(feed_dye - c_store))/V_store"),
    },
    {"cell": ("kg/m^3", "c_cell"), "store": ("kg/m^3", "c_store")},
    0.5,
)
DYE_KNOWN = {"V_cell": 0.04, "V_store": 0.03, "loop": 0.04, "k": 0.08}


def _dye(
    folder: Path,
    rng: Rng,
    shade: float = 0.0,
    recovery: float = 0.0,
    stronger: tuple[float, float, float] | None = None,
    every: float = 6.0,
    is_recorded: bool = False,
    noise_stated: float | None = 1.0,
    logger: Logger | None = None,
) -> None:
    """Light may fade within the cell by Beer and Lambert, `shade` m^3/kg being depth times absorptivity.

    The coefficient is what it is stated to be at 10 mg/L.

    Bleached dye may come back in the dark and in the light, `recovery` in 1/s; `stronger` is begin [s], end [s] and
    factor of the lamp in the second recording.
    """
    build3(DYE, folder)
    stop = 7200.0
    parts = (
        programme("lamp", ("light", "W/m^2")) + programme("dosing", ("feed", "mL/min")) + with_numbers("loop", "dye")
    )
    wires = "  - lamp.light -> loop.light\n  - dosing.feed -> loop.feed\n"
    scenario(folder, "Bleaching of a dye", stop, 3, 3, parts, wires)
    data_sheet(folder, DYE, DYE_KNOWN)
    v_cell, v_store, loop, k, feed_dye, begin = drawn(rng, DYE, DYE_KNOWN)

    def lit(content: float) -> float:
        """Mean over the depth of the cell of the light that enters it, as a share."""
        depth = 1e-3 * shade * content
        return float(-np.expm1(-depth) / depth) if depth > 1e-9 else 1.0

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Contents are in mg/L."""
        cell, store, pale_cell, pale_store = (float(s) for s in x)
        light, feed = float(u[0]), float(u[1]) / 6e7
        bleached = k * light * lit(cell) / lit(10.0) * cell
        back, back_store = recovery * pale_cell, recovery * pale_store
        return [
            loop / v_cell * (store - cell) - bleached + back,
            (loop * (cell - store) + feed * (1e3 * feed_dye - store)) / v_store + back_store,
            loop / v_cell * (pale_store - pale_cell) + bleached - back,
            (loop * (pale_cell - pale_store) - feed * pale_store) / v_store - back_store,
        ]

    for name in FOLDERS:
        stated = drawn_steps(rng, stop, 420.0, 0.0, 2000.0, 3.0)
        light = stated
        if stronger is not None and name == "second":
            light = between(stated, stronger[0], stronger[1], lambda v: stronger[2] * v)
        feed = drawn_steps(rng, stop, 600.0, 3.0, 120.0, 3.0)
        t, x = integrated(rates, (1e3 * begin, 1e3 * begin, 0.0, 0.0), (light, feed), stop, 3.0)
        sensors = [
            Sensor("loop.cell", "c_cell", "mg/L", scaled(0, 1.0), 0.12, every, noise_stated, 0.02),
            Sensor("loop.store", "c_store", "mg/L", scaled(1, 1.0), 0.1, every, noise_stated, 0.02),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"lamp.light": (light, "W/m^2"), "dosing.feed": (feed, "mL/min")},
            logger or Logger("min"),
            recorded=["lamp.light", "dosing.feed"] if is_recorded else [],
            told={} if light is stated else {"lamp.light": stated},
        )
        write(folder / name, rng, made)


def dye_null(folder: Path, rng: Rng) -> Truth:
    _dye(folder, rng, every=15.0, is_recorded=True, noise_stated=None, logger=Logger("min", zero=12.0, is_comma=True))
    return Truth(
        "nothing; numbers off as stated, noise is not stated, decimal commas, minutes from 12 min; inputs change on a "
        "grid of 3 s and are logged each 15 s",
        FINE,
    )


def dye_shade(folder: Path, rng: Rng) -> Truth:
    shade = rng.uniform(140.0, 220.0)
    _dye(folder, rng, shade=shade)
    return Truth(
        f"light fades within the cell by Beer and Lambert: (1 - exp(-a c))/(a c) of it acts, a = {shade:.1f} m^3/kg, "
        "as stated at 10 mg/L",
        PHYSICS,
        ("saturation", "michaelis_menten", "reaction_order"),
    )


def dye_two(folder: Path, rng: Rng) -> Truth:
    shade, recovery = rng.uniform(110.0, 170.0), rng.uniform(3e-4, 5e-4)
    _dye(folder, rng, shade=shade, recovery=recovery)
    return Truth(
        f"light fades within the cell by Beer and Lambert: (1 - exp(-a c))/(a c) of it acts, a = {shade:.1f} m^3/kg, "
        "as stated at 10 mg/L; "
        f"bleached dye comes back, {recovery:.3e} 1/s",
        PHYSICS,
        ("saturation", "michaelis_menten", "reaction_order", "reverse_reaction"),
    )


def dye_lamp(folder: Path, rng: Rng) -> Truth:
    begin, factor = 60.0 * round(rng.uniform(30.0, 60.0)), rng.uniform(1.2, 1.3)
    _dye(folder, rng, stronger=(begin, begin + 2100.0, factor))
    return Truth(
        f"the light was {factor:.3f} times what is stated, {begin / 60.0:g} min to {begin / 60.0 + 35.0:g} min of the "
        "second recording",
        SENSOR,
        ("input_fault",),
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    clamp_null,
    mirror_film,
    engine_other_run,
    coldroom_frost,
    lysimeter_null,
    muffler_plug,
    vacuum_viscous,
    dye_two,
    clamp_renal,
    mirror_clock,
    engine_null,
    coldroom_exchanged,
    lysimeter_seepage,
    muffler_jet,
    vacuum_null,
    dye_shade,
    clamp_start,
    mirror_null,
    engine_ram,
    coldroom_null,
    lysimeter_programme,
    muffler_two,
    vacuum_torr,
    dye_null,
    dye_lamp,
)
