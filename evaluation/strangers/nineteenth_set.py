"""Nineteenth set: a kite, a zipping pouch, a spinning supply, photocatalysis, a hose pump, vapour, a loop, an iron.

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
from evaluation.strangers.eleventh_set import LEAKING, RPM, RUBBING, telegraph
from evaluation.strangers.fifteenth_set import ramped
from evaluation.strangers.fifth_set import integrated
from evaluation.strangers.first_set import PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import between, bursts, data_sheet, scaled
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Written, celsius, drawn_steps, write
from evaluation.strangers.sixteenth_set import later
from evaluation.strangers.tenth_set import stairs, swept
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.thirteenth_set import wandering
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth

#: Gas constant [J/mol/K].
GAS_CONSTANT = 8.314
#: Laws that are true where something is stored of which the model knows nothing.
STORED = ("hidden_state", "hidden_mass", "hidden_capacity", "second_mass")
#: Laws that are true where a conductance depends on how wet or how loaded something is.
CONDUCTED = ("nonlinear_conductance", "conductance_of_state", "state_dependent_conductance")


# --- a kite of cloth on a winch whose torque is set, FMI 2 Model Exchange; ms, N m, N, rpm, m; the wind is a column
KITE = OdeModel(
    "kite",
    {
        "m": (2.5, "kg"),
        "c_a": (2.6, "N*s^2/m^2"),
        "k": (900.0, "N/m"),
        "c": (14.0, "N*s/m"),
        "J": (0.05, "kg*m^2"),
        "r": (0.1, "m"),
        "d": (0.08, "N*m*s/rad"),
    },
    {"torque": "N*m", "wind": "m/s"},
    {
        "v": ("m/s", "0.0", "(c_a*(wind - v)*fabs(wind - v) - k*s - c*(v - r*w))/m"),
        "s": ("m", "0.0", "v - r*w"),
        "w": ("rad/s", "0.0", "(r*(k*s + c*(v - r*w)) - torque - d*w)/J"),
        "x": ("m", "0.0", "r*w"),
    },
    {"tether": ("N", "k*s + c*(v - r*w)"), "drum": ("rad/s", "w"), "paid": ("m", "x")},
    1e-3,
)
KITE_KNOWN = {"m": 0.05, "c_a": 0.06, "k": 0.07, "c": 0.15, "J": 0.05, "r": 0.01, "d": 0.1}


def _kite(
    folder: Path,
    rng: Rng,
    yielding: float = np.inf,
    late: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """The canopy may yield to the air v that comes at it, its pull is c_a v^2/(1 + (v/yielding)^2), in m/s.

    In the second recording, the clock of the anemometer may be late [s].
    """
    KITE.build(folder)
    parts = programme("brake", ("torque", "N*m")) + programme("mast", ("wind", "m/s")) + with_numbers("winch", "kite")
    wires = "  - brake.torque -> winch.torque\n  - mast.wind -> winch.wind\n"
    scenario(folder, "A kite on a winch", 24.0, 0.01, 0.02, parts, wires)
    data_sheet(folder, KITE, KITE_KNOWN)
    m, c_a, k, c, inertia, r, d = drawn(rng, KITE, KITE_KNOWN)

    def tether(x: Array) -> Array:
        """Force in the tether [N]."""
        return np.asarray(k * x[..., 1] + c * (x[..., 0] - r * x[..., 2]))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        v, _, w, _ = (float(s) for s in x)
        air = float(u[1]) - v
        pulled = c_a * air * abs(air) / (1.0 + (air / yielding) ** 2)
        force = float(tether(x))
        return [(pulled - force) / m, v - r * w, (r * force - float(u[0]) - d * w) / inertia, r * w]

    for number, (name, stop) in enumerate((("first", 24.0), ("second", 20.0), ("third", 22.0))):
        torque = drawn_steps(rng, stop, 1.3, 4.0, 13.0, 0.02)
        if name == "third":
            torque = swept(stop, 4.5, 12.5, 6.0, 1.5, 0.08)
        torque = later(torque, 0.01)
        wind = ramped(rng, stop, 3.5, 4.5, 8.0, 0.1)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0), (torque, wind), stop, 5e-3)
        sensors = [
            Sensor("winch.tether", "Zugkraft", "N", lambda t, x, u: tether(x), 1.0, 0.02, noise_stated, 0.5),
            Sensor("winch.drum", "n (rpm)", "rpm", scaled(2, RPM), 1.5, 0.02, noise_stated, 0.5),
            Sensor("winch.paid", "L_tether", "m", scaled(3, 1.0), 0.015, 0.02, noise_stated, 5e-3),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"brake.torque": (torque, "N*m"), "mast.wind": (wind, "m/s")},
            loggers[number % len(loggers)],
            recorded=["mast.wind"],
            told={"mast.wind": later(wind, late)} if late and name == "second" else {},
        )
        write(folder / name, rng, made)


def kite_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=-33.0, empty=0.02), Logger("ms", zero=8.1e4), Logger("s", gap=(9.0, 10.8)))
    _kite(folder, rng, noise_stated=0.86, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.16 times too small, empty cells, a gap of 1.8 s, three loggers "
        "of s and ms",
        FINE,
    )


def kite_canopy(folder: Path, rng: Rng) -> Truth:
    yielding = rng.uniform(14.0, 22.0)
    _kite(folder, rng, yielding=yielding, loggers=(Logger("ms", zero=500.0), Logger("s")))
    return Truth(
        f"the canopy yields to the air v that comes at it: its pull is c_a v^2/(1 + (v/{yielding:.2f} m/s)^2)",
        PHYSICS,
        ("saturation", "saturating_gain", "nonlinear_damping"),
    )


def kite_late(folder: Path, rng: Rng) -> Truth:
    late = 0.1 * round(rng.uniform(9.0, 16.0))
    _kite(folder, rng, late=late, loggers=(Logger("s", zero=2.0), Logger("ms")))
    return Truth(
        f"the clock of the anemometer is {late:.1f} s late in the second recording: its column of the wind is shifted",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- a pouch of film and oil that zips when it is charged, FMI 3 Model Exchange; ms, kV, uA, mm, N
POUCH = OdeModel(
    "zipping_pouch",
    {
        "R": (8e6, "ohm"),
        "C_0": (3e-9, "F"),
        "c_x": (5e-7, "F/m"),
        "G": (1e-9, "S"),
        "m": (0.3, "kg"),
        "k": (1500.0, "N/m"),
        "d": (20.0, "N*s/m"),
    },
    {"source": "V", "load": "N"},
    {
        "v": ("V", "0.0", "((source - v)/R - G*v - c_x*v*w)/(C_0 + c_x*x)"),
        "x": ("m", "0.0", "w"),
        "w": ("m/s", "0.0", "(0.5*c_x*v*v - k*x - d*w - load)/m"),
    },
    {"stroke": ("m", "x"), "supplied": ("A", "(source - v)/R")},
    5e-4,
)
POUCH_KNOWN = {"R": 0.05, "C_0": 0.06, "c_x": 0.05, "G": 0.1, "m": 0.03, "k": 0.04, "d": 0.1}


def _pouch(
    folder: Path,
    rng: Rng,
    kept: float = 0.0,
    slow: float = 1.0,
    share: float = 0.0,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (Logger("ms"),),
) -> None:
    """The film may keep charge, which screens `kept` of the voltage at last, with a time constant `slow` [s].

    The monitor of the current may end, in the second recording, at what is exceeded for a `share` of the time.
    """
    build3(POUCH, folder, has_co_simulation=False)
    parts = programme("amplifier", ("source", "kV")) + programme("weight", ("load", "N"))
    parts += with_numbers("pouch", "zipping_pouch")
    wires = "  - amplifier.source -> pouch.source\n  - weight.load -> pouch.load\n"
    scenario(folder, "A zipping pouch", 6.4, 2e-3, 4e-3, parts, wires)
    data_sheet(folder, POUCH, POUCH_KNOWN)
    r, c_0, c_x, g, m, k, d = drawn(rng, POUCH, POUCH_KNOWN)

    def supplied(x: Array, source: Array) -> Array:
        """Current of the amplifier [uA]."""
        return np.asarray(1e9 * (source - x[..., 0]) / r)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Voltages are in kV, the stroke in mm."""
        v, way, w, screen = (float(s) for s in x)
        c = c_0 + 1e-3 * c_x * way
        pulled = 0.5e6 * c_x * (v - screen) ** 2
        return [
            (1e-9 * float(supplied(x, u[0])) - g * v - 1e-3 * c_x * v * w) / c,
            w,
            1e3 * (pulled - 1e-3 * k * way - 1e-3 * d * w - float(u[1])) / m,
            (kept * v - screen) / slow,
        ]

    for number, (name, stop) in enumerate((("first", 6.4), ("second", 5.2), ("third", 5.8))):
        source = drawn_steps(rng, stop, 0.4, 0.5, 6.0, 4e-3)
        if name == "third":
            source = telegraph(rng, stop, 0.35, 0.8, 5.8, 4e-3)
        load = drawn_steps(rng, stop, 0.9, 0.0, 1.5, 4e-3)
        source, load = later(source, 2e-3), later(load, 2e-3)
        t, x = integrated(rates, (0.0, 0.0, 0.0, 0.0), (source, load), stop, 1e-3)
        end = np.inf
        if share and name == "second":
            end = float(f"{np.quantile(np.abs(supplied(x, source.at(t))), 1.0 - share):.0f}")

        def spoil(column: str, t: Array, v: Array, end: float = end) -> Array:
            return np.clip(v, -end, end) if column == "I mon" else v

        sensors = [
            Sensor("pouch.stroke", "laser [mm]", "mm", scaled(1, 1.0), 0.02, 4e-3, noise_stated, 5e-3, colour),
            Sensor(
                "pouch.supplied",
                "I mon",
                "uA",
                lambda t, x, u: supplied(x, u[:, 0]),
                1.5,
                4e-3,
                noise_stated,
                0.5,
                colour,
            ),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"amplifier.source": (source, "kV"), "weight.load": (load, "N")},
            loggers[number % len(loggers)],
            spoil=spoil,
        )
        write(folder / name, rng, made)


