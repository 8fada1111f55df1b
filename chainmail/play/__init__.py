"""A run as a moving picture: one offline page, a GIF or an MP4, or inline in a notebook (docs/play.md)."""

from chainmail.play.notebook import play

__all__ = ["play"]
