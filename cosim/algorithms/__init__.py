"""Co-simulation algorithms, one file each: `step(system, time, size) -> StepOutcome`."""
