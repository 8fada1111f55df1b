"""Other laws in the place of what was found, so that what the recordings do not tell apart is known."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from cosim.compute.steps import counted
from diagnosis.search.explanation import Explanation
from diagnosis.search.fit import Fit, fit
from diagnosis.search.grow import fitted_with
from diagnosis.search.problem import Model, Term
from diagnosis.search.score import Projection, score

#: Share of what the straight line promises of the law that was found, from which another one is fitted, and how many
#: are: those whose promise is nearest to its own, for a law that does the same promises the same.
PROMISING, MOST = 0.5, 6
#: Rise of -2 log posterior in a rough fit from which another law is given up.
FAR = 60.0


def in_their_places(
    model: Model, found: Fit, without: Mapping[Term, Fit], terms: Sequence[Term]
) -> dict[Term, list[tuple[Term, Explanation]]]:
    """Other named laws, at any place, in the place of each that was found, with the explanations that have them.

    A search grows from few explanations: what came first was compared with others before the rest was there, and never
    again. Where motion never turns, a constant force is dry friction or an offset of the input, and only a fit in its
    place, all others kept, says so.

    Args:
        model: Model and training recordings.
        found: Fit of what was found.
        without: Fits without each of its terms.
        terms: Laws that were looked for.
    """
    others: dict[Term, list[tuple[Term, Explanation]]] = {}
    laws = [t for t in found.point.terms if t.is_named and t.recording is None and t.unit != "measurement"]
    rivals = [t for t in terms if t.is_named and t.recording is None and t not in found.point.terms]
    for term in counted(laws if rivals else (), "laws exchanged"):
        projection = Projection(without[term])
        projection.noise(0, 0)
        ranked = score(model, without[term], [term, *rivals], projection=projection).ranked
        own = next((s.gain for s in ranked if s.term == term), 0.0)
        near = [s for s in ranked if s.term != term and s.gain > PROMISING * own]
        for candidate in sorted(near, key=lambda s: abs(s.gain - own))[:MOST]:
            rough = fitted_with(model, without[term], candidate)
            if rough.cost - found.cost < FAR:
                whole = Explanation(fit(model, rough.point, widths=found.widths))
                others.setdefault(term, []).append((candidate.term, whole))
    return others
