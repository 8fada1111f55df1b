"""Laws of flow: what acts on a level, a volume or a pressure."""
