"""Measurements of speed and convergence; nothing here decides whether a test passes."""
