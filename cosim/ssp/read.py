"""System Structure Descriptions (SSD): XML to `cosim.ssp.model`, with what they refer to."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from cosim.ssp import package
from cosim.ssp.annotations import other_step, own_settings
from cosim.ssp.document import Document, parse, validate
from cosim.ssp.model import (
    Binding,
    Component,
    Connection,
    Connector,
    DictionaryReference,
    Element,
    End,
    MappingEntry,
    ParameterSet,
    Structure,
    System,
)
from cosim.ssp.namespaces import (
    DEFAULT_SSD,
    FLOAT_TYPES,
    FMU_TYPE,
    SSB,
    SSB_TYPE,
    SSC,
    SSD,
    SSD_TYPE,
    SSM_TYPE,
    SSP_TYPE,
    SSV_TYPE,
    tag,
)
from cosim.ssp.read_parameters import Definitions, is_true, read_mapping, read_parameter_set, transformation
from cosim.unit.errors import InputError

#: Systems and packages inside each other deeper than this are refused: a package may refer to itself.
MAXIMUM_DEPTH = 20
_NOT_TYPES = {tag(SSC, "Dimension"), tag(SSD, "Clock"), tag(SSD, "ConnectorGeometry"), tag(SSD, "Annotations")}


def read_structure(path: Path, folder: Path, variant: str = "") -> Structure:
    """Read an opened package.

    Args:
        path: The .ssp or .ssd file that the user gave.
        folder: Its files (`package.opened`).
        variant: Name of another .ssd file of the package.

    Raises:
        InputError: A file breaks its schema, refers to what is not there, or is of a kind that is not read.
    """
    name = variant or (path.name if path.suffix.lower() == ".ssd" else DEFAULT_SSD)
    if not (folder / name).is_file():
        there = ", ".join(sorted(p.name for p in folder.glob("*.ssd")))
        raise InputError(path, "", f"there is no {name} in it", f"it holds: {there}")
    return _Reader(path, folder, folder / name, []).structure()


class _Reader:
    """One .ssd file; a package inside a package has a reader of its own."""

    def __init__(self, path: Path, root: Path, file: Path, notes: list[str], depth: int = 0) -> None:
        self._path, self._root, self._folder, self._notes, self._depth = path, root.resolve(), file.parent, notes, depth
        self.document = self._parsed(file)
        self._definitions: Definitions

    def _parsed(self, file: Path) -> Document:
        return parse(file, self._path, str(file.resolve().relative_to(self._root)), self._notes)

    def structure(self) -> Structure:
        """The whole file."""
        top = self.document.root
        version = validate(self.document, top, tag(SSD, "SystemStructureDescription"))
        self._definitions = Definitions(self.document, top, SSD)
        experiment = top.find(tag(SSD, "DefaultExperiment"))
        system = self._system(top.find(tag(SSD, "System")), self._depth)
        start, stop = (self._time(experiment, key) for key in ("startTime", "stopTime"))
        return Structure(
            top.get("name"),
            version,
            top.get("description", ""),
            system,
            start,
            stop,
            own_settings(self.document, experiment),
            other_step(top),
            tuple(self._notes),
            self.document.place(top),
        )

    def _time(self, experiment: Any, key: str) -> float | None:
        text = None if experiment is None else experiment.get(key)
        if text is None:
            return None
        value = float(text)
        if not math.isfinite(value):
            raise self.document.place(experiment).error(
                f"{key} is `{text}`, which is no time", "give a number of seconds"
            )
        return value

    def _system(self, element: Any, depth: int) -> System:
        place = self.document.place(element)
        if depth > MAXIMUM_DEPTH:
            raise place.error(f"systems are nested more than {MAXIMUM_DEPTH} deep", "does a system contain itself?")
        elements: dict[str, Element] = {}
        listed = element.find(tag(SSD, "Elements"))
        for child in listed if listed is not None else ():
            if not isinstance(child.tag, str):
                continue  # a comment
            read = self._element(child, depth)
            if read.name in elements:
                raise read.place.error(f"two elements of one system are named `{read.name}`", "rename one of them")
            elements[read.name] = read
        connections = element.iterfind(f"{tag(SSD, 'Connections')}/{tag(SSD, 'Connection')}")
        dictionaries = list(element.iterfind(f"{tag(SSD, 'SignalDictionaries')}/{tag(SSD, 'SignalDictionary')}"))
        for dictionary in dictionaries:
            self._expect_type(dictionary, SSB_TYPE)
            validate(*self._referred(dictionary, dictionary), tag(SSB, "SignalDictionary"))
        return System(
            element.get("name"),
            self._connectors(element),
            self._bindings(element),
            place,
            elements,
            tuple(self._connection(c) for c in connections),
            frozenset(d.get("name") for d in dictionaries),
        )

    def _element(self, element: Any, depth: int) -> Element:
        if element.tag == tag(SSD, "System"):
            return self._system(element, depth + 1)
        name, place = element.get("name"), self.document.place(element)
        if element.tag == tag(SSD, "SignalDictionaryReference"):
            return DictionaryReference(name, self._connectors(element), (), place, element.get("dictionary"))
        kind, uri = element.get("type", FMU_TYPE), element.get("source")
        if uri is not None and kind in (SSD_TYPE, SSP_TYPE):
            return self._nested(element, kind, uri, depth)
        source = None if uri is None else self._resolved(element, uri)
        return Component(
            name,
            self._connectors(element),
            self._bindings(element),
            place,
            kind,
            source,
            element.get("implementation", "any"),
            own_settings(self.document, element),
        )

    def _nested(self, element: Any, kind: str, uri: str, depth: int) -> System:
        """A component that refers to another SSD or SSP: its system, with the component's name and bindings on top."""
        place = self.document.place(element)
        fragment = urlsplit(uri).fragment
        if uri.startswith("#"):
            found = next((s for s in self.document.root.iter(tag(SSD, "System")) if s.get("id") == fragment), None)
            if found is None:
                raise place.error(f"there is no system with the id `{fragment}` in the file", "correct the reference")
            system = self._system(found, depth + 1)
        elif depth >= MAXIMUM_DEPTH:
            raise place.error(f"packages are nested more than {MAXIMUM_DEPTH} deep", "does a package contain itself?")
        else:
            file = self._resolved(element, uri)
            if kind == SSP_TYPE:
                folder = file.with_name(f"{file.name}.unpacked")
                if not folder.is_dir():
                    self._unpack(element, file, folder)
                file = folder / (fragment or DEFAULT_SSD)
                if not file.is_file():
                    raise place.error(f"there is no {file.name} in {uri}", "correct the reference")
            system = _Reader(self._path, self._root, file, self._notes, depth + 1).structure().system
        bindings = system.bindings + self._bindings(element)
        return System(
            element.get("name"),
            system.connectors,
            bindings,
            place,
            system.elements,
            system.connections,
            system.dictionaries,
        )

    def _unpack(self, element: Any, file: Path, folder: Path) -> None:
        try:
            package.extract(file, folder)
        except InputError as error:  # it names the file where the outer package is unpacked for the moment
            where = f"{element.get('source')}: {error.key}: " if error.key else f"{element.get('source')}: "
            raise self.document.place(element).error(where + error.problem, error.remedy) from error

    def _resolved(self, element: Any, uri: str) -> Path:
        try:
            return package.resolve(uri, self._folder, self._root)
        except ValueError as error:
            raise self.document.place(element).error(
                str(error), "put the file into the package's `resources`"
            ) from error

    def _connectors(self, element: Any) -> dict[str, Connector]:
        found: dict[str, Connector] = {}
        for entry in element.iterfind(f"{tag(SSD, 'Connectors')}/{tag(SSD, 'Connector')}"):
            place = self.document.place(entry)
            typed = next((c for c in entry if isinstance(c.tag, str) and c.tag not in _NOT_TYPES), None)
            kind = None if typed is None else typed.tag.removeprefix(f"{{{SSC}}}")
            unit = self._definitions.unit(typed) if kind in FLOAT_TYPES else None
            sizes = [d.get("size") for d in entry.iterfind(tag(SSC, "Dimension"))]
            shape = tuple(None if s is None else int(s) for s in sizes)
            if entry.get("name") in found:
                raise place.error(f"two connectors are named `{entry.get('name')}`", "rename one of them")
            found[entry.get("name")] = Connector(entry.get("name"), entry.get("kind"), kind, unit, shape, place)
        return found

    def _connection(self, element: Any) -> Connection:
        ends = []
        for side in ("start", "end"):
            indices = element.get(f"{side}Indices")
            numbers = None if indices is None else tuple(int(i) for i in indices.split())
            if numbers is not None and min(numbers, default=0) < 1:
                raise self.document.place(element).error(
                    f"{side}Indices is `{indices}`", "indices count from 1 (docs/ssp.md)"
                )
            ends.append(End(element.get(f"{side}Element") or None, element.get(f"{side}Connector"), numbers))
        return Connection(
            ends[0],
            ends[1],
            is_true(element, "suppressUnitConversion"),
            transformation(self.document, element),
            self.document.place(element),
        )

    def _bindings(self, element: Any) -> tuple[Binding, ...]:
        listed = element.iterfind(f"{tag(SSD, 'ParameterBindings')}/{tag(SSD, 'ParameterBinding')}")
        return tuple(self._binding(b) for b in listed)

    def _binding(self, element: Any) -> Binding:
        place = self.document.place(element)
        self._expect_type(element, SSV_TYPE)
        document, top = self._referred(element, element.find(tag(SSD, "ParameterValues")))
        parameters: ParameterSet = read_parameter_set(document, top)
        mapping: tuple[MappingEntry, ...] | None = None
        given = element.find(tag(SSD, "ParameterMapping"))
        if given is not None:
            self._expect_type(given, SSM_TYPE)
            document, top = self._referred(given, given)
            mapping = read_mapping(document, top)
        return Binding(parameters, mapping, element.get("prefix", ""), place)

    def _expect_type(self, element: Any, expected: str) -> None:
        if element.get("type", expected) != expected:
            raise self.document.place(element).error(
                f"the type `{element.get('type')}` is not read", f"give it as {expected}"
            )

    def _referred(self, element: Any, container: Any) -> tuple[Document, Any]:
        """What a binding or mapping applies: a file where it has a source, else its content."""
        uri = element.get("source")
        if uri is None:
            content = next((c for c in (() if container is None else container) if isinstance(c.tag, str)), None)
            if content is None:
                raise self.document.place(element).error("there is neither a source nor content", "give one of them")
            return self.document, content
        if element.get("sourceBase", "SSD") == "component":
            raise self.document.place(element).error(
                f"`{uri}` lies inside a component (sourceBase `component`), which is not read",
                "put the file into the package's `resources` and refer to it there",
            )
        file = self._resolved(element, uri)
        document = self._parsed(file)
        return document, document.root
