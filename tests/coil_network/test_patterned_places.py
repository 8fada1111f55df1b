"""Coils that a rig treats alike: at the clamps, in the outer strings, at the edge, at one place of every string."""

from __future__ import annotations

import functools
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import Scenario, load_scenario
from diagnosis.candidates.registry import candidate, catalogue
from diagnosis.models.coil_network.kernel.layout import CoilNetworkLayout
from diagnosis.models.coil_network.kernel.places import places
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.recording.quantity import parse_quantity
from diagnosis.recording.recording import Channel, Recording
from diagnosis.search.problem import Point
from diagnosis.search.search import Settings, search

FABRIC = CoilNetworkLayout(36, (6,) * 6)
STRINGS, LENGTH = 3, 4
COILS = [(s + 1, n + 1) for s in range(STRINGS) for n in range(LENGTH)]
SCENARIO = """
title: Three strings of four coils
time: {start: 0 s, stop: 60 s, macro_step: 50 ms, output_step: 100 ms, checkpoint_step: 60 s}
algorithm: {kind: gauss_seidel, order: [supply, room, circuit, actuator]}
components:
  supply:
    kind: programme
    outputs:
      voltage: {unit: V, points: [[0 s, 0 V], [3 s, 4 V], [30 s, 0 V]]}
  room:
    kind: programme
    outputs:
      temperature: {unit: K, constant: 22 degC}
  circuit: {kind: ngspice, strings: [4, 4, 4], supply: common, start: {resistance: 2.2 ohm}}
  actuator:
    {kind: actuator, fmu: thermal_stiffness, electrical: circuit, ambient: room,
     parameters: {use_regressed_cooling_rate: false}}
connections:
  - supply.voltage -> circuit.supply_voltage
"""
LAWS = ("uneven_cooling", "radiation", "neighbour_heat", "contact_resistance", "second_mass")


@pytest.mark.parametrize(
    ("label", "count"),
    [("ends of the strings", 12), ("outer strings", 12), ("edge of the network", 20), ("place 3 of every string", 6)],
)
def test_a_fabric_of_six_by_six_has_them(label: str, count: int) -> None:
    found = {p.label: p.mask for p in places(candidate("uneven_cooling"), FABRIC)}
    assert set(np.unique(found[label])) == {0.0, 1.0}
    assert found[label].sum() == count


def test_where_all_coils_are_ends_there_is_no_edge() -> None:
    labels = {p.label for p in places(candidate("uneven_cooling"), CoilNetworkLayout(8, (2, 2, 2, 2)))}
    assert "ends of the strings" not in labels
    assert "edge of the network" not in labels
    assert "outer strings" in labels
    assert {p.label for p in places(candidate("uneven_cooling"), CoilNetworkLayout(3, (3,)))} == {
        "gradient over columns",
        "ends of the strings",
    }


@functools.cache
def _scenario(path: Path) -> Scenario:
    path.write_text(SCENARIO)
    return load_scenario(path)


def _blank(scenario: Scenario) -> Recording:
    times = np.arange(0.5, 60.0 + 1e-9, 0.5)
    clear = np.zeros(len(times), dtype=bool)
    sensors = {f"coil[{s},{n}].temperature": 0.2 for s, n in COILS}
    sensors |= {f"string[{s + 1}].current": 3e-3 for s in range(STRINGS)}
    channels = {
        name: Channel(name, parse_quantity(name), times, np.zeros(len(times)), noise, True, is_clipped=clear)
        for name, noise in sensors.items()
    }
    assert scenario.path is not None
    return Recording(scenario.path.parent, "levels", channels, (), {}, 60.0, 0.3)


def test_clamps_that_cool_the_ends_are_found_where_they_are(tmp_path: Path) -> None:
    """The truth is not the law of the catalogue: each end coil has 30 % more of its own heat transfer."""
    scenario = _scenario(tmp_path / "scenario.yaml")
    blank = _blank(scenario)
    source = CoilNetworkModel(scenario, [blank], [])
    base = np.zeros(len(source.parameters))
    for i, parameter in enumerate(source.parameters):
        if parameter.name in [f"coil[{s},{n}].conductance" for s, n in COILS if n in (1, LENGTH)]:
            base[i] = np.log(1.3) / parameter.deviation
    assert np.count_nonzero(base) == 2 * STRINGS, [p.name for p in source.parameters][:20]
    rng = np.random.default_rng(5)
    values = source.predict(Point(base), 0)
    channels = {
        name: replace(channel, values=one + channel.deviation * rng.standard_normal(len(one)))
        for (name, channel), one in zip(blank.channels.items(), values)
    }
    laws = [c for c in catalogue() if c.identifier in LAWS]
    model = CoilNetworkModel(scenario, [replace(blank, channels=channels)], laws)
    outcome = search(model, model.terms(), Settings(nulls=1))
    (term,) = outcome.best.terms
    assert (term.identifier, term.place) == ("uneven_cooling", "ends of the strings")
    assert outcome.best.fit.point.terms[term][0] == pytest.approx(0.3, abs=0.05)
