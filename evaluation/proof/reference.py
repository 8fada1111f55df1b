"""What the data of a case allow, for scoring: nothing of it reaches the diagnosis."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Reference:
    """Held-out chi-square per sample of models that know more or less than the diagnosis, on the same data.

    Args:
        case: Name of the case.
        samples: Held-out samples that judge, by channel.
        recalibrated: Of the recalibrated model without any term.
        oracle: Of the model that knows the effects: recalibrated with the true terms at the true places; None where
            the catalogue has no such terms.
        twin: Of the recalibrated model of the twin: the same rig without the effect, its recordings read with the same
            noise. Near what a model that knew the effect exactly would reach, but no bound. None where the ground wrote
            no twin.
        floor: Of the readings without their noise: nothing can do better but by chance.
        noises: Held-out channel to the root mean square of its readings about the truth and the deviation of its noise
            with its rounding [unit]; empty: of proofs made before.
        training_gain: Fall of -2 log posterior by the true terms in the training recordings, or None.
        baselines: Of other methods, by name; None where a forecast runs away.
        terms: Terms that sparse regression reports per channel, on average.
        seconds: Wall time by part.
        failure: Why there is none of it.
    """

    case: str
    samples: Mapping[str, int] = field(default_factory=dict)
    recalibrated: float | None = None
    oracle: float | None = None
    twin: float | None = None
    floor: float | None = None
    noises: Mapping[str, Sequence[float]] = field(default_factory=dict)
    training_gain: float | None = None
    baselines: Mapping[str, float | None] = field(default_factory=dict)
    terms: float | None = None
    seconds: Mapping[str, float] = field(default_factory=dict)
    failure: str = ""
