"""Recordings and scenarios that are not of one experiment: one class for each way in which that comes about."""
