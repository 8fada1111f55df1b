"""Twenty-sixth set: a fission reactor, a still, a shaken frame, a well, a pool, a ball mill, a drill, three supplies.

Written by an author who had read neither the library of laws nor its proof nor its tests nor its thresholds, and who
had not run a diagnosis, of these cases or of any other; of the earlier sets, the author had read two and the helpers
that these take from the others. Truths are integrated from equations that stand here, by scipy or, of the coils, by a
scheme of their own. How large an effect is, and how far the numbers are off, is drawn; the deviations of the numbers
are those that a parameter set states. Recordings of a rig differ in length and in logger; the one that is held out was
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
from evaluation.strangers.eleventh_set import RPM, telegraph
from evaluation.strangers.fifteenth_set import ramped
from evaluation.strangers.fifth_set import integrated
from evaluation.strangers.first_set import PLAIN, Rng, programme, scenario
from evaluation.strangers.fmi3 import build as build3
from evaluation.strangers.fourth_set import between, bursts, data_sheet, scaled
from evaluation.strangers.lab import CELSIUS, Logger, Sensor, Steps, Written, celsius, drawn_steps, write
from evaluation.strangers.sixteenth_set import later
from evaluation.strangers.tenth_set import stairs
from evaluation.strangers.third_set import drawn, with_numbers
from evaluation.strangers.thirteenth_set import wandering
from evaluation.strangers.truth import FINE, PHYSICS, RECORDING, SENSOR, Truth

#: Heat of a cubic metre of water [J/(m^3*K)], a foot-pound [N m], densities of ore and water [kg/m^3].
WATER, FOOT_POUND, ORE, LIQUID = 4.18e6, 1.3558179, 2700.0, 1000.0
#: Laws that are true where something is stored of which the model knows nothing.
STORED = ("hidden_state", "hidden_mass", "hidden_capacity", "second_mass", "hidden_storage")
#: Laws that are true where something wears with what went through it.
WORN = ("wear", "fouling", "clogging", "ageing", "aging", "degradation", "drift_of_parameter", "hidden_state")
#: Laws that are true where something begins at a value.
BEGINNING = ("threshold", "dead_zone", "dead_band", "onset")
#: Laws that are true where a number depends on a state.
RATED = ("nonlinear_rate", "rate_of_state", "state_dependent_rate", "parameter_of_state", "interaction")
#: Laws that are true where bubbles take reactivity once the fuel is hot.
BUBBLING = (*BEGINNING, *RATED, "saturation", "gain_of_state", "state_dependent_gain", "boiling")
#: Laws that are true where vapour carries liquid up, above a load.
CARRYING = (*BEGINNING, *RATED, "mixing", "back_mixing", "saturation", "state_dependent_gain")
#: Laws that are true where a spring softens with the work that it took.
LOOSENING = (*WORN, *RATED, "stiffness_of_state", "softening", "hysteresis", "nonlinear_stiffness")
#: Laws that are true where water meets more resistance the faster it flows.
TURBULENT = (
    *RATED,
    "quadratic_drag",
    "quadratic_loss",
    "turbulence",
    "turbulent_flow",
    "nonlinear_conductance",
    "nonlinear_resistance",
    "nonlinear_loss",
    "conductance_of_state",
)
#: Laws that are true where two things take each other away, above a value.
REACTING = (*BEGINNING, *RATED, "second_order_rate", "nonlinear_loss", "side_reaction", "reaction_order")
#: Laws that are true where what is full works less well.
OVERFILLED = (*RATED, "saturation", "reaction_order", "parameter_of_state", "gain_of_state")
#: Laws that are true where what was cut lies about for a while.
LITTERED = (*STORED, *RATED, "wear", "memory", "hysteresis", "relaxation")
#: Laws that are true where sources have a piece of wire in common.
SHARED = (
    "source_resistance",
    "supply_resistance",
    "inner_resistance",
    "common_resistance",
    "shared_resistance",
    "shared_return",
    "droop",
    "lead",
    "contact",
    "interaction",
)


# --- a small reactor of fission with strong feedback of its fuel, FMI 2 Model Exchange; s, mm, L/s, degC, kW
TRIGA = OdeModel(
    "triga",
    {
        "worth": (18.0, "1/m"),
        "z_0": (0.2, "m"),
        "tau_r": (1.5, "s"),
        "b": (0.6, ""),
        "l_1": (0.3, "1/s"),
        "l_2": (0.03, "1/s"),
        "a_f": (0.012, "1/K"),
        "a_w": (0.006, "1/K"),
        "P_0": (1e5, "W"),
        "U": (900.0, "W/K"),
        "C_f": (1.6e4, "J/K"),
        "C_w": (6e4, "J/K"),
        "z_begin": (0.245, "m"),
        "n_begin": (0.5, ""),
        "f_begin": (356.15, "K"),
        "w_begin": (302.15, "K"),
    },
    {"rod": "m", "flow": "m^3/s", "inlet": "K"},
    {
        "z": ("m", "z_begin", "(rod - z)/tau_r"),
        "x_1": (
            "",
            "n_begin",
            "l_1*((b*x_1 + (1.0 - b)*x_2)/(1.0 - worth*(z - z_0) + a_f*(T_f - 300.0) + a_w*(T_w - 300.0)) - x_1)",
        ),
        "x_2": (
            "",
            "n_begin",
            "l_2*((b*x_1 + (1.0 - b)*x_2)/(1.0 - worth*(z - z_0) + a_f*(T_f - 300.0) + a_w*(T_w - 300.0)) - x_2)",
        ),
        "T_f": (
            "K",
            "f_begin",
            "(P_0*(b*x_1 + (1.0 - b)*x_2)"
            "/(1.0 - worth*(z - z_0) + a_f*(T_f - 300.0) + a_w*(T_w - 300.0)) - U*(T_f - T_w))/C_f",
        ),
        "T_w": ("K", "w_begin", f"(U*(T_f - T_w) - {WATER}*flow*(T_w - inlet))/C_w"),
    },
    {
        "power": (
            "W",
            "P_0*(b*x_1 + (1.0 - b)*x_2)/(1.0 - worth*(z - z_0) + a_f*(T_f - 300.0) + a_w*(T_w - 300.0))",
        ),
        "fuel": ("K", "T_f"),
        "outlet": ("K", "T_w"),
    },
    0.1,
)
TRIGA_KNOWN = {
    "worth": 0.03,
    "z_0": 4e-3,
    "tau_r": 0.08,
    "b": 0.03,
    "l_1": 0.05,
    "l_2": 0.05,
    "a_f": 0.05,
    "a_w": 0.1,
    "P_0": 0.03,
    "U": 0.05,
    "C_f": 0.05,
    "C_w": 0.08,
}


def longest_held(steps: Steps, stop: float, span: float) -> tuple[float, float, float]:
    """Begin and end [s] of a stretch after the largest change in the middle, and the level before it."""
    moves = [
        (abs(now - before), t, before)
        for t, before, now in zip(steps.times[1:], steps.levels, steps.levels[1:])
        if 0.25 * stop < t < 0.65 * stop
    ]
    _, since, before = max(moves)
    return since, round(since + span, 6), before


def _fission(
    folder: Path,
    rng: Rng,
    bubbles: tuple[float, float] = (0.0, 400.0),
    is_jammed: bool = False,
    noise_stated: float | None = 1.0,
    wild: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> tuple[float, float]:
    """Bubbles may take reactivity, bubbles[0] (T_f - bubbles[1]) above bubbles[1], in 1/K (of dollars) and K.

    The rod may be jammed over a stretch of the first recording, against what is said; begin and end [s] come back.
    """
    TRIGA.build(folder)
    names = (("drive", "rod", "mm"), ("loop", "flow", "L/s"), ("loop_in", "inlet", "degC"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("core", "triga")
    wires = "".join(f"  - {c}.{n} -> core.{n}\n" for c, n, _ in names)
    scenario(folder, "A small reactor", 1200.0, 0.5, 1, parts, wires)
    data_sheet(folder, TRIGA, TRIGA_KNOWN)
    worth, z_0, tau_r, b, l_1, l_2, a_f, a_w, p_0, u_f, c_f, c_w, *begins = drawn(rng, TRIGA, TRIGA_KNOWN)
    z_begin, n_begin, f_begin, w_begin = begins
    takes, boils = bubbles

    def flux(x: Array) -> Array:
        """Of states, shape (..., 5)."""
        z, fast, slow, fuel, water = (x[..., i] for i in range(5))
        rho = worth * (z - z_0) - a_f * (fuel - 300.0) - a_w * (water - 300.0)
        rho = rho - takes * np.maximum(fuel - boils, 0.0)
        return np.asarray((b * fast + (1.0 - b) * slow) / (1.0 - rho))

    def rates(t: float, x: Array, u: Array) -> list[float]:
        z, fast, slow, fuel, water = (float(s) for s in x)
        n = float(flux(np.asarray(x)))
        passed = u_f * (fuel - water)
        return [
            (1e-3 * float(u[0]) - z) / tau_r,
            l_1 * (n - fast),
            l_2 * (n - slow),
            (p_0 * n - passed) / c_f,
            (passed - 1e-3 * WATER * float(u[1]) * (water - float(u[2]) - CELSIUS)) / c_w,
        ]

    def power(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(1e-3 * p_0 * flux(x))

    stretch = (0.0, 0.0)
    for number, (name, stop) in enumerate((("first", 1200.0), ("second", 1000.0), ("third", 1100.0))):
        rod = drawn_steps(rng, stop, 45.0, 235.0, 263.0, 1.0)
        if name == "third":
            rod = wandering(rng, stop, 35.0, 236.0, 262.0, 1.0)
        flow = drawn_steps(rng, stop, 80.0, 1.0, 3.2, 1.0)
        rod, flow = later(rod, 0.5), later(flow, 0.5)
        inlet = ramped(rng, stop, 180.0, 18.0, 28.0, 10.0)
        run = rod
        if is_jammed and name == "first":
            since, until, before = longest_held(rod, stop, 70.0)
            stretch = (since, until)
            run = between(rod, since, until, lambda v, before=before: before)  # type: ignore[misc]
        t, x = integrated(rates, (z_begin, n_begin, n_begin, f_begin, w_begin), (run, flow, inlet), stop, 0.5)
        sensors = [
            Sensor("core.power", "Kammer kW", "kW", power, 0.5, 1.0, noise_stated, 0.1, wild=wild),
            Sensor("core.fuel", "Brennstab degC", "degC", celsius(3), 0.4, 1.0, noise_stated, 0.1, wild=wild),
            Sensor("core.outlet", "Austritt degC", "degC", celsius(4), 0.06, 2.0, noise_stated, 0.02, wild=wild),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"drive.rod": (run, "mm"), "loop.flow": (flow, "L/s"), "loop_in.inlet": (inlet, "degC")},
            loggers[number % len(loggers)],
            recorded=["loop_in.inlet"],
            told={} if run is rod else {"drive.rod": rod},
        )
        write(folder / name, rng, made)
    return stretch


def fission_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=600.0, empty=0.02), Logger("min", zero=-3.0), Logger("s", gap=(520.0, 548.0)))
    _fission(folder, rng, noise_stated=None, wild=0.004, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, wild readings, two rates, a column of an input, empty "
        "cells, a gap of 28 s, loggers of s and min",
        FINE,
    )


def fission_bubbles(folder: Path, rng: Rng) -> Truth:
    takes, boils = rng.uniform(1.4e-2, 2e-2), rng.uniform(366.0, 370.0)
    _fission(folder, rng, bubbles=(takes, boils), loggers=(Logger("min", zero=2.0), PLAIN))
    return Truth(
        f"bubbles at the fuel take reactivity once it is hotter than {boils:.2f} K: {100.0 * takes:.3f} cents/K "
        f"(T_f - {boils:.2f} K)",
        PHYSICS,
        BUBBLING,
    )


def fission_jammed(folder: Path, rng: Rng) -> Truth:
    begin, end = _fission(folder, rng, is_jammed=True, loggers=(PLAIN, Logger("min", zero=1.0)))
    return Truth(
        f"from {begin:.10g} s to {end:.10g} s of the first recording the rod is jammed where it was, and is said to "
        "have moved",
        (*RECORDING, *SENSOR),
        ("input_fault",),
    )


# --- a still of four trays, FMI 2 Co-Simulation that hides its states; min, kW, mol/min, %, degC, Pa
STILL = OdeModel(
    "still",
    {
        "M_b": (40.0, "mol"),
        "M_t": (2.0, "mol"),
        "M_d": (10.0, "mol"),
        "alpha": (3.0, ""),
        "H": (38000.0, "J/mol"),
        "tau_q": (60.0, "s"),
        "loss": (350.0, "W"),
        "k_p": (5e4, "Pa*s^2/mol^2"),
        "T_hi": (371.0, "K"),
        "a": (42.0, "K"),
        "k_x": (0.35, ""),
        "x_b": (0.15, ""),
        "x_t": (0.88, ""),
        "q_begin": (5500.0, "W"),
    },
    {"heat": "W", "reflux": "", "feed": "mol/s", "blend": ""},
    {
        "q": ("W", "q_begin", "(heat - q)/tau_q"),
        "x_0": (
            "",
            "x_b",
            "((reflux*(q - loss)/H + feed)*(x_1 - x_0) - (q - loss)/H*(alpha*x_0/(1.0 + (alpha - 1.0)*x_0) - x_0))/M_b",
        ),
        "x_1": (
            "",
            "x_b + 0.2*(x_t - x_b)",
            "((reflux*(q - loss)/H + feed)*(x_2 - x_1)"
            " + (q - loss)/H*(alpha*x_0/(1.0 + (alpha - 1.0)*x_0) - alpha*x_1/(1.0 + (alpha - 1.0)*x_1)))/M_t",
        ),
        "x_2": (
            "",
            "x_b + 0.4*(x_t - x_b)",
            "(reflux*(q - loss)/H*x_3 + feed*blend - (reflux*(q - loss)/H + feed)*x_2"
            " + (q - loss)/H*(alpha*x_1/(1.0 + (alpha - 1.0)*x_1) - alpha*x_2/(1.0 + (alpha - 1.0)*x_2)))/M_t",
        ),
        "x_3": (
            "",
            "x_b + 0.6*(x_t - x_b)",
            "(q - loss)/H*(reflux*(x_4 - x_3)"
            " + alpha*x_2/(1.0 + (alpha - 1.0)*x_2) - alpha*x_3/(1.0 + (alpha - 1.0)*x_3))/M_t",
        ),
        "x_4": (
            "",
            "x_b + 0.8*(x_t - x_b)",
            "(q - loss)/H*(reflux*(x_5 - x_4)"
            " + alpha*x_3/(1.0 + (alpha - 1.0)*x_3) - alpha*x_4/(1.0 + (alpha - 1.0)*x_4))/M_t",
        ),
        "x_5": ("", "x_t", "(q - loss)/H*(alpha*x_4/(1.0 + (alpha - 1.0)*x_4) - x_5)/M_d"),
    },
    {
        "top": ("", "x_5"),
        "bottom": ("", "x_0"),
        "tray": ("K", "T_hi - a*x_3/(x_3 + k_x)"),
        "drop": ("Pa", "k_p*(q - loss)/H*(q - loss)/H"),
    },
    1.0,
)
STILL_KNOWN = {
    "M_b": 0.04,
    "M_t": 0.08,
    "M_d": 0.05,
    "alpha": 0.03,
    "H": 0.02,
    "tau_q": 0.08,
    "loss": 0.1,
    "k_p": 0.05,
    "T_hi": 5e-4,
    "a": 0.01,
    "k_x": 0.03,
}


def _still(
    folder: Path,
    rng: Rng,
    carries: tuple[float, float] = (0.0, 1.0),
    corner: tuple[float, float] | None = None,
    lag: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("min"),),
) -> None:
    """Vapour may carry liquid to the tray above, carries[0] (V - carries[1]) above carries[1] [mol/s].

    A corner of the kettle may be stirred badly: what it holds [mol] and exchanges with the rest [mol/s]. The densimeter
    of the second recording may lag, with a time constant `lag` [s].
    """
    STILL.build(folder)
    names = (("mantle", "heat", "kW"), ("splitter", "reflux", ""), ("pump", "feed", "mol/min"), ("tank", "blend", "%"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("still", "still", "internal")
    parts = parts.replace("unit: %", 'unit: "%"')
    wires = "".join(f"  - {c}.{n} -> still.{n}\n" for c, n, _ in names)
    scenario(folder, "A still of four trays", 9600.0, 5, 10, parts, wires)
    data_sheet(folder, STILL, STILL_KNOWN)
    m_b, m_t, m_d, alpha, latent, tau_q, loss, k_p, t_hi, a, k_x, x_b, x_t, q_begin = drawn(rng, STILL, STILL_KNOWN)
    share, onset = carries
    m_c, passes = corner if corner is not None else (1.0, 0.0)

    for number, (name, stop) in enumerate((("first", 9600.0), ("second", 7800.0), ("third", 8400.0))):
        slow = lag if name == "second" else 0.0

        def rates(t: float, x: Array, u: Array, slow: float = slow) -> list[float]:
            """Heat is in W; the last are what is in the corner of the kettle, and what a slow densimeter shows."""
            q, *liquid, held, shown = (float(s) for s in x)
            v = (q - loss) / latent
            feed, down = float(u[2]) / 60.0, float(u[1]) * v
            carried = share * max(v - onset, 0.0)
            y = [alpha * s / (1.0 + (alpha - 1.0) * s) for s in liquid[:5]]
            hidden = passes * (liquid[0] - held)
            x_0, x_1, x_2, x_3, x_4, x_5 = liquid
            return [
                (1e3 * float(u[0]) - q) / tau_q,
                ((down + feed) * (x_1 - x_0) - v * (y[0] - x_0) + carried * (x_1 - x_0) - hidden) / m_b,
                ((down + feed) * (x_2 - x_1) + v * (y[0] - y[1]) + carried * (x_0 - 2.0 * x_1 + x_2)) / m_t,
                (
                    down * x_3
                    + 1e-2 * feed * float(u[3])
                    - (down + feed) * x_2
                    + v * (y[1] - y[2])
                    + carried * (x_1 - 2.0 * x_2 + x_3)
                )
                / m_t,
                (down * (x_4 - x_3) + v * (y[2] - y[3]) + carried * (x_2 - 2.0 * x_3 + x_4)) / m_t,
                (down * (x_5 - x_4) + v * (y[3] - y[4]) + carried * (x_3 - x_4)) / m_t,
                v * (y[4] - x_5) / m_d,
                hidden / m_c,
                (x_5 - shown) / slow if slow else 0.0,
            ]

        heat = drawn_steps(rng, stop, 500.0, 4.3, 6.6, 10.0)
        if name == "third":
            heat = telegraph(rng, stop, 450.0, 4.5, 6.4, 10.0)
        reflux = drawn_steps(rng, stop, 650.0, 0.66, 0.9, 10.0)
        feed = drawn_steps(rng, stop, 900.0, 4.4, 7.0, 10.0)
        heat, reflux, feed = later(heat, 5.0), later(reflux, 5.0), later(feed, 5.0)
        blend = ramped(rng, stop, 1500.0, 36.0, 48.0, 60.0)
        liquid = [x_b + s * (x_t - x_b) for s in (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)]
        t, x = integrated(rates, (q_begin, *liquid, x_b, x_t), (heat, reflux, feed, blend), stop, 2.5)

        def tray(t: Array, x: Array, u: Array) -> Array:
            return np.asarray(t_hi - a * x[:, 4] / (x[:, 4] + k_x) - CELSIUS)

        def drop(t: Array, x: Array, u: Array) -> Array:
            return np.asarray(k_p * ((x[:, 0] - loss) / latent) ** 2)

        top = scaled(8 if slow else 6, 100.0)
        sensors = [
            Sensor("still.top", "Kopf mol%", "%", top, 0.1, 10.0, noise_stated, 0.05),
            Sensor("still.bottom", "Sumpf mol%", "%", scaled(1, 100.0), 0.15, 20.0, noise_stated, 0.05),
            Sensor("still.tray", "T Boden 3", "degC", tray, 0.08, 10.0, noise_stated, 0.02),
            Sensor("still.drop", "dp Pa", "Pa", drop, 8.0, 10.0, noise_stated, 2.0),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "mantle.heat": (heat, "kW"),
                "splitter.reflux": (reflux, ""),
                "pump.feed": (feed, "mol/min"),
                "tank.blend": (blend, "%"),
            },
            loggers[number % len(loggers)],
            recorded=["tank.blend"],
        )
        write(folder / name, rng, made)


def still_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("min", zero=20.0), Logger("h", zero=7.0, empty=0.02), Logger("s", gap=(3000.0, 3240.0)))
    _still(folder, rng, noise_stated=1.1, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.1 times too large, two rates, a column of an input, empty "
        "cells, a gap of 4 min, three loggers of min, h and s, Co-Simulation",
        FINE,
    )


def still_carries(folder: Path, rng: Rng) -> Truth:
    share, onset = rng.uniform(2.0, 3.0), rng.uniform(0.125, 0.135)
    _still(folder, rng, carries=(share, onset), loggers=(PLAIN, Logger("min", zero=-5.0)))
    return Truth(
        f"vapour carries liquid to the tray above once there is more of it than {onset:.4f} mol/s: {share:.3f} (V - "
        f"{onset:.4f} mol/s) go up, and as much more comes down",
        PHYSICS,
        CARRYING,
    )


def still_two(folder: Path, rng: Rng) -> Truth:
    share, onset = rng.uniform(2.0, 3.0), rng.uniform(0.125, 0.135)
    holds, slow = rng.uniform(18.0, 26.0), rng.uniform(700.0, 1100.0)
    _still(folder, rng, carries=(share, onset), corner=(holds, holds / slow), loggers=(Logger("h"), Logger("min")))
    return Truth(
        f"vapour carries liquid to the tray above once there is more of it than {onset:.4f} mol/s: {share:.3f} (V - "
        f"{onset:.4f} mol/s) go up, and as much more comes down; and a further {holds:.2f} mol in a corner of the "
        f"kettle mix with the rest with a time constant of {slow:.0f} s",
        PHYSICS,
        (*CARRYING, *STORED),
    )


def still_lag(folder: Path, rng: Rng) -> Truth:
    lag = rng.uniform(90.0, 150.0)
    _still(folder, rng, lag=lag, loggers=(Logger("min"), Logger("s", zero=30.0)))
    return Truth(
        f"the densimeter of the distillate is fed slowly in the second recording: it lags, time constant {lag:.1f} s",
        (*RECORDING, *SENSOR),
    )


# --- a frame of two storeys with a damper on a shaking table, FMI 2 Model Exchange; s, ms, m/s^2, A, mm
FRAME = OdeModel(
    "shaken_frame",
    {
        "m_1": (120.0, "kg"),
        "m_2": (100.0, "kg"),
        "m_d": (9.0, "kg"),
        "k_1": (2.4e4, "N/m"),
        "k_2": (2.2e4, "N/m"),
        "k_d": (620.0, "N/m"),
        "c_1": (75.0, "N*s/m"),
        "c_2": (55.0, "N*s/m"),
        "c_0": (8.0, "N*s/m"),
        "c_i": (30.0, "N*s/(m*A)"),
        "tau": (0.06, "s"),
    },
    {"shake": "m/s^2", "coil": "A"},
    {
        "x_1": ("m", "0.0", "v_1"),
        "v_1": ("m/s", "0.0", "(-k_1*x_1 - c_1*v_1 + k_2*(x_2 - x_1) + c_2*(v_2 - v_1))/m_1 - shake"),
        "x_2": ("m", "0.0", "v_2"),
        "v_2": (
            "m/s",
            "0.0",
            "(-k_2*(x_2 - x_1) - c_2*(v_2 - v_1) + k_d*(x_d - x_2) + (c_0 + c_i*i)*(v_d - v_2))/m_2 - shake",
        ),
        "x_d": ("m", "0.0", "v_d"),
        "v_d": ("m/s", "0.0", "-(k_d*(x_d - x_2) + (c_0 + c_i*i)*(v_d - v_2))/m_d - shake"),
        "i": ("A", "0.0", "(coil - i)/tau"),
    },
    {
        "storey": ("m", "x_1"),
        "roof": (
            "m/s^2",
            "(-k_2*(x_2 - x_1) - c_2*(v_2 - v_1) + k_d*(x_d - x_2) + (c_0 + c_i*i)*(v_d - v_2))/m_2",
        ),
        "travel": ("m", "x_d - x_2"),
    },
    2e-3,
)
FRAME_KNOWN = {"m_1": 0.02, "m_2": 0.02, "m_d": 0.01, "k_1": 0.03, "k_2": 0.03, "k_d": 0.03, "c_1": 0.1, "c_2": 0.1}
FRAME_KNOWN |= {"c_0": 0.1, "c_i": 0.08, "tau": 0.1}


def _quake(
    folder: Path,
    rng: Rng,
    loosens: float = np.inf,
    is_turned: bool = False,
    noise_stated: float | None = 1.0,
    colour: float = 0.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Bolts of the lower storey may come loose with the work W that it takes: k_1/(1 + W/loosens), loosens in J.

    The accelerometer of the roof may be mounted the other way round in the second recording.
    """
    FRAME.build(folder)
    parts = programme("table", ("shake", "m/s^2")) + programme("amplifier", ("coil", "A"))
    parts += with_numbers("frame", "shaken_frame")
    wires = "  - table.shake -> frame.shake\n  - amplifier.coil -> frame.coil\n"
    scenario(folder, "A frame on a shaking table", 40.0, 0.01, 0.02, parts, wires)
    data_sheet(folder, FRAME, FRAME_KNOWN)
    m_1, m_2, m_d, k_1, k_2, k_d, c_1, c_2, c_0, c_i, tau = drawn(rng, FRAME, FRAME_KNOWN)

    def upper(x: Array) -> Any:
        """Forces on the roof [N] of springs and dampers, and of the damper's mass alone."""
        tuned = k_d * (x[..., 4] - x[..., 2]) + (c_0 + c_i * x[..., 6]) * (x[..., 5] - x[..., 3])
        return -k_2 * (x[..., 2] - x[..., 0]) - c_2 * (x[..., 3] - x[..., 1]), tuned

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """The last is the work that went into the lower storey and out of it [J]."""
        frame, tuned = (float(s) for s in upper(np.asarray(x)))
        moved, fast, work = float(x[0]), float(x[1]), float(x[7])
        spring, shake = k_1 / (1.0 + work / loosens) * moved, float(u[0])
        return [
            fast,
            (-spring - c_1 * fast - frame) / m_1 - shake,
            float(x[3]),
            (frame + tuned) / m_2 - shake,
            float(x[5]),
            -tuned / m_d - shake,
            (float(u[1]) - float(x[6])) / tau,
            abs(spring * fast),
        ]

    for number, (name, stop) in enumerate((("first", 40.0), ("second", 32.0), ("third", 36.0))):
        shake = drawn_steps(rng, stop, 0.5, -1.0, 1.0, 0.02)
        if name == "third":
            shake = telegraph(rng, stop, 0.6, -0.8, 0.8, 0.02)
        coil = drawn_steps(rng, stop, 3.0, 0.0, 1.0, 0.02)
        shake, coil = later(shake, 0.01), later(coil, 0.01)
        t, x = integrated(rates, (0.0,) * 8, (shake, coil), stop, 5e-3)
        sign = -1.0 if is_turned and name == "second" else 1.0

        def roof(t: Array, x: Array, u: Array, sign: float = sign) -> Array:
            return np.asarray(sign * sum(upper(x)) / m_2)

        def travel(t: Array, x: Array, u: Array) -> Array:
            return np.asarray(1e3 * (x[:, 4] - x[:, 2]))

        sensors = [
            Sensor("frame.storey", "Laser EG mm", "mm", scaled(0, 1e3), 0.12, 0.02, noise_stated, 0.02, colour),
            Sensor("frame.roof", "a Dach", "m/s^2", roof, 0.04, 0.02, noise_stated, 0.01, colour),
            Sensor("frame.travel", "Tilger mm", "mm", travel, 0.4, 0.04, noise_stated, 0.1, colour),
        ]
        programmes = {"table.shake": (shake, "m/s^2"), "amplifier.coil": (coil, "A")}
        write(folder / name, rng, Written(t, x, sensors, programmes, loggers[number % len(loggers)]))


