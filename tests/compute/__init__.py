"""Tests of cosim.compute."""
