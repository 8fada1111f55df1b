"""Held-out readings within the error of what was fitted: closed forms, nulls over seeds, and models that are wrong."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cosim.scenario import load_scenario
from cosim.unit.protocol import AnyArray, Array
from diagnosis.judge.acceptance import Accepted, accept
from diagnosis.judge.agreement import agreement
from diagnosis.judge.parameter_error import without_whitening, zeroed
from diagnosis.judge.unfitted import HeldOutReadings, Unfitted, left_out_stretches, raw_residuals
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.models.coil_network.runs import ZERO
from diagnosis.models.cosimulation.model import ClosedLoopModel
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.models.wrappers.quasi_likelihood import QuasiLikelihoodModel
from diagnosis.recording.recording import Recording
from diagnosis.search.fit import fit
from diagnosis.search.problem import Point, Term
from diagnosis.search.search import Explanation, Outcome
from diagnosis.search.structure import Structure, structure
from tests.diagnosis.two_heaters import conditions, record, scenario
from tests.search.line_model import BEND, TIME, WAVE
from tests.verdict.lines import NOISE, Lines, Run, renamed

LINE = 0.3 + 1.2 * TIME
#: What a short training sees of the line: a tenth of it, from which the slope is known to 0.5.
SHORT = TIME < 0.1


class Seen(Lines):
    """A line of which some readings count.

    Args:
        truth: See `Lines`.
        seed: See `Lines`.
        seen: Which count, shape (samples,).
    """

    def __init__(self, truth: Array, seed: int, seen: AnyArray) -> None:
        super().__init__(truth, seed)
        self.seen = seen

    @property
    def runs(self) -> Sequence[Run]:
        (run,) = super().runs
        return (Run((replace(run.series[0], used=self.seen),)),)

    def residuals(self, points: Sequence[Point]) -> Array:
        return np.where(self.seen, super().residuals(points), 0.0)

    def base_jacobian(self, point: Point) -> Array:
        return np.where(self.seen[:, None], super().base_jacobian(point), 0.0)


def held_out(judge: Lines, trained: Lines, beginning: float = 0.0) -> HeldOutReadings:
    return HeldOutReadings(judge, trained, [Recording(Path(), "held out", {}, (), {}, 1.0, 0.0, beginning=beginning)])


def fitted(model: Lines, *terms: Term) -> Outcome:
    base = fit(model, Point(np.zeros(2)))
    point = base.point
    for term in terms:
        point = point.plus(term, (0.1,))
    best = Explanation(fit(model, point)) if terms else Explanation(base)
    quiet = Structure(0.0, "", 0.0, 0.0)
    return Outcome(base, quiet, best, structure(best.fit.residuals, model.layout), (best,), 6.0, 0.01, 1)


def judged(model: Lines, unfitted: Unfitted, *terms: Term) -> Accepted:
    training = left_out_stretches(model, ["training"])
    return accept(model, fitted(model, *terms), unfitted, training, lambda term: False)


def test_the_sum_is_that_of_the_covariance_of_predictions():
    """r^T (I + J S J^T + zero)^-1 r, S the inverse of the training's normal matrix and the priors."""
    training, judge = Seen(LINE, 1, SHORT), Lines(LINE, 2)
    point = fit(training, Point(np.zeros(2))).point
    told = held_out(judge, training)
    predicted = told.predict(point)
    columns = training.base_jacobian(point)
    sigma = np.linalg.inv(columns.T @ columns + np.eye(2))
    jacobian = judge.base_jacobian(point)
    covariance = np.eye(len(TIME)) + jacobian @ sigma @ jacobian.T + ZERO**2
    left = raw_residuals(judge, point)
    wanted = left @ np.linalg.solve(covariance, left)
    found = told.tested(point, predicted)
    assert found is not None
    assert found.total == pytest.approx(wanted, rel=1e-6)
    assert found.channels.tolist() == pytest.approx([wanted], rel=1e-6)  # one channel: both are one


