"""Tests of the isolability."""
