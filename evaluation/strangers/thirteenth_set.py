"""Thirteenth set: a vine robot, a flow chip, a mock circulation, a composter, a seat, a film, a coupling, a ribbon.

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
from evaluation.strangers.eighth_set import idle_column, second_clock
from evaluation.strangers.eleventh_set import DEGREES, LEAKING, RPM, RUBBING, telegraph
from evaluation.strangers.fifth_set import FOUR, FOUR_SPLIT, integrated, saturation_pressure
from evaluation.strangers.first_set import PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import between, bursts, data_sheet, scaled
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Steps, Written, celsius, drawn_steps, write
from evaluation.strangers.tenth_set import stairs, swept, within
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth
from evaluation.strangers.twelfth_set import SQUARE

#: Millimetres of mercury in a kilopascal; centimetres of water in a millimetre of mercury.
MMHG, WATER_COLUMN = 7.50062, 1.35951
#: Heat of evaporation of water [J/kg], its gas constant [J/(kg*K)].
EVAPORATION, VAPOUR = 2.4e6, 461.5


def wandering(rng: Rng, stop: float, dwell: float, low: float, high: float, grid: float) -> Steps:
    """Levels that each differ from the last by up to a third of the range, thrown back at its ends."""
    times, levels, t = [0.0], [rng.uniform(low, high)], 0.0
    while (t := t + grid * max(1, round(rng.uniform(0.6, 1.4) * dwell / grid))) < stop - dwell / 4:
        level = levels[-1] + rng.choice([-1.0, 1.0]) * rng.uniform(0.1, 0.35) * (high - low)
        times.append(t)
        levels.append(2.0 * low - level if level < low else 2.0 * high - level if level > high else level)
    return Steps(tuple(times), tuple(float(f"{v:.3g}") for v in levels))


# --- a vine robot that grows against a rubber cord, FMI 2 Model Exchange; mbar, encoder counts, N; two rates
VINE = OdeModel(
    "vine",
    {
        "C_base": (9e-8, "m^3/Pa"),
        "G": (1e-7, "m^3/(s*Pa)"),
        "area": (3e-3, "m^2"),
        "m": (0.6, "kg"),
        "d": (22.0, "N*s/m"),
        "k_cord": (9.0, "N/m"),
        "p_begin": (8000.0, "Pa"),
        "x_begin": (0.9, "m"),
    },
    {"supply": "Pa", "tail": "N"},
    {
        "p": ("Pa", "p_begin", "(G*(supply - p) - area*v)/C_base"),
        "x": ("m", "x_begin", "v"),
        "v": ("m/s", "0.0", "(0.5*area*p - tail - k_cord*x - d*v)/m"),
    },
    {"pressure": ("Pa", "p"), "length": ("m", "x")},
    2e-3,
)
VINE_KNOWN = {"C_base": 0.06, "G": 0.05, "area": 0.02, "m": 0.05, "d": 0.08, "k_cord": 0.05}


def _vine(
    folder: Path,
    rng: Rng,
    dry: float = 0.0,
    leak: float = 0.0,
    stuck: tuple[float, float] | None = None,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The film may rub with `dry` N where it turns inside out; its seam may leak, `leak` m^3/(s Pa).

    The encoder of the second recording may be stuck between two instants [s].
    """
    VINE.build(folder)
    parts = (
        programme("regulator", ("supply", "mbar")) + programme("winch", ("tail", "N")) + with_numbers("vine", "vine")
    )
    wires = "  - regulator.supply -> vine.supply\n  - winch.tail -> vine.tail\n"
    scenario(folder, "A vine robot", 150.0, 0.05, 0.1, parts, wires)
    data_sheet(folder, VINE, VINE_KNOWN)
    c_base, conductance, area, m, d, k_cord, p_begin, x_begin = drawn(rng, VINE, VINE_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Pressure is in kPa."""
        p, s, v = (float(w) for w in x)
        flow = conductance * (0.1 * float(u[0]) - p) - leak * p - 1e-3 * area * v
        rubbing = dry * np.tanh(v / 4e-3)
        return [flow / c_base, v, (500.0 * area * p - float(u[1]) - k_cord * s - d * v - rubbing) / m]

    for number, (name, stop) in enumerate((("first", 150.0), ("second", 120.0), ("third", 130.0))):
        supply = drawn_steps(rng, stop, 6.5, 60.0, 210.0, 0.1)
        if name == "third":
            supply = swept(stop, 65.0, 200.0, 26.0, 9.0, 0.5)
        tail = drawn_steps(rng, stop, 10.0, 0.0, 5.0, 0.1)
        t, x = integrated(rates, (1e-3 * p_begin, x_begin, 0.0), (supply, tail), stop, 0.02)

        def spoil(column: str, t: Array, v: Array, name: str = name) -> Array:
            """An encoder that counts each 2 mm."""
            if column != "enc_counts":
                return v
            shown = v.copy()
            if stuck is not None and name == "second":
                hit = within(stuck, t)
                shown[hit] = shown[np.argmax(hit)]
            return np.asarray(np.round(shown / 0.2))

        factor = {"factor": 0.2}
        sensors = [
            Sensor("vine.length", "enc_counts", "cm", scaled(1, 100.0), 0.6, 0.1, 1.0, 0.2, more=factor),
            Sensor("vine.pressure", "p_body/mbar", "mbar", scaled(0, 10.0), 0.9, 0.25, 1.0, 0.1),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"regulator.supply": (supply, "mbar"), "winch.tail": (tail, "N")},
            loggers[number % len(loggers)],
            spoil=spoil,
        )
        write(folder / name, rng, made)


def vine_friction(folder: Path, rng: Rng) -> Truth:
    dry = rng.uniform(0.9, 1.5)
    _vine(folder, rng, dry=dry, loggers=(Logger("s", zero=17.0), Logger("ms")))
    return Truth(f"the film rubs with {dry:.3f} N where it turns inside out", PHYSICS, RUBBING)


def vine_two(folder: Path, rng: Rng) -> Truth:
    dry, leak = rng.uniform(0.9, 1.5), rng.uniform(1.4e-8, 2.2e-8)
    _vine(folder, rng, dry=dry, leak=leak, loggers=(PLAIN, Logger("min", zero=-2.0)))
    return Truth(
        f"the film rubs with {dry:.3f} N where it turns inside out, and its seam leaks {leak:.2e} m^3/(s Pa)",
        PHYSICS,
        (*RUBBING, *LEAKING),
    )


def vine_stuck(folder: Path, rng: Rng) -> Truth:
    begin = float(round(rng.uniform(25.0, 75.0)))
    _vine(folder, rng, stuck=(begin, begin + 18.0), loggers=(Logger("ms", zero=500.0), PLAIN))
    return Truth(f"the encoder is stuck, {begin:g} s to {begin + 18.0:g} s of the second recording", SENSOR)


# --- a calorimetric flow chip: heater and thermometer on a membrane, FMI 3 Model Exchange; ms, mW, degC; four runs
CHIP = OdeModel(
    "chip",
    {
        "C_heater": (6e-7, "J/K"),
        "C_down": (4e-7, "J/K"),
        "G": (5e-5, "W/K"),
        "carry": (1e-5, "W/K"),
        "h_0": (6e-5, "W/K"),
        "h_1": (3e-5, "W/K"),
        "l_0": (4e-5, "W/K"),
        "l_1": (2e-5, "W/K"),
        "v_1": (1.0, "m/s"),
        "T_gas": (296.65, "K"),
    },
    {"power": "W", "flow": "m/s"},
    {
        "T_h": (
            "K",
            "T_gas",
            "(power - (h_0 + h_1*sqrt(fmax(flow/v_1, 0.0)))*(T_h - T_gas) - G*(T_h - T_d))/C_heater",
        ),
        "T_d": (
            "K",
            "T_gas",
            "((G + carry*flow/v_1)*(T_h - T_d) - (l_0 + l_1*sqrt(fmax(flow/v_1, 0.0)))*(T_d - T_gas))/C_down",
        ),
    },
    {"heater": ("K", "T_h"), "downstream": ("K", "T_d")},
    5e-5,
)
CHIP_KNOWN = {"C_heater": 0.05, "C_down": 0.05, "G": 0.06, "carry": 0.08, "h_0": 0.05, "h_1": 0.06, "l_0": 0.06}


def _chip(
    folder: Path,
    rng: Rng,
    rim: tuple[float, float] | None = None,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """A rim of silicon may take up heat of the heater: transfer [W/K] and time [s].

    The second recording may have the column of the flow of another run.
    """
    build3(CHIP, folder, has_co_simulation=False)
    parts = programme("source", ("power", "mW")) + programme("nozzle", ("flow", "m/s")) + with_numbers("chip", "chip")
    wires = "  - source.power -> chip.power\n  - nozzle.flow -> chip.flow\n"
    scenario(folder, "A flow chip", 0.36, 5e-4, 5e-4, parts, wires)
    data_sheet(folder, CHIP, CHIP_KNOWN)
    c_heater, c_down, g, carry, h_0, h_1, l_0, l_1, v_1, gas = drawn(rng, CHIP, CHIP_KNOWN)
    taken, tau = rim or (0.0, 1.0)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        hot, down, edge = (float(s) for s in x)
        flow = float(u[1]) / v_1
        return [
            (1e-3 * float(u[0]) - (h_0 + h_1 * np.sqrt(flow)) * (hot - gas) - g * (hot - down) - taken * (hot - edge))
            / c_heater,
            ((g + carry * flow) * (hot - down) - (l_0 + l_1 * np.sqrt(flow)) * (down - gas)) / c_down,
            (hot - edge) / tau,
        ]

    other = drawn_steps(rng, 0.3, 0.014, 0.2, 8.0, 5e-4)
    for number, (name, stop) in enumerate(zip(FOUR, (0.36, 0.3, 0.33, 0.3))):
        power = drawn_steps(rng, stop, 0.009, 0.0, 20.0, 5e-4)
        if name == "fourth":
            power = wandering(rng, stop, 0.006, 0.5, 19.5, 5e-4)
        flow = drawn_steps(rng, stop, 0.014, 0.2, 8.0, 5e-4)
        t, x = integrated(rates, (gas, gas, gas), (power, flow), stop, 1e-4)
        sensors = [
            Sensor("chip.heater", "R1 -> T", "degC", celsius(0), 0.5, 5e-4, noise_stated, 0.1, colour),
            Sensor("chip.downstream", "R2 -> T", "degC", celsius(1), 0.25, 5e-4, noise_stated, 0.05, colour),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"source.power": (power, "mW"), "nozzle.flow": (flow, "m/s")},
            loggers[number % len(loggers)],
            recorded=["nozzle.flow"],
            told={"nozzle.flow": other} if is_other and name == "second" else {},
        )
        write(folder / name, rng, made)


def chip_null(folder: Path, rng: Rng) -> Truth:
    _chip(folder, rng, noise_stated=0.85, colour=0.65, loggers=(Logger("ms", zero=81.5, empty=0.03), Logger("s")))
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.65 and is stated 1.18 times "
        "too small, empty cells, ms from 81.5",
        FINE,
        **FOUR_SPLIT,
    )


def chip_rim(folder: Path, rng: Rng) -> Truth:
    taken, tau = rng.uniform(1e-5, 1.6e-5), rng.uniform(0.02, 0.04)
    _chip(folder, rng, rim=(taken, tau), loggers=(Logger("ms"), Logger("ms", zero=-20.0)))
    return Truth(
        f"a rim of silicon takes up heat of the heater: {taken:.2e} W/K, it follows with {1e3 * tau:.1f} ms",
        PHYSICS,
        ("hidden_state", "thermal_mass", "hidden_mass"),
        **FOUR_SPLIT,
    )


def chip_other_run(folder: Path, rng: Rng) -> Truth:
    _chip(folder, rng, is_other=True, loggers=(Logger("s", zero=2.0), Logger("ms")))
    return Truth("the second recording has the flow of another run", (*RECORDING, *SENSOR), **FOUR_SPLIT)


# --- a mock circulation with a centrifugal pump and a clamp, FMI 2 Co-Simulation; mmHg, L/min, rpm; speed is a column
CIRCULATION = OdeModel(
    "circulation",
    {
        "k_head": (0.15, "Pa*s^2"),
        "R_pump": (2.6e7, "Pa*s/m^3"),
        "L": (1e7, "Pa*s^2/m^3"),
        "C_artery": (1.1e-8, "m^3/Pa"),
        "C_vein": (1.1e-7, "m^3/Pa"),
        "G_clamp": (1.3e-8, "m^3/(s*Pa)"),
        "p_fill": (1700.0, "Pa"),
    },
    {"speed": "rad/s", "clamp": ""},
    {
        "p_a": ("Pa", "p_fill", "(q - G_clamp*clamp*(p_a - p_v))/C_artery"),
        "p_v": ("Pa", "p_fill", "(G_clamp*clamp*(p_a - p_v) - q)/C_vein"),
        "q": ("m^3/s", "0.0", "(k_head*speed*speed - R_pump*q - (p_a - p_v))/L"),
    },
    {"artery": ("Pa", "p_a"), "vein": ("Pa", "p_v"), "flow": ("m^3/s", "q")},
    5e-3,
)
CIRCULATION_KNOWN = {"k_head": 0.03, "R_pump": 0.06, "L": 0.06, "C_artery": 0.06, "C_vein": 0.05, "G_clamp": 0.05}


def _circulation(
    folder: Path,
    rng: Rng,
    stiff: float = np.inf,
    turbulent: float = 0.0,
    is_water: bool = False,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The arterial tube may stiffen, C/(1 + (p - p_fill)/stiff), `stiff` in kPa; the pump may lose turbulent q^2.

    `turbulent` is in Pa s^2/m^6. The arterial pressure of the first recording may be in cmH2O.
    """
    CIRCULATION.build(folder)
    parts = programme("pump", ("speed", "rpm")) + programme("valve", ("clamp", "'%'")).replace("0 '%'", "0 %")
    wires = "  - pump.speed -> loop.speed\n  - valve.clamp -> loop.clamp\n"
    parts += with_numbers("loop", "circulation", "internal")
    scenario(folder, "A mock circulation", 110.0, 0.05, 0.1, parts, wires)
    data_sheet(folder, CIRCULATION, CIRCULATION_KNOWN)
    k_head, r_pump, inertance, c_artery, c_vein, g_clamp, p_fill = drawn(rng, CIRCULATION, CIRCULATION_KNOWN)
    fill = 1e-3 * p_fill

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Pressures are in kPa, the flow in ml/s."""
        artery, vein, q = (float(s) for s in x)
        out = 1e9 * g_clamp * 0.01 * float(u[1]) * (artery - vein)
        head = 1e-3 * k_head * (float(u[0]) / RPM) ** 2 - 1e-15 * turbulent * q * abs(q)
        return [
            (q - out) * (1.0 + max(artery - fill, 0.0) / stiff) / (1e9 * c_artery),
            (out - q) / (1e9 * c_vein),
            1e9 * (head - 1e-9 * r_pump * q - (artery - vein)) / inertance,
        ]

    for number, (name, stop) in enumerate((("first", 110.0), ("second", 90.0), ("third", 100.0))):
        speed = drawn_steps(rng, stop, 3.2, 1700.0, 3300.0, 0.1)
        if name == "third":
            speed = wandering(rng, stop, 2.4, 1750.0, 3250.0, 0.1)
        clamp = drawn_steps(rng, stop, 6.0, 25.0, 100.0, 0.1)
        t, x = integrated(rates, (fill, fill, 0.0), (speed, clamp), stop, 0.02)
        pressure = MMHG * (WATER_COLUMN if is_water and name == "first" else 1.0)
        sensors = [
            Sensor("loop.artery", "AoP", "mmHg", scaled(0, pressure), 0.5, 0.1, noise_stated, 0.1, wild=wild),
            Sensor("loop.vein", "CVP", "mmHg", scaled(1, MMHG), 0.25, 0.1, noise_stated, 0.1, wild=wild),
            Sensor("loop.flow", "Q_transit", "L/min", scaled(2, 0.06), 0.05, 0.1, noise_stated, 0.01, wild=wild),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"pump.speed": (speed, "rpm"), "valve.clamp": (clamp, "%")},
            loggers[number % len(loggers)],
            recorded=["pump.speed"],
        )
        write(folder / name, rng, made)
        idle_column(folder / name, "pump current [A]", lambda n: np.asarray(0.8 + 0.03 * rng.standard_normal(n)))


def circulation_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=3600.0, empty=0.02), Logger("ms", zero=-450.0))
    _circulation(folder, rng, noise_stated=0.8, wild=0.012, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.25 times too small, wild readings of all three, a column that "
        "nothing names, seconds from 3600, empty cells, Co-Simulation",
        FINE,
    )


def circulation_stiffening(folder: Path, rng: Rng) -> Truth:
    stiff = rng.uniform(4.0, 7.0)
    _circulation(folder, rng, stiff=stiff, loggers=(PLAIN, Logger("s", zero=42.0)))
    return Truth(
        f"the arterial tube stiffens: C/(1 + (p - p_fill)/{stiff:.2f} kPa)",
        PHYSICS,
        ("stiffening", "hardening", "nonlinear_compliance", "pressure_dependent_compliance", "stiffening_compliance"),
    )


def circulation_two(folder: Path, rng: Rng) -> Truth:
    stiff, turbulent = rng.uniform(4.0, 7.0), rng.uniform(2e11, 3.2e11)
    _circulation(folder, rng, stiff=stiff, turbulent=turbulent, loggers=(Logger("ms"), Logger("s", zero=-8.0)))
    return Truth(
        f"the arterial tube stiffens, C/(1 + (p - p_fill)/{stiff:.2f} kPa), and the pump loses {turbulent:.2e} "
        "Pa s^2/m^6 q^2",
        PHYSICS,
        (
            *SQUARE,
            "stiffening",
            "hardening",
            "nonlinear_compliance",
            "pressure_dependent_compliance",
            "stiffening_compliance",
        ),
    )


def circulation_water(folder: Path, rng: Rng) -> Truth:
    _circulation(folder, rng, is_water=True, loggers=(PLAIN, Logger("min", zero=1.0)))
    return Truth(
        "the arterial pressure is logged in cmH2O and stated as mmHg, in the first recording", (*RECORDING, *SENSOR)
    )


# --- a drum of compost, aerated and on a mat, FMI 3 Co-Simulation; degC, % oxygen, L/min, W, h; two days, each 5 min
COMPOST = OdeModel(
    "compost",
    {
        "C_heap": (1e5, "J/K"),
        "U": (2.1, "W/K"),
        "c_air": (1210.0, "J/(m^3*K)"),
        "rate": (1.5e-6, "1/s"),
        "T_best": (331.15, "K"),
        "width": (34.0, "K"),
        "half": (0.03, ""),
        "heat": (1.9e7, "J/kg"),
        "need": (0.9, "m^3/kg"),
        "V_gas": (0.045, "m^3"),
        "fresh": (0.209, ""),
        "S_begin": (5.5, "kg"),
        "T_begin": (304.15, "K"),
    },
    {"flow": "m^3/s", "outdoor": "K", "mat": "W"},
    {
        "T": (
            "K",
            "T_begin",
            "(mat + heat*rate*s*o/(half + o)*exp(-(T - T_best)*(T - T_best)/(width*width))"
            " - (U + c_air*flow)*(T - outdoor))/C_heap",
        ),
        "s": ("kg", "S_begin", "-rate*s*o/(half + o)*exp(-(T - T_best)*(T - T_best)/(width*width))"),
        "o": (
            "",
            "fresh",
            "(flow*(fresh - o) - need*rate*s*o/(half + o)*exp(-(T - T_best)*(T - T_best)/(width*width)))/V_gas",
        ),
    },
    {"core": ("K", "T"), "oxygen": ("", "o")},
    10.0,
)
COMPOST_KNOWN = {"C_heap": 0.05, "U": 0.06, "rate": 0.08, "width": 0.03, "heat": 0.04, "need": 0.04, "V_gas": 0.06}


def _compost(
    folder: Path,
    rng: Rng,
    moist: float = 0.0,
    stronger: tuple[float, float, float] | None = None,
    strayed: float = 0.0,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (Logger("h"),),
) -> None:
    """Air may leave with vapour of the heap, `moist` times what saturates it; it enters with half of that outdoors.

    Stronger is begin [s], end [s] and factor of the air in the second recording. `strayed` is by how much [K] the
    start of each recording is off (deviation), which is stated.
    """
    build3(COMPOST, folder, has_exchange=False)
    parts = programme("blower", ("flow", "L/min")) + programme("weather", ("outdoor", "degC"))
    parts += programme("heater", ("mat", "W")) + with_numbers("drum", "compost", "internal")
    names = ("blower.flow", "weather.outdoor", "heater.mat")
    wires = "".join(f"  - {n} -> drum.{n.partition('.')[2]}\n" for n in names)
    scenario(folder, "A drum of compost", 194400.0, 150, 300, parts, wires)
    data_sheet(folder, COMPOST, COMPOST_KNOWN)
    numbers = drawn(rng, COMPOST, COMPOST_KNOWN)
    c_heap, u_wall, c_air, rate, best, width, half, heat, need, v_gas, fresh, s_begin, usual = numbers

    def vapour(kelvin: float) -> float:
        """Of saturated air [kg/m^3]."""
        return float(saturation_pressure(kelvin)) / (VAPOUR * kelvin)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        warm, s, o = (float(w) for w in x)
        flow, outdoor = float(u[0]) / 6e4, float(u[1]) + CELSIUS
        used = rate * s * o / (half + o) * np.exp(-(((warm - best) / width) ** 2))
        drying = EVAPORATION * flow * (moist * vapour(warm) - 0.5 * vapour(outdoor)) if moist else 0.0
        return [
            (float(u[2]) + heat * used - (u_wall + c_air * flow) * (warm - outdoor) - drying) / c_heap,
            -used,
            (flow * (fresh - o) - need * used) / v_gas,
        ]

    for number, (name, stop) in enumerate((("first", 194400.0), ("second", 172800.0), ("third", 180000.0))):
        stated = drawn_steps(rng, stop, 9000.0, 6.0, 60.0, 300.0)
        if name == "third":
            stated = stairs(rng, stop, 7200.0, 8.0, 57.0, 5, 300.0)
        mat = drawn_steps(rng, stop, 14400.0, 0.0, 80.0, 300.0)
        flow = stated
        if stronger is not None and name == "second":
            flow = between(stated, stronger[0], stronger[1], lambda v: stronger[2] * v)
        hours = 0.5 * np.arange(round(stop / 1800.0))
        mean, phase = rng.uniform(8.0, 16.0), rng.uniform(0.0, 24.0)
        day = mean + 5.0 * np.sin(2 * np.pi * (hours - phase) / 24.0) + 0.6 * rng.standard_normal(len(hours))
        outdoor = Steps(tuple(float(v) for v in 3600.0 * hours), tuple(float(v) for v in np.round(day, 1)))
        said = float(f"{rng.uniform(301.0, 309.0):.1f}") if strayed else usual
        begin = said + strayed * float(rng.normal())
        t, x = integrated(rates, (begin, s_begin, fresh), (flow, outdoor, mat), stop, 60.0)
        sensors = [
            Sensor("drum.core", "Kerntemperatur", "degC", celsius(0), 0.15, 300.0, noise_stated, 0.1, colour),
            Sensor("drum.oxygen", "O2_Vol%", "%", scaled(2, 100.0), 0.15, 300.0, noise_stated, 0.1, colour),
        ]
        sidecar: dict[str, Any] = {}
        if strayed:
            sidecar["components"] = {"drum": {"parameters": {"T_begin": f"{said:.1f} K"}}}
            sidecar["uncertain"] = {"drum.T_begin": f"{strayed:g} K"}
        made = Written(
            t,
            x,
            sensors,
            {"blower.flow": (flow, "L/min"), "weather.outdoor": (outdoor, "degC"), "heater.mat": (mat, "W")},
            loggers[number % len(loggers)],
            recorded=["weather.outdoor"],
            sidecar=sidecar,
            told={} if flow is stated else {"blower.flow": stated},
        )
        write(folder / name, rng, made)


def compost_null(folder: Path, rng: Rng) -> Truth:
    loggers = (
        Logger("h", zero=9.75, is_comma=True, empty=0.03),
        Logger("min", zero=-15.0, is_comma=True),
    )
    _compost(folder, rng, strayed=1.5, noise_stated=1.25, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, a start of each recording is stated that is off by 1.5 K (deviation), which "
        "is stated too; noise stated 1.25 times too large, decimal commas, empty cells, minutes from -15",
        FINE,
    )


def compost_evaporation(folder: Path, rng: Rng) -> Truth:
    moist = rng.uniform(0.4, 0.65)
    _compost(folder, rng, moist=moist, loggers=(Logger("h"), Logger("h", zero=30.0)))
    return Truth(
        f"air leaves with vapour of the heap, {moist:.3f} times what saturates it",
        PHYSICS,
        ("evaporation", "evaporative_cooling", "latent_heat", "vapour", "drying"),
    )


def compost_blower(folder: Path, rng: Rng) -> Truth:
    begin, factor = 1800.0 * round(rng.uniform(24.0, 54.0)), rng.uniform(1.25, 1.45)
    _compost(folder, rng, stronger=(begin, begin + 43200.0, factor), loggers=(Logger("min"), Logger("h", zero=0.25)))
    return Truth(
        f"the blower gave {factor:.3f} times the air that is stated, {begin / 3600.0:g} h to "
        f"{begin / 3600.0 + 12.0:g} h of the second recording",
        SENSOR,
        ("input_fault",),
    )


# --- a seat (FMI 2, Model Exchange) on a magnetorheological damper (FMI 3, Co-Simulation); V, N, mm; two clocks
SEAT = OdeModel(
    "seat",
    {"m": (95.0, "kg"), "k": (5200.0, "N/m")},
    {"push": "N", "braking": "N"},
    {"x": ("m", "0.0", "v"), "v": ("m/s", "0.0", "(push - k*x - braking)/m")},
    {"rise": ("m", "x"), "speed": ("m/s", "v")},
    1e-3,
)
DAMPER = OdeModel(
    "mr_damper",
    {
        "L": (0.09, "H"),
        "R": (4.8, "ohm"),
        "c_0": (260.0, "N*s/m"),
        "c_1": (110.0, "N*s/(m*A)"),
        "grip": (60.0, "N/A"),
        "v_yield": (0.06, "m/s"),
    },
    {"u": "V", "speed": "m/s"},
    {"i": ("A", "0.0", "(u - R*i)/L")},
    {"force": ("N", "c_0*speed + (c_1*speed + grip*tanh(speed/v_yield))*i")},
    1e-3,
)
SEAT_KNOWN = {"m": 0.03, "k": 0.04}
DAMPER_KNOWN = {"L": 0.08, "R": 0.04, "c_0": 0.06, "c_1": 0.08, "grip": 0.06, "v_yield": 0.08}


def _seat(
    folder: Path,
    rng: Rng,
    bump: tuple[float, float] | None = None,
    is_reversed: bool = False,
    noise_stated: float | None = 1.0,
    clock: tuple[str, float] | None = None,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Two FMUs; rubber may stop the seat, stiffness [N/m] past a way [m] up and down.

    The load cell may be wired the wrong way round in the second recording.
    """
    SEAT.build(folder)
    build3(DAMPER, folder, has_exchange=False)
    data_sheet(folder, DAMPER, DAMPER_KNOWN)
    (folder / "numbers.yaml").rename(folder / "fluid.yaml")
    data_sheet(folder, SEAT, SEAT_KNOWN)
    parts = (
        programme("driver", ("u", "V"))
        + programme("shaker", ("push", "N"))
        + with_numbers("seat", "seat")
        + with_numbers("damper", "mr_damper", "internal").replace("numbers.yaml", "fluid.yaml")
    )
    wires = (
        "  - driver.u -> damper.u\n  - shaker.push -> seat.push\n  - seat.speed -> damper.speed\n"
        "  - damper.force -> seat.braking\n"
    )
    scenario(folder, "A seat on a magnetorheological damper", 14.0, 5e-3, 1e-2, parts, wires)
    m, k = drawn(rng, SEAT, SEAT_KNOWN)
    inductance, r, c_0, c_1, grip, v_yield = drawn(rng, DAMPER, DAMPER_KNOWN)
    k_stop, way = bump or (0.0, 1.0)

    def force(x: Array) -> Array:
        v, i = x[..., 1], x[..., 2]
        return np.asarray(c_0 * v + (c_1 * v + grip * np.tanh(v / v_yield)) * i)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        s, v, i = (float(w) for w in x)
        stopped = k_stop * (max(s - way, 0.0) + min(s + way, 0.0))
        return [v, (float(u[1]) - k * s - stopped - float(force(x))) / m, (float(u[0]) - r * i) / inductance]

    for number, (name, stop) in enumerate((("first", 14.0), ("second", 11.0), ("third", 12.0))):
        u = drawn_steps(rng, stop, 0.9, 0.0, 7.0, 0.01)
        push = drawn_steps(rng, stop, 0.55, -180.0, 180.0, 0.01)
        if name == "third":
            push = telegraph(rng, stop, 0.5, -140.0, 140.0, 0.01)
        t, x = integrated(rates, (0.0, 0.0, 0.0), (u, push), stop, 2e-3)
        sign = -1.0 if is_reversed and name == "second" else 1.0
        sensors = [
            Sensor("seat.rise", "LVDT", "mm", scaled(0, 1e3), 0.5, 0.01, noise_stated, 0.1),
            Sensor(
                "damper.force",
                "F_cell",
                "N",
                lambda t, x, u, sign=sign: sign * force(x),  # type: ignore[misc]
                4.0,
                0.02,
                noise_stated,
                1.0,
            ),
        ]
        programmes = {"driver.u": (u, "V"), "shaker.push": (push, "N")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))
        if clock is not None:
            second_clock(folder / name, clock[0], clock[1] + 4400.0 * number)


