"""What a search tried, by domain, and what it could not try."""

from __future__ import annotations

from collections.abc import Sequence

from cosim.components import ProgrammeComponent
from cosim.scenario import Scenario
from diagnosis.judge.diagnosis import Domain, Searched
from diagnosis.search.problem import Term
from diagnosis.search.shares import is_own
from diagnosis.simulator.models import DiagnosisModel


def searched(model: DiagnosisModel, scenario: Scenario, without: Sequence[str]) -> Searched:
    """Laws and places that were tried, and what offers no place for a law.

    Args:
        model: Model of the training recordings.
        scenario: What was diagnosed.
        without: Effects that were left out on demand.
    """
    by_domain: dict[str, list[Term]] = {}
    for term in model.terms():
        if term.is_completing:  # a basis, not laws that were tried one by one
            continue
        by_domain.setdefault(term.unit, []).append(term)
    domains = tuple(
        Domain(
            name,
            len({t.identifier for t in terms}),
            len({t.identifier for t in terms if not t.is_named}),
            len({t.place for t in terms}),
        )
        for name, terms in sorted(by_domain.items())
    )
    untried = [f"`{effect}` was left out on demand" for effect in without]
    if not any(d.laws for d in domains if d.name not in ("measurement", "input")):
        units = [n for n, c in scenario.components.items() if not isinstance(c, ProgrammeComponent)]
        untried += [f"`{name}` ({scenario.components[name].kind}) offers no place for a law" for name in units]
    if not any(not is_own(p.name) for p in model.parameters):
        untried.append("no parameter of the scenario states an uncertainty, so none was recalibrated")
    return Searched(domains, tuple(untried))
