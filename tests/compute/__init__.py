"""Tests of diagnosis.compute."""
