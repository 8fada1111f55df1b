"""Where the standard's schemas come from: for SSP 1.0 from fmpy, for 2.0 from a folder that the user names."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import Any

import fmpy
from lxml import etree

from cosim.unit.errors import InputError

_NAMED: ContextVar[Path | None] = ContextVar("ssp_schemas", default=None)


@contextmanager
def named_schemas(folder: Path | None) -> Iterator[None]:
    """SSP 2.0 files are checked against the schemas in `folder` meanwhile; None: by the reader's own rules alone.

    Raises:
        InputError: There are none in it.
    """
    if folder is not None and not (folder / "SystemStructureDescription.xsd").is_file():
        raise InputError(
            folder,
            "",
            "there is no SystemStructureDescription.xsd in it",
            "give the folder `schema` of the SSP 2.0 standard's files",
        )
    token = _NAMED.set(folder)
    try:
        yield
    finally:
        _NAMED.reset(token)


def schema(name: str, version: str) -> Any:
    """The schema of one kind of file, or None where there is none for this version.

    Args:
        name: For example `SystemStructureDescription`.
        version: 1.0 or 2.0.

    Raises:
        InputError: The schema that the user named cannot be read.
    """
    folder = _NAMED.get() if version == "2.0" else Path(fmpy.__file__).parent / "ssp" / "schema"
    if folder is None:
        return None
    return _read(folder.resolve() / f"{name}.xsd")


@functools.cache
def _read(path: Path) -> Any:
    try:
        return etree.XMLSchema(etree.parse(str(path)))
    except (OSError, etree.LxmlError) as error:
        raise InputError(path, "", f"this schema cannot be read: {error}", "give the standard's own file") from error
