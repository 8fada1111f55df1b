"""The model that the search varies, for any scenario: by the coil network where there is one, else by co-simulation."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from cosim.components import CircuitComponent
from cosim.compute.batch import Batches
from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.faults.model import with_faults
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.models.coil_network.runs import check_rig
from diagnosis.models.coil_network.translate import NoCoilNetwork
from diagnosis.models.cosimulation.model import ClosedLoopModel
from diagnosis.models.fabric.model import FabricModel
from diagnosis.models.fabric.runs import fabric_of
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.models.systems.model import SystemModel
from diagnosis.models.timeline import Timeline
from diagnosis.recording.fits import fitting
from diagnosis.recording.recording import Recording
from diagnosis.search.switch_times import Terms, are_needed


def model_of(
    scenario: Scenario,
    recordings: Sequence[Recording],
    catalogue: Sequence[CandidateTerm],
    threads: int = 2,
    without: Sequence[str] = (),
    batches: Batches | None = None,
    timeline: Timeline | None = None,
    like: DiagnosisModel | None = None,
) -> DiagnosisModel:
    """The fastest model that simulates a scenario.

    Args:
        scenario: What the recordings are compared with.
        recordings: Recordings of it.
        catalogue: Candidates of the coil network.
        threads: Simulations at the same time.
        without: Laws of units that the model must not know.
        batches: Makes the runs of the co-simulation, where there are any.
        timeline: Recordings that were fitted, where these are held out; the `timeline` of their model.
        like: Their model.

    Raises:
        InputError: A scenario is wrong, or a recording does not fit it.
    """
    recordings = fitting(scenario, recordings)
    if fabric_of(scenario) is not None:
        return FabricModel(scenario, recordings, catalogue, batches, without, timeline)
    try:
        return CoilNetworkModel(scenario, recordings, catalogue, threads, timeline)
    except NoCoilNetwork:  # also by what one of the recordings overrides
        return ClosedLoopModel(scenario, recordings, without, batches, _closed_loop(like))


def uses_batches(model: DiagnosisModel) -> bool:
    """Whether a model makes runs of the co-simulation, which processes and clusters can share."""
    if isinstance(model, ClosedLoopModel):
        return not isinstance(model.model, SystemModel)
    return isinstance(model, FabricModel)


def _closed_loop(model: DiagnosisModel | None) -> ClosedLoopModel | None:
    return model if isinstance(model, ClosedLoopModel) else None


def models_of(
    scenario: Scenario,
    training: Sequence[Recording],
    held_out: Sequence[Recording],
    catalogue: Sequence[CandidateTerm],
    threads: int = 2,
    without: Sequence[str] = (),
    batches: Batches | None = None,
) -> tuple[DiagnosisModel, DiagnosisModel | None]:
    """Models of recordings that are fitted and of those that judge; both of the same kind.

    Where one recording overrides what a coil network does not have, the co-simulation simulates all of them: parameters
    of one kind of model say nothing to the other.

    Args:
        scenario: What the recordings are compared with.
        training: Recordings that are fitted.
        held_out: Recordings that judge; there may be none.
        catalogue: See `model_of`.
        threads: See `model_of`.
        without: See `model_of`.
        batches: See `model_of`.

    Raises:
        InputError: A scenario is wrong, a recording does not fit it or is of another rig than the others, or a held-out
            one of a fabric has a `beginning`.
    """
    model = model_of(scenario, training, catalogue, threads, without, batches)
    if not held_out:
        return model, None
    judge = model_of(scenario, held_out, catalogue, threads, without, batches, model.timeline, model)
    if not judge.can_be_fitted:
        _without_beginning(held_out)
    if isinstance(model, CoilNetworkModel) and isinstance(judge, CoilNetworkModel):
        check_rig(judge.coils, model.coils, held_out[0])
    if type(judge) is type(model):
        return model, judge
    first = ClosedLoopModel(scenario, fitting(scenario, training), without, batches)
    return first, ClosedLoopModel(scenario, fitting(scenario, held_out), without, batches, first)


def with_switch_times(
    model: DiagnosisModel, judge: DiagnosisModel | None, terms: Terms
) -> tuple[DiagnosisModel, DiagnosisModel | None] | None:
    """Both models with an instant for each change of a recorded input, where readings ask for that beside found laws.

    Before anything is found a law that is missing hides that they do, or such instants take up a bit of it; so does a
    fault of one recording, which is far larger than what the rows leave.

    Args:
        model: Model of the recordings that were fitted.
        judge: Model of those held out.
        terms: Laws and faults that were found, with their values.

    Returns:
        None where they do not ask for it.

    Raises:
        InputError: See `models_of`.
    """
    if not isinstance(model, ClosedLoopModel):
        return None
    moved = model.with_instants()
    if moved is None:
        return None
    lasting = {t: v for t, v in terms.items() if t.recording is None}
    tried = [lasting] if len(lasting) == len(terms) else [lasting, terms]
    plain, free, late = with_faults(model), with_faults(moved), model.late_inputs()
    if not any(are_needed(plain, free, late, own) for own in tried):
        return None
    return moved, judge.after(moved) if isinstance(judge, ClosedLoopModel) else judge


def with_rig_faults(
    model: DiagnosisModel, recordings: Sequence[Recording], standing_out: Collection[str]
) -> DiagnosisModel:
    """The model where something of the rig may have been another for a while in recordings that stand out.

    Args:
        model: Model of the recordings that are fitted.
        recordings: These, in its order.
        standing_out: Titles of recordings that the others do not explain.
    """
    numbers = frozenset(n for n, r in enumerate(recordings) if r.title in standing_out)
    return model.with_rig_faults(numbers) if numbers and isinstance(model, ClosedLoopModel) else model


def _without_beginning(recordings: Sequence[Recording]) -> None:
    """Refuse what only a model that can be fitted to held-out recordings gives."""
    for recording in recordings:
        if recording.beginning > 0.0:
            raise InputError(
                recording.path / "recording.yaml",
                "beginning",
                "of a fabric nothing is estimated from a first stretch: a simulation takes too long",
                "leave it out, and give the start in `overrides`",
            )


def strings_of(scenario: Scenario) -> tuple[int, ...]:
    """Coils of every string of the scenario's circuit; empty where it has none."""
    circuits = [c for c in scenario.components.values() if isinstance(c, CircuitComponent)]
    return tuple(circuits[0].strings) if circuits else ()
