"""How far an accepted model is trusted: whether other ways are searched, and whether its laws bear names."""

from __future__ import annotations

import numpy as np

from diagnosis.judge.acceptance import Accepted
from diagnosis.judge.doubts import MEASURED
from diagnosis.search.posterior import cost
from diagnosis.search.search import Outcome

#: Structure beyond so many times its limit, and a share of the misfit beyond this, make a name doubtful.
DOUBTFUL, UNEXPLAINED = 1.5, 0.03
#: Chi-square per reading below which errors of the model are smaller than the noise; share of what recalibration
#: leaves that may stay where they are larger.
BURIED, MOST_LEFT = 2.0, 0.1


def is_small(accepted: Accepted) -> bool:
    """Whether what the accepted model leaves of unfitted readings is so little that no other way is searched.

    That is less than the noise of a single reading, or a tenth of what the recalibrated model leaves.
    """
    left, recalibrated = accepted.agreement, accepted.agreement_recalibrated
    return left.chi_square < BURIED or left.excess < MOST_LEFT * recalibrated.excess


def is_settled(accepted: Accepted) -> bool:
    """Whether no other way to describe the training is asked for.

    That is where unfitted readings do not reject the model, or where little is left (`is_small`) and the laws are of
    the rig. A law of a sensor or an input that acts in every recording describes much of what a rig does too: while
    readings reject the model with it, it is no answer, however little is left.
    """
    if not accepted.agreement.is_rejected:
        return True
    is_stopgap = any(t.unit in MEASURED and t.recording is None for t in accepted.explanation.terms)
    return is_small(accepted) and not is_stopgap


def bears_names(accepted: Accepted) -> bool:
    """Whether a law may be called by its name though something is left of unfitted readings.

    Where readings reject the model by what lasts, as little may be left as in training (`is_trusted`): another law than
    the named one explains most of a mismatch too.
    """
    left, recalibrated = accepted.agreement, accepted.agreement_recalibrated
    if not left.is_rejected or left.is_irregular:
        return True
    return left.excess < UNEXPLAINED * recalibrated.excess


def is_trusted(outcome: Outcome) -> bool:
    """Whether the effects found may be called by their names: no name is forced on what still shows structure.

    A name stands where noise is left, or so small a share of the misfit that errors of the model itself explain it.
    """
    if abs(outcome.left.z) <= DOUBTFUL * outcome.left.limit:
        return True
    used = np.count_nonzero(outcome.base.residuals)
    before = cost(outcome.base.residuals, np.zeros(0)) - used
    after = cost(outcome.best.fit.residuals, np.zeros(0)) - used
    return bool(after < UNEXPLAINED * before)
