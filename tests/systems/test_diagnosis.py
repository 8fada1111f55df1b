"""Concealed effects of systems of FMUs, found from recordings; truths are integrated by SciPy."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cosim.cli import main
from cosim.run import run
from cosim.scenario import load_scenario
from tests.systems.rigs import oscillator, oscillator_recordings


def diagnosis(scenario: Path, recordings: list[Path], out: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Content of diagnosis.json; the last recording is held out."""
    given = [str(scenario)]
    for folder in recordings[:-1]:
        given += ["--recording", str(folder)]
    monkeypatch.setattr("sys.argv", ["cosim", "diagnose", *given, "--held-out", str(recordings[-1]), "--out", str(out)])
    with pytest.raises(SystemExit) as ended:
        main()
    assert not ended.value.code
    found: dict[str, Any] = json.loads((out / "diagnosis.json").read_text())
    return found


def test_a_spring_that_hardens_is_found_named_and_put_into_a_scenario_that_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scenario = oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: -500.0 * x**3)
    found = diagnosis(scenario, recordings, tmp_path / "answer", monkeypatch)
    (one,) = found["findings"]
    assert (one["effect"], one["place"], one["is_named"]) == ("cubic_spring", "rig.v", True)
    (strength,) = one["parameters"]
    assert strength["lower"] <= 500.0 <= strength["upper"]
    assert found["verdict"] == "missing physics"
    assert 0.9 < found["adequacy"]["chi_square"]["after"] < 1.1
    amended = load_scenario(str(tmp_path / "answer" / "amended" / "scenario.yaml"))
    with_it, without = (run(s)["rig.position"].values for s in (amended, load_scenario(str(scenario))))
    assert np.isfinite(with_it).all()
    assert amended.components["rig"].added_terms[0].to == "der(v)"  # type: ignore[union-attr]
    assert with_it.shape == without.shape


@pytest.mark.slow
def test_nothing_is_found_where_numbers_are_off_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scenario = oscillator(tmp_path)
    found = diagnosis(scenario, oscillator_recordings(tmp_path, lambda x, v: 0.0), tmp_path / "answer", monkeypatch)
    assert found["findings"] == []
    assert found["verdict"] in ("recalibrated", "consistent")


@pytest.mark.slow
def test_two_laws_that_hide_each_other_are_found_together(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Dry friction with a constant force."""
    scenario = oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: -4.0 * float(np.tanh(v / 0.02)) + 6.0)
    found = diagnosis(scenario, recordings, tmp_path / "answer", monkeypatch)
    names = {name for f in found["findings"] for name in (f["effect"], *f["ambiguous_with"])}
    assert "dry_friction" in names
    assert {"constant_force", "input_offset"} & names


@pytest.mark.slow
def test_an_fmu_that_hides_its_states_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scenario = oscillator(tmp_path, "internal")
    recordings = oscillator_recordings(tmp_path, lambda x, v: -3.0 * v)
    found = diagnosis(scenario, recordings, tmp_path / "answer", monkeypatch)
    assert any("hides its states" in text for text in found["searched"]["untried"])
