"""Twenty-first set: a knee brace, a welding horn, desizing, a weaving shed, a yarn jet, resin, a reaction wheel, ink.

Written without a look at the library of laws, its proof, its tests or its thresholds, and without a diagnosis of any of
its cases; of the earlier sets, the author had read two and the helpers that these take from the others. Truths are
integrated by scipy from equations that stand here. How large an effect is, and how far the numbers are off, is drawn;
the deviations of the numbers are those that a parameter set states. Recordings of a rig differ in length and in logger;
the one that is held out was partly made with a programme of another kind, within the range of the others.
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
from evaluation.strangers.sixteenth_set import later
from evaluation.strangers.tenth_set import stairs, swept
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.thirteenth_set import wandering
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth

#: Heat of evaporation of water [J/kg]; heat capacity [J/kg/K] and density [kg/m^3] of air.
EVAPORATION, AIR, DENSITY = 2.45e6, 1006.0, 1.15
#: Laws that are true where something is stored of which the model knows nothing.
STORED = ("hidden_state", "hidden_mass", "hidden_capacity", "second_mass")
#: Laws that are true where a spring becomes stiffer.
HARDENING = ("cubic_spring", "cubic_stiffness", "hardening", "hardening_spring", "nonlinear_spring", "stiffening")
#: Laws that are true where a rate depends on what there is of something.
RATED = ("reaction_order", "nonlinear_rate", "rate_of_state", "state_dependent_rate")
#: Laws that are true where a drag rises with the square of a speed.
DRAGGED = ("nonlinear_damping", "quadratic_damping", "quadratic_drag", "air_drag")


# --- a knee brace with a motor behind a spring, on a dummy, FMI 2 Model Exchange; ms, A, N m, deg
KNEE = OdeModel(
    "knee_brace",
    {
        "k_t": (2.2, "N*m/A"),
        "J": (0.08, "kg*m^2"),
        "d_m": (0.7, "N*m*s/rad"),
        "k": (60.0, "N*m/rad"),
        "I": (0.35, "kg*m^2"),
        "d": (1.0, "N*m*s/rad"),
        "G": (9.0, "N*m"),
    },
    {"current": "A", "push": "N*m"},
    {
        "turned": ("rad", "0.0", "w"),
        "w": ("rad/s", "0.0", "(k_t*current - d_m*w - k*(turned - bend))/J"),
        "bend": ("rad", "0.0", "v"),
        "v": ("rad/s", "0.0", "(k*(turned - bend) - d*v - G*sin(bend) + push)/I"),
    },
    {"gear": ("rad", "turned"), "joint": ("rad", "bend"), "torque": ("N*m", "k*(turned - bend)")},
    1e-3,
)
KNEE_KNOWN = {"k_t": 0.04, "J": 0.06, "d_m": 0.1, "k": 0.05, "I": 0.05, "d": 0.1, "G": 0.04}


def _knee(
    folder: Path,
    rng: Rng,
    harder: float = np.inf,
    share: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """The spring may become stiffer, k s (1 + (s/harder)^2), `harder` in rad.

    The torque cell may end both ways, in the second recording, at what is exceeded for a `share` of the time.
    """
    KNEE.build(folder)
    parts = programme("driver", ("current", "A")) + programme("hand", ("push", "N*m"))
    parts += with_numbers("brace", "knee_brace")
    wires = "  - driver.current -> brace.current\n  - hand.push -> brace.push\n"
    scenario(folder, "A knee brace with a spring", 26.0, 0.01, 0.02, parts, wires)
    data_sheet(folder, KNEE, KNEE_KNOWN)
    k_t, rotor, d_m, k, shank, d, hanging = drawn(rng, KNEE, KNEE_KNOWN)

    def torque(x: Array) -> Array:
        """In the spring [N m]."""
        s = x[..., 0] - x[..., 2]
        return np.asarray(k * s * (1.0 + (s / harder) ** 2))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        _, w, bend, v = (float(s) for s in x)
        carried = float(torque(x))
        return [
            w,
            (k_t * float(u[0]) - d_m * w - carried) / rotor,
            v,
            (carried - d * v - hanging * np.sin(bend) + float(u[1])) / shank,
        ]

    for number, (name, stop) in enumerate((("first", 26.0), ("second", 20.0), ("third", 23.0))):
        current = drawn_steps(rng, stop, 0.7, -2.4, 2.4, 0.02)
        if name == "third":
            current = swept(stop, -2.1, 2.1, 3.0, 0.7, 0.04)
        push = bursts(rng, stop, 1.2, 0.6, -4.0, 4.0, 0.02)
        current, push = later(current, 0.01), later(push, 0.01)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0), (current, push), stop, 5e-3)
        end = np.inf
        if share and name == "second":
            end = float(f"{np.quantile(np.abs(torque(x)), 1.0 - share):.1f}")

        def spoil(column: str, t: Array, v: Array, end: float = end) -> Array:
            return np.clip(v, -end, end) if column == "M Feder" else v

        sensors = [
            Sensor("brace.gear", "enc Motor deg", "deg", scaled(0, DEGREES), 0.1, 0.02, noise_stated, 0.05),
            Sensor("brace.joint", "enc Knie deg", "deg", scaled(2, DEGREES), 0.1, 0.02, noise_stated, 0.05),
            Sensor("brace.torque", "M Feder", "N*m", lambda t, x, u: torque(x), 0.06, 0.02, noise_stated, 0.01),
        ]
        programmes = {"driver.current": (current, "A"), "hand.push": (push, "N*m")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)], spoil=spoil))


def knee_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=1.5e4, gap=(9.0, 11.0)), Logger("s", zero=-3.0, empty=0.03), Logger("min", jitter=0.1))
    _knee(folder, rng, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated rightly, a gap of 2 s, empty cells, jitter, three loggers of ms, "
        "s and min",
        FINE,
    )


def knee_hardened(folder: Path, rng: Rng) -> Truth:
    harder = rng.uniform(0.14, 0.2)
    _knee(folder, rng, harder=harder, loggers=(Logger("s", zero=1.0), Logger("ms")))
    return Truth(
        f"the spring becomes stiffer, the more it is bent: k s (1 + (s/{harder:.4f} rad)^2)", PHYSICS, HARDENING
    )


def knee_clipped(folder: Path, rng: Rng) -> Truth:
    share = rng.uniform(0.1, 0.16)
    _knee(folder, rng, share=share, loggers=(Logger("ms", zero=-900.0), PLAIN))
    return Truth(
        f"the torque cell ends, both ways, at what {100 * share:.0f} % of the second recording exceed, which is not "
        "stated",
        SENSOR,
    )


# --- a horn that welds cloth with ultrasound, in phase and in quadrature, FMI 3 Model Exchange; ms, V, Hz, N, mA, degC
HORN = OdeModel(
    "welding_horn",
    {
        "R": (60.0, "ohm"),
        "r_p": (0.3, "ohm/N"),
        "L": (0.12, "H"),
        "f_r": (40.0, "Hz"),
        "C": (12.0, "J/K"),
        "g": (2.5, "W/K"),
        "T_begin": (298.15, "K"),
    },
    {"volts": "V", "shift": "Hz", "press": "N"},
    {
        "a": ("A", "0.0", "0.5*(volts - (R + r_p*press)*a)/L + 6.283185307179586*(shift - f_r)*b"),
        "b": ("A", "0.0", "-0.5*(R + r_p*press)*b/L - 6.283185307179586*(shift - f_r)*a"),
        "T": ("K", "T_begin", "(0.5*R*(a*a + b*b) - g*(T - T_begin))/C"),
    },
    {"cosine": ("A", "a"), "sine": ("A", "b"), "warm": ("K", "T")},
    2.5e-4,
)
HORN_KNOWN = {"R": 0.05, "r_p": 0.06, "L": 0.04, "f_r": 0.1, "C": 0.06, "g": 0.08}


def _horn(
    folder: Path,
    rng: Rng,
    falls: float = 0.0,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """The resonance may fall as the horn warms, f_r - falls (T - T_begin), falls in Hz/K.

    The second recording may be said to have had the frequency of another run.
    """
    build3(HORN, folder, has_co_simulation=False)
    parts = programme("generator", ("volts", "V"), ("shift", "Hz")) + programme("anvil", ("press", "N"))
    parts += with_numbers("horn", "welding_horn")
    wires = "  - generator.volts -> horn.volts\n  - generator.shift -> horn.shift\n  - anvil.press -> horn.press\n"
    scenario(folder, "A horn that welds cloth", 9.0, 2.5e-3, 5e-3, parts, wires)
    data_sheet(folder, HORN, HORN_KNOWN)
    r, r_p, inductance, f_r, c, g, begin = drawn(rng, HORN, HORN_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        a, b, warm = (float(s) for s in x)
        lost = r + r_p * float(u[2])
        off = 2.0 * np.pi * (float(u[1]) - f_r + falls * (warm - begin))
        return [
            0.5 * (float(u[0]) - lost * a) / inductance + off * b,
            -0.5 * lost * b / inductance - off * a,
            (0.5 * r * (a * a + b * b) - g * (warm - begin)) / c,
        ]

    other = later(drawn_steps(rng, 7.5, 0.17, -60.0, 140.0, 5e-3), 2.5e-3)
    for number, (name, stop) in enumerate((("first", 9.0), ("second", 7.5), ("third", 8.2))):
        volts = drawn_steps(rng, stop, 0.25, 40.0, 240.0, 5e-3)
        shift = drawn_steps(rng, stop, 0.17, -60.0, 140.0, 5e-3)
        if name == "third":
            shift = swept(stop, -50.0, 130.0, 2.4, 0.6, 0.02)
        press = drawn_steps(rng, stop, 0.6, 20.0, 300.0, 5e-3)
        volts, shift, press = later(volts, 2.5e-3), later(shift, 2.5e-3), later(press, 2.5e-3)
        t, x = integrated(rates, (0.0, 0.0, begin), (volts, shift, press), stop, 1.25e-3)
        sensors = [
            Sensor("horn.cosine", "lock-in X mA", "mA", scaled(0, 1e3), 12.0, 5e-3, noise_stated, 2.0),
            Sensor("horn.sine", "lock-in Y mA", "mA", scaled(1, 1e3), 12.0, 5e-3, noise_stated, 2.0),
            Sensor("horn.warm", "TC Horn", "degC", celsius(2), 0.15, 0.02, noise_stated, 0.05),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"generator.volts": (volts, "V"), "generator.shift": (shift, "Hz"), "anvil.press": (press, "N")},
            loggers[number % len(loggers)],
            told={"generator.shift": other} if is_other and name == "second" else {},
        )
        write(folder / name, rng, made)


def horn_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=333.0), Logger("s", zero=-0.5, gap=(3.2, 3.9)), Logger("ms", empty=0.02))
    _horn(folder, rng, noise_stated=None, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, two rates, a gap of 0.7 s, empty cells, three loggers of "
        "ms and s",
        FINE,
    )


def horn_warmed(folder: Path, rng: Rng) -> Truth:
    falls = rng.uniform(1.4, 2.4)
    _horn(folder, rng, falls=falls, loggers=(Logger("ms"), Logger("s", zero=7.0)))
    return Truth(f"the resonance falls as the horn warms, by {falls:.3f} Hz/K (T - T_begin)", PHYSICS)


def horn_other_run(folder: Path, rng: Rng) -> Truth:
    _horn(folder, rng, is_other=True, loggers=(Logger("s", zero=2.0), Logger("ms")))
    return Truth("the second recording is said to have had the frequency of another run", (*RECORDING, *SENSOR))


# --- a bath in which an enzyme takes size off warps, FMI 2 Co-Simulation; h, min, mL/min, g/L; degC is a column
DESIZING = OdeModel(
    "desizing",
    {
        "V": (0.02, "m^3"),
        "S_f": (60.0, "kg/m^3"),
        "E_f": (2.0, "kg/m^3"),
        "k": (0.2, "1/s"),
        "K": (10.0, "kg/m^3"),
        "a": (0.04, "1/K"),
        "k_d": (1e-4, "1/s"),
        "b": (0.06, "1/K"),
        "y": (1.05, ""),
        "S_begin": (20.0, "kg/m^3"),
        "P_begin": (35.0, "kg/m^3"),
        "E_begin": (0.06, "kg/m^3"),
    },
    {"slurry": "m^3/s", "rinse": "m^3/s", "dose": "m^3/s", "warmth": "K"},
    {
        "S": (
            "kg/m^3",
            "S_begin",
            "(slurry*(S_f - S) - (rinse + dose)*S)/V - k*exp(a*(warmth - 323.15))*E*S/(K + S)",
        ),
        "P": (
            "kg/m^3",
            "P_begin",
            "y*k*exp(a*(warmth - 323.15))*E*S/(K + S) - (slurry + rinse + dose)*P/V",
        ),
        "E": ("kg/m^3", "E_begin", "(dose*(E_f - E) - (slurry + rinse)*E)/V - k_d*exp(b*(warmth - 323.15))*E"),
    },
    {"starch": ("kg/m^3", "S"), "sugar": ("kg/m^3", "P")},
    5.0,
)
DESIZING_KNOWN = {
    "V": 0.02,
    "S_f": 0.02,
    "E_f": 0.04,
    "k": 0.06,
    "K": 0.08,
    "a": 0.08,
    "k_d": 0.1,
    "b": 0.1,
    "y": 0.02,
}


def _desizing(
    folder: Path,
    rng: Rng,
    hinders: float = np.inf,
    missing: float = 0.0,
    strayed: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> None:
    """Sugar may hinder the enzyme, K (1 + P/hinders), `hinders` in g/L.

    At the begin of the second recording, a share of the enzyme may be missing. `strayed` is by how much [g/L] the
    starch at each begin is off (deviation), which is stated.
    """
    DESIZING.build(folder)
    pumps = (("pump_1", "slurry"), ("pump_2", "rinse"), ("pump_3", "dose"))
    names = (*((c, n, "mL/min") for c, n in pumps), ("jacket", "warmth", "degC"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("bath", "desizing", "internal")
    wires = "".join(f"  - {c}.{n} -> bath.{n}\n" for c, n, _ in names)
    scenario(folder, "A bath that takes size off warps", 36000.0, 15, 30, parts, wires)
    data_sheet(folder, DESIZING, DESIZING_KNOWN)
    numbers = drawn(rng, DESIZING, DESIZING_KNOWN)
    volume, s_f, e_f, k, half, a, k_d, b, y, s_begin, p_begin, e_begin = numbers

    def rates(t: float, x: Array, u: Array) -> list[float]:
        starch, sugar, enzyme = (float(s) for s in x)
        slurry, rinse, dose = (float(v) / 6e7 / volume for v in u[:3])
        warm = float(u[3]) + CELSIUS - 323.15
        cut = k * np.exp(a * warm) * enzyme * starch / (half * (1.0 + sugar / hinders) + starch)
        return [
            slurry * (s_f - starch) - (rinse + dose) * starch - cut,
            y * cut - (slurry + rinse + dose) * sugar,
            dose * (e_f - enzyme) - (slurry + rinse) * enzyme - k_d * np.exp(b * warm) * enzyme,
        ]

    for number, (name, stop) in enumerate((("first", 36000.0), ("second", 30000.0), ("third", 33000.0))):
        slurry = drawn_steps(rng, stop, 1800.0, 80.0, 380.0, 30.0)
        if name == "third":
            slurry = wandering(rng, stop, 1500.0, 90.0, 370.0, 30.0)
        rinse = drawn_steps(rng, stop, 2600.0, 0.0, 320.0, 30.0)
        dose = drawn_steps(rng, stop, 1400.0, 4.0, 30.0, 30.0)
        slurry, rinse, dose = later(slurry, 15.0), later(rinse, 15.0), later(dose, 15.0)
        warmth = ramped(rng, stop, 5400.0, 45.0, 58.0, 120.0)
        said = float(f"{s_begin + rng.uniform(-4.0, 6.0):.3g}") if strayed else s_begin
        left = e_begin * (1.0 - (missing if name == "second" else 0.0))
        start = (said + strayed * float(rng.normal()), p_begin, left)
        t, x = integrated(rates, start, (slurry, rinse, dose, warmth), stop, 15.0)
        sensors = [
            Sensor("bath.starch", "Iod g/L", "g/L", scaled(0, 1.0), 0.2, 30.0, noise_stated, 0.05),
            Sensor("bath.sugar", "Brix g/L", "g/L", scaled(1, 1.0), 0.3, 60.0, noise_stated, 0.1),
        ]
        sidecar: dict[str, Any] = {}
        if strayed:
            sidecar["components"] = {"bath": {"parameters": {"S_begin": f"{said:.6g} g/L"}}}
            sidecar["uncertain"] = {"bath.S_begin": f"{strayed:g} g/L"}
        made = Written(
            t,
            x,
            sensors,
            {
                "pump_1.slurry": (slurry, "mL/min"),
                "pump_2.rinse": (rinse, "mL/min"),
                "pump_3.dose": (dose, "mL/min"),
                "jacket.warmth": (warmth, "degC"),
            },
            loggers[number % len(loggers)],
            recorded=["jacket.warmth"],
            sidecar=sidecar,
        )
        write(folder / name, rng, made)


def desizing_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("h", zero=12.5), Logger("min", zero=-20.0, gap=(12000.0, 14400.0)), Logger("s", empty=0.02))
    _desizing(folder, rng, strayed=0.6, noise_stated=0.87, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, starch at the begin is stated and off by 0.6 g/L (deviation), which is stated "
        "too, noise stated 1.15 times too small, two rates, a gap of 40 min, empty cells, three loggers of h, min and "
        "s, Co-Simulation",
        FINE,
    )


def desizing_hindered(folder: Path, rng: Rng) -> Truth:
    hinders = rng.uniform(14.0, 24.0)
    _desizing(folder, rng, hinders=hinders, loggers=(Logger("min", zero=3.0), Logger("h")))
    return Truth(
        f"sugar P hinders the enzyme: the half of its rate is at K (1 + P/{hinders:.2f} g/L)",
        PHYSICS,
        (*RATED, "product_inhibition", "inhibition"),
    )


def desizing_start(folder: Path, rng: Rng) -> Truth:
    missing = rng.uniform(0.45, 0.65)
    _desizing(folder, rng, missing=missing, loggers=(Logger("h"), Logger("min", zero=5.0)))
    return Truth(
        f"{100 * missing:.0f} % of the enzyme that is said to be in the bath at the begin of the second recording is "
        "missing",
        (*RECORDING, *SENSOR),
    )


# --- a weaving shed with an air washer, FMI 2 Model Exchange; min, L/s, W, degC, g/kg; outdoor air in columns
SHED = OdeModel(
    "weaving_shed",
    {
        "e": (0.8, ""),
        "C_w": (8e4, "J/K"),
        "C_a": (1.2e5, "J/K"),
        "U": (90.0, "W/K"),
        "m_a": (75.0, "kg"),
        "w_20": (0.0147, "kg/kg"),
        "T_begin": (299.15, "K"),
        "W_begin": (293.15, "K"),
        "w_begin": (0.012, "kg/kg"),
    },
    {"fan": "m^3/s", "machines": "W", "outdoor": "K", "damp": "kg/kg"},
    {
        "T": (
            "K",
            "T_begin",
            f"(machines + {DENSITY}*{AIR}*fan*(outdoor + e*(T_w - outdoor) - T) - U*(T - outdoor))/C_a",
        ),
        "w": (
            "kg/kg",
            "w_begin",
            f"{DENSITY}*fan*(damp + e*(w_20*exp(0.0615*(T_w - 293.15)) - damp) - w)/m_a",
        ),
        "T_w": (
            "K",
            "W_begin",
            f"{DENSITY}*fan*e*({AIR}*(outdoor - T_w) - {EVAPORATION}*(w_20*exp(0.0615*(T_w - 293.15)) - damp))/C_w",
        ),
    },
    {"air": ("K", "T"), "moisture": ("kg/kg", "w"), "sump": ("K", "T_w")},
    2.0,
)
SHED_KNOWN = {"e": 0.04, "C_w": 0.06, "C_a": 0.06, "U": 0.08, "m_a": 0.05}


def _shed(
    folder: Path,
    rng: Rng,
    fast: float = 0.0,
    stock: float = 0.0,
    wall: float = 0.0,
    lag: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> None:
    """Where air is faster it may take up less: e is 1 - (1 - e)^((0.35 m^3/s / fan)^fast).

    Walls and beams may take up heat, `stock` J/K behind `wall` W/K. The thermometer of the shed may lag in the second
    recording, with a time constant `lag` [s].
    """
    SHED.build(folder)
    names = (
        ("washer", "fan", "L/s"),
        ("looms", "machines", "W"),
        ("roof", "outdoor", "degC"),
        ("roof", "damp", "g/kg"),
    )
    parts = programme("washer", ("fan", "L/s")) + programme("looms", ("machines", "W"))
    parts += programme("roof", ("outdoor", "degC"), ("damp", "g/kg")) + with_numbers("shed", "weaving_shed")
    wires = "".join(f"  - {c}.{n} -> shed.{n}\n" for c, n, _ in names)
    scenario(folder, "A weaving shed with an air washer", 14400.0, 5, 10, parts, wires)
    data_sheet(folder, SHED, SHED_KNOWN)
    e, c_w, c_a, loss, m_a, w_20, t_begin, sump_begin, w_begin = drawn(rng, SHED, SHED_KNOWN)

    for number, (name, stop) in enumerate((("first", 14400.0), ("second", 12000.0), ("third", 13200.0))):
        slow = lag if name == "second" else 0.0

        def rates(t: float, x: Array, u: Array, slow: float = slow) -> list[float]:
            """Moisture is in g/kg; the last two are walls and what a slow thermometer shows."""
            air, moisture, sump, walls, shown = (float(s) for s in x)
            blown, outdoor, damp = DENSITY * 1e-3 * float(u[0]), float(u[2]) + CELSIUS, float(u[3])
            share = 1.0 - (1.0 - e) ** ((350.0 / float(u[0])) ** fast)
            full = 1e3 * w_20 * np.exp(0.0615 * (sump - 293.15))
            supplied = outdoor + share * (sump - outdoor)
            stored = wall * (air - walls)
            heat = float(u[1]) + AIR * blown * (supplied - air) - loss * (air - outdoor) - stored
            return [
                heat / c_a,
                blown * (damp + share * (full - damp) - moisture) / m_a,
                blown * share * (AIR * (outdoor - sump) - 1e-3 * EVAPORATION * (full - damp)) / c_w,
                stored / stock if stock else 0.0,
                (air - shown) / slow if slow else 0.0,
            ]

        fan = drawn_steps(rng, stop, 800.0, 120.0, 600.0, 10.0)
        if name == "third":
            fan = stairs(rng, stop, 600.0, 130.0, 580.0, 5, 10.0)
        machines = drawn_steps(rng, stop, 1100.0, 300.0, 4500.0, 10.0)
        fan, machines = later(fan, 5.0), later(machines, 5.0)
        outdoor = ramped(rng, stop, 3000.0, 24.0, 34.0, 60.0)
        damp = ramped(rng, stop, 3600.0, 6.0, 11.0, 60.0)
        start = (t_begin, 1e3 * w_begin, sump_begin, t_begin, t_begin)
        t, x = integrated(rates, start, (fan, machines, outdoor, damp), stop, 5.0)
        sensors = [
            Sensor("shed.air", "Pt100 Saal", "degC", celsius(4 if slow else 0), 0.12, 10.0, noise_stated, 0.05),
            Sensor("shed.moisture", "x g/kg", "g/kg", scaled(1, 1.0), 0.1, 10.0, noise_stated, 0.02),
            Sensor("shed.sump", "Pt100 Wanne", "degC", celsius(2), 0.12, 10.0, noise_stated, 0.05),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "washer.fan": (fan, "L/s"),
                "looms.machines": (machines, "W"),
                "roof.outdoor": (outdoor, "degC"),
                "roof.damp": (damp, "g/kg"),
            },
            loggers[number % len(loggers)],
            recorded=["roof.outdoor", "roof.damp"],
        )
        write(folder / name, rng, made)


def shed_null(folder: Path, rng: Rng) -> Truth:
    loggers = (
        Logger("min", zero=480.0, is_comma=True),
        Logger("h", zero=-2.0, is_comma=True, empty=0.03),
        Logger("s", is_comma=True, gap=(5000.0, 5700.0)),
    )
    _shed(folder, rng, noise_stated=1.15, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.15 times too large, decimal commas, two columns of inputs, "
        "empty cells, a gap of 700 s, three loggers of min, h and s",
        FINE,
    )


def shed_fast(folder: Path, rng: Rng) -> Truth:
    fast = rng.uniform(0.45, 0.65)
    _shed(folder, rng, fast=fast, loggers=(Logger("min"), Logger("s", zero=77.0)))
    return Truth(
        f"where air is faster, the washer does less: e is 1 - (1 - e)^((0.35 m^3/s / fan)^{fast:.3f})", PHYSICS
    )


def shed_two(folder: Path, rng: Rng) -> Truth:
    fast, stock, wall = rng.uniform(0.45, 0.65), rng.uniform(2.5e5, 5e5), rng.uniform(120.0, 200.0)
    _shed(folder, rng, fast=fast, stock=stock, wall=wall, loggers=(Logger("h", zero=6.0), Logger("min")))
    return Truth(
        f"where air is faster, the washer does less: e is 1 - (1 - e)^((0.35 m^3/s / fan)^{fast:.3f}); and walls and "
        f"beams of {1e-3 * stock:.0f} kJ/K take up heat through {wall:.0f} W/K",
        PHYSICS,
        STORED,
    )


def shed_lag(folder: Path, rng: Rng) -> Truth:
    lag = rng.uniform(220.0, 340.0)
    _shed(folder, rng, lag=lag, loggers=(PLAIN, Logger("min", zero=-30.0)))
    return Truth(
        f"the thermometer of the shed hangs in a bag in the second recording: it lags with a time constant of {lag:.0f}"
        " s",
        (*RECORDING, *SENSOR),
    )


# --- jet (FMI 3, Co-Simulation) and bobbin (FMI 2, Model Exchange) of a yarn gun; ms, kPa, %, A, mN, rpm
JET = OdeModel(
    "yarn_jet",
    {
        "c_s": (1.2e-8, "m^3/s/Pa"),
        "c_v": (2e-8, "m^3/s/Pa"),
        "c_n": (1e-8, "m^3/s/Pa"),
        "V_t": (1e-3, "m^3"),
        "V_n": (1e-4, "m^3"),
        "a": (6e-4, "m/s/Pa"),
        "c_f": (1.5e-4, "N*s^2/m^2"),
        "p_room": (1.01e5, "Pa"),
        "p_begin": (1.5e5, "Pa"),
    },
    {"supply": "Pa", "valve": "", "yarn": "m/s"},
    {
        "p_t": ("Pa", "p_begin", "p_room*(c_s*(supply - p_t) - c_v*valve*(p_t - p_n))/V_t"),
        "p_n": ("Pa", "0.0", "p_room*(c_v*valve*(p_t - p_n) - c_n*p_n)/V_n"),
    },
    {"tank": ("Pa", "p_t"), "nozzle": ("Pa", "p_n"), "pull": ("N", "c_f*(a*p_n - yarn)*fabs(a*p_n - yarn)")},
    2e-3,
)
BOBBIN = OdeModel(
    "bobbin",
    {
        "J": (5e-5, "kg*m^2"),
        "r": (0.03, "m"),
        "d": (1e-5, "N*m*s/rad"),
        "k_b": (4e-5, "N*m*s/rad/A^2"),
    },
    {"pull": "N", "amps": "A"},
    {"w": ("rad/s", "0.0", "(r*pull - d*w - k_b*amps*amps*w)/J")},
    {"speed": ("rad/s", "w"), "yarn": ("m/s", "r*w")},
    2e-3,
)
JET_KNOWN = {"c_s": 0.05, "c_v": 0.05, "c_n": 0.05, "V_t": 0.04, "V_n": 0.08, "a": 0.04, "c_f": 0.06}
BOBBIN_KNOWN = {"J": 0.05, "r": 0.01, "d": 0.1, "k_b": 0.06}


def _yarn(
    folder: Path,
    rng: Rng,
    balloon: float = 0.0,
    leak: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """Two FMUs; yarn that leaves may drag air, balloon w^2 [N m s^2/rad^2]; the tank may leak, leak p [mL/s/kPa]."""
    build3(JET, folder, has_exchange=False)
    BOBBIN.build(folder)
    data_sheet(folder, JET, JET_KNOWN)
    (folder / "numbers.yaml").rename(folder / "jet.yaml")
    data_sheet(folder, BOBBIN, BOBBIN_KNOWN)
    parts = (
        programme("regulator", ("supply", "kPa"))
        + programme("slide", ("valve", "'%'")).replace("0 '%'", "0 %")
        + programme("magnet", ("amps", "A"))
        + with_numbers("jet", "yarn_jet", "internal").replace("numbers.yaml", "jet.yaml")
        + with_numbers("spool", "bobbin")
    )
    wires = (
        "  - regulator.supply -> jet.supply\n  - slide.valve -> jet.valve\n  - magnet.amps -> spool.amps\n"
        "  - jet.pull -> spool.pull\n  - spool.yarn -> jet.yarn\n"
    )
    scenario(folder, "A yarn gun and its bobbin", 28.0, 5e-3, 0.02, parts, wires)
    c_s, c_v, c_n, v_t, v_n, a, c_f, p_room, p_begin = drawn(rng, JET, JET_KNOWN)
    inertia, r, d, k_b = drawn(rng, BOBBIN, BOBBIN_KNOWN)

    def pull(x: Array) -> Array:
        """Of the jet [N], of the nozzle's pressure [kPa] and the bobbin's speed."""
        past = 1e3 * a * x[..., 1] - r * x[..., 2]
        return np.asarray(c_f * past * np.abs(past))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Pressures are in kPa, flows in mL/s."""
        tank, nozzle, w = (float(s) for s in x)
        through = 1e9 * c_v * 0.01 * float(u[1]) * (tank - nozzle)
        braked = d + k_b * float(u[2]) ** 2 + balloon * abs(w)
        return [
            1e-9 * p_room * (1e9 * c_s * (float(u[0]) - tank) - through - leak * tank) / v_t,
            1e-9 * p_room * (through - 1e9 * c_n * nozzle) / v_n,
            (r * float(pull(x)) - braked * w) / inertia,
        ]

    for number, (name, stop) in enumerate((("first", 28.0), ("second", 22.0), ("third", 25.0))):
        supply = drawn_steps(rng, stop, 4.5, 180.0, 360.0, 0.02)
        valve = drawn_steps(rng, stop, 1.6, 8.0, 100.0, 0.02)
        if name == "third":
            valve = telegraph(rng, stop, 1.5, 14.0, 94.0, 0.02)
        amps = bursts(rng, stop, 2.2, 2.0, 0.2, 0.9, 0.02)
        supply, valve, amps = later(supply, 0.01), later(valve, 0.01), later(amps, 0.01)
        t, x = integrated(rates, (1e-3 * p_begin, 0.0, 0.0), (supply, valve, amps), stop, 5e-3)
        sensors = [
            Sensor("jet.tank", "p Kessel", "kPa", scaled(0, 1.0), 0.6, 0.02, noise_stated, 0.1),
            Sensor("jet.nozzle", "p Duese", "kPa", scaled(1, 1.0), 0.5, 0.02, noise_stated, 0.1),
            Sensor("jet.pull", "yarn mN", "mN", lambda t, x, u: 1e3 * pull(x), 8.0, 0.02, noise_stated, 2.0),
            Sensor("spool.speed", "n Spule", "rpm", scaled(2, RPM), 30.0, 0.04, noise_stated, 5.0),
        ]
        programmes = {"regulator.supply": (supply, "kPa"), "slide.valve": (valve, "%"), "magnet.amps": (amps, "A")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def yarn_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=100.0, empty=0.02), Logger("ms", zero=-4e3), Logger("min", gap=(10.0, 13.0)))
    _yarn(folder, rng, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, two FMUs, noise stated rightly, two rates, empty cells, a gap of 3 s, three "
        "loggers of s, ms and min",
        FINE,
    )


