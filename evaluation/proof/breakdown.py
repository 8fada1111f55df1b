"""Results of a proof by effect, unit, kind, rig and method: rows of tables."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Sequence

import numpy as np

from evaluation.proof.aims import counted
from evaluation.proof.result import CaseResult
from evaluation.proof.scoring import EffectScore
from evaluation.proof.wilson import Share

UNITS = ("electrical", "thermal", "stiffness", "mechanical", "measurement")
STRENGTHS = ("weak", "medium", "strong")
#: Columns of the comparison of methods.
METHODS = (
    "recalibrated only",
    "gaussian process",
    "sparse regression",
    "diagnosis",
    "knows the effect",
    "without the effect",
    "noise alone",
)


def _fraction(effects: Sequence[EffectScore], asked: Callable[[EffectScore], bool | None]) -> str:
    share = Share.of(asked(e) for e in effects)
    return f"{share.hits} of {share.total}" if share.total else ""


def _by_truth(results: Sequence[CaseResult]) -> dict[str, list[tuple[CaseResult, EffectScore]]]:
    found: dict[str, list[tuple[CaseResult, EffectScore]]] = {}
    for result in counted(results):
        for effect in result.score.effects:
            found.setdefault(effect.effect, []).append((result, effect))
    return found


def by_effect(results: Sequence[CaseResult]) -> list[tuple[object, ...]]:
    """Rows by effect that can be named: the least often named first, then the least often in its unit."""
    rows: list[tuple[float, float, str, tuple[object, ...]]] = []
    for name, pairs in _by_truth(results).items():
        effects = [e for _, e in pairs if e.is_known]
        if not effects:
            continue
        gains = [r.reference.training_gain for r, e in pairs if e.is_known and len(r.score.effects) == 1]
        instead = Counter(e.found or "-" for e in effects if not e.is_named).most_common(3)
        cells: tuple[object, ...] = (
            name,
            effects[0].unit,
            *(_fraction([e for e in effects if e.strength == s], lambda e: e.is_named) for s in STRENGTHS),
            _fraction(effects, lambda e: e.is_unit_right),
            _fraction(effects, lambda e: e.is_place_right),
            _fraction(effects, lambda e: e.is_in_class),
            _median([g for g in gains if g is not None]),
            ", ".join(f"{n} ({c})" if c > 1 else n for n, c in instead),
        )
        named, unit = Share.of(e.is_named for e in effects), Share.of(e.is_unit_right for e in effects)
        rows.append((named.value, unit.value, name, cells))
    return [cells for *_, cells in sorted(rows, key=lambda row: row[:3])]


def unit_matrix(results: Sequence[CaseResult]) -> tuple[tuple[str, ...], list[tuple[object, ...]]]:
    """Header and rows: unit of the truth against unit of the finding."""
    counts = Counter((e.unit, e.found_unit or "nothing") for r in counted(results) for e in r.score.effects)
    header: tuple[str, ...] = ("", *UNITS, "nothing")
    rows: list[tuple[object, ...]] = [
        (u, *(counts[u, f] or "" for f in header[1:])) for u in UNITS if any(counts[u, f] for f in header[1:])
    ]
    return header, rows


def confusions(results: Sequence[CaseResult]) -> list[tuple[object, ...]]:
    """Truth, finding and number of cases, for all that were not named; the most frequent first."""
    counts = Counter(
        (e.effect + ("" if e.is_known else " (unnamed)"), e.found or "-")
        for r in counted(results)
        for e in r.score.effects
        if not e.is_named
    )
    return [(truth, found, n) for (truth, found), n in sorted(counts.items(), key=lambda item: (-item[1], item[0]))]


def by_kind(results: Sequence[CaseResult]) -> list[tuple[object, ...]]:
    """Kind, cases, verdicts that are right, headlines that are true, all verdicts, findings that stand for nothing."""
    rows: list[tuple[object, ...]] = []
    for kind in dict.fromkeys(r.kind for r in results):
        cases = [r for r in counted(results) if r.kind == kind]
        verdicts = Counter(r.score.verdict or r.outcome for r in cases)
        told = ", ".join(f"{n} {v}" for v, n in verdicts.most_common())
        share = Share.of(r.score.is_verdict_right for r in cases)
        true = Share.of(r.score.is_headline_true for r in cases)
        rows.append((kind, len(cases), share, true, told, sum(r.score.spare for r in cases)))
    return rows


def by_verdict(results: Sequence[CaseResult]) -> list[tuple[object, ...]]:
    """Verdict, cases that got it, and headlines of it that are true."""
    rows: list[tuple[object, ...]] = []
    told = [r for r in counted(results) if r.score.verdict]
    for verdict in sorted({r.score.verdict for r in told}):
        cases = [r for r in told if r.score.verdict == verdict]
        rows.append((verdict, len(cases), Share.of(r.score.is_headline_true for r in cases)))
    return rows


def by_sabotage(results: Sequence[CaseResult]) -> list[tuple[object, ...]]:
    """Sabotage, cases, those refused in words, verdicts that are right, false claims, and all verdicts."""
    rows: list[tuple[object, ...]] = []
    for kind in sorted({r.score.sabotage for r in results if r.score.sabotage}):
        cases = [r for r in results if r.score.sabotage == kind]
        diagnosed = [r for r in cases if not r.is_refused]
        told = Counter(r.score.verdict or r.outcome for r in cases).most_common()
        right = Share.of(r.score.is_verdict_right for r in diagnosed)
        false = sum(bool(r.score.is_false_claim) for r in diagnosed)
        verdicts = ", ".join(f"{n} {v}" for v, n in told)
        rows.append((kind, len(cases), len(cases) - len(diagnosed), right if right.total else "", false, verdicts))
    return rows


def is_all_right(result: CaseResult) -> bool:
    """Whether verdict, units, elements, times and names are right, and nothing else was found."""
    answers = [
        a for e in result.score.effects for a in (e.is_unit_right, e.is_place_right, e.is_time_right, e.is_named)
    ]
    is_clean = not result.score.is_false_alarm and all(not e.is_misnamed for e in result.score.effects)
    return result.score.is_verdict_right and is_clean and all(a is not False for a in answers)


def by_rig(results: Sequence[CaseResult]) -> list[tuple[object, ...]]:
    """Rig, engine, cases, those that are all right, false alarms, and times of the diagnosis [s]."""
    rows: list[tuple[object, ...]] = []
    for rig, engine in sorted({(r.setup, r.engine) for r in counted(results)}):
        cases = [r for r in counted(results) if (r.setup, r.engine) == (rig, engine)]
        alarms = Share.of(r.score.is_false_alarm for r in cases)
        times = [r.seconds for r in cases]
        right = Share.of(is_all_right(r) for r in cases)
        rows.append((rig, engine, len(cases), right, alarms if alarms.total else "", _median(times), max(times)))
    return rows


def by_method(results: Sequence[CaseResult]) -> list[tuple[object, ...]]:
    """Kind, cases, median held-out chi-square of every method, forecasts that ran away, and terms."""
    rows: list[tuple[object, ...]] = []
    for kind in dict.fromkeys(r.kind for r in results):
        cases = [r for r in counted(results) if r.kind == kind and r.reference.recalibrated is not None]
        if not cases:
            continue
        columns = zip(*(_held_out(r) for r in cases))
        runaways = sum(
            1
            for r in cases
            if "sparse regression" in r.reference.baselines and r.reference.baselines["sparse regression"] is None
        )
        terms = _median([r.reference.terms for r in cases if r.reference.terms is not None])
        medians = [_median([math.inf if v is None else v for v in c if v != ""]) for c in columns]
        rows.append((kind, len(cases), *medians, runaways, terms))
    return rows


def _held_out(result: CaseResult) -> tuple[float | str | None, ...]:
    """Held-out chi-square by method, `METHODS`; None: it ran away or there is no diagnosis; empty: not asked."""
    reference = result.reference
    others = [reference.baselines.get(n, "") for n in METHODS[1:3]]
    oracle = "" if reference.oracle is None else reference.oracle
    twin = "" if reference.twin is None else reference.twin
    return (reference.recalibrated, *others, result.score.held_out.after, oracle, twin, reference.floor)


def _median(values: Sequence[float | str]) -> float | None:
    numbers = [float(v) for v in values]
    return float(np.median(numbers)) if numbers else None
