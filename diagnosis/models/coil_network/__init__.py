"""The network of coils: circuit, heat, stiffness and hanging load, compiled; what of it may be off."""
