"""What judging, locating, amending and reporting ask of a model: every kind and every wrapper answers, and rightly."""

from __future__ import annotations

import inspect
from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from diagnosis.models.protocol import DiagnosisModel, ModelBase, Scatter
from diagnosis.models.wrappers.wrapped import WrappedModel
from diagnosis.search.problem import Point, Term
from diagnosis.search.search import Settings
from tests.fabric_diagnosis.fabrics import SMALL
from tests.models.cases import ASKED, RIG

#: Members that each kind of model has to have itself: for these there is no usual answer.
OWN = {
    *("parameters", "layout", "runs", "simulations", "residuals", "base_jacobian"),
    *("terms", "where", "shows_in", "scale_uncertainty", "groups", "predict"),
}
#: Those that a wrapper hands on as they are, without an argument.
HANDED_ON = (
    "is_fast",
    "can_be_searched_again",
    "can_be_refitted",
    "can_be_fitted",
    "has_scatter",
    "has_ridges",
    "timeline",
    "untried",
    "hidden",
    "answers",
    "coil_network",
    "innermost",
)


def members() -> set[str]:
    """Public members of the protocol."""
    return {n for n in (*vars(DiagnosisModel), *DiagnosisModel.__annotations__) if not n.startswith("_")}


@pytest.fixture(scope="module", params=ASKED, ids=lambda name: name.replace(" ", "_"))
def folder(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    """Name of a case, and where its files are."""
    return request.param, tmp_path_factory.mktemp("model")


@pytest.fixture(scope="module")
def model(folder: tuple[str, Path]) -> DiagnosisModel:
    """A model of one recording."""
    return ASKED[folder[0]](folder[1])


def nominal(model: DiagnosisModel) -> Point:
    return Point(np.zeros(len(model.parameters)))


def started(term: Term) -> tuple[float, ...]:
    return tuple(p.starts[0] if p.starts else 0.5 * (p.lower + p.upper) for p in term.parameters)


def test_a_base_or_each_kind_answers_every_question_and_a_wrapper_answers_all() -> None:
    """A wrapper without a member would answer as `ModelBase` does, and not as the model inside it."""
    assert members() - set(vars(ModelBase)) == OWN
    assert members() - set(vars(WrappedModel)) == {"parameters", "layout"}  # attributes of an instance
    assert not issubclass(WrappedModel, ModelBase)


def test_every_model_satisfies_the_protocol(model: DiagnosisModel) -> None:
    assert isinstance(model, DiagnosisModel)


def test_what_is_innermost_simulates_and_knows_the_point(model: DiagnosisModel) -> None:
    inner = model.innermost
    assert not isinstance(inner, WrappedModel)
    assert inner.innermost is inner
    point = model.innermost_point(nominal(model))
    assert len(point.base) == len(inner.parameters)
    if model.can_be_fitted:
        assert np.isfinite(inner.residuals([point])).all()


def test_inflation_is_what_parts_a_model_from_the_plain_one(model: DiagnosisModel) -> None:
    names = model.layout.names
    assert model.inflation.shape == (len(names),)
    assert np.all(model.inflation >= 1.0)
    plain = model.plain
    assert plain.plain is plain
    np.testing.assert_array_equal(plain.inflation, 1.0)
    if model.can_be_fitted:
        factor = np.sqrt(model.inflation)[np.asarray(model.layout.channel, dtype=int)]
        residuals, whole = (m.residuals([nominal(m)])[0] for m in (model, plain))
        np.testing.assert_allclose(residuals * factor, whole, rtol=1e-12)


def test_a_coil_network_is_the_model_that_simulates(model: DiagnosisModel) -> None:
    network = model.coil_network
    assert network is None or network is model.innermost
    assert network is None or network.coil_network is network


def test_a_wrapper_hands_on_what_it_does_not_change(model: DiagnosisModel) -> None:
    if not isinstance(model, WrappedModel):
        pytest.skip("no wrapper")
    for name in HANDED_ON:
        assert getattr(model, name) == getattr(model.inner, name), name
    assert model.input_terms() == model.inner.input_terms()
    assert model.judged_by(nominal(model)) == model.inner.judged_by(model.inside(nominal(model)))
    np.testing.assert_array_equal(model.step_ends(0), model.inner.step_ends(0))


def test_each_residual_is_a_reading_or_each_reading_has_one(model: DiagnosisModel) -> None:
    readings = sum(len(s.samples) for run in model.runs for s in run.series)
    place = model.residual_of_reading
    if place is None:
        assert readings == len(model.layout.time)
    else:
        assert place.shape == (readings,)


def test_shares_that_are_taken_from_residuals_are_told_for_each_channel(model: DiagnosisModel) -> None:
    for run in model.runs:
        assert run.shares.shape == (len(run.series),)
        assert np.all((run.shares >= 0.0) & (run.shares < 1.0))


def test_a_law_with_an_instant_has_a_timeline_of_all_recordings(model: DiagnosisModel) -> None:
    has_instant = any(p.is_instant for t in model.terms() for p in t.parameters)
    assert model.timeline is not None or not has_instant
    if model.timeline is not None:
        assert len(model.timeline.seats) == len(model.runs)


def test_steps_of_the_simulation_rise_over_all_readings(model: DiagnosisModel) -> None:
    for number, run in enumerate(model.runs):
        ends = model.step_ends(number)
        if len(ends):
            assert np.all(np.diff(ends) > 0.0)
            assert ends[-1] >= max(s.channel.times[-1] for s in run.series)


def test_what_could_not_be_tried_is_told_in_words(model: DiagnosisModel) -> None:
    assert all(isinstance(text, str) and text for text in model.untried)


def test_what_hides_its_states_is_a_component(model: DiagnosisModel, folder: tuple[str, Path]) -> None:
    own = folder[1] / "scenario.yaml"
    there = load_scenario(str(own)).components if own.exists() else {}
    assert set(model.hidden) <= set(there)


def test_faults_are_of_a_recording_with_begin_and_end(model: DiagnosisModel) -> None:
    faults, inputs = model.faults(), model.input_terms()
    assert len(set(map(str, faults))) == len(faults)
    assert not faults or set(inputs) <= set(faults)
    for term in (*faults, *inputs):
        assert term.recording in range(len(model.runs))
        assert [p.is_instant for p in term.parameters[:3]] == [False, True, True]
        assert not any(p.is_instant for p in term.parameters[3:])
    assert not set(faults) & set(model.terms())


def test_no_interval_is_near_where_there_is_no_fault(model: DiagnosisModel) -> None:
    assert list(model.near_intervals(nominal(model))) == []


def test_scatter_is_of_a_model_that_says_so(model: DiagnosisModel) -> None:
    def deviations() -> list[float]:
        return [s.channel.deviation for run in model.runs for s in run.series]

    before = deviations()
    if not model.has_scatter:
        assert model.scatter() == Scatter()
    model.take_scatter(Scatter({s.channel.name: 3.0 for run in model.runs for s in run.series}, 2.0))
    assert (deviations() != before) is model.has_scatter
    model.take_scatter(Scatter())
    assert deviations() == before


def test_a_search_of_its_own_is_of_a_model_that_the_usual_one_does_not_fit(model: DiagnosisModel) -> None:
    if model.can_be_fitted:
        assert model.own_search(Settings(), print) is None
    else:
        assert "own_search" in vars(type(model))  # it takes minutes


def test_a_term_moves_residuals_by_its_strength(model: DiagnosisModel) -> None:
    terms = [t for t in model.terms() if not any(p.is_instant for p in t.parameters)]
    for term in terms[:1]:
        values = started(term)
        assert not model.is_moved_by(term, (0.0, *values[1:]))
    assert not terms or any(model.is_moved_by(t, started(t)) for t in terms[:20])
    unknown = Term("nothing", "nowhere", "thermal", ())
    assert not model.is_moved_by(unknown, ())


def test_laws_and_places_answer_what_is_asked_of_them(model: DiagnosisModel) -> None:
    days = () if model.timeline is None else model.timeline.days
    for term in (*model.terms(), *model.faults()):
        effect, spot = model.where(term)
        assert effect.name
        assert isinstance(effect.is_of_a_day, bool)
        assert isinstance(effect.is_of_either, bool)
        assert effect.is_of_a_day or term.recording is None
        assert spot.label
        assert spot.mask is None or np.asarray(spot.mask).ndim == 1
        assert spot.day is None or spot.day in days
        assert set(spot.channels or ()) <= set(range(len(model.layout.names)))


def test_who_judged_is_said_in_words(model: DiagnosisModel) -> None:
    assert model.judged_by(nominal(model))


def test_a_scenario_with_its_numbers_runs_or_there_is_none(
    model: DiagnosisModel, folder: tuple[str, Path], tmp_path: Path
) -> None:
    own = folder[1] / "scenario.yaml"
    scenario = load_scenario(str(own if own.exists() else SMALL if model.has_scatter else RIG / "scenario.yaml"))
    path = model.amend(scenario, nominal(model), tmp_path / "amended")
    is_usual = inspect.getattr_static(type(model), "amend") is inspect.getattr_static(ModelBase, "amend")
    assert (path is None) == (model.coil_network is not None or is_usual)
    if path is not None:
        assert set(load_scenario(path).components) == set(scenario.components)


def test_the_base_says_what_the_protocol_asks() -> None:
    """The same arguments in the same order, so that any model can be called as the protocol says."""
    for kind in (ModelBase, WrappedModel):
        for name in members() & set(vars(kind)):
            asked, answered = inspect.getattr_static(DiagnosisModel, name), inspect.getattr_static(kind, name)
            assert isinstance(asked, property) == isinstance(answered, property), (kind, name)
            if not isinstance(asked, property):
                told = [list(inspect.signature(f).parameters) for f in (asked, answered)]
                assert told[0] == told[1], (kind, name)
