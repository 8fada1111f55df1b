"""Events in a coil network of three recordings with different programmes: predictions, slopes, bounds, cost."""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
import pytest

from cosim.unit.protocol import Array
from diagnosis.candidates.registry import candidate, catalogue
from diagnosis.judge.diagnosis import Estimate
from diagnosis.judge.estimates import estimates
from diagnosis.judge.events import event_interval, event_of, local_estimates, local_instant
from diagnosis.judge.held_out import carried_over
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.models.wrappers.masked import MaskedModel
from diagnosis.search.fit import fit
from diagnosis.search.problem import Point, Term
from tests.events import rig

#: Begin of the third recording on the joint axis [s].
THIRD = 110.0


@functools.cache
def model() -> CoilNetworkModel:
    return CoilNetworkModel(rig.scenario(), [rig.recorded(n) for n in range(3)], catalogue())


@functools.cache
def judge() -> CoilNetworkModel:
    held_out = [rig.recorded(3), rig.recorded(3, title="again")]
    return CoilNetworkModel(rig.scenario(), held_out, catalogue(), timeline=model().timeline)


def term(identifier: str, place: str) -> Term:
    return next(t for t in model().terms() if t.identifier == identifier and t.place == place)


def at(*terms: tuple[Term, tuple[float, ...]]) -> Point:
    return Point(np.zeros(len(model().parameters)), dict(terms))


def by_recording(values: Array) -> list[Array]:
    return np.split(values, np.cumsum([run.count for run in model().runs])[:-1])


def test_a_coil_that_breaks_in_the_third_recording_is_whole_before_and_broken_on_later_days() -> None:
    broken = at((term("open_coil", "coil[2,1]"), (1.0, THIRD + 8.0)))
    before = [model().predict(at(), n) for n in range(3)]
    after = [model().predict(broken, n) for n in range(3)]
    for n in (0, 1):
        assert all(np.array_equal(a, b) for a, b in zip(before[n], after[n]))
    (current,) = [n for n, s in enumerate(model().runs[2].series) if s.channel.name == "string[2].current"]
    times = model().runs[2].series[current].times
    assert np.array_equal(before[2][current][times < 7.5], after[2][current][times < 7.5])
    assert after[2][current][times > 8.5].max() < 1e-9  # nothing flows
    later = judge().predict(carried_over(broken, model(), judge()), 0)[current]
    assert later.max() < 1e-9


def test_a_break_in_the_first_recording_lasts_in_all_others() -> None:
    broken = at((term("open_coil", "coil[2,1]"), (1.0, 8.0)))
    (current,) = [n for n, s in enumerate(model().runs[1].series) if s.channel.name == "string[2].current"]
    assert model().predict(broken, 0)[current].max() > 0.1
    assert model().predict(broken, 1)[current].max() < 1e-9
    assert model().predict(broken, 2)[current].max() < 1e-9


def test_a_draught_of_the_second_recording_is_in_no_other() -> None:
    there = at((term("draught", "all coils"), (0.4, 60.0 + 20.0)))
    change = by_recording(model().residuals([there])[0] - model().residuals([at()])[0])
    assert [bool(np.any(c)) for c in change] == [False, True, False]
    elsewhere = carried_over(there, model(), judge())
    assert np.array_equal(judge().residuals([elsewhere]), judge().residuals([carried_over(at(), model(), judge())]))


def test_a_drift_is_tried_in_every_recording_at_once_and_in_each_alone() -> None:
    places = {t.place for t in model().terms() if t.identifier == "ambient_drift"}
    days = {"", " in recording 1", " in recording 2", " in recording 3"}
    assert places == {p + d for p in ("all coils", "string[1]", "string[2]") for d in days}
    for day, shown in (("", [1, 1, 1]), (" in recording 2", [0, 1, 0])):
        there = at((term("ambient_drift", "all coils" + day), (0.02,)))
        change = by_recording(model().residuals([there])[0] - model().residuals([at()])[0])
        assert [bool(np.any(c)) for c in change] == [bool(s) for s in shown]
        carried = carried_over(there, model(), judge())
        is_same = np.array_equal(
            judge().residuals([carried]), judge().residuals([carried_over(at(), model(), judge())])
        )
        assert is_same == bool(day)


