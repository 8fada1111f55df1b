"""Candidate effects: one file each, with law, source, bounds, places and the C lines that put it into a model."""
