"""Public recordings of other laboratories, made into recording folders."""
