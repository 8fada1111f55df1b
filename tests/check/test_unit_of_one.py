"""A channel that one recording states in another unit than the others, by a factor that is no odd size."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.check.check import check_recordings
from diagnosis.check.unit_of_one import OF_ONE, units_near
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel
from tests.check.test_other_course import _power, recordings_of, temperatures
from tests.systems.rigs import held, oscillator, oscillator_recordings, write_recording


def doubts(folder: Path, recordings: list[Path]) -> list[Doubt]:
    return list(check_recordings(load_scenario(str(folder / "scenario.yaml")), [load_recording(r) for r in recordings]))


@pytest.fixture
def rig(tmp_path: Path) -> tuple[Path, list[Path], str]:
    """Folder, three null recordings, and the column of the displacement."""
    oscillator(tmp_path)
    recordings = oscillator_recordings(tmp_path, lambda x, v: 0.0)
    return tmp_path, recordings, pd.read_csv(recordings[1] / "data.csv").columns[-1]


def scaled(recording: Path, column: str, factor: float) -> None:
    table = pd.read_csv(recording / "data.csv")
    table[column] *= factor
    table.to_csv(recording / "data.csv", index=False)


def test_feet_stated_as_metres_are_told_beside_the_other_recordings(rig: tuple[Path, list[Path], str]) -> None:
    folder, recordings, column = rig
    assert doubts(folder, recordings) == []
    scaled(recordings[1], column, 1.0 / 0.3048)
    (told,) = [d for d in doubts(folder, recordings) if d.is_serious]
    assert told.kind == "unit"
    assert told.recording == "run_2"
    assert "as if they were in ft and not in m" in told.statement


def test_a_rig_that_answers_more_in_all_recordings_and_a_gain_that_is_no_unit_raise_no_such_doubt(
    rig: tuple[Path, list[Path], str],
) -> None:
    folder, recordings, column = rig
    for recording in recordings:
        scaled(recording, column, 1.0 / 0.3048)  # in all of them: the scenario may be off by that
    assert not [d for d in doubts(folder, recordings) if d.kind == "unit"]
    for recording in recordings:
        scaled(recording, column, 0.3048)
    scaled(recordings[1], column, 1.5)
    assert not [d for d in doubts(folder, recordings) if d.kind == "unit"]
    scaled(recordings[1], column, 2.0)
    assert not [d for d in doubts(folder, recordings[:2]) if d.kind == "unit"]  # of two, either may be the wrong one


def test_nanometres_stated_as_metres_are_told(rig: tuple[Path, list[Path], str]) -> None:
    folder, recordings, column = rig
    scaled(recordings[2], column, 1e9)
    (told,) = [d for d in doubts(folder, recordings) if d.is_serious]
    assert "as if they were in nm and not in m" in told.statement


@pytest.mark.parametrize(
    ("unit", "stated", "base", "factor"),
    [
        ("mrad", "deg", "rad", 1000.0 * 3.14159265 / 180.0),
        ("ml/min", "m^3/s", "m^3/s", 6e7),
        ("kV", "V", "V", 1e-3),
        ("g/min", "kg/s", "kg/s", 6e4),
        ("mW/cm^2", "W/m^2", "W/m^2", 0.1),
        ("cm/s", "m/s", "m/s", 100.0),
    ],
)
def test_units_of_laboratories_are_known_by_their_factor(unit: str, stated: str, base: str, factor: float) -> None:
    assert unit in units_near(factor, stated, base, more=OF_ONE[base])


#: A plate that is heated, without units: its temperature is a number of some scale.
PLATE = OdeModel(
    "plate",
    {"C": (40.0, ""), "h": (0.5, "")},
    {"power": ""},
    {"T": ("", "22.0", "(power - h*(T - 22.0))/C")},
    {"warm": ("", "T"), "shown": ("", "T*T/100.0")},
    2.0,
)
PLATE_SCENARIO = """\
title: A plate
time: {stop: 600 s, macro_step: 2 s, output_step: 2 s}
components:
  heater: {kind: programme, outputs: {power: {unit: "1", constant: "10"}}}
  plate: {kind: fmu, fmu: plate.fmu}
