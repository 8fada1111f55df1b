"""The shipped scenario hanging_coils, shortened and changed."""

from cosim.scenario import Scenario, load_scenario
from cosim.unit.quantity import PhysicalValue


def quantity(text: str) -> PhysicalValue:
    """`0.2 s` as a quantity."""
    return PhysicalValue.parse(text)


def short(stop: str = "4 s", **actuator: object) -> Scenario:
    """hanging_coils with the supply on from 1 s to 3 s, and other keys of its actuator."""
    scenario = load_scenario("hanging_coils")
    time = scenario.time.model_copy(update={"stop": quantity(stop), "checkpoint_step": quantity("1 s")})
    supply = scenario.components["supply"]
    points = [(quantity(t), quantity(v)) for t, v in (("0 s", "0 V"), ("1 s", "6 V"), ("3 s", "0 V"))]
    points = [p for p in points if p[0].to("s") <= quantity(stop).to("s")]
    voltage = supply.outputs["voltage"].model_copy(update={"points": points})
    components = {**scenario.components, "supply": supply.model_copy(update={"outputs": {"voltage": voltage}})}
    shorter = scenario.model_copy(update={"time": time, "components": components})
    return changed(shorter, "actuator", **actuator)


def changed(scenario: Scenario, component: str, **fields: object) -> Scenario:
    """The scenario with other fields of one component."""
    new = scenario.components[component].model_copy(update=fields)
    return scenario.model_copy(update={"components": {**scenario.components, component: new}})
