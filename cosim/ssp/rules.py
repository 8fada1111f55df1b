"""What the reader asks of an SSP 2.0 file: elements where they belong, attributes that are there and of their type.

The standard's schemas of version 2.0 are in no package that could be depended on. These rules cover what the reader
reads; what it passes over (annotations, meta data, signatures, geometry) is not looked into. `--schema` checks against
the standard's own files.

Source: Modelica Association, System Structure and Parameterization 2.0, sections on SSD, SSV, SSM, SSB.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from cosim.ssp.model import BASE_UNITS
from cosim.ssp.namespaces import FLOAT_TYPES, INTEGER_TYPES, SSB, SSC, SSD, SSM, SSV, tag

_NUMBER = r"[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?|[-+]?INF|NaN"
_TRUTH = "true|false|1|0"
#: Name of a kind of attribute to its text as a regular expression.
_KINDS = {
    "text": r"(?s:.*)",
    "number": _NUMBER,
    "whole": r"[-+]?\d{1,40}",
    "size": r"\+?\d{1,18}",
    "truth": _TRUTH,
    "numbers": rf"(({_NUMBER})(\s+|$))+",
    "wholes": r"([-+]?\d{1,40}(\s+|$))+",
    "truths": rf"(({_TRUTH})(\s+|$))+",
    "indices": r"(\d{1,18}(\s+|$))+",
    "bytes": "([0-9A-Fa-f]{2})*",
    "version": r"2\.\d+(\S*)",
    "kind": "input|output|inout|parameter|calculatedParameter|structuralParameter|constant|local|unspecified",
    "base": "SSD|component",
    "interface": "any|CoSimulation|ModelExchange|ScheduledExecution",
}

_PASSED_OVER = frozenset(
    {
        tag(SSD, name)
        for name in (
            "Annotations",
            "ElementGeometry",
            "SystemGeometry",
            "ConnectionGeometry",
            "ConnectorGeometry",
            "GraphicalElements",
        )
    }
    | {tag(n, "Annotations") for n in (SSC, SSV, SSM, SSB)}
    | {tag(SSC, "MetaData"), tag(SSC, "Signature")}
)


@dataclass(frozen=True)
class Rule:
    """One element.

    Args:
        needs: Attribute that must be there to its kind.
        may: Attribute that may be there to its kind.
        children: Tags of elements that may be in it; None: anything.
        holds: Tags of which one must be in it.
    """

    needs: Mapping[str, str] = field(default_factory=dict)
    may: Mapping[str, str] = field(default_factory=dict)
    children: frozenset[str] | None = frozenset()
    holds: frozenset[str] = frozenset()


def _tags(namespace: str, *names: str) -> frozenset[str]:
    return frozenset(tag(namespace, name) for name in names)


_NAME = {"name": "text"}
_BASE = {"id": "text", "description": "text"}
_TOP = _BASE | dict.fromkeys(
    ("author", "fileversion", "copyright", "license", "generationTool", "generationDateAndTime"), "text"
)
_SOURCE = {"type": "text", "source": "text", "sourceBase": "base"}
_TYPES = FLOAT_TYPES | INTEGER_TYPES | {"Boolean", "String", "Enumeration", "Binary"}
_TRANSFORMATIONS = _tags(
    SSC, *(f"{n}Transformation" for n in ("Linear", "BooleanMapping", "IntegerMapping", "EnumerationMapping"))
)
_ELEMENTS = _tags(SSD, "Component", "SignalDictionaryReference", "System")
_INSIDE = _tags(SSD, "Connectors", "ParameterBindings")
_CLOCK = {
    "intervalVariability": "text",
    "intervalDecimal": "number",
    "shiftDecimal": "number",
    "supportsFraction": "truth",
    "resolution": "size",
    "intervalCounter": "size",
    "shiftCounter": "size",
    "priority": "size",
}


def _list_of(*names: str, namespace: str = SSD) -> Rule:
    return Rule(children=_tags(namespace, *names), holds=_tags(namespace, *names))


_RULES: dict[str, Rule] = {
    tag(SSD, "SystemStructureDescription"): Rule(
        {"version": "version", **_NAME},
        _TOP,
        _tags(SSD, "System", "Enumerations", "Units", "DefaultExperiment"),
        _tags(SSD, "System"),
    ),
    tag(SSD, "System"): Rule(_NAME, _BASE, _INSIDE | _tags(SSD, "Elements", "Connections", "SignalDictionaries")),
    tag(SSD, "Component"): Rule(
        _NAME, _BASE | {"type": "text", "source": "text", "implementation": "interface"}, _INSIDE
    ),
    tag(SSD, "SignalDictionaryReference"): Rule({**_NAME, "dictionary": "text"}, _BASE, _INSIDE),
    tag(SSD, "Elements"): Rule(children=_ELEMENTS, holds=_ELEMENTS),
    tag(SSD, "Connections"): _list_of("Connection"),
    tag(SSD, "Connectors"): _list_of("Connector"),
    tag(SSD, "ParameterBindings"): _list_of("ParameterBinding"),
    tag(SSD, "SignalDictionaries"): _list_of("SignalDictionary"),
    tag(SSD, "SignalDictionary"): Rule(_NAME, _BASE | _SOURCE, None),
    tag(SSD, "Connection"): Rule(
        {"startConnector": "text", "endConnector": "text"},
        _BASE
        | {
            "startElement": "text",
            "endElement": "text",
            "startIndices": "indices",
            "endIndices": "indices",
            "suppressUnitConversion": "truth",
        },
        _TRANSFORMATIONS,
    ),
    tag(SSD, "Connector"): Rule(
        {**_NAME, "kind": "kind"}, _BASE, _tags(SSC, *_TYPES, "Clock", "Dimension") | _tags(SSD, "Clock")
    ),
    tag(SSD, "Clock"): Rule(_NAME),
    tag(SSD, "ParameterBinding"): Rule(
        {}, _BASE | _SOURCE | {"prefix": "text"}, _tags(SSD, "ParameterValues", "ParameterMapping")
    ),
    tag(SSD, "ParameterValues"): Rule(children=None),
    tag(SSD, "ParameterMapping"): Rule({}, _BASE | _SOURCE, None),
    tag(SSD, "DefaultExperiment"): Rule({}, {"startTime": "number", "stopTime": "number"}),
    **{tag(n, "Enumerations"): _list_of("Enumeration", namespace=SSC) for n in (SSD, SSV, SSB)},
    **{tag(n, "Units"): _list_of("Unit", namespace=SSC) for n in (SSD, SSV, SSB)},
    tag(SSC, "Unit"): Rule(_NAME, _BASE, _tags(SSC, "BaseUnit"), _tags(SSC, "BaseUnit")),
    tag(SSC, "BaseUnit"): Rule({}, dict.fromkeys(BASE_UNITS, "whole") | {"factor": "number", "offset": "number"}),
    tag(SSC, "Enumeration"): Rule(_NAME, _BASE, _tags(SSC, "Item")),
    tag(SSC, "Item"): Rule({**_NAME, "value": "whole"}),
    tag(SSC, "Dimension"): Rule({}, {"size": "size", "sizeConnector": "text"}),
    tag(SSC, "Clock"): Rule({}, _CLOCK),
    **{tag(SSC, name): Rule({}, {"unit": "text"}) for name in FLOAT_TYPES},
    **{tag(SSC, name): Rule() for name in INTEGER_TYPES | {"Boolean", "String"}},
    tag(SSC, "Binary"): Rule({}, {"mime-type": "text"}),
    tag(SSC, "LinearTransformation"): Rule({}, {"factor": "number", "offset": "number"}),
    **{
        tag(SSC, f"{name}MappingTransformation"): _list_of("MapEntry", namespace=SSC)
        for name in ("Boolean", "Integer", "Enumeration")
    },
    tag(SSV, "ParameterSet"): Rule(
        {"version": "version", **_NAME},
        _TOP,
        _tags(SSV, "Parameters", "Enumerations", "Units"),
        _tags(SSV, "Parameters"),
    ),
    tag(SSV, "Parameters"): Rule(children=_tags(SSV, "Parameter")),
    tag(SSV, "Parameter"): Rule(_NAME, _BASE, _tags(SSV, *_TYPES) | _tags(SSC, "Dimension"), _tags(SSV, *_TYPES)),
    **{tag(SSV, name): Rule({"value": "numbers"}, {"unit": "text"}) for name in FLOAT_TYPES},
    **{tag(SSV, name): Rule({"value": "wholes"}) for name in INTEGER_TYPES},
    tag(SSV, "Boolean"): Rule({"value": "truths"}),
    tag(SSV, "String"): Rule({}, {"value": "text"}, _tags(SSV, "Value")),
    tag(SSV, "Enumeration"): Rule({}, {"value": "text", "name": "text"}, _tags(SSV, "Value")),
    tag(SSV, "Binary"): Rule({}, {"value": "bytes", "mime-type": "text"}, _tags(SSV, "Value")),
    tag(SSV, "Value"): Rule({"value": "text"}),
    tag(SSM, "ParameterMapping"): Rule({"version": "version"}, _TOP, _tags(SSM, "MappingEntry")),
    tag(SSM, "MappingEntry"): Rule(
        {"source": "text", "target": "text"}, _BASE | {"suppressUnitConversion": "truth"}, _TRANSFORMATIONS
    ),
    tag(SSB, "SignalDictionary"): Rule(
        {"version": "version"}, _TOP, _tags(SSB, "DictionaryEntry", "Enumerations", "Units")
    ),
    tag(SSB, "DictionaryEntry"): Rule(_NAME, _BASE, _tags(SSC, *_TYPES, "Clock", "Dimension")),
}
#: Kind of both attributes of a MapEntry, by the table that it stands in.
_ENTRIES = {
    tag(SSC, f"{n}MappingTransformation"): k
    for n, k in {"Boolean": "truth", "Integer": "whole", "Enumeration": "text"}.items()
}


@dataclass(frozen=True)
class Fault:
    """What is wrong, and where.

    Args:
        element: The element (lxml).
        text: What is wrong with it.
    """

    element: Any
    text: str


def first_fault(top: Any) -> Fault | None:
    """The first element that breaks a rule, in the order of the file; None where all keep them."""
    waiting = [top]
    while waiting:
        element = waiting.pop()
        rule = _rule_of(element)
        if rule is None:
            return Fault(element, "there is no such element here")
        fault = _attributes(element, rule) or _children(element, rule)
        if fault is not None:
            return Fault(element, fault)
        if rule.children is not None:
            waiting += reversed([c for c in element if isinstance(c.tag, str) and c.tag not in _PASSED_OVER])
    return None


def _rule_of(element: Any) -> Rule | None:
    parent = element.getparent()
    if element.tag == tag(SSC, "MapEntry") and parent is not None and parent.tag in _ENTRIES:
        kind = _ENTRIES[parent.tag]
        return Rule({"source": kind, "target": kind})
    if element.tag == tag(SSC, "Enumeration") and parent is not None and parent.tag == tag(SSD, "Connector"):
        return Rule(_NAME)
    return _RULES.get(element.tag)


def _attributes(element: Any, rule: Rule) -> str | None:
    missing = next((name for name in rule.needs if element.get(name) is None), None)
    if missing is not None:
        return f"it has no attribute `{missing}`"
    for name, text in element.attrib.items():
        kind = rule.needs.get(name) or rule.may.get(name)
        if kind is None and not name.startswith("{"):
            return f"it has an attribute `{name}`, which does not belong there"
        if kind is not None and not re.fullmatch(_KINDS[kind], text.strip(), re.ASCII):
            return f"its attribute `{name}` is `{text[:40]}`, which is not a valid value"
    return None


def _children(element: Any, rule: Rule) -> str | None:
    if rule.children is None:
        return None
    found = [c.tag for c in element if isinstance(c.tag, str)]
    wrong = next((t for t in found if t not in rule.children and t not in _PASSED_OVER), None)
    if wrong is not None:
        return f"it holds {wrong}, which does not belong there"
    if rule.holds and not rule.holds & set(found):
        return f"it holds no {' or '.join(sorted(rule.holds)[:3])}"
    return None
