"""What every tool is asked to do, and what it answers; standard library only, for every tool's interpreter."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from benchmarks.models.systems import SYSTEMS, System


@dataclass(frozen=True)
class Job:
    """One measurement.

    Args:
        system: Name in `SYSTEMS`.
        version: FMI version, 2 or 3.
        steps: Number of macro-steps.
        step: Macro-step [s].
        csv: Whether every output is recorded at every step and written to disk.
        work: Folder for files of the tool.
    """

    system: str
    version: int
    steps: int
    step: float
    csv: bool
    work: str

    @property
    def wired(self) -> System:
        """The system, with the stop time of this job."""
        return replace(SYSTEMS[self.system], step=self.step, stop=self.stop)

    @property
    def stop(self) -> float:
        """End of the run [s]: the decimal number nearest to steps times step."""
        return round(self.steps * self.step, 9)

    @property
    def folder(self) -> Path:
        """Folder for files of the tool."""
        return Path(self.work)

    def text(self) -> str:
        """As one command-line argument."""
        return json.dumps(asdict(self))


@dataclass(frozen=True)
class Answer:
    """What a tool reports.

    Args:
        seconds: Wall time of the stepping loop alone [s].
        end_time: Simulated time that the tool says it reached [s].
        values: The system's outputs at the end.
        recorded: Bytes that it wrote as results.
    """

    seconds: float
    end_time: float
    values: list[float]
    recorded: int = 0


def answer(run: Callable[[Job], Answer]) -> None:
    """Run the job given on the command line and print the answer as the last line."""
    print(json.dumps(asdict(run(Job(**json.loads(sys.argv[1]))))), flush=True)


def written(folder: Path) -> int:
    """Bytes of all files in a folder."""
    return sum(file.stat().st_size for file in folder.rglob("*") if file.is_file())
