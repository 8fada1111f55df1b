"""A fitted point as files that `cosim run` runs: scenario, FMUs with their C sources, sensors."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from cosim.fmu_build.build_c import build_c
from cosim.scenario import Scenario
from diagnosis.amend.actuator_fmu import actuator_source
from diagnosis.amend.beside import take_along
from diagnosis.amend.changes import CannotAmend, Changes, FittedTerm, changes_of
from diagnosis.amend.fmu_source import Source
from diagnosis.amend.load_fmu import load_source
from diagnosis.amend.parts import Part, load_ports
from diagnosis.amend.scenario_file import Files, actuator_inputs, amended_data, needs_own_fmu, needs_own_load
from diagnosis.amend.sensors import sensor_entries
from diagnosis.amend.written import write_scenario
from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.search.problem import Point

#: FMI versions that are built; the scenario runs the first.
VERSIONS = (3,)


@dataclass(frozen=True)
class AmendedModel:
    """An amended scenario with what belongs to it.

    Args:
        folder: Where it is.
        scenario: The scenario, read back.
        changes: What was changed.
        original: The scenario that was diagnosed.
        files: Its FMUs.
    """

    folder: Path
    scenario: Scenario
    changes: Changes
    original: Scenario
    files: Files

    @property
    def path(self) -> Path:
        """The file that `cosim run` takes."""
        return self.folder / "scenario.yaml"

    @property
    def sensors(self) -> Sequence[FittedTerm]:
        """Terms of the measurement; they are no part of the model that runs."""
        return self.changes.of(Part.SENSOR)


def amend(
    scenario: Scenario, model: CoilNetworkModel, point: Point, folder: Path, versions: Sequence[int] = VERSIONS
) -> AmendedModel:
    """Write an amended scenario.

    Args:
        scenario: The scenario that was diagnosed, read from a file.
        model: Model of the recordings that were fitted.
        point: Its fitted values.
        folder: Where the files go; made if it is not there, files of the same names are replaced.
        versions: FMI versions to build; the scenario runs the first.

    Returns:
        The amended model; its scenario runs under the conditions of any recording of the scenario.

    Raises:
        CannotAmend: Something that was found has no place in a scenario; the text says what and why.
        InputError: An FMU cannot be compiled.
    """
    return write_amended(scenario, changes_of(scenario, model, point), folder, versions)


def write_amended(
    scenario: Scenario, changes: Changes, folder: Path, versions: Sequence[int] = VERSIONS
) -> AmendedModel:
    """Write an amended scenario from its changes; see `amend`."""
    files = Files(
        f"amended_actuator_fmi{versions[0]}.fmu" if needs_own_fmu(changes) else None,
        f"amended_load_fmi{versions[0]}.fmu" if needs_own_load(changes) else None,
    )
    layout, in_load = changes.translation.layout, _terms(changes, Part.LOAD)
    data = amended_data(scenario, changes, files)  # first: what cannot be said is refused before anything is built
    if files.actuator is not None:
        terms, ports = _terms(changes, Part.ACTUATOR), load_ports(in_load)
        source = actuator_source(terms, layout, ports, actuator_inputs(changes), changes.contacts)
        _build("actuator", source, folder, layout.coils, versions)
    if files.load is not None:
        _build("load", load_source(in_load, layout), folder, layout.coils, versions)
    return _write(scenario, changes, files, folder, data)


def amend_like(other: AmendedModel, changes: Changes, folder: Path) -> AmendedModel:
    """An amended scenario that runs the FMUs of another one, with other numbers and terms of it left out.

    Args:
        other: The amended scenario whose FMUs are taken.
        changes: What was changed, of the same scenario.
        folder: Where the files go.

    Raises:
        CannotAmend: The FMUs do not hold a term, or a scenario cannot say a parameter.
    """
    built = {t.term.identifier for t in other.changes.terms}
    for fitted in (*changes.of(Part.ACTUATOR), *changes.of(Part.LOAD)):
        if fitted.term.identifier not in built:
            raise CannotAmend(f"{fitted.term.identifier} is not in the FMUs that were built")
    lacks = (needs_own_fmu(changes) and other.files.actuator is None) or (
        needs_own_load(changes) and other.files.load is None
    )
    if lacks:
        return write_amended(other.original, changes, folder)
    up = Path(os.path.relpath(other.folder, folder))
    files = Files(*(None if f is None else str(up / f) for f in (other.files.actuator, other.files.load)))
    return _write(other.original, changes, files, folder, amended_data(other.original, changes, files))


def _write(scenario: Scenario, changes: Changes, files: Files, folder: Path, data: dict[str, Any]) -> AmendedModel:
    folder.mkdir(parents=True, exist_ok=True)
    take_along(scenario, data, folder)
    amended = write_scenario(data, _comment(scenario, changes), folder / "scenario.yaml")
    sensors = sensor_entries(changes)
    if sensors:
        text = yaml.safe_dump({"sensors": sensors}, sort_keys=False, allow_unicode=True, width=110)
        (folder / "sensors.yaml").write_text(_SENSOR_COMMENT + text, encoding="utf-8")
    return AmendedModel(folder, amended, changes, scenario, files)


_SENSOR_COMMENT = "# What was found of the sensors: no part of the model that runs, but of what they read of it.\n"


def _terms(changes: Changes, part: Part) -> list[CandidateTerm]:
    return [t.term for t in changes.of(part)]


def _build(part: str, source: Source, folder: Path, coils: int, versions: Sequence[int]) -> None:
    sources = folder / "sources" / part
    source.write(sources)
    for version in versions:
        build_c(sources, version, coils, folder / f"amended_{part}_fmi{version}.fmu")


def _comment(scenario: Scenario, changes: Changes) -> str:
    """What was found, above the scenario."""
    name = "" if scenario.path is None else f" of {scenario.path.name}"
    lines = [f"# Amended scenario{name}, written by `cosim diagnose` (docs/amended-models.md).", "#"]
    if changes.factors:
        lines.append(f"# Recalibrated: {', '.join(changes.factors)}.")
    moved = ", ".join(f"{name} by {amount:.4g} K" for name, amount in changes.offsets.items())
    if moved:
        lines.append(f"# Moved by what all recordings share: {moved}.")
    for fitted in changes.terms:
        lines.append(f"# {fitted.part.value}: {fitted.term.name}: {fitted.term.law}")
        for parameter in fitted.term.parameters:
            values = sorted({f"{v:.4g}" for v in fitted.values[parameter.name].tolist()}, key=float)
            lines.append(
                f"#   {parameter.name} [{parameter.unit}]: {' to '.join(values[:1] + values[-1:][len(values) == 1 :])}"
            )
        if not fitted.values[fitted.term.amplitude.name].any():
            lines.append("#   it belongs to one day alone: here its strength is 0")
    return "\n".join(lines) + "\n"
