"""Tests of the location."""
