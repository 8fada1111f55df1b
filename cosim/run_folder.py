"""The folder of one run: what was run, with what, and what came out.

scenario.yaml    the scenario as it was run, parameter sets inlined
parameters.csv   every parameter with unit and source
versions.json    versions of everything that computes
checkpoints/     state of every unit, and the values recorded since the checkpoint before
results.nc       all recorded values (NetCDF 4)
results.csv      all recorded values as text, where that was asked for
series.csv       the main series against time
summary.json     status, wall time of every unit, energy balance
"""

from __future__ import annotations

import csv
import errno
import importlib
import itertools
import json
import os
import platform
import subprocess
import tempfile
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cosim.terminal import as_argument
from cosim.unit.errors import InputError

if TYPE_CHECKING:  # `cosim --help` needs none of them
    import numpy as np

    from cosim.observers.trace import Trace
    from cosim.parameters import Resolved
    from cosim.scenario import Scenario

_PACKAGES = (
    "numpy",
    "scipy",
    "fmpy",
    "pybullet",
    "mujoco",
    "scikit-sundae",
    "PySpice",
    "xarray",
    "netCDF4",
    "pydantic",
    "pint",
)

_MAKE_ROOM = "free some room, then go on with `--resume`"


class RunFolder:
    """Paths and files of a run.

    Args:
        path: The folder.
        has_csv: Whether `write_results` writes everything as CSV too.
        overwrites: Whether a new run takes the place of one that the folder holds.
    """

    def __init__(self, path: Path, has_csv: bool = False, overwrites: bool = False) -> None:
        self.path, self.has_csv, self.overwrites = path, has_csv, overwrites

    @property
    def scenario(self) -> Path:
        """The scenario as it was run."""
        return self.path / "scenario.yaml"

    @property
    def results(self) -> Path:
        """All recorded values."""
        return self.path / "results.nc"

    @property
    def results_csv(self) -> Path:
        """All recorded values as text."""
        return self.path / "results.csv"

    @property
    def summary(self) -> Path:
        """Status, timings and energies."""
        return self.path / "summary.json"

    @property
    def ensemble(self) -> Path:
        """How many starts there are, where the folder holds an ensemble (`chainmail.ensemble`)."""
        return self.path / "ensemble.json"

    @staticmethod
    def prepare_writing() -> None:
        """Load what `write_results` needs: a run must not find out at its end that something is not installed."""
        for module in ("cosim.native.trace_csv", "cosim.results_file"):
            importlib.import_module(module)

    def refuse_existing(self) -> None:
        """Raise InputError where the folder already holds a run that must not be overwritten."""
        if not self.overwrites and self._holds_run():
            raise InputError(
                self.path,
                "",
                "this folder already holds a run",
                "go on from it with `--resume`, replace it with `--overwrite`, or give another folder with `--out`",
            )

    def _holds_run(self) -> bool:
        return bool(self.checkpoints()) or any(p.exists() for p in (self.scenario, self.results, self.summary))

    def remove_run(self) -> None:
        """Remove the files of a run or an ensemble and nothing else; what says how it ended goes first."""
        names = ("summary.json", "results.nc", "results.csv", "series.csv", "versions.json", "parameters.csv")
        figures = (self.path / "figures").glob("*") if self._holds_run() else ()
        for file in (*(self.path / name for name in names), *self.checkpoints(), *figures):
            if file.is_file():
                file.unlink()
        if self.ensemble.is_file():
            for start in (self.path / "starts").glob("*"):
                RunFolder(start).remove_run()
                remove_empty(start / "checkpoints", start / "figures", start)
            remove_empty(self.path / "starts")
            self.ensemble.unlink()
        if self.scenario.is_file():
            self.scenario.unlink()

    def create(self, scenario: Scenario, parameters: Mapping[str, Resolved], engines: Mapping[str, str]) -> None:
        """Make the folder of a new run.

        Args:
            scenario: What is run.
            parameters: Component to its parameters.
            engines: Versions of what the components compute with, beside those of `versions`.

        Raises:
            InputError: The folder already holds a run, or cannot be written.
        """
        self.refuse_existing()
        with writing(self.path):
            if self.overwrites:
                self.remove_run()
            (self.path / "checkpoints").mkdir(parents=True, exist_ok=True)
            write_atomically(self.scenario, resolved_scenario(scenario, parameters).to_yaml(True).encode())
            self._write_parameters(parameters)
            write_atomically(self.path / "versions.json", json.dumps(versions() | dict(engines), indent=2).encode())

    def _write_parameters(self, parameters: Mapping[str, Resolved]) -> None:
        with (self.path / "parameters.csv").open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(["component", "parameter", "value", "source"])
            for component, resolved in parameters.items():
                for name, value in resolved.values.items():
                    text = "; ".join(map(str, value)) if isinstance(value, list) else str(value)
                    writer.writerow([component, name, text, resolved.sources[name]])

    def refuse_other(self, scenario: Scenario, parameters: Mapping[str, Resolved]) -> None:
        """Raise InputError where the folder holds the run of another scenario, with the first line that differs."""
        from cosim.yaml_file import read_text

        stored = read_text(self.scenario).splitlines()
        asked = resolved_scenario(scenario, parameters).to_yaml(True).splitlines()
        for here, there in itertools.zip_longest(asked, stored, fillvalue="nothing"):
            if here != there:
                raise InputError(
                    self.path,
                    "",
                    f"it holds the run of another scenario: `{there.strip()}` there, `{here.strip()}` "
                    f"in {scenario.path}",
                    f"resume what it holds with `cosim run {as_argument(self.path)} --resume`, or give another "
                    "folder with `--out`",
                )

    def is_complete(self) -> bool:
        """Whether the run in this folder has reached its end."""
        try:
            return bool(json.loads(self.summary.read_text(encoding="utf-8"))["status"] == "complete")
        except (OSError, ValueError, KeyError, TypeError):
            return False

    def checkpoints(self) -> list[Path]:
        """Checkpoint files in order of time; files of other names are none."""
        found = [
            path for path in (self.path / "checkpoints").glob("*.npz") if path.stem.isascii() and path.stem.isdigit()
        ]
        return sorted(found, key=lambda path: int(path.stem))

    def write_checkpoint(self, index: int, content: Mapping[str, np.ndarray[Any, Any]]) -> None:
        """Write checkpoint `index` as a whole or not at all."""
        import numpy as np

        with writing(self.path):
            target = self.path / "checkpoints" / f"{index:06d}.npz"
            with replacing(target) as partial, partial.open("wb") as file:
                np.savez(file, **content)  # type: ignore[arg-type]
                file.flush()
                os.fsync(file.fileno())

    def write_csv(self, trace: Trace) -> None:
        """Write everything recorded so far as CSV; raises InputError where it cannot be written."""
        from cosim.native.trace_csv import write_trace  # late: `cosim --help` needs no SciPy

        with writing(self.path), replacing(self.results_csv) as partial:
            write_trace(partial, trace)

    def write_results(self, trace: Trace, attributes: Mapping[str, Any], summary: Mapping[str, Any]) -> None:
        """Write results, main series and, last, the summary that says how the run ended.

        Args:
            trace: What was recorded.
            attributes: Of the NetCDF file.
            summary: Status, timings and energies.

        Raises:
            InputError: One of the files cannot be written.
        """
        from cosim.native.trace_csv import write_series  # late, as above
        from cosim.results_file import write_results

        with writing(self.path):
            with replacing(self.results) as partial:
                write_results(partial, trace, attributes)
            with replacing(self.path / "series.csv") as partial:
                write_series(partial, trace)
            if self.has_csv or self.results_csv.exists():  # a resumed run leaves no half of a file behind
                self.write_csv(trace)
            write_atomically(self.summary, json.dumps(summary, indent=2).encode())


