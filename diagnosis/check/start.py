"""The start: are the first readings those of the scenario's initial state?"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from cosim.unit.quantity import conversion
from diagnosis.check.beside import Beside, Compared, held_inputs
from diagnosis.check.explain import LEVEL
from diagnosis.check.feedthrough import follows_at_once
from diagnosis.check.numbers_at_start import moved_by_numbers
from diagnosis.check.quantiles import normal_beyond
from diagnosis.check.readings import measured_noise
from diagnosis.check.scale import first
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import FEWEST_VALUES
from diagnosis.report.display import instant
from diagnosis.search.shares import RIG_START

#: Share of what a channel has moved since the simulation began that a model's wrong numbers may have done.
WRONG_NUMBERS = 0.5
#: How much farther off than later ones first readings are that show another start.
ELSEWHERE = 3.0
#: Deviations by which a single reading may be off.
GROWN = 2.0
#: Share of what a start is off by, below which the last third of a recording is nearer to the simulation.
NEARER = 0.75
#: Deviations that a start is off which is said to be another one, and how many times farther than in other recordings.
FAR, ODD = 8.0, 4.0
#: Deviations of a start beyond which it is no start of that day: chance does that in one of 16,000.
STRAINED = 4.0


def start_doubts(compared: Compared) -> list[Doubt]:
    """Temperatures that begin elsewhere than simulated, beyond noise, stated uncertainty and bias.

    No such doubt is serious: a start that is stated wrongly can be stated rightly. It is far where it would take more
    than `STRAINED` deviations of a start; then it is no start of that day, and says nothing of the model.
    A recording that begins when the simulated rig has been driven already has no start to compare: what it begins with
    is the model's doing. Nor has an output whose first value hangs on numbers of the rig.
    """
    found = []
    members = [b for b in compared.channels.values() if b.channel.unit == "K" and b.simulated is not None]
    limit = normal_beyond(LEVEL / (2.0 * max(len(members), 1)))
    for beside in members:
        if _is_driven_before(beside):
            continue
        spread = _stated(compared, beside)
        usual = max(spread, RIG_START)
        off, deviation = _off(beside)
        if _grows(beside, off):
            continue
        total = float(np.sqrt(deviation**2 + spread**2))
        if abs(off) > limit * total + beside.channel.bias_bound:
            most = STRAINED * float(np.hypot(deviation, usual)) + beside.channel.bias_bound
            is_far = abs(off) > most and not compared.recording.beginning
            found.append(replace(_doubt(compared, beside, off, abs(off) / total), is_far=is_far))
    found += _others(compared)
    by_numbers = moved_by_numbers(compared, [compared.channels[d.subject] for d in found])
    return [d for d in found if d.subject not in by_numbers]


def _others(compared: Compared) -> list[Doubt]:
    """Positions, levels, pressures that begin elsewhere than simulated, and come nearer to the simulation later.

    What stays as far off is no start: an offset of a sensor, or a number of the model.
    """
    return [d for d, _, is_forgotten in _elsewhere(compared) if is_forgotten]


def _elsewhere(compared: Compared) -> Iterator[tuple[Doubt, Beside, bool]]:
    """Doubts about channels that begin elsewhere, and whether most later readings are near the simulation."""
    if compared.recording.beginning:
        return
    every = [b for b in compared.channels.values() if b.channel.unit != "K" and b.simulated is not None]
    every = [
        b
        for b in every
        if not _is_unknown(compared, b) and not _is_flow(b) and not _is_driven_before(b) and len(b.pick) > FEWEST_VALUES
    ]
    limit = normal_beyond(LEVEL / (2.0 * max(len(every), 1)))
    for beside in every:
        off, deviation = _off(beside)
        later = float(np.median(np.abs(beside.measured - beside.simulated_there)))
        if _grows(beside, off) or abs(off) <= limit * deviation + beside.channel.bias_bound:
            continue
        values, time = first(beside)
        end = float(beside.channel.times[len(values) - 1])
        mean = float(np.mean(values))
        units = compared.units_of(beside.channel.name)
        texts = [units.text(v, beside.channel.unit, False) for v in (mean, mean - off)]
        text = (
            f"its first {len(values)} readings ({instant(time)} to {instant(end)} s) are {texts[0]} on average, "
            f"where {texts[1]} is simulated, and later ones are nearer to the simulation"
        )
        remedy = "let the scenario start there (`overrides`), or use `begin` from where the start is forgotten"
        z = abs(off) / deviation
        doubt = Doubt(compared.recording.title, beside.channel.name, "start", text, remedy, False, time, end, z)
        yield doubt, beside, abs(off) > ELSEWHERE * later


def with_odd_starts(doubts: Sequence[Doubt], every: Sequence[Compared]) -> list[Doubt]:
    """Doubts, those serious about a start where one recording alone begins elsewhere, and by far.

    Before anything has acted no number and no law of the rig moves what is read, unless it follows an input at once.
    Where others begin where they are simulated, this one does not begin as it says, or its sensor was off.

    Args:
        doubts: About all recordings.
        every: Recordings beside their simulations.
    """
    known = {d.recording for d in doubts if d.is_serious}
    slow = []
    for one in (o for o in every if o.recording.title not in known):
        for doubt, beside, is_forgotten in _elsewhere(one):
            if is_forgotten or not _is_nearer_at_last(beside) or not _is_odd(doubt, every):
                continue
            if not moved_by_numbers(one, [beside]):
                slow.append(replace(doubt, is_serious=True))
    return [
        *(
            replace(d, is_serious=True) if d.kind == "start" and d.recording not in known and _is_odd(d, every) else d
            for d in doubts
        ),
        *slow,
    ]


def _is_nearer_at_last(beside: Beside) -> bool:
    """Whether the last third of the readings is nearer to the simulation than the first ones, by a quarter or more.

    A slow rig has not forgotten its start by then; what an offset of a sensor does is there as at the begin.
    """
    off, _ = _off(beside)
    misfit = beside.measured - beside.simulated_there
    return bool(np.max(np.abs(misfit[-(len(misfit) // 3) :])) < NEARER * abs(off))


def _is_odd(doubt: Doubt, every: Sequence[Compared]) -> bool:
    (own,) = (one for one in every if one.recording.title == doubt.recording)
    beside = own.channels[doubt.subject]
    if beside.channel.unit == "K" and not doubt.is_far:  # it may be of that day
        return False
    others = [o.channels[doubt.subject] for o in every if o is not own and doubt.subject in o.channels]
    others = [b for b in others if b.is_comparable and not _is_driven_before(b)]
    assert beside.simulated is not None
    if not others or follows_at_once(beside.simulated, held_inputs(own.courses), beside.channel.deviation):
        return False
    off, deviation = _off(beside)
    if abs(off) < FAR * deviation:
        return False
    return all(abs(off) > ODD * (abs(o) + d + b.channel.bias_bound) for b in others for o, d in [_off(b)])


def _stated(compared: Compared, beside: Beside) -> float:
    """Largest stated deviation of a number of this recording that a channel may begin with, in its SI unit; 0: none.

    Units of this project call such numbers initial; an FMU calls its start values as it likes: what has the quantity of
    the channel, in its component, may be one.
    """
    own = beside.channel.name.split(".")[0]
    found = [0.0]
    for key, value in compared.recording.uncertain.items():
        is_called = "initial" in key or "temperature" in key
        if not (is_called or key.split(".")[0] == own):
            continue
        try:
            found.append(value.number * conversion(value.unit or beside.channel.unit, beside.channel.unit)[0])
        except ValueError:
            continue  # another quantity
    return max(found)


def _is_unknown(compared: Compared, beside: Beside) -> bool:
    """Whether the recording says that it does not know a number of the channel's component exactly.

    A channel of another quantity may begin with it too: a pressure of steam with the temperature of its water.
    """
    own = beside.channel.name.split(".")[0]
    return any(key.split(".")[0] == own for key in compared.recording.uncertain) or _stated(compared, beside) > 0.0


def _is_driven_before(beside: Beside) -> bool:
    """Whether the simulated channel has moved between the begin of the simulation and the first reading."""
    simulated = beside.simulated
    assert simulated is not None
    course = simulated.values[simulated.times <= beside.channel.times[0]]
    return bool(course.size and np.ptp(course) > beside.floor)


def _grows(beside: Beside, off: float) -> bool:
    """Whether the very first reading is where it is simulated and later ones leave: another slope, the same start."""
    values, _ = first(beside)
    own = float(values[0] - beside.at(beside.channel.times[:1])[0])
    return abs(own) + GROWN * max(beside.floor, measured_noise(beside)) < 0.5 * abs(off)


def _off(beside: Beside) -> tuple[float, float]:
    """First readings less the simulated ones, and the deviation of that [K].

    A rig that is driven from the begin moves before three readings are taken: by how much is a matter of its numbers.
    """
    values, _ = first(beside)
    course = beside.at(beside.channel.times[: len(values)])
    assert beside.simulated is not None
    moved = WRONG_NUMBERS * abs(float(np.mean(course)) - float(beside.simulated.values[0]))
    noise = max(beside.floor, measured_noise(beside)) / np.sqrt(len(values))
    return float(np.mean(values - course)), float(np.hypot(noise, moved))


def _doubt(compared: Compared, beside: Beside, off: float, z: float) -> Doubt:
    values, time = first(beside)
    measured = float(np.mean(values))
    simulated = measured - off
    end = float(beside.channel.times[len(values) - 1])
    unit = "K" if "K" in compared.recording.units else "degC"
    begin, mean, there = (
        f"{conversion('K', unit)[0] * v + conversion('K', unit)[1]:.4g} {unit}"
        for v in (float(np.mean(values[:3])), measured, simulated)
    )
    text = (
        f"begins at {begin}; its first {len(values)} readings ({instant(time)} to {instant(end)} s) are "
        f"{mean} on average, where {there} is simulated"
    )
    remedy = (
        "state this recording's initial temperature and surroundings under `overrides`, or how far they "
        "are unknown under `uncertain`; did this sensor read as in the other recordings?"
    )
    return Doubt(compared.recording.title, beside.channel.name, "start", text, remedy, False, time, end, z)


def _is_flow(beside: Beside) -> bool:
    """Whether a channel follows a switch at once, as a current does: it has no start of its own."""
    return beside.simulated is None or beside.simulated.is_flow
