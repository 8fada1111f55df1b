"""Each unit driven alone: which departs from the recordings, where, when, on what it depends, and by what input."""
