"""Finds what a scenario leaves out of a recording, and models it."""
