"""What a simulated recording does step by step: the variables that a unit is driven with and that laws depend on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import AnyArray, Array
from diagnosis.locate.fitted import Fitted
from diagnosis.models.coil_network.kernel.layout import COIL_FIELDS
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters

#: Most steps of a course: matrices of responses grow with them. 100 s have steps of 0.25 s, shorter than any lag here.
MOST_STEPS = 400
#: Least heat flow per kelvin and heat capacity that are divided by.
TINY = 1e-30


@dataclass(frozen=True)
class Course:
    """Variables of one simulated recording; arrays over steps hold means over each step.

    Args:
        time: Ends of the steps [s], the start first, shape (steps + 1,).
        ambient: [K], shape (steps, coils).
        temperature: [K], shape (steps, coils).
        rate: Of the temperature [K/s], shape (steps, coils).
        current: Of each coil [A], shape (steps, coils).
        power: [W], shape (steps, coils).
        energy: Electrical energy so far [J], shape (steps, coils).
        stiffness: [N/m], shape (steps, coils).
        phase: Share of austenite, shape (steps, coils).
        extension: [m], shape (steps, coils).
        loss: Share of the excess temperature that is lost per second [1/s], shape (steps, coils).
        capacity: Heat capacity [J/K], shape (coils,).
        resistance: Of each coil [ohm], shape (coils,).
        string_resistance: Of each string with its coils [ohm], shape (strings,).
        load: [N], shape (coils,).
        string_of_coil: String of each coil, from 0, shape (coils,).
        since_switch: Time since the supply last jumped [s], shape (steps,).
    """

    time: Array
    ambient: Array
    temperature: Array
    rate: Array
    current: Array
    power: Array
    energy: Array
    stiffness: Array
    phase: Array
    extension: Array
    loss: Array
    capacity: Array
    resistance: Array
    string_resistance: Array
    load: Array
    string_of_coil: AnyArray
    since_switch: Array

    @property
    def middle(self) -> Array:
        """Middles of the steps [s], shape (steps,)."""
        return np.asarray(0.5 * (self.time[1:] + self.time[:-1]))

    @property
    def size(self) -> Array:
        """Lengths of the steps [s], shape (steps,)."""
        return np.diff(self.time)


def course(model: Fitted, number: int) -> Course:
    """Simulate one recording and keep what happens in it.

    Args:
        model: Recalibrated.
        number: Of the recording, from 0.

    Raises:
        CoilNetworkError: The model does not stay finite there.
    """
    run, parameters = model.network.runs[number], model.values(number)
    fine = run.inputs.time
    middle = 0.5 * (fine[1:] + fine[:-1])
    coils, strings = model.coils.coils, model.coils.strings
    wanted = {"temperature": fine, "power": middle, "stiffness": fine, "extension": fine, "resistance": fine[:1]}
    if strings:
        wanted["current"] = middle
    found = model.network.network.simulate(parameters, run.inputs, wanted)
    time = _coarse(fine)
    held = {n: _means(fine, time, v, n in ("power", "current")) for n, v in found.items() if n != "resistance"}
    base = {
        n: _over(parameters, n, coils)
        for n in (
            "conductance",
            "capacity",
            "cooling_rate",
            "heating_a",
            "heating_d",
            "load",
            "ambient_offset",
            "off_power",
        )
    }
    is_off = (held["power"] <= base["off_power"]) & (_over(parameters, "use_regressed_cooling_rate", coils) != 0.0)
    edges = np.stack([np.interp(time, fine, found["temperature"][:, c]) for c in range(coils)], axis=1)
    resistance = found["resistance"][0]
    in_series = np.broadcast_to(np.asarray(parameters.base.get("string_resistance", 0.0)), (len(strings),))
    ambient = _means(fine, time, run.inputs.ambient[:, None], is_flow=True) + base["ambient_offset"]
    current = held["current"][:, model.coils.string_of_coil] if strings else np.zeros((len(time) - 1, coils))
    return Course(
        time=time,
        ambient=ambient,
        temperature=held["temperature"],
        rate=np.diff(edges, axis=0) / np.diff(time)[:, None],
        current=current,
        power=held["power"],
        energy=np.cumsum(held["power"] * np.diff(time)[:, None], axis=0),
        stiffness=held["stiffness"],
        phase=np.clip((held["stiffness"] - base["heating_d"]) / base["heating_a"], 0.0, 1.0),
        extension=held["extension"],
        loss=np.where(is_off, base["cooling_rate"], base["conductance"] / base["capacity"]),
        capacity=base["capacity"],
        resistance=resistance,
        string_resistance=in_series + np.bincount(model.coils.string_of_coil, resistance, minlength=len(strings))
        if strings
        else np.zeros(0),
        load=base["load"],
        string_of_coil=model.coils.string_of_coil,
        since_switch=_since_switch(run.inputs.is_switch, fine, 0.5 * (time[1:] + time[:-1])),
    )


def _over(parameters: CoilNetworkParameters, name: str, coils: int) -> Array:
    """A parameter of every coil; what the network was not given has the network's default."""
    value = np.asarray(parameters.base.get(name, COIL_FIELDS[name][0]), dtype=np.float64)
    return np.broadcast_to(value, (coils,)).copy()


def _coarse(fine: Array) -> Array:
    """At most `MOST_STEPS` steps, each of whole fine ones."""
    every = -(-(len(fine) - 1) // MOST_STEPS)
    kept = fine[::every]
    return kept if kept[-1] == fine[-1] else np.concatenate([kept, fine[-1:]])


def _means(fine: Array, time: Array, values: Array, is_flow: bool) -> Array:
    """Means over coarse steps of values at the ends (or, of flows, over the whole) of fine steps."""
    inner = values if is_flow else 0.5 * (values[1:] + values[:-1])
    total = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(inner * np.diff(fine)[:, None], axis=0)])
    at = np.searchsorted(fine, time)
    return np.asarray((total[at[1:]] - total[at[:-1]]) / np.diff(time)[:, None])


def _since_switch(is_switch: AnyArray, fine: Array, middle: Array) -> Array:
    instants = fine[:-1][np.asarray(is_switch, dtype=bool)]
    return np.asarray(middle - instants[np.searchsorted(instants, middle, side="right") - 1])
