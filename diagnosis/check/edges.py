"""The readings' own edges beside the programme's switches: do they coincide?

A switch kinks a temperature and steps a current, whatever its size, also where the time constant is long against the
recording. Edges are kinks (steps) that the readings need beside a smooth discrepancy and noise: the generalised
likelihood ratio over all instants, one after the other (Basseville, Nikiforov, Detection of Abrupt Changes, 1993, ch.
2; orthogonal matching pursuit), each at the price of its instant. Neither their size nor the model's is
asked, only when they happen.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.check.beside import Beside, Compared
from diagnosis.check.clock_shift import asked, order, thinned
from diagnosis.check.discrepancy import RATIOS, Thinned, Whitener, whitener
from diagnosis.check.explain import explained, explains
from diagnosis.check.quantiles import poisson_log
from diagnosis.check.timing import critical, driver, listed, percent, resolution
from diagnosis.judge.diagnosis import Doubt

#: Most edges of a channel; a programme with more switches is not asked for its instants.
MOST_EDGES = 12
#: Lags of a sensor that smooth an edge, as shares of the recording.
LAGS = (0.0, 0.01, 0.03)
#: Blocks within which two edges are one: a lag that is a little off needs a second one beside the first.
NEAR = 3
#: Probability that a switch that must be seen leaves no edge although the programme was run: an open contact.
MISSED = 0.1
#: Edges that a recording has of itself, on average: a contact, a draught, a transformation.
EVENTS = 1.0
#: Odds beyond which a doubt is serious, and beyond which it is reported.
SERIOUS, TOLD = 1000.0, 100.0


@dataclass(frozen=True)
class Edges:
    """What readings and programme have in common.

    Args:
        met: Switches near which a channel has an edge [s].
        missed: Switches that must have left one and did not [s].
        extra: Edges without a switch [s].
        odds: Of another programme to this one with what a rig does of itself.
    """

    met: tuple[float, ...]
    missed: tuple[float, ...]
    extra: tuple[float, ...]
    odds: float


@dataclass(frozen=True)
class _Found:
    """Edges of one channel, and what a switch must be to be seen.

    Args:
        instants: Of its edges [s].
        sizes: Kinks (per s) or steps, in the channel's unit.
        seen: Smallest kink (or step) that would have been found, at each block, likewise.
        centres: Times of the blocks [s].
        spacing: Of the blocks [s].
    """

    instants: Array
    sizes: Array
    seen: Array
    centres: Array
    spacing: float


def edge_doubts(compared: Compared) -> list[Doubt]:
    """At most one doubt: the readings' edges are not the programme's.

    To be asked where no known explanation is found: a shift, another run, exchanged columns.
    """
    found = edges(compared)
    if found is None or found.odds < TOLD or not found.missed or not found.extra:
        return []
    odds = f"{min(found.odds, 1e6):.2g} to 1" + (" or more" if found.odds >= 1e6 else "")
    text = (
        f"the readings have edges at about {listed(found.extra)} s, where the programme does not switch, and none at "
        f"its switches at {listed(found.missed)} s, where the simulation has them: odds {odds} that another programme "
        f"was run, against this one with contacts, draughts and other events"
    )
    remedy = "is this the programme that was run? Correct `overrides`, or give the recorded input under `inputs`"
    share = float(np.median([explained(b, b).share for b in asked(compared)]))
    is_followed = explains(0.0, share)
    if not is_followed:  # behind any lags, of any size: what a rig does of itself comes beside its programme
        text += f"; the programme explains {percent(share)} of the variance of these readings"
    z = float(np.sqrt(2.0 * np.log(found.odds)))
    over = compared.begin, compared.end, z
    return [
        Doubt(
            compared.recording.title,
            driver(compared),
            "programme",
            text,
            remedy,
            found.odds >= SERIOUS or not is_followed,
            *over,
        )
    ]


def edges(compared: Compared) -> Edges | None:
    """Compare instants; None where nothing is driven, or too often to tell."""
    switches = compared.switches()
    leads = asked(compared)
    if not leads or not 1 <= len(switches) <= MOST_EDGES:
        return None
    met, seen, extra, near = set(), set(), [], 0.0
    for beside in leads:
        one = channel_edges(beside)
        margin = resolution(compared, beside.channel) + beside.channel.lag_bound + NEAR * one.spacing
        near = max(near, margin)
        kinks = _simulated_kinks(beside, switches)
        share = _share(one, kinks)
        for instant, kink in zip(switches, kinks):
            is_met = bool((np.abs(one.instants - instant) < margin).any())
            least = float(np.interp(instant, one.centres, one.seen))
            is_inside = one.centres[0] + 2.0 * margin < instant < one.centres[-1] - 2.0 * margin
            if is_met:
                met.add(float(instant))
            elif share * abs(kink) > 2.0 * least and is_inside:
                seen.add(float(instant))
        extra += [float(t) for t in one.instants if np.min(np.abs(switches - t)) >= margin]
    missed = sorted(seen - met)
    own = _clustered(extra, near)
    return Edges(tuple(sorted(met)), tuple(missed), tuple(own), _odds(compared, met, missed, own, near))


def _odds(compared: Compared, met: set[float], missed: list[float], extra: list[float], near: float) -> float:
    """Probability of these edges if another programme was run, over that of this one with events."""
    span = compared.end - compared.begin
    count = len(met) + len(extra)
    chance = float(np.clip(2.0 * near * count / span, 0.02, 0.9))
    other = len(met) * np.log(chance) + len(missed) * np.log1p(-chance)
    switches = sorted([*met, *missed])
    own = len(met) * np.log1p(-MISSED) + _rows(switches, missed, extra) * np.log(MISSED)
    own += poisson_log(len(extra), EVENTS)
    other += poisson_log(len(extra), len(compared.switches()))
    # or a programme of which some switches were moved: each with even odds
    moved = len(switches) * np.log(0.5) + poisson_log(len(extra), max(len(missed), 1))
    both = float(np.logaddexp(other, moved)) - np.log(2.0)
    return float(np.exp(np.clip(both - own, -50.0, 50.0)))


def _rows(switches: list[float], missed: list[float], extra: list[float]) -> int:
    """Events that missed switches need: what opens stays open, so a row is one, if nothing happens meanwhile."""
    count, last = 0, None
    for instant in switches:
        if instant not in missed:
            last = None
            continue
        if last is None or any(last < t < instant for t in extra):
            count += 1
        last = instant
    return count


def _clustered(instants: list[float], near: float) -> list[float]:
    """Edges of several channels, each once."""
    found: list[float] = []
    for instant in sorted(instants):
        if not found or instant - found[-1] >= near:
            found.append(instant)
    return found


def _simulated_kinks(beside: Beside, switches: Array) -> Array:
    """Kink (or step) of the simulated course at each switch, shape (switches,)."""
    series = beside.simulated
    assert series is not None
    ends = np.concatenate([[series.times[0]], switches, [series.times[-1]]])
    step = float(series.times[1] - series.times[0])
    found = np.zeros(len(switches))
    for k, instant in enumerate(switches):
        reach = max(min(instant - ends[k], ends[k + 2] - instant, 20.0 * step), 2.0 * step)
        before = (series.times >= instant - reach - 0.5 * step) & (series.times <= instant + 0.01 * step)
        after = (series.times >= instant + step) & (series.times <= instant + reach + 1.5 * step)
        if np.count_nonzero(before) < 3 or np.count_nonzero(after) < 3:
            continue
        lines = [np.polyfit(series.times[m] - instant, series.values[m], 1) for m in (before, after)]
        found[k] = lines[1][0] - lines[0][0] if order(beside) == 2 else lines[1][1] - lines[0][1]
    return found


def _share(one: _Found, kinks: Array) -> float:
    """How large the readings' edges are beside the simulated ones: at most 1; a weak response hides its switches."""
    if not len(one.sizes) or not np.max(np.abs(kinks), initial=0.0):
        return 0.0
    return float(min(1.0, np.max(np.abs(one.sizes)) / np.max(np.abs(kinks))))


