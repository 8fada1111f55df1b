"""How right the amended model is: what it explains, what it leaves, and whether the readings still reject it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.judge.acceptance import Accepted
from diagnosis.judge.agreement import Agreement
from diagnosis.judge.diagnosis import Adequacy, ChannelFit, Left, Met, Moved
from diagnosis.judge.held_out import root_mean_square
from diagnosis.judge.unfitted import Predicted, Readings
from diagnosis.models.coil_network.runs import deviation
from diagnosis.search.problem import Parameter
from diagnosis.search.shares import titled

#: Prior deviations from which a number of the day is reported.
TOLD = 0.5
#: Deviations of a reading's noise from which an error of the macro-step is spoken of, and its share of what is left.
SEEN, HALF = 1.0, 0.5


def adequacy(
    accepted: Accepted,
    readings: Readings,
    day: tuple[Moved, ...],
    is_recalibrated: bool = True,
    has_scatter: bool = False,
) -> Adequacy:
    """How right the accepted model is.

    Args:
        accepted: What was accepted, with its agreement with unfitted and with training readings.
        readings: The unfitted ones.
        day: Numbers of the day that were moved, see `moved_day`.
        is_recalibrated: Whether the model has any number that could be fitted.
        has_scatter: Whether its noise holds what the simulation scatters by itself.
    """
    now, worst = accepted.agreement, accepted.agreement.worst
    before, recalibrated = accepted.agreement_before, accepted.agreement_recalibrated
    louder = _louder([now, accepted.training])
    return Adequacy(
        basis=accepted.basis,
        is_rejected=now.is_rejected,
        chi_square={
            "before": before.chi_square,
            "recalibrated": recalibrated.chi_square,
            "after": now.chi_square,
        },
        limit=now.limit,
        explained=_share(before, now),
        by_recalibration=_share(before, recalibrated),
        worst=None
        if worst is None
        else Left(
            worst.recording,
            worst.channel,
            worst.unit,
            worst.rmse,
            worst.noise,
            worst.chi_square,
            worst.limit,
            worst.scatter,
            worst.is_noise_stated,
            correlation=worst.correlation,
        ),
        rejected=(sum(c.is_rejected for c in now.channels), len(now.channels)),
        day=day,
        wild=now.wild,
        is_noise_stated=all(c.is_deviation_given for c in readings.channels),
        is_nominal_rejected=before.is_rejected and not (louder and before.is_met_by_scatter),
        is_training_rejected=accepted.training.is_rejected,
        is_recalibration_worse=accepted.recalibration.is_loss or bool(accepted.recalibration.worse),
        is_irregular=now.is_irregular if now.is_rejected else accepted.training.is_irregular,
        is_recalibrated=is_recalibrated,
        has_scatter=has_scatter,
        met=met(accepted.after, readings),
        needs_parameter_error=now.needs_parameter_error,
        noises_stated=(sum(c.is_deviation_given for c in readings.channels), len(readings.channels)),
        alike=accepted.training.alike,
        louder=louder,
    )


def _louder(agreements: Sequence[Agreement]) -> dict[str, float]:
    """Channel to how many times its stated noise it scatters, where no readings reject a model by that scatter."""
    rejecting = [a for a in agreements if a.is_rejected]
    if not all(a.is_met_by_scatter for a in rejecting):
        return {}
    found: dict[str, float] = {}
    for channel, times in (own for a in rejecting for own in a.louder.items()):
        found[channel] = max(times, found.get(channel, 1.0))
    return found


def with_day(found: Adequacy, fits: Sequence[ChannelFit]) -> Adequacy:
    """The same with what estimating the day's own numbers takes from the scenario as it is.

    Single wild readings are in the rows of `fits` before and after alike.

    Args:
        found: How right the accepted model is.
        fits: Every channel with the numbers of the day as written down.
    """
    rows = [f for f in fits if f.is_held_out and f.samples]
    count = sum(f.samples for f in rows)
    if not count:
        return found
    written = {s: sum(f.samples * f.chi_square[s] for f in rows) / count for s in ("before", "after")}
    fall = {stage: value - found.chi_square[stage] for stage, value in written.items()}
    return replace(found, by_day=max(fall["before"] - fall["after"], 0.0))


def with_solving(found: Adequacy, solving_error: Callable[[], Array | None]) -> Adequacy:
    """The same with what an error of the macro-step may do, where it may be half of what is left or more.

    Recalibrated numbers take a part of that error, so that it is not subtracted.

    Args:
        found: How right the accepted model is.
        solving_error: Tells about how far residuals are from those with infinitely short macro-steps; None where it is
            not known. It is asked where readings reject the model.
    """
    error = solving_error() if found.is_open else None
    if error is None or not len(error):
        return found
    farthest, left = float(np.max(np.abs(error))), max(found.chi_square["after"] - 1.0, 0.0)
    if farthest < SEEN or float(np.mean(error**2)) < HALF * left:
        return found
    return replace(found, by_solving=farthest)


def met(predicted: Predicted, readings: Readings) -> tuple[Met, ...]:
    """How each channel is met, wild readings counted, the numbers of the day as they were estimated.

    Args:
        predicted: Of the accepted model.
        readings: What it predicted.
    """
    found = []
    for number, channel in enumerate(readings.channels):
        own = predicted.residuals[readings.channel == number]
        if len(own):
            rmse = deviation(channel) * root_mean_square(own)
            found.append(Met(readings.titles[readings.of_channel[number]], channel.name, channel.unit, rmse, len(own)))
    return tuple(found)


def moved_day(predicted: Predicted, parameters: Sequence[Parameter], titles: Sequence[str] = ()) -> tuple[Moved, ...]:
    """Numbers of the day that are taken to be farther from what is written down than `TOLD` of what is usual.

    Args:
        predicted: Of the accepted model.
        parameters: Of the model that judges.
        titles: Of its recordings, in their order: a number says nothing to who gave recordings of two kinds.
    """
    known = {p.name: p for p in parameters}
    told = {name: moved for name, moved in predicted.day.items() if abs(moved[1]) > TOLD}
    found = [
        Moved(titled(known[name], titles), known[name].unit, amount, False, far)
        for name, (amount, far) in told.items()
        if not known[name].is_within_row
    ]
    instants = [moved for name, moved in told.items() if known[name].is_within_row]
    if instants:
        amount, far = max(instants, key=lambda m: abs(m[1]))
        count = f"{len(instants)} changes" if len(instants) > 1 else "1 change"
        text = f"{count} of recorded inputs between two rows of their table, where this model meets the readings best"
        found.append(Moved(text, "s", amount, False, far))
    return tuple(found)


def _share(before: Agreement, after: Agreement) -> float:
    if before.excess <= 0.0:
        return 0.0
    return 1.0 - after.excess / before.excess
