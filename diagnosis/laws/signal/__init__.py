"""Laws of inputs: what an actuator makes of its command."""
