"""Makes batches of simulations: those that are kept are read, the others made, kept and counted."""

from __future__ import annotations

from collections.abc import Sequence
from types import TracebackType
from typing import Any

from cosim.compute.cache import Cache
from cosim.compute.cluster import Here, Place
from cosim.compute.progress import Progress
from cosim.compute.result import Result, Task, Work
from cosim.compute.steps import share


class Batches:
    """Makes simulations at a place, with a memory and a count. Used as a context, it frees the place at its end.

    Ctrl-C leaves every simulation that was finished on disk, whole; KeyboardInterrupt goes on to the caller.

    Args:
        place: Where they are made.
        cache: Where they are kept; None: nowhere.
        progress: Told of every simulation.
    """

    def __init__(
        self, place: Place | None = None, cache: Cache | None = None, progress: Progress | None = None
    ) -> None:
        self.place: Place = place or Here()
        self.cache, self.progress = cache, progress or Progress()
        #: Simulations that were made, not read.
        self.made = 0

    def __enter__(self) -> Batches:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.place.close()

    def results(self, work: Work, shared: Any, tasks: Sequence[Task]) -> list[Result]:
        """Results of tasks, in their order; equal keys are simulated once.

        Args:
            work: What simulates.
            shared: What all of them need; the same object in every call travels to a process once.
            tasks: One per simulation.

        Raises:
            InputError: The cluster does not answer, or the folder of the cache cannot be written.
            KeyboardInterrupt: The user stopped it.
        """
        found: dict[str, Result] = {}
        missing: dict[str, Task] = {}
        for task in tasks:
            kept = self.cache.get(task.key) if self.cache is not None and task.key not in missing else None
            if kept is not None and task.key not in found:
                self.progress.finished(kept.seconds, was_kept=True)
            if kept is not None:
                found[task.key] = kept
            elif task.key not in found:
                missing[task.key] = task
        chosen = list(missing.values())
        # One alone is made here: a process would only add its way there and back.
        place = Here() if len(chosen) == 1 and self.place.is_local else self.place
        for made, (number, result) in enumerate(place.make(work, shared, chosen)):
            self.made += 1
            if len(chosen) > 1:
                share((made + 1) / len(chosen))
            if self.cache is not None:
                self.cache.put(chosen[number].key, result)
            found[chosen[number].key] = result
            self.progress.parallel = self.place.parallel
            self.progress.finished(result.seconds, was_kept=False)
        return [found[task.key] for task in tasks]
