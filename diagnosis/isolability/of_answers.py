"""What the channels of a model that costs seconds a run can show and tell apart, and what one more kind would add.

The search has simulated the effects from several starts, and every run gives the channels that nobody recorded too.
Effects are compared at the largest size that is believed, in proportion to what they changed where they were simulated.
The size of a change and the angle between two are taken from different starts against different halves of the ensemble,
so that contact scatter cancels in the mean; what the model's own parameters would do as well is projected out.

Source: angles between subspaces, A. Björck and G. H. Golub, Math. Comput. 27 (1973) 579-594; products of independent
repeats as estimates without bias, as in cross-validated Mahalanobis distances, A. Walther et al., NeuroImage 137 (2016)
188-200.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.isolability.alike import APART, SHOWS
from diagnosis.judge.isolability import ExtraChannel, Isolability
from diagnosis.models.answers import Answers
from diagnosis.models.fabric.scatter import Bins, Whitening, engine_covariance, scatter_covariance
from diagnosis.search.problem import Term

#: Fewest starts of an effect from which its size is known without what contacts scatter by.
STARTS = 2
#: Effects and pairs that a sentence lists.
LISTED = 6
#: Fall of -2 log posterior below which no search accepts an effect, whatever the fabric scatters by.
ACCEPTED = 20.0
#: How many times what the sizes of nothing scatter by an effect that shows has to be beyond its limit.
SURE = 2.0
#: Share of an effect that recalibration has to leave, or it is said to be absorbed.
ABSORBED = 0.1


@dataclass(frozen=True)
class _Told:
    """What some channels tell.

    Args:
        gains: Fall of -2 log posterior that each effect would give, recalibration taken away, shape (effects,).
        whole: The same with nothing taken away, shape (effects,).
        apart: Fall that remains for one effect of a pair against the other, refitted, shape (effects, effects).
        absorbing: Number of the parameter that takes most of each effect, shape (effects,).
        errors: What contacts scatter the gains by, shape (effects,).
    """

    gains: Array
    whole: Array
    apart: Array
    absorbing: list[int]
    errors: Array

    def shows(self, effect: int) -> bool:
        """Whether an effect shows, by more than what its size scatters by."""
        return bool(self.gains[effect] > SHOWS + SURE * self.errors[effect])

    def hides(self, effect: int) -> bool:
        """Whether an effect would not be accepted; few starts may leave both open."""
        return bool(self.gains[effect] + self.errors[effect] < ACCEPTED)

    def tells(self, one: int, other: int) -> bool:
        """Whether two effects are told apart."""
        return bool(self.apart[one, other] > APART + SURE * max(self.errors[one], self.errors[other]))


def of_answers(answers: Answers) -> Isolability:
    """What is shown and told apart by what is recorded, and by one group of channels more.

    Args:
        answers: Of the search.
    """
    every = [(t, s) for t, own in answers.effects.items() if (s := _strength(own)) is not None]
    if not every:
        return Isolability()
    now = _told(answers, every, "")
    names = [_words(t, s * _larger(t, s)) for t, s in every]
    count = range(len(every))
    hidden = [i for i in count if now.hides(i)]
    shown = [i for i in count if now.shows(i)]
    mixed = [(a, b) for a, b in itertools.combinations(shown, 2) if not now.tells(a, b)]
    statements = []
    if hidden:
        unseen = [_hidden(answers, now, names, i) for i in hidden]
        statements.append(f"These channels do not show, up to the size that is believed at most: {_listed(unseen)}.")
    if mixed:
        statements.append(
            f"These channels hardly tell apart: {_listed([f'{names[a]} and {names[b]}' for a, b in mixed])}."
        )
    dim = [i for i in count if not now.shows(i)]
    extra = _extras(answers, every, names, now, (dim, mixed))
    statements += [e.statement for e in extra[:1]]
    return Isolability(tuple(statements), (), tuple(extra))


def _extras(
    answers: Answers,
    every: Sequence[tuple[Term, float]],
    names: Sequence[str],
    now: _Told,
    lacking: tuple[list[int], list[tuple[int, int]]],
) -> list[ExtraChannel]:
    """Groups of channels that would show more or tell more apart, the best first."""
    dim, mixed = lacking
    found = []
    for extra in answers.extras:
        then = _told(answers, every, extra)
        seen = [i for i in dim if then.shows(i)]
        parted = [(a, b) for a, b in mixed if then.tells(a, b)]
        if not seen and not parted:
            continue
        gives = [f"show {_listed([names[i] for i in seen])}"] if seen else []
        gives += [f"tell {_listed([f'{names[a]} from {names[b]}' for a, b in parted])}"] if parted else []
        text = f"Other channels that would help are {extra}: they would {' and '.join(gives)}."
        rises = float(np.sum(np.log((1.0 + then.gains) / (1.0 + now.gains))))
        found.append(((len(seen) + len(parted), rises), ExtraChannel(extra, len(seen) + len(parted), text)))
    return [e for _, e in sorted(found, key=lambda one: one[0], reverse=True)]


def _larger(term: Term, strength: float) -> float:
    """How many times a strength the largest one is that is believed, at least 1."""
    number = term.parameters[0]
    return max(1.0, min(number.plausible, number.upper) / abs(strength))


def _strength(own: Mapping[float, Array]) -> float | None:
    """The largest strength that was simulated from several starts; None where there is none."""
    known = [s for s, rows in own.items() if len(rows) >= STARTS]
    return max(known, key=abs) if known else None


def _told(answers: Answers, every: Sequence[tuple[Term, float]], extra: str) -> _Told:
    chosen = answers.chosen(extra)
    bins = answers.bins.only(chosen)
    members = answers.members[:, chosen]
    engines = None if answers.difference is None else engine_covariance(answers.difference[chosen], bins)
    whiten = _whitening(members, bins, engines)
    halves = members[0::2].mean(axis=0), members[1::2].mean(axis=0)
    first, second = (
        [whiten(answers.effects[t][s][:, chosen] - half) for t, s in every] for half in halves
    )  # of each effect, shape (starts, bins)
    slopes = whiten(answers.slopes[:, chosen]) if len(answers.slopes) else np.zeros((0, int(np.sum(chosen))))
    larger = np.array([_larger(t, s) for t, s in every])
    whole = _products(first, second) * np.outer(larger, larger)
    means = np.array([0.5 * k * (a.mean(axis=0) + b.mean(axis=0)) for k, a, b in zip(larger, first, second)])
    across = means @ slopes.T
    absorbed = np.linalg.solve(np.eye(len(slopes)) + slopes @ slopes.T, across.T).T
    gram = whole - absorbed @ across.T
    gains = np.maximum(np.diag(gram), 0.0)
    size = np.sqrt(np.outer(gains, gains))
    cosine = np.clip(np.divide(gram, size, out=np.zeros_like(gram), where=size > 0.0), -1.0, 1.0)
    apart = np.minimum.outer(gains, gains) * (1.0 - cosine**2)
    takes = [int(np.argmax(row)) if row.size else -1 for row in absorbed * across]
    nothing = [_of_nothing(members, turn, bins, engines) for turn in range(len(members))]
    errors = larger**2 * float(np.sqrt(np.mean(np.square(nothing))))
    return _Told(gains, np.maximum(np.diag(whole), 0.0), apart, takes, errors)


def _whitening(members: Array, bins: Bins, engines: Array | None) -> Whitening:
    covariance = scatter_covariance(members, bins)
    return Whitening(covariance if engines is None else covariance + engines, bins.noise)


def _of_nothing(members: Array, turn: int, bins: Bins, engines: Array | None) -> float:
    """Size of no effect, by `STARTS` members against the halves of the others, whose scatter is all that is known."""
    turned = np.roll(members, turn, axis=0)
    own, others = turned[:STARTS], turned[STARTS:]
    whiten = _whitening(others, bins, engines)
    first, second = (whiten(own - others[k::2].mean(axis=0)) for k in (0, 1))
    return float(_products([first], [second])[0, 0])


def _products(first: Sequence[Array], second: Sequence[Array]) -> Array:
    """Inner products of changes, of other starts and against other halves of the ensemble, shape (effects, effects)."""
    count = len(first)
    found = np.zeros((count, count))
    for a, b in itertools.product(range(count), repeat=2):
        products = first[a] @ second[b].T
        kept = ~np.eye(len(products), dtype=bool) if a == b else np.ones(products.shape, dtype=bool)
        found[a, b] = float(products[kept].mean())
    return 0.5 * (found + found.T)


def _words(term: Term, strength: float) -> str:
    """An effect and its size.

    >>> from diagnosis.search.problem import TermParameter
    >>> _words(Term("roll", "fabric", "mechanical", (TermParameter("roll", "rad", -0.5, 0.5, (0.1,)),)), -0.25)
    'roll (0.25 rad)'
    """
    unit = term.parameters[0].unit
    return f"{term.identifier.replace('_', ' ')} ({abs(strength):.2g}{f' {unit}' if unit != '1' else ''})"


def _hidden(answers: Answers, now: _Told, names: Sequence[str], effect: int) -> str:
    """An effect that does not show, and what takes it."""
    if now.whole[effect] > SHOWS and now.gains[effect] < ABSORBED * now.whole[effect] and now.absorbing[effect] >= 0:
        return f"{names[effect]} as recalibrating {answers.names[now.absorbing[effect]]} does the same"
    return names[effect]


def _listed(items: Sequence[str]) -> str:
    more = f" and {len(items) - LISTED} more" if len(items) > LISTED else ""
    return "; ".join(items[:LISTED]) + more
