"""Ninth set: an accumulator, a twisted thread, a glove, a bale of wool, a flywheel, an elastomer, a drone, a basin.

Written without a look at the library of laws, its proof, its tests or its thresholds, without a diagnosis of any of its
cases and without what was reported on the earlier sets. Truths are integrated by scipy from equations that stand here.
How large an effect is, and how far the numbers are off, is drawn; the deviations of the numbers are those that a
parameter set states.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.strangers.eighth_set import second_clock
from evaluation.strangers.fifth_set import FOUR, FOUR_SPLIT, integrated
from evaluation.strangers.first_set import FOLDERS, PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import between, data_sheet, scaled
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Steps, Written, celsius, drawn_steps, write
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth

#: Revolutions per minute in a radian per second.
RPM = 30.0 / np.pi


def later(
    state: int, factor: float, times: Array, states: Array, ahead: float
) -> Callable[[Array, Array, Array], Array]:
    """Reading of a state by a logger whose clock is `ahead` s: what it calls t happened that much earlier."""
    return lambda t, x, u: np.asarray(factor * np.interp(t - ahead, times, states[:, state]))


# --- a hydraulic accumulator with a piston, between a pump and a throttle, FMI 2 Model Exchange; bar, mm, L/min
ACCUMULATOR = OdeModel(
    "accumulator",
    {
        "V_gas": (4e-3, "m^3"),
        "p_charge": (6e6, "Pa"),
        "C_hose": (2e-11, "m^3/Pa"),
        "R_neck": (4e9, "Pa*s/m^3"),
        "Q_rated": (2.6e-4, "m^3/s"),
        "p_rated": (1e7, "Pa"),
        "area": (0.012, "m^2"),
        "oil_begin": (1.6e-3, "m^3"),
    },
    {"pump": "m^3/s", "opening": ""},
    {
        "p": (
            "Pa",
            "p_charge*V_gas/(V_gas - oil_begin)",
            "(pump - Q_rated*opening*sqrt(fmax(p, 0.0)/p_rated) - (p - p_charge*V_gas/(V_gas - oil))/R_neck)/C_hose",
        ),
        "oil": ("m^3", "oil_begin", "(p - p_charge*V_gas/(V_gas - oil))/R_neck"),
    },
    {"pressure": ("Pa", "p"), "stroke": ("m", "oil/area")},
    5e-3,
)
ACCUMULATOR_KNOWN = {"V_gas": 0.03, "p_charge": 0.03, "C_hose": 0.08, "R_neck": 0.08, "Q_rated": 0.04}


def _accumulator(
    folder: Path,
    rng: Rng,
    exchange: float = 0.0,
    share: float = 0.0,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    logger: Logger = PLAIN,
) -> None:
    """The gas, said to be isothermal, may be nitrogen that takes `exchange` s to come to the temperature of its wall.

    A transmitter of a smaller range may be at the hose in the second recording: it ends at the pressure that is
    exceeded for a `share` of the time.
    """
    ACCUMULATOR.build(folder)
    stop = 100.0
    parts = programme("unit", ("pump", "L/min"), ("opening", "")) + with_numbers("store", "accumulator")
    wires = "  - unit.pump -> store.pump\n  - unit.opening -> store.opening\n"
    scenario(folder, "A piston accumulator", stop, 0.1, 0.1, parts, wires)
    data_sheet(folder, ACCUMULATOR, ACCUMULATOR_KNOWN)
    v_gas, p_charge, hose, neck, rated, p_rated, area, begin = drawn(rng, ACCUMULATOR, ACCUMULATOR_KNOWN)

    def gas(oil: float, warm: float) -> float:
        """Pressure [bar] from oil [L] and absolute temperature over that of the wall."""
        return 1e-5 * p_charge * v_gas / (v_gas - 1e-3 * oil) * warm

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Pressure is in bar, oil in L."""
        p, oil, warm = (float(s) for s in x)
        inward = 1e5 * (p - gas(oil, warm)) / neck
        outward = rated * float(u[1]) * np.sqrt(max(p, 0.0) * 1e5 / p_rated)
        heating = 0.4 * warm * inward / (v_gas - 1e-3 * oil) - (warm - 1.0) / exchange if exchange else 0.0
        return [1e-5 * (float(u[0]) / 6e4 - outward - inward) / hose, 1e3 * inward, heating]

    for name in FOLDERS:
        pump = drawn_steps(rng, stop, 3.0, 5.0, 13.0, 0.1)
        opening = drawn_steps(rng, stop, 3.5, 0.3, 0.85, 0.1)
        t, x = integrated(rates, (gas(1e3 * begin, 1.0), 1e3 * begin, 1.0), (pump, opening), stop, 0.05)
        limit = float(round(np.quantile(x[:, 0], 1.0 - share))) if share else np.inf

        def spoil(column: str, t: Array, v: Array, name: str = name, limit: float = limit) -> Array:
            return np.minimum(v, limit) if name == "second" and column == "P1_bar" else v

        sensors = [
            Sensor("store.pressure", "P1_bar", "bar", scaled(0, 1.0), 0.3, 0.1, noise_stated, 0.05, colour),
            Sensor("store.stroke", "LVDT [mm]", "mm", scaled(1, 1.0 / area), 0.25, 0.1, noise_stated, 0.1, colour),
        ]
        programmes = {"unit.pump": (pump, "L/min"), "unit.opening": (opening, "")}
        write(folder / name, rng, Written(t, x, sensors, programmes, logger, spoil=spoil))


