"""Droop of a supply that heaters share, where a scenario gives power."""

import numpy as np
import pytest

from diagnosis.candidates.registry import candidate
from diagnosis.models.coil_network.kernel.layout import COIL_FIELDS, CoilNetworkLayout
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from diagnosis.models.coil_network.kernel.places import places
from tests.coil_network.rigs import NETWORK, ROOM, full_network, heater

C, G = COIL_FIELDS["capacity"][0], COIL_FIELDS["conductance"][0]
PLAIN = CoilNetworkParameters({"use_regressed_cooling_rate": 0.0})


@pytest.mark.parametrize("r", [0.1, 0.4])
def test_two_heaters_get_less_by_the_share_that_both_draw(r):
    power, layout = 0.4, CoilNetworkLayout(2)
    inputs = heater(power, 60.0, 0.05, coils=2)
    parameters = PLAIN.with_term("shared_supply_droop", r=np.full(2, r))
    found = full_network(layout).simulate(parameters, inputs, {"temperature": inputs.time})["temperature"]
    given = power * (1.0 - r * 2 * power)
    exact = ROOM + given / G * (1.0 - np.exp(-G / C * inputs.time))
    # The sum is that of the step before: the first step alone heats as without droop, 0.05 s of a few seconds.
    assert np.abs(found - exact[:, None]).max() < 0.05 * power / C * r * 2 * power * 1.01
    assert np.abs(found[-1] - ROOM - given / G).max() < 1e-3 * given / G


def test_it_takes_no_more_than_there_is():
    inputs = heater(3.0, 60.0, 0.05, coils=2)
    parameters = PLAIN.with_term("shared_supply_droop", r=np.full(2, 0.5))
    found = full_network(CoilNetworkLayout(2)).simulate(parameters, inputs, {"temperature": inputs.time})["temperature"]
    assert found.min() >= ROOM - 1e-9
    assert found[-1].max() < ROOM + 0.1 * 3.0 / G  # 6 W times 0.5 1/W is beyond the whole of it


def test_it_has_a_place_only_where_power_is_given():
    assert [p.label for p in places(candidate("shared_supply_droop"), CoilNetworkLayout(2), ["temperature"])] == [
        "all coils"
    ]
    assert places(candidate("shared_supply_droop"), NETWORK, ["temperature"]) == []
