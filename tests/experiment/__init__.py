"""Tests of the design of the next experiment."""
