"""Components of a scenario: one typed model per kind."""

from __future__ import annotations

import itertools
import math
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, StrictBool, StrictInt, StrictStr, model_validator

from cosim.unit.protocol import NANOSECONDS
from cosim.unit.quantity import In, PhysicalValue

Time = Annotated[PhysicalValue, In("s")]
Duration = Annotated[PhysicalValue, In("s", minimum=0.0, is_exclusive=True)]
AnyQuantity = Annotated[PhysicalValue, In()]
Count = Annotated[StrictInt, Field(ge=1)]
#: A parameter or start value of any FMI type. Text that is no quantity is for String, or for Binary in hexadecimal.
Scalar = Annotated[StrictBool | AnyQuantity | StrictStr, Field(union_mode="left_to_right")]
ParameterValue = Annotated[
    Scalar | list[Scalar] | list[list[Scalar]] | list[list[list[Scalar]]], Field(union_mode="left_to_right")
]
#: A parameter of our own units.
NumberValue = StrictBool | AnyQuantity | list[AnyQuantity]


class Strict(BaseModel):
    """Base: unknown keys are errors, and nothing changes after loading."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)


def nanoseconds(value: PhysicalValue) -> int:
    """Integer time [ns] of a quantity of time; raises ValueError if it is no whole number of nanoseconds."""
    exact = value.to("s") * NANOSECONDS
    if not math.isfinite(exact):
        raise ValueError(f"`{value}` is too long for simulated time, which is counted in nanoseconds")
    if abs(exact - round(exact)) > 1e-3:
        raise ValueError(f"`{value}` is not a whole number of nanoseconds")
    if exact and not round(exact):
        raise ValueError(f"`{value}` is less than a nanosecond, the resolution of simulated time")
    return round(exact)


class ProgrammeOutput(Strict):
    """One quantity given over time."""

    unit: str = Field(description="Unit of the output, for example V or K.")
    dim: str | None = Field(default=None, description="Dimension of a list of values, for example string.")
    constant: AnyQuantity | list[AnyQuantity] | None = None
    points: list[tuple[Time, AnyQuantity | list[AnyQuantity]]] | None = Field(
        default=None, description="[time, value] pairs; before the first its value holds, after the last its own."
    )
    interpolation: Literal["hold", "linear"] = "hold"

    @model_validator(mode="after")
    def _check(self) -> ProgrammeOutput:
        if (self.constant is None) == (self.points is None):
            raise ValueError("give either `constant` or `points`")
        values = [self.constant] if self.points is None else [v for _, v in self.points]
        if not values:
            raise ValueError("`points` is empty")
        sizes = {len(v) if isinstance(v, list) else None for v in values}
        if len(sizes) > 1:
            raise ValueError("all points must have the same number of values")
        if (sizes != {None}) != (self.dim is not None):
            raise ValueError("a list of values needs `dim`, a single value must not have it")
        for value in values:
            for element in value if isinstance(value, list) else [value]:
                assert element is not None
                element.to(self.unit)
        for (one, _), (other, _) in itertools.pairwise(self.points or []):
            if nanoseconds(one) >= nanoseconds(other):
                raise ValueError(f"the times of `points` must rise, and {other} comes after {one}")
        return self


class ProgrammeComponent(Strict):
    """Quantities given over time: supply voltage, room or bath temperature."""

    kind: Literal["programme"]
    outputs: dict[str, ProgrammeOutput]


class ContactElement(Strict):
    """A contact resistance in a string."""

    kind: Literal["contact"]
    string: Count
    resistance: Annotated[PhysicalValue, In("ohm", minimum=0.0)]
    instant: Time | None = Field(default=None, description="Time from which on it is there; default: always.")


class LeadElement(Strict):
    """A lead that warms up with its current: rise times current squared, in series with a string."""

    kind: Literal["lead"]
    string: Count
    rise: Annotated[PhysicalValue, In("ohm/A^2", minimum=0.0)]


class DropElement(Strict):
    """A voltage that a string takes whatever its current; it fades below 10 mA."""

    kind: Literal["drop"]
    string: Count
    voltage: Annotated[PhysicalValue, In("V", minimum=0.0)]


class SourceResistanceElement(Strict):
    """Inner resistance of one source."""

    kind: Literal["source_resistance"]
    supply: Count = 1
    resistance: Annotated[PhysicalValue, In("ohm", minimum=0.0)]


class CurrentLimitElement(Strict):
    """A source that lowers its voltage where its current would exceed a limit."""

    kind: Literal["current_limit"]
    supply: Count = 1
    limit: Annotated[PhysicalValue, In("A", minimum=0.0, is_exclusive=True)]
    share: float = Field(default=1.0, ge=0.0, le=1.0, description="1: the limit holds; less: it gives way.")


class SlowSourceElement(Strict):
    """A source whose voltage follows what is set behind a first-order delay."""

    kind: Literal["slow_source"]
    supply: Count = 1
    delay: Annotated[PhysicalValue, In("s", minimum=0.0)]


CircuitElement = Annotated[
    ContactElement | LeadElement | DropElement | SourceResistanceElement | CurrentLimitElement | SlowSourceElement,
    Field(discriminator="kind"),
]


class CircuitComponent(Strict):
    """The coil network, solved by ngspice."""

    kind: Literal["ngspice"]
    strings: list[Count] = Field(min_length=1, description="Coils in series, per string.")
    supply: Literal["common", "per_string"] = "common"
    supply_resistance: Annotated[PhysicalValue, In("ohm", minimum=0.0)] = PhysicalValue(0.0, "ohm")
    string_resistance: Annotated[PhysicalValue, In("ohm", minimum=0.0)] = PhysicalValue(0.0, "ohm")
    open_coils: list[StrictInt] = Field(default=[], description="Coils that are open, counted from 1.")
    shorted_coils: list[StrictInt] = Field(default=[], description="Coils that are shorted, counted from 1.")
    elements: list[CircuitElement] = Field(
        default=[], description="Contacts, leads, inner resistances and current limits, in series."
    )
    start: dict[str, AnyQuantity] = Field(default={}, description="First values of inputs that close a loop.")


class Isolation(Strict):
    """An FMU in a process of its own: its crash, endless step or leak becomes an error of this unit alone."""

    kind: Literal["process"] = "process"
    step_limit: Duration = Field(
        default=PhysicalValue(60.0, "s"), description="Wall time that one call into the FMU may take."
    )
    memory_limit: Annotated[PhysicalValue, In("byte", minimum=0.0, is_exclusive=True)] = Field(
        default=PhysicalValue(4.0, "GB"), description="Memory that its process may use."
    )


class AddedStateEntry(Strict):
    """A state that a term has of its own."""

    rate: StrictStr = Field(description="Formula of its derivative.")
    start: StrictStr = Field(description="Formula of its value at the start.")
    unit: StrictStr = Field(default="1", description="Its unit.")


class AddedDelayEntry(Strict):
    """An input as it was some time ago."""

    of: StrictStr = Field(description="Name of an input of the FMU.")
    by: StrictStr = Field(description="Parameter of the term that is the time; 0 or longer.")


class AddedInputEntry(Strict):
    """A quantity of another component."""

    of: StrictStr = Field(description="component.variable: one floating-point number, a local variable of an FMU too.")
    unit: StrictStr = Field(default="1", description="Its unit in the formulas.")


class AddedTermEntry(Strict):
    """A term that the master adds to an FMU."""

    to: StrictStr = Field(
        description="der(state) or parameter(name) of a Model Exchange FMU, or the name of an input or output."
    )
    formula: StrictStr = Field(description="In the FMU's variables, `time` and the parameters; units are checked.")
    is_share: bool = Field(
        default=False,
        description="The formula is a pure number: a share of the derivative as the FMU has it, or of the parameter.",
    )
    parameters: dict[str, AnyQuantity] = {}
    states: dict[str, AddedStateEntry] = Field(
        default={}, description="States of its own: what it adds may depend on the past."
    )
    delays: dict[str, AddedDelayEntry] = Field(
        default={}, description="Inputs as they were some time ago, by the names that the formulas use."
    )
    inputs: dict[str, AddedInputEntry] = Field(
        default={}, description="Quantities of other components, by the names that the formulas use."
    )


class FmuComponent(Strict):
    """A functional mock-up unit; an actuator, or anything else."""

    kind: Literal["fmu"]
    fmu: str = Field(description="Name of a shipped FMU (thermal_stiffness) or path of a .fmu file.")
    fmi: Literal[2, 3] = Field(default=3, description="FMI version of a shipped FMU.")
    integrator: Literal["internal", "cvode"] = Field(
        default="internal", description="internal: Co-Simulation; cvode: Model Exchange integrated by CVODE."
    )
    tolerance: Annotated[PhysicalValue, In("1", minimum=0.0, is_exclusive=True)] | None = Field(
        default=None, description="Relative tolerance of the integrator; default 1e-8 for cvode, the FMU's own else."
    )
    isolation: Literal["none", "process"] | Isolation = Field(
        default="none", description="process: in a process of its own; a mapping sets its limits."
    )
    structure: dict[str, Count] = Field(default={}, description="Structural parameters.")
    parameter_set: str | None = None
    parameters: dict[str, ParameterValue] = {}
    start: dict[str, ParameterValue] = Field(
        default={}, description="Start values: of inputs, and of what the FMU declares as initial exact or approx."
    )
    record: list[str] = Field(default=[], description="Local variables that the results keep beside the outputs.")
    added_terms: list[AddedTermEntry] = Field(
        default=[], description="What is added to derivatives of its states, to its inputs and outputs."
    )


class ActuatorComponent(FmuComponent):
    """An FMU behind the actuator interface: it connects itself to the neighbours named here."""

    kind: Literal["actuator"]  # type: ignore[assignment]  # another tag of the same keys
    electrical: str | None = Field(
        default=None, description="Component that powers it (`power`, `voltage`) and takes its `resistance`."
    )
    ambient: str | None = Field(default=None, description="Component whose `temperature` surrounds it.")
    mechanical: str | None = Field(
        default=None, description="Component that takes `stiffness` and `rest_length`, gives `extension` and `tension`."
    )


class Tether(Strict):
    """Which links are held."""

    kind: Literal["cantilever", "hanging"]
    rows: Count = 2


class Solver(Strict):
    """Numerical settings of the engine."""

    micro_step: Duration = PhysicalValue(0.5, "ms")
    iterations: Count = Field(
        default=200, description="bullet: of every micro-step; mujoco: the most of them, fewer where it converges."
    )
    friction_model: Literal["cone", "pyramid"] = Field(
        default="cone", description="bullet: pyramid takes about 0.6 of the time (docs/engines.md)."
    )
    springs: Literal["force", "motor"] = Field(
        default="force", description="force: springs rattle at their stops; motor: they do not (docs/mechanics.md)."
    )
    friction_anchors: bool = Field(
        default=False,
        description="bullet: what sticks stays; without it a fabric at rest creeps (docs/engines.md).",
    )
    penetration_limit: Annotated[PhysicalValue, In("m", minimum=0.0, is_exclusive=True)] = PhysicalValue(2.0, "mm")


#: MuJoCo's stops and contacts need a shorter step: at 0.5 ms some starts tear (docs/engines.md).
MUJOCO_STEP = PhysicalValue(0.25, "ms")


class FabricComponent(Strict):
    """Interlocked links as rigid bodies, in Bullet unless another engine is named."""

    kind: Literal["bullet_fabric"]
    engine: Literal["bullet", "mujoco"] = Field(
        default="bullet", description="bullet reproduces the paper; mujoco is faster (docs/engines.md)."
    )
    rows: Annotated[StrictInt, Field(ge=3)]
    columns: Count
    tether: Tether
    solver: Solver = Field(default=Solver(), description="micro_step: 0.5 ms by default, 0.25 ms with mujoco.")
    parameter_set: str | None = None
    parameters: dict[str, NumberValue] = {}
    start: dict[str, AnyQuantity] = {}

    @model_validator(mode="before")
    @classmethod
    def _micro_step_of_the_engine(cls, given: Any) -> Any:
        """`MUJOCO_STEP` where no other step is given."""
        if isinstance(given, dict) and given.get("engine") == "mujoco":
            solver = given.get("solver", {})
            if isinstance(solver, dict):
                given = {**given, "solver": {"micro_step": str(MUJOCO_STEP), **solver}}
        return given


class HangingMassComponent(Strict):
    """A mass hanging from each coil, in equilibrium (the paper's water bath)."""

    kind: Literal["hanging_mass"]
    coils: Count
    mass: Annotated[PhysicalValue, In("kg", minimum=0.0, is_exclusive=True)]
    start: dict[str, AnyQuantity] = {}


class PendulumComponent(Strict):
    """A single rigid arm on a fixed hinge, in Bullet."""

    kind: Literal["bullet_pendulum"]
    micro_step: Duration = PhysicalValue(1.0, "ms")
    parameter_set: str | None = None
    parameters: dict[str, NumberValue] = {}
    start: dict[str, AnyQuantity] = Field(default={}, description="First values of inputs that close a loop.")


NotNegativeTime = Annotated[PhysicalValue, In("s", minimum=0.0)]


class SensorFault(Strict):
    """A sensor that fails at an instant."""

    element: Count = 1
    instant: Time
    reads: AnyQuantity | None = Field(
        default=None, description="What it measures from then on; default: its reading stays what it was."
    )


class SensorComponent(Strict):
    """Thermometers or a camera: from a quantity to readings, with the laws and names of `cosim record`."""

    kind: Literal["sensor"]
    unit: str = Field(description="Unit of quantity and reading, for example K.")
    elements: Count = Field(default=1, description="Sensors; each reads one element of what is connected.")
    dim: str = Field(default="coil", description="Dimension of the elements in the results.")
    sample: Duration = Field(description="Interval between readings; a multiple of the macro-step.")
    lag: NotNegativeTime = Field(default=PhysicalValue(0.0, "s"), description="Time constant, of a thermocouple.")
    exposure: NotNegativeTime = Field(
        default=PhysicalValue(0.0, "s"), description="Time over which a reading is averaged, of a camera."
    )
    delay: NotNegativeTime = Field(
        default=PhysicalValue(0.0, "s"), description="From the instant of a reading until it is given out."
    )
    gain: float | list[float] = 1.0
    bias: AnyQuantity | list[AnyQuantity] | None = None
    drift: AnyQuantity | None = Field(default=None, description="Added per second, for example 0.01 K/s.")
    noise: AnyQuantity | None = Field(default=None, description="Standard deviation of white noise.")
    minimum: AnyQuantity | None = Field(default=None, description="Smallest reading.")
    maximum: AnyQuantity | None = Field(default=None, description="Largest reading.")
    quantum: AnyQuantity | None = Field(default=None, description="Step of the reading.")
    seed: Annotated[StrictInt, Field(ge=0)] = 0
    faults: list[SensorFault] = []
    start: dict[str, AnyQuantity] = Field(default={}, description="First values of inputs that close a loop.")


class OnOffLaw(Strict):
    """Full drive below a band around the setpoint, none above it."""

    kind: Literal["on_off"]
    band: AnyQuantity = Field(description="Width of the band.")


class PiLaw(Strict):
    """Proportional-integral control with anti-windup."""

    kind: Literal["pi"]
    gain: AnyQuantity = Field(description="Demand per unit of the measured value, for example 0.2 V^2/K.")
    integral_time: Duration
    feedforward: AnyQuantity | None = Field(
        default=None, description="Demand that holds one unit above `ambient`, for example 0.019 V^2/K."
    )
    ambient: AnyQuantity | None = None

    @model_validator(mode="after")
    def _check(self) -> PiLaw:
        if (self.feedforward is None) != (self.ambient is None):
            raise ValueError("`feedforward` and `ambient` belong together")
        return self


class HoldLaw(Strict):
    """Heat to the setpoint, then hold on the cooling branch of the hysteresis."""

    kind: Literal["hold"]
    hold_at: AnyQuantity
    reheat_below: AnyQuantity
    inner: Annotated[PiLaw | OnOffLaw, Field(discriminator="kind")]


class PythonLaw(Strict):
    """A law of a user's own (docs/control.md)."""

    kind: Literal["python"]
    file: StrictStr = Field(description="A .py file beside the scenario, with `command(sample, memory, ...)`.")
    parameters: dict[str, AnyQuantity] = {}


class SupervisorSettings(Strict):
    """What keeps a temperature below its limit, whatever the law asks for (docs/control.md)."""

    limit: AnyQuantity
    margin: AnyQuantity = Field(description="Largest error of a right thermometer.")
    fastest_rise: AnyQuantity = Field(description="Rise at the highest command of the coil that heats fastest.")
    slowest_rise: AnyQuantity | None = Field(default=None, description="The same of the slowest; default: no check.")
    cooling_time: Duration | None = Field(default=None, description="Shortest time constant of cooling.")
    ambient: AnyQuantity | None = Field(default=None, description="Lowest temperature of the surroundings.")
    tolerance: AnyQuantity | None = Field(default=None, description="Lack of response that is a failure.")
    delay: NotNegativeTime = PhysicalValue(0.0, "s")
    lag: NotNegativeTime = PhysicalValue(0.0, "s")
    lowest: AnyQuantity | None = Field(default=None, description="At or below this a reading is a failure.")
    highest: AnyQuantity | None = Field(default=None, description="At or above this a reading is a failure.")
    frozen_after: Duration | None = Field(default=None, description="An unchanged reading is a failure after this.")

    @model_validator(mode="after")
    def _check(self) -> SupervisorSettings:
        together = ("slowest_rise", "cooling_time", "ambient", "tolerance")
        given = [n for n in together if getattr(self, n) is not None]
        if given and len(given) < len(together):
            missing = next(n for n in together if n not in given)
            raise ValueError(f"`{missing}` is missing: {', '.join(together)} belong together")
        return self


class ControllerComponent(Strict):
    """From measured values to what drives: one command for all, or one per string."""

    kind: Literal["controller"]
    groups: list[Count] = Field(min_length=1, description="Measured elements of every string.")
    supply: Literal["common", "per_string"] = "per_string"
    measured_unit: str = "K"
    command_unit: str = "V"
    sample: Duration = Field(description="Interval between samples; a multiple of the macro-step.")
    lowest: AnyQuantity = Field(description="Lowest command.")
    highest: AnyQuantity = Field(description="Highest command.")
    drive: Literal["linear", "squared"] = Field(
        default="linear", description="squared: the law's demand is the square of the command, as heat is of a voltage."
    )
    combine: Literal["mean", "max", "min"] = "mean"
    setpoint: AnyQuantity | list[AnyQuantity] = Field(description="Where nothing is connected to `setpoint`.")
    law: Annotated[OnOffLaw | PiLaw | HoldLaw | PythonLaw, Field(discriminator="kind")]
    fmu: Literal["string_controller"] | None = Field(
        default=None, description="string_controller: law and supervisor run in this FMU, one per string."
    )
    supervisor: SupervisorSettings | None = None
    start: dict[str, AnyQuantity] = Field(default={}, description="First values of inputs that close a loop.")


Component = Annotated[
    ProgrammeComponent
    | CircuitComponent
    | FmuComponent
    | ActuatorComponent
    | FabricComponent
    | HangingMassComponent
    | PendulumComponent
    | SensorComponent
    | ControllerComponent,
    Field(discriminator="kind"),
]
