"""Cases: what is written can be read by the diagnosis, and says nothing about the answer."""

import filecmp
import json
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
import yaml

from cosim.scenario import load_scenario
from diagnosis.candidates.registry import catalogue
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import load_recording
from evaluation.proving.__main__ import main
from evaluation.proving.case import Case
from evaluation.proving.cases import KINDS, drawn_cases, hidden_with, write_cases
from evaluation.proving.effects import measurement
from evaluation.proving.pendulum.case import PendulumCase
from evaluation.proving.setups import EFFECTS, SETUPS

SEED = 12


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("cases")
    write_cases(folder, 10, SEED, ["single", "null", "sensor", "two", "outside", "leave_one_out"])
    return folder


def recordings(folder):
    return sorted(p.parent for p in (folder / "cases").glob("*/*/recording.yaml"))


def test_every_recording_loads_and_its_scenario_follows_what_was_done(written):
    found = recordings(written)
    assert len(found) == 30  # two to learn from and one to judge by
    for folder in found:
        recording = load_recording(folder)
        scenario = scenario_of(load_scenario(folder.parent / "scenario.yaml"), recording)
        assert scenario.time.stop.to("s") == pytest.approx(recording.end, abs=1.0)
        assert all(np.isfinite(c.values).all() for c in recording.channels.values())
        temperatures = [c for c in recording.channels.values() if c.target.quantity == "temperature"]
        assert temperatures or set(recording.channels) == {"arm.angle"}
        for channel in temperatures:  # none on the arm
            assert 280.0 < np.median(channel.values) < 360.0  # kelvin, not degrees Celsius


@pytest.mark.parametrize("setup", SETUPS)
def test_scenarios_are_valid_and_name_the_coils_of_their_sheet(setup):
    path = Path("evaluation/proving/scenarios") / f"{setup}.yaml"
    scenario = load_scenario(Path(__file__).resolve().parents[2] / path)
    circuit = scenario.components.get("circuit")
    strings = [1] * SETUPS[setup].sheet.coils if circuit is None else circuit.strings
    assert tuple(strings) == SETUPS[setup].sheet.strings


def test_what_the_diagnosis_is_given_names_no_effect(written):
    effects = {e.identifier for e in (*EFFECTS, *measurement.EFFECTS)}
    for file in (written / "cases").rglob("*.yaml"):
        data = yaml.safe_load(file.read_text())
        hidden = set(data.pop("hidden", []))
        assert hidden <= effects
        text = yaml.safe_dump(data)
        assert not [e for e in effects if e in text]


def test_held_out_programmes_differ_from_those_of_training(written):
    for case in (written / "cases").iterdir():
        task = yaml.safe_load((case / "task.yaml").read_text())
        overrides = [
            yaml.safe_load((case / n / "recording.yaml").read_text())["overrides"]["components"]
            for n in (*task["training"], *task["held_out"])
        ]
        assert len({yaml.safe_dump(o) for o in overrides}) == 3


def test_answers_tell_effect_place_and_strength(written):
    for file in (written / "answers").glob("*.json"):
        answer = json.loads(file.read_text())
        expected = {"null": 0, "parameters": 0, "two": 2}.get(answer["kind"], 1)
        assert len(answer["findings"]) == expected
        for finding in answer["findings"]:
            assert finding["strength"] in ("weak", "medium", "strong")
            assert finding["elements"] or finding["channels"] or finding["place"] not in ("coil", "string")
            assert finding["is_hidden"] == (answer["kind"] == "leave_one_out")
            assert set(finding["comparable_parameters"]) <= set(finding["parameters"])


def test_clean_held_out_readings_lie_under_the_noise(written):
    for file in sorted((written / "answers").glob("*.npz")):
        answer = json.loads(file.with_suffix(".json").read_text())
        if answer["setup"] == "pendulum":
            continue  # test_pendulum.py
        recording = load_recording(written / "cases" / file.stem / "held_out_1")
        clean = np.load(file)
        stamps, values = (clean[f"held_out_1/temperature/{n}"] for n in ("stamps", "clean"))
        channels = [c for n, c in recording.channels.items() if n.endswith("temperature")]
        offsets = [c.values - np.interp(c.times, stamps, values[:, n]) for n, c in enumerate(channels)]
        spread = np.median(np.abs(np.concatenate(offsets))) / 0.6745
        # Noise and rounding to 0.1 K; single precision of the file; hundreds of readings.
        assert spread == pytest.approx(np.hypot(answer["noise"]["temperature"], 0.029), rel=0.12)


