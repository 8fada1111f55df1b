"""A parameter that is another one beyond a value of a quantity: a pipe that widens, a rail that is bent."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.laws.library import library
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.places import fits, places_of
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import built, diagnosed, held, write_recording

#: A carriage on a rail, drawn back by a spring.
RAIL = OdeModel(
    "rail",
    {"m": (2.0, "kg"), "d": (1.5, "N*s/m"), "k": (6.0, "N/m")},
    {"force": "N"},
    {"x": ("m", "0.0", "v"), "v": ("m/s", "0.0", "(force - d*v - k*x)/m")},
    {"place": ("m", "x")},
)
SCENARIO = """
title: A carriage on a rail
time: {stop: 60 s, macro_step: 20 ms, output_step: 100 ms}
components:
  drive: {kind: programme, outputs: {force: {unit: N, constant: 0 N}}}
  rail: {kind: fmu, fmu: rail.fmu, integrator: cvode}
connections: [drive.force -> rail.force]
"""


def _scenario(folder: Path) -> Path:
    return built(RAIL, SCENARIO, folder)


def _diagnosed(folder: Path, more: float) -> Diagnosis:
    """Three runs on a rail that is greased up to 0.2 m and dry from 0.4 m on, where the drag is larger by a share."""
    path = _scenario(folder)
    every = []
    for number in range(3):
        rng = np.random.default_rng(70 + number)
        force = np.repeat(rng.uniform(-5.0, 5.0, 30), 100)

        def rate(x: Array, u: float) -> Array:
            drag = 1.53 * (1.0 + more * np.clip((x[0] - 0.2) / 0.2, 0.0, 1.0))
            return np.array([x[1], (u - drag * x[1] - 6.1 * x[0]) / 1.98])

        states = held(rate, np.zeros(2), force, 0.02)[::5]
        columns = {
            "t": 0.1 * np.arange(len(states)),
            "force": force[::5][: len(states)],
            "x": states[:, 0] + 0.004 * rng.standard_normal(len(states)),
        }
        inputs, channels = {"drive.force": ("force", "N")}, {"rail.place": ("x", "m", "4 mm")}
        every.append(load_recording(write_recording(folder / f"run_{number}", columns, inputs, channels)))
    return diagnosed(path, every)


def test_a_drag_that_grows_beyond_a_place_is_found_with_it(tmp_path: Path) -> None:
    found = _diagnosed(tmp_path, 3.0)
    assert found.verdict is Verdict.UNNAMED_PHYSICS
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert (finding.place, finding.effect) == ("rail.d", "parameter_spline_of_x")
    values = {p.name: p.value for p in finding.parameters}
    assert values["a"] == pytest.approx(3.0, rel=0.15)
    assert values["onset"] == pytest.approx(0.2, abs=0.03)
    assert values["onset"] + values["width"] == pytest.approx(0.4, abs=0.05)


def test_a_drag_that_is_the_same_everywhere_has_no_such_law(tmp_path: Path) -> None:
    assert not [f for f in _diagnosed(tmp_path, 0.0).findings if f.is_accepted]


def test_beyond_the_upper_knot_the_parameter_is_larger_by_the_whole_share(tmp_path: Path) -> None:
    """At rest under a force a spring of 6 N/m yields F/k; with a share of 0.5 from 0.3 m on, F/(1.5 k) beyond."""
    path = _scenario(tmp_path)
    text = path.read_text(encoding="utf-8").replace("constant: 0 N", "constant: 9 N").replace("1.5 N*s/m", "20 N*s/m")
    path.write_text(text, encoding="utf-8")
    system = FastSystem(load_scenario(str(path)))
    own = places_of([system])[0]
    spline = next(
        f
        for f in fits([own], library(), 0.1)
        if f.term.identifier == "parameter_spline_of_x" and f.placed.parameter == "k"
    )
    system.close()
    system = FastSystem(load_scenario(str(path)), [spline.placed])
    rows = system.simulate(laws={0: (0.5, 0.3, 0.1)})
    assert rows is not None
    place = rows.values[:, system.recorded["rail", "place"]].ravel()
    assert place[-1] == pytest.approx(9.0 / (1.5 * 6.0), rel=1e-4)
    system.close()
