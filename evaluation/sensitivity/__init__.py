"""What changes where a number by which the diagnosis decides is half or twice as large."""
