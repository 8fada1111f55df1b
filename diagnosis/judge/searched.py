"""What a search tried, by domain, and what it could not try."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

import numpy as np

from cosim.components import ProgrammeComponent
from cosim.scenario import Scenario
from diagnosis.faults.law import AGAIN
from diagnosis.judge.diagnosis import Domain, Searched
from diagnosis.judge.doubts import MEASURED
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.search.problem import Point, Term, strength_slopes


def searched(model: DiagnosisModel, scenario: Scenario, without: Sequence[str], base: Point | None = None) -> Searched:
    """Laws and places that were tried, and what offers no place for a law.

    A domain of which no law changes any reading (circuits, where heaters are given their power) was not tried.

    Args:
        model: Model of the training recordings.
        scenario: What was diagnosed.
        without: Effects that were left out on demand.
        base: The recalibrated model; None: every domain counts.
    """
    by_domain: dict[str, list[Term]] = {}
    for term in (*model.terms(), *model.faults()):
        if term.is_completing:  # a basis, not laws that were tried one by one
            continue
        by_domain.setdefault(term.unit, []).append(term)
    unseen = []
    if base is not None and model.is_fast:
        unseen = [n for n, terms in sorted(by_domain.items()) if n not in MEASURED and not _shows(model, base, terms)]
    domains = tuple(
        Domain(
            name,
            len({t.identifier for t in terms}),
            len({t.identifier for t in terms if not t.is_named}),
            len({t.place.removesuffix(AGAIN) for t in terms}),
        )
        for name, terms in sorted(by_domain.items())
        if name not in unseen
    )
    untried = [f"`{effect}` was left out on demand" for effect in without]
    untried += [f"no {name} law changes what these channels measure" for name in unseen]
    if not model.untried and not any(by_domain[name] for name in by_domain if name not in MEASURED):
        units = [n for n, c in scenario.components.items() if not isinstance(c, ProgrammeComponent)]
        untried += [f"`{name}` ({scenario.components[name].kind}) offers no place for a law" for name in units]
    untried += model.untried
    if not any(p.own is None for p in model.parameters):
        untried.append(
            "nothing was recalibrated: no number with a stated uncertainty moves these readings, nor does one of an "
            "FMU that compiled code simulates"
        )
    return Searched(domains, tuple(untried))


def _shows(model: DiagnosisModel, base: Point, terms: Sequence[Term]) -> bool:
    """Whether any of these laws changes any reading: one of each kind first, then all at all start values."""
    first = {t.identifier: t for t in reversed(terms)}
    some = [(t, tuple(p.starts[0] for p in t.parameters)) for t in first.values()]
    return _moves(model, base, some) or _moves(model, base, list(_every(terms)))


def _every(terms: Sequence[Term]) -> Iterator[tuple[Term, tuple[float, ...]]]:
    for term in terms:
        for values in itertools.product(*(p.starts for p in term.parameters)):
            yield term, values


def _moves(model: DiagnosisModel, base: Point, tasks: Sequence[tuple[Term, tuple[float, ...]]]) -> bool:
    slopes = strength_slopes(model, base, None, tasks)
    return bool(np.any(slopes[np.isfinite(slopes)] != 0.0))
