"""FMPy's container: array to array, at the start size and with a structural parameter that changes it."""

from __future__ import annotations

from pathlib import Path

from fmpy import extract, read_model_description
from fmpy.container_fmu.cli import create_container_fmu
from fmpy.container_fmu.config import Component, Configuration, Connection
from fmpy.fmi3 import FMU3Slave
from fmpy.model_description import CoSimulation, ModelDescription, ModelVariable

from benchmarks.peers.probes.finding import fmu, report


def probe(work: Path) -> str:
    """Offset 1 in both; y of the second is (2, 4). Its first element is asked for as a scalar, then as an array."""
    description = read_model_description(fmu("vector_gain_fmi3"))
    parts = [Component(name, fmu("vector_gain_fmi3"), description) for name in ("first", "second")]
    inner = {v.name: v for v in description.modelVariables}
    time = ModelVariable(type="Float64", variability="continuous", causality="independent", name="time")
    y = ModelVariable(
        type="Float64", initial="calculated", variability="continuous", causality="output", name="y", shape=(2,)
    )
    offsets = [
        ModelVariable(type="Float64", variability="fixed", causality="parameter", name=f"offset{i}", start="1")
        for i in range(2)
    ]
    mappings = {y: [(parts[1], inner["y"])], **{offsets[i]: [(parts[i], inner["offset"])] for i in range(2)}}
    outer = ModelDescription(
        fmiVersion="3.0",
        modelName="c",
        instantiationToken="",
        coSimulation=CoSimulation(fixedInternalStepSize=0.1),
        modelVariables=[time, *mappings],
    )
    (work / "unzipped").mkdir()
    create_container_fmu(
        Configuration(False, outer, parts, [Connection(parts[0], [inner["y"]], parts[1], [inner["u"]])], mappings),
        work / "unzipped",
        work / "c.fmu",
    )
    outside = read_model_description(work / "c.fmu", validate=False)
    container = FMU3Slave(
        guid="",
        unzipDirectory=extract(work / "c.fmu", work / "x"),
        instanceName="c",
        modelIdentifier=outside.coSimulation.modelIdentifier,
    )
    container.instantiate()
    container.enterInitializationMode()
    container.exitInitializationMode()
    container.doStep(0.0, 0.5)
    reference = next(v.valueReference for v in outside.modelVariables if v.name == "y")
    return f"y of the second array reads as {container.getFloat64([reference], 2)!r}; expected (2, 4)"


if __name__ == "__main__":
    report(probe)
