"""Electrical unit: the network of shape-memory coils, solved by ngspice."""
