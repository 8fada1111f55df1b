"""What one simulation gives: arrays, or the reason why it has none."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from cosim.unit.protocol import Array


@dataclass(frozen=True)
class Result:
    """Outcome of a simulation.

    Args:
        arrays: What it gives, in the order that its maker states; empty where it failed.
        failure: Why it stopped early; empty where it did not.
        seconds: Wall time that it took.
        text: What it gives beside numbers: units.
    """

    arrays: tuple[Array, ...]
    failure: str = ""
    seconds: float = 0.0
    text: tuple[str, ...] = ()

    @property
    def is_complete(self) -> bool:
        """Whether it ran to its end."""
        return not self.failure


@dataclass(frozen=True)
class Task:
    """One simulation of a batch.

    Args:
        key: Hash of everything that decides its result (hexadecimal).
        given: What `Work` is called with; small, as it travels to a process.
    """

    key: str
    given: Any


#: Simulates: what all tasks of a batch share, and what one of them alone is given. It must be a function of a module,
#: so that another process finds it, and must raise KeyboardInterrupt where it is stopped.
Work = Callable[[Any, Any], Result]


def failures(results: Sequence[Result]) -> list[str]:
    """Reasons of those that failed, each once, in order."""
    return list(dict.fromkeys(r.failure for r in results if r.failure))