connections: [heater.power -> plate.power]
"""


def _plates(
    folder: Path,
    spoil: Callable[[Array], Array],
    shown: Callable[[Array], Array] = lambda T: T,
    model: OdeModel = PLATE,
) -> list[Path]:
    """Three recordings; what is shown of the temperature of the second is written as `spoil` makes it."""
    model.build(folder)
    (folder / "scenario.yaml").write_text(PLATE_SCENARIO, encoding="utf-8")
    found = []
    for number in range(3):
        rng = np.random.default_rng(70 + number)
        power = np.repeat(rng.uniform(0.0, 30.0, 10), 30)
        warm = held(lambda x, u: (u - 0.51 * (x - 22.0)) / 39.0, np.array([22.0]), power, 2.0)[:, 0]
        read = shown(warm) + 0.05 * rng.standard_normal(len(warm))
        columns = {"t": 2.0 * np.arange(300), "P": power, "T": spoil(read) if number == 1 else read}
        columns["s"] = warm**2 / 100.0 + 0.05 * rng.standard_normal(len(warm))
        channels = {"plate.warm": ("T", "1", "0.05"), "plate.shown": ("s", "1", "0.05")}
        found.append(write_recording(folder / f"run_{number + 1}", columns, {"heater.power": ("P", "1")}, channels))
    return found


@pytest.mark.parametrize(
    ("scale", "spoil"),
    [("degF", lambda T: 1.8 * T + 32.0), ("K", lambda T: T + 273.15)],
    ids=["degF", "K"],
)
def test_numbers_of_another_scale_of_temperature_are_told_without_units(
    tmp_path: Path, scale: str, spoil: Callable[[Array], Array]
) -> None:
    (told,) = [d for d in doubts(tmp_path, _plates(tmp_path, spoil)) if d.is_serious]
    assert (told.kind, told.recording, told.subject) == ("unit", "run_2", "plate.warm")
    assert f"as if in {scale}, and those of the other recordings as if in degC" in told.statement


@pytest.mark.parametrize(
    "spoil", [lambda T: 1.8 * T, lambda T: T + 32.0, lambda T: 1.8 * T + 50.0, lambda T: T + 200.0, lambda T: T]
)
def test_another_slope_or_zero_alone_is_no_scale(tmp_path: Path, spoil: Callable[[Array], Array]) -> None:
    assert not [d for d in doubts(tmp_path, _plates(tmp_path, spoil)) if "as if in" in d.statement]


@pytest.mark.parametrize("share", [0.93, 1.0, 1.07])
def test_no_zero_of_a_scale_is_seen_of_numbers_that_are_as_large(tmp_path: Path, share: float) -> None:
    """A balance that shows 14 kg in grams: 273 more or less are within what a number of the rig may be off by."""
    heavy = replace(PLATE, outputs={**PLATE.outputs, "warm": ("", "14000.0 + 10.0*T")})
    folders = _plates(tmp_path, lambda v: 14220.0 + share * (v - 14220.0), lambda T: 14000.0 + 10.0 * T, heavy)
    assert not [d for d in doubts(tmp_path, folders) if "as if in" in d.statement]


@pytest.mark.parametrize(
    ("spoil", "is_unit"),
    [(lambda T: 1.8 * (T - 273.15) + 32.0, True), (lambda T: 295.0 + 1.8 * (T - 295.0), False)],
    ids=["degF", "1.8 times as warm"],
)
def test_degrees_fahrenheit_have_another_zero_too(
    tmp_path: Path, spoil: Callable[[Array], Array], is_unit: bool
) -> None:
    def made(run: int) -> tuple[Array, Array]:
        warm = temperatures(_power(run))
        if run == 2:
            warm[:, 0] = spoil(warm[:, 0])
        return _power(run), warm

    told = [d for d in doubts(tmp_path, recordings_of(tmp_path, made)) if d.kind == "unit" and "degF" in d.statement]
    assert [d.subject for d in told] == ["stack.top"] * is_unit