def pouch_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=-90.0, gap=(3.0, 3.6)), Logger("s", zero=7.0), Logger("min", empty=0.03))
    _pouch(folder, rng, noise_stated=1.18, colour=0.4, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.4 and is stated 1.18 times too "
        "large, a gap of 0.6 s, empty cells, three loggers of ms, s and min",
        FINE,
    )


def pouch_kept(folder: Path, rng: Rng) -> Truth:
    kept, slow = rng.uniform(0.05, 0.09), rng.uniform(0.7, 1.3)
    _pouch(folder, rng, kept=kept, slow=slow, loggers=(Logger("s"), Logger("ms", zero=30.0)))
    return Truth(
        f"the film keeps charge, which screens {kept:.4f} of the voltage at last, with a time constant of {slow:.2f} s",
        PHYSICS,
        ("hidden_state",),
    )


def pouch_clipped(folder: Path, rng: Rng) -> Truth:
    share = rng.uniform(0.06, 0.1)
    _pouch(folder, rng, share=share, loggers=(Logger("ms"), Logger("s", zero=-5.0)))
    return Truth(
        f"the monitor of the current ends at what {100 * share:.0f} % of the second recording exceed, either way, "
        "which is not stated",
        SENSOR,
    )


# --- high-voltage supply and spinneret of an electrospinning rig, FMI 2 Model Exchange; s, V, kV, uA, mL/min
SUPPLY = OdeModel(
    "spinning_supply",
    {
        "a": (3000.0, ""),
        "R_o": (4e7, "ohm"),
        "C_1": (5e-9, "F"),
        "R_p": (2e7, "ohm"),
        "C_2": (2e-9, "F"),
        "G_d": (2e-9, "S"),
        "g_j": (0.4, "S*s/m^3"),
    },
    {"dial": "V", "feed": "m^3/s"},
    {
        "v_1": ("V", "0.0", "((a*dial - v_1)/R_o - (v_1 - v_2)/R_p)/C_1"),
        "v_2": ("V", "0.0", "((v_1 - v_2)/R_p - (G_d + g_j*feed)*v_2)/C_2"),
    },
    {"multiplier": ("V", "v_1"), "spinneret": ("V", "v_2"), "drawn": ("A", "(a*dial - v_1)/R_o")},
    1e-3,
)
SUPPLY_KNOWN = {"a": 0.01, "R_o": 0.05, "C_1": 0.06, "R_p": 0.05, "C_2": 0.06, "G_d": 0.05, "g_j": 0.1}


