"""Recordings: what was done, what was measured, with which sensors."""
