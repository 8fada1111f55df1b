"""Batches of simulations: on several processes or a Dask cluster, kept on disk, with progress."""
