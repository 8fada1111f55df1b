"""A search that knows by how much even the best of its models is wrong."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from cosim.unit import Array
from diagnosis.search.problem import Layout
from diagnosis.search.search import Outcome, Settings, search
from diagnosis.search.validation import Validation
from diagnosis.simulator.masked import MaskedModel
from diagnosis.simulator.models import DiagnosisModel
from diagnosis.simulator.tempered import BELIEVED, TemperedModel, inflation

#: Searches with a tempered likelihood, each with the errors that the one before left.
TEMPERINGS = 2


def search_with_model_error(
    model: DiagnosisModel, settings: Settings, on_progress: Callable[[str], None] = lambda text: None
) -> tuple[Outcome, DiagnosisModel]:
    """Search; where even the model that is found is wrong by more than noise, search again and be told so.

    The readings of a real rig are met far worse than their noise. Then the likelihood is tempered by what the most
    general model leaves, and terms are chosen by how well they foretell stretches of the training that they were not
    fitted to. Where noise is all that is left, nothing of this happens.

    Args:
        model: Model and training recordings.
        settings: Of the search.
        on_progress: Told what is being done.

    Returns:
        The outcome, and the model that it belongs to.
    """
    terms, groups = model.terms(), model.groups()
    outcome = search(model, terms, settings, groups, on_progress)
    factor = _pooled(inflation(outcome.best.fit.residuals, model.layout), model.layout)
    found = model
    for _ in range(TEMPERINGS if factor.max() > BELIEVED else 0):
        on_progress("searching again: no model meets the readings within their noise")
        tempered = TemperedModel(model, factor)
        validation = Validation(tempered, partial(MaskedModel, tempered), on_progress)
        outcome, found = search(tempered, terms, settings, groups, on_progress, validation.select), tempered
        raw = model.residuals([outcome.best.fit.point])[0]
        factor = np.maximum(factor, _pooled(inflation(raw, model.layout), model.layout))
    return outcome, found


def _pooled(found: Array, layout: Layout) -> Array:
    """One inflation for all channels of a quantity (geometric mean): a model errs in all of them alike."""
    kinds = [name.split(" (")[0].rsplit(".", 1)[-1] for name in layout.names]
    means = {k: np.exp(np.mean([np.log(v) for v, other in zip(found, kinds) if other == k])) for k in kinds}
    return np.array([means[k] for k in kinds])
