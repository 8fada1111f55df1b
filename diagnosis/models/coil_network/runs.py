"""One recording, ready to be simulated by a coil network and compared with what was measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cosim.components import FabricComponent
from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from cosim.unit.protocol import AnyArray, Array
from diagnosis.models.coil_network.free import Clocks
from diagnosis.models.coil_network.kernel.inputs import CoilNetworkInputs, grid
from diagnosis.models.coil_network.kernel.layout import QUANTITIES, CoilNetworkLayout
from diagnosis.models.coil_network.kernel.network import CoilNetwork
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from diagnosis.models.coil_network.kernel.sensitivities import sharing_plan
from diagnosis.models.coil_network.kernel.steps import choose_step
from diagnosis.models.coil_network.kernel.whiten import Whitening
from diagnosis.models.coil_network.priors import stated_priors
from diagnosis.models.coil_network.translate import NoCoilNetwork, Translation, translate
from diagnosis.recording.quantity import Target
from diagnosis.recording.recording import Channel, Recording
from diagnosis.recording.usage import near_switch
from diagnosis.search.problem import MOST_FOLD

#: Standard deviation of a channel's zero, as a share of its noise: nothing is set better than its readings scatter.
ZERO = 0.15
#: A stated lag up to this belongs to the model of the sensors [s]; a longer one is no nuisance but a candidate.
LONGEST_LAG = 1.0


@dataclass(frozen=True)
class Series:
    """One channel of one recording, as the network samples it.

    Args:
        channel: The channel.
        quantity: Quantity of the network.
        element: Its element, from 0.
        samples: Numbers of its samples among those of the quantity.
        used: Which of them count: not clipped, not near a switch.
    """

    channel: Channel
    quantity: str
    element: int
    samples: AnyArray
    used: AnyArray

    @property
    def measured(self) -> Array:
        """Values at `samples`, SI."""
        return self.channel.values[-len(self.samples) :]

    @property
    def times(self) -> Array:
        """Times of `samples` [s]."""
        return self.channel.times[-len(self.samples) :]


class Run:
    """One recording.

    Args:
        translation: Its scenario as a network.
        recording: What was measured.
        network: Simulates it.
        step: Longest step [s]; None: as long as its error stays far below the noise.

    Raises:
        InputError: The recording has a channel that the scenario has not, or nothing within the simulated time.
    """

    def __init__(
        self, translation: Translation, recording: Recording, network: CoilNetwork, step: float | None = None
    ) -> None:
        self.translation = translation
        layout = translation.layout
        entries = _entries(translation, recording)
        _refuse_doubles(entries, recording)
        self.times: dict[str, Array] = {}
        for channel, quantity, _ in entries:
            inside = channel.times[channel.times >= translation.start]
            self.times[quantity] = np.union1d(self.times.get(quantity, np.zeros(0)), inside)
        if step is None:
            self.inputs = self._inputs(network, [(c, q) for c, q, _ in entries])
        else:
            ends = grid(translation.start, recording.end, step, translation.drive.switches())
            self.inputs = translation.drive.on_grid(ends)
        switches = np.array(translation.drive.switches())
        self.series = tuple(self._series(entry, switches, recording.switch_margin) for entry in entries)
        self.plan = sharing_plan(network, self.inputs, self.times)
        self.own_plan = network.plan(self.inputs, self.times)
        self.count = sum(len(s.samples) for s in self.series)
        self.pick = np.concatenate([self._places(layout, s) for s in self.series])
        self.measured = np.concatenate([s.measured for s in self.series])
        used = np.maximum([np.count_nonzero(s.used) for s in self.series], 1)
        # where a bound of the bias is stated, the zero is a parameter (diagnosis/models/wrappers/biased.py)
        is_implied = np.array([s.channel.bias_bound == 0.0 for s in self.series])
        # 1 / deviation, 0 where a sample does not count
        weight = np.concatenate([np.where(s.used, 1.0 / deviation(s.channel), 0.0) for s in self.series])
        shares = np.where(is_implied, 1.0 - 1.0 / np.sqrt(1.0 + used * ZERO**2), 0.0) / used
        self.weight = weight
        self._whitening = Whitening(self.pick, weight, shares, np.array([len(s.samples) for s in self.series]))

    def _inputs(self, network: CoilNetwork, channels: list[tuple[Channel, str]]) -> CoilNetworkInputs:
        deviations = {q: min(c.deviation for c, quantity in channels if quantity == q) for q in self.times}
        t = self.translation
        return choose_step(network, t.parameters, t.drive, t.start, self.times, deviations, _fastest(t)).inputs

    def _series(self, entry: tuple[Channel, str, int], switches: Array, margin: float) -> Series:
        channel, quantity, element = entry
        known = channel.times >= self.translation.start
        used = known & ~channel.is_clipped & ~near_switch(channel.times, switches, margin)
        samples = np.searchsorted(self.times[quantity], channel.times[known])
        return Series(channel, quantity, element, samples, used[known])

    def _places(self, layout: CoilNetworkLayout, series: Series) -> AnyArray:
        """Numbers of a series' samples in the network's output, which holds quantity by quantity, sample by sample."""
        first = 0
        for name in QUANTITIES:
            if name == series.quantity:
                break
            first += len(self.times.get(name, ())) * layout.elements(name)
        return np.asarray(first + series.samples * layout.elements(series.quantity) + series.element)

    @property
    def shares(self) -> Array:
        """Share of the sum of each channel's residuals that is taken away (`kernel.whiten`)."""
        return self._whitening.shares

    def residuals(self, outputs: Array) -> Array:
        """(measured - simulated) / deviation, shape (sets, samples), from the network's outputs (sets, out_size).

        They are whitened for a zero of each channel that is off by an unknown `ZERO`, and not finite where an output is
        not.
        """
        with np.errstate(over="ignore", invalid="ignore"):  # a quantity that the network does not watch may run away
            return self._whitening.values((self.measured - outputs[:, self.pick]) * self.weight)

    def slopes(
        self, slopes: Array, rows: int | None = None, into: AnyArray | None = None, factors: Array | None = None
    ) -> AnyArray:
        """Derivatives of outputs, shape (directions, out_size), to those of residuals; see `Whitening.slopes`."""
        return self._whitening.slopes(slopes, len(slopes) if rows is None else rows, into, factors)


