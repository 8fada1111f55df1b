"""Building blocks of written files: elements, units, types."""

from __future__ import annotations

import importlib.metadata
from collections.abc import Iterable, Mapping
from typing import Any

from lxml import etree

from cosim.ssp.model import BASE_UNITS, Unit
from cosim.ssp.namespaces import PREFIXES, SSC, SSD, SSM, SSV, TYPES_OF_SSP1, Version, tag

#: Types of FMI 3.0 that SSP 1.0 has under another name.
_NAMES_OF_SSP1 = {"Float64": "Real", "Int32": "Integer"}


def root(namespace: str, element: str, version: Version, **attributes: str) -> Any:
    """Root element of a file, with the version and the tool."""
    used = {p: n for p, n in PREFIXES.items() if n in (SSC, namespace) or (namespace == SSD and n in (SSV, SSM))}
    tool = (
        f"active-chainmail {importlib.metadata.version('active-chainmail')}" if _is_installed() else "active-chainmail"
    )
    return etree.Element(tag(namespace, element), nsmap=used, version=version, generationTool=tool, **attributes)


def _is_installed() -> bool:
    try:
        importlib.metadata.version("active-chainmail")
    except importlib.metadata.PackageNotFoundError:
        return False
    return True


def type_name(fmi_type: str, version: Version) -> str:
    """Name of a type of FMI in a version of SSP.

    Raises:
        ValueError: SSP 1.0 has no such type.
    """
    if version == "2.0":
        return fmi_type
    name = _NAMES_OF_SSP1.get(fmi_type, fmi_type)
    if name not in TYPES_OF_SSP1:
        raise ValueError(f"SSP 1.0 has no type {fmi_type}")
    return name


def number(value: float) -> str:
    """Shortest text that reads back to the same double."""
    return repr(float(value))


def add_units(parent: Any, namespace: str, units: Iterable[Unit]) -> None:
    """`Units` with the definition of every unit that a file uses."""
    listed = sorted(units, key=lambda u: u.name)
    if not listed:
        return
    element = etree.SubElement(parent, tag(namespace, "Units"))
    for unit in listed:
        entry = etree.SubElement(element, tag(SSC, "Unit"), name=unit.name)
        base = etree.SubElement(entry, tag(SSC, "BaseUnit"))
        for name, exponent in zip(BASE_UNITS, unit.exponents, strict=True):
            if exponent:
                base.set(name, str(exponent))
        if unit.factor != 1.0:
            base.set("factor", number(unit.factor))
        if unit.offset != 0.0:
            base.set("offset", number(unit.offset))


def add_enumerations(parent: Any, namespace: str, enumerations: Mapping[str, Mapping[str, int]]) -> None:
    """`Enumerations` with the items of every enumeration that a file uses."""
    if not enumerations:
        return
    element = etree.SubElement(parent, tag(namespace, "Enumerations"))
    for name, items in sorted(enumerations.items()):
        entry = etree.SubElement(element, tag(SSC, "Enumeration"), name=name)
        for item, value in items.items():
            etree.SubElement(entry, tag(SSC, "Item"), name=item, value=str(value))


def add_dimensions(parent: Any, shape: tuple[int, ...]) -> None:
    """`Dimension` of every dimension."""
    for size in shape:
        etree.SubElement(parent, tag(SSC, "Dimension"), size=str(size))


def to_bytes(element: Any) -> bytes:
    """The file's content."""
    etree.indent(element)
    content: bytes = etree.tostring(element, xml_declaration=True, encoding="UTF-8")
    return content
