"""Laws without a name, by the form of their formula."""
