"""How often `cosim recording check` finds what is wrong, and how often it doubts what is right."""