def test_a_right_model_is_rejected_by_noise_alone_and_not_within_the_error_of_a_short_training():
    plainly, within = 0, 0
    for seed in range(100):
        slope = 1.0 + np.random.default_rng([seed, 5]).standard_normal()
        training, judge = (
            type_(0.3 + slope * TIME)
            for type_ in (
                lambda truth, seed=seed: Seen(truth, 2 * seed, SHORT),
                lambda truth, seed=seed: Lines(truth, 2 * seed + 1),
            )
        )
        found = judged(training, held_out(judge, training))
        plainly += agreement(found.after.residuals, held_out(judge, training).readings).is_rejected
        within += found.agreement.is_rejected
        assert found.agreement.needs_parameter_error is (
            not found.agreement.is_rejected
            and agreement(found.after.residuals, held_out(judge, training).readings).is_rejected
        )
    assert plainly > 50
    assert within <= 2  # two tests at 0.001 each, 100 draws: 0.2 expected at most


@pytest.mark.parametrize(
    "more",
    [
        lambda t: 0.1 * np.sin(25.0 * t),
        lambda t: 1.5 * t**2,
        lambda t: 40.0 * t**2,
        lambda t: 30.0 * (t > 0.5),
        lambda t: 1e4 * np.sin(25.0 * t),
    ],
    ids=("as large as the noise", "bend", "large bend", "jump", "far off"),
)
def test_a_wrong_model_is_rejected_however_little_the_training_said(more: Callable[[Array], Array]):
    for seed in range(10):
        truth = LINE + more(TIME)
        training, judge = Seen(truth, 2 * seed, SHORT), Lines(truth, 2 * seed + 1)
        assert judged(training, held_out(judge, training)).agreement.is_rejected


def test_a_slope_that_is_far_outside_the_error_of_the_training_is_rejected():
    """Both recordings are lines, but not of one rig: the training knows the slope to 0.5."""
    for seed in range(10):
        training, judge = Seen(LINE, 2 * seed, SHORT), Lines(LINE + 12.0 * TIME, 2 * seed + 1)
        assert judged(training, held_out(judge, training)).agreement.is_rejected


def test_large_errors_of_a_model_are_no_excuse_for_it():
    """The error of what was fitted is that of the noise, by how much the model errs in the training as it may."""
    truth = LINE + 3.0 * np.sin(25.0 * TIME)
    training, judge = Lines(truth, 1), Lines(truth + 0.2 * TIME, 2)
    point = fit(training, Point(np.zeros(2))).point
    plain = held_out(judge, training)
    tempered = held_out(judge, QuasiLikelihoodModel(training, np.array([1e4])))  # type: ignore[arg-type]
    first, second = (u.tested(point, u.predict(point)) for u in (plain, tempered))
    assert first is not None
    assert second is not None
    assert second.total == pytest.approx(first.total, rel=1e-9)
    assert judged(training, plain).agreement.is_rejected


def test_numbers_that_are_printed_are_those_of_the_prediction():
    steep = 0.3 + 2.5 * TIME
    training, judge = Seen(steep, 0, SHORT), Lines(steep, 1)
    found = judged(training, held_out(judge, training))
    plain = agreement(found.after.residuals, held_out(judge, training).readings)
    assert plain.is_rejected
    assert not found.agreement.is_rejected
    assert found.agreement.chi_square == plain.chi_square
    assert [c.rmse for c in found.agreement.channels] == [c.rmse for c in plain.channels]
    assert found.agreement.excess == plain.excess


def test_the_strength_of_a_law_has_an_error_too():
    """A bend that a tenth of the line hardly shows: with it the readings are met within its error, without it not."""
    truth = LINE + 4.0 * TIME**2
    within = 0
    for seed in range(40):
        training, judge = Seen(truth, 2 * seed, TIME < 0.4), Lines(truth, 2 * seed + 1)
        point = fitted(training, BEND).best.fit.point
        unfitted = held_out(judge, training)
        predicted = unfitted.predict(point)
        assert agreement(predicted.residuals, unfitted.readings, unfitted.tested(point, predicted)).samples == len(TIME)
        within += agreement(predicted.residuals, unfitted.readings, unfitted.tested(point, predicted)).is_rejected
        assert judged(training, unfitted).agreement.is_rejected
    assert within <= 1


