"""From pictures of a rig to positions of its markers, and from positions of markers to pictures."""
