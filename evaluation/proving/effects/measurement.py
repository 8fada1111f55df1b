"""Faults of sensors."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from evaluation.proving.effects.effect import Place, Strength, Unit, drawn_values
from evaluation.proving.sensors import Sensors


class SensorFault:
    """A fault of some channels of one kind; attributes as in `Effect`.

    Args:
        place: `channel`, `quantity` (all channels of a kind) or `swap` (two of them), with names of channels.
        parameters: Values; in SI, times `unit_of` where a strength is given in units of the sensor's noise.
    """

    identifier: ClassVar[str]
    unit: ClassVar[Unit] = "measurement"
    is_named: ClassVar[bool] = True
    law: str
    places: ClassVar[tuple[str, ...]] = ("channel", "quantity")
    same_parameters: ClassVar[tuple[str, ...]] = ()
    strengths: ClassVar[Mapping[str, tuple[float, float]]]
    signed: ClassVar[str] = ""
    #: Kinds of sensors that may have it.
    kinds: ClassVar[tuple[str, ...]] = ("temperature", "extension", "string", "supply")
    #: Parameters whose strength is in units of the sensor's typical reading.
    relative: ClassVar[tuple[str, ...]] = ()

    def __init__(self, place: Place, parameters: Mapping[str, float]) -> None:
        self.place = place
        self.parameters = dict(parameters)

    def spoil(self, sensors: Sensors) -> None:
        """Change the sensors of its channels."""
        raise NotImplementedError


class ClockOffset(SensorFault):
    identifier = "sensor_clock_offset"
    law = "value = truth(t - delay)"
    same_parameters = ("delay",)
    strengths = {"delay": (0.5, 2.0)}
    signed = "delay"

    def spoil(self, sensors: Sensors) -> None:
        sensors.delay[sensors.rows(self.place.channels)] += self.parameters["delay"]


class Lag(SensorFault):
    identifier = "sensor_lag"
    law = "lag_time * d(value) = truth - value"
    same_parameters = ("lag_time",)
    strengths = {"lag_time": (0.6, 2.5)}
    kinds = ("temperature", "extension")

    def spoil(self, sensors: Sensors) -> None:
        sensors.lag[sensors.rows(self.place.channels)] += self.parameters["lag_time"]


class Gain(SensorFault):
    identifier = "sensor_gain"
    law = "value = truth + gain * (truth - pivot)"
    same_parameters = ("gain",)
    strengths = {"gain": (0.05, 0.2)}
    signed = "gain"
    places = ("channel",)

    def spoil(self, sensors: Sensors) -> None:
        sensors.gain[sensors.rows(self.place.channels)] += self.parameters["gain"]


#: A typical reading [SI]: what biases and drifts are measured in.
TYPICAL = {"temperature": 20.0, "extension": 2e-3, "string": 0.3, "supply": 1.5}


class Bias(SensorFault):
    identifier = "sensor_bias"
    law = "value = truth + bias"
    strengths = {"bias": (0.08, 0.32)}
    signed = "bias"
    relative = ("bias",)
    places = ("channel",)

    def spoil(self, sensors: Sensors) -> None:
        sensors.bias[sensors.rows(self.place.channels)] += self.parameters["bias"]


class Drift(SensorFault):
    identifier = "sensor_drift"
    law = "value = truth + drift * t"
    strengths = {"drift": (0.0015, 0.006)}
    signed = "drift"
    relative = ("drift",)
    places = ("channel",)

    def spoil(self, sensors: Sensors) -> None:
        sensors.drift[sensors.rows(self.place.channels)] += self.parameters["drift"]


class Clipping(SensorFault):
    identifier = "sensor_clipping"
    law = "value = min(truth, ceiling)"
    #: Share of the way from the least to the greatest true reading.
    strengths = {"share": (0.85, 0.5)}

    def spoil(self, sensors: Sensors) -> None:
        sensors.ceiling[sensors.rows(self.place.channels)] = self.parameters["ceiling"]


class WrongIdentity(SensorFault):
    identifier = "wrong_identity"
    law = "two channels are exchanged"
    places = ("swap",)
    strengths = {"exchange": (1.0, 1.0)}
    kinds = ("temperature", "extension", "string")

    def spoil(self, sensors: Sensors) -> None:
        first, second = sensors.rows(self.place.channels)
        sensors.element[[first, second]] = sensors.element[[second, first]]


class CurrentPickup(SensorFault):
    """The thermocouple touches the wire and reads part of its voltage."""

    identifier = "current_pickup"
    is_named = False
    law = "value = truth + pickup * I"
    strengths = {"pickup": (4.0, 16.0)}  # [K/A]
    signed = "pickup"
    kinds = ("temperature",)

    def spoil(self, sensors: Sensors) -> None:
        sensors.pickup[sensors.rows(self.place.channels)] += self.parameters["pickup"]


class BentScale(SensorFault):
    """An amplifier that gives way at large readings."""

    identifier = "bent_scale"
    is_named = False
    law = "value = truth - bend * (truth - pivot)**2"
    strengths = {"bend": (0.001, 0.004)}  # [1/K]
    kinds = ("temperature",)

    def spoil(self, sensors: Sensors) -> None:
        sensors.bend[sensors.rows(self.place.channels)] += self.parameters["bend"]


EFFECTS: tuple[type[SensorFault], ...] = (
    ClockOffset,
    Lag,
    Gain,
    Bias,
    Drift,
    Clipping,
    WrongIdentity,
    CurrentPickup,
    BentScale,
)


def drawn_fault(
    fault: type[SensorFault], networks: Mapping[str, Sensors], strength: Strength, rng: np.random.Generator
) -> SensorFault:
    """A fault with its channels drawn; a clipping still needs its `ceiling`.

    Args:
        fault: Which.
        networks: Sensors that the rig has, by kind.
        strength: How much.
        rng: Source of draws.
    """
    kind = str(
        rng.choice(
            [k for k in fault.kinds if k in networks and (len(networks[k].names) > 1 or "swap" not in fault.places)]
        )
    )
    names = networks[kind].names
    place_kind = str(rng.choice(list(fault.places)))
    if place_kind == "channel":
        chosen: tuple[str, ...] = (str(rng.choice(list(names))),)
    elif place_kind == "swap":
        first = str(rng.choice(list(names)))
        # Coils of one string are so alike that other parameters explain an exchange: take two strings.
        chosen = (first, str(rng.choice([n for n in names if _string(n) != _string(first)])))
    else:
        chosen = names
    parameters = drawn_values(fault.strengths, {}, strength, rng)
    for name in fault.relative:
        parameters[name] *= TYPICAL[kind]
    if fault.signed and rng.random() < 0.5:
        parameters[fault.signed] *= -1.0
    return fault(Place(place_kind, (), np.zeros(0), chosen), parameters)


def _string(name: str) -> str:
    """`coil[2,5].temperature` -> `2`."""
    return name.partition("[")[2].partition("]")[0].partition(",")[0]
