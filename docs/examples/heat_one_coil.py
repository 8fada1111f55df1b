"""Run a shipped scenario from Python and read temperatures with xarray."""

from cosim.run import run
from cosim.scenario import load_scenario

dataset = run(load_scenario("single_coil_heating"))
hottest = dataset["actuator.temperature"].max("time") - 273.15
for voltage, temperature in zip(dataset["supply.voltage"].values[0], hottest.values, strict=True):
    print(f"{voltage:.1f} V: {temperature:.1f} degC")
