"""Where simulations are made: in this process, in processes of this machine, or on a Dask cluster."""

from __future__ import annotations

import importlib
import logging
import os
import re
import signal
import socket
import threading
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager, nullcontext
from typing import Any, Protocol

from cosim.compute.result import Result, Task, Work
from cosim.unit.errors import InputError

#: Time in which a cluster must answer [s].
CONNECT_TIME = 30.0
#: An address as `dask scheduler` prints it.
_ADDRESS = re.compile(r"^((tcp|tls)://)?(?P<host>[A-Za-z0-9.-]+|\[[0-9A-Fa-f:]+\]):(?P<port>\d{1,5})$")
_REMEDY = "give the address that `dask scheduler` prints, such as `--cluster tcp://10.0.0.1:8786`, or leave it out"


class Place(Protocol):
    """Makes simulations."""

    #: How many it makes at once.
    parallel: int
    #: Whether its simulations run on this machine.
    is_local: bool

    def make(self, work: Work, shared: Any, tasks: Sequence[Task]) -> Iterator[tuple[int, Result]]:
        """Results as they become ready, each with the number of its task."""
        ...

    def close(self) -> None:
        """Free what it holds; safe to call twice."""
        ...


class Here:
    """One simulation after the other in this process."""

    parallel = 1
    is_local = True

    def make(self, work: Work, shared: Any, tasks: Sequence[Task]) -> Iterator[tuple[int, Result]]:
        """See `Place`."""
        for number, task in enumerate(tasks):
            yield number, work(shared, task.given)

    def close(self) -> None:
        """Nothing is held."""


class DaskPlace:
    """A Dask cluster; it is opened with the first batch, since one may need none.

    Workers live as long as this object: modules, unpacked FMUs and what tasks share are loaded once in each.

    Args:
        jobs: Processes of a cluster on this machine; not used where an address is given.
        address: Of the scheduler of a running cluster, for example `tcp://10.0.0.1:8786`. Its workers need the same
            version of this program; the diagnosis needs the scenario's files at the same paths, too.
        goes_on: Whether a simulation that kills its process is a failure of its own, and the others go on.
    """

    def __init__(self, jobs: int, address: str | None = None, goes_on: bool = False) -> None:
        self._jobs, self._address, self._goes_on = jobs, address, goes_on
        self._client: Any = None
        self._open = ExitStack()
        self._shared: tuple[Any, Any] | None = None
        self.parallel, self.is_local = jobs, address is None

    def make(self, work: Work, shared: Any, tasks: Sequence[Task]) -> Iterator[tuple[int, Result]]:
        """See `Place`.

        Raises:
            InputError: The cluster does not answer, or lost a worker again and again.
        """
        client, dask = self._connected(), distributed()
        if self._shared is None or self._shared[0] is not shared:
            # A result that others depend on: loaded once per process, and made again where a process is lost.
            self._shared = (shared, client.submit(_same, shared, pure=False))
        futures = {
            client.submit(work, self._shared[1], task.given, key=f"simulation-{task.key}", pure=False): number
            for number, task in enumerate(tasks)
        }
        lost = []
        try:
            for future in dask.as_completed(list(futures)):
                try:
                    result = future.result()
                except dask.KilledWorker:
                    if not self._goes_on:
                        raise
                    lost.append(futures[future])
                    continue
                yield futures[future], result
            for number in lost:
                yield number, self._again(client, work, tasks[number])
        except (dask.KilledWorker, dask.client.FutureCancelledError) as error:
            raise InputError(
                self._address or "local cluster",
                "",
                f"a process died while it simulated: {error}",
                "run with `--jobs 1` to see why; most often memory ran out",
            ) from error
        finally:
            client.cancel(list(futures), force=True)

    def _again(self, client: Any, work: Work, task: Task) -> Result:
        """A simulation whose process died, once more and alone: it may have shared the process with another."""
        future = client.submit(work, self._shared[1] if self._shared else None, task.given, pure=False)
        try:
            return future.result()  # type: ignore[no-any-return]
        except distributed().KilledWorker:
            return Result((), "its process died again and again; `isolation: process` of its FMUs finds the one")
        finally:
            client.cancel([future], force=True)

    def _connected(self) -> Any:
        if self._client is None:
            self._client = self._open.enter_context(dask_client(self._jobs, self._address))
            self.parallel = max(1, sum(self._client.nthreads().values()))
        return self._client

    def close(self) -> None:
        """See `Place`."""
        self._client, self._shared = None, None
        self._open.close()


