"""What `cosim play` is given, by what lies in each folder: runs, recordings, diagnoses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from chainmail.play.film import Fabric, Film, Finding
from chainmail.play.from_diagnosis import FILE, findings_of
from chainmail.play.from_results import fabric_of
from chainmail.play.run_results import is_run, run_results
from cosim.unit.errors import InputError
from diagnosis.recording.recording import load_recording
from diagnosis.report.recorded_marks import marks_of


def film_of(folders: Sequence[Path], frames: int) -> Film:
    """The film of runs, recordings and diagnoses, told apart by their files.

    Args:
        folders: At least one run.
        frames: At most this many frames of each run.

    Raises:
        InputError: A folder does not exist, holds none of the three or cannot be read, or none holds a run.
    """
    kinds = [(_kind(folder), folder) for folder in folders]
    runs = [folder for kind, folder in kinds if kind == "run"]
    if not runs:
        raise InputError(
            folders[0],
            "",
            "there is no run among what was given, so there is no fabric to show",
            "give the folder of a run first, then recordings and diagnoses",
        )
    fabrics = _distinct([fabric_of(run_results(run), run, frames) for run in runs], runs)
    first = fabrics[0]
    marks = tuple(marks_of(load_recording(folder), first) for kind, folder in kinds if kind == "recording")
    findings: list[Finding] = []
    notes = _comparison(fabrics)
    for folder in (folder for kind, folder in kinds if kind == "diagnosis"):
        found, told = findings_of(folder, first)
        findings += found
        notes += told
    return Film(tuple(fabrics), marks, tuple(findings), tuple(notes))


def _kind(folder: Path) -> str:
    if not folder.exists():
        raise InputError(folder, "", "there is no such folder", "give the folder of a run, a recording or a diagnosis")
    if folder.is_file():
        raise InputError(folder, "", "this is a file", f"give its folder: {folder.parent}")
    if is_run(folder):
        return "run"
    if (folder / "recording.yaml").is_file():
        return "recording"
    if (folder / FILE).is_file():
        return "diagnosis"
    raise InputError(
        folder,
        "",
        f"it holds no run (results.nc), no recording (recording.yaml) and no diagnosis ({FILE})",
        "give the folder that `cosim run`, `cosim record` or `cosim diagnose` wrote",
    )


def _distinct(fabrics: list[Fabric], runs: Sequence[Path]) -> list[Fabric]:
    """Fabrics with titles that tell them apart: the folder stands behind a title that several have."""
    titles = [f.title for f in fabrics]
    return [
        replace(f, title=f"{f.title} ({run.resolve().name})" if titles.count(f.title) > 1 else f.title)
        for f, run in zip(fabrics, runs)
    ]


def _comparison(fabrics: Sequence[Fabric]) -> list[str]:
    """What differs between the fabrics of several runs."""
    first = fabrics[0]
    notes = []
    for other in fabrics[1:]:
        if other.links != first.links or other.size != first.size:
            notes.append(f"the fabrics differ: {first.title} has {first.size}, {other.title} has {other.size}")
        elif other.shape != first.shape:
            notes.append(f"the links of {first.title} and {other.title} differ in size")
        if other.times[0] > first.times[-1] or other.times[-1] < first.times[0]:
            notes.append(f"{other.title} has no time in common with {first.title}: they are never shown together")
    return notes
