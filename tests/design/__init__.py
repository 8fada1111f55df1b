"""Tests of cosim.design."""
