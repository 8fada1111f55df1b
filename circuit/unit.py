"""The coil network as a unit of the co-simulation: voltages and resistances in, currents and powers out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from circuit.elements import FADING
from circuit.kirchhoff import Laws, Solution
from circuit.netlist import (
    MAX_RESISTANCE,
    MIN_RESISTANCE,
    Network,
    ammeter_name,
    coil_name,
    coil_nodes,
    contact_name,
    render,
    source_name,
)
from circuit.ngspice import Circuit, NgspiceError, require_ngspice
from cosim.unit.protocol import (
    Array,
    ArrayStore,
    Causality,
    Coordinate,
    StepOutcome,
    StepStatus,
    Unit,
    UnitError,
    Variable,
    seconds,
)

INPUTS = ("supply_voltage", "resistance")

#: Solutions in which a lead's resistance is found from its current; each makes the error smaller by the share that the
#: lead has in its string.
MOST_TURNS = 100
#: Change of that resistance, relative to its size, at which it is found: what `circuit.kirchhoff` cannot see.
SETTLED = 1e-13


class CircuitUnit(Unit):
    """A network of coils solved by ngspice; its outputs follow its inputs at once, but for sources that are slow.

    ngspice solves only when an input differs from that of the last solution; `solves` counts. Each solution is held
    against Kirchhoff's and Ohm's laws (`circuit.kirchhoff`).

    An open coil carries what 1e12 ohm let pass (6 pA at 6 V, reported as solved) and takes the voltage of its string;
    a shorted coil carries the current of its string at exactly 0 V and 0 W. The `resistance` given for either is not
    used. Voltages may be negative; the current then is, too. The elements of the network (`circuit.elements`) lie in
    series: leads are solved again until current and resistance agree, a limited source is solved at its lower voltage.

    Args:
        name: Name of the unit in error texts.
        network: What is connected to what.

    Raises:
        NgspiceMissingError, PySpiceMissingError: libngspice or PySpice is not there (UnitErrors and ValueErrors).
            Whether it is there is found out here; it is loaded for the first solution, as a check of a scenario does
            without it.
    """

    can_restore = True

    def __init__(self, name: str, network: Network) -> None:
        self.name, self.network = name, network
        self.variables: Mapping[str, Variable] = {v.name: v for v in _variables(network)}
        # While it steps it is sampled: its outputs change in `do_step` alone.
        self.initial_feedthrough = {
            n: frozenset(INPUTS) for n, v in self.variables.items() if v.causality is Causality.OUTPUT
        }
        self.coordinates: Mapping[str, Coordinate] = _coordinates(network)
        #: Number of solutions that ngspice has made for this unit.
        self.solves = 0
        faulty = {*network.open_coils, *network.shorted_coils}
        self._elements = [source_name(s) for s in range(1, network.sources + 1)]
        self._elements += [coil_name(c) for c in range(1, network.coils + 1)]
        self._whole = np.array([c not in faulty for c in range(1, network.coils + 1)])
        self._in_use = np.concatenate([np.ones(network.sources, dtype=bool), self._whole])
        self._series, self._rises = network.series, network.series.rises()
        self._drops = self._series.drops()
        self._delays = self._series.delays()
        self._is_slow = self._delays > 0.0
        self._has_slow = bool(self._is_slow.any())
        self._behind = np.zeros(network.sources)  # voltage of the sources that are slow [V]
        self._by_current = (self._rises > 0.0) | (self._drops > 0.0)
        self._with_contacts = [n - 1 for n in network.strings_with_contacts()]
        self._elements += [f"{contact_name(n + 1)} gain" for n in self._with_contacts]
        self._in_use = np.append(self._in_use, np.ones(len(self._with_contacts), dtype=bool))
        self._store = ArrayStore(name, self.variables)
        self._solved = np.full(len(self._elements), np.nan)  # inputs that the outputs belong to
        self._altered = np.full(len(self._elements), np.nan)  # values that ngspice holds
        self._laws = Laws(network)
        nodes = coil_nodes(network)
        self._nodes = sorted(set(nodes) - {"0"})
        #: Place of every coil's node among `_nodes`; ground comes after the last.
        number = {n: k for k, n in enumerate(self._nodes)}
        self._node_of_coil = np.array([number.get(n, len(number)) for n in nodes])
        self._start = 0
        require_ngspice()
        self._circuit: Circuit | None = None  # made for the first solution
        self._is_terminated = False

    def _vectors(self) -> list[str]:
        network = self.network
        return [
            *self._nodes,
            *(f"{ammeter_name(s)}#branch" for s in range(1, len(network.strings) + 1)),
            *(f"{source_name(s)}#branch" for s in range(1, network.sources + 1)),
        ]

    def set(self, name: str, value: Array) -> None:
        """Copy to an input: `supply_voltage` [V] or `resistance` [ohm]; UnitError if it is not finite."""
        if name not in INPUTS:
            raise UnitError(self.name, f"{name} is not an input", remedy=f"inputs: {', '.join(INPUTS)}")
        self._store.set(name, value)

    def get(self, name: str) -> Array:
        """The live array of a variable, SI."""
        return self._store.get(name)

    def initialise(self, time: int) -> None:
        """Solve with the inputs that are set; UnitError if one is not or is out of range."""
        self._start = time
        self._follow_inputs(time, time)

    def refresh(self) -> None:
        """Solve again with the inputs set since (start values that close a loop)."""
        self._follow_inputs(self._start, self._start)

    def do_step(self, time: int, size: int) -> StepOutcome:
        """Outputs at `time + size` of the inputs held over the step.

        Raises:
            UnitError: A resistance is out of range, ngspice fails, or its solution breaks Kirchhoff's laws.
        """
        self._follow_inputs(time, time + size)
        return StepOutcome(StepStatus.OK, time + size)

    def checkpoint(self) -> dict[str, npt.NDArray[np.generic]]:
        """All inputs and outputs, the inputs that the outputs belong to, and the voltage of slow sources."""
        return {n: a.copy() for n, a in self._memory().items()}

    def resume(self, state: Mapping[str, npt.NDArray[np.generic]], time: int) -> None:
        """Go on from a checkpoint; UnitError if it belongs to another network."""
        for name, array in self._memory().items():
            if name not in state or state[name].shape != array.shape:
                raise UnitError(
                    self.name, f"the checkpoint's {name} does not fit this network", time, "resume the same scenario"
                )
            array[...] = state[name]

    def _memory(self) -> dict[str, Array]:
        """Live arrays that a checkpoint holds."""
        slow = {"behind": self._behind} if self._has_slow else {}
        return {"solved": self._solved, **slow, **self._store.arrays}

    def terminate(self) -> None:
        """Free the circuit in ngspice."""
        self._is_terminated = True
        if self._circuit is not None:
            self._circuit.remove()
            self._circuit = None

    def _follow_inputs(self, begin: int, time: int) -> None:
        arrays = self._store.arrays
        contacts = self._series.contacts(begin, time)
        voltage = self._slowed(arrays["supply_voltage"].reshape(-1), seconds(time - begin))
        wanted = np.concatenate([voltage, arrays["resistance"], contacts[self._with_contacts]])
        if np.array_equal(wanted[self._in_use], self._solved[self._in_use]):
            return
        self._check_inputs(time)
        solution = self._settled(wanted, contacts, time)
        violation = self._laws.violation(solution)
        if violation:
            raise UnitError(self.name, violation, time, "keep the resistances of a string within 12 orders of size")
        self._publish(solution)
        self._solved[...] = wanted

    def _slowed(self, voltage: Array, size: float) -> Array:
        """Mean over a step of `size` [s] of the voltage of every source; slow ones are behind what is set."""
        if not self._has_slow or np.isnan(voltage).any():
            return voltage
        is_slow, delay = self._is_slow, np.where(self._is_slow, self._delays, 1.0)
        gap, decay = self._behind - voltage, np.exp(-size / delay)
        mean = voltage + gap * ((1.0 - decay) * delay / size if size > 0.0 else 1.0)
        self._behind[...] = np.where(is_slow, voltage + gap * decay, 0.0)
        return np.where(is_slow, mean, voltage)

    def _check_inputs(self, time: int) -> None:
        for name in INPUTS:
            if np.isnan(self._store.arrays[name]).any():
                raise UnitError(
                    self.name, f"the input {name} was never set", time, "connect it or give it a start value"
                )
        resistance = self._store.arrays["resistance"]
        wrong = np.flatnonzero(self._whole & ~((resistance >= MIN_RESISTANCE) & (resistance <= MAX_RESISTANCE)))
        if wrong.size:
            coil = int(wrong[0])
            raise UnitError(
                self.name,
                f"resistance of {self.network.place(coil + 1)} is {resistance[coil]:g} ohm",
                time,
                f"it must lie within {MIN_RESISTANCE:g} to {MAX_RESISTANCE:g} ohm; list broken coils in open_coils or "
                "shorted_coils",
            )

    def _settled(self, wanted: Array, contacts: Array, time: int) -> Solution:
        """The solution in which what depends on a string's current agrees with it."""
        now = contacts
        for _ in range(MOST_TURNS):
            solution = self._limited(wanted, now, time)
            if not self._by_current.any():
                return solution
            current = np.abs(solution.string_current)
            last, now = now, contacts + self._rises * current**2 + self._drops / (current + FADING)
            if np.all(np.abs(now - last) <= SETTLED * (1.0 + now)):
                return solution
            now = np.where(self._by_current, 0.5 * (now + last), now)  # a lead that rules its string would swing
        raise UnitError(
            self.name, "the resistance of a lead does not settle", time, "give it a smaller rise, or a lower voltage"
        )

    def _limited(self, wanted: Array, contacts: Array, time: int) -> Solution:
        """The solution with the currents of all sources within their limits: the network is linear in the voltage."""
        free = self._solution(wanted, contacts, time)
        sources = self.network.sources
        lowered = self._series.lowered(wanted[:sources], free.source_current)
        if np.array_equal(lowered, wanted[:sources]):
            return free
        return self._solution(np.concatenate([lowered, wanted[sources:]]), contacts, time)

    def _loaded(self, time: int) -> Circuit:
        """The circuit in ngspice, loaded at the first call; UnitError if ngspice does not take the netlist."""
        if self._is_terminated:
            raise UnitError(self.name, "the unit was terminated", time, "construct a new one")
        if self._circuit is None:
            try:
                self._circuit = Circuit(render(self.network), self._vectors())
            except NgspiceError as fault:
                raise UnitError(self.name, str(fault), time) from fault
        return self._circuit

    def _solution(self, wanted: Array, contacts: Array, time: int) -> Solution:
        """One operating point; `contacts` are those of all strings [ohm] and replace the ones in `wanted`."""
        circuit = self._loaded(time)
        whole = self.network.sources + self.network.coils
        wanted = np.concatenate([wanted[:whole], contacts[self._with_contacts]])
        changed = np.flatnonzero(self._in_use & (wanted != self._altered))
        try:
            values = circuit.solve({self._elements[i]: float(wanted[i]) for i in changed})
        except NgspiceError as fault:
            self._altered[...] = np.nan  # unknown how far ngspice came: alter everything next time
            raise UnitError(self.name, str(fault), time, "check voltages and resistances") from fault
        self._altered[changed] = wanted[changed]
        self.solves += 1
        n, strings, sources = len(self._nodes), len(self.network.strings), self.network.sources
        return Solution(
            source_voltage=wanted[:sources],
            resistance=wanted[sources:whole],
            node_voltage=np.append(values[:n], 0.0)[self._node_of_coil],
            string_current=values[n : n + strings],
            source_current=-values[n + strings :],  # SPICE counts current into a source's positive terminal
            contacts=contacts,
        )

    def _publish(self, solution: Solution) -> None:
        arrays = self._store.arrays
        arrays["string_current"][...] = solution.string_current
        arrays["current"][...] = self._laws.coil_current(solution.string_current)
        arrays["voltage"][...] = self._laws.coil_voltage(solution.node_voltage)
        np.multiply(arrays["voltage"], arrays["current"], out=arrays["power"])
        arrays["supply_current"][...] = solution.source_current.sum()
        terminal = solution.source_voltage - self._laws.supply_drop(solution)
        arrays["terminal_voltage"][...] = terminal.reshape(arrays["terminal_voltage"].shape)
        arrays["supply_power"][...] = solution.source_current @ solution.source_voltage