def seat_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=-2.0), Logger("ms", zero=640.0, empty=0.01), Logger("s", jitter=0.2))
    _seat(folder, rng, noise_stated=1.15, clock=("ms", 123400.0), loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, two FMUs, noise stated 1.15 times too large, empty cells, jitter, the load "
        "cell is of a logger with another rate and a clock of its own, in ms from 123400",
        FINE,
    )


def seat_bump(folder: Path, rng: Rng) -> Truth:
    k_stop, way = rng.uniform(3000.0, 5000.0), rng.uniform(0.016, 0.021)
    _seat(folder, rng, bump=(k_stop, way), loggers=(Logger("ms"), PLAIN))
    return Truth(
        f"rubber stops the seat past {1e3 * way:.1f} mm up and down, {1e-3 * k_stop:.2f} N/mm",
        PHYSICS,
        (
            "end_stop",
            "bump_stop",
            "stop",
            "hardening",
            "hardening_spring",
            "cubic_spring",
            "cubic_stiffness",
            "nonlinear_spring",
            "dead_zone",
            "threshold",
        ),
    )


def seat_sign(folder: Path, rng: Rng) -> Truth:
    _seat(folder, rng, is_reversed=True, loggers=(PLAIN, Logger("s", zero=55.0)))
    return Truth("the load cell is wired the wrong way round in the second recording", (*RECORDING, *SENSOR))


