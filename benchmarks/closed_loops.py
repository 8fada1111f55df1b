"""Closed loops against their aims: one command that prints every figure of docs/control.md but those of a fabric.

    python -m benchmarks.closed_loops
    python -m benchmarks.closed_loops runs/prototype_hold ...     # and those of finished runs of prototype_hold.yaml

The systems are those of `tests/control`, which assert the bounds; here the figures themselves are printed.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import xarray as xr

from cosim.run import run
from cosim.scenario import Scenario, load_scenario
from cosim.unit.quantity import PhysicalValue
from tests.control.closed_form import largest_error
from tests.control.files import loop
from tests.control.test_supervisor import FAULTS, LIMIT, cases

ZERO = 273.15
#: Closed form of the power that holds the 36 coils of the prototype at a temperature, G (T - T_room) [W/K].
CONDUCTANCE = 36 * 90.0 * 97.85e-6


def main() -> None:
    """Print the table, and that of a fabric where its run is given."""
    print(f"sampled PI loop against its closed form: {largest_error():.1e} K over 300 samples")
    for share in (0.7, 1.0, 1.3):
        found = run(_plain(share))
        hottest = float(found["actuator.temperature"].max()) - ZERO
        print(f"PI to 62 degC, h A times {share:g}: hottest {hottest:.2f} degC, overshoot {hottest - 62.0:.2f} K")
    flat, held = run(_plain(1.0)), run(load_scenario("closed_loop_coil"))
    powers = [float(r["circuit.power"].sel(time=slice(10.0, None)).mean()) for r in (flat, held)]
    energies = [r.attrs["energy_electrical_J"] for r in (flat, held)]
    print(f"one coil, 30 s: PI {energies[0]:.2f} J, hold {energies[1]:.2f} J ({100 * energies[1] / energies[0]:.0f} %)")
    print(f"one coil, holding: PI {powers[0]:.3f} W, hold {powers[1]:.3f} W ({100 * powers[1] / powers[0]:.0f} %)")
    for supervised in (True, False):
        drawn = run(loop(cases(supervised, FAULTS), 20.0))["actuator.temperature"].values.max(axis=0) - ZERO
        name = "with" if supervised else "without"
        print(
            f"200 drawn coils {name} supervisor: hottest {drawn.max():.2f} degC, limit {LIMIT:g} degC; "
            f"{int((drawn > LIMIT + 1.0).sum())} above it by more than 1 K"
        )
    for folder in sys.argv[1:]:
        print(folder)
        fabric(xr.open_dataset(Path(folder) / "results.nc"))


def _plain(share: float) -> Scenario:
    """The shipped loop as a plain PI at 62 degC, with another convection."""
    scenario = load_scenario("closed_loop_coil")
    controller, actuator = scenario.components["controller"], scenario.components["actuator"]
    law = controller.law.inner  # type: ignore[union-attr]
    plain = controller.model_copy(update={"law": law, "setpoint": PhysicalValue(62.0, "degC")})
    heat = PhysicalValue(90 * share, "W/m^2/K")
    other = actuator.model_copy(update={"parameters": {"heat_transfer_coefficient": heat}})
    return scenario.model_copy(update={"components": {**scenario.components, "controller": plain, "actuator": other}})


def fabric(found: xr.Dataset) -> None:
    """What the whole prototype takes to be held, and the band of curvature in which it stays."""
    late = found.sel(time=slice(8.0, None))
    power = float(late["circuit.supply_power"].mean())
    flat = CONDUCTANCE * 40.0
    saved = 100 * (1 - power / flat)
    print(f"prototype, held: {power:.2f} W; G (62 degC - 22 degC) is {flat:.2f} W: {saved:.1f} % less")
    length = 1e3 * late["fabric.link_length"].isel(link=slice(6, None))
    print(f"free links: {float(length.mean()):.2f} mm on average, longest {float(length.max()):.2f} mm")
    curved = late["fabric.max_curvature"].values
    low, middle, high = np.percentile(curved, [5, 50, 95])
    print(
        f"curvature from 8 s on: median {middle:.2f} 1/m, 5 to 95 % {low:.2f} to {high:.2f}, "
        f"all {curved.min():.2f} to {curved.max():.2f}"
    )
    cold = found["fabric.max_curvature"].sel(time=slice(-0.5, 0.0)).mean()
    print(f"before heating: {float(cold):.2f} 1/m")


if __name__ == "__main__":
    main()