def _variables(network: Network) -> list[Variable]:
    coil, string = (network.coils,), (len(network.strings),)
    is_common = network.supply == "common"
    into, out = Causality.INPUT, Causality.OUTPUT
    found = [
        Variable(
            "supply_voltage",
            into,
            () if is_common else string,
            "V",
            () if is_common else ("string",),
            "Voltage of the ideal source, before its series resistance",
        ),
        Variable("resistance", into, coil, "ohm", ("coil",), "Resistance of a coil"),
        Variable("current", out, coil, "A", ("coil",), "Current through a coil, from the supply to ground"),
        Variable("voltage", out, coil, "V", ("coil",), "Voltage across a coil"),
        Variable("power", out, coil, "W", ("coil",), "Heat in a coil"),
        Variable("string_current", out, string, "A", ("string",), "Current through a string"),
        Variable(
            "terminal_voltage",
            out,
            () if is_common else string,
            "V",
            () if is_common else ("string",),
            "Voltage at the terminals of a source, behind its series resistance",
        ),
        Variable("supply_current", out, (), "A", (), "Current out of all sources together"),
        Variable("supply_power", out, (), "W", (), "Power of all sources, with the loss in their series resistance"),
    ]
    return [replace(v, is_mean=True) if v.causality is out else v for v in found]


def _coordinates(network: Network) -> dict[str, Coordinate]:
    strings = network.coils_of_strings()
    number = np.array([s for s, coils in enumerate(strings, 1) for _ in coils])
    position = np.array([p for coils in strings for p in range(1, len(coils) + 1)])
    return {
        "string": Coordinate("string", np.arange(1, len(strings) + 1), "String of the circuit, from 1"),
        "string_of_coil": Coordinate("coil", number, "String that a coil belongs to, from 1"),
        "position_in_string": Coordinate("coil", position, "Place of a coil in its string, from 1 at the supply"),
    }
