"""The aims of the diagnosis, and what of them a proof reaches."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from evaluation.proof.headline import VISIBLE
from evaluation.proof.result import CaseResult
from evaluation.proof.scoring import EffectScore
from evaluation.proof.wilson import Share

#: Cases of a kind that a share of wrong ones must be of.
FEWEST_NULLS, FEWEST_SABOTAGED = 100, 60


@dataclass(frozen=True)
class Aim:
    """A share that is wanted.

    Args:
        name: In plain words.
        low: Least share that is wanted.
        high: Largest share that is wanted.
        share: Reached.
        visible: Reached where the true terms lower -2 log posterior by at least `VISIBLE`; None where that makes no
            sense.
        fewest: Cases that the share must be of.
    """

    name: str
    low: float
    high: float
    share: Share
    visible: Share | None = None
    fewest: int = 1

    @property
    def is_reached(self) -> bool:
        """Whether the share lies within what is wanted, of enough cases."""
        return self.share.total >= self.fewest and self.low <= self.share.value <= self.high

    @property
    def wanted(self) -> str:
        """As text."""
        if self.low == 0.0:
            return f"at most {100 * self.high:.0f} % of at least {self.fewest}"
        if self.high < 1.0:
            return f"{100 * self.low:.0f} to {100 * self.high:.0f} %"
        return f"{100 * self.low:.0f} %"


def counted(results: Sequence[CaseResult]) -> list[CaseResult]:
    """Cases that count: those whose scenario was not refused. What failed counts as wrong."""
    return [r for r in results if not r.is_refused]


def is_visible(result: CaseResult) -> bool:
    """Whether the data show the effect to one who knows it."""
    gain = result.reference.training_gain
    return gain is not None and gain >= VISIBLE


def aims(results: Sequence[CaseResult]) -> list[Aim]:
    """What issue and documents ask for, and what is reached."""
    cases = counted(results)
    named = [r for r in cases if r.kind in ("single", "sensor")]
    nulls = [r for r in cases if r.kind in ("null", "parameters")]
    two = [r for r in cases if r.kind == "two"]
    sabotaged = [r for r in results if r.kind == "sabotaged"]
    found = [
        _of_effects("unit right", 0.95, named, lambda e: e.is_unit_right),
        _of_effects("element right", 0.9, named, lambda e: e.is_place_right),
        _of_effects("time right", 0.9, named, lambda e: e.is_time_right),
        _of_effects("named first", 0.85, named, lambda e: e.is_named),
        _of_effects("within the ambiguity class", 0.95, named, lambda e: e.is_in_class),
        Aim("false alarms", 0.0, 0.05, Share.of(r.score.is_false_alarm for r in nulls), fewest=FEWEST_NULLS),
        # A refusal in words claims nothing.
        Aim(
            "false claims on sabotaged recordings",
            0.0,
            0.02,
            Share.of(r.score.is_false_claim and not r.is_refused for r in sabotaged),
            fewest=FEWEST_SABOTAGED,
        ),
        Aim("headline true, all kinds", 0.95, 1.0, Share.of(r.score.is_headline_true for r in cases)),
        _of_cases(
            "held-out chi-square within 1.1 times of the model that knows the effect",
            0.9,
            [*named, *two],
            lambda r: r.score.held_out.is_as_good,
        ),
        _of_cases("both of two effects", 0.7, two, lambda r: all(bool(e.is_named) for e in r.score.effects)),
    ]
    for kind, word, gain in (
        ("outside", "outside the catalogue", 0.8),
        ("composed", "composed laws", 0.8),
        ("leave_one_out", "left out of the catalogue", 0.9),
    ):
        part = [r for r in cases if r.kind == kind]
        found += [
            _of_effects(f"{word}: unit right", 0.9, part, lambda e: e.is_unit_right),
            _of_effects(f"{word}: not misnamed", 0.9, part, _is_not_misnamed),
            _of_cases(
                f"{word}: 80 % of the possible held-out gain", gain, part, lambda r: r.score.held_out.is_share_enough
            ),
        ]
    covered = [c for r in cases for e in r.score.effects for c in e.covered]
    return [*found, Aim("95 % intervals that hold the true parameter", 0.9, 0.99, Share.of(covered))]


def _is_not_misnamed(effect: EffectScore) -> bool | None:
    return None if effect.is_misnamed is None else not effect.is_misnamed


def _of_effects(name: str, low: float, cases: Sequence[CaseResult], asked: Callable[[EffectScore], bool | None]) -> Aim:
    def share(chosen: Iterable[CaseResult]) -> Share:
        return Share.of(asked(e) for r in chosen for e in r.score.effects)

    return Aim(name, low, 1.0, share(cases), share(r for r in cases if is_visible(r)))


def _of_cases(name: str, low: float, cases: Sequence[CaseResult], asked: Callable[[CaseResult], bool | None]) -> Aim:
    return Aim(name, low, 1.0, Share.of(asked(r) for r in cases), Share.of(asked(r) for r in cases if is_visible(r)))
