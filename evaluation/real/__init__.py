"""Public recordings of systems that a user would describe by an FMU."""
