"""What the sensors of a recording would read of a free run of the closed co-simulation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from cosim.components import FmuComponent, ProgrammeComponent
from cosim.run import run
from cosim.scenario import Scenario
from cosim.unit.protocol import Array
from cosim.unit.quantity import PhysicalValue
from cosim.yaml_file import parse_yaml, read_text
from diagnosis.amend.amend import AmendedModel
from diagnosis.amend.changes import Changes, FittedTerm
from diagnosis.amend.circuit_elements import circuit_elements
from diagnosis.amend.parts import Part
from diagnosis.amend.scenario_file import term_parameters
from diagnosis.candidates.registry import catalogue
from diagnosis.models.coil_network.kernel.inputs import CoilNetworkInputs
from diagnosis.models.coil_network.kernel.layout import QUANTITIES
from diagnosis.models.coil_network.kernel.network import CoilNetwork
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters, Packing, active_terms, pack
from diagnosis.models.coil_network.kernel.plan import Plan
from diagnosis.models.coil_network.kernel.source import reads_current
from diagnosis.models.coil_network.translate import Translation, translate
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.quantity import parse_quantity
from diagnosis.recording.recording import Recording
from diagnosis.recording.series import recorded_series
from diagnosis.search.cosim_run import shifted


@dataclass(frozen=True)
class Start:
    """The room and the start of one recording, as they were estimated.

    Args:
        ambient_offset: How much warmer its surroundings were than it says [K].
        temperature: Of every coil at the start [K], one number or shape (coils,).
        position: Of every coil in its hysteresis loop at the start, as `temperature`.
    """

    ambient_offset: float
    temperature: Array
    position: Array


def start_of(parameters: CoilNetworkParameters) -> Start:
    """The start in parameters of the network."""
    ambient, temperature, position = (
        np.asarray(parameters.base.get(n, 0.0), dtype=np.float64)
        for n in ("ambient_offset", "initial_temperature", "initial_loop_position")
    )
    return Start(float(np.mean(ambient)), temperature, position)  # one room for all coils


def free_run(
    amended: AmendedModel, recording: Recording, times: Mapping[str, Array], start: Start | None = None
) -> dict[str, Array]:
    """Run the amended scenario under the conditions of a recording, and read it.

    Args:
        amended: The model.
        recording: Whose conditions (programmes, ambient, first temperature) hold; nothing of what it measured is used.
        times: Quantity of the network to sample times [s], rising.
        start: Its room and start, where they were estimated; None: as it says, and off by what every day is off.

    Returns:
        Quantity to values at its samples, shape (samples, elements), SI, as the sensors read them, without noise.

    Raises:
        InputError: The conditions do not fit the scenario.
        RunStopped: A unit failed.
    """
    plain = scenario_of(amended.original, recording)
    translation = translate(plain)
    if start is None:
        said, offsets = start_of(translation.parameters), amended.changes.offsets
        start = replace(
            said,
            ambient_offset=offsets.get("ambient_offset", 0.0),
            temperature=said.temperature + offsets.get("initial_temperature", 0.0),
        )
    own = started(scenario_of(amended.scenario, carried(recording, amended)), plain, translation, start)
    return read_run(run(own), translation, times, amended.changes)


def free_run_of(
    scenario: Scenario, recording: Recording, times: Mapping[str, Array], start: Start | None = None
) -> dict[str, Array]:
    """The same of a scenario as it is, without any change but a start that was estimated."""
    plain = scenario_of(scenario, recording)
    translation = translate(plain)
    own = plain if start is None else started(plain, plain, translation, start)
    return read_run(run(own), translation, times)


def started(scenario: Scenario, plain: Scenario, translation: Translation, start: Start) -> Scenario:
    """A scenario with the room and the start of a recording.

    Args:
        scenario: What is to run, under the conditions of the recording.
        plain: What was diagnosed, under the same conditions: its room is the one that the recording says.
        translation: The same as a network.
        start: Of the recording.
    """
    components: dict[str, Any] = dict(scenario.components)
    name, _, output = translation.ambient.partition(".")
    room = plain.components[name]
    assert isinstance(room, ProgrammeComponent)
    moved = shifted(room.outputs[output], start.ambient_offset / translation.ambient_factor)
    components[name] = room.model_copy(update={"outputs": {**room.outputs, output: moved}})
    coils = components[translation.actuator]
    assert isinstance(coils, FmuComponent)
    own: dict[str, PhysicalValue | list[PhysicalValue]] = {"initial_temperature": _quantities(start.temperature, "K")}
    if np.any(start.position):
        own["initial_loop_position"] = _quantities(start.position, "1")
    components[translation.actuator] = coils.model_copy(update={"parameters": {**coils.parameters, **own}})
    return scenario.model_copy(update={"components": components})


def _quantities(values: Array, unit: str) -> PhysicalValue | list[PhysicalValue]:
    """One value, or one for each coil."""
    numbers = np.unique(values).tolist() if np.ptp(values) == 0.0 else values.tolist()
    found = [PhysicalValue(v, unit) for v in numbers]
    return found[0] if len(found) == 1 else found


def _own_terms(recording: Recording, amended: AmendedModel) -> Sequence[FittedTerm]:
    """Terms as they are in a recording, where they are not as in the scenario: nothing else has to be said of them."""
    changes = amended.changes
    terms = changes.terms if changes.terms_in is None else changes.terms_in(recording)
    same = all(
        np.array_equal(own.values[name], value)
        for own, one in zip(terms, changes.terms)
        for name, value in one.values.items()
    )
    return () if same else terms


def read_run(
    results: xr.Dataset, translation: Translation, times: Mapping[str, Array], changes: Changes | None = None
) -> dict[str, Array]:
    """Samples of a run, through the sensors of the network.

    Args:
        results: Of `cosim.run`.
        translation: The scenario as a network, under the same conditions.
        times: Quantity to sample times [s], rising.
        changes: What was found, the sensors' part of which is applied; None: ideal sensors.
    """
    inputs = translation.drive.on_grid(np.asarray(results["time"].values, dtype=np.float64))
    plan = Plan(translation.layout, inputs, times, is_midpoint=True)
    terms = tuple(t for t in catalogue() if t.axis == "channel")
    parameters = CoilNetworkParameters()
    if changes is not None:
        found = {s.term.identifier: dict(s.values) for s in changes.of(Part.SENSOR)}
        parameters = CoilNetworkParameters(dict(changes.sensors), found)
    active = active_terms(terms, parameters)
    is_current_read = any(reads_current(t) for t in terms if t.identifier in active)
    wanted = {*plan.times, *(("current",) if is_current_read and translation.circuit is not None else ())}
    traces = {q: _trace(results, translation, q, inputs) for q in wanted}
    packing = Packing(translation.layout, terms, active)
    # The network reads these traces in place of its own, so that both go through the same sensors.
    plan.read_traces(traces)
    out = CoilNetwork(translation.layout, terms).run(plan, packing, pack(packing, terms, parameters)[None])
    return {q: values[0] for q, values in plan.split(out).items()}


def _trace(results: xr.Dataset, translation: Translation, quantity: str, inputs: CoilNetworkInputs) -> Array:
    """A quantity over the run, shape (outputs, elements); a flow stands in the row that its step ends with."""
    owner = {
        "temperature": translation.actuator,
        "stiffness": translation.actuator,
        "resistance": translation.actuator,
        "current": translation.circuit,
        "supply_current": translation.circuit,
        "power": translation.circuit,
        "extension": translation.load,
        "length": translation.load,
        "tension": translation.load,
        "voltage": translation.circuit,
    }.get(quantity)
    if quantity in _MADE:
        return _made(results, translation, quantity)
    if owner is None and quantity == "power":
        assert inputs.power is not None
        return np.ascontiguousarray(np.vstack([inputs.power[:1], inputs.power]))
    variable = f"{owner}.{ {'current': 'string_current'}.get(quantity, quantity) }"
    values = np.asarray(results[variable].values, dtype=np.float64).reshape(len(results["time"]), -1)
    values = values.copy()
    if QUANTITIES[quantity].is_flow:
        values[0] = values[1]  # before the first step nothing flows
    return np.ascontiguousarray(values)


#: Quantities that no variable of the results is, to the channel that measures them in string {}.
_MADE = {"string_voltage": "string[{}].voltage", "supply_power": "supply.power", "terminal_voltage": "supply.voltage"}


def _made(results: xr.Dataset, translation: Translation, quantity: str) -> Array:
    """The same of a quantity that follows from several variables of the circuit."""
    layout, source = translation.layout, Path("results")
    if quantity == "terminal_voltage" and layout.sources > 1:
        values = np.asarray(results[f"{translation.circuit}.terminal_voltage"].values, dtype=np.float64)
    else:
        targets = [parse_quantity(_MADE[quantity].format(n + 1)) for n in range(layout.elements(quantity))]
        values = np.stack([recorded_series(results, t, source).values for t in targets], axis=1)
    values = values.copy()
    values[0] = values[1]  # before the first step nothing flows
    return np.ascontiguousarray(values)


def carried(recording: Recording, amended: AmendedModel) -> Recording:
    """The recording with what it overrides of recalibrated parameters moved by the factors that the fit found.

    What sets in during it, or is not there on its day, is said for it alone.
    """
    translation = amended.changes.translation
    components: dict[str, Any] = dict(recording.overrides.get("components", {}))
    for name in (translation.actuator, translation.load):
        if name is not None and name in components:
            components[name] = _carried_component(components[name], name == translation.load, amended)
    terms = _own_terms(recording, amended)
    own: dict[str | None, dict[str, Any]] = {
        translation.actuator: term_parameters([t for t in terms if t.part is Part.ACTUATOR], translation.layout),
        translation.load: term_parameters([t for t in terms if t.part is Part.LOAD], translation.layout),
    }
    if amended.files.actuator is not None and recording.cycles_before != amended.changes.cycles_before:
        own[translation.actuator]["cycles_before"] = f"{recording.cycles_before:.10g}"
    for name, parameters in own.items():
        if name is not None and parameters:
            given = components.get(name, {})
            components[name] = {**given, "parameters": {**given.get("parameters", {}), **parameters}}
    if any(t.part is Part.CIRCUIT for t in terms):
        assert translation.circuit is not None
        components[translation.circuit] = _own_circuit(
            recording, components.get(translation.circuit, {}), terms, amended
        )
    return replace(recording, overrides={**recording.overrides, "components": components})


def _own_circuit(
    recording: Recording, given: Mapping[str, Any], terms: Sequence[FittedTerm], amended: AmendedModel
) -> dict[str, Any]:
    """The circuit of a recording, with the elements of its own terms in place of those of the scenario's."""
    original = amended.original
    assert original.path is not None, "the scenario was read from a file"
    data = parse_yaml(read_text(original.path), original.path)
    circuit = data["components"][amended.changes.translation.circuit]
    first = given.get("elements", circuit.get("elements", []))
    start = translate(scenario_of(original, recording)).start
    elements = circuit_elements([t for t in terms if t.part is Part.CIRCUIT], start)
    return {**given, "elements": [*first, *elements]}