def _spinning(
    folder: Path,
    rng: Rng,
    corona: float = 0.0,
    onset: float = 14.0,
    drift: float = 0.0,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """From `onset` kV on, the spinneret may lose corona v (v - onset) uA to the air.

    The zero of the first recording's current may drift [uA].
    """
    SUPPLY.build(folder)
    parts = programme("panel", ("dial", "V")) + programme("syringe", ("feed", "mL/min"))
    parts += with_numbers("supply", "spinning_supply")
    wires = "  - panel.dial -> supply.dial\n  - syringe.feed -> supply.feed\n"
    scenario(folder, "Supply of an electrospinning rig", 16.0, 5e-3, 0.01, parts, wires)
    data_sheet(folder, SUPPLY, SUPPLY_KNOWN)
    a, r_o, c_1, r_p, c_2, g_d, g_j = drawn(rng, SUPPLY, SUPPLY_KNOWN)

    def current(x: Array, dial: Array) -> Array:
        """Of the supply [uA]."""
        return np.asarray(1e9 * (1e-3 * a * dial - x[..., 0]) / r_o)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Voltages are in kV."""
        v_1, v_2 = (float(s) for s in x)
        through = 1e9 * (v_1 - v_2) / r_p
        lost = 1e9 * (g_d + g_j * float(u[1]) / 6e7) * v_2 + corona * v_2 * max(v_2 - onset, 0.0)
        return [1e-9 * (float(current(x, u[0])) - through) / c_1, 1e-9 * (through - lost) / c_2]

    for number, (name, stop) in enumerate((("first", 16.0), ("second", 13.0), ("third", 14.4))):
        dial = drawn_steps(rng, stop, 0.7, 1.5, 9.0, 0.01)
        if name == "third":
            dial = stairs(rng, stop, 0.6, 1.8, 8.8, 5, 0.01)
        feed = drawn_steps(rng, stop, 2.2, 0.0, 0.08, 0.01)
        dial, feed = later(dial, 5e-3), later(feed, 5e-3)
        t, x = integrated(rates, (0.0, 0.0), (dial, feed), stop, 2.5e-3)
        strayed = drift if name == "first" else 0.0

        def drawn_off(t: Array, x: Array, u: Array, strayed: float = strayed, stop: float = stop) -> Array:
            return np.asarray(current(x, u[:, 0]) + strayed * t / stop)

        sensors = [
            Sensor("supply.multiplier", "U out kV", "kV", scaled(0, 1.0), 0.03, 0.01, noise_stated, 0.01, wild=wild),
            Sensor("supply.spinneret", "Tastkopf", "kV", scaled(1, 1.0), 0.03, 0.01, noise_stated, 0.01, wild=wild),
            Sensor("supply.drawn", "I (uA)", "uA", drawn_off, 0.5, 0.01, noise_stated, 0.1, wild=wild),
        ]
        programmes = {"panel.dial": (dial, "V"), "syringe.feed": (feed, "mL/min")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def spinning_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=1e3, is_comma=True), Logger("ms", is_comma=True, jitter=0.2), Logger("min", zero=-3.0))
    _spinning(folder, rng, wild=0.008, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated rightly, wild readings, decimal commas, jitter, three loggers of "
        "s, ms and min",
        FINE,
    )


def spinning_corona(folder: Path, rng: Rng) -> Truth:
    corona, onset = rng.uniform(0.018, 0.03), rng.uniform(11.0, 14.0)
    _spinning(folder, rng, corona=corona, onset=onset, loggers=(Logger("ms", zero=12.0), PLAIN))
    return Truth(
        f"from {onset:.2f} kV on, the spinneret loses {corona:.4f} uA/kV^2 v (v - {onset:.2f} kV) to the air (corona)",
        PHYSICS,
        CONDUCTED,
    )


def spinning_drift(folder: Path, rng: Rng) -> Truth:
    drift = rng.uniform(3.0, 6.0) * rng.choice([-1.0, 1.0])
    _spinning(folder, rng, drift=drift, loggers=(PLAIN, Logger("ms", zero=-400.0)))
    return Truth(f"the zero of the current drifts by {drift:.2f} uA in the course of the first recording", SENSOR)


# --- a cloth with titania that bleaches dye under a lamp, FMI 2 Co-Simulation; min, mg/L, mL/min; degC is a column
PHOTOCAT = OdeModel(
    "photocatalyst",
    {
        "V": (2e-3, "m^3"),
        "k": (2.5e-5, "m^2/J"),
        "b": (0.03, "1/K"),
        "y": (0.6, ""),
        "k_s": (1.2e-5, "m^2/J"),
        "c_feed": (0.02, "kg/m^3"),
        "c_begin": (0.01, "kg/m^3"),
    },
    {"lamp": "W/m^2", "feed": "m^3/s", "warmth": "K"},
    {
        "c": ("kg/m^3", "c_begin", "feed*(c_feed - c)/V - k*lamp*exp(b*(warmth - 298.15))*c"),
        "s": ("kg/m^3", "0.0", "y*k*lamp*exp(b*(warmth - 298.15))*c - k_s*lamp*s - feed*s/V"),
    },
    {"dye": ("kg/m^3", "c"), "split": ("kg/m^3", "s")},
    2.0,
)
PHOTOCAT_KNOWN = {"V": 0.02, "k": 0.07, "b": 0.1, "y": 0.05, "k_s": 0.08, "c_feed": 0.02}


def _photocat(
    folder: Path,
    rng: Rng,
    half: float = np.inf,
    fast: float = 0.0,
    strayed: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> None:
    """Sites on the cloth may be taken: dye is bleached as c/(1 + c/half), half in mg/L.

    A clock that is `fast` is the logger's. `strayed` is by how much [mg/L] the dye at each begin is off (deviation),
    which is stated.
    """
    PHOTOCAT.build(folder)
    names = (("leds", "lamp", "W/m^2"), ("doser", "feed", "mL/min"), ("bath", "warmth", "degC"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("cloth", "photocatalyst", "internal")
    wires = "".join(f"  - {c}.{n} -> cloth.{n}\n" for c, n, _ in names)
    scenario(folder, "A cloth that bleaches dye", 14400.0, 5, 10, parts, wires)
    data_sheet(folder, PHOTOCAT, PHOTOCAT_KNOWN)
    volume, k, b, y, k_s, c_feed, usual = drawn(rng, PHOTOCAT, PHOTOCAT_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Concentrations are in mg/L."""
        c, split = (float(s) for s in x)
        lamp, renewed = float(u[0]), float(u[1]) / 6e7 / volume
        bleached = k * lamp * np.exp(b * (float(u[2]) + CELSIUS - 298.15)) * c / (1.0 + c / half)
        return [renewed * (1e3 * c_feed - c) - bleached, y * bleached - k_s * lamp * split - renewed * split]

    for number, (name, stop) in enumerate((("first", 14400.0), ("second", 12000.0), ("third", 13200.0))):
        lamp = drawn_steps(rng, stop, 620.0, 3.0, 60.0, 10.0)
        if name == "third":
            lamp = wandering(rng, stop, 540.0, 5.0, 58.0, 10.0)
        feed = drawn_steps(rng, stop, 1000.0, 8.0, 60.0, 10.0)
        lamp, feed = later(lamp, 5.0), later(feed, 5.0)
        warmth = ramped(rng, stop, 2400.0, 21.0, 33.0, 40.0)
        said = float(f"{1e3 * usual + rng.uniform(-2.0, 4.0):.3g}") if strayed else 1e3 * usual
        start = (said + strayed * float(rng.normal()), 0.0)
        t, x = integrated(rates, start, (lamp, feed, warmth), stop, 5.0)
        sensors = [
            Sensor("cloth.dye", "E664 mg/L", "mg/L", scaled(0, 1.0), 0.07, 10.0, noise_stated, 0.02),
            Sensor("cloth.split", "TOC rest", "mg/L", scaled(1, 1.0), 0.08, 30.0, noise_stated, 0.05),
        ]
        sidecar: dict[str, Any] = {}
        if strayed:
            sidecar["components"] = {"cloth": {"parameters": {"c_begin": f"{said:.6g} mg/L"}}}
            sidecar["uncertain"] = {"cloth.c_begin": f"{strayed:g} mg/L"}
        made = Written(
            t,
            x,
            sensors,
            {"leds.lamp": (lamp, "W/m^2"), "doser.feed": (feed, "mL/min"), "bath.warmth": (warmth, "degC")},
            loggers[number % len(loggers)],
            recorded=["bath.warmth"],
            sidecar=sidecar,
        )
        write(folder / name, rng, made)


def photocat_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("h", zero=3.0), Logger("min", zero=-15.0, gap=(4200.0, 5400.0)), Logger("s", zero=500.0))
    _photocat(folder, rng, strayed=0.4, noise_stated=0.88, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, dye at the begin is stated and off by 0.4 mg/L (deviation), which is stated "
        "too, noise stated 1.14 times too small, two rates, a gap of 20 min, three loggers of h, min and s, "
        "Co-Simulation",
        FINE,
    )