def quake_null(folder: Path, rng: Rng) -> Truth:
    loggers = (
        Logger("s", zero=12.0, jitter=0.15),
        Logger("ms", zero=-800.0, gap=(14.0, 15.2)),
        Logger("s", empty=0.02),
    )
    _quake(folder, rng, colour=0.2, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise of neighbouring readings correlates by 0.2 and is stated rightly, two "
        "rates, jitter, empty cells, a gap of 1.2 s, loggers of s and ms",
        FINE,
    )


def quake_loosens(folder: Path, rng: Rng) -> Truth:
    loosens = rng.uniform(2500.0, 4000.0)
    _quake(folder, rng, loosens=loosens, loggers=(PLAIN, Logger("ms", zero=250.0)))
    return Truth(
        "bolts of the lower storey come loose with the work W that went into it and out of it, and are tightened "
        f"before each recording: k_1/(1 + W/{loosens:.0f} J)",
        PHYSICS,
        LOOSENING,
    )


def quake_turned(folder: Path, rng: Rng) -> Truth:
    _quake(folder, rng, is_turned=True, loggers=(Logger("ms"), Logger("s", zero=4.0), PLAIN))
    return Truth(
        "the accelerometer of the roof is mounted the other way round in the second recording: its sign is wrong",
        (*RECORDING, *SENSOR),
    )


