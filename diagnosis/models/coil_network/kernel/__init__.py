"""The coil network: circuit, heat, stiffness and hanging load of n coils in one compiled function."""
