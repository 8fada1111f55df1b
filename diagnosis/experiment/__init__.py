"""The next experiment: the programme within the limits of a rig that separates rival explanations best."""