def photocat_sites(folder: Path, rng: Rng) -> Truth:
    half = rng.uniform(16.0, 28.0)
    _photocat(folder, rng, half=half, loggers=(Logger("min", zero=1.0), Logger("h")))
    return Truth(
        f"sites on the cloth are taken: dye is bleached as c/(1 + c/{half:.2f} mg/L)",
        PHYSICS,
        (
            "saturation",
            "saturating_gain",
            "reaction_order",
            "nonlinear_rate",
            "rate_of_state",
            "state_dependent_rate",
        ),
    )


def photocat_clock(folder: Path, rng: Rng) -> Truth:
    fast = rng.uniform(8e-3, 1.4e-2) * rng.choice([-1.0, 1.0])
    _photocat(folder, rng, loggers=(Logger("min"), Logger("s", rate=1.0 + fast), Logger("min", zero=20.0)))
    return Truth(
        f"the clock of the second recording is off by {100 * fast:+.2f} % (fast is +), which is not stated",
        (*RECORDING, *SENSOR),
    )


# --- motor (FMI 2, Model Exchange) of a hose pump and its air bottle (FMI 3, Co-Simulation); V, A, %, rpm, kPa, mL/s
ROLLER = OdeModel(
    "hose_pump",
    {
        "k": (0.4, "V*s/rad"),
        "R": (4.0, "ohm"),
        "J": (4e-3, "kg*m^2"),
        "d": (0.01, "N*m*s/rad"),
        "D": (1e-6, "m^3/rad"),
    },
    {"volts": "V", "back": "Pa"},
    {"w": ("rad/s", "0.0", "(k*(volts - k*w)/R - d*w - D*back)/J")},
    {"speed": ("rad/s", "w"), "amperes": ("A", "(volts - k*w)/R"), "flow": ("m^3/s", "D*w")},
    2e-3,
)
BOTTLE = OdeModel(
    "air_bottle",
    {"V_0": (4e-4, "m^3"), "G": (8e-10, "m^3/s/Pa"), "p_room": (1.01e5, "Pa")},
    {"flow": "m^3/s", "valve": ""},
    {"V_l": ("m^3", "0.0", "flow - G*valve*p_room*V_l/fmax(V_0 - V_l, 1e-6)")},
    {
        "pressure": ("Pa", "p_room*V_l/fmax(V_0 - V_l, 1e-6)"),
        "outlet": ("m^3/s", "G*valve*p_room*V_l/fmax(V_0 - V_l, 1e-6)"),
    },
    2e-3,
)
ROLLER_KNOWN = {"k": 0.02, "R": 0.05, "J": 0.06, "d": 0.1, "D": 0.03}
BOTTLE_KNOWN = {"V_0": 0.05, "G": 0.05}


