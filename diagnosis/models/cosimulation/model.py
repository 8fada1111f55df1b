"""Any scenario with its recordings, simulated by the closed co-simulation, with the laws that its units may lack."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

import numpy as np

from cosim.compute.batch import Batches
from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from cosim.unit.protocol import AnyArray, Array
from diagnosis.amend.closed_loop import amend_closed_loop
from diagnosis.models.coil_network.kernel.compiler import CompilerError
from diagnosis.models.coil_network.runs import deviation
from diagnosis.models.cosimulation.unit_laws import laws_of
from diagnosis.models.pendulum.model import TORQUE, PendulumModel, is_single_pendulum, without_scale
from diagnosis.models.protocol import ComparedRun, ComparedSeries, Labelled, ModelBase, compared_run
from diagnosis.models.systems.changed_run import Changed, changes_of
from diagnosis.models.systems.fmu_layout import NotFast
from diagnosis.models.systems.model import SystemLaws, SystemModel, laws_at
from diagnosis.models.systems.places import Fit
from diagnosis.models.systems.run import is_system
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import Recording
from diagnosis.search.cosim_model import ComponentTerm, CosimModel, can_be_added
from diagnosis.search.cosim_run import changed
from diagnosis.search.free_numbers import Free, Numbers, free_parameters
from diagnosis.search.pendulum_terms import arm_of, pendulum_laws, sensor_laws
from diagnosis.search.problem import Layout, Parameter, Point, Term
from diagnosis.search.switch_times import are_needed, switch_times
from diagnosis.search.unit_law import UnitLaw


class ClosedLoopModel(ModelBase):
    """See `diagnosis.models.protocol.DiagnosisModel`.

    Args:
        scenario: What the recordings are compared with.
        recordings: Recordings of it.
        without: Laws that it must not know.
        batches: Makes the runs; None: one after the other in this process.
        like: Model of other recordings of the same scenario, whose laws and bounds it has too.
        instants: Whether each change of a recorded input has an instant of its own; None: as `like`, or as the
            recordings ask.
        changes: What of the rig may have been another for a while in recordings, by their numbers.

    Raises:
        InputError: A scenario is wrong, or a recording does not fit it.
    """

    def __init__(
        self,
        scenario: Scenario,
        recordings: Sequence[Recording],
        without: Sequence[str] = (),
        batches: Batches | None = None,
        like: ClosedLoopModel | None = None,
        instants: bool | None = None,
        changes: Mapping[int, Sequence[Changed]] = MappingProxyType({}),
    ) -> None:
        self._given = scenario, recordings, without, batches
        self._changes = changes
        recordings = [_with_rounding(r) for r in recordings]
        laws, kind = laws_of(scenario), CosimModel
        #: Why compiled code does not simulate a system of FMUs; empty where it does, or where it is none.
        self.slow = ""
        #: Whether each change of a recorded input has an instant of its own.
        self.has_instants = False
        #: What may be missing in a system of FMUs.
        self.system_laws: SystemLaws | None = None
        if instants is None and like is not None:
            instants = like.has_instants
        known = None if like is None else like.system_laws
        other = None if like is None else like.model
        self._like = other if isinstance(other, SystemModel) else None
        if is_system(scenario) and self._take_system(scenario, recordings, without, batches, known, instants):
            return
        if is_single_pendulum(scenario, recordings):
            (component,) = scenario.components
            channels = dict.fromkeys(name for r in recordings for name in r.channels)
            laws = [*pendulum_laws(component, without, arm_of(scenario, component)), *sensor_laws(component, channels)]
            kind = PendulumModel
        numbers = Numbers(scenario)
        laws = [law for law in laws if can_be_added(numbers, law.place)]
        self._laws = {law.place.term: law for law in laws if law.place.term.identifier not in without}
        free, self._torque_scale = free_parameters(scenario, recordings), 0.0
        if kind is PendulumModel:
            free, self._torque_scale = without_scale(scenario_of(scenario, recordings[0]), free)
        self._begin(kind(scenario, recordings, free, [law.place for law in self._laws.values()], batches), recordings)

    def _take_system(
        self,
        scenario: Scenario,
        recordings: Sequence[Recording],
        without: Sequence[str],
        batches: Batches | None,
        known: SystemLaws | None,
        has_instants: bool | None,
    ) -> bool:
        """Whether compiled code simulates the system of FMUs; if not, `slow` says why."""
        try:
            free = free_parameters(scenario, recordings)
            laws = known or laws_at(scenario, recordings, free, without)
            plain = [*laws.usual, *free]
            changes: Sequence[Free] = ()
            if has_instants is not False:
                changes = switch_times([scenario_of(scenario, r) for r in recordings], recordings)
            numbers = [*plain, *changes]
            model = SystemModel(scenario, recordings, numbers, laws.found, batches, self._like, self._changes)
            if changes and has_instants is None:
                without_them = SystemModel(scenario, recordings, plain, laws.found, batches, self._like, self._changes)
                if not are_needed(without_them, model, model.late_inputs()):
                    model, changes = without_them, ()
            self.has_instants = bool(changes)
        except (NotFast, CompilerError) as reason:
            self.slow = str(reason)
            return False
        self._torque_scale, self.system_laws = 0.0, laws
        self._laws = {fit.term: _unit_law(fit) for fit in laws.found}
        self._laws |= {law.place.term: law for law in laws.sensors}
        self._begin(model, recordings)
        return True

    def with_instants(self) -> ClosedLoopModel | None:
        """The same with an instant of its own for each change of a recorded input; None where there is no more."""
        if self.has_instants or not isinstance(self.model, SystemModel):
            return None
        found = ClosedLoopModel(*self._given, like=self, instants=True, changes=self._changes)
        return found if found.has_instants else None

    def with_rig_faults(self, numbers: Collection[int]) -> ClosedLoopModel:
        """The same where something of the rig may have been another for a while in some recordings, by their numbers.

        What hundreds of simulations would take minutes of is not asked.
        """
        if not isinstance(self.model, SystemModel) or not self.model.can_try_intervals:
            return self
        try:
            changes = {n: changes_of(self.model.scenarios[n]) for n in sorted(numbers)}
        except (InputError, NotFast, CompilerError):
            return self
        return ClosedLoopModel(*self._given, like=self, changes=changes) if any(changes.values()) else self

    def late_inputs(self) -> list[Term]:
        """Laws that an input is late by, and nothing else."""
        return self.model.late_inputs() if isinstance(self.model, SystemModel) else []

    def after(self, other: ClosedLoopModel) -> ClosedLoopModel:
        """The model of the same recordings with laws and kinds of numbers as the model of others has them."""
        return ClosedLoopModel(*self._given, like=other)

    def _begin(self, model: CosimModel, recordings: Sequence[Recording]) -> None:
        self.model = model
        self.runs = [_compared(r) for r in recordings]
        self.parameters: Sequence[Parameter] = self.model.parameters
        self.layout: Layout = self.model.layout

    @property
    def untried(self) -> tuple[str, ...]:
        """Where no law can be tried, and why."""
        if self.slow:
            return (f"laws of FMUs need compiled code, which does not simulate this system: {self.slow}",)
        return () if self.system_laws is None else self.system_laws.untried

    @property
    def hidden(self) -> tuple[str, ...]:
        """Components that hide their states."""
        return () if self.system_laws is None else self.system_laws.hidden

    @property
    def can_be_searched_again(self) -> bool:
        """See `CosimModel`."""
        return self.model.can_be_searched_again

    @property
    def can_be_refitted(self) -> bool:
        """See `CosimModel`."""
        return self.model.can_be_refitted

    def refine(self, point: Point) -> bool:
        """See `diagnosis.search.problem.refined`."""
        return self.model.refine(point)

    def solving_error(self, point: Point) -> Array | None:
        """See `diagnosis.models.protocol.DiagnosisModel`."""
        return self.model.solving_error(point)

    def row_shifts(self, point: Point) -> Array:
        """See `diagnosis.models.protocol.DiagnosisModel`."""
        return self.model.row_shifts(point)

    @property
    def has_ridges(self) -> bool:
        """See `diagnosis.search.problem.has_ridges`."""
        return self.model.has_ridges

    @property
    def simulations(self) -> int:
        """How many were made so far."""
        return self.model.runs

    def residuals(self, points: Sequence[Point]) -> Array:
        """See `diagnosis.search.problem.Model`."""
        return self.model.residuals(points)

    def base_jacobian(self, point: Point) -> Array:
        """See `diagnosis.search.problem.Model`."""
        return self.model.base_jacobian(point)

    def terms(self) -> list[Term]:
        """Every law that may be missing."""
        return list(self._laws)

    def input_terms(self) -> list[Term]:
        """Every output of a programme of every recording, as it may have been another within an interval.

        And, in recordings that stand out, whatever of the rig may have been another.
        """
        rig = self.model.rig if isinstance(self.model, SystemModel) else ()
        return [*self.model.inputs, *rig]

    def where(self, term: Term) -> tuple[UnitLaw, Labelled]:
        """Law and component of a term."""
        law = self._laws[term]
        return law, Labelled(law.place.component)

    def shows_in(self, term: Term) -> None:
        """A law of a unit is not local to a channel."""
        return

    def scale_uncertainty(self, term: Term) -> tuple[float, ...]:
        """See `diagnosis.models.protocol.DiagnosisModel`."""
        return tuple(self._torque_scale if p.unit.startswith(TORQUE) else 0.0 for p in term.parameters)

    def groups(self) -> Mapping[str, AnyArray]:
        """No channels are looked at together."""
        return {}

    def judged_by(self, point: Point) -> str:
        """What simulated recordings that judge, for people."""
        return self.model.judged_by(point)

    def restated(self, scenario: Scenario, point: Point) -> Scenario:
        """See `DiagnosisModel`."""
        return changed(scenario, self.model.changes_at(point.lasting, None))

    def amend(self, scenario: Scenario, point: Point, folder: Path) -> Path:
        """See `diagnosis.amend.closed_loop.amend_closed_loop`."""
        return amend_closed_loop(scenario, self.restated(scenario, point), point.terms, folder)

    def predict(self, point: Point, run: int) -> list[Array]:
        """Simulated values of every channel of a recording at its samples, SI."""
        found = self.model.predict(point, run)
        if found is None:
            return [np.full(len(s.samples), np.inf) for s in self.runs[run].series]
        return list(found)


def _unit_law(fit: Fit) -> UnitLaw:
    """What a law at a place says about itself."""
    place = ComponentTerm(fit.term, fit.term.place, ())
    more = ", ".join([*([fit.beside] if fit.beside else []), *([f"read by {fit.seen_by}"] if fit.seen_by else [])])
    name = f"{fit.law.name} ({more})" if more else fit.law.name
    return UnitLaw(place, name, fit.law.source, fit.law.confused_with)


def _compared(recording: Recording) -> ComparedRun:
    channels = recording.channels.values()
    return compared_run(ComparedSeries(c, np.arange(len(c.times)), ~c.is_clipped) for c in channels)


def _with_rounding(recording: Recording) -> Recording:
    """Rounding is noise too, where the noise that is given is that of the sensor alone; it is counted once."""
    channels = {
        name: replace(c, deviation=deviation(c), quantum=0.0) if c.is_deviation_given else c
        for name, c in recording.channels.items()
    }
    return replace(recording, channels=channels)
