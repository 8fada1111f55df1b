"""Keep a C library's chatter off the terminal."""

from __future__ import annotations

import ctypes
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def without_output() -> Iterator[None]:
    """Send what C code prints to standard output and standard error to nowhere while the block runs.

    C keeps its own buffers, so they are emptied before and after; without a C library to ask, nothing is hidden.
    """
    try:
        flush = ctypes.CDLL(None).fflush
        kept = {stream: os.dup(stream) for stream in (1, 2)}
    except (OSError, AttributeError, TypeError):
        yield
        return
    sys.stdout.flush()
    sys.stderr.flush()
    flush(None)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in kept:
        os.dup2(nowhere, stream)
    try:
        yield
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        flush(None)
        for stream, copy in kept.items():
            os.dup2(copy, stream)
            os.close(copy)
        os.close(nowhere)
