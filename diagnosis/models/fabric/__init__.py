"""Diagnosis of fabrics in Bullet: few simulations, contact scatter as uncertainty, mechanical candidates."""
