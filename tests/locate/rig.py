"""A rig of two strings whose recordings the coil network simulates, with an effect and parameters of our choice."""

from __future__ import annotations

import functools
from dataclasses import replace
from pathlib import Path

import numpy as np

from cosim.scenario import load_scenario
from diagnosis.candidates.registry import catalogue
from diagnosis.locate.fitted import Fitted, fitted
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.recording.quantity import parse_quantity
from diagnosis.recording.recording import Channel, Recording
from diagnosis.search.fit import Fit
from diagnosis.search.problem import Point, Term
from diagnosis.search.search import recalibrate

SCENARIO = Path(__file__).with_name("two_strings.yaml")
TITLES = ("pulses", "levels")
#: Steps of the supply's voltage [s, V]; two recordings.
PROGRAMMES = (
    [[0.0, 0.0], [3.0, 2.4], [22.0, 0.0], [32.0, 1.6], [50.0, 0.0]],
    [[0.0, 0.0], [3.0, 1.5], [18.0, 2.2], [36.0, 1.0], [50.0, 0.0]],
)
COILS = ("1,1", "1,2", "2,1", "2,2")
#: Quantity to period [s] and noise [SI].
SENSORS = {"temperature": (0.5, 0.2), "current": (0.25, 3e-3), "extension": (0.5, 1e-4)}


def names() -> list[str]:
    """Channels of a recording."""
    of_coils = [f"coil[{c}].{quantity}" for quantity in ("temperature", "extension") for c in COILS]
    return [*of_coils, "string[1].current", "string[2].current"]


def blank(number: int) -> Recording:
    """A recording whose sensors read nothing yet."""
    channels = {}
    for name in names():
        period, noise = SENSORS[name.rpartition(".")[2]]
        times = np.arange(period, 60.0 + 1e-9, period)
        channels[name] = Channel(
            name,
            parse_quantity(name),
            times,
            np.zeros(len(times)),
            noise,
            True,
            is_clipped=np.zeros(len(times), dtype=bool),
        )
    points = [[f"{t:g} s", f"{v:g} V"] for t, v in PROGRAMMES[number]]
    overrides = {"components": {"supply": {"outputs": {"voltage": {"points": points}}}}}
    return Recording(SCENARIO.parent, TITLES[number], channels, (), overrides, 60.0, 0.3)


@functools.cache
def perfect_model() -> CoilNetworkModel:
    return CoilNetworkModel(load_scenario(SCENARIO), [blank(0), blank(1)], catalogue())


def term(identifier: str, place: str) -> Term:
    """A term of the catalogue at a place."""
    return next(t for t in perfect_model().terms() if t.identifier == identifier and t.place == place)


def truth(effects: dict[Term, tuple[float, ...]], seed: int = 1) -> Point:
    """Parameters off as the prior has them, halved, and effects."""
    model = perfect_model()
    base = 0.5 * np.random.default_rng(seed).standard_normal(len(model.parameters))
    return Point(base, effects)


def fit_to(point: Point, seed: int = 2) -> tuple[CoilNetworkModel, Fit]:
    """Recordings of the true model, and the model without effects, recalibrated to them."""
    rng = np.random.default_rng(seed)
    source, recordings = perfect_model(), []
    for number in range(2):
        recording = blank(number)
        channels = {}
        for values, (name, channel) in zip(source.predict(point, number), recording.channels.items()):
            noisy = values + channel.deviation * rng.standard_normal(len(values))
            channels[name] = replace(channel, values=noisy)
        recordings.append(replace(recording, channels=channels))
    model = CoilNetworkModel(load_scenario(SCENARIO), recordings, catalogue())
    return model, recalibrate(model)


def at(model: CoilNetworkModel, fit: Fit) -> Fitted:
    found = fitted(model, fit)
    assert found is not None
    return found
