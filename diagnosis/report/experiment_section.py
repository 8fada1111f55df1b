"""What the channels can tell apart, and the experiment that would decide what they leave open."""

from __future__ import annotations

from diagnosis.judge.isolability import Isolability
from diagnosis.judge.next_experiment import NextExperiment
from diagnosis.report.course_figures import experiment_figure
from diagnosis.report.section import Section, section

#: Most channels whose spread between explanations is listed.
_CHANNELS = 5
#: Faults up to which they are shown as a matrix.
_MATRIX = 24


def experiment_section(experiment: NextExperiment) -> Section:
    """What to do next."""
    picture = experiment_figure(experiment)
    return section("Next experiment", "experiment.html.j2", experiment=experiment, picture=picture)


def isolability_section(told: Isolability) -> Section:
    """Statements, classes of faults, and channels that would help."""
    faults = [(fault, one) for one in told.classes for fault in one.faults]
    return section(
        "What these channels can tell apart",
        "isolability.html.j2",
        statements=told.statements,
        channels=told.extra_channels[:_CHANNELS],
        matrix=faults if 2 <= len(faults) <= _MATRIX else [],
        classes=told.classes,
    )
