"""A law that a unit can switch on itself, with what it says about itself."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from diagnosis.search.cosim_model import ComponentTerm


@dataclass(frozen=True)
class UnitLaw:
    """See `diagnosis.models.protocol.Effect`.

    Args:
        place: The law in its component.
        name: In plain words.
        source: Where the law comes from.
        confused_with: Identifiers that data often cannot tell from it, with what decides.
        is_of_either: Whether it is written as a law of a sensor, and the rig may do the same before the sensor.
    """

    place: ComponentTerm
    name: str
    source: str = ""
    confused_with: Mapping[str, str] = field(default_factory=dict)
    is_of_either: bool = False

    @property
    def is_of_a_day(self) -> bool:
        """Never: what a unit lacks it lacks every day."""
        return False

    @property
    def law(self) -> str:
        """Formula."""
        return self.place.term.law
