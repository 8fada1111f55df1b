"""One scenario with a fabric from several starts: contacts decide by micrometres, so one run is one draw."""