def test_the_same_seed_writes_the_same_bytes(tmp_path):
    for name in ("first", "second"):
        write_cases(tmp_path / name, 2, 7, ["single", "sensor"])
    files = sorted(p.relative_to(tmp_path / "first") for p in (tmp_path / "first").rglob("*") if p.is_file())
    assert len(files) >= 2 * (2 + 3 * 2 + 2)  # of each case: scenario, task, three sidecars and tables, answer
    same, different, missing = filecmp.cmpfiles(
        tmp_path / "first", tmp_path / "second", [str(f) for f in files], shallow=False
    )
    assert (different, missing) == ([], [])
    assert len(same) == len(files)
    write_cases(tmp_path / "other", 2, 8, ["single", "sensor"])
    assert filecmp.cmpfiles(tmp_path / "first", tmp_path / "other", [str(files[0])], shallow=False)[0] == []


def test_kinds_come_by_their_shares_and_effects_equally_often():
    cases = [case for case, _ in drawn_cases(600, 3)]
    counts = Counter(c.kind for c in cases)
    for kind, share in KINDS.items():
        assert counts[kind] == pytest.approx(600 * share / sum(KINDS.values()), abs=1.0)
    pendulums = [c for c in cases if isinstance(c, PendulumCase)]
    assert 0.05 < len(pendulums) / len(cases) < 0.17
    assert {c.engine for c in pendulums} == {"own", "bullet", "mujoco"}
    cases = [c for c in cases if isinstance(c, Case)]
    mechanical = [c for c in cases if any(e.unit == "mechanical" for e in c.effects)]
    moved = [*mechanical, *pendulums]
    assert sum(c.engine == "mujoco" for c in moved) >= len(moved) / 4  # as the aims ask
    singles = Counter(c.effects[0].identifier for c in cases if c.kind == "single")
    assert set(singles) == {e.identifier for e in EFFECTS if e.is_named}
    assert max(singles.values()) - min(singles.values()) <= 3  # three strengths to a deck
    both = [c for c in cases if c.kind == "two"]
    assert sum(len({e.unit for e in c.effects}) == 2 for c in both) > len(both) / 3
    assert all(c.hidden == hidden_with(c.effects[0].identifier) for c in cases if c.kind == "leave_one_out")


def test_with_an_effect_its_equal_equations_are_hidden_and_nothing_else():
    assert hidden_with("tilt") == ("tilt",)
    assert hidden_with("sheath") == ("sheath", "lossy_second_mass", "second_mass")
    assert hidden_with("transformation_shift") == ("transformation_shift", "stress_dependent_transformation")


def test_named_effects_have_the_catalogues_name_and_the_others_none_of_its():
    names = {c.identifier for c in catalogue()}
    for effect in (*EFFECTS, *measurement.EFFECTS):
        assert (effect.identifier in names) == effect.is_named, effect.identifier


def test_comparable_parameters_are_the_catalogues():
    parameters = {c.identifier: {p.name for p in c.parameters} for c in catalogue()}
    for effect in (*EFFECTS, *measurement.EFFECTS):
        if effect.is_named:
            assert set(effect.same_parameters) <= parameters[effect.identifier], effect.identifier


def test_unknown_kinds_and_no_cases_are_refused(tmp_path, capsys):
    assert main([str(tmp_path), "--kinds", "ghost"]) == 2
    assert "there is no kind of case `ghost`" in capsys.readouterr().err
    assert main([str(tmp_path), "--cases", "0"]) == 2
    assert "ask for at least one" in capsys.readouterr().err


@pytest.mark.parametrize("seed", [235, 1374])
def test_instants_of_a_programme_rise_as_they_are_written(seed):
    # With these seeds the programme of minor loops once had two switches within the last written digit.
    for setup in SETUPS.values():
        for shape in setup.shapes.values():
            programme = shape(np.random.default_rng(seed), setup.top, setup.stop)
            written = [float(f"{time:.6g}") for time in programme.times]
            assert written == sorted(set(written))