def test_a_number_of_the_day_moves_at_the_price_of_its_prior_and_together_with_what_was_fitted():
    """offset of the day 0.8 away, slope of the rig hardly known: neither alone explains the readings."""
    within = 0
    for seed in range(40):
        training = renamed(Seen(LINE, 2 * seed, SHORT), "offset of recording 1")
        judge = renamed(Lines(LINE + 0.8, 2 * seed + 1), "offset of recording 1")
        within += judged(training, held_out(judge, training)).agreement.is_rejected
    assert within <= 1
    far = renamed(Lines(LINE + 40.0, 3), "offset of recording 1")
    training = renamed(Seen(LINE, 2, SHORT), "offset of recording 1")
    assert judged(training, held_out(far, training)).agreement.is_rejected


def test_what_was_fitted_to_a_first_stretch_has_an_error_that_hangs_on_the_rest():
    """The day's offset from 0.05 s, the rig's slope from a short training."""
    within, plainly = 0, 0
    for seed in range(50):
        training = renamed(Seen(LINE, 2 * seed, SHORT), "offset of recording 1")
        judge = renamed(Lines(LINE + 0.8, 2 * seed + 1), "offset of recording 1")
        unfitted = held_out(judge, training, beginning=0.05)
        found = judged(training, unfitted)
        plainly += agreement(found.after.residuals, unfitted.readings).is_rejected
        within += found.agreement.is_rejected
    assert plainly > 25
    assert within <= 1
    wrong = renamed(Lines(LINE + 0.8 + 1.5 * TIME**2, 1), "offset of recording 1")
    training = renamed(Seen(LINE, 0, SHORT), "offset of recording 1")
    assert judged(training, held_out(wrong, training, beginning=0.05)).agreement.is_rejected


def test_stretches_that_were_left_out_are_predicted_with_an_error_too():
    """Ten readings, two left out in turn: a bend through the others says little about the first and the last two."""
    few = np.arange(len(TIME)) % 40 == 0
    plainly, within = 0, 0
    for seed in range(40):
        model = Seen(LINE + 3.0 * TIME**2, seed, few)
        unfitted = left_out_stretches(model, ["training"])
        point = fitted(model, BEND).best.fit.point
        predicted = unfitted.predict(point)
        plainly += agreement(predicted.residuals, unfitted.readings).is_rejected
        within += agreement(predicted.residuals, unfitted.readings, unfitted.tested(point, predicted)).is_rejected
    assert plainly > 4
    assert within <= 1
    wrong = Seen(LINE + 2.0 * np.sin(25.0 * TIME), 1, few)
    assert judged(wrong, left_out_stretches(wrong, ["training"])).agreement.is_rejected


def test_a_model_without_numbers_is_compared_with_the_noise_alone():
    class Bare(Lines):
        def __init__(self, truth: Array, seed: int) -> None:
            super().__init__(truth, seed)
            self.parameters = []

        def signal(self, point: Point) -> Array:
            return np.asarray(super().signal(Point(np.array([0.3, 1.2]), point.terms)))

        def base_jacobian(self, point: Point) -> Array:
            return np.zeros((len(TIME), 0))

    model, judge = Bare(LINE, 1), Bare(LINE + 1.0 * TIME, 2)
    unfitted = held_out(judge, model)
    point = Point(np.zeros(0))
    predicted = unfitted.predict(point)
    assert unfitted.tested(point, predicted) is None
    assert agreement(predicted.residuals, unfitted.readings).is_rejected


def test_a_zero_that_is_unknown_is_taken_as_in_the_test_against_noise():
    rng = np.random.default_rng(0)
    values = rng.standard_normal(300)
    channel = np.repeat([0, 1], [100, 200])
    left = zeroed(values[:, None], channel, np.array([True, False]))[:, 0]
    covariance = np.eye(100) + ZERO**2
    assert left[:100] @ left[:100] == pytest.approx(values[:100] @ np.linalg.solve(covariance, values[:100]))
    np.testing.assert_array_equal(left[100:], values[100:])


