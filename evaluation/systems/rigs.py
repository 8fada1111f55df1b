"""Rigs: a linear model as FMUs with its scenario, and the truth that a law is added to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import CodeType

import numpy as np

from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel


@dataclass(frozen=True)
class Rig:
    """One kind of rig.

    Args:
        name: Of the rig.
        models: FMUs by component.
        connections: As a scenario has them.
        inputs: Programme output to its unit and size.
        channels: Variable to its unit and the size of its noise as a share of its own.
        step: Time between two readings [s]; several FMUs are coupled five times as often.
        count: Readings of a recording.
        dwell: Typical time between two changes of the drive, in steps.
        source: Derivatives in the numbers, the states x and the inputs u.
        states: Component and name of every state.
        numbers: Names of the numbers of the truth with their values.
        targets: Where laws act: index of the state, role.
        outputs: Channel to the index of its state.
        hidden: Components that are used by Co-Simulation, which hides their states.
    """

    name: str
    models: Mapping[str, OdeModel]
    connections: tuple[str, ...]
    inputs: Mapping[str, tuple[str, float]]
    channels: Mapping[str, tuple[str, float]]
    step: float
    count: int
    dwell: int
    source: str
    states: tuple[str, ...]
    numbers: Mapping[str, float]
    targets: Mapping[int, str]
    outputs: Mapping[str, int]
    hidden: frozenset[str] = field(default_factory=frozenset)

    @cached_property
    def _code(self) -> CodeType:
        return compile(self.source, self.name, "eval")

    def component(self, state: int) -> str:
        """FMU of a state."""
        return self.states[state].partition(".")[0]

    def driven(self) -> dict[int, str]:
        """Number of every input that is driven and no temperature of surroundings, to the input of an FMU."""
        ends = {source: target for source, _, target in (c.partition(" -> ") for c in self.connections)}
        return {i: ends[name] for i, (name, (unit, _)) in enumerate(self.inputs.items()) if unit != "K"}

    def rates(self, p: Mapping[str, float], x: Array, u: Array) -> Array:
        """Derivatives of the model as its author has it."""
        space: dict[str, object] = {"balanced": balanced, **p, "x": x, "u": u}
        return np.array(eval(self._code, space), dtype=np.float64)  # the texts below

    def scenario(self) -> str:
        """The scenario that is diagnosed."""
        outputs = "\n".join(
            f"      {name.partition('.')[2]}: {{unit: {unit}, constant: 0 {unit}}}"
            for name, (unit, _) in self.inputs.items()
        )
        fmus = "\n".join(
            f"  {name}: {{kind: fmu, fmu: {model.name}.fmu, "
            f"integrator: {'internal' if name in self.hidden else 'cvode'}}}"
            for name, model in self.models.items()
        )
        wires = "\n".join(f"  - {c}" for c in self.connections)
        stop, macro = self.step * (self.count - 1), self.step / (5 if len(self.models) > 1 else 1)
        times = f"stop: {stop:.12g} s, macro_step: {macro:.12g} s, output_step: {self.step!r} s"
        return (
            f"title: {self.name}\ntime: {{{times}}}\n"
            f"components:\n  drive:\n    kind: programme\n    outputs:\n{outputs}\n{fmus}\nconnections:\n{wires}\n"
        )


SLIDE = Rig(
    "a slide with a motor",
    {
        "slide": OdeModel(
            "slide",
            {"m": (20.0, "kg"), "c": (60.0, "N*s/m"), "k": (400.0, "N/m")},
            {"force": "N"},
            {"x": ("m", "0.0", "v"), "v": ("m/s", "0.0", "(force - c*v - k*x)/m")},
            {"position": ("m", "x")},
        )
    },
    ("drive.force -> slide.force",),
    {"drive.force": ("N", 60.0)},
    {"slide.position": ("m", 0.004)},
    0.01,
    500,
    45,
    "[x[1], (u[0] - c*x[1] - k*x[0])/m]",
    ("slide.x", "slide.v"),
    {"m": 20.0, "c": 60.0, "k": 400.0},
    {1: "velocity"},
    {"slide.position": 0},
)
OSCILLATORS = Rig(
    "two coupled oscillators in one FMU",
    {
        "pair": OdeModel(
            "pair",
            {"k_1": (90.0, "1/s^2"), "k_2": (140.0, "1/s^2"), "k_c": (30.0, "1/s^2"), "c": (1.2, "1/s")},
            {"a": "m/s^2"},
            {
                "x_1": ("m", "0.0", "v_1"),
                "v_1": ("m/s", "0.0", "a - k_1*x_1 - c*v_1 - k_c*(x_1 - x_2)"),
                "x_2": ("m", "0.0", "v_2"),
                "v_2": ("m/s", "0.0", "-k_2*x_2 - c*v_2 - k_c*(x_2 - x_1)"),
            },
            {"first": ("m", "x_1"), "second": ("m", "x_2")},
        )
    },
    ("drive.a -> pair.a",),
    {"drive.a": ("m/s^2", 3.0)},
    {"pair.first": ("m", 0.005), "pair.second": ("m", 0.005)},
    0.02,
    450,
    25,
    "[x[1], u[0] - k_1*x[0] - c*x[1] - k_c*(x[0]-x[2]), x[3], -k_2*x[2] - c*x[3] - k_c*(x[2]-x[0])]",
    ("pair.x_1", "pair.v_1", "pair.x_2", "pair.v_2"),
    {"k_1": 90.0, "k_2": 140.0, "k_c": 30.0, "c": 1.2},
    {1: "velocity", 3: "velocity"},
    {"pair.first": 0, "pair.second": 2},
)
TANKS = Rig(
    "two tanks in two FMUs",
    {
        name: OdeModel(
            name,
            {"area": (area, "m^2"), "leak": (leak, "m^2/s"), "h_0": (0.3, "m")},
            {"inflow": "m^3/s"},
            {"h": ("m", "h_0", "(inflow - leak*h)/area")},
            {"level": ("m", "h"), "outflow": ("m^3/s", "leak*h")},
            inner_step=0.05,
        )
        for name, area, leak in (("upper", 0.5, 0.02), ("lower", 0.8, 0.015))
    },
    ("drive.flow -> upper.inflow", "upper.outflow -> lower.inflow"),
    {"drive.flow": ("m^3/s", 0.012)},
    {"upper.level": ("m", 0.004), "lower.level": ("m", 0.004)},
    0.5,
    420,
    70,
    "[(u[0] - leak_1*x[0])/area_1, (leak_1*x[0] - leak_2*x[1])/area_2]",
    ("upper.h", "lower.h"),
    {"area_1": 0.5, "leak_1": 0.02, "area_2": 0.8, "leak_2": 0.015},
    {0: "level", 1: "level"},
    {"upper.level": 0, "lower.level": 1},
)
MOTOR = Rig(
    "a DC motor with a load",
    {
        "motor": OdeModel(
            "motor",
            {
                "L": (0.05, "H"),
                "R": (1.2, "ohm"),
                "K": (0.3, "V*s/rad"),
                "J": (0.02, "kg*m^2"),
                "b": (0.02, "N*m*s/rad"),
            },
            {"voltage": "V"},
            {"i": ("A", "0.0", "(voltage - R*i - K*w)/L"), "w": ("rad/s", "0.0", "(K*i - b*w)/J")},
            {"current": ("A", "i"), "speed": ("rad/s", "w")},
        )
    },
    ("drive.voltage -> motor.voltage",),
    {"drive.voltage": ("V", 12.0)},
    {"motor.current": ("A", 0.005), "motor.speed": ("rad/s", 0.004)},
    0.004,
    500,
    60,
    "[(u[0] - R*x[0] - K*x[1])/L, (K*x[0] - b*x[1])/J]",
    ("motor.i", "motor.w"),
    {"L": 0.05, "R": 1.2, "K": 0.3, "J": 0.02, "b": 0.02},
    {0: "current", 1: "speed"},
    {"motor.current": 0, "motor.speed": 1},
)
ROOM = Rig(
    "a room with a heater",
    {
        "room": OdeModel(
            "room",
            {"C_a": (4e4, "J/K"), "C_w": (4e5, "J/K"), "U": (120.0, "W/K"), "V": (40.0, "W/K")},
            {"power": "W", "outside": "K"},
            {
                "T_a": ("K", "293.15", "(power - U*(T_a - T_w))/C_a"),
                "T_w": ("K", "293.15", "(U*(T_a - T_w) - V*(T_w - outside))/C_w"),
            },
            {"air": ("K", "T_a"), "wall": ("K", "T_w")},
            inner_step=5.0,
        )
    },
    ("drive.power -> room.power", "drive.outside -> room.outside"),
    {"drive.power": ("W", 1500.0), "drive.outside": ("K", 6.0)},
    {"room.air": ("K", 0.01), "room.wall": ("K", 0.01)},
    30.0,
    450,
    70,
    "[(u[0] - U*(x[0]-x[1]))/C_a, (U*(x[0]-x[1]) - V*(x[1]-u[1]))/C_w]",
    ("room.T_a", "room.T_w"),
    {"C_a": 4e4, "C_w": 4e5, "U": 120.0, "V": 40.0},
    {0: "temperature", 1: "temperature"},
    {"room.air": 0, "room.wall": 1},
)
#: Gains of the cart's own controller: linear-quadratic, weights 40, 1, 10, 1 of the states and 0.5 of the force.
_FORCE = "k_x*(reference - x) - k_v*v + k_t*theta + k_w*w"
_ACCELERATION = f"({_FORCE} - c*v + m*l*w*w*sin(theta) - m*9.81*sin(theta)*cos(theta)) / (M + m*sin(theta)*sin(theta))"
INVERTED = Rig(
    "a pendulum that a slide balances upside down",
    {
        "cart": OdeModel(
            "cart",
            {
                "M": (1.0, "kg"),
                "m": (0.2, "kg"),
                "l": (0.4, "m"),
                "c": (2.0, "N*s/m"),
                "k_x": (-8.94, "N/m"),
                "k_v": (-10.8, "N*s/m"),
                "k_t": (50.6, "N/rad"),
                "k_w": (9.88, "N*s/rad"),
            },
            {"reference": "m"},
            {
                "x": ("m", "0.0", "v"),
                "v": ("m/s", "0.0", _ACCELERATION),
                "theta": ("rad", "0.0", "w"),
                "w": ("rad/s", "0.0", f"(9.81*sin(theta) - cos(theta) * {_ACCELERATION}) / l"),
            },
            {"position": ("m", "x"), "angle": ("rad", "theta")},
        )
    },
    ("drive.reference -> cart.reference",),
    {"drive.reference": ("m", 0.25)},
    {"cart.position": ("m", 0.005), "cart.angle": ("rad", 0.005)},
    0.02,
    500,
    80,
    "balanced(x, u[0], M, m, l, c, k_x, k_v, k_t, k_w)",
    ("cart.x", "cart.v", "cart.theta", "cart.w"),
    {"M": 1.0, "m": 0.2, "l": 0.4, "c": 2.0, "k_x": -8.94, "k_v": -10.8, "k_t": 50.6, "k_w": 9.88},
    {1: "velocity", 3: "velocity"},
    {"cart.position": 0, "cart.angle": 2},
)
DRIVE = Rig(
    "a motor and its load in two FMUs",
    {
        "motor": OdeModel(
            "electric",
            {"L": (0.05, "H"), "R": (1.2, "ohm"), "K": (0.3, "V*s/rad")},
            {"voltage": "V", "speed": "rad/s"},
            {"i": ("A", "0.0", "(voltage - R*i - K*speed)/L")},
            {"current": ("A", "i"), "torque": ("N*m", "K*i")},
        ),
        "load": OdeModel(
            "rotor",
            {"J": (0.02, "kg*m^2"), "b": (0.02, "N*m*s/rad")},
            {"torque": "N*m"},
            {"w": ("rad/s", "0.0", "(torque - b*w)/J")},
            {"speed": ("rad/s", "w")},
        ),
    },
    ("drive.voltage -> motor.voltage", "load.speed -> motor.speed", "motor.torque -> load.torque"),
    {"drive.voltage": ("V", 12.0)},
    {"motor.current": ("A", 0.005), "load.speed": ("rad/s", 0.004)},
    0.004,
    500,
    60,
    "[(u[0] - R*x[0] - K*x[1])/L, (K*x[0] - b*x[1])/J]",
    ("motor.i", "load.w"),
    {"L": 0.05, "R": 1.2, "K": 0.3, "J": 0.02, "b": 0.02},
    {0: "current", 1: "speed"},
    {"motor.current": 0, "load.speed": 1},
    frozenset({"motor"}),
)


def balanced(state: Array, reference: float, M: float, m: float, length: float, c: float, *gains: float) -> list[float]:
    """Derivatives of the balanced pendulum.

    A point mass m at a distance from a pivot on a slide of mass M, theta from upright:
    (M + m) x'' + m l (theta'' cos theta - theta'^2 sin theta) = F - c x', l theta'' + x'' cos theta = g sin theta. The
    two are solved as a linear system, which the FMU does by hand.
    """
    x, v, theta, w = state
    force = gains[0] * (reference - x) - gains[1] * v + gains[2] * theta + gains[3] * w
    cos, sin = float(np.cos(theta)), float(np.sin(theta))
    matrix = np.array([[M + m, m * length * cos], [cos, length]])
    right = np.array([force - c * v + m * length * w * w * sin, 9.81 * sin])
    acceleration, turning = np.linalg.solve(matrix, right)
    return [float(v), float(acceleration), float(w), float(turning)]


def _hiding(rig: Rig, name: str, *components: str) -> Rig:
    """The same rig, of which some FMUs hide their states."""
    return replace(rig, name=name, hidden=frozenset(components))


RIGS = (
    SLIDE,
    OSCILLATORS,
    TANKS,
    MOTOR,
    ROOM,
    INVERTED,
    DRIVE,
    _hiding(SLIDE, "a slide by Co-Simulation", "slide"),
    _hiding(ROOM, "a room by Co-Simulation", "room"),
    _hiding(MOTOR, "a DC motor by Co-Simulation", "motor"),
    _hiding(TANKS, "two tanks, the upper by Co-Simulation", "upper"),
)
