"""Tests of the diagnosis of fabrics in Bullet."""