def accumulator_null(folder: Path, rng: Rng) -> Truth:
    _accumulator(folder, rng, colour=0.7, logger=Logger("s", zero=512.0, jitter=0.2))
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.7, jitter, the clock begins at "
        "512 s",
        FINE,
    )


def accumulator_gas(folder: Path, rng: Rng) -> Truth:
    exchange = rng.uniform(6.0, 14.0)
    _accumulator(folder, rng, exchange=exchange)
    return Truth(
        f"the gas warms as it is compressed (nitrogen, 1.4) and takes {exchange:.2f} s to the temperature of its wall",
        PHYSICS,
        ("relaxation", "viscoelastic", "viscoelasticity", "maxwell_element", "standard_linear_solid", "thermal_mass"),
    )


def accumulator_saturated(folder: Path, rng: Rng) -> Truth:
    share = rng.uniform(0.12, 0.25)
    _accumulator(folder, rng, share=share, logger=Logger("min"))
    return Truth(
        f"the pressure transmitter of the second recording ends at what {100 * share:.0f} % of its course exceed, "
        "which is not stated",
        SENSOR,
    )


# --- a twisted and coiled thread against a spring, heated by a current and cooled by a fan, FMI 3; degC, mm, A
THREAD = OdeModel(
    "thread",
    {
        "R": (8.0, "ohm"),
        "C": (1.2, "J/K"),
        "h_still": (0.05, "W/K"),
        "h_fan": (0.08, "W/K"),
        "pull": (0.035, "N/K"),
        "k": (180.0, "N/m"),
        "d": (120.0, "N*s/m"),
        "T_room": (295.15, "K"),
        "T_begin": (295.15, "K"),
    },
    {"current": "A", "fan": ""},
    {
        "T": ("K", "T_begin", "(R*current*current - (h_still + h_fan*fan)*(T - T_room))/C"),
        "x": ("m", "pull*(T_begin - T_room)/k", "(pull*(T - T_room) - k*x)/d"),
    },
    {"temperature": ("K", "T"), "contraction": ("m", "x")},
    0.02,
)
THREAD_KNOWN = {"R": 0.03, "C": 0.05, "h_still": 0.08, "h_fan": 0.1, "pull": 0.06, "k": 0.05, "d": 0.08}


