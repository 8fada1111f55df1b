"""Heat between two coils that touch: against the linear system, where it may act, and found by a search."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from cosim.scenario import load_scenario
from diagnosis.candidates.registry import candidate, catalogue
from diagnosis.models.coil_network.kernel.layout import COIL_FIELDS, CoilNetworkLayout
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from diagnosis.models.coil_network.kernel.places import places
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.recording.quantity import parse_quantity
from diagnosis.recording.recording import Channel, Recording
from diagnosis.search.search import Settings, search
from tests.coil_network.rigs import ROOM, full_network, heater

C, G = COIL_FIELDS["capacity"][0], COIL_FIELDS["conductance"][0]
PLAIN = CoilNetworkParameters({"use_regressed_cooling_rate": 0.0})
POWER = 0.4
THREE = CoilNetworkLayout(3)


def between(layout: CoilNetworkLayout, *coils: tuple[int, int], g: float) -> np.ndarray:
    found = np.zeros(len(layout.contacts))
    for pair in coils:
        found[layout.contacts.index(pair)] = g
    return found


def temperatures(parameters: CoilNetworkParameters, power: list[float], stop: float) -> np.ndarray:
    inputs = heater(power, stop, 0.05, coils=3)
    return full_network(THREE).simulate(parameters, inputs, {"temperature": inputs.time})["temperature"]


@pytest.mark.parametrize(("g", "error"), [(2e-3, 2e-3), (0.02, 2e-3)])
def test_two_coils_that_touch_follow_the_linear_system_and_the_third_is_left_alone(g, error):
    found = temperatures(PLAIN.with_term("touching_coils", g=between(THREE, (0, 2), g=g)), [POWER, 0.1, 0.0], 40.0)
    joined = np.array([[-(G + g), 0.0, g], [0.0, -G, 0.0], [g, 0.0, -(G + g)]]) / C
    steady = -np.linalg.solve(joined, np.array([POWER, 0.1, 0.0]) / C)
    exact = np.array([ROOM + steady - expm(joined * t) @ steady for t in np.arange(0.0, 40.01, 0.05)])
    assert np.abs(found - exact).max() < error  # second order in the step
    assert exact[-1, 2] - ROOM > 0.4  # the unpowered coil warms up


def test_what_one_coil_gives_the_others_have():
    pairs = between(THREE, (0, 1), (0, 2), g=3e-3)  # two contacts of one coil are two places
    found = temperatures(PLAIN.with_base(conductance=0.0).with_term("touching_coils", g=pairs), [POWER, 0.0, 0.0], 20.0)
    stored = C * (found - ROOM)
    assert np.allclose(stored.sum(axis=1), POWER * np.arange(0.0, 20.01, 0.05), rtol=1e-11, atol=1e-12)
    assert np.allclose(stored[:, 1], stored[:, 2], rtol=0.01, atol=1e-3)
    assert stored[-1, 1] > 0.3


@pytest.mark.parametrize(
    ("layout", "count", "first", "last"),
    [
        (CoilNetworkLayout(2), 0, "", ""),  # the only pair is all coils: `neighbour_heat`
        (CoilNetworkLayout(4, (2, 2)), 6, "coil[1,1] and coil[1,2]", "coil[2,1] and coil[2,2]"),
        (CoilNetworkLayout(4), 6, "coil[1] and coil[2]", "coil[3] and coil[4]"),
        (CoilNetworkLayout(36, (6,) * 6), 60, "coil[1,1] and coil[1,2]", "coil[6,5] and coil[6,6]"),
    ],
)
def test_any_two_of_a_few_coils_may_touch_and_neighbours_of_many(layout, count, first, last):
    found = places(candidate("touching_coils"), layout)
    assert len(found) == count
    assert not count or (found[0].label, found[-1].label) == (first, last)


FOUR = """
title: Four heaters in a row
time: {start: 0 s, stop: 600 s, macro_step: 1 s, output_step: 1 s, checkpoint_step: 600 s}
algorithm: {kind: gauss_seidel, order: [drive, room, heaters]}
components:
  drive:
    kind: programme
    outputs:
      power_1: {unit: W, points: [[0 s, 0 W], [30 s, 0.75 W], [250 s, 0 W], [450 s, 0.6 W]]}
      power_2: {unit: W, points: [[0 s, 0 W], [100 s, 0.5 W], [200 s, 0 W]]}
      power_3: {unit: W, points: [[0 s, 0.3 W], [80 s, 0 W], [300 s, 0.5 W]]}
      power_4: {unit: W, points: [[0 s, 0.2 W], [150 s, 0.6 W], [350 s, 0 W]]}
  room:
    kind: programme
    outputs:
      temperature: {unit: K, constant: 21 degC}
  heaters:
    kind: fmu
    fmu: thermal_stiffness
    structure: {coils: 4}
    parameter_set: tclab_heater
    parameters: {initial_temperature: 21 degC}
