"""What the search may change in a coil network: free parameters, and how each of them acts on the network's own."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.models.coil_network.kernel.layout import AXIS_OF_FIELD, QUANTITIES, CoilNetworkLayout
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from diagnosis.models.coil_network.kernel.places import coil_label
from diagnosis.models.coil_network.kernel.sensitivities import Direction
from diagnosis.models.coil_network.priors import DailyPriors, Prior, matters
from diagnosis.search.problem import MOST_FOLD, Alike, Own, Parameter
from diagnosis.search.shares import own_label

#: Both branches of the stiffness moved along the temperature; no field of the network.
SHIFTS: Mapping[str, tuple[str, ...]] = {
    "heating_shift": ("heating",),
    "cooling_shift": ("cooling",),
    "transformation_shift": ("heating", "cooling"),
}


#: Field of the network that begins and ends at a branch of the loop.
POSITION, HALF_WAY = "initial_loop_position", 0.5
#: Of a stated bound half is one deviation of a clock, a fifth the typical lag of a sensor.
LATE_SHARE, LAG_SHARE = 0.5, 0.2
#: Deviation of the logarithm of a sensor's lag.
LAG_SPREAD = 0.9
#: Deviation of the gain of an ammeter as bought (0.1 to 0.3 % of the reading).
CALIBRATION = 0.002


@dataclass(frozen=True)
class Clocks:
    """How late readings may be by what the recordings state of clocks and sensors; quantity to seconds.

    Args:
        late: How far the clock may be off.
        slow: Largest lag of the sensors.
    """

    late: Mapping[str, float]
    slow: Mapping[str, float]


@dataclass(frozen=True)
class Free:
    """A free parameter in terms of the network: values change by a factor or a summand over a mask.

    Args:
        field: Base parameter of the network, or one of `SHIFTS`.
        mask: Weight at every element of the field's axis.
        parameter: As the search sees it.
        recordings: Numbers of the recordings that it belongs to, or None: all.
    """

    field: str
    mask: Array
    parameter: Parameter
    recordings: frozenset[int] | None = None

    def belongs_to(self, recording: int) -> bool:
        """Whether it acts in a recording."""
        return self.recordings is None or recording in self.recordings


def free_parameters(
    layout: CoilNetworkLayout,
    nominal: Mapping[str, float | Array],
    measured: Collection[str],
    clocks: Clocks,
    priors: Mapping[str, Prior],
    daily: DailyPriors,
) -> Iterator[Free]:
    """All that may be off.

    Args:
        layout: Coils and strings.
        nominal: Values of the scenario.
        measured: Quantities of which there are channels.
        clocks: How late readings may be.
        priors: Base parameter of the network to how far it may be off.
        daily: What recordings share of their room and their start, and what each has by itself.
    """
    for name, prior in priors.items():
        value = float(np.median(nominal[name])) if name in nominal else 0.0  # an open coil has 1e12 ohm
        if not matters(prior, set(measured)) or (prior.is_relative and value == 0.0):
            continue
        if name == "reference_resistance" and not layout.strings:
            continue  # power is given: the resistance does nothing
        size = layout.coils if name in SHIFTS else layout.size(AXIS_OF_FIELD[name])
        if prior.shared:
            yield _free(name, name, np.ones(size), (value, prior.shared), prior)
        for i in range(size if prior.scatter and size > 1 else 0):
            one = _free(f"{coil_label(layout, i)}.{name}", name, np.eye(size)[i], (value, prior.scatter), prior)
            yield replace(one, parameter=replace(one.parameter, alike=_alike(layout, i, name)))
    yield from _sensors(clocks)
    yield from _supply_gain(measured)
    yield from _daily(layout, daily)


def _daily(layout: CoilNetworkLayout, daily: DailyPriors) -> Iterator[Free]:
    """The room and the start: what all recordings share, what those of a day share, what each has by itself."""
    every = np.ones(layout.coils)
    for name, deviation in daily.shared.items():
        yield Free(name, every, _offset(name, deviation))
    days: dict[str, list[Own]] = {}
    for number, own in enumerate(daily.own):
        room = Own("ambient_offset", number, own.day)
        days.setdefault(own_label(room), []).append(room)
    for label, rooms in days.items():
        # recordings of one day that doubt their room differently: the one that knows it best knows it for all
        deviation = min(daily.own[r.recording].ambient for r in rooms)
        offset = replace(_offset(label, deviation), own=rooms[0])
        yield Free("ambient_offset", every, offset, frozenset(r.recording for r in rooms))
    for number, own in enumerate(daily.own):
        alone = frozenset((number,))
        if not own.are_all_stated:
            start, others = Own("initial_temperature", number), every.copy()
            others[list(own.starts)] = 0.0  # a coil whose start is stated is off by that alone
            yield Free("initial_temperature", others, _own_offset(start, daily.start), alone)
        for name, unit, stated in (
            ("initial_temperature", "K", own.starts),
            ("initial_loop_position", "1", own.positions),
        ):
            for i, deviation in stated.items():
                offset = _own_offset(Own(f"{coil_label(layout, i)}.{name}", number), deviation, unit)
                alike = _alike(layout, i, f"{name} of recording {number + 1}")
                yield Free(name, np.eye(layout.coils)[i], replace(offset, alike=alike), alone)


def _offset(label: str, deviation: float, unit: str = "K") -> Parameter:
    return Parameter(label, unit, 0.0, deviation, is_relative=False)


def _own_offset(own: Own, deviation: float, unit: str = "K") -> Parameter:
    return replace(_offset(own_label(own), deviation, unit), own=own)


def _alike(layout: CoilNetworkLayout, element: int, kind: str) -> Alike:
    """Coils of one string are compared; elements that are numbered alone (strings, coils without a circuit) are not."""
    return Alike(kind, coil_label(layout, element).split(",")[0])


def _sensors(clocks: Clocks) -> Iterator[Free]:
    """Clocks and lags within what the recordings state; beyond it they are faults, and candidates."""
    for quantity, late in clocks.late.items():
        deviation, label = LATE_SHARE * late, f"delay of every {quantity}"
        clock = Parameter(label, "s", 0.0, deviation, is_relative=False, bounds=1.0 / LATE_SHARE, is_clock=True)
        yield Free("clock_offset", _over(quantity), clock)
    for quantity, slow in clocks.slow.items():
        most = -math.log(LAG_SHARE) / LAG_SPREAD  # as far below the typical lag as the bound is above it
        lag = Parameter(f"lag of every {quantity}", "s", LAG_SHARE * slow, LAG_SPREAD, bounds=most, is_clock=True)
        yield Free("sensor_lag", _over(quantity), lag)


def _over(quantity: str) -> Array:
    """1 at a quantity, else 0, shape (quantities,)."""
    return np.array([1.0 if q == quantity else 0.0 for q in QUANTITIES])


def _supply_gain(measured: Collection[str]) -> Iterator[Free]:
    """Where the currents of the strings are read too, the supply's must be their sum: two calibrations meet."""
    if {"supply_current", "current"} <= set(measured):
        label = "gain of supply.current"
        yield Free("gain_error", _over("supply_current"), Parameter(label, "1", 0.0, CALIBRATION, is_relative=False))


