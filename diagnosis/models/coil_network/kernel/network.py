"""The coil network: parameter sets in, sampled quantities out."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache

import numpy as np

from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.models.coil_network.kernel.compiler import load
from diagnosis.models.coil_network.kernel.inputs import CoilNetworkInputs
from diagnosis.models.coil_network.kernel.layout import QUANTITIES, Array, CoilNetworkLayout
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters, Packing, active_terms, pack, pack_all
from diagnosis.models.coil_network.kernel.plan import Plan
from diagnosis.models.coil_network.kernel.source import generate


@cache
def _pool(process: int, threads: int) -> ThreadPoolExecutor:
    """Threads that wait for parts of batches; a forked process has none of its parent's."""
    return ThreadPoolExecutor(threads, thread_name_prefix=f"network-{process}")


class CoilNetworkError(ArithmeticError):
    """A simulation did not stay finite, or there was no memory for it.

    Args:
        what: The failure in a sentence.
        parameter_set: Number of the set in its batch, from 0.
        time: Simulated time [s], or None.
    """

    def __init__(self, what: str, parameter_set: int = 0, time: float | None = None) -> None:
        super().__init__(what)
        self.parameter_set, self.time = parameter_set, time


class CoilNetwork:
    """Coils (or lumped heaters) with circuit, heat, stiffness and load, and every candidate term compiled in.

    Equations: `circuit.kirchhoff`, fmus/thermal_stiffness, `mechanics.hanging_mass`; terms: docs/candidates.md. It
    holds no state between calls and may be used by several threads at once.

    Args:
        layout: Coils and strings.
        terms: Candidates to compile in; compiled once, then taken from the cache.
        is_midpoint: Take what depends on the temperature at the middle of a step (second order in the step). False
            takes it at the begin, as the co-simulation does: then equal steps give equal results.

    Raises:
        CompilerError: There is no usable C compiler.
        ValueError: Two candidates have one identifier.
    """

    def __init__(
        self, layout: CoilNetworkLayout, terms: Sequence[CandidateTerm] = (), is_midpoint: bool = True
    ) -> None:
        self.layout, self.terms, self.is_midpoint = layout, tuple(terms), is_midpoint
        if len({t.identifier for t in terms}) != len(terms):
            raise ValueError("two candidates have the same identifier")
        self._packings: dict[frozenset[str], Packing] = {}
        self._library = load(generate(self.terms))
        self._library.network_simulate.restype = ctypes.c_int

    def wanted(self, inputs: CoilNetworkInputs, times: Array | Mapping[str, Array]) -> dict[str, Array]:
        """Sample times by quantity; one array: all that this network has under these inputs, without derived ones."""
        if isinstance(times, Mapping):
            return dict(times)
        has_circuit = inputs.power is None
        own = {n: q for n, q in QUANTITIES.items() if self.layout.elements(n) and n != "string_share"}
        return {n: times for n, q in own.items() if not q.is_derived and (has_circuit or not q.needs_circuit)}

    def simulate(
        self, parameters: CoilNetworkParameters, inputs: CoilNetworkInputs, times: Array | Mapping[str, Array]
    ) -> dict[str, Array]:
        """One simulation.

        Args:
            parameters: Values, SI.
            inputs: Grid of steps and what drives them.
            times: Sample times [s] of each quantity wanted, or one array for all quantities that this network has but
                derived ones.
                Values between the ends of steps are interpolated linearly. Electrical flows never across a switch.

        Returns:
            `temperature` [K], `extension` [m], `length` [m], `stiffness` [N/m], `resistance` [ohm], `power` [W] with
            shape (samples, coils); `current` [A], (samples, strings); `supply_current` [A], (samples, 1): of all
            sources. Derived: `voltage` [V] and `tension` [N] of the coils; `string_voltage` [V] across the coils of a
            string and `terminal_voltage` [V] of its source, (samples, strings); `supply_power` [W], (samples, 1).

        Raises:
            CoilNetworkError: A value stopped being finite.
            KeyError: An unknown parameter or candidate.
            ValueError: Wrong shapes, sample times outside the grid.
        """
        plan = self.plan(inputs, times)
        packing = self.packing(active_terms(self.terms, parameters))
        vectors = pack(packing, self.terms, parameters)[None]
        return {n: v[0] for n, v in plan.split(self.run(plan, packing, vectors)).items()}

    def simulate_batch(
        self,
        parameters: Sequence[CoilNetworkParameters],
        inputs: CoilNetworkInputs,
        times: Array | Mapping[str, Array],
        threads: int = 1,
    ) -> dict[str, Array]:
        """Many simulations over the same inputs; see `simulate`.

        Args:
            parameters: One for each set.
            inputs: Grid of steps and what drives them.
            times: As for `simulate`.
            threads: Threads that share the sets (the C function runs without Python's lock).

        Returns:
            As `simulate`, with the set as first dimension.
        """
        plan, out = self.simulate_flat(parameters, inputs, times, threads)
        return plan.split(out)

    def simulate_flat(
        self,
        parameters: Sequence[CoilNetworkParameters],
        inputs: CoilNetworkInputs,
        times: Array | Mapping[str, Array],
        threads: int = 1,
        plan: Plan | None = None,
    ) -> tuple[Plan, Array]:
        """As `simulate_batch`, but the outputs as they are laid out, shape (sets, plan.out_size).

        `plan`: what `plan` made of the same inputs and times, where it is at hand.
        """
        plan = self.plan(inputs, times) if plan is None else plan
        active: frozenset[str] = frozenset().union(*(active_terms(self.terms, p) for p in parameters))
        packing = self.packing(active)
        vectors = pack_all(packing, self.terms, parameters)
        return plan, self.run(plan, packing, vectors, threads)

    def plan(self, inputs: CoilNetworkInputs, times: Array | Mapping[str, Array]) -> Plan:
        """Inputs and samples ready for `run`."""
        return Plan(self.layout, inputs, self.wanted(inputs, times), self.is_midpoint)

    def packing(self, active: frozenset[str]) -> Packing:
        """Places of the parameters where the candidates `active` are switched on."""
        if active not in self._packings:  # they do not change, and few sets of candidates are on together
            self._packings[active] = Packing(self.layout, self.terms, active)
        return self._packings[active]

    def run(self, plan: Plan, packing: Packing, vectors: Array, threads: int = 1) -> Array:
        """Simulate packed sets: shape (sets, packing.size) to (sets, plan.out_size); `plan.split` names the outputs.

        Raises:
            CoilNetworkError: A value stopped being finite in one of them.
            ValueError: Plan or packing are those of other coils, or the vectors are those of another packing.
        """
        vectors = np.ascontiguousarray(vectors, dtype=np.float64)
        # The C function trusts all of these: what is too short would be read beyond its end.
        for what, own in (("plan", plan.layout), ("packing", packing.layout)):
            if own != self.layout:
                raise ValueError(f"the {what} is one of {own}, and the network one of {self.layout}")
        if vectors.shape[1:] != (packing.size,):
            raise ValueError(f"the vectors have the shape {vectors.shape}; this packing needs (sets, {packing.size})")
        out = np.empty((len(vectors), plan.out_size))
        plan_structure = type(plan.structure).from_buffer_copy(plan.structure)
        plan_structure.term_offset = packing.term_offset.ctypes.data
        bounds = np.linspace(0, len(vectors), max(1, min(threads, len(vectors))) + 1).astype(int)

        def part(n: int) -> None:
            self._call(
                plan, plan_structure, vectors[bounds[n] : bounds[n + 1]], out[bounds[n] : bounds[n + 1]], int(bounds[n])
            )

        if len(bounds) == 2:
            part(0)
        else:
            list(_pool(os.getpid(), threads).map(part, range(len(bounds) - 1)))
        return out

    def _call(self, plan: Plan, structure: ctypes.Structure, vectors: Array, out: Array, first: int) -> None:
        failure = np.zeros(2, dtype=np.int64)
        pointer = ctypes.c_void_p
        result = self._library.network_simulate(
            ctypes.byref(structure),
            ctypes.c_int64(len(vectors)),
            pointer(vectors.ctypes.data),
            ctypes.c_int64(vectors.shape[1]),
            pointer(out.ctypes.data),
            ctypes.c_int64(out.shape[1]),
            pointer(failure.ctypes.data),
        )
        if result == 2:
            raise CoilNetworkError("there is no memory for the traces of the coil network; use a longer step")
        if result:
            number, time = first + int(failure[0]), float(plan.time_after(int(failure[1])))
            raise CoilNetworkError(
                f"the coil network stopped being finite at t = {time:g} s (set {number})", number, time
            )
