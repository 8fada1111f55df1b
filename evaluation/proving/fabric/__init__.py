"""Truth for fabrics: links of its own geometry in Bullet, seen by a camera. It shares no code with the units."""