def yarn_balloon(folder: Path, rng: Rng) -> Truth:
    balloon = rng.uniform(1.8e-8, 3e-8)
    _yarn(folder, rng, balloon=balloon, loggers=(Logger("ms"), Logger("s", zero=9.0)))
    return Truth(
        f"yarn that leaves the bobbin flies round it and drags air: {balloon:.3e} N m s^2/rad^2 w^2", PHYSICS, DRAGGED
    )


def yarn_two(folder: Path, rng: Rng) -> Truth:
    balloon, leak = rng.uniform(1.8e-8, 3e-8), rng.uniform(0.8, 1.4)
    _yarn(folder, rng, balloon=balloon, leak=leak, loggers=(PLAIN, Logger("ms", zero=250.0)))
    return Truth(
        f"yarn that leaves the bobbin flies round it and drags air, {balloon:.3e} N m s^2/rad^2 w^2, and the tank leaks"
        f" {leak:.3f} mL/s/kPa p",
        PHYSICS,
        (*DRAGGED, *LEAKING),
    )


# --- a pan of resin that cures in light, FMI 3, both interfaces, without units; its stage is a column
RESIN = OdeModel(
    "resin",
    {
        "phi": (1e-4, ""),
        "k": (1e-3, ""),
        "b": (0.025, ""),
        "H": (110.0, ""),
        "s": (0.03, ""),
        "tau": (8.0, ""),
        "T_begin": (30.0, ""),
    },
    {"light": "", "stage": ""},
    {
        "i": ("", "1.0", "-phi*light*i"),
        "x": ("", "0.0", "k*sqrt(light*i)*(1.0 - x)*exp(b*(T - 30.0))"),
        "T": ("", "T_begin", "H*k*sqrt(light*i)*(1.0 - x)*exp(b*(T - 30.0)) + s*light - (T - stage)/tau"),
    },
    {"cured": ("", "x"), "warm": ("", "T")},
    0.25,
)
RESIN_KNOWN = {"phi": 0.1, "k": 0.06, "b": 0.08, "H": 0.05, "s": 0.06, "tau": 0.06}


