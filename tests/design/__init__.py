"""Tests of chainmail.design."""
