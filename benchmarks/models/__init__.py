"""Small FMUs for measurements: C sources, their descriptions and the builder."""
