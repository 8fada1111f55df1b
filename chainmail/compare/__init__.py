"""One scenario over several actuators, side by side."""
