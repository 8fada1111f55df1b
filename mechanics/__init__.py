"""Mechanical unit: interlocked links as rigid bodies in Bullet."""
