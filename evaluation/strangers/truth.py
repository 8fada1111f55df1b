"""What is concealed in a case, and which answers to it are true."""

from __future__ import annotations

from dataclasses import dataclass

#: Verdicts.
FINE = ("consistent", "recalibrated")
OPEN = ("cannot tell",)
RECORDING = ("recording fault",)
SENSOR = ("measurement fault",)
PHYSICS = ("missing physics", "unnamed physics")


@dataclass(frozen=True)
class Truth:
    """What is concealed, and what may be said of it.

    Args:
        concealed: In words.
        right: Verdicts that are true; "cannot tell" always is.
        names: Laws that may stand as named; a name that is none of them is false.
        training: Folders that are fitted.
        held_out: Folders that judge.
    """

    concealed: str
    right: tuple[str, ...]
    names: tuple[str, ...] = ()
    training: tuple[str, ...] = ("first", "second")
    held_out: tuple[str, ...] = ("third",)