def _thread(
    folder: Path,
    rng: Rng,
    exponent: float = 0.0,
    soft: float = 0.0,
    stronger: tuple[float, float, float] | None = None,
    strayed: float = 0.0,
    noise_stated: float | None = 1.0,
    logger: Logger = PLAIN,
) -> None:
    """Still air may rise by itself, h_still (dT/40 K)^exponent; the thread may soften, k (1 - soft dT), dT over room.

    Stronger is begin [s], end [s] and factor of the current in the second recording. `strayed` is by how much [K] the
    start is off (deviation), which is stated.
    """
    build3(THREAD, folder)
    stop = 420.0
    parts = programme("source", ("current", "A")) + programme("blower", ("fan", "")) + with_numbers("muscle", "thread")
    wires = "  - source.current -> muscle.current\n  - blower.fan -> muscle.fan\n"
    scenario(folder, "A thread muscle", stop, 0.25, 0.25, parts, wires)
    data_sheet(folder, THREAD, THREAD_KNOWN)
    r, c, still, blown, pull, k, d, room, _ = drawn(rng, THREAD, THREAD_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Temperature is over that of the room, contraction in mm."""
        warm, short = float(x[0]), float(x[1])
        loss = still * (max(abs(warm), 1e-9) / 40.0) ** exponent + blown * float(u[1])
        return [(r * float(u[0]) ** 2 - loss * warm) / c, (1e3 * pull * warm - k * (1.0 - soft * warm) * short) / d]

    for name in FOLDERS:
        stated = drawn_steps(rng, stop, 16.0, 0.05, 0.72, 0.5)
        current = stated
        if stronger is not None and name == "second":
            current = between(stated, stronger[0], stronger[1], lambda v: stronger[2] * v)
        fan = drawn_steps(rng, stop, 30.0, 0.0, 0.6, 0.5)
        said = float(f"{rng.uniform(297.0, 308.0):.1f}") if strayed else room
        begin = said + strayed * float(rng.normal()) - room
        t, x = integrated(rates, (begin, 1e3 * pull * begin / k), (current, fan), stop, 0.125)

        def pyrometer(t: Array, x: Array, u: Array) -> Array:
            return np.asarray(x[:, 0] + room - CELSIUS)

        sensors = [
            Sensor("muscle.temperature", "IR °C", "degC", pyrometer, 0.35, 0.5, noise_stated, 0.1),
            Sensor("muscle.contraction", "laser_mm", "mm", scaled(1, 1.0), 0.06, 0.25, noise_stated, 0.01),
        ]
        sidecar: dict[str, Any] = {}
        if strayed:
            sidecar["components"] = {"muscle": {"parameters": {"T_begin": f"{said:.1f} K"}}}
            sidecar["uncertain"] = {"muscle.T_begin": f"{strayed:g} K"}
        made = Written(
            t,
            x,
            sensors,
            {"source.current": (current, "A"), "blower.fan": (fan, "")},
            logger,
            sidecar=sidecar,
            told={} if current is stated else {"source.current": stated},
        )
        write(folder / name, rng, made)


def thread_null(folder: Path, rng: Rng) -> Truth:
    _thread(folder, rng, strayed=2.5, noise_stated=None, logger=Logger("ms", zero=-4000.0))
    return Truth(
        "nothing; numbers off as stated, noise is not stated, a start of each recording is stated that is off by 2.5 K "
        "(deviation), which is stated too; two rates, the clock begins at -4000 ms",
        FINE,
    )


def thread_convection(folder: Path, rng: Rng) -> Truth:
    exponent = rng.uniform(0.25, 0.36)
    _thread(folder, rng, exponent=exponent, logger=Logger("s", zero=100.0))
    return Truth(
        f"still air rises by itself: h_still (dT/40 K)^{exponent:.3f}",
        PHYSICS,
        ("natural_convection", "convection", "free_convection"),
    )


def thread_two(folder: Path, rng: Rng) -> Truth:
    exponent, soft = rng.uniform(0.25, 0.36), rng.uniform(2e-3, 3.2e-3)
    _thread(folder, rng, exponent=exponent, soft=soft)
    return Truth(
        f"still air rises by itself, h_still (dT/40 K)^{exponent:.3f}, and the thread softens, k (1 - {soft:.2e}/K dT)",
        PHYSICS,
        (
            "natural_convection",
            "convection",
            "free_convection",
            "softening",
            "temperature_dependent_stiffness",
            "stiffness_of_temperature",
        ),
    )


def thread_source(folder: Path, rng: Rng) -> Truth:
    begin, factor = 10.0 * round(rng.uniform(8.0, 22.0)), rng.uniform(1.1, 1.18)
    _thread(folder, rng, stronger=(begin, begin + 110.0, factor))
    return Truth(
        f"the current was {factor:.3f} times what is stated, {begin:g} s to {begin + 110.0:g} s of the second "
        "recording",
        SENSOR,
        ("input_fault",),
    )


# --- a knitted glove with two heated zones on a hand, FMI 2 Co-Simulation; degC, W, min; its inputs are columns
GLOVE = OdeModel(
    "glove",
    {
        "C_palm": (60.0, "J/K"),
        "C_back": (45.0, "J/K"),
        "C_skin": (700.0, "J/K"),
        "U_palm": (0.3, "W/K"),
        "U_back": (0.38, "W/K"),
        "S_palm": (0.55, "W/K"),
        "S_back": (0.4, "W/K"),
        "B": (0.15, "W/K"),
        "blood": (1.3, "W/K"),
        "T_core": (309.65, "K"),
        "T_begin": (304.15, "K"),
    },
    {"power_palm": "W", "power_back": "W", "air": "K"},
    {
        "T_p": (
            "K",
            "T_begin",
            "(power_palm - U_palm*(T_p - air) - S_palm*(T_p - T_s) - B*(T_p - T_b))/C_palm",
        ),
        "T_b": (
            "K",
            "T_begin",
            "(power_back - U_back*(T_b - air) - S_back*(T_b - T_s) + B*(T_p - T_b))/C_back",
        ),
        "T_s": (
            "K",
            "T_begin",
            "(S_palm*(T_p - T_s) + S_back*(T_b - T_s) + blood*(T_core - T_s))/C_skin",
        ),
    },
    {"palm": ("K", "T_p"), "back": ("K", "T_b"), "skin": ("K", "T_s")},
    1.0,
)
GLOVE_KNOWN = {
    "C_palm": 0.06,
    "C_back": 0.06,
    "C_skin": 0.06,
    "U_palm": 0.05,
    "U_back": 0.05,
    "S_palm": 0.06,
    "S_back": 0.06,
    "B": 0.1,
    "blood": 0.06,
}


def _glove(
    folder: Path,
    rng: Rng,
    sweat: float = 0.0,
    onset: float = 306.5,
    is_exchanged: bool = False,
    noise_stated: float | None = 1.0,
    logger: Logger | None = None,
) -> None:
    """The hand may sweat above `onset` K and lose `sweat` W/K times the excess."""
    GLOVE.build(folder)
    stop = 5400.0
    parts = (
        programme("driver", ("power_palm", "W"), ("power_back", "W"))
        + programme("chamber", ("air", "degC"))
        + with_numbers("glove", "glove", "internal")
    )
    wires = (
        "  - driver.power_palm -> glove.power_palm\n  - driver.power_back -> glove.power_back\n"
        "  - chamber.air -> glove.air\n"
    )
    scenario(folder, "A heated glove", stop, 5, 10, parts, wires)
    data_sheet(folder, GLOVE, GLOVE_KNOWN)
    c_p, c_b, c_s, u_p, u_b, s_p, s_b, across, blood, core, begin = drawn(rng, GLOVE, GLOVE_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        palm, back, skin = (float(s) for s in x)
        air, knit = float(u[2]) + CELSIUS, across * (palm - back)
        lost = sweat * max(0.0, skin - onset)
        return [
            (float(u[0]) - u_p * (palm - air) - s_p * (palm - skin) - knit) / c_p,
            (float(u[1]) - u_b * (back - air) - s_b * (back - skin) + knit) / c_b,
            (s_p * (palm - skin) + s_b * (back - skin) + blood * (core - skin) - lost) / c_s,
        ]

    for name in FOLDERS:
        palm = drawn_steps(rng, stop, 300.0, 0.0, 16.0, 10.0)
        back = drawn_steps(rng, stop, 360.0, 0.0, 13.0, 10.0)
        air = drawn_steps(rng, stop, 1500.0, -2.0, 14.0, 10.0)
        t, x = integrated(rates, [begin] * 3, (palm, back, air), stop, 5.0)
        one, two = (1, 0) if is_exchanged and name == "second" else (0, 1)
        sensors = [
            Sensor("glove.palm", "NTC1", "degC", celsius(one), 0.2, 10.0, noise_stated, 0.05),
            Sensor("glove.back", "NTC2", "degC", celsius(two), 0.2, 10.0, noise_stated, 0.05),
            Sensor("glove.skin", "T_finger", "degC", celsius(2), 0.08, 10.0, noise_stated, 0.02),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"driver.power_palm": (palm, "W"), "driver.power_back": (back, "W"), "chamber.air": (air, "degC")},
            logger or Logger("min"),
            recorded=["driver.power_palm", "driver.power_back", "chamber.air"],
        )
        write(folder / name, rng, made)


def glove_null(folder: Path, rng: Rng) -> Truth:
    logger = Logger("min", zero=45.0, is_comma=True, empty=0.02)
    _glove(folder, rng, noise_stated=1.3, logger=logger)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.3 times too large, decimal commas, empty cells, minutes from "
        "45 min, Co-Simulation",
        FINE,
    )


def glove_sweat(folder: Path, rng: Rng) -> Truth:
    sweat, onset = rng.uniform(2.5, 4.5), rng.uniform(306.0, 306.8)
    _glove(folder, rng, sweat=sweat, onset=onset)
    return Truth(
        f"the hand sweats above {onset - CELSIUS:.2f} degC and loses {sweat:.2f} W/K times the excess",
        PHYSICS,
        ("threshold", "dead_zone", "evaporation", "latent_heat"),
    )


def glove_exchanged(folder: Path, rng: Rng) -> Truth:
    _glove(folder, rng, is_exchanged=True)
    return Truth("the thermistors of palm and back are exchanged, in the second recording", RECORDING)


# --- a bale of wool in a conditioned chamber, FMI 3 Model Exchange; % humidity, g, h; three days, two rates
WOOL = OdeModel(
    "wool",
    {
        "V_air": (2.0, "m^3"),
        "rho": (0.0173, "kg/m^3"),
        "K_shell": (0.6, "kg"),
        "K_core": (1.6, "kg"),
        "h_shell": (1.2e-4, "kg/s"),
        "h_core": (8e-5, "kg/s"),
        "phi_out": (0.35, ""),
        "phi_begin": (0.5, ""),
    },
    {"steam": "kg/s", "vent": "m^3/s"},
    {
        "phi": (
            "",
            "phi_begin",
            "(steam + vent*rho*(phi_out - phi) - h_shell*(phi - m_s/K_shell))/(V_air*rho)",
        ),
        "m_s": ("kg", "phi_begin*K_shell", "h_shell*(phi - m_s/K_shell) - h_core*(m_s/K_shell - m_c/K_core)"),
        "m_c": ("kg", "phi_begin*K_core", "h_core*(m_s/K_shell - m_c/K_core)"),
    },
    {"humidity": ("", "phi"), "water": ("kg", "m_s + m_c")},
    20.0,
)
WOOL_KNOWN = {"V_air": 0.03, "K_shell": 0.06, "K_core": 0.05, "h_shell": 0.08, "h_core": 0.08, "phi_out": 0.04}


def _wool(
    folder: Path,
    rng: Rng,
    hysteresis: float = 0.0,
    ahead: float = 0.0,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    logger: Logger | None = None,
) -> None:
    """Wool that dries may be in equilibrium with drier air than wool that takes up: 2 `hysteresis` between the two.

    The clock of the hygrometer may be `ahead` s in the second recording.
    """
    build3(WOOL, folder, has_co_simulation=False)
    stop = 259200.0
    parts = programme("climate", ("steam", "g/min"), ("vent", "m^3/h")) + with_numbers("bale", "wool")
    wires = "  - climate.steam -> bale.steam\n  - climate.vent -> bale.vent\n"
    scenario(folder, "A bale of wool", stop, 120, 120, parts, wires)
    data_sheet(folder, WOOL, WOOL_KNOWN)
    v_air, rho, k_s, k_c, h_s, h_c, outside, begin = drawn(rng, WOOL, WOOL_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Water is in g; the last state is the branch of the isotherm, -1 to 1, turned by some 15 g of the shell."""
        phi, shell, core, branch = (float(s) for s in x)
        taken = h_s * (phi - 1e-3 * shell / k_s - hysteresis * branch)
        inward = h_c * (1e-3 * shell / k_s - 1e-3 * core / k_c)
        air = float(u[0]) / 6e4 + float(u[1]) / 3600.0 * rho * (outside - phi)
        change = 1e3 * (taken - inward)
        turned = (change - abs(change) * branch) / 15.0 if hysteresis else 0.0
        return [(air - taken) / (v_air * rho), change, 1e3 * inward, turned]

    for name in FOLDERS:
        steam = drawn_steps(rng, stop, 9000.0, 0.0, 1.7, 240.0)
        vent = drawn_steps(rng, stop, 12000.0, 6.0, 20.0, 240.0)
        start = (begin, 1e3 * begin * k_s, 1e3 * begin * k_c, 0.0)
        t, x = integrated(rates, start, (steam, vent), stop, 60.0)

        def water(t: Array, x: Array, u: Array) -> Array:
            return np.asarray(x[:, 1] + x[:, 2])

        humidity = later(0, 100.0, t, x, ahead if name == "second" else 0.0)
        sensors = [
            Sensor("bale.humidity", "rF_%", "%", humidity, 0.3, 120.0, noise_stated, 0.1, wild=wild),
            Sensor("bale.water", "water_g", "g", water, 1.2, 360.0, noise_stated, 0.2, wild=wild),
        ]
        programmes = {"climate.steam": (steam, "g/min"), "climate.vent": (vent, "m^3/h")}
        write(folder / name, rng, Written(t, x, sensors, programmes, logger or Logger("h")))


def wool_null(folder: Path, rng: Rng) -> Truth:
    logger = Logger("h", zero=7.5, gap=(93600.0, 111600.0))
    _wool(folder, rng, noise_stated=1.6, wild=0.01, logger=logger)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.6 times too large, wild readings, a gap of 5 h, two rates, the "
        "clock begins at 7.5 h",
        FINE,
    )


