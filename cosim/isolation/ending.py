"""How the process of an isolated unit ended, in words."""

from __future__ import annotations

import os
import signal
from dataclasses import dataclass

from cosim.isolation.limits import Limits, memory_text

#: From this share of the limit on, memory is named as a likely cause. The allocation that failed is not counted, pages
#: that were reserved and never touched are not, and Linux adds up the resident pages of its processors late.
_NEARLY_FULL = 0.6
_MEANINGS = {
    signal.SIGSEGV: "segmentation fault",
    signal.SIGABRT: "abort",
    signal.SIGFPE: "arithmetic error",
    signal.SIGILL: "illegal instruction",
    signal.SIGBUS: "bus error",
}
_LINES, _LINE = 5, 200


@dataclass(frozen=True)
class Ending:
    """How a process ended.

    Args:
        status: As `os.waitpid` gives it; None: somebody else has waited for it.
        function: FMI function that was being called; empty: none, or not known.
        doing: What the unit was asked to do, for example `its step`.
        memory: Largest memory that was seen [byte].
        said: Last bytes of its standard output and error.
    """

    status: int | None
    function: str
    doing: str
    memory: int
    said: bytes

    def text(self, limits: Limits) -> str:
        """What happened, where, with which memory, and what it printed last."""
        where = f"in {self.function}" if self.function else f"during {self.doing}"
        return (
            f"its process {self._how()} {where}{memory_used(self.memory, limits, always=True)}{last_lines(self.said)}"
        )

    def _how(self) -> str:
        if self.status is None:
            return "ended for an unknown reason"
        code = os.waitstatus_to_exitcode(self.status)
        if code >= 0:
            return f"ended by itself with exit code {code}"
        try:
            number = signal.Signals(-code)
        except ValueError:  # a real-time signal
            return f"was ended by signal {-code}"
        if number in _MEANINGS:
            return f"crashed with {number.name} ({_MEANINGS[number]})"
        return f"was ended from outside with {number.name}"


def memory_used(memory: int, limits: Limits, always: bool = False) -> str:
    """`; it used ...` where memory may be the cause, or always."""
    used, limit = memory_text(memory), memory_text(limits.memory_limit)
    if memory >= _NEARLY_FULL * limits.memory_limit:
        return f"; it had used {used} of the {limit} of memory that it may use"
    return f"; it used {used} of memory" if always and memory else ""


def last_lines(said: bytes) -> str:
    """The last lines of what a process printed, one after the other, without control characters."""
    text = said.decode("utf-8", "replace")
    lines = ["".join(c for c in line if c.isprintable()).strip()[-_LINE:] for line in text.splitlines()]
    lines = [line for line in lines if line][-_LINES:]
    return f"; it printed last: {' | '.join(lines)}" if lines else ""
