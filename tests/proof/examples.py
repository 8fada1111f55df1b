"""Hand-made diagnoses, answers and results for the tests of the scoring."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from diagnosis.judge.diagnosis import Alternative, ChannelFit, Diagnosis, Estimate, Finding, Verdict
from diagnosis.judge.isolability import Isolability
from evaluation.proof.answer import Answer, Concealed, Sabotage
from evaluation.proof.place import Rig
from evaluation.proof.reference import Reference
from evaluation.proof.result import CaseResult
from evaluation.proof.scoring import score

SMALL = Rig((3, 3), True, ("coil[1,1].temperature", "coil[2,3].temperature", "string[1].current", "supply.current"))
BATH = Rig((1,), False, ("coil[1].extension", "coil[1].temperature"))
DURATION = 100.0

RADIATION = Concealed(
    "radiation",
    "thermal",
    True,
    False,
    "weak",
    "string",
    ("string[2]",),
    (),
    {"emissivity_area": 2e-4},
    ("emissivity_area",),
    None,
)
SHORT = Concealed(
    "shorted_coil",
    "electrical",
    True,
    False,
    "strong",
    "coil",
    ("coil[2,3]",),
    (),
    {"bridged": 1.0, "instant": 40.0},
    ("bridged", "instant"),
    40.0,
)


def finding(effect: str = "radiation", unit: str = "thermal", place: str = "string[2]", **changes: Any) -> Finding:
    """A finding; by default that of `RADIATION` with an interval that holds its value."""
    estimates = (Estimate("emissivity_area", "m^2", 2.1e-4, 1.8e-4, 2.4e-4),)
    found = Finding(unit, place, (place,), ((0.0, 100.0),), (), effect, True, "", "", estimates, 50.0, 0.9)
    return replace(found, **changes)


def alternative(effect: str, probability: float) -> Alternative:
    """Another explanation."""
    return Alternative(effect, "string[2]", 40.0, probability)


def diagnosis(*findings: Finding, verdict: Verdict = Verdict.MISSING_PHYSICS, after: float = 1.0) -> Diagnosis:
    """A diagnosis whose two held-out channels have this chi-square, the second of them with twice as many samples."""
    stages = {"before": 9.0, "recalibrated": 3.0, "after": after}
    names = ("coil[1,1].temperature", "coil[2,3].temperature")
    fits = tuple(
        ChannelFit("r", True, n, "K", stages, stages, stages, samples) for n, samples in zip(names, (100, 200))
    )
    return Diagnosis(verdict, "", findings, fits, 12.0, 0.01, 9.0, 3.0, {}, Isolability(), None, 1.0, 10, 0)


def answer(
    *effects: Concealed,
    kind: str = "single",
    verdicts: tuple[str, ...] = ("missing physics",),
    sabotage: Sabotage | None = None,
) -> Answer:
    """A truth on the rig `SMALL`."""
    return Answer("case_0001", kind, "small", "own", verdicts, effects, sabotage)


#: The true term explains 100 in the training recordings; 300 held-out samples.
REFERENCE = Reference(
    "case_0001",
    {"coil[1,1].temperature": 100, "coil[2,3].temperature": 200},
    recalibrated=3.0,
    oracle=1.0,
    floor=0.95,
    training_gain=100.0,
    baselines={"gaussian process": 2.0, "sparse regression": None},
    terms=21.0,
)


def result(given: Diagnosis | None, truth: Answer, outcome: str = "diagnosed", case: str = "case_0001") -> CaseResult:
    """Scored."""
    scored = score(given, truth, SMALL, REFERENCE, DURATION)
    return CaseResult(case, truth.kind, truth.setup, truth.engine, outcome, "", 7.0, scored, REFERENCE)
