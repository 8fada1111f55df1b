"""Colours of markers: by name, as #rrggbb, or only dark or bright."""

from __future__ import annotations

import re

Rgb = tuple[float, float, float]
#: Colours of paint and paper that are sold for markers, as red, green, blue from 0 to 255.
NAMES: dict[str, Rgb] = {
    "green": (0, 160, 60),
    "red": (200, 20, 30),
    "blue": (20, 60, 200),
    "yellow": (230, 210, 0),
    "magenta": (210, 0, 150),
    "cyan": (0, 170, 200),
    "orange": (240, 120, 0),
}
#: Markers that differ from their surroundings in brightness alone.
PLAIN = ("dark", "bright")
#: A colour must be this far from grey (largest less smallest part) to be told from grey in any light.
LEAST_CHROMA = 40.0
_HEX = re.compile(r"^#[0-9a-fA-F]{6}$")


def check_colour(text: str) -> str:
    """The text, if it is a colour of markers.

    Raises:
        ValueError: It is none, or too grey to be told from grey in changing light.
    """
    if text in PLAIN:
        return text
    if text not in NAMES and not _HEX.match(text):
        known = ", ".join((*NAMES, *PLAIN))
        raise ValueError(f"`{text}` is no colour; give one of {known}, or #rrggbb in quotes")
    parts = rgb(text)
    if max(parts) - min(parts) < LEAST_CHROMA:
        raise ValueError(f"`{text}` is too grey to be told from grey in changing light; write `dark` or `bright`")
    return text


def rgb(text: str) -> Rgb:
    """Red, green and blue from 0 to 255; of `dark` black, of `bright` white."""
    if text in PLAIN:
        return (0.0, 0.0, 0.0) if text == "dark" else (255.0, 255.0, 255.0)
    if text in NAMES:
        return NAMES[text]
    return (float(int(text[1:3], 16)), float(int(text[3:5], 16)), float(int(text[5:7], 16)))
