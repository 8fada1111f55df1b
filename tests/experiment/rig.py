"""A rig with an effect of our choice, whose recordings are simulated with noise and with parameters that are off."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from cosim.scenario import Scenario, load_scenario
from diagnosis.candidates.registry import catalogue
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.recording.quantity import parse_quantity
from diagnosis.recording.recording import Channel, Recording
from diagnosis.search.fit import Fit, fit
from diagnosis.search.problem import Point, Term

SCENARIO = """
title: Coils in series on one supply, a mass below each
time: {start: 0 s, stop: 60 s, macro_step: 50 ms, output_step: 100 ms, checkpoint_step: 60 s}
algorithm: {kind: gauss_seidel, order: [supply, room, circuit, actuator, load]}
components:
  supply:
    kind: programme
    outputs:
      voltage: {unit: V, points: [[0 s, 0 V], [3 s, 1.7 V], [30 s, 0 V]]}
  room:
    kind: programme
    outputs:
      temperature: {unit: K, constant: 22 degC}
  circuit: {kind: ngspice, strings: [2], supply: common, start: {resistance: 2.2 ohm}}
  actuator:
    {kind: actuator, fmu: thermal_stiffness, electrical: circuit, ambient: room, mechanical: load,
     parameters: {use_regressed_cooling_rate: false}}
  load: {kind: hanging_mass, coils: 2, mass: 100 g}
connections:
  - supply.voltage -> circuit.supply_voltage
"""
#: Channel to period [s] and noise [SI].
SENSORS = {
    "coil[1,1].temperature": (0.5, 0.3),
    "coil[1,2].temperature": (0.5, 0.3),
    "coil[1,1].extension": (0.5, 3e-4),
    "coil[1,2].extension": (0.5, 3e-4),
    "supply.current": (0.25, 3e-3),
}


@dataclass(frozen=True)
class Effect:
    """A term at a place, with its values."""

    term: str
    values: tuple[float, ...]


def scenario(folder: Path, text: str = SCENARIO) -> Scenario:
    path = folder / "scenario.yaml"
    path.write_text(text)
    return load_scenario(path)


def perfect(made: Scenario, title: str = "recording") -> Recording:
    """A recording whose sensors read nothing yet."""
    assert made.path is not None
    stop = made.time.stop.to("s")
    channels = {}
    for name, (period, noise) in SENSORS.items():
        times = np.arange(period, stop + 1e-9, period)
        channels[name] = Channel(
            name,
            parse_quantity(name),
            times,
            np.zeros(len(times)),
            noise,
            True,
            is_clipped=np.zeros(len(times), dtype=bool),
        )
    return Recording(made.path.parent, title, channels, (), {}, stop, 0.3)


def measured(made: Scenario, effect: Effect, base: np.ndarray, random: np.random.Generator) -> Recording:
    """What the sensors read where an effect acts and the model's own parameters are off by `base` deviations."""
    empty = perfect(made)
    model = CoilNetworkModel(made, [empty], catalogue())
    day = np.array([" of recording " in p.name for p in model.parameters])
    z = np.where(day, random.standard_normal(len(day)), base)
    values = model.predict(Point(z, {named(model, effect.term): effect.values}), 0)
    channels = {
        name: replace(c, values=v + c.deviation * random.standard_normal(len(v)))
        for (name, c), v in zip(empty.channels.items(), values)
    }
    return replace(empty, channels=channels)


def off(made: Scenario, random: np.random.Generator) -> np.ndarray:
    """Distances of the true parameters from the nominal ones, in prior deviations."""
    return random.standard_normal(len(CoilNetworkModel(made, [perfect(made)], catalogue()).parameters))


def named(model: CoilNetworkModel, name: str) -> Term:
    return next(t for t in model.terms() if str(t) == name)


def fitted(model: CoilNetworkModel, effects: Sequence[Effect], base: Fit) -> list[Fit]:
    """Every effect fitted with all parameters."""
    return [fit(model, base.point.plus(named(model, e.term), e.values)) for e in effects]