def channel_edges(beside: Beside) -> _Found:
    """Edges of a channel: as many as are worth the price of their instants."""
    at = thinned(beside)
    span = float(at.centres[-1] - at.centres[0])
    price = critical(1.0) + 2.0 * np.log(len(at.centres))
    atoms = [at.means(_atoms(at, order(beside), share * span)) for share in LAGS]
    best: tuple[float, list[int], Array, Array] | None = None
    for ratio in RATIOS:
        taken_off = whitener(at, float(ratio), order(beside))
        white = taken_off(at.values[None])[0]
        for rows in atoms:
            deviance, chosen, sizes, seen = _pursued(taken_off, white, taken_off(rows), beside, price)
            if best is None or deviance < best[0]:
                best = deviance, chosen, sizes, seen
    assert best is not None
    _, chosen, sizes, seen = best
    keep = _apart(chosen, sizes)
    spacing = span / max(len(at.centres) - 1, 1)
    return _Found(at.centres[[chosen[k] for k in keep]], sizes[keep], seen, at.centres, spacing)


def _atoms(at: Thinned, degree: int, lag: float) -> Array:
    """Kinks (or steps) at each block behind a lag [s], shape (blocks, readings)."""
    since = np.maximum(at.times[None, :] - at.centres[:, None], 0.0)
    if degree == 2:
        return since if not lag else since + lag * np.expm1(-since / lag)
    return np.asarray((since > 0.0).astype(float) if not lag else -np.expm1(-since / lag))


