"""Co-simulation of active chainmail: one algorithm, any units (FMUs, ngspice, Bullet)."""