def _carried_component(given: Mapping[str, Any], is_load: bool, amended: AmendedModel) -> dict[str, Any]:
    factors = amended.changes.factors
    result = dict(given)
    if is_load and "mass" in given:
        mass = _scaled(result.pop("mass"), factors.get("load", np.ones(())))
        if amended.files.load is not None:
            result["parameters"] = {**given.get("parameters", {}), "mass": mass}
        else:
            result["mass"] = mass
    elif "parameters" in given:
        fields = {"heat_transfer_coefficient": "conductance", "area": "conductance"}
        fields |= dict.fromkeys(("volume", "density", "specific_heat"), "capacity")
        own = given["parameters"]
        result["parameters"] = {n: _scaled(v, factors.get(fields.get(n, n), np.ones(()))) for n, v in own.items()}
    return result


def _scaled(given: Any, factor: Array) -> Any:
    """A value or a list of values times a factor, in the unit that it is given in."""
    if np.ndim(factor) == 0 and float(factor) == 1.0:
        return given
    parts = given if isinstance(given, list) else [given]
    values = [PhysicalValue.parse(v) for v in parts]
    numbers = np.array([v.number for v in values]) * factor
    texts = [
        f"{n:.10g} {values[i if len(values) > 1 else 0].unit}".strip() for i, n in enumerate(np.atleast_1d(numbers))
    ]
    return texts if len(texts) > 1 else texts[0]
