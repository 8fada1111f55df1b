"""The other methods do what they are known to do, so that the comparison with them is fair."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from diagnosis.search.search import recalibrate
from evaluation.proof import gaussian_process, sparse_regression
from evaluation.proof.baselines import baselines
from evaluation.proof.ground import Draw, make_cases
from evaluation.proof.oracle import read_data
from evaluation.proof.variables import NAMES, Course, courses

SAMPLES = 240


def _course(law, seed: int, quantity: str = "extension", noise: float = 1.0, channel: str = "coil[1].x") -> Course:
    """A channel whose residual follows a law of its variables, `law(columns by name) -> residuals`, in unit noise."""
    rng = np.random.default_rng(seed)
    times = np.linspace(0.0, 120.0, SAMPLES)
    drive = np.repeat(rng.uniform(0.0, 3.0, 12), SAMPLES // 12)
    since = times % 10.0
    temperature = 295.0 + 10.0 * drive * (1.0 - np.exp(-since / 3.0))
    columns = [temperature, np.gradient(temperature, times), rng.uniform(0.0, 5e-3, SAMPLES), drive, since, times]
    variables = np.stack(columns, axis=1)
    residuals = law(dict(zip(NAMES, variables.T))) + noise * rng.standard_normal(SAMPLES)
    return Course(channel, quantity, times, residuals, variables, np.ones(SAMPLES, dtype=bool))


def _left(held_out: Course, predicted: np.ndarray) -> float:
    return float(np.mean((held_out.residuals - predicted) ** 2))


def test_a_gaussian_process_learns_a_smooth_law_of_the_temperature() -> None:
    def law(v):
        return 5.0 * np.sin((v["temperature"] - 295.0) / 6.0)

    training, held_out = [_course(law, 1), _course(law, 2)], _course(law, 3)
    (predicted,) = gaussian_process.predict(training, [held_out])
    assert np.mean(held_out.residuals**2) > 8.0
    # Noise is 1; 300 samples of noise 1 leave an error of some tenths of it in four dimensions.
    assert _left(held_out, predicted) < 1.6


def test_a_gaussian_process_adds_next_to_nothing_to_noise() -> None:
    training, held_out = [_course(lambda v: 0.0, 4), _course(lambda v: 0.0, 5)], _course(lambda v: 0.0, 6)
    (predicted,) = gaussian_process.predict(training, [held_out])
    assert _left(held_out, predicted) < 1.15 * np.mean(held_out.residuals**2)


def test_sparse_regression_finds_the_terms_of_an_algebraic_law() -> None:
    def law(v):
        return 3.0 * (v["drive"] - 1.5) + 2.0 * (v["drive"] - 1.5) ** 2

    training, held_out = [_course(law, 7, noise=0.02), _course(law, 8, noise=0.02)], _course(law, 9, noise=0.02)
    (predicted,), terms = sparse_regression.predict(training, [held_out])
    assert terms <= 4.0  # constant, drive, drive squared, and at most one of chance
    assert _left(held_out, predicted) < 0.01 * np.mean(held_out.residuals**2)


def test_sparse_regression_finds_the_dynamics_of_a_temperature() -> None:
    def law(v):
        found = np.zeros(SAMPLES)
        for n, size in enumerate(np.diff(v["time"])):
            found[n + 1] = found[n] + size * (-0.5 * found[n] + 4.0 * v["drive"][n])
        return found

    training = [_course(law, n, "temperature", 0.01) for n in (10, 11)]
    held_out = _course(law, 12, "temperature", 0.01)
    (predicted,), _ = sparse_regression.predict(training, [held_out])
    # Derivatives of smoothed samples blur the switches: a tenth of the residual is left, not a hundredth.
    assert _left(held_out, predicted) < 0.1 * np.mean(held_out.residuals**2)


def test_a_law_that_runs_away_is_infinite() -> None:
    def law(v):
        found = np.zeros(SAMPLES)
        for n, size in enumerate(np.diff(v["time"])):
            found[n + 1] = found[n] + size * (0.2 * found[n] + 0.1 * v["drive"][n])
        return found

    training = [_course(law, 13, "temperature", 0.001)]
    rising = training[0].times < 40.0  # the growth is learnt, not where it ends
    training = [replace(c, used=rising) for c in training]
    held_out = _course(law, 14, "temperature", 0.001)
    (predicted,), terms = sparse_regression.predict(training, [held_out])
    assert terms >= 1.0
    assert np.isinf(predicted).all()


def test_held_out_residuals_are_not_looked_at() -> None:
    training, held_out = [_course(lambda v: v["drive"], 15)], _course(lambda v: v["drive"], 16)
    other = replace(held_out, residuals=0.0 * held_out.residuals)
    assert np.array_equal(*(gaussian_process.predict(training, [h])[0] for h in (held_out, other)))
    assert np.array_equal(*(sparse_regression.predict(training, [h])[0][0] for h in (held_out, other)))


def test_both_are_given_the_residuals_and_variables_of_a_case(tmp_path: Path) -> None:
    make_cases(tmp_path, Draw(1, 3, ("single",), ("heaters",)))
    data = read_data(tmp_path / "cases" / "case_0001")
    base = recalibrate(data.model)
    given = courses(data.model, base.point)
    together = np.concatenate([np.where(c.used, c.residuals, 0.0) for c in given])
    # The model's own residuals are freed of a zero of each channel and divided by noise and rounding together.
    assert np.corrcoef(together, base.residuals)[0, 1] > 0.9
    variables = dict(zip(NAMES, given[0].variables.T))
    assert 280.0 < variables["temperature"].min() < variables["temperature"].max() < 400.0
    assert 0.0 <= variables["drive"].min() < variables["drive"].max() < 10.0  # [W]
    assert variables["since_switch"].max() < variables["time"].max()
    values, terms, seconds = baselines(data, base)
    assert set(values) == set(seconds) == {"gaussian process", "sparse regression"}
    assert values["gaussian process"] is not None
    assert terms > 0.0
