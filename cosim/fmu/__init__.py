"""Functional mock-up units: the only place where an FMU is opened, loaded and called."""
