"""The scorecard: every number the paper publishes, beside ours."""
