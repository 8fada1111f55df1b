"""Units in processes of their own."""
