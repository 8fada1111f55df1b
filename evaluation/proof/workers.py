"""Work on cases side by side, over Dask: in processes of this machine or on any cluster."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from cosim.compute.cluster import dask_client, distributed

#: Cases that wait at each worker: files of cases travel with them, so only a few are under way.
WAITING = 2

#: Makes the arguments of a case's work, when its turn comes.
Given = Callable[[], tuple[Any, ...]]


@dataclass(frozen=True)
class Lost:
    """A case whose work ended in an exception, or with the death of its process."""

    message: str


@dataclass
class Workers:
    """Processes that work on cases.

    Args:
        client: Dask's client; None: work is done in this process.
        count: How many.
    """

    client: Any
    count: int

    def results(self, work: Callable[..., Any], tasks: Mapping[str, Given]) -> Iterator[tuple[str, Any]]:
        """Results by case as they become ready; `Lost` where there is none.

        Args:
            work: Function of a module.
            tasks: Case to what makes its arguments.
        """
        if self.client is None:
            for case, given in tasks.items():
                yield case, _tried(work, given)
            return
        yield from self._spread(work, tasks)

    def _spread(self, work: Callable[..., Any], tasks: Mapping[str, Given]) -> Iterator[tuple[str, Any]]:
        dask = distributed()
        left = iter(tasks.items())
        names: dict[Any, str] = {}
        suspects: list[str] = []

        def submit(case: str, given: Given) -> Any:
            future = self.client.submit(work, *given(), pure=False)
            names[future] = case
            return future

        ready = dask.as_completed([submit(*task) for _, task in zip(range(WAITING * self.count), left)])
        try:
            for future in ready:
                case = names.pop(future)
                if future.status == "error" and isinstance(future.exception(), dask.KilledWorker):
                    suspects.append(case)
                else:
                    yield case, _tried(future.result, tuple)
                following = next(left, None)
                if following is not None:
                    ready.add(submit(*following))
            # A process that died took with it cases that only waited there: each has another try, alone.
            for case in suspects:
                yield case, _tried(submit(case, tasks[case]).result, tuple)
        finally:
            self.client.cancel(list(names), force=True)


def _tried(work: Callable[..., Any], given: Given) -> Any:
    try:
        return work(*given())
    except Exception as error:  # a case that fails must be counted, whatever it was
        return Lost(f"{type(error).__name__}: {error}")


@contextmanager
def workers(jobs: int, address: str | None = None) -> Iterator[Workers]:
    """Workers of this machine, or of a cluster.

    Args:
        jobs: Processes on this machine, one thread each; one alone needs no cluster.
        address: Of a running Dask scheduler; `jobs` does not matter then.

    Raises:
        InputError: As of `cosim.compute.cluster.dask_client`.
    """
    if address is None and jobs == 1:
        yield Workers(None, 1)
        return
    with dask_client(jobs, address, is_deaf=True) as client:
        yield Workers(client, jobs if address is None else sum(client.nthreads().values()))
