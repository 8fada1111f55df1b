"""What a finding says of its instant, from a search over two events among few candidates."""

from __future__ import annotations

import numpy as np
import pytest

from diagnosis.candidates.registry import candidate, catalogue
from diagnosis.experiment.bench import Belief, Bench
from diagnosis.judge.acceptance import accept
from diagnosis.judge.findings import findings
from diagnosis.judge.unfitted import left_out_readings
from diagnosis.model_error import distinct, plain_terms
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.search.problem import Point
from diagnosis.search.search import Settings, search
from tests.events import rig

FEW = ("open_coil", "shorted_coil", "loose_contact", "draught", "ambient_drift", "second_mass", "contact_resistance")


@pytest.fixture(scope="module")
def model() -> CoilNetworkModel:
    """The second coil of the first string half breaks between the second and the third of three recordings.

    After a clean break nothing tells which coil of the string it was: none is heated any more.
    """
    broken = rig.open_coil(2, rig.BEFORE, 0.6)
    recordings = [rig.recorded(2, broken, order=7), rig.recorded(0, order=2), rig.recorded(1, order=4)]
    return CoilNetworkModel(rig.scenario(), recordings, [candidate(name) for name in FEW])


def test_a_break_between_two_recordings_is_one_at_the_begin_of_the_later(model: CoilNetworkModel) -> None:
    settings = Settings(nulls=2, most_terms=2)
    outcome = search(model, model.terms(), settings, model.groups())
    titles = [r.title for r in model.timeline.recordings]
    unfitted = left_out_readings(model, titles)
    accepted = accept(model, outcome, unfitted, unfitted, lambda term: False)
    (found,) = findings(model, outcome, accepted, titles)
    assert found.is_accepted
    assert found.recording in ("levels", "stairs")
    assert (found.effect, found.place) == ("open_coil", "coil[1,2]")
    (instant,) = [p for p in found.parameters if p.name == "instant"]
    # nothing flows in the last 6 s of `levels`, which ends at 50 s, nor in the first 2 s of `stairs`
    ((begin, end),) = found.intervals
    assert 0.0 <= begin - instant.value <= 0.25  # it shows from its instant on, at most one reading later
    late = {50.0: 0.0, 64.0: 50.0}[end]
    assert 43.0 < instant.lower + late < 44.1
    assert 51.9 < instant.upper + late < 54.0
    first, last = instant.lower + late, instant.upper + late - 50.0
    told = f"between {first:.1f} s of recording levels and {last:.1f} s of recording stairs"
    assert found.statement == f"coil open from an instant on, coil[1,2], {told}"
    assert outcome.best.fit.residuals @ outcome.best.fit.residuals < 1.1 * np.count_nonzero(outcome.best.fit.residuals)


def test_terms_of_different_days_stay_apart_and_none_of_them_is_plain(model: CoilNetworkModel) -> None:
    drifts = [t for t in distinct(model, model.terms()) if t.identifier == "ambient_drift"]
    assert len(drifts) == 3 * 4
    plain = {t.identifier for t in plain_terms(model, model.terms())}
    assert plain == {"second_mass", "contact_resistance"}


def test_in_another_experiment_what_broke_is_broken_and_a_draught_is_over() -> None:
    recordings = [rig.recorded(n) for n in range(2)]
    model = CoilNetworkModel(rig.scenario(), recordings, catalogue())
    terms = {(t.identifier, t.place): t for t in model.terms()}
    points = [
        Point(np.zeros(len(model.parameters)), {terms["open_coil", "coil[1,1]"]: (1.0, 80.0)}),
        Point(np.zeros(len(model.parameters)), {terms["draught", "all coils"]: (0.4, 80.0)}),
    ]
    beliefs = [Belief(p, np.eye(len(model.parameters) + 2)) for p in points]
    again = Bench(model, recordings, beliefs).repeat()
    plain = again.residuals([Point(np.zeros(len(model.parameters)))])[0]
    broken, windy = again.residuals(points)
    assert np.array_equal(windy, plain)
    first = np.abs(broken - plain)[: again.runs[0].count]
    assert first.max() > 100.0  # in the first recording of the repeat too
