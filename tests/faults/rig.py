"""Two heaters whose recordings the coil network simulates, with noise, wrong parameters and faults of our choice."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from cosim.scenario import Scenario, load_scenario
from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.candidates.registry import catalogue
from diagnosis.faults.model import FaultyModel, with_faults
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.recording.quantity import parse_quantity
from diagnosis.recording.recording import Channel, Recording
from diagnosis.search.problem import Point, Term
from diagnosis.search.search import Outcome, Settings, search

SCENARIO = """
title: Two heaters
time: {start: 0 s, stop: 600 s, macro_step: 1 s, output_step: 1 s, checkpoint_step: 600 s}
algorithm: {kind: gauss_seidel, order: [drive, room, heaters]}
components:
  drive:
    kind: programme
    outputs:
      power_1: {unit: W, points: [[0 s, 0 W], [30 s, 0.75 W], [250 s, 0.3 W], [450 s, 0.6 W]]}
      power_2: {unit: W, points: [[0 s, 0 W], [100 s, 0.4 W], [350 s, 0.1 W]]}
  room:
    kind: programme
    outputs:
      temperature: {unit: K, constant: 21 degC}
  heaters:
    kind: fmu
    fmu: thermal_stiffness
    structure: {coils: 2}
    parameter_set: tclab_heater
    parameters: {initial_temperature: 21 degC}
connections:
  - drive.power_1 -> heaters.power[1]
  - drive.power_2 -> heaters.power[2]
  - room.temperature -> heaters.ambient_temperature
"""
#: A part of the catalogue, so that a search takes a second: what faults of a day were named before.
LAWS = (
    "neighbour_heat",
    "radiation",
    "second_mass",
    "draught",
    "ambient_step",
    "sensor_bias",
    "sensor_lag",
    "sensor_drift",
)
PERIOD, NOISE, STOP = 6.0, 0.3, 600.0
NAMES = ("coil[1].temperature", "coil[2].temperature")


@dataclass(frozen=True)
class Wrong:
    """A sensor that is wrong from a share of the recording to another: by an amount, or stuck where that is None."""

    channel: str
    begin: float
    end: float
    amount: float | None
    recording: int = 0


def laws() -> list[CandidateTerm]:
    return [c for c in catalogue() if c.identifier in LAWS]


def scenario(folder: Path, text: str = SCENARIO) -> Scenario:
    path = folder / "scenario.yaml"
    path.write_text(text)
    return load_scenario(path)


def blank(made: Scenario, title: str) -> Recording:
    """A recording whose sensors read nothing yet."""
    assert made.path is not None
    times = np.arange(PERIOD, STOP + 1e-9, PERIOD)
    channels = {
        name: Channel(
            name,
            parse_quantity(name),
            times,
            np.zeros(len(times)),
            NOISE,
            True,
            is_clipped=np.zeros(len(times), dtype=bool),
        )
        for name in NAMES
    }
    return Recording(made.path.parent, title, channels, (), {}, STOP, 0.0)


def recorded(
    made: Scenario, seed: int, terms: Sequence[tuple[str, tuple[float, ...]]] = (), wrong: Sequence[Wrong] = ()
) -> list[Recording]:
    """Two recordings of a rig with terms, whose parameters are off as drawn; then the readings that are wrong."""
    random = np.random.default_rng(seed)
    empty = [blank(made, "first"), blank(made, "second")]
    model = CoilNetworkModel(made, empty, laws())
    known = {str(t): t for t in (*model.terms(), *model.input_terms())}
    point = Point(0.5 * random.standard_normal(len(model.parameters)), {known[name]: values for name, values in terms})
    found = []
    for number, recording in enumerate(empty):
        channels = {
            name: replace(c, values=v + NOISE * random.standard_normal(len(v)))
            for (name, c), v in zip(recording.channels.items(), model.predict(point, number))
        }
        for one in (w for w in wrong if w.recording == number):
            channels[one.channel] = sabotaged(channels[one.channel], one)
        found.append(replace(recording, channels=channels))
    return found


def sabotaged(channel: Channel, wrong: Wrong) -> Channel:
    """The readings of a sensor at fault."""
    begin, end = (channel.times[0] + s * np.ptp(channel.times) for s in (wrong.begin, wrong.end))
    inside = (channel.times >= begin) & (channel.times < end)
    values = channel.values.copy()
    if wrong.amount is None:
        values[inside] = values[np.argmax(inside)]
    else:
        values[inside] += wrong.amount
    return replace(channel, values=values)


def faulty(made: Scenario, recordings: Sequence[Recording]) -> FaultyModel:
    return with_faults(CoilNetworkModel(made, recordings, laws()))


def found(made: Scenario, recordings: Sequence[Recording]) -> Outcome:
    """What the search finds."""
    model = faulty(made, recordings)
    return search(model, model.terms(), Settings(), model.groups())


def interval(outcome: Outcome, term: Term) -> tuple[float, float]:
    """Begin and end of a fault that was found [s]."""
    _, begin, end = outcome.best.fit.point.terms[term]
    return begin, end