def _pursued(
    taken_off: Whitener, white: Array, atoms: Array, beside: Beside, price: float
) -> tuple[float, list[int], Array, Array]:
    """Orthogonal matching pursuit: smallest priced deviance, places, sizes, and the smallest size that is seen."""
    degree = order(beside)
    degrees = len(white) - degree
    constant = taken_off.log_determinant + taken_off.log_trend
    least = 0.25 * beside.channel.deviation**2
    free, left = atoms.copy(), white
    chosen: list[int] = []
    lengths = np.linalg.norm(atoms, axis=1)
    best: tuple[float, list[int], float] | None = None
    for count in range(MOST_EDGES + 1):
        squares = float(left @ left)
        variance = max(squares / (degrees - count), least)
        deviance = (degrees - count) * np.log(variance) + squares / variance + constant + count * price
        if best is None or deviance < best[0]:
            best = deviance, list(chosen), variance
        sizes = np.linalg.norm(free, axis=1)
        scores = np.where(sizes > 1e-3 * lengths, np.abs(free @ left) / np.maximum(sizes, 1e-300), 0.0)
        place = int(np.argmax(scores))
        if not scores[place] > 0.0:
            break
        direction = free[place] / sizes[place]
        left = left - (left @ direction) * direction
        free = free - np.outer(free @ direction, direction)
        chosen.append(place)
    assert best is not None
    deviance, chosen, variance = best
    rows = atoms[chosen]
    sizes = np.linalg.lstsq(rows.T, white, rcond=None)[0] if chosen else np.zeros(0)
    seen = np.sqrt(price * variance) / np.maximum(lengths, 1e-300)
    return float(deviance), chosen, np.asarray(sizes), np.asarray(seen)


def _apart(chosen: list[int], sizes: Array) -> list[int]:
    """Of edges within `NEAR` blocks the largest."""
    kept: list[int] = []
    for k in sorted(range(len(chosen)), key=lambda k: -abs(sizes[k])):
        if all(abs(chosen[k] - chosen[n]) > NEAR for n in kept):
            kept.append(k)
    return kept
