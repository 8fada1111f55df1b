"""docs/priors.md says what the code takes for granted."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest

from cosim.parameters import find_parameter_set
from cosim.scenario import find_scenario, load_scenario
from diagnosis.models.build import model_of
from diagnosis.models.coil_network import free, runs
from diagnosis.models.coil_network.priors import FACTORS, PRIORS, stated_priors
from diagnosis.models.wrappers.biased import DEVIATIONS_IN_BOUND
from diagnosis.recording.recording import load_recording
from diagnosis.search.cosim_model import free_parameters
from diagnosis.search.problem import Point
from tests.diagnosis.test_recording import folder

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "priors.md").read_text()
ROWS = [[cell.strip() for cell in line.strip("|").split("|")] for line in PAGE.splitlines() if line.startswith("| ")]


def row(first: str) -> list[str]:
    """The one row whose first cell begins so."""
    (found,) = [r for r in ROWS if r[0].startswith(first)]
    return found


def test_the_page_has_every_parameter_of_a_network_with_its_prior():
    assert [r[0].split("`")[1] for r in ROWS if len(r) == 5 and r[0].startswith("`")] == list(PRIORS)
    for name, prior in PRIORS.items():
        cell, shared, scatter, of, counts = row(f"`{name}`")
        assert (float(shared), float(scatter)) == (prior.shared, prior.scatter), name
        assert of == ("ln(value)" if prior.is_relative else "K")
        assert counts == (", ".join(prior.needs) or ("with a circuit" if name == "reference_resistance" else "always"))
        assert re.findall(r"`(\w+)`", cell)[1:] == list(FACTORS.get(name, ()))


def test_the_page_has_the_numbers_of_sensors_and_days(tmp_path):
    assert (free.LATE_SHARE, free.LAG_SHARE, free.LAG_SPREAD) == (0.5, 0.2, 0.9)
    assert row("delay of a clock")[1].startswith("half")
    assert "a fifth of `lag_bound` times e^(0.9 z)" in row("lag of a sensor")[1]
    assert f"up to {runs.LONGEST_LAG:g} s" in row("lag of a sensor")[0]
    assert f"; {runs.ZERO:g} of its noise" in row("zero of a sensor")[1]
    assert DEVIATIONS_IN_BOUND == 2.0
    assert row("gain of `supply.current`")[1].startswith(f"{free.CALIBRATION:g} of")
    model = model_of(load_scenario("tclab"), [load_recording(folder(tmp_path))], [])
    for words, field in (("temperature of the room", "ambient_offset"), ("temperature of the coils", "initial_temp")):
        deviations = [p.deviation for p in model.parameters if p.name.startswith(field)]
        assert row(words)[1] == f"{math.hypot(*deviations):g} K"


def test_the_page_has_what_a_pendulum_may_be_off_by(tmp_path):
    channels = {"arm.angle": {"column": "T", "unit": "deg"}}
    recording = load_recording(folder(tmp_path, channels=channels))
    found = free_parameters(load_scenario("pendulum"), [recording])
    stated = {r[1].strip("`"): float(r[2]) for r in ROWS if r[0] == "`bullet_pendulum`"}
    assert stated == {"mass": 0.015, "centre_distance": 0.05}
    for one in found:
        if one.name in stated:
            assert one.parameter.deviation > 0.0  # the shipped set states its own
    own = tmp_path / "own.yaml"
    own.write_text(
        "title: t\ntime: {stop: 1 s, macro_step: 5 ms, output_step: 5 ms, checkpoint_step: 1 s}\n"
        "components:\n  arm: {kind: bullet_pendulum, parameters: {mass: 0.2 kg, centre_distance: 0.1 m, "
        "central_inertia: 1e-4 kg*m^2}}\n"
    )
    found = free_parameters(load_scenario(own), [recording])
    assert {f.name: f.parameter.deviation for f in found} == stated


def test_a_parameter_set_changes_them_as_the_page_says():
    stated = {"specific_heat": 0.3, "volume": 0.4, "cooling_rate": 0.0}
    found = stated_priors(stated, {"heat_transfer_coefficient": 0.1})
    assert found["capacity"].shared == pytest.approx(0.5)  # factors add as squares
    assert found["capacity"].scatter == PRIORS["capacity"].scatter
    assert found["cooling_rate"].shared == 0.0
    assert (found["conductance"].shared, found["conductance"].scatter) == (0.05, pytest.approx(0.1))
    assert stated_priors({"heating_shift": 3.0}, {})["heating_shift"] == PRIORS["heating_shift"]


def test_a_recording_changes_its_own_room_alone(tmp_path):
    model = model_of(
        load_scenario("tclab"), [load_recording(folder(tmp_path, uncertain={"room.temperature": "2 degC"}))], []
    )
    deviations = [p.deviation for p in model.parameters if p.name.startswith("ambient_offset")]
    assert math.hypot(*deviations) == pytest.approx(2.0, rel=1e-12)
    assert np.isclose([p.deviation for p in model.parameters if p.name == "conductance"], 0.5).all()  # as the set says


def test_a_prior_as_wide_as_can_be_stated_gives_numbers_at_its_bounds(tmp_path):
    """Warnings are errors here; a value that is not finite would end the diagnosis."""
    shipped = find_parameter_set("tclab_heater", tmp_path / "own.yaml").read_text()
    (tmp_path / "wide.yaml").write_text(shipped.replace("uncertainty: 0.5", "uncertainty: 1000"))
    text = find_scenario("tclab").read_text().replace("parameter_set: tclab_heater", "parameter_set: wide.yaml")
    (tmp_path / "own.yaml").write_text(text)
    model = model_of(load_scenario(tmp_path / "own.yaml"), [load_recording(folder(tmp_path))], [])
    wide = [p for p in model.parameters if p.deviation == 1000.0]
    assert {p.name for p in wide} == {"conductance", "capacity"}
    for z in (-6.0, 6.0):
        base = model.network_parameters(Point(np.full(len(model.parameters), z)), 0).base
        assert all(np.isfinite(base[p.name]).all() and np.all(np.asarray(base[p.name]) > 0.0) for p in wide)