def test_of_one_recording_nothing_is_of_another_day() -> None:
    alone = CoilNetworkModel(rig.scenario(), [rig.recorded(0)], catalogue())
    drifts = {t.place for t in alone.terms() if t.identifier == "ambient_drift"}
    assert drifts == {"all coils", "string[1]", "string[2]"}
    (free,) = [p for p in term_of(alone, "open_coil", "coil[1,1]").parameters if p.is_instant]
    assert (free.lower, free.upper) == (0.0, 60.0)
    assert len(free.starts) == 9
    assert len(free.scan) == 40


def term_of(other: CoilNetworkModel, identifier: str, place: str) -> Term:
    return next(t for t in other.terms() if t.identifier == identifier and t.place == place)


def test_instants_are_spread_over_every_recording_and_lie_on_their_begins() -> None:
    (lasting,) = [p for p in term("open_coil", "coil[1,1]").parameters if p.is_instant]
    (of_day,) = [p for p in term("draught", "all coils").parameters if p.is_instant]
    assert (lasting.lower, lasting.upper) == (0.0, 174.0)
    for begin, end in ((0.0, 60.0), (60.0, 110.0), (110.0, 174.0)):
        assert sum(begin < v < end for v in lasting.scan) == 40
        assert sum(begin < v < end for v in lasting.starts) == 9
    # what is there from the first begin on and lasts is no event; on one day of several it is
    assert {0.0, 60.0, 110.0} & set(lasting.scan) == {60.0, 110.0}
    assert {0.0, 60.0, 110.0} & set(of_day.scan) == {0.0, 60.0, 110.0}


def test_to_scan_instants_costs_in_each_recording_what_it_costs_in_one() -> None:
    coil = term("open_coil", "coil[2,1]")
    (free,) = [p for p in coil.parameters if p.is_instant]
    begun = model().simulations
    model().residuals([at((coil, (1.0, value))) for value in free.scan])
    # within each recording its own 40; before it one (it is whole); after it one (it is broken from the start)
    assert model().simulations - begun <= 3 * 42


@pytest.mark.parametrize("identifier", ["open_coil", "draught", "ambient_drift"])
def test_slopes_are_those_of_the_residuals_wherever_the_instant_lies(identifier: str) -> None:
    place = {"open_coil": "coil[2,1]", "draught": "all coils", "ambient_drift": "all coils in recording 2"}[identifier]
    one, step = term(identifier, place), 1e-4
    instants = (8.0, 60.0, 80.0, 118.0) if identifier != "ambient_drift" else (0.0,)
    tasks = [(one, (step, i)[: len(one.parameters)]) for i in instants]
    slopes = model().slopes(at(), tasks)
    moved = model().residuals([at(task) for task in tasks])
    expected = (moved - model().residuals([at()])[0]) / step
    assert np.abs(slopes).max() > 1.0
    # single precision of whitening aside both are the same difference
    assert slopes == pytest.approx(expected, rel=1e-4, abs=1e-4 * np.abs(expected).max())


def test_an_event_is_told_by_its_recording_and_that_ones_clock() -> None:
    coil = term("open_coil", "coil[2,1]")
    values = (1.0, THIRD + 8.0)
    wrapped = MaskedModel(model(), np.ones(len(model().layout.time), dtype=bool))
    event = event_of(coil, values, wrapped)
    assert event is not None
    assert event.statement == "8.0 s of recording stairs"
    assert local_instant(coil, values, wrapped) == (2, 8.0)
    assert event_interval(coil, values, wrapped) == (8.0, 64.0)
    assert event_of(term("ambient_drift", "all coils"), (0.01,), wrapped) is None
    assert event_interval(term("ambient_drift", "all coils"), (0.01,), wrapped) is None


