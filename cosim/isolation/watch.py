"""A thread in the process of an isolated unit that outlives an endless step."""

from __future__ import annotations

import os
import select
import shutil
import signal
import threading

from cosim.isolation.shared import Header

#: How often memory is looked at, and whether the simulation is still there [s].
INTERVAL = 0.25


class Watch:
    """Notes the memory of this process, and ends it when the simulation is gone.

    Args:
        requests: Descriptor of the pipe on which requests come; it hangs up when the simulation ends.
        parent: Process of the simulation.
        folder: Removed when the simulation ends before the unit was terminated; empty: none.
        header: Where the memory is noted.
    """

    def __init__(self, requests: int, parent: int, folder: str, header: Header) -> None:
        self._requests, self._parent, self._folder, self._header = requests, parent, folder, header

    def start(self) -> None:
        """Begin to watch."""
        threading.Thread(target=self._watch, name="watch", daemon=True).start()

    def _watch(self) -> None:
        hang_up = select.poll()
        hang_up.register(self._requests, 0)
        # A forked copy of the simulation may hold the pipe open; the parent of this process tells then.
        while not hang_up.poll(1e3 * INTERVAL) and os.getppid() == self._parent:
            self.note_memory()
        self.end()

    def note_memory(self) -> None:
        """Look at the memory of this process once."""
        self._header.memory = memory_in_use()

    def end(self) -> None:
        """Remove the folder and end this process, with all processes that the unit has started."""
        if self._folder:
            shutil.rmtree(self._folder, ignore_errors=True)
        os.killpg(0, signal.SIGKILL)


def memory_in_use() -> int:
    """Private writable memory of this process, which RLIMIT_DATA limits [byte]; 0 where the system does not tell.

    Source: proc_pid_statm(5), field `data`.
    """
    try:
        with open("/proc/self/statm", "rb") as file:
            return int(file.read().split()[5]) * os.sysconf("SC_PAGE_SIZE")
    except OSError:
        return 0
