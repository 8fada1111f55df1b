"""A clock in another unit of time: milliseconds or minutes taken for seconds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cosim.components import nanoseconds
from diagnosis.check.beside import MOST_STEPS, Compared, compare
from diagnosis.check.explain import Fit, explained, fit
from diagnosis.check.timing import critical, discrepant, leading, percent
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import Recording
from diagnosis.report.display import instant

#: Factors between units of time that are mistaken for one another: ms, s, min, h.
FACTORS = {
    1e-3: "ms taken for s",
    1e3: "s taken for ms",
    1.0 / 60.0: "s taken for min",
    60.0: "min taken for s",
    1.0 / 3600.0: "s taken for h",
    3600.0: "h taken for s",
}
#: Share of the recording within which all switches of a programme lie if its times are far too long.
EARLY = 0.1


def time_unit_doubts(compared: Compared) -> list[Doubt]:
    """A doubt where the programme does not happen within the recording, and does in another unit of time.

    Two tests, both of which must hold: as it is, the simulation leaves more than a model's discrepancy; in the other
    unit it
    does not (`diagnosis.check.timing.discrepant`). Only recordings are asked that end before the first switch, or whose
    switches all lie in their first tenth.
    """
    span = compared.end - compared.begin
    every = [c.switches() for c in compared.courses]
    switches = np.unique(np.concatenate([np.zeros(0), *every]))
    inside = switches[(switches > compared.begin) & (switches < compared.end)]
    if compared.base is None or not switches.size or (inside.size and inside[-1] > compared.begin + EARLY * span):
        return []
    best: tuple[float, str, float, float] | None = None
    for factor, name in FACTORS.items():
        found = _in_unit(compared, factor)
        if found is not None and (best is None or found[1] > best[2]):
            best = (found[2], name, found[1], found[0])
    if best is None:
        return []
    z, name, share, own = best
    text = (
        f"the recording lasts {instant(span, 3)} s, and the programme switches from {switches[0]:.3g} to "
        f"{instant(switches[-1], 3)} s: with "
        f"{name} corrected it explains {percent(share)} of the variance of the readings, as it is {percent(own)}"
    )
    return [
        Doubt(
            compared.recording.title,
            "time",
            "clock",
            text,
            "correct `time.unit`",
            True,
            compared.begin,
            compared.end,
            z,
        )
    ]


def _in_unit(compared: Compared, factor: float) -> tuple[float, float, float] | None:
    """Shares explained as it is and in the other unit, and the evidence; None if that unit does not help."""
    scaled = _scaled(compared.recording, factor)
    steps = scaled.end * 1e9 / nanoseconds(compared.scenario.time.macro_step)
    assert compared.base is not None
    if not 24 <= steps <= MOST_STEPS:
        return None
    other = compare(compared.base, scaled)
    if not other.switches().size:
        return None
    leads = leading(other)
    if not leads:
        return None
    fits = [explained(b, b) for b in leads]
    plain = [_plain(compared, b.channel.name) for b in leads]
    excess = float(np.median([discrepant(f) for f in plain]))
    if excess <= critical(float(len(FACTORS))) or np.median([discrepant(f) for f in fits]) >= critical(
        float(len(FACTORS))
    ):
        return None
    shares = [float(np.median([f.share for f in found])) for found in (plain, fits)]
    return shares[0], shares[1], float(np.sqrt(excess))


def _plain(compared: Compared, name: str) -> Fit:
    """What the simulation explains as it is."""
    own = compared.channels[name]
    if own.moves:
        return explained(own, own)
    return fit(own.measured, np.zeros((len(own.pick), 0)), own.tolerance)


def _scaled(recording: Recording, factor: float) -> Recording:
    channels = {n: replace(c, times=factor * c.times) for n, c in recording.channels.items()}
    inputs = tuple(replace(i, times=factor * i.times) for i in recording.inputs)
    return replace(recording, channels=channels, inputs=inputs, end=factor * recording.end)
