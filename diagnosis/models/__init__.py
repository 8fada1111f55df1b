"""Simulators of the diagnosis: a scenario and its recordings as a model that the search can vary."""
