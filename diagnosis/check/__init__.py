"""Are a recording and a scenario of the same experiment? Asked before anything is fitted."""
