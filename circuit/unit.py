"""The coil network as a unit: supply voltage and resistances in, currents and powers out."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from circuit.netlist import OPEN_RESISTANCE, Network, netlist
from circuit.ngspice import simulator
from cosim.unit import Array, ArrayStore, Causality, Coordinate, StepOutcome, StepStatus, UnitError, Variable

#: Relative tolerance of Kirchhoff's laws; ngspice's own reltol does not limit a linear circuit.
TOLERANCE = 1e-9
#: Current below which differences are rounding, not a violation [A].
_LEAST_CURRENT = 1e-11


def _variables(network: Network) -> dict[str, Variable]:
    coils, strings = (network.coils,), (len(network.strings),)
    supplies, supply = ((), ()) if network.supply == "common" else (strings, ("string",))
    given, found = Causality.INPUT, Causality.OUTPUT
    listed = (
        Variable("supply_voltage", given, supplies, "V", supply, "voltage of every supply"),
        Variable("resistance", given, coils, "ohm", ("coil",), "resistance of every coil (no effect if open or shorted)"),
        Variable("current", found, coils, "A", ("coil",), "current through every coil"),
        Variable("voltage", found, coils, "V", ("coil",), "voltage across every coil"),
        Variable("power", found, coils, "W", ("coil",), "electrical power turned into heat in every coil"),
        Variable("string_current", found, strings, "A", ("string",), "current into every string"),
        Variable("supply_current", found, (), "A", (), "current out of all supplies"),
        Variable("supply_power", found, (), "W", (), "power out of all supplies"),
    )
    return {v.name: v for v in listed}


class CircuitUnit:
    """The network solved by ngspice, anew only where an input has changed.

    Args:
        name: Name of the unit.
        network: Strings, coils and supplies.

    Raises:
        UnitError: libngspice is missing.
    """

    def __init__(self, name: str, network: Network) -> None:
        self.name, self.network = name, network
        self.variables: Mapping[str, Variable] = _variables(network)
        members = network.members()
        string = np.repeat(np.arange(len(members)), network.strings)
        place = np.concatenate([np.arange(len(m)) for m in members])
        self.coordinates: Mapping[str, Coordinate] = {
            "string": Coordinate("string", np.arange(1, len(members) + 1), "string of the circuit"),
            "coil_string": Coordinate("coil", string + 1, "string that holds the coil"),
            "coil_place": Coordinate("coil", place + 1, "place of the coil in its string, from the supply"),
        }
        self._store = ArrayStore(name, self.variables)
        self._string = string
        self._first = np.array([m[0] for m in members])
        self._netlist = netlist(network)
        self._nodes = list(dict.fromkeys(n for pair in self._netlist.coil_nodes for n in pair if n != "0"))
        place_of = {n: i for i, n in enumerate(self._nodes)} | {"0": len(self._nodes)}
        pairs = self._netlist.coil_nodes
        self._high = np.array([place_of[a] for a, _ in pairs])
        self._low = np.array([place_of[b] for _, b in pairs])
        branches = [f"{v}#branch" for v in (*self._netlist.ammeters, *self._netlist.sources)]
        self._vectors = [text.encode() for text in (*self._nodes, *branches)]
        self._is_ordinary = np.array([bool(r) for r in self._netlist.resistors])
        self._solved: tuple[Array, Array] | None = None
        #: Number of times that ngspice has solved the network.
        self.solves = 0
        simulator()

    def set(self, name: str, value: Array) -> None:
        """Copy an input; raises UnitError if it is not finite."""
        self._store.set(name, value)

    def get(self, name: str) -> Array:
        """Current value of a variable."""
        return self._store.get(name)

    def initialise(self, time: int) -> None:
        """Solve at the start."""
        self._solve(time)

    def do_step(self, time: int, size: int) -> StepOutcome:
        """Solve with the present inputs; currents settle at once.

        Raises:
            UnitError: A resistance that is not positive, no solution, or one that breaks Kirchhoff's laws.
        """
        self._solve(time)
        return StepOutcome(StepStatus.OK, time + size)

    def checkpoint(self) -> dict[str, npt.NDArray[np.generic]]:
        """Inputs and outputs; there is no other state."""
        return {name: self._store.get(name).copy() for name in self.variables}

    def resume(self, state: Mapping[str, npt.NDArray[np.generic]], time: int) -> None:
        """Continue from `checkpoint`."""
        for name in self.variables:
            self._store.arrays[name][...] = state[name]
        self._solved = self._store.get("supply_voltage").copy(), self._store.get("resistance").copy()

    def terminate(self) -> None:
        """Remove the circuit from ngspice."""
        simulator().unload(self)

    def _solve(self, time: int) -> None:
        voltage, resistance = self._store.get("supply_voltage"), self._store.get("resistance")
        if self._solved is not None and all(map(np.array_equal, self._solved, (voltage, resistance))):
            return
        self._check_resistance(resistance, time)
        try:
            self._set_values(voltage, resistance)
            values = simulator().operating_point(self._vectors)
        except UnitError as error:
            raise UnitError(self.name, error.what, time, error.remedy) from error
        self.solves += 1
        self._distribute(values, time)
        self._solved = voltage.copy(), resistance.copy()

    def _check_resistance(self, resistance: Array, time: int) -> None:
        bad = np.flatnonzero(~(resistance > 0))
        if bad.size:
            raise UnitError(
                self.name, f"resistance of coil {bad[0] + 1} is {resistance[bad[0]]} Ohm", time,
                "it must be positive; a coil without resistance belongs into shorted_coils",
            )  # fmt: skip

    def _set_values(self, voltage: Array, resistance: Array) -> None:
        engine = simulator()
        known = self._solved
        is_new = engine.load(self, self._netlist.text) or known is None
        changes: list[tuple[str, float]] = []
        voltages = voltage.reshape(-1)
        for i, source in enumerate(self._netlist.sources):
            if is_new or known is None or known[0].reshape(-1)[i] != voltages[i]:
                changes.append((source, float(voltages[i])))
        for i in np.flatnonzero(self._is_ordinary):
            if is_new or known is None or known[1][i] != resistance[i]:
                changes.append((self._netlist.resistors[i], float(resistance[i])))
        self._solved = None  # until the solution is there, a failure must not pass for "unchanged"
        engine.alter(changes)

    def _distribute(self, values: Array, time: int) -> None:
        """Node voltages and branch currents to outputs."""
        put, strings = self._store.arrays, len(self.network.strings)
        if not np.isfinite(values).all():
            raise UnitError(self.name, "ngspice returned a value that is not finite", time)
        nodes = len(self._nodes)
        potential = np.append(values[:nodes], 0.0)
        put["string_current"][...] = values[nodes : nodes + strings]
        sources = -values[nodes + strings :]  # SPICE counts current into the positive terminal
        put["voltage"][...] = potential[self._high] - potential[self._low]
        through = put["string_current"][self._string]
        put["current"][...] = np.where(self._is_ordinary, put["voltage"] / put["resistance"], through)
        put["power"][...] = put["voltage"] * put["current"]
        put["supply_current"][...] = sources.sum()
        put["supply_power"][...] = (put["supply_voltage"].reshape(-1) * sources).sum()
        self._check_kirchhoff(sources, potential, time)

    def _check_kirchhoff(self, sources: Array, potential: Array, time: int) -> None:
        """Ohm's law in every coil against the ammeter of its string, and both laws of Kirchhoff."""
        put, network = self._store.arrays, self.network
        currents = put["string_current"]
        scale = max(np.abs(currents).max(), _LEAST_CURRENT / TOLERANCE)
        off = np.abs(put["current"] - currents[self._string])
        if (off > TOLERANCE * scale).any():
            worst = int(np.argmax(off))
            self._violated(f"the current of coil {worst + 1} differs by {off[worst]:.3g} A from that of its string", time)
        fed = currents.sum() if network.supply == "common" else currents
        if (np.abs(sources - fed) > TOLERANCE * scale * len(currents)).any():
            self._violated(f"the supplies give {sources.sum():.9g} A, the strings take {currents.sum():.9g} A", time)
        drop = np.add.reduceat(put["voltage"], self._first) + network.string_resistance * currents
        source_drop = network.supply_resistance * (sources if network.supply == "per_string" else sources[0])
        loop = put["supply_voltage"].reshape(-1) - source_drop - drop
        limit = TOLERANCE * max(1.0, float(np.abs(put["supply_voltage"]).max()))
        if (np.abs(loop) > limit).any():
            worst = int(np.argmax(np.abs(loop)))
            self._violated(f"the voltages around string {worst + 1} leave {loop[worst]:.3g} V", time)

    def _violated(self, what: str, time: int) -> None:
        raise UnitError(
            self.name, f"ngspice's solution breaks Kirchhoff's laws: {what}", time,
            "check the resistances: ngspice loses accuracy where they differ by more than twelve orders of magnitude",
        )  # fmt: skip


__all__ = ["OPEN_RESISTANCE", "CircuitUnit"]