def _roller(
    folder: Path,
    rng: Rng,
    slip: float = 0.0,
    dry: float = 0.0,
    opened: tuple[float, float] | None = None,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Two FMUs; `slip` mL/s/kPa may go back under the rollers; these may rub with `dry` N m.

    Opened is begin and end [s] of a stretch of the second recording in which the pinch valve has no power and is open.
    """
    ROLLER.build(folder)
    build3(BOTTLE, folder, has_exchange=False)
    data_sheet(folder, BOTTLE, BOTTLE_KNOWN)
    (folder / "numbers.yaml").rename(folder / "bottle.yaml")
    data_sheet(folder, ROLLER, ROLLER_KNOWN)
    parts = (
        programme("knob", ("volts", "V"))
        + programme("pinch", ("valve", "'%'")).replace("0 '%'", "0 %")
        + with_numbers("pump", "hose_pump")
        + with_numbers("bottle", "air_bottle", "internal").replace("numbers.yaml", "bottle.yaml")
    )
    wires = (
        "  - knob.volts -> pump.volts\n  - pinch.valve -> bottle.valve\n  - pump.flow -> bottle.flow\n"
        "  - bottle.pressure -> pump.back\n"
    )
    scenario(folder, "A hose pump and its air bottle", 96.0, 0.04, 0.08, parts, wires)
    k, r, inertia, d, delivered = drawn(rng, ROLLER, ROLLER_KNOWN)
    v_0, g, p_room = drawn(rng, BOTTLE, BOTTLE_KNOWN)

    def pressure(x: Array) -> Array:
        """In the bottle [kPa], of the water in it [mL]."""
        return np.asarray(1e-3 * p_room * x[..., 1] / (1e6 * v_0 - x[..., 1]))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        w, p = float(x[0]), float(pressure(x))
        driven = k * (float(u[0]) - k * w) / r
        return [
            (driven - d * w - 1e3 * delivered * p - dry * np.tanh(w / 0.2)) / inertia,
            1e6 * delivered * w - slip * p - 1e7 * g * float(u[1]) * p,
        ]

    for number, (name, stop) in enumerate((("first", 96.0), ("second", 80.0), ("third", 88.0))):
        volts = drawn_steps(rng, stop, 4.0, 3.0, 12.0, 0.08)
        if name == "third":
            volts = telegraph(rng, stop, 3.2, 3.5, 11.5, 0.08)
        valve = drawn_steps(rng, stop, 7.0, 35.0, 100.0, 0.08)
        volts, valve = later(volts, 0.04), later(valve, 0.04)
        run = valve
        if opened is not None and name == "second":
            run = between(valve, opened[0], opened[1], lambda v: 100.0)
        t, x = integrated(rates, (0.0, 0.0), (volts, run), stop, 0.02)
        sensors = [
            Sensor("pump.speed", "Drehzahl", "rpm", scaled(0, RPM), 1.0, 0.08, noise_stated, 0.5),
            Sensor(
                "pump.amperes",
                "I_mot/A",
                "A",
                lambda t, x, u: (u[:, 0] - k * x[:, 0]) / r,
                0.01,
                0.08,
                noise_stated,
                5e-3,
            ),
            Sensor("bottle.pressure", "p kPa", "kPa", lambda t, x, u: pressure(x), 0.3, 0.08, noise_stated, 0.1),
            Sensor(
                "bottle.outlet",
                "Coriolis",
                "mL/s",
                lambda t, x, u: 1e7 * g * u[:, 1] * pressure(x),
                0.12,
                0.16,
                noise_stated,
                0.02,
            ),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"knob.volts": (volts, "V"), "pinch.valve": (run, "%")},
            loggers[number % len(loggers)],
            told={} if run is valve else {"pinch.valve": valve},
        )
        write(folder / name, rng, made)


def roller_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=-2e3), Logger("min", zero=12.0, empty=0.02), Logger("s", zero=0.7, gap=(40.0, 46.0)))
    _roller(folder, rng, noise_stated=None, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, two FMUs, noise is not stated, two rates, empty cells, a gap of 6 s, three "
        "loggers of ms, min and s",
        FINE,
    )


def roller_slip(folder: Path, rng: Rng) -> Truth:
    slip = rng.uniform(0.03, 0.055)
    _roller(folder, rng, slip=slip, loggers=(PLAIN, Logger("min", zero=0.5)))
    return Truth(f"water goes back under the rollers, {slip:.4f} mL/s/kPa p", PHYSICS, LEAKING)


def roller_two(folder: Path, rng: Rng) -> Truth:
    slip, dry = rng.uniform(0.03, 0.055), rng.uniform(0.02, 0.04)
    _roller(folder, rng, slip=slip, dry=dry, loggers=(Logger("s", zero=88.0), Logger("ms")))
    return Truth(
        f"water goes back under the rollers, {slip:.4f} mL/s/kPa p, and the rollers rub on the hose with {dry:.4f} N m",
        PHYSICS,
        (*LEAKING, *RUBBING),
    )


def roller_opened(folder: Path, rng: Rng) -> Truth:
    begin = 2.0 * round(rng.uniform(8.0, 26.0)) + 0.04
    _roller(folder, rng, opened=(begin, begin + 18.0), loggers=(Logger("min"), PLAIN))
    return Truth(
        f"the pinch valve has no power and is open, {begin:g} s to {begin + 18.0:g} s of the second recording, and is "
        "said to throttle",
        SENSOR,
        ("input_fault",),
    )


# --- a bladder of silicone in which a liquid boils, FMI 3 Co-Simulation; s, W, kPa, mL, degC; room is a column
VAPOUR = OdeModel(
    "boiling_bladder",
    {
        "C": (25.0, "J/K"),
        "h": (0.5, "W/K"),
        "C_s": (20.0, "J/K"),
        "h_o": (0.35, "W/K"),
        "V_0": (2.4e-5, "m^3"),
        "C_b": (9e-10, "m^3/Pa"),
        "tau": (1.5, "s"),
        "T_boil": (307.15, "K"),
        "B": (3416.0, "K"),
        "L": (1.42e5, "J/kg"),
        "M": (0.2, "kg/mol"),
        "p_room": (1.013e5, "Pa"),
        "T_begin": (311.15, "K"),
    },
    {"heat": "W", "load": "Pa", "room": "K"},
    {
        "T": (
            "K",
            "T_begin",
            "(heat - h*(T - T_s) - L*M*p_room*exp(B*(1.0/T_boil - 1.0/T))/(8.314*T)"
            "*(V_0 + C_b*(p_room*exp(B*(1.0/T_boil - 1.0/T)) - p_room - load) - V)/tau)/C",
        ),
        "T_s": ("K", "T_begin", "(h*(T - T_s) - h_o*(T_s - room))/C_s"),
        "V": (
            "m^3",
            "V_0 + C_b*(p_room*exp(B*(1.0/T_boil - 1.0/T_begin)) - p_room)",
            "(V_0 + C_b*(p_room*exp(B*(1.0/T_boil - 1.0/T)) - p_room - load) - V)/tau",
        ),
    },
    {
        "gauge": ("Pa", "p_room*exp(B*(1.0/T_boil - 1.0/T)) - p_room"),
        "liquid": ("K", "T"),
        "bladder": ("m^3", "V"),
    },
    0.05,
)
VAPOUR_KNOWN = {
    "C": 0.06,
    "h": 0.06,
    "C_s": 0.06,
    "h_o": 0.06,
    "V_0": 0.05,
    "C_b": 0.06,
    "tau": 0.1,
    "T_boil": 6e-4,
    "B": 0.02,
}


def _vapour(
    folder: Path,
    rng: Rng,
    air: float = 0.0,
    lag: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Air may have been left in the bladder, `air` umol, with its own share of the pressure.

    The thermocouple in the liquid may follow with a lag [s] in the second recording.
    """
    build3(VAPOUR, folder, has_exchange=False)
    names = (("wire", "heat", "W"), ("plate", "load", "kPa"), ("lab", "room", "degC"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("bladder", "boiling_bladder", "internal")
    wires = "".join(f"  - {c}.{n} -> bladder.{n}\n" for c, n, _ in names)
    scenario(folder, "A bladder in which a liquid boils", 900.0, 0.25, 0.5, parts, wires)
    data_sheet(folder, VAPOUR, VAPOUR_KNOWN)
    c, h, c_s, h_o, v_0, c_b, tau, t_boil, slope, latent, molar, p_room, begin = drawn(rng, VAPOUR, VAPOUR_KNOWN)

    def saturated(kelvin: Array) -> Array:
        """Pressure of the vapour [kPa]."""
        return np.asarray(1e-3 * p_room * np.exp(slope * (1.0 / t_boil - 1.0 / kelvin)))

    def gauge(x: Array) -> Array:
        """In the bladder [kPa], of temperature [K] and volume [mL]."""
        return np.asarray(saturated(x[..., 0]) + 1e-3 * air * GAS_CONSTANT * x[..., 0] / x[..., 2] - 1e-3 * p_room)

    for number, (name, stop) in enumerate((("first", 900.0), ("second", 720.0), ("third", 800.0))):
        heat = drawn_steps(rng, stop, 40.0, 1.5, 6.5, 0.5)
        if name == "third":
            heat = stairs(rng, stop, 35.0, 1.8, 6.2, 4, 0.5)
        load = drawn_steps(rng, stop, 22.0, 0.0, 14.0, 0.5)
        heat, load = later(heat, 0.25), later(load, 0.25)
        room = ramped(rng, stop, 150.0, 22.0, 26.0, 5.0)
        late = lag if name == "second" else 0.0

        def rates(t: float, x: Array, u: Array, late: float = late) -> list[float]:
            """The volume is in mL."""
            liquid, skin, volume, shown = (float(s) for s in x)
            grown = (1e6 * v_0 + 1e9 * c_b * (float(gauge(x)) - float(u[1])) - volume) / tau
            density = 1e3 * molar * float(saturated(x[0])) / (GAS_CONSTANT * liquid)
            warmed = (float(u[0]) - h * (liquid - skin) - 1e-6 * latent * density * grown) / c
            return [
                warmed,
                (h * (liquid - skin) - h_o * (skin - float(u[2]) - CELSIUS)) / c_s,
                grown,
                (liquid - shown) / late if late else warmed,
            ]

        full = 1e6 * v_0
        for _ in range(200):
            full = 0.5 * full + 0.5 * (1e6 * v_0 + 1e9 * c_b * float(gauge(np.asarray([begin, begin, full]))))
        t, x = integrated(rates, (begin, begin, full, begin), (heat, load, room), stop, 0.125)
        sensors = [
            Sensor("bladder.gauge", "MPX (kPa)", "kPa", lambda t, x, u: gauge(x), 0.15, 0.5, noise_stated, 0.05),
            Sensor("bladder.liquid", "TC innen", "degC", celsius(3), 0.12, 0.5, noise_stated, 0.05),
            Sensor("bladder.bladder", "Kamera mL", "mL", scaled(2, 1.0), 0.5, 0.5, noise_stated, 0.2),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"wire.heat": (heat, "W"), "plate.load": (load, "kPa"), "lab.room": (room, "degC")},
            loggers[number % len(loggers)],
            recorded=["lab.room"],
        )
        write(folder / name, rng, made)


def vapour_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=-4.0, jitter=0.15), Logger("s", zero=77.0, gap=(300.0, 341.0)), Logger("ms"))
    _vapour(folder, rng, noise_stated=1.22, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.22 times too large, jitter, a gap of 41 s, three loggers of "
        "min, s and ms, Co-Simulation",
        FINE,
    )