def test_an_estimate_carries_the_instant_and_its_interval_on_the_clock_of_its_recording() -> None:
    """A contact that comes loose while the supply is at 0 V (40 s to the end, and 4 s of the next day)."""
    training = [rig.recorded(3, rig.loose_contact(46.0)), rig.recorded(0, rig.loose_contact(rig.BEFORE))]
    own = CoilNetworkModel(rig.scenario(), training, catalogue())
    contact = term_of(own, "loose_contact", "string[2]")
    start = Point(np.zeros(len(own.parameters)), {contact: (1.0, 47.0)})
    found = fit(own, start)
    openness, instant = local_estimates(estimates(found, contact), contact, found, own)
    assert openness.lower < 1.5 < openness.upper
    assert local_instant(contact, found.point.terms[contact], own) == (0, instant.value)
    # known no better than from 40 s of the first recording to 3 s of the second, which begins at 52 s of the first
    assert 39.5 < instant.lower < 40.3
    assert 55.0 < instant.upper < 57.0
    sharp = CoilNetworkModel(rig.scenario(), [rig.recorded(1), rig.recorded(0, rig.loose_contact(12.0))], catalogue())
    contact = term_of(sharp, "loose_contact", "string[2]")
    found = fit(sharp, Point(np.zeros(len(sharp.parameters)), {contact: (1.0, 50.0 + 12.2)}))
    _, instant = local_estimates(estimates(found, contact), contact, found, sharp)
    assert instant.lower < 12.0 < instant.upper
    assert instant.upper - instant.lower < 0.5  # readings of the current every 0.25 s
    drift = term_of(sharp, "ambient_drift", "all coils")
    drifting = replace(found, point=Point(found.point.base, {drift: (0.01,)}))
    given = (Estimate("drift", "K/s", 0.01, 0.005, 0.015),)
    assert local_estimates(given, drift, drifting, sharp) == given


def test_cycles_made_before_count() -> None:
    fresh = CoilNetworkModel(rig.scenario(), [rig.recorded(0)], catalogue())
    used = CoilNetworkModel(rig.scenario(), [rig.recorded(0, cycles_before=10.0)], catalogue())
    for name, value in (("fatigue", 0.01), ("fatigue_shift", 0.2)):
        own = term_of(used, name, "all coils")
        point = Point(np.zeros(len(used.parameters)), {own: (value,)})
        (extension,) = [n for n, s in enumerate(used.runs[0].series) if s.channel.name == "coil[1,1].extension"]
        worn = used.predict(point, 0)[extension]
        same = Point(point.base, {term_of(fresh, name, "all coils"): (value,)})
        change = worn - fresh.predict(same, 0)[extension]
        plain = used.predict(Point(point.base), 0)[extension]
        assert np.array_equal(plain, fresh.predict(Point(point.base), 0)[extension])  # without the law nothing counts
        assert np.abs(change).max() > 1e-4  # [m], noise of the sensor
    # the first heating: a tenth of the effect is lost where none was before
    worn_out = Point(point.base, {term_of(used, "fatigue", "all coils"): (0.01,)})
    hot, cold = (
        used.network.simulate(used.network_parameters(p, 0), used.runs[0].inputs, {"stiffness": np.array([21.0])})
        for p in (worn_out, Point(point.base))
    )
    soft = 157.1  # heating_d [N/m]: what does not fade
    share = (hot["stiffness"][0, 0] - soft) / (cold["stiffness"][0, 0] - soft)
    assert share == pytest.approx(0.9, abs=0.01)  # and half a cycle of its own


def test_every_candidate_with_an_instant_says_whether_it_lasts() -> None:
    with_instant = [c for c in catalogue() if any(p.is_instant for p in c.parameters)]
    assert {c.identifier: c.scope for c in with_instant} == {
        "open_coil": "rig",
        "shorted_coil": "rig",
        "loose_contact": "rig",
        "unnamed_resistance_step": "rig",
        "unnamed_series_step": "rig",
        "draught": "day",
        "ambient_step": "day",
        "unnamed_heat_step": "day",
        "unnamed_heat_excess_times_step": "day",
    }
    assert all(c.scope_reason for c in with_instant)
    assert candidate("ambient_drift").scope == "day"
    assert all(candidate(c.same_as).scope == c.scope for c in catalogue() if c.same_as)