def _refuse_doubles(entries: Sequence[tuple[Channel, str, int]], recording: Recording) -> None:
    """Two channels of one quantity: no law of the network could say which of the two sensors is wrong."""
    known: dict[tuple[str, int], Channel] = {}
    for channel, quantity, element in entries:
        other = known.setdefault((quantity, element), channel)
        if other is not channel:
            key, problem = f"channels.{channel.name}", f"it measures the same as {other.name}"
            raise InputError(recording.path / "recording.yaml", key, problem, "leave one of the two out")


def _fastest(translation: Translation) -> CoilNetworkParameters:
    """The rig with the shortest time constants that its priors hold probable: two deviations from what is stated."""
    base = translation.parameters.base
    priors = stated_priors(translation.uncertainty, translation.scatter)
    doubt = {n: float(np.hypot(priors[n].shared, priors[n].scatter)) for n in ("capacity", "conductance")}
    away = {n: min(2.0 * d, MOST_FOLD) for n, d in doubt.items()}
    return translation.parameters.with_base(
        capacity=np.asarray(base["capacity"]) * np.exp(-away["capacity"]),
        conductance=np.asarray(base["conductance"]) * np.exp(away["conductance"]),
    )


def clocks(runs: Sequence[Run]) -> Clocks:
    """How late readings may be."""
    late: dict[str, float] = {}
    slow: dict[str, float] = {}
    for s in (s for run in runs for s in run.series):
        lag = s.channel.lag_bound if s.channel.lag_bound <= LONGEST_LAG else 0.0
        slow[s.quantity] = max(slow.get(s.quantity, 0.0), lag)
        late[s.quantity] = max(late.get(s.quantity, 0.0), s.channel.offset_bound)
    return Clocks({q: v for q, v in late.items() if v > 0.0}, {q: v for q, v in slow.items() if v > 0.0})


def deviation(channel: Channel) -> float:
    """Noise and rounding together."""
    return float(np.hypot(channel.deviation, channel.quantum / np.sqrt(12.0) if channel.is_deviation_given else 0.0))


#: Variables of a circuit to the names under which a network has them; variables of coils have their own name.
_OF_CIRCUIT = {
    "string_current": ("string", "current"),
    "supply_current": ("supply", "current"),
    "terminal_voltage": ("supply", "voltage"),
}


def own_name(target: Target, translation: Translation) -> Target:
    """A variable of a component by the name of the network: `heaters.temperature[1]` is `coil[1].temperature`.

    Args:
        target: What a channel measures.
        translation: The scenario as a network.

    Returns:
        The same target where the network has no such variable; `network_quantity` refuses it.
    """
    if target.kind not in (translation.actuator, translation.circuit, translation.load):
        return target
    if target.kind == translation.circuit and target.quantity in _OF_CIRCUIT:
        kind, quantity = _OF_CIRCUIT[target.quantity]
        return Target(kind, target.element, quantity) if len(target.element) == (kind == "string") else target
    if len(target.element) == 1 and target.quantity in QUANTITIES and QUANTITIES[target.quantity].axis == "coil":
        return Target("coil", target.element, target.quantity)
    return target