def missing(folder: Path) -> list[Path]:
    """Folders of a path that do not exist, the innermost first."""
    found = []
    while not folder.exists():
        found.append(folder)
        folder = folder.parent
    return found


def remove_empty(*folders: Path) -> None:
    """Remove folders that are empty, and leave the others."""
    for folder in folders:
        with suppress(OSError):
            folder.rmdir()


def read_checkpoint(file: Path) -> dict[str, np.ndarray[Any, Any]]:
    """Content of a checkpoint; raises InputError if it cannot be read."""
    import numpy as np

    try:
        with file.open("rb") as stream, np.load(stream) as content:
            return dict(content)
    except (OSError, ValueError, EOFError, zipfile.BadZipFile) as error:
        raise useless_checkpoint(file, f"cannot be read: {error}") from error


def useless_checkpoint(file: Path, why: str) -> InputError:
    """The error for a checkpoint from which no run can go on."""
    return InputError(
        file, "", f"this checkpoint {why}", "delete it and those after it, then resume from the one before"
    )


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Turn an operating-system error while writing into one that names the folder."""
    try:
        yield
    except OSError as error:
        full = error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
        remedy = _MAKE_ROOM if full else "give a folder that can be written, `--out`"
        why = error.strerror or str(error)
        if error.errno in (errno.EEXIST, errno.ENOTDIR):
            why = f"{path if path.is_file() else 'a part of its path'} is a file, not a folder"
        raise InputError(path, "", f"it cannot be written: {why}", remedy) from error
    except RuntimeError as error:  # netCDF4 reports a full disk as "NetCDF: HDF error"
        if "HDF" not in str(error) and "space" not in str(error):
            raise
        raise InputError(path, "", f"it cannot be written: {error} (is the disk full?)", _MAKE_ROOM) from error


def refuse_unwritable(folder: Path) -> None:
    """Refuse a folder that cannot be made or written, before work is done that would be lost.

    Args:
        folder: What a command will write; where it does not exist, none is left behind.

    Raises:
        InputError: It is a file, or the system refuses to write there.
    """
    if folder.exists() and not folder.is_dir():
        raise InputError(folder, "", "this is a file, not a folder", "give another folder with `--out`")
    made: list[Path] = []
    with writing(folder):
        made += missing(folder)
        try:
            folder.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=folder):
                pass
        finally:
            remove_empty(*made)


@contextmanager
def replacing(path: Path, is_shared: bool = False) -> Iterator[Path]:
    """A file to write in place of `path`, which it becomes as a whole; where writing fails it is removed.

    Args:
        path: What it becomes.
        is_shared: Whether no lock keeps a second program from writing it now (`cosim.alone`): each then has a partial
            file of its own, and the last to finish wins.
    """
    partial = path.with_name(f"{path.name}.{os.getpid()}.part" if is_shared else f"{path.name}.part")
    try:
        yield partial
        partial.replace(path)
    except BaseException:
        with suppress(OSError):
            partial.unlink()
        raise


def write_atomically(path: Path, data: bytes, is_shared: bool = False) -> None:
    """Write a file as a whole or not at all; `is_shared` as in `replacing`."""
    with replacing(path, is_shared) as partial:
        partial.write_bytes(data)


def resolved_scenario(scenario: Scenario, parameters: Mapping[str, Resolved]) -> Scenario:
    """The scenario with all parameter sets inlined, so that it stands alone."""
    components = {}
    for name, component in scenario.components.items():
        update: dict[str, Any] = {}
        if parameters[name].values:
            update = {"parameters": dict(parameters[name].values), "parameter_set": None}
        fmu = getattr(component, "fmu", None) or ""
        if fmu.endswith(".fmu") and scenario.path is not None:
            beside = scenario.path.parent / fmu
            update["fmu"] = str((beside if os.path.isfile(beside) else Path(fmu)).resolve())
        law = getattr(component, "law", None)
        if getattr(law, "kind", "") == "python" and scenario.path is not None:
            beside = (scenario.path.parent / law.file).resolve()  # type: ignore[union-attr]
            update["law"] = law.model_copy(update={"file": str(beside)})  # type: ignore[union-attr]
        components[name] = component.model_copy(update=update)
    return scenario.model_copy(update={"components": components})


def versions() -> dict[str, str]:
    """Versions of Python, the packages that compute, the machine and the commit where it is a checkout."""
    from importlib import metadata  # late: `--help` does without

    found = {"python": platform.python_version(), "platform": platform.platform()}
    for package in ("active-chainmail", *_PACKAGES):
        try:
            found[package] = metadata.version(package)
        except metadata.PackageNotFoundError:
            found[package] = "not installed"
    found["commit"] = _commit()
    return found


def _commit() -> str:
    """Commit of a clone; an installation may lie inside the repository of something else, so it has none."""
    root = Path(__file__).resolve().parent.parent
    if not (root / ".git").exists():
        return "unknown"
    command = ["git", "-C", str(root), "describe", "--always", "--dirty"]
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
