"""Any scenario, simulated by the closed co-simulation."""
