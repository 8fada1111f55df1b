"""XML files of an SSP: parsed without entities or network, checked as their version asks."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lxml import etree

from cosim.ssp.model import Place
from cosim.ssp.namespaces import PREFIXES, SSB, SSD, SSM, SSV, tag
from cosim.ssp.rules import first_fault
from cosim.ssp.schemas import schema
from cosim.unit.errors import InputError

#: An XML file larger than this is refused [byte].
MAXIMUM_SIZE = 64 << 20

#: Root element to its schema.
SCHEMAS = {
    tag(SSD, "SystemStructureDescription"): "SystemStructureDescription",
    tag(SSV, "ParameterSet"): "SystemStructureParameterValues",
    tag(SSM, "ParameterMapping"): "SystemStructureParameterMapping",
    tag(SSB, "SignalDictionary"): "SystemStructureSignalDictionary",
}
_UNDECLARED = re.compile(r"Namespace prefix (\w+) ")
_ROOT = re.compile(rb"<(?![?!])[^\s/>]+")


@dataclass
class Document:
    """A parsed file.

    Args:
        package: What the user gave.
        file: Name inside it.
        root: Root element (lxml).
        notes: What was read otherwise than written.
    """

    package: Path
    file: str
    root: Any
    notes: list[str]

    def place(self, element: Any) -> Place:
        """Where an element stands."""
        return Place(self.package, self.file, element.sourceline or 0)


def parse(path: Path, package: Path, file: str, notes: list[str]) -> Document:
    """Parse one XML file.

    Args:
        path: Where it lies.
        package: What the user gave, for errors.
        file: Its name inside that.
        notes: What is read otherwise than written is added here.

    Raises:
        InputError: It cannot be read, is no XML, is too large or declares a document type (entities).
    """
    try:
        content = path.read_bytes() if path.stat().st_size <= MAXIMUM_SIZE else None
    except OSError as error:
        raise InputError(
            package, file, f"it cannot be read: {error.strerror}", "correct the reference to it"
        ) from error
    if content is None:
        raise InputError(package, file, "it is larger than 64 MB", "refused")
    root = _parsed(content, package, file, notes)
    document = Document(package, file, root, notes)
    if root.getroottree().docinfo.doctype:
        raise document.place(root).error("it declares a document type, which SSP does not use", "remove the DOCTYPE")
    return document


def _parsed(content: bytes, package: Path, file: str, notes: list[str]) -> Any:
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False)
    try:
        return etree.fromstring(content, parser)
    except etree.XMLSyntaxError as error:
        found = _UNDECLARED.search(str(error))
        if found and f"xmlns:{found[1]}=".encode() not in content:
            return _parsed(_declared(content, found[1], file, notes), package, file, notes)
        line = error.lineno or 0
        raise Place(package, file, line).error(
            f"this is no XML: {error.msg}", "correct it, or export it again"
        ) from error


def _declared(content: bytes, prefix: str, file: str, notes: list[str]) -> bytes:
    """The text with a prefix declared at its root: one of the standard, with the others, or one of another author.

    What stands in the namespace of another author is read by nobody here, so any name does.
    """
    root = _ROOT.search(content)
    assert root is not None  # the parser has met a prefixed element
    if prefix in PREFIXES:
        missing = {p: n for p, n in PREFIXES.items() if f"xmlns:{p}=".encode() not in content}
        notes.append(f"{file}: it uses prefixes that it does not declare; they were taken for those of the standard")
    else:
        missing = {prefix: f"urn:undeclared:{prefix}"}
        notes.append(f"{file}: it does not declare the prefix `{prefix}`; what it marks is passed over")
    text = "".join(f' xmlns:{p}="{n}"' for p, n in missing.items())
    return content[: root.end()] + text.encode() + content[root.end() :]


def validate(document: Document, element: Any, expected: str) -> str:
    """Validate an element as the version that it declares asks: by its schema, or by rules of our own.

    Args:
        document: Its file.
        element: Root element of a file, or a parameter set or mapping inside a system structure description.
        expected: Qualified name that it must have.

    Returns:
        The version: 1.0 or 2.0.

    Raises:
        InputError: It is another element, of another version, or breaks the schema; file and line are named.
    """
    place = document.place(element)
    if element.tag != expected:
        raise place.error(
            f"the element is {_short(element.tag)}, not {_short(expected)}", "refer to a file of that kind"
        )
    written = element.get("version", "")
    version = "2.0" if written.startswith("2.") else "1.0"
    if not re.match(r"[12]\.\d+", written):
        raise place.error(f"its version is `{written}`", "write it as SSP 1.0 or 2.0; drafts are not read")
    checker = schema(SCHEMAS[expected], version)
    if version == "2.0":
        broken = first_fault(element)
        if broken is not None:
            raise document.place(broken.element).error(
                f"{_short(broken.element.tag)} breaks the rules of SSP 2.0: {_short(broken.text)}",
                "correct the file, or export it again with a tool that writes valid SSP",
            )
    if checker is not None and not checker.validate(element):
        fault = checker.error_log[0]
        more = f" (and {len(checker.error_log) - 1} more)" if len(checker.error_log) > 1 else ""
        raise Place(document.package, document.file, fault.line).error(
            f"it breaks the schema of SSP {version}: {_readable(fault.message)}{more}",
            "correct the file, or export it again with a tool that writes valid SSP",
        )
    return version


def _short(name: str) -> str:
    """`ssd:System` for a qualified name."""
    for prefix, namespace in PREFIXES.items():
        name = name.replace(f"{{{namespace}}}", f"{prefix}:")
    return name


def _readable(message: str) -> str:
    return _short(message).replace("\n", " ")