def wool_hysteresis(folder: Path, rng: Rng) -> Truth:
    hysteresis = rng.uniform(0.034, 0.05)
    _wool(folder, rng, hysteresis=hysteresis)
    return Truth(
        f"hysteresis of sorption: equilibrium of drying wool is {200 * hysteresis:.2f} % of humidity below that of "
        "wool that takes up",
        PHYSICS,
        ("hysteresis", "bouc_wen"),
    )


def wool_clock(folder: Path, rng: Rng) -> Truth:
    ahead = 60.0 * round(rng.uniform(25.0, 60.0))
    _wool(folder, rng, ahead=ahead, logger=Logger("min", zero=480.0))
    return Truth(
        f"the clock of the hygrometer is {ahead / 60.0:g} min ahead in the second recording", (*RECORDING, *SENSOR)
    )


# --- a flywheel on a converter with a buffered link, FMI 2 Model Exchange; rpm, V; four runs
FLYWHEEL = OdeModel(
    "flywheel",
    {
        "J": (0.08, "kg*m^2"),
        "k": (0.12, "N*m/A"),
        "b": (3e-3, "N*m*s/rad"),
        "tau": (0.25, "s"),
        "C_link": (2.2, "F"),
        "R_link": (0.3, "ohm"),
        "V_supply": (48.0, "V"),
        "w_begin": (180.0, "rad/s"),
    },
    {"command": "A"},
    {
        "i": ("A", "0.0", "(command - i)/tau"),
        "w": ("rad/s", "w_begin", "(k*i - b*w)/J"),
        "v": ("V", "V_supply", "((V_supply - v)/R_link - k*w*i/v)/C_link"),
    },
    {"speed": ("rad/s", "w"), "link": ("V", "v")},
    0.01,
)
FLYWHEEL_KNOWN = {"J": 0.03, "k": 0.04, "b": 0.1, "tau": 0.08, "C_link": 0.06, "R_link": 0.05}