def vapour_air(folder: Path, rng: Rng) -> Truth:
    air = rng.uniform(60.0, 110.0)
    _vapour(folder, rng, air=air, loggers=(Logger("s", zero=-10.0), Logger("min")))
    return Truth(
        f"{air:.1f} umol of air were left in the bladder, which have a share n R T/V of the pressure besides",
        PHYSICS,
    )


def vapour_lag(folder: Path, rng: Rng) -> Truth:
    lag = rng.uniform(6.0, 11.0)
    _vapour(folder, rng, lag=lag, loggers=(PLAIN, Logger("s", zero=3.0), Logger("min")))
    return Truth(
        f"the thermocouple in the liquid follows with a lag of {lag:.2f} s in the second recording (a thicker one)",
        SENSOR,
    )


# --- a loop of breathing air with lime that binds what is breathed out, FMI 3, both interfaces, without units
LOOP = OdeModel(
    "rebreather",
    {
        "V": (30.0, ""),
        "o_rest": (0.3, ""),
        "k_o": (0.0115, ""),
        "r": (0.85, ""),
        "s": (55.0, ""),
        "H": (3000.0, ""),
        "C": (1500.0, ""),
        "h": (2.8, ""),
        "O_begin": (20.9, ""),
        "C_begin": (0.4, ""),
        "T_begin": (24.0, ""),
    },
    {"work": "", "oxygen": "", "purge": "", "room": ""},
    {
        "O": (
            "",
            "O_begin",
            "(100.0*(oxygen - o_rest - k_o*work) + 20.9*purge - O*(oxygen + purge - o_rest - k_o*work))/(60.0*V)",
        ),
        "D": (
            "",
            "C_begin",
            "(100.0*r*(o_rest + k_o*work) - s*D - D*(oxygen + purge - o_rest - k_o*work))/(60.0*V)",
        ),
        "T": ("", "T_begin", "(H*s*D/6000.0 - h*(T - room))/C"),
    },
    {"o2": ("", "O"), "co2": ("", "D"), "lime": ("", "T")},
    1.0,
)
LOOP_KNOWN = {"V": 0.04, "o_rest": 0.05, "k_o": 0.04, "r": 0.03, "s": 0.06, "H": 0.03, "C": 0.06, "h": 0.06}


