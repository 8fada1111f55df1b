"""Tests of cosim.control."""
