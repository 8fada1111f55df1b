"""Coil network and Bullet together: the same as the closed co-simulation, and clear refusals."""

from __future__ import annotations

import numpy as np
import pytest

from cosim.assemble import assemble
from cosim.run import run
from cosim.scenario import load_scenario
from cosim.unit.errors import InputError
from diagnosis.candidates.registry import catalogue
from diagnosis.models.build import model_of
from diagnosis.models.fabric.amended import amend_fabric
from diagnosis.models.fabric.laws import fabric_laws
from diagnosis.models.fabric.model import PREDICTED, START_SPEED, FabricModel
from diagnosis.models.fabric.search import search_fabric
from diagnosis.recording.quantity import parse_quantity
from diagnosis.search.cosim_run import predicted
from diagnosis.search.problem import Point
from diagnosis.search.search import Settings
from tests.fabric_diagnosis.fabrics import DRAPE, ELECTRICAL, MARKERS, made, shortened, small, with_fabric

SHORT = 0.1


@pytest.fixture(scope="module")
def short(tmp_path_factory):
    return made(tmp_path_factory.mktemp("s") / "r", 1, [*ELECTRICAL[:1], *MARKERS], shortened(small(), 0.5))


@pytest.fixture(scope="module")
def found(short):
    return model_of(small(), [short], catalogue())


def test_a_scenario_with_a_fabric_is_diagnosed_by_network_and_bullet(found):
    assert isinstance(found, FabricModel)
    assert found.first_own > 20
    assert [p.name for p in found.parameters[found.first_own :]] == [
        "fabric.link_mass",
        "fabric.friction",
        "fabric.steel_stiffness",
    ]
    assert {t.identifier for t in found.laws()} >= {"tilt", "slide_friction", "hinge_friction", "payload", "backlash"}


def test_bullet_driven_by_the_network_moves_like_the_closed_co_simulation(found, short):
    closed = run(shortened(small(), 0.5))
    point = Point(np.zeros(len(found.parameters)))
    (values,) = found.fabric_runs.make([(0, found.fabric_parameters(point, 0), found.network_point(point))])
    names = list(found.mechanical_recordings[0].channels)
    worst = 0.0
    for name in MARKERS:
        channel = short.channels[name]
        early = channel.times <= SHORT
        own = values[names.index(name)][early]
        same = predicted(closed, channel.target, channel.times, short.path)[early]
        worst = max(worst, float(np.abs(own - same).max()))
    # stiffness agrees to 1e-9; contacts amplify it, by less than a micrometre within a tenth of a second
    assert worst < 1e-6


def test_a_prediction_is_the_mean_of_runs_from_starts_of_their_own(found):
    """Of the scenario's start and two others; they are not the same run."""
    point = Point(np.zeros(len(found.parameters)))
    tasks = [(0, found.fabric_parameters(point, 0, s), found.network_point(point)) for s in range(PREDICTED)]
    runs = found.fabric_runs.make(tasks)
    last = len(found.mechanical_recordings[0].channels) - 1
    np.testing.assert_allclose(found.predict(point, 0)[-1], np.mean([r[last] for r in runs], axis=0), rtol=1e-12)
    assert PREDICTED == len({r[last].tobytes() for r in runs}) == 3
    assert {s.channel.scatter_runs for s in found.runs[0].series if s.channel.name in MARKERS} == {3}


def test_what_judges_is_called_by_its_engine(found, short):
    """A fabric of MuJoCo was judged by "free runs of Bullet"."""
    point = Point(np.zeros(len(found.parameters)))
    assert found.judged_by(point).startswith("means of 3 free runs of Bullet, driven by the coil network")
    given = small()
    fabric = given.components["fabric"].model_copy(update={"engine": "mujoco"})
    other = given.model_copy(update={"components": {**given.components, "fabric": fabric}})
    assert "free runs of MuJoCo, driven" in model_of(other, [short], catalogue()).judged_by(point)


def test_a_prediction_of_which_one_run_stops_is_not_finite(found, monkeypatch):
    """The two that go on would hide it."""
    made = found.fabric_runs.make

    def stopping(tasks):
        return [None if "start_number" in given else values for (_, given, _), values in zip(tasks, made(tasks))]

    monkeypatch.setattr(found.fabric_runs, "make", stopping)
    assert np.all(np.isinf(found.predict(Point(np.zeros(len(found.parameters))), 0)[-1]))


