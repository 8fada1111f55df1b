"""Laws of inputs: what an actuator makes of what it is told."""
