"""Sweeps: one scenario at many values of its keys, as one labelled data set."""