# --- a well that is pumped beside a river, and two gauges in the ground; FMI 3 Model Exchange; h, m^3/h, mm/h, m
WELL = OdeModel(
    "well_field",
    {
        "A_w": (0.05, "m^2"),
        "G_s": (8e-3, "m^2/s"),
        "G_1": (9e-3, "m^2/s"),
        "G_2": (9.5e-3, "m^2/s"),
        "G_3": (1e-2, "m^2/s"),
        "G_r": (8e-3, "m^2/s"),
        "C_1": (0.08, "m^2"),
        "C_2": (1.2, "m^2"),
        "C_3": (16.0, "m^2"),
        "C_4": (160.0, "m^2"),
        "L_3": (4e-4, "m^2/s"),
        "up": (50.0, "m"),
        "A_s": (900.0, "m^2"),
        "h_begin": (49.2, "m"),
    },
    {"pump": "m^3/s", "river": "m", "rain": "m/s"},
    {
        "h_w": ("m", "h_begin", "(G_s*(h_1 - h_w) - pump)/A_w"),
        "h_1": ("m", "h_begin", "(G_1*(h_2 - h_1) - G_s*(h_1 - h_w))/C_1"),
        "h_2": ("m", "h_begin", "(G_2*(h_3 - h_2) - G_1*(h_2 - h_1))/C_2"),
        "h_3": ("m", "h_begin", "(G_3*(h_4 - h_3) - G_2*(h_3 - h_2) + L_3*(up - h_3))/C_3"),
        "h_4": ("m", "h_begin", "(G_r*(river - h_4) - G_3*(h_4 - h_3) + A_s*rain)/C_4"),
    },
    {"well": ("m", "h_w"), "near": ("m", "h_2"), "far": ("m", "h_3")},
    5.0,
)
WELL_KNOWN = {
    "A_w": 0.03,
    "G_s": 0.06,
    "G_1": 0.05,
    "G_2": 0.05,
    "G_3": 0.05,
    "G_r": 0.06,
    "C_1": 0.1,
    "C_2": 0.08,
    "C_3": 0.08,
    "C_4": 0.08,
    "L_3": 0.1,
    "A_s": 0.05,
}


