"""What every model of the diagnosis keeps, whatever simulates it (`diagnosis.models.protocol.DiagnosisModel`)."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from cosim.run import run
from cosim.scenario import parse_scenario
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.search.problem import Point, strength_slopes
from tests.models.cases import ARM, CASES, pendulum

#: Distance of the differences below, in prior deviations; a base parameter moves readings smoothly over it.
STEP = 1e-3


@pytest.fixture(scope="module", params=CASES, ids=lambda name: name.replace(" ", "_"))
def model(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> DiagnosisModel:
    """A model of one recording."""
    return CASES[request.param](tmp_path_factory.mktemp("model"))


def at(model: DiagnosisModel, z: float = 0.0) -> Point:
    """A point away from the scenario's own values, by other amounts for each parameter."""
    count = len(model.parameters)
    return Point(z * np.cos(np.arange(count)))


def test_it_has_the_protocol_and_parameters_of_different_names(model: DiagnosisModel) -> None:
    assert isinstance(model, DiagnosisModel)
    names = [p.name for p in model.parameters]
    assert names
    assert len(set(names)) == len(names)
    assert all(p.deviation > 0.0 for p in model.parameters)


def test_the_layout_has_a_channel_a_unit_and_a_time_for_every_residual(model: DiagnosisModel) -> None:
    layout, residuals = model.layout, model.residuals([at(model)])
    assert residuals.shape == (1, len(layout.channel)) == (1, len(layout.time))
    assert len(layout.names) == len(layout.units)
    assert set(np.unique(layout.channel)) <= set(range(len(layout.names)))
    for number in range(len(layout.names)):
        assert all(a <= b for a, b in pairwise(layout.time[layout.channel == number]))


def test_residuals_are_the_same_alone_together_and_again(model: DiagnosisModel) -> None:
    points = [at(model), at(model, 0.3), at(model, -0.2)]
    together = model.residuals(points)
    assert np.isfinite(together).all()
    for number, point in enumerate(points):
        np.testing.assert_allclose(model.residuals([point])[0], together[number], rtol=0, atol=1e-9)
    np.testing.assert_array_equal(model.residuals(points), together)
    assert np.abs(together[1] - together[0]).max() > 1e-3, "the parameters change nothing"


def test_the_jacobian_is_the_derivative_of_the_residuals(model: DiagnosisModel) -> None:
    point = at(model, 0.1)
    jacobian = model.base_jacobian(point)
    assert jacobian.shape == (len(model.layout.channel), len(model.parameters))
    steps = np.eye(len(model.parameters)) * STEP
    ahead = model.residuals([Point(point.base + s) for s in steps])
    behind = model.residuals([Point(point.base - s) for s in steps])
    by_difference = ((ahead - behind) / (2.0 * STEP)).T
    scale = np.abs(by_difference).max(axis=0) + 1e-6
    np.testing.assert_allclose(jacobian / scale, by_difference / scale, rtol=0, atol=2e-2)


def test_every_term_says_what_and_where_it_is_and_vanishes_at_no_strength(model: DiagnosisModel) -> None:
    terms = model.terms()
    assert terms
    assert len(set(terms)) == len(terms)
    plain = model.residuals([at(model)])[0]
    for term in terms[:: max(1, len(terms) // 25)]:
        effect, spot = model.where(term)
        assert effect.name
        assert effect.law
        assert spot.label
        others = tuple(p.starts[0] if p.starts else 0.5 * (p.lower + p.upper) for p in term.parameters[1:])
        (none,) = model.residuals([at(model).plus(term, (0.0, *others))])
        np.testing.assert_allclose(none, plain, rtol=0, atol=1e-6, err_msg=str(term))


def test_slopes_of_terms_are_differences_of_residuals(model: DiagnosisModel) -> None:
    """Whatever shorter way a model has: the direction in which a small strength moves the residuals is the same."""
    point = at(model)
    plain = model.residuals([point])[0]
    compared = 0
    for term in model.terms():
        strength = term.parameters[0]
        if strength.is_switch or any(p.is_instant for p in term.parameters) or not strength.starts:
            continue
        values = (strength.starts[0] * 1e-3, *(p.starts[0] for p in term.parameters[1:] if p.starts))
        if len(values) != len(term.parameters):
            continue
        (slope,) = strength_slopes(model, point, plain, [(term, values)])
        direct = (model.residuals([point.plus(term, values)])[0] - plain) / values[0]
        size = np.linalg.norm(direct)
        if not np.isfinite(size) or size * values[0] < 1e-4:
            continue
        cosine = float(slope @ direct / (np.linalg.norm(slope) * size))
        assert cosine > 0.99, (str(term), cosine)
        compared += 1
        if compared == 12:
            break
    assert compared >= 3


def test_a_prediction_has_a_value_for_every_sample_of_every_channel(model: DiagnosisModel) -> None:
    for number, one in enumerate(model.runs):
        values = model.predict(at(model), number)
        assert [len(v) for v in values] == [len(s.samples) for s in one.series]
        assert all(np.isfinite(v).all() for v in values)


def test_groups_hold_channels_of_the_layout(model: DiagnosisModel) -> None:
    for name, channels in model.groups().items():
        assert name
        assert set(np.asarray(channels).tolist()) <= set(range(len(model.layout.names)))


def test_a_law_comes_on_top_of_what_the_scenario_has_of_it(tmp_path: Path) -> None:
    """The arm of the example has 1e-5 N*m*s/rad of damping; what a diagnosis finds beside it is what is missing."""
    model = CASES["pendulum"](tmp_path)
    (damping,) = (t for t in model.terms() if t.identifier == "viscous_damping")
    arm = parse_scenario(ARM.replace("DAMPING", "3e-5 N*m*s/rad"), tmp_path / "scenario.yaml")
    wanted = run(arm)["arm.angle"].interp(time=model.runs[0].series[0].channel.times).values
    (told,) = model.predict(at(model).plus(damping, (2e-5,)), 0)
    np.testing.assert_allclose(told, wanted, rtol=0, atol=1e-9)


def test_a_law_with_a_shape_that_a_scenario_has_is_not_added_a_second_time(tmp_path: Path) -> None:
    shaped = "0 N*m*s/rad, band_damping: 6e-4 N*m*s/rad, band_width: 0.25 rad"
    plain, given = (
        {t.identifier for t in pendulum(tmp_path / n, d).terms()} for n, d in (("a", "0 N*m*s/rad"), ("b", shaped))
    )
    assert len(plain - given) == 1
    assert "viscous_damping" in given