def reach(address: str) -> None:
    """Refuse an address that is none, or at which nothing listens.

    Raises:
        InputError: It is so.
    """
    found = _ADDRESS.match(address)
    if found is None or not 0 < int(found["port"]) < 65536:
        raise InputError("--cluster", "", f"`{address}` is no address of a Dask scheduler", _REMEDY)
    try:
        socket.create_connection((found["host"].strip("[]"), int(found["port"])), CONNECT_TIME).close()
    except (OSError, UnicodeError) as error:  # UnicodeError: a host name with an empty or overlong part
        raise _unreachable(address, error) from error


def _unreachable(address: str, why: object) -> InputError:
    return InputError("--cluster", "", f"the cluster at {address} does not answer: {why}", _REMEDY)


def _same(shared: Any) -> Any:
    return shared


def distributed() -> Any:
    """Dask's package, late: it takes half a second, which one process need not spend."""
    return importlib.import_module("distributed")


@contextmanager
def dask_client(jobs: int, address: str | None = None, is_deaf: bool = False) -> Iterator[Any]:
    """Dask's client of a running cluster, or of processes of this machine, which end with the block.

    Args:
        jobs: Processes on this machine, one thread each; not used where an address is given.
        address: Of the scheduler of a running cluster.
        is_deaf: Whether processes of this machine ignore Ctrl-C, which a terminal sends to all: the first process ends
            them.

    Raises:
        InputError: The cluster does not answer or has no workers, or the processes do not answer.
    """
    with ExitStack() as opened:
        try:
            client = opened.enter_context(_opened(opened, jobs, address, is_deaf))
        except (OSError, TimeoutError, ValueError) as error:
            if address is not None:
                raise _unreachable(address, error) from error
            what, remedy = f"its processes do not answer: {error}", "run with `--jobs 1`"
            raise InputError("local cluster", "", what, remedy) from error
        yield client


def _opened(opened: ExitStack, jobs: int, address: str | None, is_deaf: bool) -> AbstractContextManager[Any]:
    dask = distributed()
    if address is not None:
        client: Any = dask.Client(address, timeout=CONNECT_TIME)
        if not client.nthreads():
            client.close()
            raise TimeoutError("it has no workers")
        return client  # type: ignore[no-any-return]
    # One thread each: ngspice and Bullet are not made for two threads, and a fabric keeps a core busy by itself.
    with _interrupts_ignored() if is_deaf else nullcontext():
        cluster = dask.LocalCluster(
            n_workers=jobs,
            threads_per_worker=1,
            processes=True,
            dashboard_address="127.0.0.1:0",
            memory_limit=0,
            silence_logs=logging.CRITICAL,
        )
    opened.callback(cluster.close)
    return dask.Client(cluster)  # type: ignore[no-any-return]


@contextmanager
def _interrupts_ignored() -> Iterator[None]:
    """Processes that are started here inherit that they ignore Ctrl-C."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    previous = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, previous)


def choose_place(jobs: int | None = None, address: str | None = None, goes_on: bool = False) -> Place:
    """Where simulations are made.

    Args:
        jobs: Processes on this machine; None: as many as there are cores. One needs no cluster.
        address: Of a Dask scheduler; comes before `jobs`.
        goes_on: As of `DaskPlace`.

    Raises:
        InputError: The address is none, or nothing answers there: said before any work is done.
    """
    if address is not None:
        reach(address)
    count = jobs or (len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()) or 1
    if address is None and count == 1:
        return Here()
    return DaskPlace(count, address, goes_on)
