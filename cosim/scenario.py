"""Scenario files: YAML to a typed, validated description of one run.

A scenario names components, the connections between their variables, the algorithm and the times. Quantities carry
their units. `json_schema()` is what editors use to complete and check a file.
"""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import Annotated, Any, Literal

import pydantic
import yaml
from pydantic import BaseModel, ConfigDict, Field, StrictBool, StrictInt, model_validator

from cosim.errors import InputError
from cosim.quantity import In, PhysicalValue
from cosim.unit import NANOSECONDS
from cosim.yaml_file import input_error, parse_yaml, read_text

_REMEDY = "`cosim schema` prints every key; `cosim list` shows examples"
Time = Annotated[PhysicalValue, In("s")]
Duration = Annotated[PhysicalValue, In("s", minimum=0.0, is_exclusive=True)]
AnyQuantity = Annotated[PhysicalValue, In()]
Count = Annotated[StrictInt, Field(ge=1)]
#: `component.output -> component.input`; variables of an FMU may hold dots and brackets themselves.
CONNECTION = r"^\s*(\w+)\.(\S+)\s*->\s*(\w+)\.(\S+)\s*$"
ParameterValue = StrictBool | AnyQuantity | list[AnyQuantity]


def nanoseconds(value: PhysicalValue) -> int:
    """Integer time [ns] of a quantity of time; raises ValueError if it is no whole number of nanoseconds."""
    exact = value.to("s") * NANOSECONDS
    if abs(exact - round(exact)) > 1e-3:
        raise ValueError(f"`{value}` is not a whole number of nanoseconds")
    return round(exact)


class Strict(BaseModel):
    """Base: unknown keys are errors, and nothing changes after loading."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class TimeSettings(Strict):
    """Start, end and steps of a run."""

    start: Time = Field(default=PhysicalValue(0.0, "s"), description="Simulated time at which the run begins.")
    stop: Time = Field(description="Simulated time at which the run ends; met exactly.")
    macro_step: Duration = Field(description="Communication step of the co-simulation.")
    output_step: Duration = Field(description="Interval between recorded values; a multiple of the macro-step.")
    checkpoint_step: Duration = Field(default=PhysicalValue(2.0, "s"), description="Interval between checkpoints.")

    @model_validator(mode="after")
    def _check(self) -> TimeSettings:
        start, stop, macro = nanoseconds(self.start), nanoseconds(self.stop), nanoseconds(self.macro_step)
        output, checkpoint = nanoseconds(self.output_step), nanoseconds(self.checkpoint_step)
        if stop <= start:
            raise ValueError(f"stop ({self.stop}) must come after start ({self.start})")
        for name, value, divisor, of in (
            ("output_step", output, macro, "macro_step"),
            ("checkpoint_step", checkpoint, output, "output_step"),
            ("stop - start", stop - start, output, "output_step"),
        ):
            if value % divisor:
                raise ValueError(f"{name} ({value / 1e9:g} s) must be a multiple of {of} ({divisor / 1e9:g} s)")
        return self


class Algorithm(Strict):
    """How the units are stepped."""

    kind: Literal["gauss_seidel", "jacobi"] = "gauss_seidel"
    order: list[str] | None = Field(default=None, description="Order of the components; default: as listed.")


class ProgrammeOutput(Strict):
    """One quantity given over time."""

    unit: str = Field(description="Unit of the output, for example V or K.")
    dim: str | None = Field(default=None, description="Dimension of a list of values, for example string.")
    constant: AnyQuantity | list[AnyQuantity] | None = None
    points: list[tuple[Time, AnyQuantity | list[AnyQuantity]]] | None = Field(
        default=None, description="[time, value] pairs."
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
        times = [nanoseconds(t) for t, _ in self.points or []]
        if any(a >= b for a, b in itertools.pairwise(times)):
            raise ValueError("the times of `points` must rise")
        return self


class ProgrammeComponent(Strict):
    """Quantities given over time: supply voltage, room or bath temperature."""

    kind: Literal["programme"]
    outputs: dict[str, ProgrammeOutput]


class CircuitComponent(Strict):
    """The coil network, solved by ngspice."""

    kind: Literal["ngspice"]
    strings: list[Count] = Field(min_length=1, description="Coils in series, per string.")
    supply: Literal["common", "per_string"] = "common"
    supply_resistance: Annotated[PhysicalValue, In("ohm", minimum=0.0)] = PhysicalValue(0.0, "ohm")
    string_resistance: Annotated[PhysicalValue, In("ohm", minimum=0.0)] = PhysicalValue(0.0, "ohm")
    open_coils: list[StrictInt] = Field(default=[], description="Coils that are open, counted from 1.")
    shorted_coils: list[StrictInt] = Field(default=[], description="Coils that are shorted, counted from 1.")
    start: dict[str, AnyQuantity] = Field(default={}, description="First values of inputs that close a loop.")


class FmuComponent(Strict):
    """A functional mock-up unit; an actuator, or anything else."""

    kind: Literal["fmu"]
    fmu: str = Field(description="Name of a shipped FMU (thermal_stiffness) or path of a .fmu file.")
    fmi: Literal[2, 3] = Field(default=3, description="FMI version of a shipped FMU.")
    integrator: Literal["internal", "cvode"] = Field(
        default="internal", description="internal: Co-Simulation; cvode: Model Exchange integrated by CVODE."
    )
    structure: dict[str, Count] = Field(default={}, description="Structural parameters.")
    parameter_set: str | None = None
    parameters: dict[str, ParameterValue] = {}
    start: dict[str, AnyQuantity] = {}


class Tether(Strict):
    """Which links are held."""

    kind: Literal["cantilever", "hanging"]
    rows: Count = 2


class Solver(Strict):
    """Bullet's solver."""

    micro_step: Duration = PhysicalValue(0.5, "ms")
    iterations: Count = 200
    springs: Literal["force", "motor"] = Field(
        default="force", description="force: springs rattle at their stops; motor: they do not (docs/mechanics.md)."
    )
    penetration_limit: Annotated[PhysicalValue, In("m", minimum=0.0, is_exclusive=True)] = PhysicalValue(2.0, "mm")


