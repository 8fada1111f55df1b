"""Names of the SSP standard: XML namespaces, versions, media types; and ours.

Source: Modelica Association, System Structure and Parameterization 1.0.1 and 2.0 (https://ssp-standard.org).
"""

from __future__ import annotations

from typing import Literal

Version = Literal["1.0", "2.0"]

_BASE = "http://ssp-standard.org/SSP1/SystemStructure"
SSC, SSD, SSV, SSM, SSB = (
    f"{_BASE}{name}" for name in ("Common", "Description", "ParameterValues", "ParameterMapping", "SignalDictionary")
)
#: Prefix to namespace, as the standard nicknames them.
PREFIXES = {"ssc": SSC, "ssd": SSD, "ssv": SSV, "ssm": SSM, "ssb": SSB}

FMU_TYPE = "application/x-fmu-sharedlibrary"
SSD_TYPE = "application/x-ssp-definition"
SSP_TYPE = "application/x-ssp-package"
SSV_TYPE = "application/x-ssp-parameter-set"
SSB_TYPE = "application/x-ssp-signal-dictionary"
SSM_TYPE = "application/x-ssp-parameter-mapping"
#: A component of ours that is no FMU: its source is the YAML that a scenario holds for it.
OWN_TYPE = "application/vnd.active-chainmail.component+yaml"

#: Annotations of ours. The project owns no domain, so the type is its name, which no domain can equal.
OWN_ANNOTATION = "active-chainmail.cosim"
OWN = "urn:active-chainmail:cosim:1"

DEFAULT_SSD = "SystemStructure.ssd"

#: Types that SSP 1.0 knows; all others came with 2.0.
TYPES_OF_SSP1 = frozenset({"Real", "Integer", "Boolean", "String", "Enumeration", "Binary"})
FLOAT_TYPES = frozenset({"Real", "Float64", "Float32"})
INTEGER_TYPES = frozenset({"Integer", "Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64"})


def tag(namespace: str, name: str) -> str:
    """Qualified name as lxml writes it.

    >>> tag(SSC, "Real")
    '{http://ssp-standard.org/SSP1/SystemStructureCommon}Real'
    """
    return f"{{{namespace}}}{name}"
