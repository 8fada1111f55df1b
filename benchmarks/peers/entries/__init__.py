"""One file per tool: runs a job with it and prints the result as JSON."""
