"""The run loop and the CSV writer in C, for systems that need no Python between two macro-steps."""
