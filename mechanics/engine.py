"""Loads Bullet for the modules that call it, or says why there is none."""

from __future__ import annotations

from typing import Any

from cosim.unit.protocol import UnitError
from mechanics.quiet import without_output

REMEDY = (
    "install it, `pip install pybullet`: Python up to 3.11 on Linux x86-64 has a wheel; elsewhere pip compiles it, "
    "which needs a C++ compiler and many minutes"
)


class BulletMissingError(UnitError):
    """pybullet is not installed or does not load."""

    def __init__(self, fault: str) -> None:
        super().__init__("Bullet", f"a fabric or a pendulum needs pybullet, and {fault}", remedy=REMEDY)


def load() -> Any:
    """The module pybullet, which prints its build time when it is first loaded.

    Raises:
        BulletMissingError: It is not installed or does not load.
    """
    try:
        with without_output():
            import pybullet
    except ModuleNotFoundError as error:
        raise BulletMissingError("it is not installed") from error
    except ImportError as error:
        raise BulletMissingError(f"it does not load: {error}") from error
    return pybullet
