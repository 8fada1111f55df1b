"""Effects that look alike at the recalibrated point, and what the recalibration absorbs."""

from dataclasses import replace

import numpy as np
import pytest

from diagnosis.isolability.alike import effects, widest
from diagnosis.isolability.isolability import isolability
from diagnosis.search.fit import fit
from diagnosis.search.problem import Point
from tests.locate.rig import fit_to, truth
from tests.search.line_model import BEND, TIME
from tests.verdict.lines import Lines


def test_known_confusions_are_seen():
    model, fitted = fit_to(truth({}))
    shown, alike = effects(model, fitted, widest(model.terms()))
    by_name = {(e.term.identifier, e.term.place): e for e in shown}
    source = next(e for e in shown if e.term.identifier == "supply_source_resistance")
    assert source.absorbed_by.endswith("reference_resistance")
    assert source.visibility < 0.1
    gain = by_name["sensor_gain", "every temperature"]
    assert gain.visibility < 0.1
    assert gain.absorbed_by.rpartition(".")[2] in ("conductance", "capacity")
    step = by_name["incomplete_transformation", "all coils"]
    assert step.visibility > source.visibility
    assert all(0.0 <= p.cosine <= 1.0 and p.gain < 6.0 for p in alike)
    pairs = {frozenset((p.one, p.other)) for p in alike}
    assert frozenset(("stress_dependent_transformation", "transformation_shift")) in pairs  # one load only


def test_statements_name_classes_and_the_best_extra_channel():
    model, fitted = fit_to(truth({}))
    told = isolability(model, fitted, model.terms())
    assert any("cannot tell apart" in s and "stiffness of a coil" in s for s in told.statements)
    assert told.extra_channels
    assert told.extra_channels[0].statement in told.statements
    assert all(len(c.faults) >= 1 for c in told.classes)


def test_a_model_without_a_free_number_absorbs_nothing():
    """Of an FMU none of whose numbers moves the readings: the full report ended in a traceback."""

    class Fixed(Lines):
        def __init__(self, truth):
            super().__init__(truth)
            self.parameters = []

        def signal(self, point):
            return super().signal(replace(point, base=np.zeros(2)))

        def base_jacobian(self, point):
            return np.zeros((len(TIME), 0))

    model = Fixed(0.0 * TIME)
    (shown,), alike = effects(model, fit(model, Point(np.zeros(0))), [BEND])
    assert shown.absorbed_by == ""
    assert shown.visibility == pytest.approx(1.0)
    assert alike == []
