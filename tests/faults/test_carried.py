"""Faults belong to one recording: what is simulated, predicted, carried to other days and written of them."""

from dataclasses import replace

import numpy as np
import pytest

from cosim.scenario import load_scenario
from cosim.unit.quantity import PhysicalValue
from diagnosis.amend.changes import changes_of
from diagnosis.experiment.bench import Belief
from diagnosis.faults.given import GivenFaults, faults_of
from diagnosis.faults.model import with_faults
from diagnosis.faults.programme import InputChange, with_changes
from diagnosis.judge.held_out import carried_over
from diagnosis.models.cosimulation.model import ClosedLoopModel
from diagnosis.recording.quantity import parse_quantity
from diagnosis.recording.recording import Channel, Recording
from diagnosis.search.fit import fit
from diagnosis.search.grow import interval_scores
from diagnosis.search.problem import Point, strength_slopes
from diagnosis.search.score import Projection
from tests.faults.rig import NAMES, faulty, recorded, scenario


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return scenario(tmp_path_factory.mktemp("rig"))


@pytest.fixture(scope="module")
def model(made):
    return faulty(made, recorded(made, 0))


def term_of(model, name):
    return next(t for t in (*model.sensor_terms, *model.input_terms()) if str(t) == name)


def nominal(model):
    return Point(np.zeros(len(model.parameters)))


def test_residuals_are_those_of_what_is_predicted_with_every_fault(model):
    """The channel's unknown zero is whitened away in both; 1e-9 is rounding."""
    point = nominal(model)
    for name, values in (
        (f"sensor_offset_in_interval at {NAMES[0]} (first)", (1.2, 100.0, 203.0)),
        (f"sensor_stuck_in_interval at {NAMES[1]} (second)", (1.0, 150.0, 300.0)),
        ("input_gain_in_interval at power of coil[1] (second)", (0.2, 151.0, 300.0)),
    ):
        point = point.plus(term_of(model, name), values)
    own = model.residuals([point])[0]
    for r in model.readings:
        predicted = model.predict(point, r.recording)[r.number % 2]
        np.testing.assert_allclose(r.residuals((r.measured - predicted) / r.deviation), own[r.own], atol=1e-9)
    clean = model.predict(nominal(model), 1)
    assert np.ptp(model.predict(point, 1)[1][30:45]) < 1e-9 < np.ptp(clean[1][30:45])  # stuck from 150 s to 300 s


def test_a_fault_changes_its_own_recording_alone(model):
    for term in (*model.sensor_terms, *model.input_terms()):
        span = (0.0, 30.0) if term.identifier == "unstated_input_in_interval" else (200.0, 400.0)
        there = model.residuals([nominal(model), nominal(model).plus(term, (0.3, *span))])
        changed = np.flatnonzero(there[0] != there[1])
        own = [r.own for r in model.readings if r.recording == term.recording]
        assert len(changed)
        assert own[0].start <= changed[0]
        assert changed[-1] < own[-1].stop


def test_slopes_of_inputs_add_up_over_pieces(model):
    """Along a straight line; 2 % of the largest for what a gain of 0.02 bends."""
    term = term_of(model, "input_gain_in_interval at power of coil[1] (first)")
    tasks = [(term, (0.02, a, b)) for a, b in ((100.0, 160.0), (160.0, 300.0), (100.0, 300.0))]
    first, second, whole = strength_slopes(model, nominal(model), None, tasks)
    assert np.abs(first + second - whole).max() < 0.02 * np.abs(whole).max()


def test_another_model_an_experiment_and_an_amended_scenario_leave_faults_of_a_day_out(made, model):
    law = next(t for t in model.terms() if str(t) == "neighbour_heat at all coils")
    faults = {
        term_of(model, "input_gain_in_interval at power of coil[1] (first)"): (0.2, 100.0, 200.0),
        term_of(model, f"sensor_offset_in_interval at {NAMES[0]} (first)"): (1.2, 100.0, 203.0),
    }
    point = Point(nominal(model).base, {law: (0.03,), **faults})
    assert faults_of(point) == faults
    assert list(carried_over(point, model, model).terms) == [law]
    changes = changes_of(made, model.inner, model.inside(point))
    assert [t.term.identifier for t in changes.terms] == ["neighbour_heat"]
    found = fit(model, point, iterations=1)
    belief = Belief.of(found, len(model.parameters))
    assert list(belief.point.terms) == [law]
    assert len(belief.covariance) == len(model.parameters) + 1
    given = GivenFaults(model, faults)
    np.testing.assert_array_equal(given.residuals([point.lasting]), model.residuals([point]))


