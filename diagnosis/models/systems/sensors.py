"""What the sensors of a system may lack: as `diagnosis.search.pendulum_terms.SENSOR_TERMS`, sized by the readings."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from diagnosis.search.cosim_model import ComponentTerm
from diagnosis.search.pendulum_terms import SENSOR_TERMS
from diagnosis.search.problem import Term, TermParameter
from diagnosis.search.unit_law import UnitLaw

#: Times between two readings: largest lag, largest offset of a clock, and where a search begins.
LONGEST_LAG, LARGEST_OFFSET, LAGS, OFFSETS = 300.0, 50.0, (1.0, 8.0), (1.0, -1.0)


def sensor_laws_of(channels: Collection[str], sample_step: float, macro_step: float) -> list[UnitLaw]:
    """Gain, lag and clock of every channel.

    Args:
        channels: Their names.
        sample_step: Typical time between two readings [s].
        macro_step: Of the co-simulation [s]; what is shorter is an error of the coupling.
    """
    found = []
    for channel in channels:
        for identifier, (name, law, number) in SENSOR_TERMS.items():
            own = _sized(identifier, number, sample_step, macro_step)
            term = Term(identifier, channel, "measurement", (own,), law=law.replace("pi", "middle"))
            found.append(UnitLaw(ComponentTerm(term, channel, ()), name))
    return found


def _sized(identifier: str, number: TermParameter, step: float, macro_step: float) -> TermParameter:
    if identifier == "sensor_lag":
        return replace(
            number,
            upper=LONGEST_LAG * step,
            starts=tuple(step * s for s in LAGS),
            negligible=macro_step,
            plausible=LONGEST_LAG * step,
            plausible_reason="no sensor of a rig follows that late",
        )
    if identifier == "sensor_clock_offset":
        most = LARGEST_OFFSET * step
        return replace(
            number,
            lower=-most,
            upper=most,
            starts=tuple(step * s for s in OFFSETS),
            negligible=macro_step,
            plausible=most,
            plausible_reason="an offset of so many readings is seen in the table",
        )
    return number
