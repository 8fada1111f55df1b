"""docs/walk-fmu.md, command by command: every block is run as it is written, and says what stands below it."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from cosim.scenario import load_scenario

ROOT = Path(__file__).resolve().parents[1]
PAGE = (ROOT / "docs" / "walk-fmu.md").read_text(encoding="utf-8")
#: Language, file and text of every fenced block, in the order of the page.
BLOCKS = re.findall(r"^```(\w+)(?: (\S+))?\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)
#: Numbers may differ by so much where another compiler or processor rounds otherwise.
TOLERANCE = 0.02
_NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")


def _plain(text: str) -> str:
    """One line without the borders and breaks of a terminal."""
    return re.sub(r"\s+", " ", text)


def _is_said(line: str, output: str) -> bool:
    """Whether a line stands in an output, its numbers within the tolerance."""
    parts = _NUMBER.split(line)
    pattern = rf"({_NUMBER.pattern})".join(re.escape(part) for part in parts)
    numbers = [float(n) for n in _NUMBER.findall(line)]
    for match in re.finditer(pattern, output):
        found = [float(n) for n in match.groups()]
        if all(abs(a - b) <= TOLERANCE * abs(b) for a, b in zip(found, numbers, strict=True)):
            return True
    return False


def test_what_is_said_is_compared_with_its_numbers() -> None:
    assert _is_said("friction = 249.8 mm/s^2", "law: friction = 250.1 mm/s^2, deceleration")
    assert not _is_said("friction = 249.8 mm/s^2", "law: friction = 260.1 mm/s^2, deceleration")
    assert not _is_said("friction = 249.8 mm/s^2", "law: damping = 249.8 mm/s^2")


def _environment(folder: Path) -> dict[str, str]:
    """A shell in which `cosim` and `python` are those of this test."""
    programs = folder / "programs"
    programs.mkdir()
    for name, arguments in (("cosim", "-m cosim.cli "), ("python", "")):
        program = programs / name
        program.write_text(f'#!/bin/sh\nexec "{sys.executable}" {arguments}"$@"\n')
        program.chmod(0o755)
    path = f"{programs}{os.pathsep}{os.environ['PATH']}"
    return {**os.environ, "PATH": path, "PYTHONPATH": str(ROOT), "COLUMNS": "200", "TERM": "dumb"}


@pytest.mark.slow
def test_the_walk_runs_as_it_is_written(tmp_path: Path) -> None:
    environment, output = _environment(tmp_path), ""
    work = tmp_path / "work"
    work.mkdir()
    for language, file, text in BLOCKS:
        if language == "yaml":
            target = work / file
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text, encoding="utf-8")
        elif language == "sh":
            done = subprocess.run(
                ["bash", "-e", "-c", text], cwd=work, env=environment, capture_output=True, text=True, check=False
            )
            output = _plain(done.stdout + done.stderr)
            assert done.returncode == 0, f"{text}\n{output}"
        else:
            for line in text.splitlines():
                assert _is_said(_plain(line), output), f"{line}\n{output}"
    found = load_scenario(str(work / "answer" / "amended" / "scenario.yaml")).components["slide"]
    (term,) = found.added_terms  # type: ignore[union-attr]
    assert term.parameters["friction"].to("m/s^2") == pytest.approx(0.25, rel=0.01)  # what the tables conceal
    assert (work / "answer" / "report.html").is_file()
    assert (work / "amended.ssp").is_file()
