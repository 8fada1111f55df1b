"""Faults that are written into files of recordings, by what they do to numbers that a person knows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from cosim.unit.protocol import Array
from evaluation.strangers import spoil
from evaluation.strangers.spoil import FAULTS, Fault, read, written
from evaluation.strangers.spoiled import _scored, summary

COUNT = 201
TIMES: Array = np.linspace(0.0, 100.0, COUNT)


def folder(path: Path, name: str = "first", second: str = "degC") -> Path:
    """Two temperatures, a force, and a heater with a course of six levels; the clock counts from 10 s."""
    own = path / name
    own.mkdir()
    bath = 20.0 + 80.0 * TIMES / 100.0
    rows = [
        f"{10.0 + t:.9g},{b:.9g},{b / 2.0:.9g},{np.sin(t / 5.0) - 0.2:.9g}" for t, b in zip(TIMES, bath, strict=True)
    ]
    (own / "data.csv").write_text("\n".join(["t,bath,lid,force", *rows]) + "\n", encoding="utf-8")
    level = 100.0 if name == "first" else 300.0
    points = [[f"{20 * n} s", f"{level * (n % 3):g} W"] for n in range(6)]
    keys = {
        "title": name,
        "table": "data.csv",
        "time": {"column": "t", "unit": "s", "zero": 10.0},
        "overrides": {"components": {"mains": {"outputs": {"heater": {"points": points}}}}},
        "channels": {
            "pot.bath": {"column": "bath", "unit": "degC", "noise": "0.1 K"},
            "pot.lid": {"column": "lid", "unit": second, "noise": "0.1 K"},
            "pot.force": {"column": "force", "unit": "N", "noise": "0.01 N"},
        },
    }
    (own / "recording.yaml").write_text(yaml.safe_dump(keys, sort_keys=False), encoding="utf-8")
    return own


def spoiled(path: Path, name: str, seed: int = 0) -> tuple[Fault, dict[str, Array], spoil.Files]:
    """A fault, and what is read from the files after it."""
    own = folder(path)
    folder(path, "second")
    before = (path / "second" / "data.csv").read_bytes()
    files = read(own)
    fault = getattr(spoil, name)(files, np.random.default_rng(seed))
    assert fault is not None
    assert fault.recording == "first"
    written(files)
    assert (path / "second" / "data.csv").read_bytes() == before
    again = read(own)
    return fault, {n: again.values(n) for n in again.channels}, again


def plain() -> dict[str, Array]:
    bath = 20.0 + 80.0 * TIMES / 100.0
    return {"pot.bath": bath, "pot.lid": bath / 2.0, "pot.force": np.sin(TIMES / 5.0) - 0.2}


def changed(found: dict[str, Array]) -> list[str]:
    return [n for n, v in plain().items() if not np.allclose(found[n], v, atol=1e-6)]


def test_units_are_those_that_a_person_knows() -> None:
    """Water boils at 212 degF, an inch is 25.4 mm, a turn in a second is 60 rpm."""
    known = {
        ("degC", "degF"): (100.0, 212.0),
        ("degC", "K"): (0.0, 273.15),
        ("degF", "degC"): (32.0, 0.0),
        ("mm", "in"): (25.4, 1.0),
        ("bar", "psi"): (1.0, 14.5),
        ("mbar", "mmHg"): (1013.25, 760.0),
        ("deg", "gon"): (90.0, 100.0),
        ("rad", "deg"): (np.pi, 180.0),
        ("rpm", "rad/s"): (60.0, 2.0 * np.pi),
        ("deg/s", "rpm"): (360.0, 60.0),
        ("m/s", "km/h"): (10.0, 36.0),
        ("km/h", "mph"): (100.0, 62.137),
        ("N", "kgf"): (9.81, 1.0),
        ("kg", "lb"): (1.0, 2.2046),
        ("g", "oz"): (28.35, 1.0),
        ("L/min", "m^3/h"): (1000.0, 60.0),
        ("L/min", "gal/min"): (3.785, 1.0),
        ("N*m", "lbf*ft"): (1.356, 1.0),
        ("m", "ft"): (0.3048, 1.0),
        ("um", "mil"): (25.4, 1.0),
    }
    for (own, other), (value, there) in known.items():
        factor, offset = next((f, o) for unit, f, o in spoil.READ_IN[own] if unit == other)
        assert factor * value + offset == pytest.approx(there, rel=1e-3, abs=1e-9), (own, other)


@pytest.mark.parametrize("seed", range(6))
def test_a_sensor_that_read_in_another_unit(seed: int, tmp_path: Path) -> None:
    fault, found, files = spoiled(tmp_path, "other_unit", seed)
    assert changed(found) == list(fault.subjects)
    (name,) = fault.subjects
    assert files.channels[name]["unit"] == ("N" if name == "pot.force" else "degC")


def test_columns_are_exchanged_and_a_sign_reversed(tmp_path: Path) -> None:
    for number, name in enumerate(("exchanged", "reversed_sign")):
        own = tmp_path / str(number)
        own.mkdir()
        fault, found, _ = spoiled(own, name)
        if name == "exchanged":
            assert set(fault.subjects) == {"pot.bath", "pot.lid"}
            np.testing.assert_allclose(found["pot.bath"], plain()["pot.lid"])
        else:
            assert fault.subjects == ("pot.force",)  # a temperature has no leads to exchange
            np.testing.assert_allclose(found["pot.force"], -plain()["pot.force"], atol=1e-8)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("name", ["clock_rate", "clock_offset", "clock_jump"])
def test_a_clock_moves_every_channel_and_never_back(name: str, seed: int, tmp_path: Path) -> None:
    fault, _, files = spoiled(tmp_path, name, seed)
    assert fault.subjects == ()
    clock = files.tables["data.csv"]["t"]
    assert np.all(np.diff(clock) > 0.0)
    late = clock[-1] - 110.0
    assert 0.7 < abs(late) < 6.1
    assert bool(clock[0] == 10.0) is (name != "clock_offset")
    # rows keep their readings: those of the last instant are the last
    assert files.values("pot.bath")[-1] == pytest.approx(100.0)


@pytest.mark.parametrize("name", ["stuck", "offset", "drift", "lag", "clipped", "gain"])
def test_a_sensor_fault_is_of_one_channel(name: str, tmp_path: Path) -> None:
    for seed in range(5):
        own = tmp_path / f"{name}_{seed}"
        own.mkdir()
        fault, found, _ = spoiled(own, name, seed)
        assert changed(found) == list(fault.subjects)
        assert len(fault.subjects) == 1
        values = found[fault.subjects[0]]
        if name == "stuck":
            assert 0.14 < np.mean(np.diff(values) == 0.0) < 0.41
        if name == "clipped":
            assert np.count_nonzero(values == values.max()) > 0.1 * COUNT


def test_an_input_is_stated_otherwise_than_it_acted(tmp_path: Path) -> None:
    levels = {}
    for number, name in enumerate(("size_of_input", "pause_of_input", "other_course")):
        own = tmp_path / str(number)
        own.mkdir()
        fault, found, files = spoiled(own, name)
        assert changed(found) == []
        assert fault.subjects == ("mains.heater",)
        levels[name] = np.array([float(v.split()[0]) for _, v in files.courses()["mains.heater"]])
    plain_levels = np.array([0.0, 100.0, 200.0, 0.0, 100.0, 200.0])
    factor = levels["size_of_input"][1] / 100.0
    np.testing.assert_allclose(levels["size_of_input"], factor * plain_levels)
    assert np.count_nonzero(levels["pause_of_input"] != plain_levels) == 1
    np.testing.assert_allclose(levels["other_course"], 3.0 * plain_levels)


def test_what_cannot_be_spoiled_so_is_left_alone(tmp_path: Path) -> None:
    """Two channels of one unit are needed to exchange them; without a second recording there is no other course."""
    files = read(folder(tmp_path, second="K"))
    rng = np.random.default_rng(0)
    assert spoil.exchanged(files, rng) is None
    assert spoil.other_course(files, rng) is None
    files.keys["overrides"] = {}
    assert spoil.size_of_input(files, rng) is None
    assert spoil.pause_of_input(files, rng) is None
    assert len({f.__name__ for f in FAULTS}) == len(FAULTS) == 15


def doubt(recording: str, subject: str, kind: str, is_serious: bool = True) -> dict[str, object]:
    return {"recording": recording, "subject": subject, "kind": kind, "is_serious": is_serious, "statement": ""}


@pytest.mark.parametrize(
    ("doubts", "answer"),
    [
        ([], "silent"),
        ([doubt("day 1", "pot.bath", "unit", False)], "silent"),
        ([doubt("day 1", "pot.bath", "unit")], "named"),
        ([doubt("day 1", "all channels", "odd one out")], "stands out"),
        ([doubt("day 2", "pot.bath", "unit")], "false"),
        ([doubt("", "", "refused")], "refused"),
        ([doubt("day 1", "pot.lid", "unit")], "false"),
        ([doubt("day 1", "pot.bath", "clock")], "false"),
        ([doubt("day 1", "pot.bath", "unit"), doubt("day 1", "pot.lid", "swapped")], "false"),
    ],
)
def test_an_answer_is_false_where_it_says_what_was_not_done(doubts: list[dict[str, object]], answer: str) -> None:
    fault = Fault("unit", "day_1", ("pot.bath",), "")
    assert _scored(fault, doubts)["answer"] == answer
    if answer != "refused":
        assert _scored(None, doubts)["answer"] == ("false" if any(d["is_serious"] for d in doubts) else "silent")


def test_the_table_counts_each_answer_once() -> None:
    answers = [{"fault": "unit", "answer": "named"}, {"fault": "unit", "answer": "false"}]
    assert "| unit | 2 | 1 | 0 | 0 | 1 | 0 |" in summary(answers)
    assert "| nothing | 0 | 0 | 0 | 0 | 0 | 0 |" in summary(answers)
