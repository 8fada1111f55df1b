"""What watches a run without disturbing it: the trace and the energy balance."""