def test_a_wave_is_known_as_well_as_its_readings_say():
    """What is well known is no excuse: a wave of another size in the held-out readings rejects the model."""
    model = Lines(LINE + 0.3 * np.sin(25.0 * TIME), 1)
    unfitted = held_out(Lines(LINE + 0.6 * np.sin(25.0 * TIME), 2), model)
    point = fitted(model, WAVE).best.fit.point
    predicted = unfitted.predict(point)
    assert agreement(predicted.residuals, unfitted.readings, unfitted.tested(point, predicted)).is_rejected
    assert NOISE == 0.1


def powers(first: str, second: str) -> dict[str, Any]:
    """Overrides of the heaters' programmes."""
    courses = {
        "power_1": {"points": [["0 s", "0 W"], ["8 s", first], ["24 s", "0 W"]]},
        "power_2": {"points": [["0 s", "0 W"], ["16 s", second], ["32 s", "0 W"]]},
    }
    return {"drive": {"outputs": courses}}


@pytest.mark.parametrize("kind", [CoilNetworkModel, ClosedLoopModel])
def test_heaters_that_were_hardly_warmed_in_the_training(kind: Callable[..., DiagnosisModel], tmp_path: Path) -> None:
    """By the coil network and by the co-simulation: a heat capacity known to a half, which 5 mW do not show.

    A sensor that swings by four times its noise is rejected by the same readings.
    """
    scenario(tmp_path)
    file = tmp_path / "scenario.yaml"
    text = file.read_text().replace("use_regressed_cooling_rate: false, ", "")
    file.write_text(text.replace("    parameters: {init", "    parameter_set: tclab_heater\n    parameters: {init"))
    base = load_scenario(file)
    own = conditions(specific_heat="650 J/(kg*K)")["components"]

    def recorded(name: str, first: str, second: str, seed: int) -> Recording:
        said = {"components": powers(first, second)}
        return record(base, tmp_path / name, {"components": {**said["components"], **own}}, seed, said)

    low, high = recorded("low", "5 mW", "4 mW", 1), recorded("high", "0.3 W", "0.2 W", 2)
    args = ((),) if kind is CoilNetworkModel else ()
    trained, judge = kind(base, [low], *args), kind(base, [high], *args)
    point = fit(trained, Point(np.zeros(len(trained.parameters)))).point

    def found(model: DiagnosisModel, one: Recording) -> tuple[bool, bool]:
        unfitted = HeldOutReadings(model, trained, [one])
        predicted = unfitted.predict(point)
        plain = agreement(predicted.residuals, unfitted.readings)
        return plain.is_rejected, agreement(
            predicted.residuals, unfitted.readings, unfitted.tested(point, predicted)
        ).is_rejected

    assert found(judge, high) == (True, False)
    channels = {
        n: replace(c, values=c.values + 2.0 * NOISE * np.sin(c.times)) if "[1]" in n else c
        for n, c in high.channels.items()
    }
    wrong = replace(high, channels=channels)
    assert found(kind(base, [wrong], *args), wrong) == (True, True)


def test_derivatives_of_readings_are_those_of_what_is_measured(tmp_path: Path) -> None:
    """A coil network takes a share of each channel's sum away; what judges is not whitened."""
    base = scenario(tmp_path)
    said = {"components": powers("0.3 W", "0.2 W")}
    one = record(base, tmp_path / "one", said, 1, said)
    model = CoilNetworkModel(base, [one], ())
    middle, used = np.full(len(model.parameters), 0.1), np.concatenate([s.used for s in model.runs[0].series])
    columns = without_whitening(model, np.asarray(model.base_jacobian(Point(middle)), dtype=np.float64))
    for number in range(len(middle)):
        step = 1e-3 * np.eye(len(middle))[number]
        high, low = (raw_residuals(model, Point(middle + sign * step)) for sign in (1.0, -1.0))
        wanted = ((high - low) / 2e-3)[used]
        np.testing.assert_allclose(columns[used, number], wanted, atol=1e-3 * np.abs(columns).max())
