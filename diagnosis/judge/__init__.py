"""From a search to a verdict: findings, ambiguity, held-out recordings."""
