"""Laws of heat: what acts on a temperature."""
