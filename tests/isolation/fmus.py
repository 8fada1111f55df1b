"""Builds the FMUs of these tests with gcc."""

from __future__ import annotations

import subprocess
import zipfile
from functools import cache
from pathlib import Path

import fmpy

MODELS = Path(__file__).resolve().parent / "models"
_DESCRIPTION = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="faulty" guid="faulty">
  <CoSimulation modelIdentifier="faulty" canHandleVariableCommunicationStepSize="true" canGetAndSetFMUstate="true"
    canSerializeFMUstate="true" canBeInstantiatedOnlyOncePerProcess="{once}"/>
  <ModelVariables>
    <ScalarVariable name="u" valueReference="0" causality="input" variability="continuous"><Real start="1.0"/>
    </ScalarVariable>
    <ScalarVariable name="y" valueReference="1" causality="output" variability="continuous" initial="exact">
      <Real start="0.0"/></ScalarVariable>
    <ScalarVariable name="steps" valueReference="2" causality="output" variability="discrete" initial="exact">
      <Integer start="0"/></ScalarVariable>
    <ScalarVariable name="calls_in_process" valueReference="3" causality="output" variability="discrete"
      initial="exact"><Integer start="0"/></ScalarVariable>
  </ModelVariables>
  <ModelStructure><Outputs><Unknown index="2" dependencies=""/><Unknown index="3" dependencies=""/>
    <Unknown index="4" dependencies=""/></Outputs></ModelStructure>
</fmiModelDescription>
"""


class Builder:
    """`builder(deed, place)` compiles an FMU, once per combination, and returns its path.

    Args:
        folder: Where the FMUs are put.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.build = cache(self._build)

    def __call__(self, deed: str = "nothing", place: str = "nowhere", gain: float | None = None, once: bool = False):
        """FMU that does `deed` at `place` (see faulty.c)."""
        return self.build(deed, place, gain, once)

    def _build(self, deed: str, place: str, gain: float | None, once: bool) -> Path:
        name = f"{deed}_{place}" + (f"_{gain:g}" if gain is not None else "") + ("_once" if once else "")
        binaries = self.folder / name / "binaries" / fmpy.platform
        binaries.mkdir(parents=True)
        headers = Path(fmpy.__file__).parent / "c-code"
        command = [
            "gcc",
            "-std=gnu99",
            "-O1",
            "-Wall",
            "-Wextra",
            "-Wno-unused-function",
            "-fPIC",
            "-shared",
            "-isystem",
            headers,
        ]
        options = [f"-DDEED={deed}", f"-DPLACE={place}"] + (["-DONCE"] if once else [])
        libraries = []
        if gain is not None:
            library = binaries / "libgain.so"
            _run([*command, f"-DGAIN={gain}", "-Wl,-soname,libgain.so", "-o", library, MODELS / "gain.c"])
            options.append("-DWITH_GAIN")
            libraries = [f"-L{binaries}", "-lgain", "-Wl,-rpath,$ORIGIN"]
        _run([*command, *options, "-o", binaries / "faulty.so", MODELS / "faulty.c", *libraries, "-lm"])
        (self.folder / name / "modelDescription.xml").write_text(_DESCRIPTION.format(once=str(once).lower()))
        path = self.folder / f"{name}.fmu"
        with zipfile.ZipFile(path, "w") as archive:
            for file in sorted((self.folder / name).rglob("*")):
                archive.write(file, file.relative_to(self.folder / name))
        return path


def _run(command: list[str | Path]) -> None:
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "warning" not in done.stderr, done.stderr
