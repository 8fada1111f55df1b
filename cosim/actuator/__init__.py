"""Actuators: the interface that makes them interchangeable, and how they connect themselves."""
