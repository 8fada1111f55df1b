"""A unit in a process of its own: its crash, endless step or leak becomes an error of this unit alone."""
