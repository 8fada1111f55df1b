"""Equations and measures of the paper, as plain functions of arrays."""
