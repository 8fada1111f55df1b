"""A model of ordinary differential equations, and the FMU that is made of it."""

from __future__ import annotations

import platform
import re
import subprocess
import tempfile
import uuid
import zipfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from xml.sax.saxutils import quoteattr


@dataclass(frozen=True)
class OdeModel:
    """States, inputs, parameters and outputs, with their equations in C.

    Args:
        name: Identifier in C.
        parameters: Name to (value, unit).
        inputs: Name to unit.
        states: Name to (unit, start in the names of parameters, rate in all names).
        outputs: Name to (unit, formula); those of states need none.
        inner_step: Longest step of the Co-Simulation interface [s].
    """

    name: str
    parameters: Mapping[str, tuple[float, str]]
    inputs: Mapping[str, str]
    states: Mapping[str, tuple[str, str, str]]
    outputs: Mapping[str, tuple[str, str]]
    inner_step: float = 1e-3

    def source(self, guid: str) -> str:
        """Everything in C."""
        p, u, x = list(self.parameters), list(self.inputs), list(self.states)
        names = "".join(f"    const double {n} = p_[{i}];\n" for i, n in enumerate(p))
        inputs = "".join(f"    const double {n} = u_[{i}];\n" for i, n in enumerate(u))
        states = "".join(f"    const double {n} = x_[{i}];\n" for i, n in enumerate(x))
        used = "".join(f"    (void){n};\n" for n in (*p, *u, *x))
        starts = "".join(f"    x_[{i}] = {s};\n" for i, (_, s, _) in enumerate(self.states.values()))
        rates = "".join(f"    d_[{i}] = {r};\n" for i, (_, _, r) in enumerate(self.states.values()))
        outs = "".join(f"    y_[{i}] = {f};\n" for i, (_, f) in enumerate(self.outputs.values()))
        values = ", ".join([*(repr(v) for v, _ in self.parameters.values()), *("0.0" for _ in u), "0.0"])
        head = (
            "(double t, const double *p_, const double *x_, const double *u_, double *@)\n"
            "{\n    (void)t; (void)p_; (void)x_; (void)u_;\n"
        )
        p_used = "".join(f"    (void){n};\n" for n in p)
        shim = Path(__file__).with_name("fmi2.c").read_text(encoding="utf-8")
        return (
            f"#include <math.h>\n#define NX {len(x)}\n#define NU {len(u)}\n#define NP {len(p)}\n"
            f'#define NY {len(self.outputs)}\n#define GUID "{guid}"\n#define INNER_STEP {self.inner_step!r}\n'
            f"static const double start_values[] = {{{values}}};\n"
            "static void start_states(const double *p_, double *x_)\n{\n    (void)p_; (void)x_;\n"
            f"{names}{p_used}{starts}}}\n"
            f"static void rates{head.replace('@', 'd_')}    (void)d_;\n{names}{inputs}{states}{used}{rates}}}\n"
            f"static void outputs{head.replace('@', 'y_')}    (void)y_;\n{names}{inputs}{states}{used}{outs}}}\n{shim}"
        )

    def description(self, guid: str) -> str:
        """modelDescription.xml."""
        units = sorted(
            {u for _, u in self.parameters.values()}
            | set(self.inputs.values())
            | {s[0] for s in self.states.values()}
            | {o[0] for o in self.outputs.values()} - {""}
        )
        lines, reference = [], 0

        def variable(name: str, causality: str, variability: str, real: str, initial: str = "") -> None:
            nonlocal reference
            first = f' initial="{initial}"' if initial else ""
            lines.append(
                f'<ScalarVariable name={quoteattr(name)} valueReference="{reference}" causality="{causality}" '
                f'variability="{variability}"{first}><Real {real}/></ScalarVariable>'
            )
            reference += 1

        def unit(text: str) -> str:
            return f"unit={quoteattr(text)}" if text else ""

        for name, (value, text) in self.parameters.items():
            variable(name, "parameter", "fixed", f'start="{value!r}" {unit(text)}', "exact")
        for name, text in self.inputs.items():
            variable(name, "input", "continuous", f'start="0" {unit(text)}')
        first = len(lines) + 1
        for name, (text, _, _) in self.states.items():
            variable(name, "local", "continuous", unit(text), "calculated")
        for i, name in enumerate(self.states):
            variable(f"der({name})", "local", "continuous", f'derivative="{first + i}"', "calculated")
        begin = len(lines) + 1
        for name, (text, _) in self.outputs.items():
            variable(name, "output", "continuous", unit(text), "calculated")
        known = {n: i + 1 for i, n in enumerate((*self.parameters, *self.inputs, *self.states))}

        def unknown(index: int, formula: str, depends: Iterable[str], always: Iterable[str] = ()) -> str:
            """An unknown with what it depends on: where none is given, importers take every input."""
            used = set(re.findall(r"[A-Za-z_]\w*", formula)) & set(depends) | set(always)
            return f'<Unknown index="{index}" dependencies="{" ".join(str(known[n]) for n in known if n in used)}"/>'

        formulas = [rate for _, _, rate in self.states.values()]
        running, later = (*self.inputs, *self.states), [*formulas, *(f for _, f in self.outputs.values())]
        outputs = "".join(unknown(begin + i, f, running) for i, (_, f) in enumerate(self.outputs.values()))
        derivatives = first + len(self.states)
        rates = "".join(unknown(derivatives + i, f, running) for i, f in enumerate(formulas))
        initial = "".join(unknown(first + i, s, self.parameters) for i, (_, s, _) in enumerate(self.states.values()))
        initial += "".join(unknown(derivatives + i, f, self.inputs, self.parameters) for i, f in enumerate(later))
        described = "".join(f"<Unit name={quoteattr(u)}/>" for u in units if u)
        flags = 'canGetAndSetFMUstate="true" canSerializeFMUstate="true"'
        return (
            f'<?xml version="1.0" encoding="UTF-8"?><fmiModelDescription fmiVersion="2.0" modelName="{self.name}" '
            f'guid="{guid}" numberOfEventIndicators="0"><ModelExchange modelIdentifier="{self.name}" {flags}/>'
            f'<CoSimulation modelIdentifier="{self.name}" canHandleVariableCommunicationStepSize="true" {flags}/>'
            + (f"<UnitDefinitions>{described}</UnitDefinitions>" if described else "")
            + f"<ModelVariables>{''.join(lines)}</ModelVariables><ModelStructure><Outputs>{outputs}</Outputs>"
            f"<Derivatives>{rates}</Derivatives><InitialUnknowns>{initial}</InitialUnknowns></ModelStructure></fmiModelDescription>"
        )

    def build(self, folder: Path) -> Path:
        """Compile the FMU; returns its path.

        Raises:
            RuntimeError: gcc refuses.
        """
        guid = str(uuid.uuid5(uuid.NAMESPACE_URL, repr(self)))
        path = folder / f"{self.name}.fmu"
        bits = {"Linux": "linux64", "Darwin": "darwin64"}.get(platform.system(), "win64")
        with tempfile.TemporaryDirectory() as work:
            source, library = Path(work) / "model.c", Path(work) / "model.so"
            source.write_text(self.source(guid), encoding="utf-8")
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
            folder.mkdir(parents=True, exist_ok=True)
            suffix = {"linux64": ".so", "darwin64": ".dylib"}.get(bits, ".dll")
            with zipfile.ZipFile(path, "w") as archive:
                archive.writestr("modelDescription.xml", self.description(guid))
                archive.writestr(f"binaries/{bits}/{self.name}{suffix}", library.read_bytes())
        return path
