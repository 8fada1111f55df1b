"""Other ways to describe the training, for readings of another recording to decide between.

A search takes what the training recordings make the most probable. Where the model lacks the law itself, that is a
poor judge: faults of one recording pass for a law that acts in all of them, and of two wrong laws the better fit may
predict worse. Where the recordings that were held out reject the answer, and by more than a small remainder, they are
asked about others too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from diagnosis.faults.given import LawsOnly, lasting_laws
from diagnosis.model_error import laws_that_predict, pooled, refitted
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.models.wrappers.quasi_likelihood import BELIEVED, QuasiLikelihoodModel, inflation
from diagnosis.search.complete import MOST, MOST_SLOW, by_few_terms, completed
from diagnosis.search.explanation import Explanation
from diagnosis.search.problem import Term
from diagnosis.search.search import Outcome, Settings, search, shrink
from diagnosis.search.structure import structure


def other_ways(
    model: DiagnosisModel, outcome: Outcome, settings: Settings, on_progress: Callable[[str], None] = lambda text: None
) -> Iterator[tuple[Outcome, DiagnosisModel]]:
    """Outcomes with the models that they belong to, one after the other as they are asked for.

    1. Laws that hold in all recordings alone: those found before the errors of the model were taken into account, or,
       where something of one recording was among them (a fault, an event), those that are found without such.
    2. Where such was found though the model errs by more than noise: the same laws by how well they predict stretches
       that they were not fitted to. A fault that fills a gap takes what laws would explain.
    3. One or two generic terms in the place of all laws that were found: laws that bend towards a missing one hide it.
    4. Those of the first way with a sum of generic terms for what they leave (`diagnosis.search.complete`).

    Args:
        model: Model of the training recordings with the noise of the sensors, as it was searched.
        outcome: What the search gave.
        settings: Of the search.
        on_progress: Told what is being done.
    """
    laws = LawsOnly(model)
    terms = lasting_laws(model)
    lasting = set(terms)
    first = outcome.first or outcome
    is_of_training = any(t not in lasting for e in (outcome.best, first.best) for t in e.terms)
    if is_of_training:
        on_progress("searching laws that hold in all recordings alone")
        first = search(laws, terms, settings, model.groups(), on_progress)
    if is_of_training or outcome.first is not None:
        honest, errs = _honest(laws, first)
        yield honest, errs
        if is_of_training and outcome.first is not None and errs is not laws:
            predicting, errs = laws_that_predict(laws, first, terms, settings, on_progress)
            yield replace(predicting, first=first), errs
    known = [set(first.best.terms)]
    for whole in _by_generic_terms(laws, first, terms, settings, on_progress):
        if set(whole.terms) not in known:
            known.append(set(whole.terms))
            left = structure(whole.fit.residuals, model.layout, model.groups())
            yield _honest(laws, replace(first, best=whole, left=left, rivals=(whole, *first.rivals)))


def _by_generic_terms(
    laws: DiagnosisModel,
    first: Outcome,
    terms: Sequence[Term],
    settings: Settings,
    on_progress: Callable[[str], None],
) -> Iterator[Explanation]:
    """Explanations with generic terms in the place of what was found, and beside it."""
    if first.best.terms:
        yield first.few or by_few_terms(laws, first.base, terms, settings, first.margin, on_progress)
    if not first.left.is_noise:
        most = MOST if laws.is_fast else MOST_SLOW
        whole = completed(laws, first.best, terms, settings, first.margin, on_progress, most)
        yield shrink(laws, whole, first.margin)


def _honest(model: DiagnosisModel, outcome: Outcome) -> tuple[Outcome, DiagnosisModel]:
    """The outcome with errors as large as it leaves, where noise does not explain them."""
    factor = pooled(inflation(outcome.best.fit.residuals, model.layout), model.layout)
    if factor.max() <= BELIEVED:
        return outcome, model
    found = QuasiLikelihoodModel(model, factor)
    return refitted(found, outcome), found
