"""How far a channel is moved by what rows of a table do not say: when within a row its inputs changed."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np

from cosim.run import RunStopped
from cosim.scenario import Scenario
from diagnosis.judge.diagnosis import Adequacy
from diagnosis.models.systems.run import is_system, run_quickly
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import Channel, Recording
from diagnosis.search.cosim_run import predicted
from diagnosis.search.problem import Parameter
from diagnosis.search.switch_times import earlier, is_held

#: Simulations with every change somewhere within the row before it, and the seed of their instants.
DRAWS, SEED = 4, 33


def with_instants(parameters: Sequence[Parameter], titles: Sequence[str]) -> frozenset[str]:
    """Titles of the recordings in which a model estimates when inputs changed; one with many changes has none.

    Args:
        parameters: Of the model.
        titles: Of its recordings.
    """
    return frozenset(titles[p.own.recording] for p in parameters if p.is_within_row and p.own is not None)


def with_input_rows(
    adequacy: Adequacy, scenario: Scenario, recordings: Sequence[Recording], estimated: Collection[str] = ()
) -> Adequacy:
    """The same with how far the worst channel is moved by instants of inputs that its recording does not say.

    Args:
        adequacy: How right the model is.
        scenario: As the recordings are compared with.
        recordings: Among them the one with the worst channel.
        estimated: Titles of recordings in which these instants are estimated.
    """
    worst = adequacy.worst
    own = next((r for r in recordings if worst is not None and r.title == worst.recording), None)
    if worst is None or own is None or not adequacy.is_rejected or worst.channel not in own.channels:
        return adequacy
    if own.title in estimated:
        return adequacy
    return replace(adequacy, worst=replace(worst, by_rows=moved_by_rows(scenario, own, own.channels[worst.channel])))


def moved_by_rows(scenario: Scenario, recording: Recording, channel: Channel) -> float:
    """Root mean square change of a channel [SI] where every change of an input came anywhere within the row before it.

    By the scenario as it is, in proportion to the readings.

    Returns:
        0 where no recorded input holds its values, or where compiled code does not simulate the scenario.
    """
    conditions = scenario_of(scenario, recording)
    if not is_system(conditions):
        return 0.0
    changes = [is_held(conditions, i) and bool(np.any(np.diff(i.values))) for i in recording.inputs]
    if not any(changes):
        return 0.0
    rng, source = np.random.default_rng(SEED), recording.path / "recording.yaml"
    try:
        usual = predicted(run_quickly(conditions), channel.target, channel.times, source)
        squares = []
        for _ in range(DRAWS):
            inputs = tuple(
                earlier(i, rng.uniform(0.0, 1.0, len(i.times) - 1)) if c else i
                for i, c in zip(recording.inputs, changes)
            )
            results = run_quickly(scenario_of(scenario, replace(recording, inputs=inputs)))
            squares.append(np.mean((predicted(results, channel.target, channel.times, source) - usual) ** 2))
    except RunStopped:
        return 0.0
    # what the fitted model answers is as large as the readings, whatever the scenario as it is answers
    size = float(np.std(usual))
    return float(np.sqrt(np.mean(squares))) * (float(np.std(channel.values)) / size if size > 0.0 else 0.0)