def _wellfield(
    folder: Path,
    rng: Rng,
    swirls: float = 0.0,
    is_closed: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("h"),),
) -> None:
    """Water may be turbulent in the screen: the difference of levels is q/G_s + swirls q |q|, swirls in s^2/m^5.

    The gauge farther away may be closed to the air in the second recording, and show its pressure as well.
    """
    build3(WELL, folder, has_co_simulation=False)
    names = (("motor", "pump", "m^3/h"), ("staff", "river", "m"), ("sprinkler", "rain", "mm/h"))
    parts = "".join(programme(c, (n, u)) for c, n, u in names) + with_numbers("field", "well_field")
    wires = "".join(f"  - {c}.{n} -> field.{n}\n" for c, n, _ in names)
    scenario(folder, "A well beside a river", 86400.0, 30, 60, parts, wires)
    data_sheet(folder, WELL, WELL_KNOWN)
    a_w, g_s, g_1, g_2, g_3, g_r, c_1, c_2, c_3, c_4, l_3, up, a_s, begin = drawn(rng, WELL, WELL_KNOWN)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        h_w, h_1, h_2, h_3, h_4 = (float(s) for s in x)
        drawn_in = g_s * (h_1 - h_w)
        if swirls:
            difference = h_1 - h_w
            drawn_in = np.sign(difference) * (np.sqrt(1.0 + 4.0 * swirls * g_s**2 * abs(difference)) - 1.0)
            drawn_in = float(drawn_in) / (2.0 * swirls * g_s)
        first, second, third = g_1 * (h_2 - h_1), g_2 * (h_3 - h_2), g_3 * (h_4 - h_3)
        return [
            (drawn_in - float(u[0]) / 3600.0) / a_w,
            (first - drawn_in) / c_1,
            (second - first) / c_2,
            (third - second + l_3 * (up - h_3)) / c_3,
            (g_r * (float(u[1]) - h_4) - third + a_s * float(u[2]) / 3.6e6) / c_4,
        ]

    for number, (name, stop) in enumerate((("first", 86400.0), ("second", 72000.0), ("third", 79200.0))):
        pump = drawn_steps(rng, stop, 2700.0, 0.0, 40.0, 60.0)
        if name == "third":
            pump = stairs(rng, stop, 2400.0, 1.0, 39.0, 5, 60.0)
        rain = bursts(rng, stop, 9000.0, 4500.0, 3.0, 14.0, 60.0)
        pump, rain = later(pump, 30.0), later(rain, 30.0)
        river = ramped(rng, stop, 14400.0, 49.0, 50.2, 300.0)
        air = ramped(rng, stop, 14400.0, -0.09, 0.09, 300.0)
        t, x = integrated(rates, (begin,) * 5, (pump, river, rain), stop, 30.0)
        closed = air if is_closed and name == "second" else Steps((0.0,), (0.0,))

        def far(t: Array, x: Array, u: Array, closed: Steps = closed) -> Array:
            return np.asarray(x[:, 3] + closed.at(t))

        sensors = [
            Sensor("field.well", "Brunnen m", "m", scaled(0, 1.0), 0.02, 60.0, noise_stated, 5e-3),
            Sensor("field.near", "GWM 1 m", "m", scaled(2, 1.0), 6e-3, 60.0, noise_stated, 1e-3),
            Sensor("field.far", "GWM 2 m", "m", far, 6e-3, 120.0, noise_stated, 1e-3),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"motor.pump": (pump, "m^3/h"), "staff.river": (river, "m"), "sprinkler.rain": (rain, "mm/h")},
            loggers[number % len(loggers)],
            recorded=["staff.river"],
        )
        write(folder / name, rng, made)
        idle_column(folder / name, "Akku V", lambda n: np.full(n, 3.61))


def wellfield_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("h", zero=24.0), Logger("min", zero=-90.0, empty=0.03), Logger("s", gap=(31000.0, 33400.0)))
    _wellfield(folder, rng, noise_stated=None, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise is not stated, two rates, a column of an input, a column that nobody "
        "uses, empty cells, a gap of 40 min, three loggers of h, min and s",
        FINE,
    )


