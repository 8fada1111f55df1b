"""A model of ordinary differential equations as an FMU of FMI 3.0."""

from __future__ import annotations

import subprocess
import tempfile
import uuid
import zipfile
from pathlib import Path
from xml.sax.saxutils import quoteattr

from evaluation.fmus.model import OdeModel


def build(model: OdeModel, folder: Path, has_exchange: bool = True, has_co_simulation: bool = True) -> Path:
    """Compile the FMU; returns its path.

    Args:
        model: Its equations; those that have no unit are written without one.
        folder: Where it goes.
        has_exchange: Whether it offers Model Exchange.
        has_co_simulation: Whether it offers Co-Simulation.

    Raises:
        RuntimeError: gcc refuses.
    """
    token = str(uuid.uuid5(uuid.NAMESPACE_URL, repr(model) + "3"))
    shim = Path(__file__).with_name("fmi3.c").read_text(encoding="utf-8")
    generated = model.source(token)
    head = generated[: generated.index("/* A model of ordinary differential equations")]
    path = folder / f"{model.name}.fmu"
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as work:
        source, library = Path(work) / "model.c", Path(work) / "model.so"
        source.write_text(head + shim, encoding="utf-8")
        command = [
            "gcc",
            "-std=gnu11",
            "-O2",
            "-fPIC",
            "-shared",
            "-fvisibility=hidden",
            "-o",
            str(library),
            str(source),
            "-lm",
        ]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            raise RuntimeError(done.stderr)
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("modelDescription.xml", description(model, token, has_exchange, has_co_simulation))
            archive.writestr(f"binaries/x86_64-linux/{model.name}.so", library.read_bytes())
    return path


def description(model: OdeModel, token: str, has_exchange: bool, has_co_simulation: bool) -> str:
    """modelDescription.xml of FMI 3.0."""
    units = sorted(
        {u for _, u in model.parameters.values()}
        | set(model.inputs.values())
        | {s[0] for s in model.states.values()}
        | {o[0] for o in model.outputs.values()} - {""}
    )

    def unit(text: str) -> str:
        return f" unit={quoteattr(text)}" if text else ""

    lines = ['<Float64 name="time" valueReference="0" causality="independent" variability="continuous"/>']
    reference = 1

    def variable(name: str, causality: str, rest: str) -> None:
        nonlocal reference
        lines.append(f'<Float64 name={quoteattr(name)} valueReference="{reference}" causality="{causality}" {rest}/>')
        reference += 1

    for name, (value, text) in model.parameters.items():
        variable(name, "parameter", f'variability="fixed" initial="exact" start="{value!r}"{unit(text)}')
    for name, text in model.inputs.items():
        variable(name, "input", f'variability="continuous" start="0"{unit(text)}')
    first = reference
    for name, (text, _, _) in model.states.items():
        variable(name, "local", f'variability="continuous" initial="calculated"{unit(text)}')
    rates = reference
    for i, name in enumerate(model.states):
        variable(f"der({name})", "local", f'variability="continuous" initial="calculated" derivative="{first + i}"')
    outputs = reference
    for name, (text, _) in model.outputs.items():
        variable(name, "output", f'variability="continuous" initial="calculated"{unit(text)}')
    structure = "".join(f'<Output valueReference="{i}"/>' for i in range(outputs, reference))
    structure += "".join(f'<ContinuousStateDerivative valueReference="{i}"/>' for i in range(rates, outputs))
    structure += "".join(f'<InitialUnknown valueReference="{i}"/>' for i in range(first, reference))
    exchange = f'<ModelExchange modelIdentifier="{model.name}"/>' if has_exchange else ""
    exchange += (
        f'<CoSimulation modelIdentifier="{model.name}" canHandleVariableCommunicationStepSize="true"/>'
        if has_co_simulation
        else ""
    )
    described = "".join(f"<Unit name={quoteattr(u)}/>" for u in units if u)
    return (
        f'<?xml version="1.0" encoding="UTF-8"?><fmiModelDescription fmiVersion="3.0" modelName="{model.name}" '
        f'instantiationToken="{token}">{exchange}'
        + (f"<UnitDefinitions>{described}</UnitDefinitions>" if described else "")
        + f"<ModelVariables>{''.join(lines)}</ModelVariables><ModelStructure>{structure}</ModelStructure>"
        "</fmiModelDescription>"
    )
