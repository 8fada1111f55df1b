"""Folder of an ensemble: a run folder whose results have a dimension `start`, and the run of every start inside it.

starts/01, ...   one run folder for each start, from which it is resumed
ensemble.json    how many starts there are
results.nc       all starts that reached their end, with dimension `start` where they differ
series.csv       median and 5 to 95 % of the main series
summary.json     status, failures by start, medians and bands where the supply switches and at the end
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from cosim.assemble import Assembly
from cosim.run_folder import RunFolder, resolved_scenario, write_atomically, writing
from cosim.scenario import Scenario, load_scenario
from cosim.unit.errors import InputError


class EnsembleFolder:
    """Paths and files of an ensemble.

    Args:
        path: The folder.
        overwrites: Whether a new ensemble takes the place of the run or the ensemble that the folder holds.
    """

    def __init__(self, path: Path, overwrites: bool = False) -> None:
        self.path, self.run = path, RunFolder(path, overwrites=overwrites)
        self.file = self.run.ensemble

    def member(self, start: int) -> RunFolder:
        """Folder of one start, counted from 1."""
        return RunFolder(self.path / "starts" / f"{start:02d}")

    def exists(self) -> bool:
        """Whether an ensemble was begun here."""
        return self.file.is_file()

    def starts(self) -> int:
        """How many starts it has; raises InputError where its file is damaged."""
        try:
            return int(json.loads(self.file.read_text(encoding="utf-8"))["starts"])
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise InputError(
                self.file,
                "starts",
                "the number of starts cannot be read",
                'write {"starts": N} into it, with the N that it was begun with',
            ) from error

    def begin(self, assembly: Assembly, starts: int, resume: bool) -> Scenario:
        """Note what is run, and how many starts there are.

        Args:
            assembly: Of the scenario that was given.
            starts: How many.
            resume: Whether an ensemble that is here goes on; it may get more starts.

        Returns:
            The scenario as it is stored, which every start is made from.

        Raises:
            InputError: The folder holds another run, the ensemble of another scenario, or one of more starts.
        """
        if not resume:
            self.refuse_existing()
        elif not self.exists():
            raise InputError(
                self.path, "", "there is no ensemble to resume here", "leave out `--starts`, or `--resume`"
            )
        elif starts < self.starts():
            raise InputError(
                self.path,
                "",
                f"it holds an ensemble of {self.starts()} starts, {starts} are asked for",
                f"resume it with `--starts {self.starts()}` or more, or give another folder with `--out`",
            )
        else:
            self.run.refuse_other(assembly.scenario, assembly.parameters)
        with writing(self.path):
            self.path.mkdir(parents=True, exist_ok=True)
            if not resume:
                if self.run.overwrites:
                    self.run.remove_run()
                text = resolved_scenario(assembly.scenario, assembly.parameters).to_yaml(True)
                write_atomically(self.run.scenario, text.encode())
            write_atomically(self.file, json.dumps({"starts": starts}).encode())
        return load_scenario(self.run.scenario)

    def refuse_existing(self) -> None:
        """Raise InputError where the folder already holds a run or an ensemble."""
        self.run.refuse_existing()
        if not self.run.overwrites and (self.exists() or (self.path / "starts").exists()):
            raise InputError(
                self.path,
                "",
                "this folder already holds an ensemble",
                "go on from it with `--resume`, replace it with `--overwrite`, or give another folder with `--out`",
            )

    def write_summary(self, summary: Mapping[str, object]) -> None:
        """Write the summary; raises InputError where it cannot be written."""
        with writing(self.path):
            write_atomically(self.run.summary, json.dumps(summary, indent=2).encode())
