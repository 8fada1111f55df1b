"""Amended models: what was fitted is what runs."""
