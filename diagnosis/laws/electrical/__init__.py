"""Laws of circuits: what acts on a current or a voltage."""
