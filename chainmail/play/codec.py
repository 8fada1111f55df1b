"""Numbers over time as few bytes: rounded to a step, differences in time, variable-length integers, deflate.

A block is a table of integers, one series after the other. Each series is predicted from its own past (order 1: the
last value; order 2: the line through the last two) and the misses are written as LEB128 of their zigzag code, so that a
miss below 64 steps takes one byte. `player.js` reads the same blocks; `decode` here is its twin, for tests.
"""

from __future__ import annotations

import base64
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from cosim.unit.protocol import Array

Integers = npt.NDArray[np.int64]
#: Codes are kept below this, so that second differences fit into 32 bits in the browser.
LARGEST = 2**28


@dataclass(frozen=True)
class Block:
    """Rounded series of one quantity.

    Args:
        name: What it is, for the reader.
        codes: Shape (series, frames).
        scale: Size of one step, in the quantity's unit.
        offset: Value of code 0 of every series, shape (series,).
    """

    name: str
    codes: Integers
    scale: float
    offset: Array

    def values(self) -> Array:
        """The numbers that a reader gets back, shape (series, frames)."""
        return np.asarray(self.offset[:, None] + self.scale * self.codes)


def quantised(name: str, values: Array, step: float) -> Block:
    """Values rounded to a step.

    Args:
        name: Of the block.
        values: Shape (series, frames), finite.
        step: Distance of two values that can be told apart, in the quantity's unit.

    Raises:
        ValueError: A value is not finite, or the range holds more steps than a code can.

    >>> quantised("x", np.array([[0.0, 0.9, 2.1]]), 1.0).values()
    array([[0., 1., 2.]])
    """
    if not np.isfinite(values).all():
        raise ValueError(f"{name} is not finite")
    offset = values[:, 0].copy() if values.shape[1] else np.zeros(len(values))
    steps = (values - offset[:, None]) / step
    if steps.size and np.abs(steps).max() >= LARGEST:
        raise ValueError(f"{name} spans {np.ptp(values):.4g}, more than {LARGEST} steps of {step:.4g}")
    return Block(name, np.rint(steps).astype(np.int64), step, offset)


def encode(blocks: Sequence[Block]) -> tuple[str, list[dict[str, Any]]]:
    """All blocks as one text, and the table that says how to read it.

    Returns:
        Base64 of the deflated bytes (zlib format), and for each block its name, series, frames, order of prediction,
        scale, offsets and length in bytes before deflating.
    """
    content, table = [], []
    for block in blocks:
        order, data = min(((k, _bytes(block.codes, k)) for k in (1, 2)), key=lambda e: len(zlib.compress(e[1], 6)))
        content.append(data)
        table.append(
            {
                "name": block.name,
                "series": block.codes.shape[0],
                "frames": block.codes.shape[1],
                "order": order,
                "scale": block.scale,
                "offset": [float(f"{v:.9g}") for v in block.offset],
                "bytes": len(data),
            }
        )
    return base64.b64encode(zlib.compress(b"".join(content), 9)).decode("ascii"), table


def decode(text: str, table: Sequence[dict[str, Any]]) -> dict[str, Array]:
    """Values of every block by name, shape (series, frames): what `player.js` makes of the same text."""
    data, place, found = zlib.decompress(base64.b64decode(text)), 0, {}
    for entry in table:
        part = data[place : place + entry["bytes"]]
        place += entry["bytes"]
        codes = _integers(part).reshape(entry["series"], entry["frames"])
        for _ in range(entry["order"]):
            codes = np.cumsum(codes, axis=1)
        found[entry["name"]] = np.array(entry["offset"])[:, None] + entry["scale"] * codes
    return found


def _bytes(codes: Integers, order: int) -> bytes:
    """LEB128 of the zigzag codes of the differences."""
    miss = codes
    for _ in range(order):
        miss = np.diff(miss, axis=1, prepend=0)
    zigzag = np.where(miss < 0, -2 * miss - 1, 2 * miss).ravel()
    length = np.ones(len(zigzag), dtype=np.int64)
    for bits in (7, 14, 21, 28):
        length += zigzag >= 1 << bits
    end = np.cumsum(length)
    data = np.zeros(int(end[-1]) if len(end) else 0, dtype=np.uint8)
    for k in range(5):
        is_there = length > k
        more = (length > k + 1)[is_there]
        data[(end - length + k)[is_there]] = ((zigzag[is_there] >> 7 * k) & 0x7F) | (more << 7)
    return data.tobytes()


def _integers(data: bytes) -> Integers:
    found, value, shift = [], 0, 0
    for byte in data:
        value |= (byte & 0x7F) << shift
        shift += 7
        if byte < 0x80:
            found.append(-(value + 1 >> 1) if value & 1 else value >> 1)
            value = shift = 0
    return np.array(found, dtype=np.int64)