def _free(name: str, field: str, mask: Array, size: tuple[float, float], prior: Prior) -> Free:
    nominal, deviation = size
    unit = "K" if not prior.is_relative else "1"
    return Free(field, mask, Parameter(name, unit, nominal, deviation, prior.is_relative))


def sensor_values(free: Sequence[Free]) -> dict[str, float | Array]:
    """Nominal lags of sensors, over the quantities [s]."""
    lags = np.zeros(len(QUANTITIES))
    for one in free:
        if one.field == "sensor_lag":
            lags += one.parameter.nominal * one.mask
    return {"sensor_lag": lags}


class FreeSet:
    """Free parameters of one recording, all applied at once.

    Args:
        free: All free parameters of the model.
        recording: Those of other recordings are left out.
    """

    def __init__(self, free: Sequence[Free], recording: int) -> None:
        fields: dict[tuple[str, bool], list[int]] = {}
        for i, one in enumerate(free):
            if one.belongs_to(recording):
                fields.setdefault((one.field, one.parameter.is_relative), []).append(i)
        self._fields = [
            (
                field,
                is_relative,
                np.array(members),
                np.array([free[i].parameter.deviation * free[i].mask for i in members]),
            )
            for (field, is_relative), members in fields.items()
        ]

    def vary(self, base: dict[str, float | Array], z: Array) -> None:
        """Change base parameters of the network as free parameters at z say; z has shape (parameters,)."""
        exponents: dict[str, Array] = {}
        for field, is_relative, members, masks in self._fields:
            if not z[members].any():
                continue
            amount = z[members] @ masks
            if is_relative:
                exponents[field] = exponents.get(field, 0.0) + amount
            elif field in SHIFTS:
                for branch in SHIFTS[field]:
                    # b exp(-c (T - shift)) = b exp(c shift) exp(-c T)
                    slope = np.asarray(base[f"{branch}_c"]) * amount
                    exponents[f"{branch}_b"] = exponents.get(f"{branch}_b", 0.0) + slope
            else:
                base[field] = np.asarray(base.get(field, 0.0)) + amount
                if field == POSITION:
                    base[field] = np.clip(base[field], 0.0, 1.0)
        for name, exponent in exponents.items():
            base[name] = np.asarray(base[name]) * np.exp(np.clip(exponent, -MOST_FOLD, MOST_FOLD))


def directions(free: Free, parameters: CoilNetworkParameters) -> list[tuple[Direction, float]]:
    """Directions of the network whose weighted sum is the derivative by z."""
    deviation = free.parameter.deviation
    base = parameters.base
    if free.field in SHIFTS:
        return [
            (
                Direction(
                    f"{branch}_b",
                    np.asarray(base[f"{branch}_b"]) * np.asarray(base[f"{branch}_c"]) * free.mask,
                    1e-3,
                    is_central=False,
                ),
                deviation,
            )
            for branch in SHIFTS[free.field]
        ]
    if free.parameter.is_relative:
        return [(Direction(free.field, np.asarray(base[free.field]) * free.mask, 1e-4, is_central=False), deviation)]
    # A place in the loop ends at 0 and 1: a step goes inwards.
    step = -1e-3 if free.field == POSITION and float(np.max(base[POSITION] * free.mask)) > HALF_WAY else 1e-3
    return [(Direction(free.field, free.mask, step, is_central=False), deviation)]
