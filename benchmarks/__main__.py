"""`python -m benchmarks`: every measurement that needs nothing but the project's own environment, one after the other.

The peers (`python -m benchmarks.peers.run`) need an environment of their own.
"""

from __future__ import annotations

from benchmarks import (
    bullet_convergence,
    isolation,
    loop,
    macro_step,
    quarter_truck,
    run_costs,
    two_mass,
    units,
    whole_run,
)

MEASUREMENTS = (
    whole_run,
    units,
    loop,
    run_costs,
    two_mass,
    quarter_truck,
    isolation,
    macro_step,
    bullet_convergence,
)

if __name__ == "__main__":
    for measurement in MEASUREMENTS:
        measurement.main([])
