"""Faults of one recording with begin and end: a sensor that reads wrong for a while, an input that was another."""