class FabricComponent(Strict):
    """Interlocked links as rigid bodies in Bullet."""

    kind: Literal["bullet_fabric"]
    rows: Annotated[StrictInt, Field(ge=2)]
    columns: Count
    tether: Tether
    solver: Solver = Solver()
    parameter_set: str | None = None
    parameters: dict[str, ParameterValue] = {}
    start: dict[str, AnyQuantity] = {}


class HangingMassComponent(Strict):
    """A mass hanging from each coil, in equilibrium (the paper's water bath)."""

    kind: Literal["hanging_mass"]
    coils: Count
    mass: Annotated[PhysicalValue, In("kg", minimum=0.0, is_exclusive=True)]
    start: dict[str, AnyQuantity] = {}


Component = Annotated[
    ProgrammeComponent | CircuitComponent | FmuComponent | FabricComponent | HangingMassComponent,
    Field(discriminator="kind"),
]


class Scenario(Strict):
    """One run, as a scenario file describes it."""

    title: str
    description: str = ""
    time: TimeSettings
    algorithm: Algorithm = Algorithm()
    components: dict[Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]*$")], Component]
    connections: list[Annotated[str, Field(pattern=CONNECTION)]]
    path: Path | None = Field(default=None, exclude=True, description="File that it was read from.")

    @model_validator(mode="after")
    def _check(self) -> Scenario:
        order = self.algorithm.order
        if order is not None and sorted(order) != sorted(self.components):
            raise ValueError(f"algorithm.order must list every component once: {', '.join(self.components)}")
        self._check_grid()
        return self

    def _check_grid(self) -> None:
        """Switching times must fall on the macro-step grid: a switch inside a step would act late, silently."""
        start, macro = nanoseconds(self.time.start), nanoseconds(self.time.macro_step)
        for name, component in self.components.items():
            if isinstance(component, FabricComponent):
                micro = component.solver.micro_step
                if macro % nanoseconds(micro):
                    raise ValueError(f"components.{name}.solver.micro_step ({micro}) must divide time.macro_step "
                                     f"({self.time.macro_step}) into a whole number of steps")  # fmt: skip
            if isinstance(component, ProgrammeComponent):
                for output, given in component.outputs.items():
                    late = [t for t, _ in given.points or [] if (nanoseconds(t) - start) % macro]
                    if late:
                        raise ValueError(
                            f"components.{name}.outputs.{output}: {late[0]} is not a whole number of macro-steps "
                            f"({self.time.macro_step}) after the start; move it, or choose another macro_step"
                        )

    def names(self) -> list[str]:
        """Components in stepping order."""
        return self.algorithm.order or list(self.components)

    def to_yaml(self, is_complete: bool = False) -> str:
        """The scenario as YAML that `load_scenario` reads back to an equal scenario.

        Args:
            is_complete: Write defaults too, so that the text keeps its meaning where a default changes later.
        """
        data = self.model_dump(mode="json", exclude_defaults=not is_complete, exclude_none=True)
        return yaml.safe_dump(data, sort_keys=False, allow_unicode=True, width=110)


def parse_scenario(text: str, source: Path) -> Scenario:
    """Scenario from YAML text.

    Args:
        text: YAML.
        source: File named in errors; relative paths inside the scenario start from its folder.

    Raises:
        InputError: It is no YAML, or a key or value is wrong; all faults are listed, each with its key.
    """
    data = parse_yaml(text, source)
    if not isinstance(data, dict):
        raise InputError(source, "", "a scenario is a mapping with the keys title, time, components, connections",
                         "copy one from `cosim list`")  # fmt: skip
    if "path" in data:
        raise InputError(source, "path", "there is no such key here", "remove it: the path is that of the file itself")
    try:
        return Scenario.model_validate({**data, "path": source})
    except pydantic.ValidationError as error:
        raise input_error(source, error, _REMEDY) from error


def load_scenario(path: str | Path) -> Scenario:
    """Read a scenario file, or a shipped scenario by its name.

    Raises:
        InputError: There is no such file, or it is wrong.
    """
    found = find_scenario(path)
    return parse_scenario(read_text(found), found)


def scenario_folder() -> Path:
    """Folder of the shipped scenarios."""
    return Path(__file__).resolve().parent.parent / "scenarios"


def shipped_scenarios() -> dict[str, Path]:
    """Name to file of every shipped scenario."""
    return {path.stem: path for path in sorted(scenario_folder().glob("*.yaml"))}


def find_scenario(path: str | Path) -> Path:
    """A file as given, or a shipped scenario by name."""
    direct = Path(path)
    if direct.is_file():
        return direct
    shipped = shipped_scenarios()
    if str(path) in shipped:
        return shipped[str(path)]
    raise InputError(path, "", "there is no such scenario", f"give a file, or one of: {', '.join(shipped)}")


def json_schema() -> dict[str, Any]:
    """JSON Schema of scenario files."""
    schema = Scenario.model_json_schema(mode="validation")
    schema["properties"].pop("path", None)
    schema["properties"]["components"]["additionalProperties"] = False  # names that break the pattern
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}
