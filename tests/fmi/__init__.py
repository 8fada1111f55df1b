"""FMUs of our own for every type, event and trouble that FMI knows."""
