"""A pendulum with concealed friction: three engines, one law."""
