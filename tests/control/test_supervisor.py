"""The supervisor over 200 drawn coils and laws that ask for too much, some with a failed thermometer.

The model is the FMU `thermal_stiffness` with 200 coils, each with a law, a thermometer and a convection of its own,
driven by power: one co-simulation of 20 s holds all cases.
"""

from __future__ import annotations

import numpy as np
import pytest

from cosim.run import run
from tests.control.files import CAPACITY, CONDUCTANCE, loop

COUNT, LIMIT = 200, 80.0
SEED = 20261123
#: What the supervisor is told, and what the draws stay within.
SPREAD_G, SPREAD_C, BIAS, NOISE = 0.3, 0.1, 0.5, 0.1
POWER = 1.5
FASTEST = POWER / (CAPACITY * (1 - SPREAD_C))
SLOWEST = POWER / (CAPACITY * (1 + SPREAD_C))
COOLING = CAPACITY * (1 - SPREAD_C) / (CONDUCTANCE * (1 + SPREAD_G))


def cases(supervised: bool, faults: list[dict[str, object]]) -> dict[str, object]:
    """What is changed of the loop of one coil: 200 of them, drawn."""
    random = np.random.default_rng(SEED)
    convection = 90 * random.uniform(1 - SPREAD_G, 1 + SPREAD_G, COUNT)
    volume = 7.328e-9 * random.uniform(1 - SPREAD_C, 1 + SPREAD_C, COUNT)
    bias = random.uniform(-BIAS, BIAS, COUNT)
    setpoints = random.uniform(50.0, 140.0, COUNT)  # most laws ask for more than the limit
    supervisor = {
        "limit": f"{LIMIT} degC",
        "margin": "1 K",
        "fastest_rise": f"{FASTEST} K/s",
        "slowest_rise": f"{SLOWEST} K/s",
        "cooling_time": f"{COOLING} s",
        "ambient": "21 degC",
        "tolerance": "3 K",
        "delay": "100 ms",
        "lag": "0.3 s",
        "lowest": "0 degC",
        "highest": "150 degC",
        "frozen_after": "1 s",
    }
    changes = {
        "sensor": {
            "kind": "sensor",
            "unit": "K",
            "elements": COUNT,
            "sample": "100 ms",
            "lag": "0.3 s",
            "delay": "100 ms",
            "noise": f"{NOISE} K",
            "bias": [f"{b} K" for b in bias],
            "seed": 5,
            "faults": faults,
            "start": {"quantity": "22 degC"},
        },
        "controller.groups": [1] * COUNT,
        "controller.highest": f"{POWER} W",
        "controller.setpoint": [f"{s} degC" for s in setpoints],
        "controller.law": {"kind": "on_off", "band": "1 K"},
        "actuator.structure": {"coils": COUNT},
        "actuator.parameters": {
            "use_regressed_cooling_rate": False,
            "heat_transfer_coefficient": [f"{h} W/(m^2*K)" for h in convection],
            "volume": [f"{v} m^3" for v in volume],
        },
    }
    return {**changes, **({"controller.supervisor": supervisor} if supervised else {})}


FAULTS = [
    {"element": 10, "instant": "1.0 s"},  # stays what it was, while the coil heats
    {"element": 20, "instant": "8 s"},  # the same, while it holds
    {"element": 30, "instant": "0.8 s", "reads": "22 degC"},  # fell off
    {"element": 40, "instant": "8 s", "reads": "22 degC"},
    {"element": 50, "instant": "2 s", "reads": "1300 degC"},  # open, reads full scale
    {"element": 60, "instant": "2 s", "reads": "0 degC"},
]


def test_no_coil_of_200_is_above_the_limit_by_more_than_a_kelvin():
    found = run(loop(cases(True, FAULTS), 20.0))
    highest = found["actuator.temperature"].values.max(axis=0) - 273.15
    assert highest.shape == (COUNT,)
    assert highest.max() < LIMIT + 1.0
    alarm = found["controller.alarm"].values
    # Failed thermometers, and no others, are taken for failed.
    assert sorted(np.flatnonzero(alarm.max(axis=0) >= 2) + 1) == [f["element"] for f in FAULTS]
    assert (found["controller.command"].values[-1][[9, 19, 29, 39, 49, 59]] == 0.0).all()
    # It does not simply switch everything off: who asks for less than the limit gets it.
    setpoints = np.random.default_rng(SEED)
    for _ in range(3):
        setpoints.uniform(0.0, 1.0, COUNT)
    asked = setpoints.uniform(50.0, 140.0, COUNT)
    modest = (asked < 65.0) & (alarm.max(axis=0) < 2)
    late = found["actuator.temperature"].values[100:].mean(axis=0) - 273.15
    assert modest.sum() > 20
    # An on-off law behind 0.4 s swings: upwards by 0.4 s * 42 K/s, downwards by 0.4 s * 13 K/s.
    np.testing.assert_allclose(late[modest], asked[modest], atol=6.0)


def test_without_it_the_same_cases_go_far_above():
    found = run(loop(cases(False, FAULTS), 20.0))
    highest = found["actuator.temperature"].values.max(axis=0) - 273.15
    assert (highest > LIMIT + 1.0).sum() > 100


@pytest.mark.parametrize("fault", [{"instant": "2 s"}, {"instant": "2 s", "reads": "22 degC"}])
def test_a_failure_stays_a_failure(fault):
    changes = cases(True, [])
    short = {**changes, "sensor": {**changes["sensor"], "faults": [{"element": 1, **fault}]}}  # type: ignore[dict-item]
    found = run(loop(short, 6.0))
    alarm = found["controller.alarm"].values[:, 0]
    first = int(np.flatnonzero(alarm >= 2)[0])
    assert (alarm[first:] == alarm[first]).all()
    assert (found["controller.command"].values[first:, 0] == 0.0).all()
