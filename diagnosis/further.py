"""What helps to decide beside the verdict: what the channels tell apart, where units depart, the next experiment."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from cosim.compute.steps import TimeIsOver, may_be_left
from cosim.scenario import Scenario
from cosim.unit.protocol import UnitError
from diagnosis.experiment.design import next_experiment
from diagnosis.isolability.isolability import isolability
from diagnosis.judge.acceptance import Accepted
from diagnosis.judge.isolability import Isolability
from diagnosis.judge.next_experiment import NextExperiment
from diagnosis.locate.locate import Located, locate
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.recording.recording import Recording
from diagnosis.search.search import Outcome

T = TypeVar("T")


@dataclass
class Further:
    """What is known beside the verdict; what did not come about has its default and a note that says why.

    Args:
        told_apart: What these channels can tell apart.
        located: Where units that are driven alone depart.
        experiment: What would decide between what is left open.
        notes: Of what did not come about.
    """

    told_apart: Isolability
    located: Located
    experiment: NextExperiment | None
    notes: tuple[str, ...] = ()

    def _made(self, what: str, make: Callable[[], T], otherwise: T) -> T:
        """What is made; where a simulation of it fails, what stands in its place, and a note.

        The verdict is known by then: it is not lost because a model that meets the recordings cannot be simulated
        elsewhere.
        """
        try:
            return make()
        except (ArithmeticError, np.linalg.LinAlgError, UnitError) as error:
            self.notes = (*self.notes, f"{what} is left out: {error}.")
            return otherwise


def further(
    scenario: Scenario,
    model: DiagnosisModel,
    recordings: Sequence[Recording],
    found: tuple[Outcome, Accepted],
    seed: int,
    limits: Mapping[str, float],
    on_progress: Callable[[str], None],
) -> Further:
    """What helps to decide, as far as there is time.

    Args:
        scenario: The model as it is.
        model: Of the training recordings.
        recordings: These.
        found: Outcome of the search, and what of it is accepted.
        seed: Of random numbers.
        limits: See `design`.
        on_progress: Told what is being done.

    Raises:
        InputError: See `design`.
    """
    outcome, accepted = found
    known = Further(Isolability(), Located(()), None)
    with suppress(TimeIsOver), may_be_left():
        on_progress("finding out what these channels can tell apart")
        terms = [t for t in model.terms() if not t.is_completing]
        known.told_apart = known._made(
            "What these channels can tell apart", lambda: isolability(model, outcome.base, terms), known.told_apart
        )
        on_progress("driving each unit alone")
        titles = [r.title for r in recordings]
        known.located = known._made(
            "Where each unit departs", lambda: locate(model, outcome.base, titles, seed), known.located
        )
        on_progress("designing the next experiment")
        known.experiment = known._made(
            "The next experiment", lambda: next_experiment(scenario, model, recordings, outcome, accepted, limits), None
        )
    return known
