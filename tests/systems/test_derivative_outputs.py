"""An accelerometer, and other outputs that are the derivative of a state: a law that is added to it shows there too."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.run import run
from cosim.scenario import parse_scenario
from diagnosis.laws.library import library
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.places import Fit, fits, places_of
from diagnosis.search.cosim_run import Changes, changed
from evaluation.fmus.model import OdeModel

M, B, K = 2.0, 0.5, 30.0
SLED = OdeModel(
    "sled",
    {"m": (M, "kg"), "b": (B, "N*s/m"), "k": (K, "N/m")},
    {"push": "N"},
    {"x": ("m", "0.2", "v"), "v": ("m/s", "0", "(push - b*v - k*x) / m")},
    {
        "position": ("m", "x"),
        "speed": ("km/h", "3.6*v"),
        "acceleration": ("m/s^2", "(push - b*v - k*x) / m"),
        "force": ("N", "push - b*v - k*x"),
        "spring": ("N", "-k*x"),
    },
)
#: A store that decays by itself: its level is a straight line in its rate, and reads no derivative.
STORE = OdeModel("store", {"r": (0.3, "1/s")}, {}, {"h": ("m", "2", "-r*h")}, {"level": ("m", "h")})
SCENARIO = """\
title: A sled on a spring
time: {stop: 4 s, macro_step: 10 ms, output_step: 10 ms}
components:
  hand: {kind: programme, outputs: {push: {unit: N, points: [[0 s, 3 N], [1.5 s, -2 N], [2.5 s, 1 N]]}}}
  sled: {kind: fmu, fmu: sled.fmu, integrator: cvode}
  store: {kind: fmu, fmu: store.fmu, integrator: cvode}
connections: [hand.push -> sled.push]
"""
DRAG = 1.7


@pytest.fixture
def drag(tmp_path: Path) -> Fit:
    """Quadratic drag of the sled."""
    SLED.build(tmp_path)
    STORE.build(tmp_path)
    system = FastSystem(parse_scenario(SCENARIO, tmp_path / "scenario.yaml"))
    try:
        places = places_of([system])
    finally:
        system.close()
    assert [p.derivatives_read for p in places] == [
        {"v": {"acceleration": pytest.approx(1.0), "force": pytest.approx(M)}},
        {},
    ]
    return next(f for f in fits(places, library(), 0.01) if f.term.identifier == "quadratic_drag")


def test_an_accelerometer_reads_the_law_and_an_encoder_does_not(drag: Fit, tmp_path: Path) -> None:
    """Newton: what the accelerometer reads is push, damper, spring and drag over the mass, at every output."""
    system = FastSystem(parse_scenario(SCENARIO, tmp_path / "scenario.yaml"), drag.every)
    system.set_substeps(8)
    assert [p.to for p in drag.every] == ["der(v)", "acceleration", "force"]
    rows = system.simulate(None, {n: drag.values_of(p, (DRAG,)) for n, p in enumerate(drag.every)})
    assert rows is not None
    got = {n: rows.values[:, system.recorded["sled", n]][:, 0] for n in ("position", "speed", "acceleration", "force")}
    v, push = got["speed"] / 3.6, rows.values[:, system.recorded["sled", "input push"]][:, 0]
    wanted = (push - B * v - K * got["position"]) / M - DRAG * np.abs(v) * v
    np.testing.assert_allclose(got["acceleration"], wanted, atol=1e-9)
    np.testing.assert_allclose(got["force"], M * wanted, atol=1e-9)
    steady = np.flatnonzero(np.diff(push, n=2) == 0.0)  # away from the steps of the push
    slope = (v[steady + 2] - v[steady]) / 0.02
    np.testing.assert_allclose(got["acceleration"][steady + 1], slope, atol=5e-3)
    spring = rows.values[:, system.recorded["sled", "spring"]][:, 0]
    np.testing.assert_allclose(spring, -K * got["position"], atol=1e-9)
    system.close()


def test_the_amended_scenario_reads_the_same(drag: Fit, tmp_path: Path) -> None:
    scenario = parse_scenario(SCENARIO, tmp_path / "scenario.yaml")
    entries = tuple(p.entry(drag.values_of(p, (DRAG,))) for p in drag.every)
    amended = changed(scenario, Changes(added={"sled": entries}))
    there = run(amended)
    system = FastSystem(scenario, drag.every)
    system.set_substeps(8)
    rows = system.simulate(None, {n: drag.values_of(p, (DRAG,)) for n, p in enumerate(drag.every)})
    assert rows is not None
    for name, size in (("position", 0.3), ("acceleration", 5.0), ("force", 10.0)):
        mine = rows.values[:, system.recorded["sled", name]][:, 0]
        np.testing.assert_allclose(mine, there[f"sled.{name}"].values, atol=1e-4 * size)
    system.close()
    begun = FastSystem(amended)  # a diagnosis that starts from it has the law there already
    begun.set_substeps(8)
    again = begun.simulate()
    assert again is not None
    np.testing.assert_allclose(
        again.values[:, begun.recorded["sled", "acceleration"]], there["sled.acceleration"].values[:, None], atol=5e-4
    )
    begun.close()
