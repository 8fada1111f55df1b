"""Runs of a design at their fidelities, each on the record."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from chainmail.design.candidate import Candidate, Rig, Settings, scenario_for
from chainmail.design.task import Task
from cosim.components import FabricComponent
from cosim.compute.batch import Batches
from cosim.compute.package import Packer
from cosim.compute.result import Task as Job
from cosim.sweep.file import Output
from cosim.sweep.one_run import Shared, simulate
from cosim.sweep.travel import packed_text, run_key
from cosim.unit.quantity import PhysicalValue

#: Coarse settings: a fifth of the iterations and not longer steps, a third of the time. With friction anchors two
#: designs of 2 x 8 rows with 20 g read 3.3 mm less and 1.0 mm more sag than with 200 iterations, MuJoCo 14 mm more.
#: They stop at no overlap; `GATE` judges it.
COARSE = Settings(
    "bullet",
    {"micro_step": PhysicalValue(0.5, "ms"), "iterations": 40, "penetration_limit": PhysicalValue(8.0, "mm")},
)
#: A coarse run in which links overlap by more is worth nothing, and is made again with fine settings [m].
GATE = 1.5e-3
#: Quantities of a fabric that coarse settings keep, but for a difference that is measured (`Ledger.difference`).
#: Curvature is decided by single links, which they let slip.
KEPT_COARSE = ("tip_sag", "fabric_length", "row_centre", "position")
#: Designs that are run coarse and fine before a coarse run may decide.
LEAST_PAIRS = 2
OVERLAP, SPENT = "overlap", "energy"


class BudgetSpent(Exception):
    """No run of a fidelity is left."""


@dataclass(frozen=True)
class Entry:
    """One run.

    Args:
        fidelity: `coarse`, `short` (the scenario's own settings, until the fabric has been rigid), `fine` (the same, to
            the end, within the search) or `full` (the same, a fresh start).
        candidate: What was run.
        start: Number of the start.
        values: Of every requirement, in the unit of its quantity; empty where the run failed, no number (nan) where it
            ended before it could say.
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
        """Whether every requirement holds that the run says something about; a run that failed meets none."""
        return self.meets(None)

    def meets(self, counting: Sequence[int] | None) -> bool:
        """The same of some requirements, by their numbers; None: all."""
        return not self.failure and all(d >= 0.0 or math.isnan(d) for d in self.of(counting))

    def of(self, counting: Sequence[int] | None) -> tuple[float, ...]:
        """Distances of some requirements, by their numbers; None: all."""
        return self.distances if counting is None else tuple(self.distances[n] for n in counting)

    def worst(self, counting: Sequence[int] | None) -> float:
        """The least of them that the run knows; minus infinity where it failed."""
        return float(np.nanmin(self.of(counting))) if not self.failure else -math.inf


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
    _decided: dict[Candidate, Entry] = field(default_factory=dict)

    def __post_init__(self) -> None:
        fabric = self.rig.scenario.components[self.rig.fabric]
        assert isinstance(fabric, FabricComponent)
        self._is_mujoco = fabric.engine == "mujoco"

    def can_be_coarse(self) -> bool:
        """Whether coarse runs may judge everything that is wanted, and are another thing than the scenario's own."""
        fabric = f"{self.rig.fabric}."
        asked = [w.quantity.removeprefix(fabric) for w in self.task.wanted if w.quantity.startswith(fabric)]
        return self.task.runs.coarse > 0 and not self._is_mujoco and all(name in KEPT_COARSE for name in asked)

    @property
    def is_short_first(self) -> bool:
        """Whether runs are first made until the fabric has been rigid: that decides, and cooling is most of a cycle."""
        return self.task.cycle is not None

    def count(self, fidelity: str) -> int:
        """Runs of a fidelity."""
        return sum(e.fidelity == fidelity for e in self.entries)

    def judged(self, candidate: Candidate, start: int = 1, counting: Sequence[int] | None = None) -> Entry:
        """`decision`, kept; by some requirements, by their numbers, or all (None)."""
        if candidate not in self._decided:
            self._decided[candidate] = self._decision(candidate, start)
        kept = self._decided[candidate]
        if kept.fidelity == "short" and kept.meets(counting):
            kept = self._decided[candidate] = self._full([candidate], [start], "fine")[0]
        return kept

    def mean_distances(self, entry: Entry) -> tuple[float, ...]:
        """Of a design, over all starts with the scenario's own settings; of a coarse or short run its own."""
        own = [e.distances for e in self.entries if e.candidate == entry.candidate and e.fidelity == "fine"]
        complete = [d for d in own if d]
        if entry.fidelity != "fine" or not complete:
            return entry.distances
        return tuple(float(d) for d in np.mean(complete, axis=0))

    def left(self) -> int:
        """Runs of the scenario's own settings that are left, or short ones where these come first."""
        most = self.task.runs
        full = most.full - self.count("full") - self.count("fine")
        return most.coarse - self.count("short") if self.is_short_first else full

    def scaled(self, entry: Entry, counting: Sequence[int] | None = None) -> list[float]:
        """Distances of a run to the bounds as shares of them, where it says something."""
        found = []
        for number in range(len(self.task.wanted)) if counting is None else counting:
            bound = self.task.wanted[number].below or self.task.wanted[number].above
            assert bound is not None
            share = entry.distances[number] / (abs(bound.to(self.units[number])) or 1.0)
            found += [] if math.isnan(share) else [share]
        return found

    def shortly(self, candidate: Candidate, start: int = 1) -> Entry:
        """What a short run says, if there is no longer one; kept.

        Raises:
            BudgetSpent: No short run is left.
        """
        if candidate not in self._decided:
            self._decided[candidate] = self._decision(candidate, start)
        return self._decided[candidate]

    def _decision(self, candidate: Candidate, start: int) -> Entry:
        """The run that decides about a design within the search.

        A coarse run decides where, corrected by what coarse and fine runs differed by so far, it is farther from every
        bound than they scatter; else, and in the first two designs, a fine run of the same start.

        Raises:
            BudgetSpent: No coarse or full run is left.
        """
        if self.is_short_first:
            self._check(1, 0)
            return self._made([candidate], [start], ["short"])[0]
        if not self.can_be_coarse():
            return self._full([candidate], [start], "fine")[0]
        self._check(1, 0)
        if len(self.pairs()) < LEAST_PAIRS:
            self._check(1, 1)
            return self._made([candidate] * 2, [start] * 2, ["coarse", "fine"])[1]
        entry = self._made([candidate], [start], ["coarse"])[0]
        if (
            entry.failure
            or entry.overlap > GATE
            or any(abs(d - shift) <= scatter for d, (shift, scatter) in zip(entry.distances, self.difference()))
        ):
            return self._full([candidate], [start], "fine")[0]
        moved = tuple(d - shift for d, (shift, _) in zip(entry.distances, self.difference()))
        return replace(entry, distances=moved)

    def decided(self) -> dict[Candidate, Entry]:
        """Designs of the search and the run that decided about each."""
        return dict(self._decided)

    def pairs(self) -> list[tuple[Entry, Entry]]:
        """Coarse and fine runs of the same design and start, both complete and without overlap."""
        fine = {(e.candidate, e.start): e for e in self.entries if e.fidelity == "fine" and not e.failure}
        coarse = [e for e in self.entries if e.fidelity == "coarse" and not e.failure and e.overlap <= GATE]
        return [(c, fine[c.candidate, c.start]) for c in coarse if (c.candidate, c.start) in fine]

    def difference(self) -> list[tuple[float, float]]:
        """Per requirement: by how much coarse runs read too far on the right side, and how much that scatters."""
        found = []
        for number in range(len(self.task.wanted)):
            errors = np.array([c.distances[number] - f.distances[number] for c, f in self.pairs()])
            shift = float(np.median(errors))
            found.append((shift, float(np.abs(errors - shift).max())))
        return found

    def full_batch(self, candidate: Candidate, starts: Sequence[int]) -> list[Entry]:
        """Runs on fresh starts with the scenario's own settings; raises BudgetSpent where too few are left."""
        return self._full([candidate] * len(starts), starts, "full")

    def fine_batch(self, candidate: Candidate, starts: Sequence[int]) -> list[Entry]:
        """Runs of the search from other starts with the scenario's own settings; raises BudgetSpent as `full_batch`."""
        return self._full([candidate] * len(starts), starts, "fine")

    def _full(self, candidates: Sequence[Candidate], starts: Sequence[int], fidelity: str) -> list[Entry]:
        self._check(0, len(starts))
        return self._made(candidates, starts, [fidelity] * len(starts))

    def _check(self, coarse: int, full: int) -> None:
        most = self.task.runs
        if self.count("coarse") + self.count("short") + coarse > most.coarse:
            raise BudgetSpent(f"all {most.coarse} {'short' if self.is_short_first else 'coarse'} runs are spent")
        if self.count("full") + self.count("fine") + full > most.full:
            raise BudgetSpent(f"all {most.full} full runs are spent")

    def _made(self, candidates: Sequence[Candidate], starts: Sequence[int], fidelities: Sequence[str]) -> list[Entry]:
        end = self._short_end() if fidelities[0] == "short" else None
        known = [n for n, w in enumerate(self.task.wanted) if end is None or w.last <= end or math.isinf(w.last)]
        outputs = {f"wanted{n}": self.task.wanted[n].output() for n in known}
        # From the first switch on: while it falls into its drape, every coarse fabric overlaps for a moment.
        since = str(PhysicalValue(min(c.begin for c in candidates), "s"))
        outputs[OVERLAP] = Output.model_validate(
            {"quantity": f"{self.rig.fabric}.max_penetration", "over": "max", "from": since}
        )
        outputs[SPENT] = Output(quantity="energy")
        packer = Packer()
        given = [COARSE if f == "coarse" else None for f in fidelities]
        asked = zip(candidates, given, starts)
        texts = [packed_text(scenario_for(c, self.rig, g, s, end), packer) for c, g, s in asked]
        shared = Shared(packer.files(), outputs, {})
        results = self.batches.results(simulate, shared, [Job(run_key(shared, t), t) for t in texts])
        made = []
        for candidate, start, fidelity, result in zip(candidates, starts, fidelities, results):
            numbers = result.arrays[0] if result.is_complete else ()
            wanted: tuple[float, ...] = ()
            if result.is_complete:
                read = {n: float(v) for n, v in zip(known, numbers)}
                wanted = tuple(read.get(n, math.nan) for n in range(len(self.task.wanted)))
                units = dict(zip(known, result.text))
                self.units = tuple(units.get(n, w.unit or "") for n, w in enumerate(self.task.wanted))
            distances = tuple(w.distance(v, u) for w, v, u in zip(self.task.wanted, wanted, self.units))
            overlap, energy = (float(v) for v in numbers[-2:]) if result.is_complete else (float("nan"),) * 2
            made.append(
                Entry(fidelity, candidate, start, wanted, distances, overlap, energy, result.failure, result.seconds)
            )
        self.entries += made
        return made

    def _short_end(self) -> float:
        """Until the longest delay and the time in which the fabric is to be rigid are over [s], on the output grid."""
        assert self.task.cycle is not None
        last = max(d.to("s") for d in self.task.cycle.delay) + self.task.cycle.hot_for.to("s")
        grain, stop = self.rig.scenario.time.output_step.to("s"), self.task.cycle.period.to("s")
        return round(stop - math.floor((stop - last) / grain + 1e-9) * grain, 9)

    def table(self) -> str:
        """Every run, as CSV."""
        buffer = io.StringIO()
        writer = csv.writer(buffer)
        wanted = [f"{w.name} [{u}]" for w, u in zip(self.task.wanted, self.units or [""] * len(self.task.wanted))]
        head = ["energy [J]", "overlap [mm]", "met", "wall time [s]", "failure"]
        writer.writerow(["run", "fidelity", "design", "start", *wanted, *head])
        for number, e in enumerate(self.entries, start=1):
            values = ["" if math.isnan(v) else f"{v:.6g}" for v in e.values] or [""] * len(wanted)
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
