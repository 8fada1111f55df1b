"""Groups of sub-commands of the command line."""
