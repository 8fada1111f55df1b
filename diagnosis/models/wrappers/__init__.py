"""Models of the search that change what another model says."""
