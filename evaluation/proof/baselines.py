"""What other methods reach on the same data: recalibrated model plus a Gaussian process, or plus SINDy's terms."""

from __future__ import annotations

import time as clock
from collections.abc import Sequence

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.judge.held_out import carried_over
from diagnosis.search.fit import Fit
from evaluation.proof import gaussian_process, sparse_regression
from evaluation.proof.oracle import Data
from evaluation.proof.variables import Course, courses


def baselines(data: Data, base: Fit) -> tuple[dict[str, float | None], float, dict[str, float]]:
    """Held-out chi-square per sample by method, terms that SINDy reports per channel, and seconds by method.

    Args:
        data: The same recordings as the diagnosis has.
        base: Recalibrated model without terms.
    """
    training = courses(data.model, base.point)
    held_out = courses(data.judge, carried_over(base.point, data.model, data.judge))
    begin = clock.perf_counter()
    by_process = gaussian_process.predict(training, held_out)
    between = clock.perf_counter()
    by_terms, terms = sparse_regression.predict(training, held_out)
    end = clock.perf_counter()
    values: dict[str, float | None] = {
        "gaussian process": _chi_square(held_out, by_process),
        "sparse regression": _chi_square(held_out, by_terms),
    }
    return values, terms, {"gaussian process": between - begin, "sparse regression": end - between}


def _chi_square(held_out: Sequence[Course], predicted: Sequence[Array]) -> float | None:
    """Mean over all samples that count; None where it is not finite."""
    left = np.concatenate([(c.residuals - p)[c.used] for c, p in zip(held_out, predicted)])
    mean = float(np.mean(left**2))
    return mean if np.isfinite(mean) else None
