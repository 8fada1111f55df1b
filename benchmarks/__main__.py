"""`python -m benchmarks`: every measurement, one after the other."""

from __future__ import annotations

from benchmarks import bullet_convergence, macro_step, units, whole_run

for measurement in (whole_run, units, macro_step, bullet_convergence):
    measurement.main([])
