"""The last word of the recordings held out: what makes their prediction worse is not accepted."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from diagnosis.judge.diagnosis import Diagnosis, Verdict

#: Rise of chi-square over all held-out readings by which a finding is refuted: odds of 20000 to 1 against it.
REFUTING = 20.0
#: ... and at least this share of it, for no model of a rig foretells better than that.
SHARE = 0.02


def held_out_chi_square(diagnosis: Diagnosis, stage: str) -> float:
    """Sum of squares over all readings held out, in deviations of their noise.

    Args:
        diagnosis: With fits of held-out recordings.
        stage: `before`, `recalibrated` or `after`.
    """
    return sum(f.chi_square[stage] * f.samples for f in diagnosis.fit if f.is_held_out)


def confirmed(diagnosis: Diagnosis, foretell: Callable[[], Mapping[str, float]] | None = None) -> Diagnosis:
    """The diagnosis, or `cannot tell` where its findings foretell held-out recordings worse than no finding at all.

    Findings stay listed, as what the training recordings suggest. Effects that the priors can absorb show in training
    alone, and are not refuted by that.

    Args:
        diagnosis: What was found.
        foretell: Says how well `recalibrated` and `after` foretell where what belongs to the held-out day alone is
            unknown (`own_numbers.foretold`); it is asked only where the plain chi-square speaks against the findings.
    """
    if not diagnosis.findings or not any(f.is_held_out for f in diagnosis.fit):
        return diagnosis
    without, with_them = (held_out_chi_square(diagnosis, stage) for stage in ("recalibrated", "after"))
    if not _refutes(without, with_them):
        return diagnosis
    if foretell is not None:
        foretold = diagnosis.foretold or dict(foretell())
        diagnosis = replace(diagnosis, foretold=foretold)
        without, with_them = foretold["recalibrated"], foretold["after"]
        if not _refutes(without, with_them):
            return diagnosis
    effects = "; ".join(f.statement for f in diagnosis.findings)
    text = (
        f"The training recordings suggest: {effects}. The recordings held out are foretold worse with it "
        f"(chi-square {with_them:.0f} against {without:.0f}), so it is not accepted."
    )
    return replace(diagnosis, verdict=Verdict.CANNOT_TELL, statement=text)


def _refutes(without: float, with_them: float) -> bool:
    return with_them - without > max(REFUTING, SHARE * without)
