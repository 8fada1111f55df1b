"""What a user would pick instead of `cosim diagnose`, on the recordings of a draw."""
