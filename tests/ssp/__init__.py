"""SSP: import, export, validation."""