def _flywheel(
    folder: Path,
    rng: Rng,
    windage: float = 0.0,
    dry: float = 0.0,
    is_other: bool = False,
    logger: Logger = PLAIN,
) -> None:
    """The disc may drag air, `windage` w^2 [N m], and its bearings may rub with `dry` N m.

    The second recording may state the current of another run.
    """
    FLYWHEEL.build(folder)
    stop = 150.0
    parts = programme("converter", ("command", "A")) + with_numbers("wheel", "flywheel")
    scenario(folder, "A flywheel", stop, 0.1, 0.1, parts, "  - converter.command -> wheel.command\n")
    data_sheet(folder, FLYWHEEL, FLYWHEEL_KNOWN)
    inertia, k, b, tau, c_link, r_link, supply, begin = drawn(rng, FLYWHEEL, FLYWHEEL_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        i, w, v = (float(s) for s in x)
        held = windage * abs(w) * w + dry * np.tanh(w / 0.5)
        return [
            (float(u[0]) - i) / tau,
            (k * i - b * w - held) / inertia,
            ((supply - v) / r_link - k * w * i / v) / c_link,
        ]

    other = drawn_steps(rng, stop, 5.0, -4.0, 20.0, 0.1)
    for name in FOUR:
        command = drawn_steps(rng, stop, 5.0, -4.0, 20.0, 0.1)
        t, x = integrated(rates, (0.0, begin, supply), (command,), stop, 0.05)
        sensors = [
            Sensor("wheel.speed", "n (1/min)", "rpm", scaled(1, RPM), 8.0, 0.1, 1.0, 1.0),
            Sensor("wheel.link", "U_ZK", "V", scaled(2, 1.0), 0.08, 0.1, 1.0, 0.02),
        ]
        told = {"converter.command": other} if is_other and name == "second" else {}
        write(folder / name, rng, Written(t, x, sensors, {"converter.command": (command, "A")}, logger, told=told))


def flywheel_windage(folder: Path, rng: Rng) -> Truth:
    windage = rng.uniform(3.5e-6, 6e-6)
    _flywheel(folder, rng, windage=windage, logger=Logger("ms", zero=2000.0))
    return Truth(
        f"the disc drags air: {windage:.3e} N m s^2 w^2",
        PHYSICS,
        ("quadratic_drag", "quadratic_damping", "air_drag", "drag", "windage", "turbulent_loss"),
        **FOUR_SPLIT,
    )


def flywheel_two(folder: Path, rng: Rng) -> Truth:
    windage, dry = rng.uniform(4e-6, 6e-6), rng.uniform(0.18, 0.26)
    _flywheel(folder, rng, windage=windage, dry=dry)
    return Truth(
        f"the disc drags air, {windage:.3e} N m s^2 w^2, and its bearings rub with {dry:.3f} N m",
        PHYSICS,
        (
            "quadratic_drag",
            "quadratic_damping",
            "air_drag",
            "drag",
            "windage",
            "turbulent_loss",
            "dry_friction",
            "coulomb_friction",
        ),
        **FOUR_SPLIT,
    )


def flywheel_other_run(folder: Path, rng: Rng) -> Truth:
    _flywheel(folder, rng, is_other=True, logger=Logger("min", zero=3.0))
    return Truth("the second recording states the current of another run", RECORDING, **FOUR_SPLIT)


# --- a membrane of a dielectric elastomer with a mass and its amplifier, FMI 2 Model Exchange; mm, kV, ms
ELASTOMER = OdeModel(
    "elastomer",
    {
        "m": (0.012, "kg"),
        "k": (900.0, "N/m"),
        "k_slow": (250.0, "N/m"),
        "tau_slow": (0.03, "s"),
        "d": (0.5, "N*s/m"),
        "beta": (1.2e-7, "N/V^2"),
        "tau": (4e-3, "s"),
    },
    {"command": "V"},
    {
        "y": ("m", "0.0", "v"),
        "v": ("m/s", "0.0", "(beta*charged*charged - k*y - k_slow*(y - z) - d*v)/m"),
        "z": ("m", "0.0", "(y - z)/tau_slow"),
        "charged": ("V", "0.0", "(command - charged)/tau"),
    },
    {"lift": ("m", "y"), "voltage": ("V", "charged")},
    1e-4,
)
ELASTOMER_KNOWN = {"m": 0.03, "k": 0.04, "k_slow": 0.1, "tau_slow": 0.1, "d": 0.1, "beta": 0.05, "tau": 0.05}


def _elastomer(
    folder: Path,
    rng: Rng,
    stiffening: float = 0.0,
    is_reversed: bool = False,
    noise_stated: float | None = 1.0,
    quantum: float = 2e-3,
    logger: Logger | None = None,
) -> None:
    """The membrane may stiffen as it is stretched, k y (1 + (y/stiffening)^2), `stiffening` in mm."""
    ELASTOMER.build(folder)
    stop = 0.5
    parts = programme("amplifier", ("command", "kV")) + with_numbers("membrane", "elastomer")
    wires = "  - amplifier.command -> membrane.command\n"
    scenario(folder, "A dielectric elastomer", stop, 5e-4, 5e-4, parts, wires)
    data_sheet(folder, ELASTOMER, ELASTOMER_KNOWN)
    m, k, k_slow, tau_slow, d, beta, tau = drawn(rng, ELASTOMER, ELASTOMER_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Courses are in mm, voltage in kV, forces in mN."""
        y, v, z, charged = (float(s) for s in x)
        held = k * y * (1.0 + (y / stiffening) ** 2) if stiffening else k * y
        return [
            v,
            (1e9 * beta * charged**2 - held - k_slow * (y - z) - d * v) / m,
            (y - z) / tau_slow,
            (float(u[0]) - charged) / tau,
        ]

    for name in FOLDERS:
        command = drawn_steps(rng, stop, 0.018, 0.2, 4.0, 5e-4)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0), (command,), stop, 1.25e-4)
        sign = -1.0 if is_reversed and name == "second" else 1.0
        sensors = [
            Sensor("membrane.lift", "lift/mm", "mm", scaled(0, sign), 0.012, 5e-4, noise_stated, quantum),
            Sensor("membrane.voltage", "probe_kV", "kV", scaled(3, 1.0), 0.015, 5e-4, noise_stated, 5e-3),
        ]
        programmes = {"amplifier.command": (command, "kV")}
        write(folder / name, rng, Written(t, x, sensors, programmes, logger or Logger("ms")))


def elastomer_null(folder: Path, rng: Rng) -> Truth:
    logger = Logger("s", zero=-0.02, jitter=0.3, empty=0.02)
    _elastomer(folder, rng, noise_stated=None, quantum=0.02, logger=logger)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, a coarse converter of the laser, jitter, empty cells, "
        "the clock begins at -0.02 s",
        FINE,
    )


def elastomer_stiffening(folder: Path, rng: Rng) -> Truth:
    stiffening = rng.uniform(3.6, 4.8)
    _elastomer(folder, rng, stiffening=stiffening)
    return Truth(
        f"the membrane stiffens as it is stretched: k y (1 + (y/{stiffening:.3f} mm)^2)",
        PHYSICS,
        ("cubic_spring", "cubic_stiffness", "hardening", "hardening_spring", "nonlinear_spring"),
    )


def elastomer_sign(folder: Path, rng: Rng) -> Truth:
    _elastomer(folder, rng, is_reversed=True, logger=Logger("ms", zero=12.5))
    return Truth("the laser counts the other way in the second recording", (*RECORDING, *SENSOR))


# --- a drone's pack (FMI 2, Co-Simulation) and its motor and propeller (FMI 3, Model Exchange); rpm, mV; two clocks
PACK = OdeModel(
    "pack",
    {
        "U_empty": (14.0, "V"),
        "U_full": (2.6, "V"),
        "Q": (5400.0, "C"),
        "R0": (0.02, "ohm"),
        "R1": (0.025, "ohm"),
        "tau1": (12.0, "s"),
        "soc_begin": (0.95, ""),
    },
    {"current": "A"},
    {
        "soc": ("", "soc_begin", "-current/Q"),
        "v1": ("V", "0.0", "(R1*current - v1)/tau1"),
    },
    {"voltage": ("V", "U_empty + U_full*soc - v1 - R0*current")},
    0.01,
)
PROPELLER = OdeModel(
    "propeller",
    {
        "k": (0.0103, "V*s/rad"),
        "R": (0.2, "ohm"),
        "tau": (0.12, "s"),
        "J": (2.5e-4, "kg*m^2"),
        "k_air": (1.6e-7, "N*m*s^2/rad^2"),
    },
    {"duty": "", "supply": "V"},
    {
        "i": ("A", "0.0", "((duty*supply - k*w)/R - i)/tau"),
        "w": ("rad/s", "0.0", "(k*i - k_air*w*fabs(w))/J"),
    },
    {"speed": ("rad/s", "w"), "phase": ("A", "i"), "drawn": ("A", "duty*i")},
    1e-3,
)
PACK_KNOWN = {"U_empty": 0.005, "Q": 0.05, "R0": 0.08, "R1": 0.08, "tau1": 0.1}
PROPELLER_KNOWN = {"k": 0.02, "R": 0.05, "tau": 0.08, "J": 0.05, "k_air": 0.05}


def _drone(
    folder: Path,
    rng: Rng,
    dry: float = 0.0,
    misread: tuple[float, float, float] | None = None,
    noise_stated: float | None = 1.0,
    logger: Logger = PLAIN,
) -> None:
    """Two FMUs; bearings may rub with `dry` N m; `misread` is begin [s], end [s] and gain of the clamp-on ammeter."""
    stop = 36.0
    PACK.build(folder)
    build3(PROPELLER, folder)
    data_sheet(folder, PROPELLER, PROPELLER_KNOWN)
    (folder / "numbers.yaml").rename(folder / "motor.yaml")
    data_sheet(folder, PACK, PACK_KNOWN)
    parts = (
        programme("flight", ("duty", ""))
        + with_numbers("pack", "pack", "internal")
        + with_numbers("motor", "propeller").replace("numbers.yaml", "motor.yaml")
    )
    wires = "  - flight.duty -> motor.duty\n  - pack.voltage -> motor.supply\n  - motor.drawn -> pack.current\n"
    scenario(folder, "A motor of a drone", stop, 0.04, 0.04, parts, wires)
    empty, full, charge, r0, r1, tau1, begin = drawn(rng, PACK, PACK_KNOWN)
    k, r, tau, inertia, k_air = drawn(rng, PROPELLER, PROPELLER_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        soc, v1, i, w = (float(s) for s in x)
        duty = float(u[0])
        supply = empty + full * soc - v1 - r0 * duty * i
        return [
            -duty * i / charge,
            (r1 * duty * i - v1) / tau1,
            ((duty * supply - k * w) / r - i) / tau,
            (k * i - k_air * w * abs(w) - dry * np.tanh(w / 2.0)) / inertia,
        ]

    for name in FOLDERS:
        duty = drawn_steps(rng, stop, 1.6, 0.15, 0.8, 0.04)
        t, x = integrated(rates, (begin, 0.0, 0.0, 0.0), (duty,), stop, 0.02)

        def terminals(t: Array, x: Array, u: Array) -> Array:
            return np.asarray(empty + full * x[:, 0] - x[:, 1] - r0 * u[:, 0] * x[:, 2])

        def spoil(column: str, t: Array, v: Array, name: str = name) -> Array:
            if misread is None or name != "second" or column != "I_clamp":
                return v
            return np.where((t >= misread[0]) & (t < misread[1]), np.round(misread[2] * v, 1), v)

        sensors = [
            Sensor("motor.speed", "rpm_opt", "rpm", scaled(3, RPM), 25.0, 0.04, noise_stated, 5.0),
            Sensor("motor.phase", "I_clamp", "A", scaled(2, 1.0), 0.25, 0.04, noise_stated, 0.1),
            Sensor("pack.voltage", "U_pack_mV", "mV", lambda *a: 1e3 * terminals(*a), 12.0, 0.2, noise_stated, 1.0),
        ]
        write(folder / name, rng, Written(t, x, sensors, {"flight.duty": (duty, "")}, logger, spoil=spoil))
        second_clock(folder / name, "ms", float(round(rng.uniform(1000.0, 90000.0))))


def drone_null(folder: Path, rng: Rng) -> Truth:
    _drone(folder, rng, noise_stated=1.5, logger=Logger("s", zero=7.0, gap=(20.0, 22.5)))
    return Truth(
        "nothing; numbers off as stated, two FMUs, noise stated 1.5 times too large, a gap of 2.5 s, the "
        "pack's voltage is of a logger with another rate and a clock of its own, in ms",
        FINE,
    )


def drone_friction(folder: Path, rng: Rng) -> Truth:
    dry = rng.uniform(0.016, 0.024)
    _drone(folder, rng, dry=dry)
    return Truth(f"the motor's bearings rub with {1e3 * dry:.2f} mN m", PHYSICS, ("dry_friction", "coulomb_friction"))


def drone_clamp(folder: Path, rng: Rng) -> Truth:
    begin, gain = float(round(rng.uniform(8.0, 19.0))), rng.uniform(1.15, 1.3)
    _drone(folder, rng, misread=(begin, begin + 14.0, gain))
    return Truth(
        f"the clamp-on ammeter reads {gain:.3f} times the current, {begin:g} s to {begin + 14.0:g} s of the second "
        "recording",
        SENSOR,
    )


# --- oxygen and substrate of an aerated basin, FMI 3 Co-Simulation, without units; mg/L, min
BASIN = OdeModel(
    "basin",
    {
        "D": (2e-4, ""),
        "k": (6e-4, ""),
        "kLa": (4e-3, ""),
        "need": (0.35, ""),
        "c_sat": (8.8, ""),
        "c_begin": (6.0, ""),
        "s_begin": (20.0, ""),
    },
    {"air": "", "feed": ""},
    {
        "c": ("", "c_begin", "kLa*air*(c_sat - c) - need*k*s - D*c"),
        "s": ("", "s_begin", "D*(feed - s) - k*s"),
    },
    {"oxygen": ("", "c"), "substrate": ("", "s")},
    5.0,
)
BASIN_KNOWN = {"D": 0.04, "k": 0.08, "kLa": 0.06, "need": 0.06, "c_sat": 0.02}


def _basin(
    folder: Path,
    rng: Rng,
    half: float = 0.0,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    logger: Logger | None = None,
) -> None:
    """Sludge may take up less where there is much (Monod): k s/(1 + s/half).

    The programme of the feed may be the scenario's alone, which was played in no recording.
    """
    build3(BASIN, folder, has_exchange=False)
    stop = 36000.0

    def fed() -> Steps:
        return drawn_steps(rng, stop, 2400.0, 20.0, 190.0, 60.0)

    written, real = fed(), fed()
    parts = programme("dosing", ("feed", ""))
    if is_other:
        points = ", ".join(f"[{t:.10g} s, {v:.10g}]" for t, v in zip(written.times, written.levels))
        parts = f'  dosing:\n    kind: programme\n    outputs:\n      feed: {{unit: "1", points: [{points}]}}\n'
    parts += programme("blower", ("air", "")) + with_numbers("basin", "basin", "internal")
    wires = "  - blower.air -> basin.air\n  - dosing.feed -> basin.feed\n"
    scenario(folder, "An aerated basin", stop, 20, 20, parts, wires)
    data_sheet(folder, BASIN, BASIN_KNOWN)
    dilution, k, k_la, need, sat, c_begin, s_begin = drawn(rng, BASIN, BASIN_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        c, s = float(x[0]), float(x[1])
        uptake = k * s / (1.0 + s / half) if half else k * s
        return [
            k_la * float(u[0]) * (sat - c) - need * uptake - dilution * c,
            dilution * (float(u[1]) - s) - uptake,
        ]

    for name in FOLDERS:
        air = drawn_steps(rng, stop, 1500.0, 0.45, 1.0, 60.0)
        feed = real if is_other else fed()
        t, x = integrated(rates, (c_begin, s_begin), (air, feed), stop, 10.0)
        sensors = [
            Sensor("basin.oxygen", "DO", "1", scaled(0, 1.0), 0.05, 20.0, noise_stated, 0.01),
            Sensor("basin.substrate", "COD", "1", scaled(1, 1.0), 0.5, 60.0, noise_stated, 0.1),
        ]
        programmes = {"blower.air": (air, "")} if is_other else {"blower.air": (air, ""), "dosing.feed": (feed, "")}
        write(folder / name, rng, Written(t, x, sensors, programmes, logger or Logger("min")))


def basin_null(folder: Path, rng: Rng) -> Truth:
    _basin(folder, rng, noise_stated=0.75, logger=Logger("h", zero=14.0, empty=0.04))
    return Truth(
        "nothing; numbers off as stated, no units, noise stated 1.33 times too small, empty cells, two rates, the "
        "clock begins at 14 h",
        FINE,
    )


def basin_monod(folder: Path, rng: Rng) -> Truth:
    half = rng.uniform(45.0, 80.0)
    _basin(folder, rng, half=half)
    return Truth(
        f"sludge takes up less where there is much (Monod): k s/(1 + s/{half:.1f} mg/L)",
        PHYSICS,
        ("michaelis_menten", "saturation"),
    )


def basin_programme(folder: Path, rng: Rng) -> Truth:
    _basin(folder, rng, is_other=True)
    return Truth(
        "the scenario states a programme of the feed that was played in none of the recordings; all have one other",
        (*RECORDING, *SENSOR),
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    accumulator_null,
    thread_convection,
    glove_exchanged,
    wool_hysteresis,
    flywheel_windage,
    elastomer_null,
    drone_clamp,
    basin_monod,
    accumulator_gas,
    thread_null,
    glove_sweat,
    wool_clock,
    flywheel_other_run,
    elastomer_stiffening,
    drone_null,
    basin_programme,
    accumulator_saturated,
    thread_two,
    glove_null,
    wool_null,
    flywheel_two,
    elastomer_sign,
    drone_friction,
    basin_null,
    thread_source,
)
