"""From a fitted point to a model that `cosim run` runs: scenario, generated FMUs, netlist elements, sensors."""