def wellfield_swirls(folder: Path, rng: Rng) -> Truth:
    swirls = rng.uniform(4500.0, 7000.0)
    _wellfield(folder, rng, swirls=swirls, loggers=(Logger("min"), Logger("h", zero=6.0)))
    return Truth(
        f"water is turbulent in the screen of the well: its level is lower by {swirls:.0f} s^2/m^5 q |q| more",
        PHYSICS,
        TURBULENT,
    )


def wellfield_closed(folder: Path, rng: Rng) -> Truth:
    _wellfield(folder, rng, is_closed=True, loggers=(Logger("h"), Logger("min", zero=15.0)))
    return Truth(
        "the gauge farther away is closed to the air in the second recording: it drifts with the air's pressure, by up "
        "to 9 cm either way",
        (*RECORDING, *SENSOR),
    )


# --- a public pool and its buffer tank, FMI 2 Model Exchange, without units and with its keeper's names; two rates
POOL = OdeModel(
    "piscina_2",
    {
        "Vol": (240.0, ""),
        "Vol_c": (25.0, ""),
        "Ricircolo": (60.0, ""),
        "k_sole": (1.6e-4, ""),
        "k_0": (0.02, ""),
        "b_t": (0.06, ""),
        "Carico": (3.0, ""),
        "Meta": (0.4, ""),
        "resa": (0.25, ""),
        "k_c": (0.03, ""),
        "k_aria": (0.03, ""),
        "Cap": (1e9, ""),
        "U_tot": (9000.0, ""),
        "Superficie": (110.0, ""),
        "tau_s": (600.0, ""),
        "Cl_0": (1.0, ""),
        "Cc_0": (0.35, ""),
        "T_0": (26.5, ""),
    },
    {"Dose": "", "Bagnanti": "", "Sole": "", "Caldo": "", "Aria": ""},
    {
        "Cl_c": ("", "Cl_0", "(Ricircolo*(Cl - Cl_c) + Dose)/Vol_c/3600.0"),
        "Cl": (
            "",
            "Cl_0",
            "(Ricircolo*(Cl_c - Cl)/Vol - k_sole*Sole*Cl - k_0*exp(b_t*(T - 26.0))*Cl"
            " - Carico*Bagnanti/Vol*Cl/(Cl + Meta))/3600.0",
        ),
        "Cc": (
            "",
            "Cc_0",
            "(resa*Carico*Bagnanti/Vol*Cl/(Cl + Meta) - k_c*Cl*Cc - k_aria*Cc)/3600.0",
        ),
        "T": ("", "T_0", "(1000.0*Caldo + Superficie*Sole - U_tot*(T - Aria))/Cap"),
        "S": ("", "Cl_0", "(Cl - S)/tau_s"),
    },
    {"Sonda": ("", "S"), "Combinato": ("", "Cc"), "Acqua": ("", "T")},
    30.0,
)
POOL_KNOWN = {
    "Vol": 0.01,
    "Vol_c": 0.03,
    "Ricircolo": 0.05,
    "k_sole": 0.08,
    "k_0": 0.1,
    "b_t": 0.05,
    "Carico": 0.06,
    "Meta": 0.08,
    "resa": 0.06,
    "k_c": 0.08,
    "k_aria": 0.08,
    "Cap": 0.03,
    "U_tot": 0.06,
    "Superficie": 0.04,
    "tau_s": 0.08,
}


def _pool(
    folder: Path,
    rng: Rng,
    breaks: tuple[float, float] = (0.0, 9.0),
    begins: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (Logger("h"),),
) -> None:
    """Free chlorine above breaks[1] [mg/L] may destroy what is combined: breaks[0] (Cl - breaks[1]) Cc, in L/mg/h.

    It takes one and a half times as much of itself. The second recording may begin with more chlorine than is said, by
    `begins` [mg/L].
    """
    POOL.build(folder)
    names = (
        ("Pompa", "Dose"),
        ("Cassa", "Bagnanti"),
        ("Cielo", "Sole"),
        ("Caldaia", "Caldo"),
        ("Meteo", "Aria"),
    )
    parts = "".join(programme(c, (n, "")) for c, n in names) + with_numbers("Vasca", "piscina_2")
    wires = "".join(f"  - {c}.{n} -> Vasca.{n}\n" for c, n in names)
    scenario(folder, "Piscina comunale", 259200.0, 150, 300, parts, wires)
    data_sheet(folder, POOL, POOL_KNOWN)
    vol, vol_c, moved, k_sun, k_0, b_t, load, half, gives, k_c, k_air, *more = drawn(rng, POOL, POOL_KNOWN)
    capacity, loss, area, tau_s, free_0, bound_0, warm_0 = more
    destroys, onset = breaks

    def rates(t: float, x: Array, u: Array) -> list[float]:
        buffered, free, bound, warm, shown = (float(s) for s in x)
        used = load * float(u[1]) / vol * free / (free + half)
        broken = destroys * max(free - onset, 0.0) * bound
        faded = (k_sun * float(u[2]) + k_0 * np.exp(b_t * (warm - 26.0))) * free
        return [
            (moved * (free - buffered) + float(u[0])) / vol_c / 3600.0,
            (moved * (buffered - free) / vol - faded - used - 1.5 * broken) / 3600.0,
            (gives * used - k_c * free * bound - k_air * bound - broken) / 3600.0,
            (1e3 * float(u[3]) + area * float(u[2]) - loss * (warm - float(u[4]))) / capacity,
            (free - shown) / tau_s,
        ]

    for number, (name, stop) in enumerate((("first", 259200.0), ("second", 216000.0), ("third", 237600.0))):
        dose = drawn_steps(rng, stop, 10800.0, 10.0, 150.0, 300.0)
        if name == "third":
            dose = telegraph(rng, stop, 9000.0, 18.0, 140.0, 300.0)
        bathers = bursts(rng, stop, 10800.0, 14400.0, 12.0, 70.0, 300.0)
        heat = drawn_steps(rng, stop, 14400.0, 0.0, 60.0, 300.0)
        dose, bathers, heat = later(dose, 150.0), later(bathers, 150.0), later(heat, 150.0)
        bathers = Steps(bathers.times, tuple(float(round(v)) for v in bathers.levels))
        sun = ramped(rng, stop, 10800.0, 0.0, 800.0, 900.0)
        air = ramped(rng, stop, 21600.0, 14.0, 30.0, 900.0)
        free = free_0 + (begins if name == "second" else 0.0)
        t, x = integrated(rates, (free, free, bound_0, warm_0, free), (dose, bathers, sun, heat, air), stop, 75.0)
        sensors = [
            Sensor("Vasca.Sonda", "Cl libero", "1", scaled(4, 1.0), 0.02, 300.0, noise_stated, 0.01),
            Sensor("Vasca.Combinato", "Cl combinato", "1", scaled(2, 1.0), 0.015, 600.0, noise_stated, 0.01),
            Sensor("Vasca.Acqua", "T acqua", "1", scaled(3, 1.0), 0.04, 300.0, noise_stated, 0.01),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "Pompa.Dose": (dose, ""),
                "Cassa.Bagnanti": (bathers, ""),
                "Cielo.Sole": (sun, ""),
                "Caldaia.Caldo": (heat, ""),
                "Meteo.Aria": (air, ""),
            },
            loggers[number % len(loggers)],
            recorded=["Cielo.Sole", "Meteo.Aria"],
        )
        write(folder / name, rng, made)


def pool_null(folder: Path, rng: Rng) -> Truth:
    loggers = (
        Logger("h", zero=6.0, is_comma=True),
        Logger("min", zero=360.0, is_comma=True, empty=0.02),
        Logger("s", is_comma=True, gap=(90000.0, 97200.0)),
    )
    _pool(folder, rng, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated rightly, no units, two rates, columns of two inputs, decimal "
        "commas, empty cells, a gap of 2 h, three loggers of h, min and s",
        FINE,
    )


def pool_breaks(folder: Path, rng: Rng) -> Truth:
    destroys, onset = rng.uniform(0.12, 0.2), rng.uniform(0.8, 1.0)
    _pool(folder, rng, breaks=(destroys, onset), loggers=(Logger("min"), Logger("h", zero=12.0)))
    return Truth(
        f"free chlorine above {onset:.3f} mg/L destroys what is combined: {destroys:.4f} L/mg/h (Cl - {onset:.3f} "
        "mg/L) Cc, and takes one and a half times as much of itself",
        PHYSICS,
        REACTING,
    )


def pool_shocked(folder: Path, rng: Rng) -> Truth:
    begins = rng.uniform(0.8, 1.3)
    _pool(folder, rng, begins=begins, loggers=(Logger("h"), Logger("min", zero=5.0)))
    return Truth(
        f"the pool was chlorinated in the night before the second recording: it begins with {1.0 + begins:.3f} mg/L, "
        "and is said to begin with 1 mg/L",
        (*RECORDING, *SENSOR),
    )


