"""The quarter truck as an SSP package, version 1.0 or 2.0, with a parameter set; standard library only."""

from __future__ import annotations

import tomllib
import zipfile
from pathlib import Path

from benchmarks.models.systems import QUARTER_TRUCK

SPACES = " ".join(
    f'xmlns:{short}="http://ssp-standard.org/SSP1/SystemStructure{name}"'
    for short, name in (("ssc", "Common"), ("ssd", "Description"), ("ssv", "ParameterValues"))
)


def structure(version: str) -> str:
    """SystemStructure.ssd; SSP 2.0 keeps the name spaces of SSP 1.0 and raises the version attribute."""
    number = "Float64" if version == "2.0" else "Real"
    components = []
    for name, model in QUARTER_TRUCK.components.items():
        toml = tomllib.loads((Path(__file__).parents[2] / "models" / model / "model.toml").read_text())
        connectors = "".join(
            f'<ssd:Connector name="{v}" kind="{row["causality"]}"><ssc:{number}/></ssd:Connector>'
            for v, row in toml["variables"].items()
            if row["causality"] in {"input", "output", "parameter"}
        )
        bindings = ""
        if name == "chassis":
            values = (
                f'<ssv:ParameterSet version="{version}" name="mass"><ssv:Parameters><ssv:Parameter name="mass">'
                f'<ssv:{number} value="200"/></ssv:Parameter></ssv:Parameters></ssv:ParameterSet>'
            )
            bindings = (
                "<ssd:ParameterBindings><ssd:ParameterBinding><ssd:ParameterValues>"
                + values
                + "</ssd:ParameterValues></ssd:ParameterBinding></ssd:ParameterBindings>"
            )
        components.append(
            f'<ssd:Component name="{name}" source="resources/{name}.fmu"><ssd:Connectors>{connectors}</ssd:Connectors>'
            f"{bindings}</ssd:Component>"
        )
    wires = "".join(
        f'<ssd:Connection startElement="{c.source}" startConnector="{c.output}" endElement="{c.target}" '
        f'endConnector="{c.input}"/>'
        for c in QUARTER_TRUCK.connections
    )
    return (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<ssd:SystemStructureDescription {SPACES} name="QuarterTruck" '
        f'version="{version}"><ssd:System name="Root"><ssd:Elements>{"".join(components)}</ssd:Elements>'
        f"<ssd:Connections>{wires}</ssd:Connections></ssd:System>"
        f'<ssd:DefaultExperiment startTime="0" stopTime="2"/></ssd:SystemStructureDescription>\n'
    )


def write(folder: Path, version: str) -> tuple[Path, Path]:
    """Unpacked folder and .ssp file. The chassis mass is 200 kg in it, so that a lost parameter set shows."""
    unpacked = folder / f"ssp_{version}"
    (unpacked / "resources").mkdir(parents=True)
    (unpacked / "SystemStructure.ssd").write_text(structure(version))
    for name in QUARTER_TRUCK.components:
        (unpacked / "resources" / f"{name}.fmu").write_bytes(QUARTER_TRUCK.fmu(name, 2).read_bytes())
    package = folder / f"quarter_truck_{version}.ssp"
    with zipfile.ZipFile(package, "w") as archive:
        for file in unpacked.rglob("*"):
            if file.is_file():
                archive.write(file, file.relative_to(unpacked))
    return unpacked, package