# --- an electrochromic film between two electrodes, FMI 3, both interfaces, without units; mA, % of light
FILM = OdeModel(
    "film",
    {
        "R": (22.0, ""),
        "C_layer": (0.06, ""),
        "R_insert": (55.0, ""),
        "C_film": (0.5, ""),
        "clear": (74.0, ""),
        "eta": (1.7, ""),
        "q_begin": (0.1, ""),
    },
    {"u": ""},
    {
        "e": ("", "q_begin/C_film", "((u - e)/R - (e - q/C_film)/R_insert)/C_layer"),
        "q": ("", "q_begin", "(e - q/C_film)/R_insert"),
    },
    {"current": ("", "1000.0*(u - e)/R"), "light": ("", "clear*exp(-eta*q)")},
    0.05,
)
FILM_KNOWN = {"R": 0.04, "C_layer": 0.08, "R_insert": 0.06, "C_film": 0.05, "clear": 0.02, "eta": 0.04}


def _film(
    folder: Path,
    rng: Rng,
    bleaching: float = 0.0,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    quantum: float = 0.1,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Charge of the film may leak away, `bleaching` 1/s. The voltage changes between two readings."""
    build3(FILM, folder)
    parts = programme("potentiostat", ("u", "")) + with_numbers("film", "film")
    scenario(folder, "A tinted film", 1500.0, 1, 2, parts, "  - potentiostat.u -> film.u\n")
    data_sheet(folder, FILM, FILM_KNOWN)
    r, c_layer, r_insert, c_film, clear, eta, q_begin = drawn(rng, FILM, FILM_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        e, q = (float(s) for s in x)
        inward = (e - q / c_film) / r_insert
        return [((float(u[0]) - e) / r - inward) / c_layer, inward - bleaching * q]

    for number, (name, stop) in enumerate((("first", 1500.0), ("second", 1200.0), ("third", 1300.0))):
        u = drawn_steps(rng, stop, 40.0, 0.0, 1.5, 2.0)
        if name == "third":
            u = wandering(rng, stop, 30.0, 0.0, 1.5, 2.0)
        u = Steps((0.0, *(t + 1.0 for t in u.times[1:])), u.levels)
        t, x = integrated(rates, (q_begin / c_film, q_begin), (u,), stop, 0.5)
        sensors = [
            Sensor(
                "film.current",
                "<I>/mA",
                "1",
                lambda t, x, u: 1e3 * (u[:, 0] - x[:, 0]) / r,
                0.12,
                2.0,
                noise_stated,
                0.02,
                colour,
            ),
            Sensor(
                "film.light",
                "T550",
                "1",
                lambda t, x, u: clear * np.exp(-eta * x[:, 1]),
                0.25,
                2.0,
                noise_stated,
                quantum,
                colour,
            ),
        ]
        write(folder / name, rng, Written(t, x, sensors, {"potentiostat.u": (u, "")}, loggers[number % len(loggers)]))


def film_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=11.0, is_comma=True), Logger("s", zero=-30.0, is_comma=True, empty=0.02))
    _film(folder, rng, noise_stated=None, quantum=1.0, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, no units, noise is not stated, a coarse converter of the light, decimal "
        "commas, minutes from 11, seconds from -30, empty cells",
        FINE,
    )


def film_bleaching(folder: Path, rng: Rng) -> Truth:
    bleaching = rng.uniform(2e-3, 3.6e-3)
    _film(folder, rng, bleaching=bleaching, loggers=(PLAIN, Logger("min")))
    return Truth(
        f"charge of the film leaks away, {bleaching:.2e} 1/s of it", PHYSICS, (*LEAKING, "self_discharge", "decay")
    )


def film_clock(folder: Path, rng: Rng) -> Truth:
    fast = rng.uniform(0.02, 0.035)
    _film(folder, rng, loggers=(Logger("s", zero=5.0), Logger("s", rate=1.0 + fast), Logger("min")))
    return Truth(f"the logger's clock runs {100 * fast:.2f} % fast in the second recording", RECORDING)


# --- two shafts that magnets couple through a wall, FMI 2 Model Exchange; rpm, deg, N m; two rates
COUPLING = OdeModel(
    "coupling",
    {
        "J_drive": (5e-3, "kg*m^2"),
        "J_load": (1e-2, "kg*m^2"),
        "b_drive": (3e-3, "N*m*s/rad"),
        "b_load": (2.5e-3, "N*m*s/rad"),
        "T_pull": (1.1, "N*m"),
        "pairs": (3.0, ""),
        "d_wall": (0.02, "N*m*s/rad"),
        "w_begin": (0.0, "rad/s"),
    },
    {"torque": "N*m", "brake": "N*m"},
    {
        "twist": ("rad", "0.0", "w_d - w_l"),
        "w_d": (
            "rad/s",
            "w_begin",
            "(torque - b_drive*w_d - T_pull*sin(pairs*twist) - d_wall*(w_d - w_l))/J_drive",
        ),
        "w_l": (
            "rad/s",
            "w_begin",
            "(T_pull*sin(pairs*twist) + d_wall*(w_d - w_l) - b_load*w_l - brake)/J_load",
        ),
    },
    {"drive": ("rad/s", "w_d"), "load": ("rad/s", "w_l"), "angle": ("rad", "twist")},
    1e-3,
)
COUPLING_KNOWN = {
    "J_drive": 0.04,
    "J_load": 0.05,
    "b_drive": 0.08,
    "b_load": 0.08,
    "T_pull": 0.04,
    "d_wall": 0.1,
}


def _coupling(
    folder: Path,
    rng: Rng,
    drag: float = 0.0,
    turning: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """A paddle on the driven shaft may be dragged, drag w^2 [N m s^2].

    Both shafts may turn already at the begin of the second recording [rpm].
    """
    COUPLING.build(folder)
    parts = programme("motor", ("torque", "N*m")) + programme("eddy", ("brake", "N*m"))
    parts += with_numbers("shafts", "coupling")
    wires = "  - motor.torque -> shafts.torque\n  - eddy.brake -> shafts.brake\n"
    scenario(folder, "A magnetic coupling", 40.0, 0.02, 0.02, parts, wires)
    data_sheet(folder, COUPLING, COUPLING_KNOWN)
    j_drive, j_load, b_drive, b_load, pull, pairs, wall, _ = drawn(rng, COUPLING, COUPLING_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        twist, drive, load = (float(s) for s in x)
        across = pull * np.sin(pairs * twist) + wall * (drive - load)
        return [
            drive - load,
            (float(u[0]) - b_drive * drive - across) / j_drive,
            (across - b_load * load - drag * load * abs(load) - float(u[1])) / j_load,
        ]

    for number, (name, stop) in enumerate((("first", 40.0), ("second", 34.0), ("third", 36.0))):
        torque = drawn_steps(rng, stop, 1.2, -0.3, 0.45, 0.02)
        if name == "third":
            torque = wandering(rng, stop, 0.9, -0.3, 0.45, 0.02)
        brake = drawn_steps(rng, stop, 1.9, -0.08, 0.12, 0.02)
        begin = turning / RPM if name == "second" else 0.0
        t, x = integrated(rates, (0.0, begin, begin), (torque, brake), stop, 5e-3)
        sensors = [
            Sensor("shafts.drive", "n1 (1/min)", "rpm", scaled(1, RPM), 2.5, 0.02, noise_stated, 0.5),
            Sensor("shafts.load", "n2 (1/min)", "rpm", scaled(2, RPM), 2.5, 0.02, noise_stated, 0.5),
            Sensor("shafts.angle", "torsion_deg", "deg", scaled(0, DEGREES), 0.2, 0.05, noise_stated, 0.05),
        ]
        programmes = {"motor.torque": (torque, "N*m"), "eddy.brake": (brake, "N*m")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def coupling_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=9000.0, empty=0.01), Logger("s", gap=(14.0, 18.5)), Logger("s", zero=-4.0, jitter=0.3))
    _coupling(folder, rng, noise_stated=None, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, a gap of 4.5 s, jitter, empty cells, two rates, three "
        "loggers",
        FINE,
    )


def coupling_drag(folder: Path, rng: Rng) -> Truth:
    drag = rng.uniform(5e-5, 9e-5)
    _coupling(folder, rng, drag=drag, loggers=(PLAIN, Logger("ms", zero=70.0)))
    return Truth(f"water drags at a paddle on the driven shaft, {drag:.2e} N m s^2 w^2", PHYSICS, SQUARE)


def coupling_start(folder: Path, rng: Rng) -> Truth:
    turning = float(rng.choice([-1.0, 1.0])) * rng.uniform(110.0, 220.0)
    _coupling(folder, rng, turning=turning, loggers=(Logger("s", zero=1.5), PLAIN))
    return Truth(
        f"both shafts turn with {turning:.0f} rpm at the begin of the second recording and are said to rest",
        (*RECORDING, *SENSOR),
    )


# --- a ribbon of liquid-crystal elastomer under a lamp lifts a load, FMI 2 Model Exchange; W, %, K and mm
RIBBON = OdeModel(
    "ribbon",
    {
        "C": (0.5, "J/K"),
        "absorbed": (0.12, ""),
        "h_still": (0.014, "W/K"),
        "h_fan": (0.012, "W/K"),
        "T_room": (295.65, "K"),
        "T_turn": (349.15, "K"),
        "spread": (9.0, "K"),
        "stroke": (0.02, "m"),
        "soft": (2.4e-3, "m/N"),
        "tau": (2.2, "s"),
    },
    {"light": "W", "fan": "", "load": "N"},
    {
        "T": ("K", "T_room", "(absorbed*light - (h_still + h_fan*fan)*(T - T_room))/C"),
        "x": ("m", "0.0", "(stroke/(1.0 + exp((T_turn - T)/spread)) - soft*load - x)/tau"),
    },
    {"surface": ("K", "T"), "lift": ("m", "x")},
    0.02,
)
RIBBON_KNOWN = {
    "C": 0.05,
    "absorbed": 0.04,
    "h_still": 0.05,
    "h_fan": 0.08,
    "T_turn": 0.004,
    "spread": 0.06,
    "stroke": 0.03,
    "soft": 0.05,
    "tau": 0.08,
}


def _ribbon(
    folder: Path,
    rng: Rng,
    latent: tuple[float, float] | None = None,
    share: float = 0.0,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Order that melts may take up heat: C (1 + latent exp(-((T - T_turn)/width)^2)), latent and width [K].

    The camera may have a smaller range in the second recording: it ends at what is exceeded for a `share` of the time.
    """
    RIBBON.build(folder)
    parts = programme("lamp", ("light", "W")) + programme("cooler", ("fan", "'%'")).replace("0 '%'", "0 %")
    parts += programme("weights", ("load", "N")) + with_numbers("ribbon", "ribbon")
    names = ("lamp.light", "cooler.fan", "weights.load")
    wires = "".join(f"  - {n} -> ribbon.{n.partition('.')[2]}\n" for n in names)
    scenario(folder, "A ribbon under a lamp", 900.0, 0.5, 1, parts, wires)
    data_sheet(folder, RIBBON, RIBBON_KNOWN)
    c, absorbed, h_still, h_fan, room, turn, spread, stroke, soft, tau = drawn(rng, RIBBON, RIBBON_KNOWN)
    taken, width = latent or (0.0, 1.0)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Lift is in mm."""
        warm, lift = (float(s) for s in x)
        heating = absorbed * float(u[0]) - (h_still + h_fan * 0.01 * float(u[1])) * (warm - room)
        still = 1e3 * (stroke / (1.0 + np.exp((turn - warm) / spread)) - soft * float(u[2]))
        return [heating / (c * (1.0 + taken * np.exp(-(((warm - turn) / width) ** 2)))), (still - lift) / tau]

    for number, (name, stop) in enumerate((("first", 900.0), ("second", 700.0), ("third", 800.0))):
        light = drawn_steps(rng, stop, 32.0, 0.0, 14.0, 1.0)
        if name == "third":
            light = stairs(rng, stop, 24.0, 0.5, 13.5, 6, 1.0)
        fan = bursts(rng, stop, 60.0, 35.0, 20.0, 100.0, 1.0)
        load = drawn_steps(rng, stop, 75.0, 0.0, 2.0, 1.0)
        t, x = integrated(rates, (room, 0.0), (light, fan, load), stop, 0.25)
        limit = float(f"{np.quantile(x[:, 0], 1.0 - share):.1f}") if share and name == "second" else np.inf

        def spoil(column: str, t: Array, v: Array, limit: float = limit) -> Array:
            return np.minimum(v, limit) if column == "IR mean (K)" else v

        sensors = [
            Sensor("ribbon.surface", "IR mean (K)", "K", scaled(0, 1.0), 0.4, 1.0, noise_stated, 0.1, wild=wild),
            Sensor("ribbon.lift", "laser", "mm", scaled(1, 1.0), 0.12, 1.0, noise_stated, 0.02, wild=wild),
        ]
        programmes = {"lamp.light": (light, "W"), "cooler.fan": (fan, "%"), "weights.load": (load, "N")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)], spoil=spoil))


def ribbon_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=25.0), Logger("s", zero=10.0, gap=(330.0, 420.0), empty=0.02))
    _ribbon(folder, rng, wild=0.01, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, wild readings, a temperature in K, a gap of 90 s, empty cells",
        FINE,
    )


def ribbon_latent(folder: Path, rng: Rng) -> Truth:
    taken, width = rng.uniform(0.7, 1.1), rng.uniform(6.0, 9.0)
    _ribbon(folder, rng, latent=(taken, width), loggers=(PLAIN, Logger("s", zero=120.0)))
    return Truth(
        f"order that melts takes up heat: C (1 + {taken:.3f} exp(-((T - T_turn)/{width:.2f} K)^2))",
        PHYSICS,
        ("latent_heat", "phase_change", "melting", "heat_capacity_of_temperature", "temperature_dependent_capacity"),
    )


def ribbon_saturated(folder: Path, rng: Rng) -> Truth:
    share = rng.uniform(0.15, 0.25)
    _ribbon(folder, rng, share=share, loggers=(Logger("s"), Logger("min", zero=0.5)))
    return Truth(
        f"the camera ends at what {100 * share:.0f} % of the second recording exceed, which is not stated",
        SENSOR,
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    vine_friction,
    chip_null,
    circulation_water,
    compost_evaporation,
    seat_null,
    film_clock,
    coupling_drag,
    ribbon_saturated,
    circulation_null,
    chip_rim,
    vine_two,
    compost_blower,
    seat_bump,
    film_null,
    coupling_start,
    ribbon_latent,
    vine_stuck,
    chip_other_run,
    compost_null,
    circulation_two,
    seat_sign,
    film_bleaching,
    coupling_null,
    ribbon_null,
    circulation_stiffening,
)