# --- a ball mill (FMI 2, Model Exchange), and its sump with a cyclone (FMI 2, Co-Simulation); min, kg/min, rpm, kW, cm
MILL = OdeModel(
    "ball_mill",
    {
        "k": (0.012, "1/s"),
        "tau": (90.0, "s"),
        "p_0": (1500.0, "W"),
        "p_m": (42.0, "W/kg"),
        "p_q": (0.25, "W/kg^2"),
        "c_begin": (15.0, "kg"),
        "f_begin": (24.0, "kg"),
        "w_begin": (36.0, "kg"),
    },
    {"ore": "kg/s", "water": "kg/s", "back_c": "kg/s", "back_f": "kg/s", "back_w": "kg/s"},
    {
        "M_c": ("kg", "c_begin", "ore + back_c - k*M_c - M_c/tau"),
        "M_f": ("kg", "f_begin", "back_f + k*M_c - M_f/tau"),
        "W": ("kg", "w_begin", "water + back_w - W/tau"),
    },
    {
        "power": ("W", "p_0 + p_m*(M_c + M_f) - p_q*(M_c + M_f)*(M_c + M_f)"),
        "out_c": ("kg/s", "M_c/tau"),
        "out_f": ("kg/s", "M_f/tau"),
        "out_w": ("kg/s", "W/tau"),
    },
    0.5,
)
SUMP = OdeModel(
    "sump",
    {
        "A": (0.12, "m^2"),
        "c_q": (1.3e-5, "m^2.5/rad"),
        "e_c": (0.9, ""),
        "e_f": (0.25, ""),
        "e_w": (0.2, ""),
        "c_begin": (11.0, "kg"),
        "f_begin": (18.0, "kg"),
        "w_begin": (50.0, "kg"),
    },
    {"in_c": "kg/s", "in_f": "kg/s", "in_w": "kg/s", "dilute": "kg/s", "speed": "rad/s"},
    {
        "S_c": ("kg", "c_begin", "in_c - c_q*speed*S_c/sqrt(A*((S_c + S_f)/2700.0 + S_w/1000.0 + 1e-9))"),
        "S_f": ("kg", "f_begin", "in_f - c_q*speed*S_f/sqrt(A*((S_c + S_f)/2700.0 + S_w/1000.0 + 1e-9))"),
        "S_w": ("kg", "w_begin", "in_w + dilute - c_q*speed*S_w/sqrt(A*((S_c + S_f)/2700.0 + S_w/1000.0 + 1e-9))"),
    },
    {
        "back_c": ("kg/s", "e_c*c_q*speed*S_c/sqrt(A*((S_c + S_f)/2700.0 + S_w/1000.0 + 1e-9))"),
        "back_f": ("kg/s", "e_f*c_q*speed*S_f/sqrt(A*((S_c + S_f)/2700.0 + S_w/1000.0 + 1e-9))"),
        "back_w": ("kg/s", "e_w*c_q*speed*S_w/sqrt(A*((S_c + S_f)/2700.0 + S_w/1000.0 + 1e-9))"),
        "level": ("m", "((S_c + S_f)/2700.0 + S_w/1000.0 + 1e-9)/A"),
        "density": ("kg/m^3", "(S_c + S_f + S_w)/((S_c + S_f)/2700.0 + S_w/1000.0 + 1e-9)"),
        "residue": ("", "(1.0 - e_c)*S_c/((1.0 - e_c)*S_c + (1.0 - e_f)*S_f + 1e-9)"),
    },
    0.5,
)
MILL_KNOWN = {"k": 0.06, "tau": 0.05, "p_0": 0.03, "p_m": 0.03, "p_q": 0.06}
SUMP_KNOWN = {"A": 0.01, "c_q": 0.03, "e_c": 0.015, "e_f": 0.05, "e_w": 0.06}


