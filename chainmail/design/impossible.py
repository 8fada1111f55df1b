"""What is raised where no design can meet a request."""

from __future__ import annotations


class Impossible(Exception):
    """No design meets the request.

    Args:
        limit: The limit that forbids it.
        nearest: The nearest that is possible.
    """

    def __init__(self, limit: str, nearest: str) -> None:
        super().__init__(f"{limit}; {nearest}")
        self.limit, self.nearest = limit, nearest
