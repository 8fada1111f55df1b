"""Other laws in the place of what was found, so that what the recordings do not tell apart is known."""

from __future__ import annotations

from collections.abc import Sequence

from cosim.compute.steps import counted
from diagnosis.search.explanation import Explanation
from diagnosis.search.fit import fit
from diagnosis.search.grow import fitted_with
from diagnosis.search.problem import Model, Term
from diagnosis.search.score import Projection, score

#: Share of what the straight line promises of the law that was found, from which another one is fitted; and how many.
PROMISING, MOST = 0.5, 5
#: Rise of -2 log posterior in a rough fit from which another law is given up.
FAR = 60.0


def in_its_place(model: Model, found: Explanation, terms: Sequence[Term]) -> list[Explanation]:
    """Explanations with another named law at the very place of one of several, all others kept.

    A search grows from few explanations: what came first was compared with others before the rest was there, and never
    again. Where motion never turns, a constant force is dry friction, and only a fit in its place says so.

    Args:
        model: Model and training recordings.
        found: What was found, with the fits without each of its terms.
        terms: Laws that were looked for.
    """
    others: list[Explanation] = []
    laws = [t for t in found.terms if t.is_named and t.recording is None]
    for term in counted(laws if len(found.terms) > 1 else (), "laws exchanged"):
        at_place = [t for t in terms if t.is_named and t.place == term.place and t.unit == term.unit]
        rivals = [t for t in at_place if t.recording is None and t not in found.terms]
        before = found.without.get(term)
        if before is None or not rivals:
            continue
        projection = Projection(before)
        projection.noise(0, 0)
        ranked = score(model, before, [term, *rivals], projection=projection).ranked
        own = next((s.gain for s in ranked if s.term == term), 0.0)
        near = [s for s in ranked if s.term != term and s.gain > PROMISING * own][:MOST]
        for candidate in near:
            rough = fitted_with(model, before, candidate)
            if rough.cost - found.fit.cost < FAR:
                others.append(Explanation(fit(model, rough.point, widths=found.fit.widths)))
    return others
