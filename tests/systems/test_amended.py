"""The amended model of a system: it runs, goes out as SSP, and a second diagnosis begins from it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.run import run
from cosim.scenario import load_scenario
from cosim.ssp.export import export_ssp
from cosim.ssp.importer import import_ssp
from tests.systems.rigs import oscillator, oscillator_recordings
from tests.systems.test_diagnosis import diagnosis


def _cubic(x: float, v: float) -> float:
    return -500.0 * x**3


def _with_friction(x: float, v: float) -> float:
    return _cubic(x, v) - 4.0 * float(np.tanh(v / 0.02))


@pytest.mark.slow
def test_a_second_diagnosis_begins_from_the_amended_model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """After the first nothing is left; where the rig has got another effect since, that one is found and both stay."""
    first = oscillator_recordings(tmp_path / "first", _cubic)
    found = diagnosis(oscillator(tmp_path), first, tmp_path / "one", monkeypatch)
    assert [f["effect"] for f in found["findings"]] == ["cubic_spring"]
    amended = tmp_path / "one" / "amended" / "scenario.yaml"

    # it goes out as SSP and comes back: the same outputs, to the last bit
    export_ssp(load_scenario(str(amended)), tmp_path / "amended.ssp")
    again = load_scenario(str(import_ssp(tmp_path / "amended.ssp", tmp_path / "imported").scenario))
    before, after = run(load_scenario(str(amended))), run(again)
    np.testing.assert_array_equal(before["rig.position"].values, after["rig.position"].values)

    # the same rig once more
    null = diagnosis(amended, first, tmp_path / "two", monkeypatch)
    assert null["findings"] == []
    assert null["verdict"] in ("recalibrated", "consistent")

    # the rig rubs since
    later = oscillator_recordings(tmp_path / "later", _with_friction, (0.35, 0.45, 0.55))
    second = diagnosis(amended, later, tmp_path / "three", monkeypatch)
    (one,) = second["findings"]
    assert (one["effect"], one["place"]) == ("dry_friction", "rig.v")
    (strength,) = one["parameters"]
    assert strength["lower"] <= 4.0 <= strength["upper"]
    both = load_scenario(str(tmp_path / "three" / "amended" / "scenario.yaml"))
    terms = both.components["rig"].added_terms  # type: ignore[union-attr]
    assert len(terms) == 2
    assert "x ** 3" in terms[0].formula
    assert "tanh" in terms[1].formula
    assert np.isfinite(run(both)["rig.position"].values).all()
