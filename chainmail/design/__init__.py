"""Designs: from what is wanted to a scenario that runs."""
