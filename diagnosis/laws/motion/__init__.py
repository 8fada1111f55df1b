"""Laws of translation and rotation: what acts on a velocity."""
