"""A fabric of one's own: take a shipped scenario, change it, run it, look at the lengths of the links."""

from cosim.run import run
from cosim.scenario import load_scenario
from cosim.unit.quantity import PhysicalValue

scenario = load_scenario("passive_drape")
fabric = scenario.components["fabric"]
heavier = fabric.model_copy(update={"rows": 5, "parameters": {"link_mass": PhysicalValue(10.0, "g")}})
short = scenario.time.model_copy(update={"stop": PhysicalValue(0.3, "s"), "checkpoint_step": PhysicalValue(0.3, "s")})
scenario = scenario.model_copy(update={"components": {**scenario.components, "fabric": heavier}, "time": short})

dataset = run(scenario)
by_row = 100 * dataset["fabric.link_length"].isel(time=-1).groupby("link_row").mean("link")
print(f"{dataset.sizes['link']} links; mean length by row [cm]: {by_row.values.round(2).tolist()}")
