"""What a unit in a process of its own may take."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Limits:
    """Limits of one isolated unit.

    Args:
        step_limit: Wall time that one request (a step, an initialisation) may take [s].
        memory_limit: Memory that its process may use, the Python interpreter in it included [byte].
    """

    step_limit: float = 60.0
    memory_limit: int = 4_000_000_000


def memory_text(size: int) -> str:
    """A size for a message, for example `1.2 GB`."""
    return f"{size / 1e9:.3g} GB" if size >= 1e9 else f"{size / 1e6:.0f} MB"
