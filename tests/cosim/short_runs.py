"""Shipped scenarios, shortened, for tests that need a whole run."""

from __future__ import annotations

from typing import Any

from cosim.scenario import Scenario, load_scenario
from cosim.unit.quantity import PhysicalValue


def quantity(text: str) -> PhysicalValue:
    """`0.2 s` as a quantity."""
    return PhysicalValue.parse(text)


def shortened(name: str, stop: str, **time: str) -> Scenario:
    """A shipped scenario that stops earlier; programme points after the end are dropped."""
    scenario = load_scenario(name)
    times = {"stop": stop, **time}
    components = {}
    for key, component in scenario.components.items():
        update: dict[str, Any] = {}
        if component.kind == "programme":
            end = quantity(stop).to("s")
            update["outputs"] = {
                n: o
                if o.points is None
                else o.model_copy(update={"points": [p for p in o.points if p[0].to("s") <= end] or o.points[:1]})
                for n, o in component.outputs.items()
            }
        components[key] = component.model_copy(update=update)
    clock = scenario.time.model_copy(update={k: quantity(v) for k, v in times.items()})
    return scenario.model_copy(update={"time": clock, "components": components})


def with_parameters(scenario: Scenario, component: str, **parameters: Any) -> Scenario:
    """The scenario with other parameters of one component; texts become quantities."""
    old = scenario.components[component]
    values = {k: quantity(v) if isinstance(v, str) else v for k, v in parameters.items()}
    new = old.model_copy(update={"parameters": {**old.parameters, **values}})  # type: ignore[union-attr]
    return scenario.model_copy(update={"components": {**scenario.components, component: new}})


def changed(scenario: Scenario, component: str, **fields: Any) -> Scenario:
    """The scenario with other fields of one component."""
    new = scenario.components[component].model_copy(update=fields)
    return scenario.model_copy(update={"components": {**scenario.components, component: new}})


def without_fabric(name: str) -> Scenario:
    """Circuit and actuator alone, over the whole time of the scenario: nothing feeds back from the fabric."""
    scenario = load_scenario(name)
    components = {n: c for n, c in scenario.components.items() if n != "fabric"}
    components["actuator"] = components["actuator"].model_copy(update={"mechanical": None})
    algorithm = scenario.algorithm.model_copy(update={"order": list(components)})
    connections = [c for c in scenario.connections if "fabric." not in c]
    return scenario.model_copy(update={"components": components, "algorithm": algorithm, "connections": connections})


def drape() -> Scenario:
    """0.3 s of the passive drape, a checkpoint every 0.1 s."""
    return shortened("passive_drape", "0.3 s", checkpoint_step="0.1 s")


def heating() -> Scenario:
    """3 s of single coils, switched off after 1.5 s by the scenario's own second point moved there."""
    scenario = shortened("single_coil_heating", "3 s", checkpoint_step="1 s")
    supply = scenario.components["supply"].outputs["voltage"]  # type: ignore[union-attr]
    first = supply.points[0]
    off = (quantity("1.5 s"), [quantity("0 V")] * len(first[1]))
    return changed(scenario, "supply", outputs={"voltage": supply.model_copy(update={"points": [first, off]})})


def prototype(stop: str = "-3.8 s") -> Scenario:
    """The first 0.2 s of the whole prototype: circuit, FMU and Bullet, under 6 V from the start."""
    scenario = shortened("prototype_cantilever", stop, checkpoint_step="0.1 s")
    supply = scenario.components["supply"].outputs["voltage"]  # type: ignore[union-attr]
    points = [(quantity("-4 s"), quantity("6 V"))]
    return changed(scenario, "supply", outputs={"voltage": supply.model_copy(update={"points": points})})