def _resin(
    folder: Path,
    rng: Rng,
    most: float = np.inf,
    shut: tuple[float, float] | None = None,
    is_fahrenheit: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Resin may become glass, its rate counts as 1 - (x/most)^4 of what it was.

    Shut is begin and end [s] of a stretch of the first recording in which no light comes. The temperature of the second
    recording may be in degF.
    """
    build3(RESIN, folder)
    parts = programme("lamp", ("light", "")) + programme("peltier", ("stage", "")) + with_numbers("pan", "resin")
    wires = "  - lamp.light -> pan.light\n  - peltier.stage -> pan.stage\n"
    scenario(folder, "A pan of resin that cures", 900.0, 0.5, 1, parts, wires)
    data_sheet(folder, RESIN, RESIN_KNOWN)
    phi, k, b, h, s, tau, begin = drawn(rng, RESIN, RESIN_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        left, cured, warm = (float(v) for v in x)
        light = float(u[0])
        pace = k * np.sqrt(light * left) * (1.0 - cured) * np.exp(b * (warm - 30.0))
        pace *= max(1.0 - (cured / most) ** 4, 0.0)
        return [-phi * light * left, pace, h * pace + s * light - (warm - float(u[1])) / tau]

    for number, (name, stop) in enumerate((("first", 900.0), ("second", 720.0), ("third", 800.0))):
        light = drawn_steps(rng, stop, 25.0, 0.0, 26.0, 1.0)
        if name == "third":
            light = telegraph(rng, stop, 22.0, 1.0, 24.0, 1.0)
        light = later(light, 0.5)
        stage = ramped(rng, stop, 120.0, 24.0, 44.0, 3.0)
        run = light
        if shut is not None and name == "first":
            run = between(light, shut[0], shut[1], lambda v: 0.0)
        t, x = integrated(rates, (1.0, 0.0, begin), (run, stage), stop, 0.25)
        factor, zero = (1.8, 32.0) if is_fahrenheit and name == "second" else (1.0, 0.0)

        def pan(t: Array, x: Array, u: Array, factor: float = factor, zero: float = zero) -> Array:
            return np.asarray(zero + factor * x[:, 2])

        sensors = [
            Sensor("pan.cured", "FTIR", "1", scaled(1, 1.0), 4e-3, 1.0, noise_stated, 1e-3),
            Sensor("pan.warm", "T pan", "1", pan, 0.1, 1.0, noise_stated, 0.02),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"lamp.light": (run, ""), "peltier.stage": (stage, "")},
            loggers[number % len(loggers)],
            recorded=["peltier.stage"],
            told={} if run is light else {"lamp.light": light},
        )
        write(folder / name, rng, made)
        idle_column(folder / name, "N2 L/min", lambda n: np.asarray(5.0 + 0.02 * rng.standard_normal(n)))


def resin_glass(folder: Path, rng: Rng) -> Truth:
    most = rng.uniform(0.72, 0.82)
    _resin(folder, rng, most=most, loggers=(PLAIN, Logger("min", zero=1.0)))
    return Truth(
        f"resin becomes glass as it cures: its rate is 1 - (x/{most:.3f})^4 of what the model says",
        PHYSICS,
        (*RATED, "saturation", "saturating_gain", "state_limit"),
    )


def resin_shut(folder: Path, rng: Rng) -> Truth:
    begin = round(rng.uniform(90.0, 330.0)) + 0.5
    _resin(folder, rng, shut=(begin, begin + 110.0), loggers=(Logger("s", zero=-12.0), Logger("min")))
    return Truth(
        f"a shutter keeps the light away for 110 s from {begin:g} s of the first recording on, and light is said to "
        "come",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


def resin_fahrenheit(folder: Path, rng: Rng) -> Truth:
    _resin(folder, rng, is_fahrenheit=True, loggers=(Logger("min"), PLAIN))
    return Truth(
        "the temperature of the second recording is in degF, that of the others (and the model's) in degC",
        (*RECORDING, *SENSOR),
    )


# --- a pendulum with a reaction wheel, FMI 2 Co-Simulation; ms, V, N m, deg, rad/s, rpm, A; two rates
WHEEL = OdeModel(
    "reaction_wheel",
    {
        "I": (0.02, "kg*m^2"),
        "G": (0.9, "N*m"),
        "d": (0.012, "N*m*s/rad"),
        "J": (6e-4, "kg*m^2"),
        "k": (0.05, "V*s/rad"),
        "R": (1.5, "ohm"),
        "d_w": (3e-5, "N*m*s/rad"),
    },
    {"volts": "V", "push": "N*m"},
    {
        "q": ("rad", "0.0", "v"),
        "v": ("rad/s", "0.0", "(push - G*sin(q) - d*v - k*(volts - k*w)/R + d_w*w)/I"),
        "w": (
            "rad/s",
            "0.0",
            "(k*(volts - k*w)/R - d_w*w)/J - (push - G*sin(q) - d*v - k*(volts - k*w)/R + d_w*w)/I",
        ),
    },
    {"angle": ("rad", "q"), "gyro": ("rad/s", "v"), "wheel": ("rad/s", "w"), "amps": ("A", "(volts - k*w)/R")},
    5e-4,
)
WHEEL_KNOWN = {"I": 0.04, "G": 0.04, "d": 0.1, "J": 0.04, "k": 0.02, "R": 0.05, "d_w": 0.15}


def _wheel(
    folder: Path,
    rng: Rng,
    drop: float = 0.0,
    fast: float = 0.0,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """The bridge may drop a voltage, `drop` [V], against the current, and block below it.

    The clock of the encoder's own logger may be `fast` by a share in the first recording.
    """
    WHEEL.build(folder)
    parts = programme("bridge", ("volts", "V")) + programme("hand", ("push", "N*m"))
    parts += with_numbers("pendulum", "reaction_wheel", "internal")
    wires = "  - bridge.volts -> pendulum.volts\n  - hand.push -> pendulum.push\n"
    scenario(folder, "A pendulum with a reaction wheel", 20.0, 5e-3, 0.01, parts, wires)
    data_sheet(folder, WHEEL, WHEEL_KNOWN)
    inertia, hanging, d, rim, k, r, d_w = drawn(rng, WHEEL, WHEEL_KNOWN)

    def current(x: Array, volts: Array) -> Array:
        """Of the motor [A]."""
        left = volts - k * x[..., 2]
        return np.asarray(np.sign(left) * np.maximum(np.abs(left) - drop, 0.0) / r)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        q, v, w = (float(s) for s in x)
        torque = k * float(current(x, u[0])) - d_w * w
        swung = (float(u[1]) - hanging * np.sin(q) - d * v - torque) / inertia
        return [v, swung, torque / rim - swung]

    for number, (name, stop) in enumerate((("first", 20.0), ("second", 16.0), ("third", 18.0))):
        volts = drawn_steps(rng, stop, 0.6, -4.5, 4.5, 0.02)
        if name == "third":
            volts = stairs(rng, stop, 0.35, -4.2, 4.2, 6, 0.02)
        push = bursts(rng, stop, 0.9, 0.5, -0.2, 0.2, 0.02)
        volts, push = later(volts, 5e-3), later(push, 5e-3)
        t, x = integrated(rates, (0.0, 0.0, 0.0), (volts, push), stop, 2.5e-3)
        ahead, swings = fast if name == "first" else 0.0, DEGREES * x[:, 0]

        def encoder(now: Array, x: Array, u: Array, t: Array = t, q: Array = swings, ahead: float = ahead) -> Array:
            return np.asarray(np.interp(now / (1.0 + ahead), t, q))

        sensors = [
            Sensor("pendulum.angle", "Encoder deg", "deg", encoder, 0.15, 0.02, noise_stated, 0.05, colour),
            Sensor("pendulum.gyro", "gyro rad/s", "rad/s", scaled(1, 1.0), 0.03, 0.01, noise_stated, 5e-3, colour),
            Sensor("pendulum.wheel", "Hall rpm", "rpm", scaled(2, RPM), 6.0, 0.01, noise_stated, 1.0, colour),
            Sensor(
                "pendulum.amps",
                "Shunt",
                "A",
                lambda t, x, u: current(x, u[:, 0]),
                0.03,
                0.01,
                noise_stated,
                5e-3,
                colour,
            ),
        ]
        programmes = {"bridge.volts": (volts, "V"), "hand.push": (push, "N*m")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def wheel_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=-5e3, empty=0.02), Logger("s", zero=64.0), Logger("ms", gap=(7.0, 8.5)))
    _wheel(folder, rng, noise_stated=1.2, colour=0.35, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.35 and is stated 1.2 times too "
        "large, two rates, empty cells, a gap of 1.5 s, three loggers of ms and s, Co-Simulation",
        FINE,
    )


def wheel_drop(folder: Path, rng: Rng) -> Truth:
    drop = rng.uniform(0.3, 0.55)
    _wheel(folder, rng, drop=drop, loggers=(Logger("s", zero=2.0), Logger("ms")))
    return Truth(
        f"the bridge drops {drop:.3f} V against the current, and where there is less than that, no current flows",
        PHYSICS,
        ("dead_zone", "dead_band", "voltage_drop"),
    )


def wheel_clock(folder: Path, rng: Rng) -> Truth:
    fast = rng.uniform(6e-3, 1e-2)
    _wheel(folder, rng, fast=fast, loggers=(Logger("ms"), Logger("s", zero=-1.0)))
    return Truth(
        f"the clock of the encoder's own logger is fast by {100 * fast:.2f} % in the first recording, those of the "
        "other sensors are right",
        (*RECORDING, *SENSOR),
    )


# --- a loop that keeps ink moving past a print head, FMI 3 Co-Simulation; rpm, kPa, mL/min, mm; room is a column
INKLOOP = OdeModel(
    "ink_loop",
    {
        "A_1": (4e-3, "m^2"),
        "A_2": (6e-3, "m^2"),
        "H": (0.3, "m"),
        "rho": (1050.0, "kg/m^3"),
        "G": (6e-10, "m^3/s/Pa"),
        "b": (0.03, "1/K"),
        "D": (4.3e-7, "m^3/rad"),
        "C": (8000.0, "J/K"),
        "U": (6.0, "W/K"),
        "T_begin": (300.15, "K"),
        "h_begin": (0.2, "m"),
    },
    {"pump": "rad/s", "vacuum": "Pa", "print": "m^3/s", "heater": "W", "room": "K"},
    {
        "h_1": (
            "m",
            "h_begin",
            f"(D*pump - G*exp(b*(T - 303.15))*(rho*{GRAVITY}*(h_1 - h_2 + H) + vacuum))/A_1",
        ),
        "h_2": (
            "m",
            "h_begin",
            f"(G*exp(b*(T - 303.15))*(rho*{GRAVITY}*(h_1 - h_2 + H) + vacuum) - print - D*pump)/A_2",
        ),
        "T": ("K", "T_begin", "(heater - U*(T - room))/C"),
    },
    {
        "upper": ("m", "h_1"),
        "lower": ("m", "h_2"),
        "flow": ("m^3/s", f"G*exp(b*(T - 303.15))*(rho*{GRAVITY}*(h_1 - h_2 + H) + vacuum)"),
        "ink": ("K", "T"),
    },
    0.5,
)
INKLOOP_KNOWN = {"A_1": 0.02, "A_2": 0.02, "H": 0.02, "G": 0.06, "b": 0.08, "D": 0.03, "C": 0.06, "U": 0.06}


def _inkloop(
    folder: Path,
    rng: Rng,
    clogs: float = np.inf,
    stuck: tuple[float, float] | None = None,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """A filter before the head may clog: G counts as G/(1 + V/clogs), V and clogs in mL, of what has passed.

    Stuck is begin and end [s] of a stretch of the first recording in which the upper float does not move.
    """
    build3(INKLOOP, folder, has_exchange=False)
    names = (
        ("drive", "pump", "rpm"),
        ("ejector", "vacuum", "kPa"),
        ("head", "print", "mL/min"),
        ("mat", "heater", "W"),
        ("hall", "room", "degC"),
    )
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("loop", "ink_loop", "internal")
    wires = "".join(f"  - {c}.{n} -> loop.{n}\n" for c, n, _ in names)
    scenario(folder, "A loop of ink", 2400.0, 1, 2, parts, wires)
    data_sheet(folder, INKLOOP, INKLOOP_KNOWN)
    a_1, a_2, head, rho, g, b, delivered, c, loss, t_begin, h_begin = drawn(rng, INKLOOP, INKLOOP_KNOWN)

    def flow(x: Array, vacuum: Array) -> Array:
        """Past the head [mL/s], of levels [mm], of the temperature and of what has passed; vacuum is in kPa."""
        across = rho * GRAVITY * (1e-3 * (x[..., 0] - x[..., 1]) + head) + 1e3 * vacuum
        return np.asarray(1e6 * g * np.exp(b * (x[..., 2] - 303.15)) * across / (1.0 + x[..., 3] / clogs))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        past, pumped = float(flow(x, u[1])), 1e6 * delivered * float(u[0]) / RPM
        return [
            1e-3 * (pumped - past) / a_1,
            1e-3 * (past - float(u[2]) / 60.0 - pumped) / a_2,
            (float(u[3]) - loss * (float(x[2]) - float(u[4]) - CELSIUS)) / c,
            past,
        ]

    for number, (name, stop) in enumerate((("first", 2400.0), ("second", 1900.0), ("third", 2100.0))):
        pump = drawn_steps(rng, stop, 90.0, 35.0, 115.0, 2.0)
        vacuum = drawn_steps(rng, stop, 140.0, 0.8, 3.6, 2.0)
        if name == "third":
            pump = wandering(rng, stop, 80.0, 38.0, 112.0, 2.0)
        ejected = bursts(rng, stop, 90.0, 70.0, 4.0, 25.0, 2.0)
        heater = drawn_steps(rng, stop, 300.0, 0.0, 120.0, 2.0)
        pump, vacuum, ejected, heater = later(pump, 1.0), later(vacuum, 1.0), later(ejected, 1.0), later(heater, 1.0)
        room = ramped(rng, stop, 600.0, 21.0, 26.0, 20.0)
        start = (1e3 * h_begin, 1e3 * h_begin, t_begin, 0.0)
        t, x = integrated(rates, start, (pump, vacuum, ejected, heater, room), stop, 0.5)
        held = stuck if stuck is not None and name == "first" else (np.inf, np.inf)

        def spoil(column: str, t: Array, v: Array, held: tuple[float, float] = held) -> Array:
            if column != "float 1 mm" or held[0] == np.inf:
                return v
            return np.where((t >= held[0]) & (t < held[1]), v[np.searchsorted(t, held[0])], v)

        sensors = [
            Sensor("loop.upper", "float 1 mm", "mm", scaled(0, 1.0), 0.5, 2.0, noise_stated, 0.1, wild=wild),
            Sensor("loop.lower", "float 2 mm", "mm", scaled(1, 1.0), 0.5, 2.0, noise_stated, 0.1, wild=wild),
            Sensor(
                "loop.flow",
                "Coriolis mL/min",
                "mL/min",
                lambda t, x, u: 60.0 * flow(x, u[:, 1]),
                1.5,
                2.0,
                noise_stated,
                0.5,
                wild=wild,
            ),
            Sensor("loop.ink", "NTC Tinte", "degC", celsius(2), 0.1, 4.0, noise_stated, 0.05, wild=wild),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "drive.pump": (pump, "rpm"),
                "ejector.vacuum": (vacuum, "kPa"),
                "head.print": (ejected, "mL/min"),
                "mat.heater": (heater, "W"),
                "hall.room": (room, "degC"),
            },
            loggers[number % len(loggers)],
            recorded=["hall.room"],
            spoil=spoil,
        )
        write(folder / name, rng, made)


def inkloop_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=3600.0, jitter=0.2), Logger("min", zero=-4.0), Logger("h", gap=(900.0, 990.0)))
    _inkloop(folder, rng, wild=0.006, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, wild readings, noise stated rightly, two rates, jitter, a gap of 90 s, three "
        "loggers of s, min and h, Co-Simulation",
        FINE,
    )


def inkloop_clogged(folder: Path, rng: Rng) -> Truth:
    clogs = rng.uniform(1.4e4, 2.4e4)
    _inkloop(folder, rng, clogs=clogs, loggers=(Logger("min", zero=10.0), PLAIN))
    return Truth(
        f"a filter before the head clogs from the begin of each recording on: G/(1 + V/{1e-3 * clogs:.2f} L), V of what"
        " has passed",
        PHYSICS,
        ("hidden_state",),
    )


def inkloop_stuck(folder: Path, rng: Rng) -> Truth:
    begin = float(2 * round(rng.uniform(200.0, 700.0)))
    _inkloop(folder, rng, stuck=(begin, begin + 460.0), loggers=(PLAIN, Logger("min", zero=2.5)))
    return Truth(
        f"the upper float is stuck, {begin:g} s to {begin + 460.0:g} s of the first recording",
        SENSOR,
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    knee_hardened,
    horn_null,
    desizing_start,
    shed_fast,
    yarn_null,
    resin_shut,
    wheel_drop,
    inkloop_stuck,
    knee_null,
    horn_other_run,
    desizing_hindered,
    shed_null,
    yarn_balloon,
    resin_fahrenheit,
    wheel_null,
    inkloop_clogged,
    knee_clipped,
    horn_warmed,
    desizing_null,
    shed_lag,
    yarn_two,
    resin_glass,
    wheel_clock,
    inkloop_null,
    shed_two,
)