def _rebreather(
    folder: Path,
    rng: Rng,
    room_for: float = np.inf,
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The lime may be spent by what it has bound, s (1 - bound/room_for), in L; each recording has fresh lime.

    The second recording may be said to have had the oxygen of another run.
    """
    build3(LOOP, folder)
    names = (("ergometer", "work"), ("bottle", "oxygen"), ("fan", "purge"), ("lab", "room"))
    parts = "".join(programme(c, (n, "")) for c, n in names) + with_numbers("hood", "rebreather")
    wires = "".join(f"  - {c}.{n} -> hood.{n}\n" for c, n in names)
    scenario(folder, "A loop of breathing air", 4500.0, 2.5, 5, parts, wires)
    data_sheet(folder, LOOP, LOOP_KNOWN)
    volume, o_rest, k_o, r, s, heat, c, h, o_begin, c_begin, begin = drawn(rng, LOOP, LOOP_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        o2, co2, lime, bound = (float(v) for v in x)
        used = o_rest + k_o * float(u[0])
        out = float(u[1]) + float(u[2]) - used
        scrubbed = s * (1.0 - bound / room_for) * co2
        return [
            (100.0 * (float(u[1]) - used) + 20.9 * float(u[2]) - o2 * out) / (60.0 * volume),
            (100.0 * r * used - scrubbed - co2 * out) / (60.0 * volume),
            (heat * scrubbed / 6000.0 - h * (lime - float(u[3]))) / c,
            scrubbed / 6000.0,
        ]

    other = later(drawn_steps(rng, 3600.0, 260.0, 1.2, 2.6, 5.0), 2.5)
    for number, (name, stop) in enumerate((("first", 4500.0), ("second", 3600.0), ("third", 4000.0))):
        work = drawn_steps(rng, stop, 150.0, 20.0, 140.0, 5.0)
        if name == "third":
            work = wandering(rng, stop, 130.0, 25.0, 135.0, 5.0)
        oxygen = drawn_steps(rng, stop, 260.0, 1.2, 2.6, 5.0)
        purge = drawn_steps(rng, stop, 500.0, 10.0, 18.0, 5.0)
        work, oxygen, purge = later(work, 2.5), later(oxygen, 2.5), later(purge, 2.5)
        room = ramped(rng, stop, 900.0, 20.0, 26.0, 60.0)
        t, x = integrated(rates, (o_begin, c_begin, begin, 0.0), (work, oxygen, purge, room), stop, 1.25)
        sensors = [
            Sensor("hood.o2", "O2 cell", "1", scaled(0, 1.0), 0.08, 5.0, noise_stated, 0.02, wild=wild),
            Sensor("hood.co2", "NDIR", "1", scaled(1, 1.0), 0.012, 5.0, noise_stated, 5e-3, wild=wild),
            Sensor("hood.lime", "Kalk degC", "1", scaled(2, 1.0), 0.15, 10.0, noise_stated, 0.1, wild=wild),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "ergometer.work": (work, ""),
                "bottle.oxygen": (oxygen, ""),
                "fan.purge": (purge, ""),
                "lab.room": (room, ""),
            },
            loggers[number % len(loggers)],
            recorded=["lab.room"],
            told={"bottle.oxygen": other} if is_other and name == "second" else {},
        )
        write(folder / name, rng, made)
        idle_column(folder / name, "rH %", lambda n: np.asarray(81.0 + 0.6 * rng.standard_normal(n)))


def rebreather_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=3.0, empty=0.02), Logger("h", zero=-0.4), Logger("s", zero=60.0, jitter=0.1))
    _rebreather(folder, rng, noise_stated=0.87, wild=0.006, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, no units, wild readings, noise stated 1.15 times too small, two rates, a "
        "column that nothing names, empty cells, jitter, three loggers of min, h and s",
        FINE,
    )


def rebreather_spent(folder: Path, rng: Rng) -> Truth:
    room_for = rng.uniform(170.0, 260.0)
    _rebreather(folder, rng, room_for=room_for, loggers=(PLAIN, Logger("min", zero=-6.0)))
    return Truth(
        f"the lime is spent by what it has bound: s (1 - bound/{room_for:.1f} L), fresh in each recording",
        PHYSICS,
        (*STORED, "saturation"),
    )


def rebreather_other_run(folder: Path, rng: Rng) -> Truth:
    _rebreather(folder, rng, is_other=True, loggers=(Logger("min", zero=10.0), PLAIN, Logger("h")))
    return Truth("the second recording is said to have had the oxygen of another run", (*RECORDING, *SENSOR))


# --- a steam iron on a board, preheated, FMI 2 Co-Simulation; min, W, g/min, %, degC; room is a column
IRON = OdeModel(
    "steam_iron",
    {
        "C_e": (250.0, "J/K"),
        "C_s": (500.0, "J/K"),
        "g": (12.0, "W/K"),
        "h_0": (1.2, "W/K"),
        "h_c": (3.5, "W/K"),
        "q": (2.6e6, "J/kg"),
        "T_begin": (433.15, "K"),
    },
    {"power": "W", "drip": "kg/s", "press": "", "room": "K"},
    {
        "T_e": ("K", "T_begin", "(power - g*(T_e - T_s) - q*drip)/C_e"),
        "T_s": ("K", "T_begin", "(g*(T_e - T_s) - (h_0 + h_c*press)*(T_s - room))/C_s"),
    },
    {"chamber": ("K", "T_e"), "sole": ("K", "T_s"), "ironed": ("W", "h_c*press*(T_s - room)")},
    0.1,
)
IRON_KNOWN = {"C_e": 0.06, "C_s": 0.05, "g": 0.06, "h_0": 0.08, "h_c": 0.06}


def _iron(
    folder: Path,
    rng: Rng,
    slow: float = 0.0,
    wet: float = 0.0,
    colder: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Water may stand in the chamber until it boils off, in `slow` s where the chamber has 180 degC.

    Steam may wet the cloth, which then conducts h_c (1 + wet steam), steam in g/min. The iron may be colder [K] at the
    begin of the second recording than is said.
    """
    IRON.build(folder)
    names = (("rod", "power", "W"), ("pump", "drip", "g/min"), ("hand", "press", "'%'"), ("shop", "room", "degC"))
    parts = "".join(programme(c, (n, u)).replace("0 '%'", "0 %") for c, n, u in names)
    parts += with_numbers("iron", "steam_iron", "internal")
    wires = "".join(f"  - {c}.{n} -> iron.{n}\n" for c, n, _ in names)
    scenario(folder, "A steam iron", 900.0, 0.5, 1, parts, wires)
    data_sheet(folder, IRON, IRON_KNOWN)
    c_e, c_s, g, h_0, h_c, evaporation, begin = drawn(rng, IRON, IRON_KNOWN)

    def steam(x: Array, drip: Array) -> Array:
        """What evaporates [g/min], of the chamber's temperature [K] and the water in it [g]."""
        if not slow:
            return np.asarray(drip)
        return np.asarray(60.0 * x[..., 2] * np.maximum(x[..., 0] - 373.15, 0.0) / (80.0 * slow))

    def ironed(x: Array, u: Array) -> Array:
        """Heat into the cloth [W]."""
        conducted = 0.01 * h_c * u[..., 2] * (1.0 + wet * steam(x, u[..., 1]))
        return np.asarray(conducted * (x[..., 1] - u[..., 3] - CELSIUS))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        chamber, sole, _ = (float(s) for s in x)
        boiled = float(steam(x, u[1]))
        passed = g * (chamber - sole)
        return [
            (float(u[0]) - passed - evaporation * boiled / 6e4) / c_e,
            (passed - h_0 * (sole - float(u[3]) - CELSIUS) - float(ironed(x, u))) / c_s,
            (float(u[1]) - boiled) / 60.0,
        ]

    for number, (name, stop) in enumerate((("first", 900.0), ("second", 720.0), ("third", 800.0))):
        power = drawn_steps(rng, stop, 45.0, 250.0, 1200.0, 1.0)
        if name == "third":
            power = telegraph(rng, stop, 32.0, 300.0, 1150.0, 1.0)
        drip = bursts(rng, stop, 22.0, 24.0, 4.0, 14.0, 1.0)
        press = drawn_steps(rng, stop, 30.0, 0.0, 100.0, 1.0)
        power, drip, press = later(power, 0.5), later(drip, 0.5), later(press, 0.5)
        room = ramped(rng, stop, 200.0, 21.0, 26.0, 5.0)
        at = begin - (colder if name == "second" else 0.0)
        t, x = integrated(rates, (at, at, 0.0), (power, drip, press, room), stop, 0.25)
        sensors = [
            Sensor("iron.chamber", "TC Kammer", "degC", celsius(0), 0.5, 1.0, 1.0, 0.1),
            Sensor("iron.sole", "TC Sohle", "degC", celsius(1), 0.4, 1.0, 1.0, 0.1),
            Sensor("iron.ironed", "flux plate W", "W", lambda t, x, u: ironed(x, u), 4.0, 1.0, 1.0, 1.0),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "rod.power": (power, "W"),
                "pump.drip": (drip, "g/min"),
                "hand.press": (press, "%"),
                "shop.room": (room, "degC"),
            },
            loggers[number % len(loggers)],
            recorded=["shop.room"],
        )
        write(folder / name, rng, made)


