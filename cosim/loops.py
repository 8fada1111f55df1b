"""Direct feedthrough between units: in which order outputs follow inputs, and which of them form algebraic loops.

An output that depends on an input at the same instant is only right once that input is; a chain of such dependences is
followed in order, a ring of them is an algebraic loop, a set of equations that is solved.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np

from cosim.connection import Transfer
from cosim.ordering import in_order
from cosim.unit.protocol import AnyArray, Array, Unit, UnitError

#: Largest difference of a loop's inputs, relative to 1 + their size, at which the loop counts as closed.
TOLERANCE = 1e-10
#: Repetitions of setting the inputs to what follows from them; enough where the ring is none element by element.
REPETITIONS = 3
#: Rounds in which discrete values of a ring must settle; each passes a value on by one connection at least.
ROUNDS = 100
#: Up to this many unknowns a Jacobian is made by differences; beyond, Anderson mixing needs none.
MOST_UNKNOWNS_WITH_JACOBIAN = 64

Action = Callable[[], None]
Feedthrough = Callable[[Unit], Mapping[str, frozenset[str]]]


class AlgebraicLoop:
    """Inputs that depend on each other at one instant: u = g(u).

    Where one of them is no floating-point number (a message of a bus, a switch), there is no equation to be solved:
    values are passed round until none changes, as discrete states settle inside an FMU.

    Args:
        transfers: The inputs of the loop.
        units: The units that have them.
    """

    def __init__(self, transfers: Sequence[Transfer], units: Sequence[Unit]) -> None:
        self.transfers, self.units = list(transfers), list(units)
        self.size = sum(t.variable.size for t in transfers)
        self.is_discrete = any(not t.variable.type.is_float for t in transfers)

    def __str__(self) -> str:
        what = "ring of discrete values " if self.is_discrete else "algebraic loop "
        return what + ", ".join(str(p.connection) for t in self.transfers for p in t.parts)

    def _inputs(self) -> Array:
        return np.concatenate([np.ravel(t.buffer) for t in self.transfers]).astype(np.float64)

    def _apply(self, unknowns: Array) -> None:
        begin = 0
        for transfer in self.transfers:
            end = begin + transfer.variable.size
            transfer.buffer[...] = unknowns[begin:end].reshape(transfer.variable.shape)
            transfer.write()
            begin = end
        for unit in self.units:
            unit.refresh()

    def _follow(self, unknowns: Array) -> Array:
        """g(u): the inputs that follow from the outputs that follow from the inputs u."""
        self._apply(unknowns)
        for transfer in self.transfers:
            for part in transfer.parts:
                part.copy()
        return self._inputs()

    def solve(self) -> None:
        """Find inputs that agree with the outputs they cause.

        Raises:
            UnitError: There are none, or they were not found.
        """
        if self.is_discrete:
            self._settle()
            return
        for transfer in self.transfers:
            for part in transfer.parts:
                part.copy()
        unknowns = self._inputs()
        for _ in range(REPETITIONS):
            following = self._follow(unknowns)
            if _agree(following, unknowns):
                return
            unknowns = following
        unknowns = self._root(unknowns)
        following = self._follow(unknowns)
        if not _agree(following, unknowns):
            worst = float(np.max(np.abs(following - unknowns)))
            raise self._unsolved(f"inputs and outputs differ by {worst:g}")

    def _settle(self) -> None:
        """Pass values round until none changes."""
        for _ in range(ROUNDS):
            before = [t.buffer.copy() for t in self.transfers]
            for transfer in self.transfers:
                for part in transfer.parts:
                    part.copy()
            for transfer in self.transfers:
                transfer.write()
            for unit in self.units:
                unit.refresh()
            if all(_are_same(t.buffer, old) for t, old in zip(self.transfers, before)) and self._is_closed():
                return
        raise UnitError(
            self.units[0].name,
            f"{self}: its values do not settle in {ROUNDS} rounds",
            remedy="break the ring with an output that depends on no input",
        )

    def _is_closed(self) -> bool:
        """Whether the outputs that follow from the inputs give the same inputs again."""
        before = [t.buffer.copy() for t in self.transfers]
        for transfer in self.transfers:
            for part in transfer.parts:
                part.copy()
        return all(_are_same(t.buffer, old) for t, old in zip(self.transfers, before))

    def _root(self, unknowns: Array) -> Array:
        from scipy.optimize import anderson, root  # late: it takes a third of a second, and loops are rare

        def residual(u: Array) -> Array:
            return self._follow(np.asarray(u, dtype=np.float64)) - u

        if self.size <= MOST_UNKNOWNS_WITH_JACOBIAN:
            return np.asarray(root(residual, unknowns, method="hybr", options={"xtol": 1e-14}).x, dtype=np.float64)
        try:
            return np.asarray(anderson(residual, unknowns, f_tol=1e-12), dtype=np.float64)  # type: ignore[arg-type]
        except Exception as error:  # scipy raises NoConvergence, and others for overflow
            raise self._unsolved(str(error)) from error

    def _unsolved(self, why: str) -> UnitError:
        what = f"{self}: no solution was found ({why})"
        return UnitError(self.units[0].name, what, remedy="give start values near a solution, or break the loop")


def _are_same(one: AnyArray, other: AnyArray) -> bool:
    if one.dtype.kind == "f":
        return bool(np.all(np.abs(one - other) <= TOLERANCE * (1.0 + np.abs(other))))
    return bool(np.all(one == other))


def _agree(one: Array, other: Array) -> bool:
    return bool(np.all(np.abs(one - other) <= TOLERANCE * (1.0 + np.abs(other))))


class Propagation:
    """Sets inputs and lets outputs follow, in an order in which every output is right when it is read.

    Args:
        units: Name to unit.
        transfers: Name of a unit to the transfers into it.
        feedthrough: Which dependences count: `Unit.feedthrough` or `Unit.initial_feedthrough`.
        is_complete: Carry out every transfer, not only those into inputs with direct feedthrough.
    """

    def __init__(
        self,
        units: Mapping[str, Unit],
        transfers: Mapping[str, Sequence[Transfer]],
        feedthrough: Feedthrough,
        is_complete: bool,
    ) -> None:
        through = {n: feedthrough(u) for n, u in units.items()}
        direct = {(n, i) for n, depends in through.items() for inputs in depends.values() for i in inputs}
        # A tick must arrive once, while this is carried out again and again: algorithms hand it over before a step.
        self._nodes = [
            t for into in transfers.values() for t in into if not t.is_clock and (is_complete or t.end in direct)
        ]
        self._direct = direct
        self.loops: list[AlgebraicLoop] = []
        #: What `carry_out` does, in order: methods of transfers, of algebraic loops, and of units.
        self.actions: list[Action] = list(self._plan(units, self._edges(through)))

    def carry_out(self) -> None:
        """Set the inputs and let the outputs follow; raises UnitError where a loop has no solution."""
        for action in self.actions:
            action()

    @property
    def settled(self) -> list[Transfer]:
        """Transfers that would bring nothing if they were carried out again: what they read has not changed since."""
        found: dict[int, Transfer] = {}
        readers: dict[int, list[int]] = {}  # a unit to the transfers that read it
        for action in self.actions:
            owner = getattr(action, "__self__", None)
            if isinstance(owner, Transfer):
                found[id(owner)] = owner
                for part in owner.parts:
                    readers.setdefault(id(part.source), []).append(id(owner))
                continue
            for unit in owner.units if isinstance(owner, AlgebraicLoop) else [owner]:
                for reader in readers.pop(id(unit), ()):
                    found.pop(reader, None)
        return list(found.values())

    def _edges(self, through: Mapping[str, Mapping[str, frozenset[str]]]) -> list[tuple[int, int]]:
        """(before, after): input `after` is fed by an output that depends directly on input `before`."""
        index = {t.end: i for i, t in enumerate(self._nodes)}
        edges = []
        for after, transfer in enumerate(self._nodes):
            for unit, output in {p.connection.source for p in transfer.parts}:
                for name in through[unit].get(output, ()):
                    if (unit, name) in index:
                        edges.append((index[unit, name], after))
        return edges

    def _plan(self, units: Mapping[str, Unit], edges: Sequence[tuple[int, int]]) -> Iterator[Action]:
        stale: dict[str, Unit] = {}
        for group in in_order(len(self._nodes), edges):
            members = [self._nodes[i] for i in group]
            for name in dict.fromkeys(p.connection.source[0] for t in members for p in t.parts):
                if name in stale and not _is_inside(name, members):
                    yield stale.pop(name).refresh
            if len(group) > 1 or (group[0], group[0]) in edges:
                loop = AlgebraicLoop(members, list({t.target.name: t.target for t in members}.values()))
                self.loops.append(loop)
                yield loop.solve
                continue
            yield members[0].carry_out
            if members[0].end in self._direct:
                stale[members[0].target.name] = members[0].target
        for unit in stale.values():
            yield unit.refresh


def _is_inside(unit: str, members: Sequence[Transfer]) -> bool:
    return len(members) > 1 and any(t.target.name == unit for t in members)