def test_every_effect_is_a_parameter_that_the_scenario_takes(found):
    for term in found.laws():
        point = Point(np.zeros(len(found.parameters)), {term: (term.parameters[0].starts[0],)})
        numbers = found.fabric_parameters(point, 0)
        name = term.parameters[0].name
        place = found.link_places.get(term)
        assert list(numbers) == ([name] if place is None else [f"{name}[{link}]" for link in place.links])
        amended = with_fabric(small(), **{n: f"{v.number!r} {v.unit}" for n, v in numbers.items()})
        assemble(amended).system.terminate()


def test_what_was_found_is_a_scenario_that_runs(found, tmp_path):
    laws = {t.identifier: t for t in found.laws()}
    tilt, slide = laws["tilt"], laws["slide_friction"]
    base = np.zeros(len(found.parameters))
    base[found.first_own + 1] = 2.0  # friction, by two deviations of 5 %
    base[[p.name for p in found.parameters].index("conductance")] = 1.0
    path = amend_fabric(small(), found, Point(base, {tilt: (0.06,), slide: (0.3,)}), tmp_path / "amended")
    amended = load_scenario(path)
    numbers = amended.components["fabric"].parameters
    assert numbers["tilt"].to("rad") == 0.06
    assert numbers["slide_friction"].to("N") == 0.3
    assert numbers["friction"].number == pytest.approx(0.5329 * np.exp(0.1))
    results = run(shortened(amended, 0.1))
    point = Point(base, {tilt: (0.06,), slide: (0.3,)})
    (own,) = found.fabric_runs.make([(0, found.fabric_parameters(point, 0), found.network_point(point))])
    place = list(found.mechanical_recordings[0].channels).index("marker[10].z")
    early = found.mechanical_recordings[0].channels["marker[10].z"].times <= 0.1
    series = predicted(results, parse_quantity("marker[10].z"), np.array([0.05, 0.1]), path)
    # daily numbers are at their nominal values here, so both are one model
    np.testing.assert_allclose(series, own[place][early][1:], atol=2e-6)


def test_random_starts_are_parameters_too(found):
    nominal = Point(np.zeros(len(found.parameters)))
    assert found.fabric_parameters(nominal, 0) == {}
    numbers = found.fabric_parameters(nominal, 0, start=3)
    assert numbers["start_speed"].number == START_SPEED
    assert numbers["start_number"].number == 3


def test_a_recording_without_the_fabric_is_refused(tmp_path):
    recording = made(tmp_path / "r", 1, ELECTRICAL, shortened(small(), 0.8))
    with pytest.raises(InputError, match="no channel measures the fabric"):
        model_of(small(), [recording], catalogue())


def test_a_drape_without_circuit_is_diagnosed_by_the_closed_co_simulation(tmp_path):
    scenario = load_scenario(DRAPE)
    channels = [f"marker[{i}].z" for i in (6, 7, 8)]
    recording = made(tmp_path / "r", 1, channels, scenario)
    model = model_of(scenario, [recording], catalogue())
    assert isinstance(model, FabricModel)
    assert model.network is None
    values = model.predict(Point(np.zeros(len(model.parameters))), 0)
    assert [len(v) for v in values] == [len(recording.channels[n].times) for n in channels]
    assert np.abs(values[0] - recording.channels["marker[6].z"].values).max() < 2e-3  # scatter and noise


def test_all_laws_take_energy_or_have_a_sign():
    for law in fabric_laws("fabric"):
        lower = law.place.term.parameters[0].lower
        assert lower == 0.0 or law.place.term.identifier in ("tilt", "roll")


@pytest.mark.slow
def test_a_tilt_is_found_and_another_start_is_not(tmp_path):
    """About a hundred simulations of a second each."""
    tilted = made(tmp_path / "tilted", 1, [*ELECTRICAL, *MARKERS], small(), tilt="0.07 rad")
    model = model_of(small(), [tilted], catalogue())
    assert isinstance(model, FabricModel)
    outcome = search_fabric(model, Settings(seed=1))
    assert outcome.best.terms
    assert [t.identifier for t in outcome.best.terms] == ["tilt"]
    (values,) = outcome.best.fit.point.terms.values()
    assert values[0] == pytest.approx(0.07, abs=0.02)  # twice the half width of its interval


@pytest.mark.slow
def test_scatter_of_a_fabric_is_never_called_physics(tmp_path):
    same = made(tmp_path / "same", 1, [*ELECTRICAL, *MARKERS], small())
    model = model_of(small(), [same], catalogue())
    assert isinstance(model, FabricModel)
    outcome = search_fabric(model, Settings(seed=1))
    assert not outcome.best.terms
    assert not outcome.best.terms
