"""Search for missing physics: recalibrate, score, refit, compete, accept."""
