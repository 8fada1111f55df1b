"""Every law of the library at every rig of the sets by strangers: placed, and simulated with its first numbers.

Rigs of a test suite are alike: they have a position beside each velocity, and units. Those of strangers are not.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from diagnosis.candidates.registry import catalogue
from diagnosis.models.build import model_of
from diagnosis.recording.recording import load_recording
from diagnosis.search.problem import Point
from evaluation.strangers.__main__ import SETS, convert, make
from evaluation.strangers.first_set import Rng
from evaluation.strangers.truth import Truth

Written = Callable[[Path, Rng], Truth]


def _rigs(name: str) -> list[Written]:
    """The first case of every rig of a set."""
    return list({case.__name__.partition("_")[0]: case for case in reversed(SETS[name])}.values())


def _stopped(case: Written, folder: Path) -> list[str]:
    """Laws whose simulation stops where that of the scenario does not, but for cubes, which drive themselves."""
    make(case, folder, 3)
    convert(folder, 120.0)
    names = json.loads((folder / "answer.json").read_text(encoding="utf-8"))["training"]
    recordings = [load_recording(folder / "task" / n) for n in names]
    model = model_of(load_scenario(str(folder / "task" / "scenario.yaml")), recordings, catalogue())
    nominal = Point(np.zeros(len(model.parameters)))
    assert np.isfinite(model.residuals([nominal])).all()
    terms = list(model.terms())
    assert terms
    first = [nominal.plus(t, tuple(p.starts[0] for p in t.parameters)) for t in terms]
    rows = np.concatenate([model.residuals([p]) for p in first])
    return [
        f"{t.identifier} at {t.place}"
        for t, row in zip(terms, rows)
        if not np.isfinite(row).all() and "cubed" not in t.identifier
    ]


def _but_powers(stopped: list[str]) -> list[str]:
    return [name for name in stopped if not any(p in name for p in ("square", "quadratic_spring", "modulated"))]


@pytest.mark.parametrize("case", [*_rigs("ninth"), *_rigs("tenth")], ids=lambda c: c.__name__)
def test_every_law_runs_at_every_rig_of_the_last_sets(case: Written, tmp_path: Path) -> None:
    assert _stopped(case, tmp_path) == []


@pytest.mark.parametrize("case", _rigs("eleventh"), ids=lambda c: c.__name__)
def test_every_law_but_powers_runs_at_every_rig_of_the_eleventh_set(case: Written, tmp_path: Path) -> None:
    """A platform that nothing holds, and the carriers of a laser, run away by powers of themselves and of an angle."""
    assert _but_powers(_stopped(case, tmp_path)) == []


@pytest.mark.slow
@pytest.mark.parametrize(
    "case",
    [c for name in ("fourth", "fifth", "sixth", "seventh", "eighth") for c in _rigs(name) if "bank" not in c.__name__],
    ids=lambda c: c.__name__,
)
def test_every_law_but_powers_runs_at_every_rig_of_earlier_sets(case: Written, tmp_path: Path) -> None:
    """A mass on a mass, driven by the square of the other's speed, runs away."""
    assert _but_powers(_stopped(case, tmp_path)) == []
