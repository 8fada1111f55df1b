"""Two strings of two coils whose recordings are simulated by the coil network, each under a programme of its own.

What acts in a recording is given on that recording's own clock, so that nothing here knows of a joint axis.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from cosim.scenario import Scenario, load_scenario
from cosim.unit.protocol import Array
from diagnosis.candidates.registry import catalogue
from diagnosis.models.coil_network.kernel.inputs import grid
from diagnosis.models.coil_network.kernel.layout import CoilNetworkLayout
from diagnosis.models.coil_network.kernel.network import CoilNetwork
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from diagnosis.models.coil_network.translate import translate
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.quantity import parse_quantity
from diagnosis.recording.recording import Channel, Recording

SCENARIO = Path(__file__).parents[1] / "locate" / "two_strings.yaml"
#: Steps of the supply's voltage [s, V], and the end [s]; all of them differ.
PROGRAMMES = (
    ([[0.0, 0.0], [3.0, 2.4], [22.0, 0.0], [32.0, 1.6], [50.0, 0.0]], 60.0),
    ([[0.0, 0.0], [3.0, 1.5], [18.0, 2.2], [36.0, 1.0], [44.0, 0.0]], 50.0),
    ([[0.0, 0.0], [2.0, 1.2], [14.0, 2.0], [24.0, 0.8], [40.0, 2.2], [52.0, 0.0]], 64.0),
    ([[0.0, 0.0], [4.0, 2.0], [12.0, 1.0], [26.0, 2.4], [40.0, 0.0]], 52.0),
)
TITLES = ("pulses", "levels", "stairs", "judge")
COILS = ("1,1", "1,2", "2,1", "2,2")
#: Quantity to period [s] and noise [SI].
SENSORS = {"temperature": (0.5, 0.2), "current": (0.25, 3e-3), "extension": (0.5, 1e-4)}
#: Before the run begins: what is there from the start.
BEFORE = -1.0

Terms = Mapping[str, Mapping[str, float | Array]]


def scenario() -> Scenario:
    return load_scenario(SCENARIO)


def coil(number: int, value: float = 1.0) -> Array:
    """A value at one coil of four, from 1."""
    return np.asarray(value * np.eye(4)[number - 1])


def open_coil(number: int, instant: float, openness: float = 1.0) -> Terms:
    return {"open_coil": {"openness": coil(number, openness), "instant": instant}}


def loose_contact(instant: float) -> Terms:
    """1.5 ohm in the second string."""
    return {"loose_contact": {"R_contact": np.array([0.0, 1.5]), "instant": instant}}


def draught(amount: float, instant: float) -> Terms:
    return {"draught": {"amount": np.full(4, amount), "instant": instant}}


@functools.cache
def network(layout: CoilNetworkLayout) -> CoilNetwork:
    return CoilNetwork(layout, catalogue())


def recorded(number: int, terms: Terms | None = None, noise: float = 1.0, **facts: Any) -> Recording:
    """A recording of one of the programmes.

    Args:
        number: Of the programme, from 0.
        terms: What acts, on this recording's clock.
        noise: Factor on the noise of its sensors.
        facts: Other fields of the recording (`order`, `day`, `cycles_before`).
    """
    points, stop = PROGRAMMES[number]
    course = [[f"{t:g} s", f"{v:g} V"] for t, v in points]
    overrides = {"components": {"supply": {"outputs": {"voltage": {"points": course}}}}}
    title = facts.pop("title", TITLES[number])
    empty = Recording(SCENARIO.parent / title, title, {}, (), overrides, stop, 0.3, **facts)
    translation = translate(scenario_of(scenario(), empty))
    base = dict(translation.parameters.base)
    for n, name in enumerate(("reference_resistance", "conductance", "capacity", "load")):
        scatter = np.random.default_rng(100 + n).standard_normal(5)
        base[name] = base[name] * np.exp(0.015 * (scatter[0] + scatter[1:]))
    base["cycles_before"] = empty.cycles_before
    channels, rng = {}, np.random.default_rng(number)
    times = {q: np.arange(p, stop + 1e-9, p) for q, (p, _) in SENSORS.items()}
    inputs = translation.drive.on_grid(grid(0.0, stop, 0.05, translation.drive.switches()))
    values = network(translation.layout).simulate(CoilNetworkParameters(base, terms or {}), inputs, times)
    for quantity, (_, deviation) in SENSORS.items():
        places = ("string[1]", "string[2]") if quantity == "current" else tuple(f"coil[{c}]" for c in COILS)
        for column, place in enumerate(places):
            own = values[quantity][:, column]
            read = own + noise * deviation * rng.standard_normal(len(own))
            name = f"{place}.{quantity}"
            channels[name] = Channel(
                name,
                parse_quantity(name),
                times[quantity],
                read,
                deviation,
                True,
                is_clipped=np.zeros(len(read), dtype=bool),
            )
    return replace(empty, channels=channels)
