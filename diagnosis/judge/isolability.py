"""What the channels of the recordings can tell apart at all."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class FaultClass:
    """Faults that the channels cannot tell from each other.

    Args:
        faults: Their equations or parts: `heat balance of a coil`, `resistance of a coil`.
        is_detectable: Whether the channels show that one of them is there.
    """

    faults: tuple[str, ...]
    is_detectable: bool = True


@dataclass(frozen=True)
class ExtraChannel:
    """A channel that is not recorded, and what it would add.

    Args:
        channel: Its quantity: `coil[2,5].temperature`, `coil temperatures`.
        classes: Classes of faults that could be told apart with it.
        statement: In plain words.
    """

    channel: str
    classes: int
    statement: str


@dataclass(frozen=True)
class Isolability:
    """What these channels can tell apart.

    Args:
        statements: In plain words, the most important first.
        classes: Faults by what can be told apart.
        extra_channels: Channels that would help, the best first.
    """

    statements: tuple[str, ...] = ()
    classes: tuple[FaultClass, ...] = ()
    extra_channels: tuple[ExtraChannel, ...] = ()
