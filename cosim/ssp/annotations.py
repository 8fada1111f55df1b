"""Annotations: our own settings, and the step sizes that other tools write."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

from lxml import etree

from cosim.ssp.document import Document
from cosim.ssp.namespaces import OWN, OWN_ANNOTATION, SSC, SSD, tag

#: Element and attribute in which a tool writes its fixed step [s].
_STEPS = (("FixedStepAlgorithm", "baseStepSize"), ("FixedStepMaster", "stepSize"))


def own_settings(document: Document, element: Any) -> Mapping[str, Any]:
    """Settings in the annotation of ours on an element; empty where there is none.

    Raises:
        InputError: The annotation is not as we write it.
    """
    if element is None:
        return {}
    for annotation in element.iterfind(f"{tag(SSD, 'Annotations')}/{tag(SSC, 'Annotation')}"):
        content = annotation.find(tag(OWN, "Settings"))
        if annotation.get("type") != OWN_ANNOTATION or content is None:
            continue
        try:
            return {k: json.loads(v) for k, v in content.attrib.items()}
        except ValueError as error:
            raise document.place(content).error(f"a setting is no JSON value: {error}", "export it again") from error
    return {}


def own_annotations(settings: Mapping[str, Any]) -> Any:
    """`ssd:Annotations` that holds settings of ours, one JSON value per attribute."""
    annotations = etree.Element(tag(SSD, "Annotations"))
    annotation = etree.SubElement(annotations, tag(SSC, "Annotation"), type=OWN_ANNOTATION)
    content = etree.SubElement(annotation, tag(OWN, "Settings"), nsmap={"cosim": OWN})
    for key, value in settings.items():
        content.set(key, json.dumps(value, ensure_ascii=False))
    return annotations


def other_step(top: Any) -> float | None:
    """Fixed step [s] in an annotation of the Open Simulation Platform (ecos, libcosim) or OMSimulator; None else."""
    for element in top.iter():
        if not isinstance(element.tag, str):
            continue
        for name, attribute in _STEPS:
            if etree.QName(element).localname == name and element.get(attribute) is not None:
                return _positive(element.get(attribute))
    return None


def _positive(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) and value > 0 else None
