"""The systems that are measured: components, connections, step and stop, the same for every tool."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

#: Folder of the built FMUs (`python -m benchmarks.models.build`).
FMUS = Path(__file__).resolve().parent.parent.parent / "build" / "benchmark_models"


@dataclass(frozen=True)
class Connection:
    """`source.output -> target.input`."""

    source: str
    output: str
    target: str
    input: str


@dataclass(frozen=True)
class System:
    """Components wired to each other.

    Args:
        components: Name to model; the order is the stepping order of Gauss-Seidel.
        connections: Wires between Float64 scalars.
        outputs: What is compared, as (component, variable).
        step: Communication step [s].
        stop: End of the run [s].
        start: Start values, (component, variable) to value.
    """

    components: dict[str, str]
    connections: tuple[Connection, ...]
    outputs: tuple[tuple[str, str], ...]
    step: float
    stop: float
    start: dict[tuple[str, str], float]

    def fmu(self, component: str, version: int) -> Path:
        """FMU file of a component."""
        return FMUS / f"{self.components[component]}_fmi{version}.fmu"

    @property
    def steps(self) -> int:
        """Number of macro-steps."""
        return round(self.stop / self.step)


CHAIN = System(
    components={"first": "feedthrough", "second": "feedthrough"},
    connections=(Connection("first", "y", "second", "u"),),
    outputs=(("second", "y"),),
    step=1e-3,
    stop=100.0,
    start={("first", "u"): 3.0},
)

#: The quarter-truck case of the Open Simulation Platform's demo-cases (effort and flow of its bonds are `force` and
#: `velocity` here). Parameters and start values are those of the models: 400 kg, 15 kN/m, 1 kN s/m; 40 kg, 150 kN/m,
#: no damping; ground step 0.1 m at 1 s, its derivative filtered with 10 Hz; heights 1 m and 0.5 m, at rest, springs
#: compressed by the weights.
QUARTER_TRUCK = System(
    components={"chassis": "chassis", "wheel": "wheel", "ground": "ground"},
    connections=(
        Connection("chassis", "force", "wheel", "force_in"),
        Connection("wheel", "velocity", "chassis", "velocity_in"),
        Connection("wheel", "force", "ground", "force_in"),
        Connection("ground", "velocity", "wheel", "velocity_in"),
    ),
    outputs=(("chassis", "z"), ("wheel", "z"), ("ground", "z")),
    step=1e-3,
    stop=2.0,
    start={},
)

TWO_MASS = System(
    components={"left": "oscillator_left", "right": "oscillator_right"},
    connections=(
        Connection("left", "force", "right", "force_in"),
        Connection("right", "displacement", "left", "displacement_in"),
    ),
    outputs=(("left", "displacement"), ("left", "velocity"), ("right", "displacement"), ("right", "velocity")),
    step=1e-3,
    stop=0.8,
    start={},
)

#: y = u / 2 + 1 twice, in a circle: an algebraic loop whose one solution is y = 2.
LOOP = System(
    components={"first": "feedthrough", "second": "feedthrough"},
    connections=(Connection("first", "y", "second", "u"), Connection("second", "y", "first", "u")),
    outputs=(("first", "y"), ("second", "y")),
    step=1e-3,
    stop=1e-3,
    start={(n, v): value for n in ("first", "second") for v, value in (("gain", 0.5), ("offset", 1.0))},
)

#: A force [N] into a velocity [m/s]: a tool that checks units refuses it.
WRONG_UNITS = System(
    components={"chassis": "chassis", "wheel": "wheel"},
    connections=(Connection("chassis", "force", "wheel", "velocity_in"),),
    outputs=(("wheel", "z"),),
    step=1e-3,
    stop=1e-2,
    start={},
)

#: The second FMU aborts its process at 0.5 s.
CRASH = System(
    components={"first": "feedthrough", "second": "crasher"},
    connections=(Connection("first", "y", "second", "u"),),
    outputs=(("second", "y"),),
    step=1e-3,
    stop=1.0,
    start={("first", "u"): 3.0},
)

SYSTEMS = {
    "chain": CHAIN,
    "quarter_truck": QUARTER_TRUCK,
    "two_mass": TWO_MASS,
    "loop": LOOP,
    "wrong_units": WRONG_UNITS,
    "crash": CRASH,
}
