"""Contract of all models of the diagnosis."""
