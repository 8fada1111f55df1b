"""Sensors and controllers: units between what is measured and what drives."""
