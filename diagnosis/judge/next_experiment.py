"""The experiment that would decide between explanations that the recordings leave open."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Rival:
    """An explanation that the experiment is to decide about.

    Args:
        effects: Its terms, `radiation at all coils`; `the model as it is` where it has none.
        probability: Before the experiment, among the rivals.
    """

    effects: tuple[str, ...]
    probability: float


@dataclass(frozen=True)
class Course:
    """One input of the experiment over time.

    Args:
        component: Component of the scenario that is driven.
        output: Its output.
        unit: Unit of the output.
        times: Corners [s], rising.
        values: For each corner the values of all elements of the output (one where it has no elements).
        is_linear: Whether it is linear between the corners; else each value holds to the next corner.
    """

    component: str
    output: str
    unit: str
    times: tuple[float, ...]
    values: tuple[tuple[float, ...], ...]
    is_linear: bool = False


@dataclass(frozen=True)
class NextExperiment:
    """An experiment within the limits of the scenario, ready to run.

    Args:
        scenario: Path of the scenario file, or None where it was not written.
        kind: Family of the programme: `staircase`, `pulses`, `long soak`.
        statement: What to do and what it decides, in plain words.
        rivals: Explanations that it separates, the most probable first.
        courses: What is driven, and how.
        duration: Of the experiment [s].
        limits: What it keeps: `voltage up to 24 V`.
        log_bayes_factor: Expected |ln| of the Bayes factor between the first two rivals after it (from predicted
            differences, with what a recalibration would do as well taken away).
        repeat_log_bayes_factor: The same for a mere repeat of the recordings.
        decides: Predicted probability that it decides with odds of at least 20 to 1 for the true rival.
        repeat_decides: The same for a mere repeat.
        channel: Channel in which the rivals differ most.
        best_time: When they differ most [s].
        tried: Programmes that were simulated.
        mass: Of the load that hangs from each coil [kg]; 0: as in the scenario.
    """

    scenario: str | None
    kind: str
    statement: str
    rivals: tuple[Rival, ...]
    courses: tuple[Course, ...]
    duration: float
    limits: tuple[str, ...]
    log_bayes_factor: float
    repeat_log_bayes_factor: float
    decides: float
    repeat_decides: float
    channel: str = ""
    best_time: float = 0.0
    tried: int = 0
    mass: float = 0.0