def _grinding(
    folder: Path,
    rng: Rng,
    overfills: float = np.inf,
    ropes: tuple[float, float] = (0.0, 2000.0),
    is_other: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Two FMUs; a mill that is full may grind less well: k/(1 + (M/overfills)^2), overfills in kg of ore.

    The cyclone may rope: fines stay, ropes[0] (density - ropes[1]) more of them, in m^3/kg and kg/m^3. The second
    recording may be said to have had the ore of another run.
    """
    MILL.build(folder)
    SUMP.build(folder)
    data_sheet(folder, MILL, MILL_KNOWN)
    (folder / "numbers.yaml").rename(folder / "mill.yaml")
    data_sheet(folder, SUMP, SUMP_KNOWN)
    parts = (
        programme("belt", ("ore", "kg/min"))
        + programme("tap", ("water", "kg/min"), ("dilute", "kg/min"))
        + programme("inverter", ("speed", "rpm"))
        + with_numbers("mill", "ball_mill").replace("numbers.yaml", "mill.yaml")
        + with_numbers("sump", "sump", "internal")
    )
    wires = "  - belt.ore -> mill.ore\n  - tap.water -> mill.water\n  - tap.dilute -> sump.dilute\n"
    wires += "  - inverter.speed -> sump.speed\n"
    wires += "".join(f"  - mill.out_{n} -> sump.in_{n}\n  - sump.back_{n} -> mill.back_{n}\n" for n in "cfw")
    scenario(folder, "A ball mill in closed circuit", 5400.0, 0.5, 5, parts, wires)
    k, tau, p_0, p_m, p_q, *mill_0 = drawn(rng, MILL, MILL_KNOWN)
    area, c_q, e_c, e_f, e_w, *sump_0 = drawn(rng, SUMP, SUMP_KNOWN)
    keeps, dense = ropes

    def volume(x: Array) -> Any:
        """Of the pulp in the sump [m^3]."""
        return (x[..., 3] + x[..., 4]) / ORE + x[..., 5] / LIQUID

    def density(x: Array) -> Any:
        return (x[..., 3] + x[..., 4] + x[..., 5]) / volume(x)

    def fines_kept(x: Array) -> Any:
        return np.minimum(e_f + keeps * np.maximum(density(x) - dense, 0.0), 0.9)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        state = np.asarray(x, dtype=np.float64)
        coarse, fine, water, s_c, s_f, s_w = (float(s) for s in state)
        ore, tapped, diluted = (float(u[i]) / 60.0 for i in range(3))
        pumped = c_q * float(u[3]) / RPM / np.sqrt(area * float(volume(state)))
        ground = k / (1.0 + ((coarse + fine) / overfills) ** 2) * coarse
        kept = float(fines_kept(state))
        return [
            ore + e_c * pumped * s_c - ground - coarse / tau,
            kept * pumped * s_f + ground - fine / tau,
            tapped + e_w * pumped * s_w - water / tau,
            coarse / tau - pumped * s_c,
            fine / tau - pumped * s_f,
            water / tau + diluted - pumped * s_w,
        ]

    def power(t: Array, x: Array, u: Array) -> Array:
        full = x[:, 0] + x[:, 1]
        return np.asarray(1e-3 * (p_0 + p_m * full - p_q * full**2))

    def level(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(100.0 * volume(x) / area)

    def residue(t: Array, x: Array, u: Array) -> Array:
        over_c, over_f = (1.0 - e_c) * x[:, 3], (1.0 - fines_kept(x)) * x[:, 4]
        return np.asarray(100.0 * over_c / (over_c + over_f))

    other = later(drawn_steps(rng, 4500.0, 260.0, 5.0, 18.0, 5.0), 2.5)
    for number, (name, stop) in enumerate((("first", 5400.0), ("second", 4500.0), ("third", 4800.0))):
        ore = drawn_steps(rng, stop, 260.0, 5.0, 18.0, 5.0)
        if name == "third":
            ore = telegraph(rng, stop, 300.0, 5.5, 17.5, 5.0)
        water = drawn_steps(rng, stop, 400.0, 8.0, 22.0, 5.0)
        dilute = drawn_steps(rng, stop, 330.0, 12.0, 34.0, 5.0)
        speed = drawn_steps(rng, stop, 450.0, 800.0, 1150.0, 5.0)
        ore, water, dilute, speed = (later(s, 2.5) for s in (ore, water, dilute, speed))
        t, x = integrated(rates, (*mill_0, *sump_0), (ore, water, dilute, speed), stop, 1.25)
        sensors = [
            Sensor("mill.power", "P Mühle kW", "kW", power, 0.01, 5.0, noise_stated, 2e-3),
            Sensor("sump.level", "Pegel cm", "cm", level, 0.3, 5.0, noise_stated, 0.1),
            Sensor("sump.density", "Dichte g/L", "kg/m^3", lambda t, x, u: density(x), 3.0, 5.0, noise_stated, 1.0),
            Sensor("sump.residue", "R 90 %", "%", residue, 0.15, 10.0, noise_stated, 0.02),
        ]
        made = Written(
            t,
            x,
            sensors,
            {
                "belt.ore": (ore, "kg/min"),
                "tap.water": (water, "kg/min"),
                "tap.dilute": (dilute, "kg/min"),
                "inverter.speed": (speed, "rpm"),
            },
            loggers[number % len(loggers)],
            told={"belt.ore": other} if is_other and name == "second" else {},
        )
        write(folder / name, rng, made)


def grinding_overfilled(folder: Path, rng: Rng) -> Truth:
    overfills = rng.uniform(55.0, 75.0)
    _grinding(folder, rng, overfills=overfills, loggers=(Logger("min", zero=3.0), PLAIN))
    return Truth(
        f"a mill that is full grinds less well: k/(1 + (M/{overfills:.2f} kg)^2), M the ore in it",
        PHYSICS,
        OVERFILLED,
    )


def grinding_two(folder: Path, rng: Rng) -> Truth:
    overfills, keeps, dense = rng.uniform(55.0, 75.0), rng.uniform(1.2e-3, 2e-3), rng.uniform(1280.0, 1310.0)
    _grinding(folder, rng, overfills=overfills, ropes=(keeps, dense), loggers=(PLAIN, Logger("min", zero=-8.0)))
    return Truth(
        f"a mill that is full grinds less well: k/(1 + (M/{overfills:.2f} kg)^2), M the ore in it; and the cyclone "
        f"ropes once the pulp is denser than {dense:.1f} kg/m^3: of the fines {1e3 * keeps:.4f}e-3 m^3/kg (density - "
        f"{dense:.1f} kg/m^3) more go back",
        PHYSICS,
        (*OVERFILLED, *BEGINNING),
    )


def grinding_other_run(folder: Path, rng: Rng) -> Truth:
    _grinding(folder, rng, is_other=True, loggers=(PLAIN, Logger("h", zero=2.0)))
    return Truth("the second recording is said to have had the ore of another run", (*RECORDING, *SENSOR))


# --- a string with a bit that drills stone, FMI 2 Co-Simulation that hides its states; s, ms, rpm, N, N m, mm
DRILL = OdeModel(
    "drill_string",
    {
        "J_t": (0.5, "kg*m^2"),
        "J_m": (0.05, "kg*m^2"),
        "J_b": (0.08, "kg*m^2"),
        "K": (4.0, "N*m*s/rad"),
        "k_1": (9.0, "N*m/rad"),
        "k_2": (14.0, "N*m/rad"),
        "c_1": (0.12, "N*m*s/rad"),
        "c_2": (0.12, "N*m*s/rad"),
        "d_m": (0.04, "N*m*s/rad"),
        "d_b": (0.06, "N*m*s/rad"),
        "r": (0.011, "m"),
        "w_s": (4.0, "rad/s"),
        "k_z": (5.5e-8, "m/(N*rad)"),
        "tau": (0.5, "s"),
        "w_begin": (14.0, "rad/s"),
        "f_begin": (300.0, "N"),
        "q_begin": (0.5, "rad"),
    },
    {"drive": "rad/s", "hook": "N"},
    {
        "w_t": ("rad/s", "w_begin", "(K*(drive - w_t) - k_1*q_1 - c_1*(w_t - w_m))/J_t"),
        "q_1": ("rad", "q_begin", "w_t - w_m"),
        "w_m": ("rad/s", "w_begin", "(k_1*q_1 + c_1*(w_t - w_m) - k_2*q_2 - c_2*(w_m - w_b) - d_m*w_m)/J_m"),
        "q_2": ("rad", "0.6*q_begin", "w_m - w_b"),
        "w_b": (
            "rad/s",
            "w_begin",
            "(k_2*q_2 + c_2*(w_m - w_b) - r*F*tanh(w_b/w_s) - d_b*w_b)/J_b",
        ),
        "F": ("N", "f_begin", "(hook - F)/tau"),
        "z": ("m", "0.0", "k_z*F*w_b"),
    },
    {"torque": ("N*m", "k_1*q_1 + c_1*(w_t - w_m)"), "table": ("rad/s", "w_t"), "depth": ("m", "z")},
    5e-3,
)
DRILL_KNOWN = {
    "J_t": 0.03,
    "J_m": 0.05,
    "J_b": 0.05,
    "K": 0.04,
    "k_1": 0.04,
    "k_2": 0.04,
    "c_1": 0.1,
    "c_2": 0.1,
    "d_m": 0.1,
    "d_b": 0.1,
    "r": 0.05,
    "w_s": 0.1,
    "k_z": 0.05,
    "tau": 0.08,
}


def _drilling(
    folder: Path,
    rng: Rng,
    cuttings: tuple[float, float] | None = None,
    is_pounds: bool = False,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """Cuttings may lie in the hole until they are flushed: a torque [N m] for each mm of them, and a time constant [s].

    The torque of the second recording may be in foot-pounds.
    """
    DRILL.build(folder)
    parts = programme("inverter", ("drive", "rpm")) + programme("winch", ("hook", "N"))
    parts += with_numbers("string", "drill_string", "internal")
    wires = "  - inverter.drive -> string.drive\n  - winch.hook -> string.hook\n"
    scenario(folder, "A string drills stone", 100.0, 0.025, 0.05, parts, wires)
    data_sheet(folder, DRILL, DRILL_KNOWN)
    j_t, j_m, j_b, gain, k_1, k_2, c_1, c_2, d_m, d_b, r, w_s, k_z, tau, *begins = drawn(rng, DRILL, DRILL_KNOWN)
    w_begin, f_begin, q_begin = begins
    brakes, lag = cuttings if cuttings is not None else (0.0, 10.0)

    def rates(t: float, x: Array, u: Array) -> list[float]:
        """Depth is in mm; the last are the cuttings that lie in the hole, as mm of its depth."""
        w_t, q_1, w_m, q_2, w_b, force, _, lying = (float(s) for s in x)
        upper, lower = k_1 * q_1 + c_1 * (w_t - w_m), k_2 * q_2 + c_2 * (w_m - w_b)
        cut = 1e3 * k_z * force * w_b
        met = (r * force + brakes * lying) * np.tanh(w_b / w_s) + d_b * w_b
        return [
            (gain * (float(u[0]) / RPM - w_t) - upper) / j_t,
            w_t - w_m,
            (upper - lower - d_m * w_m) / j_m,
            w_m - w_b,
            (lower - met) / j_b,
            (float(u[1]) - force) / tau,
            cut,
            cut - lying / lag,
        ]

    def torque(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(k_1 * x[:, 1] + c_1 * (x[:, 0] - x[:, 2]))

    for number, (name, stop) in enumerate((("first", 100.0), ("second", 80.0), ("third", 90.0))):
        drive = drawn_steps(rng, stop, 4.0, 90.0, 210.0, 0.05)
        if name == "third":
            drive = wandering(rng, stop, 3.0, 95.0, 205.0, 0.05)
        hook = drawn_steps(rng, stop, 6.0, 120.0, 700.0, 0.05)
        drive, hook = later(drive, 0.025), later(hook, 0.025)
        start = (w_begin, q_begin, w_begin, 0.6 * q_begin, w_begin, f_begin, 0.0, 0.0)
        t, x = integrated(rates, start, (drive, hook), stop, 0.0125)
        divisor = FOOT_POUND if is_pounds and name == "second" else 1.0

        def spoil(column: str, t: Array, v: Array, divisor: float = divisor) -> Array:
            return v / divisor if column == "Md" else v

        sensors = [
            Sensor("string.torque", "Md", "N*m", torque, 0.06, 0.05, noise_stated, 0.02),
            Sensor("string.table", "n Tisch", "rpm", scaled(0, RPM), 0.5, 0.05, noise_stated, 0.1),
            Sensor("string.depth", "Teufe mm", "mm", scaled(6, 1.0), 0.06, 0.1, noise_stated, 0.02),
        ]
        made = Written(
            t,
            x,
            sensors,
            {"inverter.drive": (drive, "rpm"), "winch.hook": (hook, "N")},
            loggers[number % len(loggers)],
            spoil=spoil,
        )
        write(folder / name, rng, made)


def drilling_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("ms", zero=1e4, gap=(42.0, 44.5)), Logger("s", zero=-5.0), Logger("s", empty=0.02))
    _drilling(folder, rng, noise_stated=0.95, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, noise stated 1.05 times too small, two rates, empty cells, a gap of 2.5 s, "
        "loggers of ms and s, Co-Simulation",
        FINE,
    )


def drilling_cuttings(folder: Path, rng: Rng) -> Truth:
    brakes, lag = rng.uniform(0.3, 0.5), rng.uniform(5.0, 9.0)
    _drilling(folder, rng, cuttings=(brakes, lag), loggers=(PLAIN, Logger("ms", zero=600.0)))
    return Truth(
        f"cuttings lie in the hole until they are flushed, time constant {lag:.2f} s, and brake the bit with "
        f"{brakes:.3f} N m for each mm of depth that lies there",
        PHYSICS,
        LITTERED,
    )


def drilling_pounds(folder: Path, rng: Rng) -> Truth:
    _drilling(folder, rng, is_pounds=True, loggers=(Logger("s", zero=2.0), Logger("ms"), PLAIN))
    return Truth(
        "the torque of the second recording is in foot-pounds, and is said to be in N m",
        (*RECORDING, *SENSOR),
    )


# --- six coils on three supplies, two, one and three in series, the third with a limit of current; the tool's own units
NEST = {
    "reference_resistance": (2.4, "ohm", 0.02, 0.02),
    "heat_transfer_coefficient": (85.0, "W/(m^2*K)", 0.05, 0.02),
    "area": (110.0, "mm^2", 0.0, 0.0),
    "volume": (8.6, "mm^3", 0.0, 0.0),
    "density": (6450.0, "kg/m^3", 0.0, 0.0),
    "specific_heat": (830.0, "J/(kg*K)", 0.05, 0.02),
}
#: Coils in series, resistance of the wires of a string [ohm], of a supply [ohm], limit [A], rise of resistance [1/K].
NEST_STRINGS, NEST_WIRES, NEST_INNER, NEST_LIMIT, NEST_RISE = (2, 1, 3), 0.12, 0.15, 0.4, 7e-4


def _nest_files(folder: Path) -> None:
    """Scenario and parameter set of the six coils."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = ["title: Coils of a nest", "parameters:"]
    for name, (value, unit, uncertainty, scatter) in NEST.items():
        known = f"uncertainty: {uncertainty:g}, scatter: {scatter:g}"
        lines.append(f'  {name}: {{value: {value:g}, unit: {unit}, source: "own measurement", {known}}}')
    lines += [
        '  use_regressed_cooling_rate: {value: false, source: "cools as it heats"}',
        '  initial_temperature: {value: 22, unit: degC, source: "room"}',
        '  reference_temperature: {value: 22, unit: degC, source: "room"}',
        f'  resistance_temperature_coefficient: {{value: {NEST_RISE:g}, unit: 1/K, source: "own measurement"}}',
    ]
    (folder / "numbers.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    volts = "".join(programme(f"bench_{s}", ("voltage", "V")) for s in (1, 2, 3))
    parts = (
        volts
        + programme("room", ("temperature", "degC")).replace("constant: 0 degC", "constant: 22 degC")
        + f"  circuit:\n    kind: ngspice\n    strings: [{', '.join(str(n) for n in NEST_STRINGS)}]\n"
        f"    supply: per_string\n    supply_resistance: {NEST_INNER} ohm\n    string_resistance: {NEST_WIRES} ohm\n"
        f"    elements: [{{kind: current_limit, supply: 3, limit: {NEST_LIMIT} A, share: 1}}]\n"
        "    start: {resistance: 2.4 ohm}\n"
        "  coils: {kind: actuator, fmu: thermal_stiffness, electrical: circuit, ambient: room, "
        "parameter_set: numbers.yaml}\n"
    )
    wires = "".join(f'  - {{connect: "bench_{s}.voltage -> circuit.supply_voltage[{s}]"}}\n' for s in (1, 2, 3))
    scenario(folder, "Six coils on three supplies", 100.0, 0.05, 0.1, parts, wires)


def _off(rng: Rng, name: str) -> Array:
    """A number of each coil as it is."""
    value, _, uncertainty, scatter = NEST[name]
    return np.asarray(value * np.exp(uncertainty * rng.normal() + scatter * rng.normal(size=sum(NEST_STRINGS))))


def _nest_course(
    numbers: Sequence[Array], volts: Sequence[Steps], room: Steps, start: float, stop: float, step: float, shared: float
) -> tuple[Array, Array]:
    """Times [s], and temperatures of the coils [degC] and currents of the strings [A].

    Heat by the exponential of equation (3) over a step, with the currents of its middle.

    Args:
        numbers: Resistances [ohm], conductances [W/K], capacities [J/K] of the coils.
        volts: Of the supplies.
        room: Its temperature [degC].
        start: Temperature of the coils at 0 [degC].
        stop: End [s].
        step: Of time [s].
        shared: Resistance of the return wire that the supplies share [ohm].
    """
    cold, loses, holds = numbers
    times: Array = step * np.arange(round(stop / step) + 1, dtype=np.float64)
    emf, around = np.stack([s.at(times) for s in volts], axis=1), room.at(times)
    string = np.repeat(np.arange(len(NEST_STRINGS)), NEST_STRINGS)
    most = np.asarray([np.inf, np.inf, NEST_LIMIT])

    def currents(hot: Array, v: Array) -> Array:
        ohms = np.bincount(string, hot) + NEST_WIRES + NEST_INNER
        amps = np.minimum(v / ohms, most)
        for _ in range(30 if shared else 0):
            amps = np.minimum((v - shared * amps.sum()) / ohms, most)
        return np.asarray(amps)

    def relaxed(warm: Array, at: Array, v: Array, outside: float, span: float) -> Array:
        hot = cold * (1.0 + NEST_RISE * (at - 22.0))
        end = outside + currents(hot, v)[string] ** 2 * hot / loses
        return np.asarray(end + (warm - end) * np.exp(-loses * span / holds))

    warm = np.full(len(string), start)
    found = np.empty((len(times), len(string) + len(NEST_STRINGS)))
    for i, (v, outside) in enumerate(zip(emf, around)):
        found[i] = (*warm, *currents(cold * (1.0 + NEST_RISE * (warm - 22.0)), v))
        middle = relaxed(warm, warm, v, float(outside), step / 2)
        warm = relaxed(warm, middle, v, float(outside), step)
    return times, found


def _nest(
    folder: Path,
    rng: Rng,
    shared: float = 0.0,
    late: float = 0.0,
    noise_stated: float | None = 1.0,
    loggers: Sequence[Logger] = (PLAIN,),
) -> None:
    """The supplies may share a return wire of a resistance [ohm].

    Readings of the second recording may have been taken later than is said, by `late` [s].
    """
    _nest_files(folder)
    conductance = 1e-6 * _off(rng, "area") * _off(rng, "heat_transfer_coefficient")
    capacity = 1e-9 * _off(rng, "density") * _off(rng, "volume") * _off(rng, "specific_heat")
    numbers = (_off(rng, "reference_resistance"), conductance, capacity)

    for number, (name, stop) in enumerate((("first", 100.0), ("second", 84.0), ("third", 92.0))):
        volts = [drawn_steps(rng, stop, dwell, 0.0, high, 0.1) for dwell, high in ((7.0, 2.5), (5.0, 1.4), (9.0, 4.0))]
        if name == "third":
            volts[2] = stairs(rng, stop, 5.0, 0.2, 3.9, 5, 0.1)
        volts = [later(s, 0.05) for s in volts]
        room = ramped(rng, stop, 30.0, 20.5, 25.0, 0.5)
        said = room.levels[0]
        shift = late if name == "second" else 0.0
        t, x = _nest_course(
            numbers, volts, room, said + 0.2 * float(rng.normal()), round(stop + shift, 6), 0.0125, shared
        )
        if shift:
            skipped = round(shift / 0.0125)
            x = x[skipped:]
            t = t[: len(x)]
        sensors = [
            Sensor(f"string[{s}].current", f"I{s} mA", "mA", scaled(5 + s, 1e3), 1.5, 0.1, noise_stated, 0.5)
            for s in (1, 2, 3)
        ]
        sensors += [
            Sensor(f"coil[{c}].temperature", f"IR {c}", "degC", scaled(c - 1, 1.0), 0.3, 0.2, noise_stated, 0.1)
            for c in (1, 3, 4, 6)
        ]
        made = Written(
            t,
            x,
            sensors,
            {f"bench_{s}.voltage": (volts[s - 1], "V") for s in (1, 2, 3)} | {"room.temperature": (room, "degC")},
            loggers[number % len(loggers)],
            recorded=["room.temperature"],
            sidecar={"components": {"coils": {"parameters": {"initial_temperature": f"{said:g} degC"}}}},
        )
        write(folder / name, rng, made)


def nest_null(folder: Path, rng: Rng) -> Truth:
    loggers = (Logger("s", zero=5.0, empty=0.02), Logger("ms", zero=-600.0), Logger("s", gap=(40.0, 42.5)))
    _nest(folder, rng, noise_stated=1.05, loggers=loggers)
    return Truth(
        "nothing; numbers off as stated, coil by coil too, start off by 0.2 K (deviation), noise stated 1.05 times too "
        "large, two rates, a column of an input, empty cells, a gap of 2.5 s, loggers of s and ms",
        FINE,
    )


def nest_shared(folder: Path, rng: Rng) -> Truth:
    shared = rng.uniform(0.06, 0.1)
    _nest(folder, rng, shared=shared, loggers=(Logger("ms", zero=80.0), PLAIN))
    return Truth(
        f"the three supplies share a return wire of {shared:.4f} ohm: each has less voltage the more current the "
        "others give",
        PHYSICS,
        SHARED,
    )


def nest_late(folder: Path, rng: Rng) -> Truth:
    late = 0.05 * round(rng.uniform(0.25, 0.4) / 0.05)
    _nest(folder, rng, late=late, loggers=(PLAIN, Logger("s", zero=1.0), Logger("ms")))
    return Truth(
        f"the clock of the second recording is late: readings were taken {late:.2f} s later than it says",
        (*RECORDING, *SENSOR),
    )


CASES: tuple[Callable[[Path, Rng], Truth], ...] = (
    still_carries,
    fission_null,
    nest_late,
    quake_loosens,
    pool_null,
    drilling_pounds,
    grinding_two,
    wellfield_null,
    fission_bubbles,
    still_lag,
    nest_null,
    wellfield_swirls,
    grinding_other_run,
    drilling_null,
    pool_breaks,
    quake_turned,
    still_null,
    fission_jammed,
    nest_shared,
    quake_null,
    wellfield_closed,
    still_two,
    pool_shocked,
    drilling_cuttings,
    grinding_overfilled,
)
