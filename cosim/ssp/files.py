"""Names and files of an imported scenario."""

from __future__ import annotations

import re
import shutil
from pathlib import Path


def plain_name(text: str) -> str:
    """A name that a scenario's component can have.

    >>> plain_name("3rd coil.left")
    'c_3rd_coil_left'
    """
    name = re.sub(r"[^A-Za-z0-9_]", "_", text)
    return name if name[:1].isalpha() else f"c_{name}"


def copy_once(source: Path, target: Path) -> Path:
    """Copy a file unless it is there already; another file of the same name gets a number."""
    candidate, count = target, 1
    while candidate.is_file() and candidate.read_bytes() != source.read_bytes():
        count += 1
        candidate = target.with_stem(f"{target.stem}_{count}")
    if not candidate.is_file():
        candidate.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, candidate)
    return candidate
