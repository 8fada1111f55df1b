"""How far a model that is said to agree is from the truth, which the scorer alone knows.

A reading is truth plus noise, and a residual the model's departure from the truth plus the same noise. Over the N
readings of a channel the squares of the residuals less those of the noise are N times the mean square of the departure,
but for twice its product with the noise, whose expectation is 0. Wild readings are in both sums and fall out, so that
it does not matter which of them a diagnosis set aside. Noise alone lets a mean square of chi2(0.999, N) / N - 1
deviations^2 be seen: that is where the readings reject a model as often as not.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.stats import chi2

from diagnosis.judge.diagnosis import Diagnosis, Moved
from evaluation.proof.answer import Answer
from evaluation.proof.reference import Reference

#: Probability that noise alone stays below the limit of a chi-square.
_NOISE_LEVEL = 0.999
#: Stands in names of numbers that belong to some recordings alone, as a diagnosis writes them.
_OF_RECORDING = " of recording "
#: Numbers of a day whose truth is how far the room is off: a rig begins as warm as its room.
_OF_THE_ROOM = ("ambient_offset", "initial_temperature")
#: Share of the doubt about a number of the day by which it may be off: a diagnosis does not tell less than that.
_TOLD = 0.5


def noise_limit(samples: int, channels: int = 1) -> float:
    """Chi-square per sample that noise alone exceeds once in a thousand times, in any of so many channels.

    >>> round(noise_limit(3000), 3)
    1.082
    """
    return float(chi2.isf((1.0 - _NOISE_LEVEL) / channels, samples)) / samples


def is_within_noise(diagnosis: Diagnosis, answer: Answer, reference: Reference) -> bool:
    """Whether the noise hides how far the model is from the truth, with the day that it takes for granted.

    Over all held-out readings, and in each channel (Bonferroni). Where a diagnosis states the numbers of the day by
    which it met the readings, it is judged with them, and they have to be true.
    """
    found = departures(diagnosis, reference)
    if not found or not np.isfinite([square for _, square in found]).all():
        return False
    samples = sum(count for count, _ in found)
    mean = sum(count * square for count, square in found) / samples
    each = all(square <= noise_limit(count, len(found)) - 1.0 for count, square in found)
    return mean <= noise_limit(samples) - 1.0 and each and _is_day_true(diagnosis, answer)


def departures(diagnosis: Diagnosis, reference: Reference) -> list[tuple[int, float]]:
    """Held-out samples of each channel with the mean square of the departure [deviations^2].

    A reference of before has no noise by channel: there all readings are one channel, as the fit has them.
    """
    rows = _rows(diagnosis)
    if not reference.noises:
        counts, squares = _plain(diagnosis, reference)
        total = sum(counts)
        return [(total, float(np.dot(counts, squares)) / total - (reference.floor or 1.0))] if total else []
    found = []
    for channel, samples, rmse in rows:
        noise, deviation = reference.noises.get(channel, (float("nan"), 1.0))
        found.append((samples, (rmse**2 - noise**2) / deviation**2))
    return found


def _rows(diagnosis: Diagnosis) -> list[tuple[str, int, float]]:
    """Channel, samples and root mean square residual [unit] of what was held out, wild readings counted."""
    titles = {r.title for r in diagnosis.recordings if r.is_held_out}
    met = diagnosis.adequacy.met if diagnosis.adequacy is not None else ()
    own = [(m.channel, m.samples, m.rmse) for m in met if m.recording in titles]
    return own or [(f.channel, f.samples, f.rmse.get("after", float("nan"))) for f in diagnosis.fit if f.is_held_out]


def _plain(diagnosis: Diagnosis, reference: Reference) -> tuple[list[int], list[float]]:
    fits = [f for f in diagnosis.fit if f.is_held_out]
    counts = [f.samples or reference.samples.get(f.channel, 0) for f in fits]
    return counts, [f.chi_square.get("after", float("nan")) for f in fits]


def _is_day_true(diagnosis: Diagnosis, answer: Answer) -> bool:
    day: Sequence[Moved] = diagnosis.adequacy.day if diagnosis.adequacy is not None else ()
    return answer.room is None or all(_is_true(moved, answer.room) for moved in day)


def _is_true(moved: Moved, room: float) -> bool:
    """Whether a number of the day is no farther from the truth than what is written down, or by less than is said."""
    if moved.name.split(_OF_RECORDING)[0].rpartition(".")[2] not in _OF_THE_ROOM or not moved.deviations:
        return True
    doubt = abs(moved.amount / moved.deviations)
    return abs(moved.amount - room) <= max(abs(room), _TOLD * doubt)
