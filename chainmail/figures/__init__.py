"""Figures of runs; they draw what a dataset holds and compute nothing."""