def iron_puddle(folder: Path, rng: Rng) -> Truth:
    slow = rng.uniform(9.0, 16.0)
    _iron(folder, rng, slow=slow, loggers=(Logger("min", zero=2.0), PLAIN))
    return Truth(
        f"water stands in the chamber until it boils off, in {slow:.2f} s where the chamber has 180 degC, in "
        "proportion to what stands there and to how much warmer than 100 degC it is",
        PHYSICS,
        STORED,
    )


def iron_two(folder: Path, rng: Rng) -> Truth:
    slow, wet = rng.uniform(9.0, 16.0), rng.uniform(0.025, 0.045)
    _iron(folder, rng, slow=slow, wet=wet, loggers=(PLAIN, Logger("ms", zero=-5e3)))
    return Truth(
        f"water stands in the chamber until it boils off, in {slow:.2f} s where the chamber has 180 degC, and steam "
        f"wets the cloth, which then conducts h_c (1 + {wet:.4f} steam/(g/min))",
        PHYSICS,
        (*STORED, *CONDUCTED, "conductance_of_moisture", "wet_conduction"),
    )


def iron_colder(folder: Path, rng: Rng) -> Truth:
    colder = rng.uniform(18.0, 32.0)
    _iron(folder, rng, colder=colder, loggers=(PLAIN, Logger("min", zero=1.0)))
    return Truth(
        f"the iron is {colder:.1f} K colder at the begin of the second recording than is said", (*RECORDING, *SENSOR)
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    kite_canopy,
    pouch_null,
    spinning_drift,
    photocat_sites,
    roller_null,
    vapour_lag,
    rebreather_null,
    iron_puddle,
    kite_null,
    pouch_clipped,
    spinning_corona,
    photocat_clock,
    roller_slip,
    vapour_null,
    rebreather_other_run,
    iron_two,
    kite_late,
    pouch_kept,
    spinning_null,
    photocat_null,
    roller_opened,
    vapour_air,
    rebreather_spent,
    iron_colder,
    roller_two,
)
