"""Effects that a truth may hold: one class each, with draws of strength, place and time."""
