"""Tests of cosim.sweep."""
