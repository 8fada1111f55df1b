"""A single pendulum with its recordings."""
