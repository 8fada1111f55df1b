"""An FMU that states no units may call its variables `current` or `temperature`: its readings are pure numbers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import parse_scenario
from cosim.unit.errors import InputError
from diagnosis.models.cosimulation.model import ClosedLoopModel
from diagnosis.recording.recording import Recording, load_recording
from diagnosis.search.problem import Point
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import write_recording

COUNT = 60
NAMES = ("current", "temperature", "voltage", "length")
SCENARIO = """\
title: A film
time: {stop: 59 s, macro_step: 1 s, output_step: 1 s}
components:
  source: {kind: programme, outputs: {u: {unit: "UNIT", points: [[0 s, "1 UNIT"], [20 s, "0 UNIT"]]}}}
  film: {kind: fmu, fmu: film.fmu, integrator: cvode}
connections: [source.u -> film.u]
"""


def made(folder: Path, name: str, unit: str, stated: str) -> tuple[str, Recording]:
    """A scenario whose FMU has an output of that name and unit, and a recording that states another unit of it."""
    OdeModel("film", {"tau": (5.0, "s")}, {"u": unit}, {"q": (unit, "0", "(u - q)/tau")}, {name: (unit, "q")}).build(
        folder
    )
    times = np.arange(COUNT, dtype=float)
    values = np.where(times < 20, 1 - np.exp(-times / 5), (1 - np.exp(-4)) * np.exp(-(times - 20) / 5))
    path = write_recording(
        folder / "run", {"t": times, "y": values}, {}, {f"film.{name}": ("y", stated, f"0.01 {stated}")}
    )
    text = SCENARIO.replace("1 UNIT", f"1 {unit}".strip()).replace("0 UNIT", f"0 {unit}".strip()).replace("UNIT", unit)
    (folder / "scenario.yaml").write_text(text, encoding="utf-8")
    return text, load_recording(path)


@pytest.mark.parametrize("name", NAMES)
def test_a_pure_number_is_compared_with_a_variable_without_a_unit(tmp_path: Path, name: str) -> None:
    text, recording = made(tmp_path, name, "1", "1")
    model = ClosedLoopModel(parse_scenario(text, tmp_path / "scenario.yaml"), [recording])
    residuals = model.residuals([Point(np.zeros(len(model.parameters)))])[0]
    assert np.abs(residuals).max() < 0.1
    assert recording.channels[f"film.{name}"].unit == "1"


def test_a_pure_number_of_what_has_a_unit_is_refused_with_what_to_write(tmp_path: Path) -> None:
    text, recording = made(tmp_path, "current", "A", "1")
    with pytest.raises(InputError) as caught:
        ClosedLoopModel(parse_scenario(text, tmp_path / "scenario.yaml"), [recording])
    assert caught.value.key == "channels.film.current.unit"
    assert "`factor`" in str(caught.value)
    assert "(A)" in str(caught.value)
