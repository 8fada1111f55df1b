"""A wrong gain and a bias of one thermometer: told apart where its true readings are known, else one class.

What a known power makes of a body of unknown heat capacity and losses is known but for a factor, and so is not the gain
of its thermometer about the room. In a bath it is.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import Scenario
from diagnosis.candidates.registry import candidate
from diagnosis.judge.acceptance import UNSEPARATED
from diagnosis.judge.plausibility import implausible
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.search.fit import Fit, fit
from diagnosis.search.problem import Point
from diagnosis.search.search import recalibrate
from tests.faults.rig import NAMES, NOISE, SCENARIO, blank, scenario

LAWS = [candidate("sensor_bias"), candidate("sensor_gain")]
#: No power: both bodies stay as warm as the room.
SOAK = SCENARIO.replace("0.75 W", "0 W").replace("0.3 W", "0 W").replace("0.6 W", "0 W").replace("0.4 W", "0 W")
SOAK = SOAK.replace("0.1 W", "0 W")
#: No power either, in a bath of known temperature.
BATH = SOAK.replace("constant: 21 degC", "points: [[0 s, 21 degC], [60 s, 90 degC], [350 s, 50 degC]]")
ZERO = 273.15


@pytest.fixture(scope="module", params=[BATH, SCENARIO, SOAK], ids=["bath", "heated", "soak"])
def made(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Scenario:
    return scenario(tmp_path_factory.mktemp("rig"), request.param)


def _read(made: Scenario, gain: float, about: float, bias: float) -> CoilNetworkModel:
    """The model of recordings of a rig like the scenario, whose first thermometer has a wrong gain or a bias."""
    random = np.random.default_rng(3)
    empty = [blank(made, "first"), blank(made, "second")]
    model = CoilNetworkModel(made, empty, LAWS)
    nominal = Point(np.zeros(len(model.parameters)))
    found = []
    for number, recording in enumerate(empty):
        channels = {}
        for (name, channel), truth in zip(recording.channels.items(), model.predict(nominal, number)):
            off = gain * (truth - about) + bias if name == NAMES[0] else 0.0
            channels[name] = replace(channel, values=truth + off + NOISE * random.standard_normal(len(truth)))
        found.append(replace(recording, channels=channels))
    return CoilNetworkModel(made, found, LAWS)


def _fits(model: CoilNetworkModel) -> dict[str, Fit]:
    """Of each law at the first thermometer, from all of its starts."""
    base = recalibrate(model)
    found = {}
    for term in model.terms():
        if term.place == NAMES[0]:
            strength, *shape = term.parameters
            starts = [(s, *(v for _ in shape)) for s in strength.starts for v in (shape[0].starts if shape else (0.0,))]
            fits = [fit(model, base.point.plus(term, s), near=base) for s in starts]
            found[term.identifier] = min(fits, key=lambda f: f.cost)
    return found


@pytest.mark.parametrize(("gain", "about"), [(0.14, ZERO), (-0.14, ZERO), (0.14, 295.15)])
def test_a_gain_wins_where_known_temperatures_are_far_from_each_other(
    made: Scenario, gain: float, about: float
) -> None:
    found = _fits(_read(made, gain, about, 0.0))
    ahead = found["sensor_bias"].cost - found["sensor_gain"].cost
    if "90 degC" not in (made.path or Path()).read_text():
        assert abs(ahead) < UNSEPARATED
        return
    assert ahead > UNSEPARATED
    ((term, values),) = found["sensor_gain"].point.terms.items()
    assert implausible(term, values) == []
    assert values[0] == pytest.approx(gain, rel=0.5)


@pytest.mark.parametrize("bias", [3.0, -3.0])
def test_a_bias_is_never_told_as_a_gain(made: Scenario, bias: float) -> None:
    found = _fits(_read(made, 0.0, ZERO, bias))
    # a gain has one number more: that it is as good is a class, that it is better by odds of 20 to 1 would be false
    assert found["sensor_bias"].cost - found["sensor_gain"].cost < UNSEPARATED
