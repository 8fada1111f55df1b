"""Which units an algorithm may take back to the begin of a step."""

from __future__ import annotations

from collections.abc import Sequence

from cosim.system import System


class CannotRestore(ValueError):
    """An algorithm must repeat the step of a unit that cannot go back; the text names it."""


def require_restoring(system: System, names: Sequence[str], purpose: str, is_divided: bool = False) -> None:
    """Check that units can return to a saved state.

    Args:
        system: The system.
        names: Units that the algorithm takes back.
        purpose: What it does with them, for the error.
        is_divided: Whether it makes steps of other sizes than the macro-step.

    Raises:
        CannotRestore: One of them cannot.
    """
    fixed = [name for name in names if not getattr(system.units[name], "can_vary_step", True)]
    if is_divided and fixed:
        raise CannotRestore(f"{purpose} divides macro-steps, but {', '.join(fixed)} takes steps of one size only")
    unable = [name for name in names if not system.units[name].can_restore]
    if unable:
        kinds = ", ".join(f"{name} ({type(system.units[name]).__name__})" for name in unable)
        raise CannotRestore(
            f"{purpose} takes units back to the begin of a step, but {kinds} cannot return to a saved state"
        )
