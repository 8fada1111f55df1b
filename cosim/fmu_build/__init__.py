"""Compiling actuators in C to FMUs."""