def refuse_unknown(scenario: Scenario, recording: Recording) -> None:
    """Refuse channels that a diagnosis of this scenario could not compare, before anything is simulated.

    Args:
        scenario: Under the conditions of the recording.
        recording: What was measured.

    Raises:
        InputError: The scenario is a network of coils, and a channel is none of its quantities, or two are the same.
    """
    if any(isinstance(c, FabricComponent) for c in scenario.components.values()):
        return  # it has channels that no network has
    try:
        translation = translate(scenario)
    except NoCoilNetwork:
        return
    _refuse_doubles(_entries(translation, recording), recording)


def _entries(translation: Translation, recording: Recording) -> list[tuple[Channel, str, int]]:
    """Channels, each with its quantity of the network and its element."""
    named = [(c, own_name(c.target, translation)) for c in recording.channels.values()]
    return [(c, *network_quantity(target, translation.layout, recording)) for c, target in named]


def network_quantity(target: Target, layout: CoilNetworkLayout, recording: Recording) -> tuple[str, int]:
    """Quantity of the network and number of its element (from 0) for a channel.

    Raises:
        InputError: The scenario has no such quantity.
    """
    source = recording.path / "recording.yaml"
    place = _place(target, layout)
    if place is not None:
        return place
    problem, remedy = "the scenario has no such quantity", f"it has {_rig(layout)}"
    if (target.kind, target.quantity) == ("supply", "voltage") and layout.sources > 1:
        problem, remedy = "every string has a supply of its own", "name `string[n].voltage`, across its coils"
    elif (target.kind, target.quantity) in _CIRCUIT and not layout.strings:
        problem, remedy = "the scenario has no circuit: it gives the power of its heaters", "leave the channel out"
    elif target.is_component:
        problem = "a network of coils is compared by the names of its supply, strings and coils"
        remedy = "write for example `coil[1].temperature`; docs/recordings.md lists the names"
    raise InputError(source, f"channels.{target}", problem, remedy)


#: Quantity of the network by kind and quantity of a channel where their names differ; those of a circuit.
_CIRCUIT = {
    ("supply", "current"): "supply_current",
    ("supply", "voltage"): "terminal_voltage",
    ("supply", "power"): "supply_power",
    ("string", "current"): "current",
    ("string", "voltage"): "string_voltage",
    ("coil", "current"): "current",
    ("coil", "voltage"): "voltage",
}


def _place(target: Target, layout: CoilNetworkLayout) -> tuple[str, int] | None:
    """Quantity of the network and number of its element; None: it has none."""
    name = _CIRCUIT.get((target.kind, target.quantity), target.quantity)
    if target.kind not in ("supply", "string", "coil") or name not in QUANTITIES or not layout.elements(name):
        return None
    if target.kind == "supply":
        return (name, 0) if name != "terminal_voltage" or layout.sources == 1 else None
    if target.kind == "string":
        return (name, target.element[0] - 1) if target.element[0] <= len(layout.strings) else None
    coil = _coil(target.element, layout)
    if coil is None or (QUANTITIES[name].axis != "coil" and name != "current"):
        return None
    return name, int(layout.string_of_coil[coil]) if name == "current" else coil


def check_rig(layout: CoilNetworkLayout, first: CoilNetworkLayout, recording: Recording) -> None:
    """Refuse a recording of another rig: numbers of one coil, and laws at its place, say nothing of another rig's.

    Args:
        layout: Coils and strings of the scenario under the conditions of the recording.
        first: Those of the recordings before it.
        recording: The recording.

    Raises:
        InputError: They differ.
    """
    if layout == first:
        return
    raise InputError(
        recording.path / "recording.yaml",
        "overrides",
        f"its rig is not that of the other recordings: {_wired(layout)}, not {_wired(first)}",
        "diagnose them one by one; a string that is not connected is one with an open coil (`open_coils`)",
    )


def _wired(layout: CoilNetworkLayout) -> str:
    if not layout.strings:
        return f"{layout.coils} coils without a circuit"
    supply = "one supply for all strings" if layout.supply == "common" else "a supply for each string"
    return f"strings of {', '.join(map(str, layout.strings))} coils and {supply}"


def _rig(layout: CoilNetworkLayout) -> str:
    return f"{layout.coils} coils in {len(layout.strings)} strings" if layout.strings else f"{layout.coils} coils"


def _coil(element: tuple[int, ...], layout: CoilNetworkLayout) -> int | None:
    """Number of a coil from 0; without a circuit all coils are one string."""
    strings = layout.strings or (layout.coils,)
    if len(element) == 1:
        return element[0] - 1 if element[0] <= layout.coils else None
    string, place = element
    if string > len(strings) or place > strings[string - 1]:
        return None
    return sum(strings[: string - 1]) + place - 1
