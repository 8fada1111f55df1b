"""Cases of the proving ground of systems: truths by code of their own, and the freeze before a draw."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
import yaml

from cosim.scenario import parse_scenario
from cosim.unit.protocol import Array
from diagnosis.models.systems.fast import FastSystem
from evaluation.systems.__main__ import NotFrozen, frozen
from evaluation.systems.case import FAULTS, KINDS, course, drive, make
from evaluation.systems.effects import Course, composed, effects_inside, effects_of_actuators, with_memory
from evaluation.systems.rigs import DRIVE, RIGS, ROOM, SLIDE, Rig
from evaluation.systems.score import score


def _plain(rig: Rig, seed: int = 5) -> Course:
    inputs = drive(rig, np.random.default_rng(seed))
    states = course(rig, dict(rig.numbers), inputs, [])
    rates = np.array([rig.rates(rig.numbers, x, u) for x, u in zip(states, inputs)])
    return Course(states, rates, inputs)


@pytest.mark.parametrize("rig", RIGS, ids=lambda rig: rig.name)
def test_a_truth_without_effects_is_what_its_fmus_do(rig: Rig, tmp_path: Path) -> None:
    """Two codes of one model: NumPy integrates the truth, compiled code steps the FMUs."""
    for model in rig.models.values():
        model.build(tmp_path)
    plain = _plain(rig)
    scenario = yaml.safe_load(rig.scenario())
    for i, (name, (unit, _)) in enumerate(rig.inputs.items()):
        points = [[f"{rig.step * k!r} s", f"{u!r} {unit}"] for k, u in enumerate(plain.inputs[:, i].tolist())]
        scenario["components"]["drive"]["outputs"][name.partition(".")[2]] = {"unit": unit, "points": points}
    system = FastSystem(parse_scenario(yaml.safe_dump(scenario), tmp_path / "scenario.yaml"))
    system.set_substeps(8)
    rows = system.simulate()
    assert rows is not None
    for channel, state in rig.outputs.items():
        component, _, output = channel.partition(".")
        there = rows.values[:, system.recorded[component, output]].ravel()
        # FMUs that exchange values once in a macro-step are late by up to that: a few parts in a thousand.
        most = (5e-3 if len(rig.models) > 1 else 1e-5) * float(np.std(plain.states[:, state]))
        np.testing.assert_allclose(there, plain.states[:, state], atol=most)
    system.close()


@pytest.mark.slow
def test_every_effect_moves_the_truth_by_more_than_the_noise() -> None:
    rng = np.random.default_rng(1)
    for rig in (rig for rig in RIGS if not rig.hidden):
        plain = _plain(rig)
        drawn = [*effects_inside(rig, plain, rng), *effects_of_actuators(rig, plain)]
        for effect in [*drawn, with_memory(rig, plain, rng), composed(rig, plain, rng)]:
            try:
                with np.errstate(over="raise", invalid="raise"):
                    moved = course(rig, dict(rig.numbers), plain.inputs, [effect]) - plain.states
            except (OverflowError, FloatingPointError):
                continue  # such a truth is drawn again
            shares = [
                np.sqrt(np.mean(moved[:, s] ** 2)) / (rig.channels[c][1] * np.std(plain.states[:, s]))
                for c, s in rig.outputs.items()
            ]
            assert max(shares) > 1.0, (rig.name, effect)


def test_actuators_do_what_their_names_say() -> None:
    effects = {e.name: e for e in effects_of_actuators(SLIDE, _plain(SLIDE))}
    up = np.concatenate([np.zeros(200), np.full(800, 60.0)])
    passed = {name: e.passed(up.copy(), 1e-3) for name, e in effects.items() if e.passed is not None}
    late = SLIDE.dwell * SLIDE.step / 10.0
    assert np.argmax(passed["input_dead_time"] > 0.0) == 200 + round(late / 1e-3)
    lag = passed["input_lag"]
    assert lag[200 + round(late / 1e-3) - 1] == pytest.approx(60.0 * (1.0 - np.exp(-1.0)), rel=1e-3)
    slopes = np.diff(passed["input_rate_limit"])
    assert np.max(slopes) == pytest.approx(np.min(slopes[slopes > 1e-9][:-1]))  # one slope but for its end
    turn = np.concatenate([up, up[::-1]])
    play = effects["input_play"].passed
    assert play is not None
    followed = play(turn, 1e-3)
    assert followed[999] < 60.0
    assert followed[-1] > 0.0  # it hangs behind on both ways
    assert np.max(passed["input_saturation"]) < 60.0


def test_a_hidden_state_is_integrated_with_the_rig() -> None:
    """Held still, a Maxwell element relaxes: its state goes to the state that it follows."""
    effect = with_memory(SLIDE, _plain(SLIDE), np.random.default_rng(3))
    still = np.full((SLIDE.count * 4, 1), 40.0)
    states = course(SLIDE, dict(SLIDE.numbers), still, [effect])
    assert states[-1, 0] == pytest.approx(40.0 / 400.0, rel=1e-3)  # force by the spring of the model alone
    without = course(SLIDE, dict(SLIDE.numbers), still, [])
    assert np.max(np.abs(states - without)) > 0.005


def _made(folder: Path, kind: str, seed: int = 3, number: int = 0) -> Array:
    make(folder, kind, seed, number)
    return np.loadtxt(folder / "task" / "second" / "data.csv", delimiter=",", skiprows=1)


def test_a_case_is_the_same_each_time_and_tells_its_answer_apart(tmp_path: Path) -> None:
    first, again = (_made(tmp_path / name, "single") for name in ("one", "two"))
    np.testing.assert_array_equal(first, again)
    answer = json.loads((tmp_path / "one" / "answer.json").read_text())
    assert answer["places"][0].startswith("slide.")
    told = "".join(p.read_text() for p in (tmp_path / "one" / "task").rglob("*.yaml"))
    assert not [name for name in answer["answers"][0] if name in told]
    assert not {"answer.json"} & {p.name for p in (tmp_path / "one" / "task").rglob("*")}


def test_faults_are_in_one_stretch_of_one_recording(tmp_path: Path) -> None:
    seen = set()
    for seed in range(12):
        folder = tmp_path / str(seed)
        _made(folder, "fault", seed)
        seen.add(json.loads((folder / "answer.json").read_text())["fault"])
    assert seen == set(FAULTS)


def test_inside_an_fmu_that_hides_its_states_nothing_is_asked_by_name(tmp_path: Path) -> None:
    """What acts there is no `single` case, unless it is the same as a law at the input."""
    hiding = next(i for i, rig in enumerate(RIGS) if rig.name == "a slide by Co-Simulation")
    for seed in range(8):
        single = make(tmp_path / f"s{seed}", "single", seed, hiding)
        assert single.places == ["slide.force"] or single.answers == [["constant_force", "input_offset"]]
    hidden = make(tmp_path / "h", "hidden", 1, hiding)
    assert (hidden.places, hidden.without) == (["slide.v"], [])
    assert "integrator: internal" in (tmp_path / "h" / "task" / "scenario.yaml").read_text()


def test_kinds_are_shares() -> None:
    assert sum(KINDS.values()) == pytest.approx(1.0)
    assert {"slide", "motor"} <= {name for rig in (SLIDE, DRIVE, ROOM) for name in rig.models}


def test_the_library_is_frozen_with_the_draw(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    work = tmp_path / "work"
    work.mkdir()
    monkeypatch.chdir(work)
    for command in (["init", "-q"], ["config", "user.email", "a@b"], ["config", "user.name", "a"]):
        subprocess.run(["git", *command], check=True)
    (work / "law.py").write_text("one")
    for command in (["add", "-A"], ["commit", "-qm", "one"]):
        subprocess.run(["git", *command], check=True)
    out = tmp_path / "out"
    out.mkdir()
    commit = frozen(out, 1, 5)
    assert frozen(out, 1, 5) == commit
    with pytest.raises(NotFrozen, match="another folder"):
        frozen(out, 2, 5)
    (work / "law.py").write_text("two")
    with pytest.raises(NotFrozen, match="changes that no commit names"):
        frozen(out, 1, 5)
    subprocess.run(["git", "commit", "-qam", "two"], check=True)
    with pytest.raises(NotFrozen, match=commit):
        frozen(out, 1, 5)
    assert frozen(out, 1, 5, only_read=True) == commit


def test_an_answer_beside_the_truth_is_scored_by_place_name_and_class(tmp_path: Path) -> None:
    (tmp_path / "answer.json").write_text(
        json.dumps(
            {"kind": "single", "rig": "a rig", "places": ["slide.v"], "answers": [["dry_friction"]], "without": []}
        )
    )
    (tmp_path / "done").write_text("0")
    (tmp_path / "diagnosis").mkdir()
    finding = {
        "effect": "stribeck_friction",
        "place": "slide.v",
        "unit": "mechanical",
        "is_accepted": True,
        "standing": "class",
        "ambiguous_with": ["dry_friction"],
    }
    chi = {"before": 9.0, "recalibrated": 5.0, "after": 1.4}
    answer = {
        "findings": [finding],
        "adequacy": {"chi_square": chi},
        "verdict": "missing physics",
        "statement": "",
        "seconds": 1.0,
    }
    (tmp_path / "diagnosis" / "diagnosis.json").write_text(json.dumps(answer))
    found = score(tmp_path)
    assert (found["element"], found["name"], found["class"], found["misnamed"]) == ([True], [False], [True], False)
    assert found["gain"] == pytest.approx(0.9)
