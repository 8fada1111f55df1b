"""What the channels of the recordings can tell apart: by the structure of their equations and by sizes."""
