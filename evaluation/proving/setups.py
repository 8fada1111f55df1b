"""The rigs that cases are made on: scenario, data sheet, what is done, and who measures."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from evaluation.proving.effects import electrical, mechanical, outside, stiffness, thermal
from evaluation.proving.effects.effect import Effect
from evaluation.proving.programme import Programme, partial, pulses, soak, staircase
from evaluation.proving.rig import DataSheet
from evaluation.proving.sensors import KINDS, Kind

Shape = Callable[[np.random.Generator, float, float], Programme]

#: All effects on the rig, in the order in which they act: what holds an extension back comes last.
EFFECTS: tuple[type[Effect], ...] = (
    *electrical.EFFECTS,
    *thermal.EFFECTS,
    *stiffness.EFFECTS,
    *(e for e in outside.EFFECTS if e is not outside.StickAndRelease),
    *mechanical.EFFECTS,
    outside.StickAndRelease,
)


@dataclass(frozen=True)
class Setup:
    """A kind of rig.

    Args:
        name: Of its scenario, `scenarios/<name>.yaml`.
        sheet: What is believed of it.
        top: Highest level of a programme [V], [W] or [K].
        stop: End of a recording [s].
        step: Longest step of the truth [s].
        shapes: Programmes by name.
        sensors: Kinds of sensors.
        effects: What can act on it.
        component: Programme of the scenario that is replaced, and its output.
    """

    name: str
    sheet: DataSheet
    top: float
    stop: float
    step: float
    shapes: Mapping[str, Shape]
    sensors: Mapping[str, Kind]
    effects: tuple[type[Effect], ...]
    component: tuple[str, str]

    def overrides(self, programme: Programme) -> dict[str, Any]:
        """Keys of the scenario that say what was done."""
        component, output = self.component
        points = [[f"{t:.6g} s", self._level(level)] for t, level in zip(programme.times, programme.levels)]
        return {
            "time": {"stop": f"{programme.stop:.6g} s"},
            "components": {component: {"outputs": {output: {"points": points}}}},
        }

    def _level(self, level: Any) -> Any:
        if self.sheet.is_driven_by_power or self.sheet.is_per_string:
            return [f"{float(v):.6g} {'V' if self.sheet.is_per_string else 'W'}" for v in level]
        return f"{float(level) - 273.15:.6g} degC" if self.sheet.is_bath else f"{float(level):.6g} V"


def _apart(shape: Shape, count: int, slower: float = 1.0) -> Shape:
    """`count` sources, each with a programme of that shape, joined at the switches of all."""

    def drawn(rng: np.random.Generator, top: float, stop: float) -> Programme:
        own = [shape(rng, top, stop / slower) for _ in range(count)]
        slow = [replace(p, times=np.round(slower * p.times, 0 if slower > 1.0 else 1), stop=stop) for p in own]
        times = np.unique(np.concatenate([p.times for p in slow]))
        levels = np.array([[float(p.at(t)) for p in slow] for t in times])
        return Programme(times, levels, stop)

    return drawn


def _bath(turns: tuple[float, ...]) -> Shape:
    """Ramps between temperatures [degC] with rests of 10 s, within 3 K of the plan."""

    def drawn(rng: np.random.Generator, top: float, stop: float) -> Programme:
        wanted = np.array([turns[0], *(t + rng.uniform(-3.0, 3.0) for t in turns[1:])])
        length = (stop - 10.0 * len(turns)) / (len(turns) - 1)
        times = np.concatenate([[n * (length + 10.0), n * (length + 10.0) + 10.0] for n in range(len(turns))])
        return Programme(np.round(times, 1), np.repeat(np.round(wanted, 1), 2) + 273.15, stop, is_ramped=True)

    return drawn


_ELECTRIC: Mapping[str, Shape] = {"staircase": staircase, "pulses": pulses, "soak": soak, "partial": partial}
_OF_SUPPLY = (electrical.SupplySourceResistance, electrical.SupplyCurrentLimit, outside.SlowSupply)
_NETWORK = Setup(
    "network",
    DataSheet(),
    6.0,
    100.0,
    0.2,
    _ELECTRIC,
    KINDS,
    tuple(e for e in EFFECTS if e is not thermal.NeighbourHeat),  # equally warm neighbours exchange nothing
    ("supply", "voltage"),
)
_LOADED = (*stiffness.EFFECTS, *mechanical.EFFECTS, outside.SoftStop, outside.StickAndRelease, outside.TwoWaySquare)
_BLOCK = (
    thermal.SecondMass,
    thermal.LossySecondMass,
    thermal.Radiation,
    thermal.TemperatureDependentConvection,
    thermal.InsulationWhenOff,
    thermal.Draught,
    thermal.NeighbourHeat,
    thermal.AmbientDrift,
    thermal.AmbientStep,
    outside.BoilingOnset,
)

SETUPS: Mapping[str, Setup] = {
    "network": _NETWORK,
    "small": replace(_NETWORK, name="small", sheet=DataSheet(strings=(3, 3)), top=3.0),
    "zones": replace(
        _NETWORK,
        name="zones",
        sheet=DataSheet(strings=(3, 3, 3, 3), is_per_string=True),
        top=3.0,
        shapes={name: _apart(shape, 4) for name, shape in _ELECTRIC.items()},
        effects=tuple(e for e in EFFECTS if e not in _OF_SUPPLY),
    ),
    "bath": Setup(
        "bath",
        DataSheet(strings=(1,), conductance=900.0 * 97.85e-6, is_bath=True),
        70.0,
        240.0,
        0.2,
        {
            "loop": _bath((30.0, 70.0, 30.0)),
            "inner": _bath((30.0, 58.0, 42.0, 64.0, 38.0, 54.0, 30.0)),
            "twice": _bath((30.0, 68.0, 34.0, 72.0, 30.0)),
            "short": _bath((30.0, 62.0, 46.0, 56.0, 30.0)),
        },
        {k: KINDS[k] for k in ("temperature", "extension")},
        _LOADED,
        ("bath", "temperature"),
    ),
    "heaters": Setup(
        "heaters",
        DataSheet(
            strings=(1, 1),
            conductance=25.0 * 32e-4,
            capacity=2700.0 * 900.0 * 3.3e-6,
            conduction=50.0,
            is_driven_by_power=True,
        ),
        4.0,
        600.0,
        0.5,
        {name: _apart(shape, 2, 6.0) for name, shape in _ELECTRIC.items() if name != "partial"},
        {"temperature": replace(KINDS["temperature"], rate=1.0)},
        _BLOCK,
        ("heater", "power"),
    ),
}
#: How often each kind of rig is used.
SHARES = {"network": 0.5, "small": 0.15, "zones": 0.1, "bath": 0.1, "heaters": 0.15}
