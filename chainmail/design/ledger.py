"""Runs of a design at their fidelities, each on the record."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from chainmail.design.candidate import Candidate, Rig, scenario_for
from chainmail.design.task import Task
from cosim.compute.batch import Batches
from cosim.compute.package import Packer
from cosim.compute.result import Task as Job
from cosim.sweep.file import Output
from cosim.sweep.one_run import Shared, simulate
from cosim.sweep.travel import packed_text, run_key
from cosim.unit.quantity import PhysicalValue

#: Coarse settings of Bullet. Fewer iterations and not longer steps: at 1 ms the links of 2 x 8 rows with 20 g
#: overlapped by 3.4 and 4.4 mm in the first two runs. They stop at no overlap; `GATE` judges it.
COARSE = {"micro_step": PhysicalValue(0.5, "ms"), "iterations": 30, "penetration_limit": PhysicalValue(8.0, "mm")}
#: A coarse run in which links overlap by more is worth nothing, and is made again with fine settings [m].
GATE = 1.5e-3
#: Quantities of a fabric that coarse settings keep. Curvature is decided by single links, which they let slip.
KEPT_COARSE = ("tip_sag", "fabric_length", "row_centre", "position")
OVERLAP, SPENT = "overlap", "energy"


class BudgetSpent(Exception):
    """No run of a fidelity is left."""


@dataclass(frozen=True)
class Entry:
    """One run.

    Args:
        fidelity: `coarse`, `fine` (a coarse run that overlapped, made again) or `full` (a fresh start).
        candidate: What was run.
        start: Number of the start.
        values: Of every requirement, in the unit of its quantity; empty where the run failed.
        distances: How far each is on the right side of its bound; the same.
        overlap: Largest overlap of two links from the first switch on [m].
        energy: Electrical energy [J].
        failure: Why it stopped; empty where it did not.
        seconds: Wall time.
    """

    fidelity: str
    candidate: Candidate
    start: int
    values: tuple[float, ...]
    distances: tuple[float, ...]
    overlap: float
    energy: float
    failure: str
    seconds: float

    @property
    def is_met(self) -> bool:
        """Whether every requirement holds; a run that failed meets none."""
        return not self.failure and all(d >= 0.0 for d in self.distances)


@dataclass
class Ledger:
    """Makes runs and keeps the record.

    Args:
        task: What is wanted.
        rig: Scenario of the task.
        batches: Makes the runs.
    """

    task: Task
    rig: Rig
    batches: Batches
    entries: list[Entry] = field(default_factory=list)
    units: tuple[str, ...] = ()

    def can_be_coarse(self) -> bool:
        """Whether coarse runs may judge everything that is wanted."""
        fabric = f"{self.rig.fabric}."
        asked = [w.quantity.removeprefix(fabric) for w in self.task.wanted if w.quantity.startswith(fabric)]
        return all(name in KEPT_COARSE for name in asked)

    def count(self, fidelity: str) -> int:
        """Runs of a fidelity; a coarse run that was made again counts as both."""
        return sum(e.fidelity == fidelity for e in self.entries)

    def coarse(self, candidate: Candidate, starts: Sequence[int]) -> list[Entry]:
        """Coarse runs of a design; one in which links overlap is made again with fine settings, which count.

        Raises:
            BudgetSpent: No coarse or full run is left.
        """
        if not self.can_be_coarse():
            return self.full_batch(candidate, starts, "fine")
        if self.count("coarse") + len(starts) > self.task.runs.coarse:
            raise BudgetSpent(f"all {self.task.runs.coarse} coarse runs are spent")
        made = self._made([candidate] * len(starts), starts, "coarse", COARSE)
        again = [e.start for e in made if e.failure or e.overlap > GATE]
        fine = {e.start: e for e in (self.full_batch(candidate, again, "fine") if again else [])}
        return [fine.get(e.start, e) for e in made]

    def full_batch(self, candidate: Candidate, starts: Sequence[int], fidelity: str = "full") -> list[Entry]:
        """Runs with the scenario's own settings; raises BudgetSpent where too few are left."""
        if self.count("full") + self.count("fine") + len(starts) > self.task.runs.full:
            raise BudgetSpent(f"all {self.task.runs.full} full runs are spent")
        return self._made([candidate] * len(starts), starts, fidelity, None)

    def _made(
        self, candidates: Sequence[Candidate], starts: Sequence[int], fidelity: str, solver: Mapping[str, object] | None
    ) -> list[Entry]:
        outputs = {f"wanted{i}": w.output() for i, w in enumerate(self.task.wanted)}
        # From the first switch on: while it falls into its drape, every coarse fabric overlaps for a moment.
        since = str(PhysicalValue(min(c.begin for c in candidates), "s"))
        outputs[OVERLAP] = Output.model_validate(
            {"quantity": f"{self.rig.fabric}.max_penetration", "over": "max", "from": since}
        )
        outputs[SPENT] = Output(quantity="energy")
        packer = Packer()
        texts = [packed_text(scenario_for(c, self.rig, solver, s), packer) for c, s in zip(candidates, starts)]
        shared = Shared(packer.files(), outputs, {})
        results = self.batches.results(simulate, shared, [Job(run_key(shared, t), t) for t in texts])
        made = []
        for candidate, start, result in zip(candidates, starts, results):
            numbers = result.arrays[0] if result.is_complete else ()
            wanted = tuple(float(v) for v in numbers[: len(self.task.wanted)])
            if result.is_complete:
                self.units = result.text[: len(self.task.wanted)]
            distances = tuple(w.distance(v, u) for w, v, u in zip(self.task.wanted, wanted, self.units))
            overlap, energy = (float(v) for v in numbers[-2:]) if result.is_complete else (float("nan"),) * 2
            made.append(
                Entry(fidelity, candidate, start, wanted, distances, overlap, energy, result.failure, result.seconds)
            )
        self.entries += made
        return made

    def table(self) -> str:
        """Every run, as CSV."""
        buffer = io.StringIO()
        writer = csv.writer(buffer)
        wanted = [f"{w.quantity} [{u}]" for w, u in zip(self.task.wanted, self.units or [""] * len(self.task.wanted))]
        head = ["energy [J]", "overlap [mm]", "met", "wall time [s]", "failure"]
        writer.writerow(["run", "fidelity", "design", "start", *wanted, *head])
        for number, e in enumerate(self.entries, start=1):
            values = [f"{v:.6g}" for v in e.values] or [""] * len(wanted)
            writer.writerow(
                [
                    number,
                    e.fidelity,
                    e.candidate.text(),
                    e.start,
                    *values,
                    f"{e.energy:.6g}",
                    f"{1e3 * e.overlap:.3g}",
                    "yes" if e.is_met else "no",
                    f"{e.seconds:.3g}",
                    " ".join(e.failure.split()),
                ]
            )
        return buffer.getvalue()