connections:
  - drive.power_1 -> heaters.power[1]
  - drive.power_2 -> heaters.power[2]
  - drive.power_3 -> heaters.power[3]
  - drive.power_4 -> heaters.power[4]
  - room.temperature -> heaters.ambient_temperature
"""
#: Begin of each level [s] and the level [W], heater by heater, as in the scenario.
LEVELS = (
    ((30.0, 0.75), (250.0, 0.0), (450.0, 0.6)),
    ((100.0, 0.5), (200.0, 0.0)),
    ((0.0, 0.3), (80.0, 0.0), (300.0, 0.5)),
    ((0.0, 0.2), (150.0, 0.6), (350.0, 0.0)),
)
LAWS = ("touching_coils", "neighbour_heat", "uneven_cooling", "radiation", "second_mass", "sensor_bias", "sensor_lag")
NOISE = 0.2


def readings(contacts: list[tuple[int, int, float]], seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Times [s] and readings [K] of a row of heaters by the heat balance, integrated by SciPy."""
    capacity, loss = 8000.0 * 500e-9 * 500.0 * 1.1, 10.0 * 12e-4 * 0.95

    def power(t: float) -> np.ndarray:
        return np.array([next((w for begin, w in reversed(own) if t >= begin), 0.0) for own in LEVELS])

    def slope(t: float, x: np.ndarray) -> np.ndarray:
        heat = power(t) - loss * (x - 294.15)
        for a, b, g in contacts:
            heat[a] -= g * (x[a] - x[b])
            heat[b] += g * (x[a] - x[b])
        return heat / capacity

    times = np.arange(4.0, 600.1, 4.0)
    done = solve_ivp(slope, (0.0, 600.0), np.full(4, 294.15), t_eval=times, max_step=1.0, rtol=1e-9, atol=1e-9)
    return times, done.y.T + NOISE * np.random.default_rng(seed).standard_normal((len(times), 4))


@pytest.mark.parametrize(
    ("contacts", "names"),
    [
        ([(0, 2, 0.004)], {"touching_coils at coil[1] and coil[3]"}),
        ([(0, 1, 0.004), (1, 2, 0.004), (2, 3, 0.004)], {"neighbour_heat at all coils"}),
        ([], set()),
    ],
    ids=["two that touch", "all neighbours", "none"],
)
def test_a_search_names_the_two_that_touch(tmp_path: Path, contacts, names):
    path = tmp_path / "scenario.yaml"
    path.write_text(FOUR)
    channels = {}
    times, values = readings(contacts, 5)
    for n in range(4):
        name = f"coil[{n + 1}].temperature"
        clipped = np.zeros(len(times), dtype=bool)
        channels[name] = Channel(name, parse_quantity(name), times, values[:, n], NOISE, True, is_clipped=clipped)
    recording = Recording(tmp_path, "first", channels, (), {}, 600.0, 0.0)
    own = [t for t in catalogue() if t.identifier in LAWS]
    model = CoilNetworkModel(load_scenario(path), [recording], own)
    found = search(model, model.terms(), Settings(), model.groups()).best.fit.point.terms
    assert {str(t) for t in found} == names
    for term, fitted in found.items():
        assert fitted[0] == pytest.approx(0.004, rel=0.15), term
