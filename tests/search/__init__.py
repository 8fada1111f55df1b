"""Tests of the search: fit, scores, structure, acceptance."""