def test_a_programme_with_a_gain_drives_the_same_energy_wherever_the_interval_begins(made):
    """Partial macro-steps have their part: 0.1 * (203.7 - 101.3) s of 0.75 W, exact but for rounding."""
    given = made.components["drive"].outputs["power_1"]
    moved = with_changes(given, [InputChange(0.1, 101.3, 203.7)], made)

    def energy(output):
        times = np.array([t.to("s") for t, _ in output.points])
        watts = np.array([v.to("W") for _, v in output.points])
        return float(np.sum(watts * np.diff(np.append(times, 600.0))))

    assert energy(moved) - energy(given) == pytest.approx(0.1 * 102.4 * 0.75, rel=1e-9)


def test_an_input_acts_where_nothing_is_stated_and_a_gain_there_is_nothing(made):
    """Both at once, each of what is stated: 0.2 W over the 30 s before the first command, a tenth of 0.75 W after."""
    given = made.components["drive"].outputs["power_1"]
    both = [InputChange(0.1, 0.0, 203.0), InputChange(0.2, 0.0, 100.0, is_added=True)]
    moved = with_changes(given, both, made)
    found = {round(t.to("s")): v.to("W") for t, v in moved.points}
    assert found[0] == pytest.approx(0.2)
    assert found[30] == found[100] == pytest.approx(0.825)
    assert found[203] == pytest.approx(0.75)
    assert found[250] == pytest.approx(0.3)


def test_the_closed_loop_runs_and_scans_faults_of_its_inputs_and_sensors(made, tmp_path):
    """A coarse scan, before any fit: within a piece of the twelve (50 s) and 30 % of the gain."""
    times = np.arange(10.0, 600.0, 10.0)
    channels = {
        n: Channel(
            n,
            parse_quantity(f"heaters.temperature[{i}]"),
            times,
            np.zeros(59),
            0.1,
            True,
            is_clipped=np.zeros(59, dtype=bool),
        )
        for i, n in ((1, "T1"), (2, "T2"))
    }
    empty = Recording(tmp_path, "day", channels, (), {}, 600.0, 0.0)
    blank = with_faults(ClosedLoopModel(made, [empty]))
    term = term_of(blank, "input_gain_in_interval at drive.power_2")
    values = blank.predict(nominal(blank).plus(term, (0.3, 200.0, 300.0)), 0)
    random = np.random.default_rng(0)
    noisy = [v + 0.1 * random.standard_normal(59) for v in values]
    read = replace(empty, channels={n: replace(c, values=v) for (n, c), v in zip(channels.items(), noisy)})
    model = with_faults(ClosedLoopModel(made, [read]))
    base = fit(model, nominal(model), iterations=5)
    projection = Projection(base)
    projection.noise(0, 0)
    three = {str(s.term): s.values for s in interval_scores(model, base, projection).ranked[:3]}  # these are fitted
    gain, begin, end = three[str(term)]
    assert gain == pytest.approx(0.3, rel=0.3)
    assert (begin, end) == pytest.approx((200.0, 300.0), abs=50.0)
    # 0.4 W is stated from 100 to 350 s: a share of it is another value too
    _, begin, end, level = three["input_level_in_interval at drive.power_2"]
    assert level == pytest.approx(1.3 * 0.4, rel=0.1)
    assert (begin, end) == pytest.approx((200.0, 300.0), abs=50.0)


def test_a_pendulum_has_faults_of_its_encoder(tmp_path):
    base = load_scenario("pendulum")
    stop = base.time.model_copy(update={"stop": PhysicalValue(4.0, "s")})
    short = base.model_copy(update={"time": stop})
    times = np.arange(0.1, 4.0, 0.02)
    channel = Channel(
        "arm.angle",
        parse_quantity("arm.angle"),
        times,
        np.zeros(len(times)),
        2e-3,
        True,
        is_clipped=np.zeros(len(times), dtype=bool),
    )
    empty = Recording(tmp_path, "swing", {"arm.angle": channel}, (), {}, 4.0, 0.0)
    swing = ClosedLoopModel(short, [empty])
    values = swing.predict(Point(np.zeros(len(swing.parameters))), 0)[0]
    wrong = (
        values + 2e-3 * np.random.default_rng(0).standard_normal(len(values)) + np.where(abs(times - 2) < 0.4, 0.01, 0)
    )
    read = replace(empty, channels={"arm.angle": replace(channel, values=wrong)})
    model = with_faults(ClosedLoopModel(short, [read]))
    found = fit(model, nominal(model), iterations=5)
    projection = Projection(found)
    projection.noise(0, 0)
    best = interval_scores(model, found, projection).ranked[0]
    assert str(best.term) == "sensor_offset_in_interval at arm.angle"
    assert best.values == pytest.approx((0.01, 1.6, 2.4), abs=0.05)
