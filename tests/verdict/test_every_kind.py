"""The invariants of an answer on every kind of model: coils, heaters, an arm, one FMU, two FMUs, an amended scenario.

Each recording is made by `cosim run` with something that the scenario does not have, drawn by hypothesis; the whole of
`diagnose` runs.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.special import chdtri

from cosim.run import run
from cosim.scenario import Scenario, load_scenario, parse_scenario
from cosim.yaml_file import parse_yaml, read_text
from diagnosis.diagnose import Means, diagnose
from diagnosis.judge.diagnosis import Diagnosis, Standing, Verdict
from diagnosis.recording.readings import read_results
from diagnosis.recording.recording import Recording, load_recording
from diagnosis.recording.sensor import SensorFile
from diagnosis.recording.write import Notes, write_recording
from diagnosis.search.explanation import Settings

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[2]
RIG = ROOT / "docs" / "examples" / "rig" / "scenario.yaml"
DRAWN = settings(max_examples=2, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))


def recorded(
    scenario: Path,
    truth: Callable[[dict[str, Any]], None],
    channels: list[str],
    noise: dict[str, str],
    folder: Path,
    seed: int,
) -> Recording:
    """A recording of a scenario that was changed, read with white noise; the scenario does not know the change."""
    data = parse_yaml(read_text(scenario), scenario)
    truth(data)
    made: Scenario = parse_scenario(yaml.safe_dump(data, sort_keys=False), scenario)
    sensors = SensorFile.model_validate(
        {"default": {"rate": "5 Hz"}, "channels": {c: {"noise": n, "rate": "5 Hz"} for c, n in noise.items()}}
    )
    read = read_results(run(made), channels, sensors, seed, folder)
    write_recording(folder, read, Notes(folder.name))
    return load_recording(folder)


def keeps_what_it_says(told: Diagnosis) -> None:
    """Never `agrees` beyond the noise's limit, never an accepted finding that is no gain, never a name at a bound."""
    right = told.adequacy
    assert right is not None
    judged = [f for f in told.fit if f.is_held_out]
    samples = sum(f.samples for f in judged)
    total = sum(f.samples * f.chi_square["after"] for f in judged) / samples
    if told.verdict in (Verdict.CONSISTENT, Verdict.RECALIBRATED):
        assert not right.day, "these rigs have no room of a day"
        assert total <= chdtri(samples, 0.001) / samples * 1.02
        assert "agrees" in told.statement
    else:
        assert "agrees" not in told.statement
    assert right.is_rejected == ("reject" in told.statement or "something else is missing" in told.statement)
    for finding in told.findings:
        assert finding.probability >= max((a.probability for a in finding.alternatives), default=0.0) - 1e-9
        if finding.is_accepted:
            assert finding.held_out_gain > 0.0
        if finding.standing is Standing.NAMED:
            strength = finding.parameters[0]
            assert np.isfinite([strength.lower, strength.upper]).all()
    if not told.searched.has_physics:
        assert told.verdict in (Verdict.CANNOT_TELL, Verdict.MEASUREMENT_FAULT)


def answers(scenario: Path, training: Recording, judge: Recording) -> tuple[Diagnosis, Diagnosis]:
    """In brief and in full: the verdict is the same."""
    given_to = load_scenario(str(scenario)), [training], [judge], Settings(nulls=1)
    return tuple(diagnose(*given_to, means=Means(is_brief=brief)).diagnosis for brief in (True, False))  # type: ignore[return-value]


NOISE = {"coil[1,1].temperature": "0.25 K", "coil[2,1].temperature": "0.25 K", "supply.current": "2 mA"}
"""Of the rig of the documentation."""


def supply(data: dict[str, Any], points: list[list[str]]) -> None:
    data["components"]["supply"]["outputs"]["voltage"]["points"] = points


MONDAY = [["0 s", "0 V"], ["5 s", "0.8 V"], ["60 s", "0 V"]]
TUESDAY = [["0 s", "0 V"], ["5 s", "0.5 V"], ["40 s", "0.9 V"], ["90 s", "0 V"]]


def scenario_with(folder: Path, change: Callable[[dict[str, Any]], None]) -> Path:
    data = parse_yaml(read_text(RIG), RIG)
    change(data)
    file = folder / "scenario.yaml"
    file.write_text(yaml.safe_dump(data, sort_keys=False))
    return file


def rig_case(
    folder: Path, change: Callable[[dict[str, Any]], None], other: Callable[[dict[str, Any]], None]
) -> tuple[Path, Recording, Recording]:
    """Scenario, training and held-out recording of the rig with another truth."""
    scenario = scenario_with(folder, change)
    made = []
    for name, points, seed in (("monday", MONDAY, 1), ("tuesday", TUESDAY, 2)):

        def truth(data: dict[str, Any], points: list[list[str]] = points) -> None:
            supply(data, points)
            other(data)

        part = recorded(scenario, truth, list(NOISE), NOISE, folder / name, seed)
        text = yaml.safe_load((part.path / "recording.yaml").read_text())
        text["overrides"] = {"components": {"supply": {"outputs": {"voltage": {"points": points}}}}}
        (part.path / "recording.yaml").write_text(yaml.safe_dump(text, sort_keys=False))
        made.append(load_recording(part.path))
    return scenario, made[0], made[1]


@DRAWN
@given(st.sampled_from((1.0, 1.05, 1.6)), st.sampled_from((0.0, 0.002)))
def test_a_coil_bank(tmp_path_factory: pytest.TempPathFactory, cooling: float, alpha: float) -> None:
    def other(data: dict[str, Any]) -> None:
        own = data["components"]["actuator"]["parameters"]
        own["heat_transfer_coefficient"] = f"{60.0 * cooling} W/(m^2*K)"
        own["resistance_temperature_coefficient"] = f"{alpha} 1/K"

    folder = tmp_path_factory.mktemp("bank")
    scenario, training, judge = rig_case(folder, lambda data: None, other)
    brief, full = answers(scenario, training, judge)
    keeps_what_it_says(brief)
    assert (brief.verdict, brief.statement) == (full.verdict, full.statement)


@DRAWN
@given(st.sampled_from((1.0, 1.3)))
def test_one_fmu_whose_laws_nobody_knows(tmp_path_factory: pytest.TempPathFactory, factor: float) -> None:
    def fmu(data: dict[str, Any]) -> None:
        data["components"]["actuator"].update(fmu="niti_kinetics", parameters={})

    def other(data: dict[str, Any]) -> None:
        data["components"]["actuator"]["parameters"] = {"heat_transfer_coefficient": f"{60.0 * factor} W/(m^2*K)"}

    folder = tmp_path_factory.mktemp("fmu")
    scenario, training, judge = rig_case(folder, fmu, other)
    brief, full = answers(scenario, training, judge)
    keeps_what_it_says(brief)
    assert brief.verdict in (Verdict.CANNOT_TELL, Verdict.MEASUREMENT_FAULT)
    assert (brief.verdict, brief.statement) == (full.verdict, full.statement)
