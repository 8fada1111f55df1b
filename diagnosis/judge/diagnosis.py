"""What a diagnosis says; `diagnosis.json` is this, key by key."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum

from diagnosis.judge.isolability import Isolability
from diagnosis.judge.location import Location, Proposal, Remainder, Waveform
from diagnosis.judge.next_experiment import NextExperiment

#: A parameter that moved by more prior deviations than this is reported.
MOVED = 2.0
#: Prior deviations from which a fitted parameter is no measurement: its prior holds it, or another law is missing.
FAR = 3.0


class Verdict(Enum):
    """What the recordings say about the model."""

    CONSISTENT = "consistent"
    RECALIBRATED = "recalibrated"
    RECORDING_FAULT = "recording fault"
    MEASUREMENT_FAULT = "measurement fault"
    MISSING_PHYSICS = "missing physics"
    UNNAMED_PHYSICS = "unnamed physics"
    CANNOT_TELL = "cannot tell"


class Standing(Enum):
    """How far a finding may be called by a name."""

    NAMED = "named"
    CLASS = "class"
    UNNAMED = "unnamed"


@dataclass(frozen=True)
class Physical:
    """A physical quantity with its 95 % interval.

    Args:
        unit: SI unit.
        value: Estimate.
        lower: Lower end.
        upper: Upper end.
    """

    unit: str
    value: float
    lower: float
    upper: float


@dataclass(frozen=True)
class Estimate:
    """A parameter of a finding.

    Args:
        name: Symbol in the law.
        unit: SI unit.
        value: Estimate.
        lower: Lower end of the 95 % interval.
        upper: Upper end.
        meaning: What it is, in words: a share, a factor or a change of what, or which physical quantity.
        physical: The quantity that it stands for, where that is another: the bias of a sensor is counted in what its
            channel typically reads. None: it is that quantity itself.
        is_reading: Whether it is a reading and no change: 300 K are 27 degC then.
    """

    name: str
    unit: str
    value: float
    lower: float
    upper: float
    meaning: str = ""
    physical: Physical | None = None
    is_reading: bool = False


@dataclass(frozen=True)
class Alternative:
    """Another explanation of the same residuals.

    Args:
        effect: Identifier of its term.
        place: Where it would act.
        gain: Fall of -2 log posterior.
        probability: Among all explanations that were fitted.
    """

    effect: str
    place: str
    gain: float
    probability: float


@dataclass(frozen=True)
class Member:
    """A law at a place whose predictions cannot be told from those of a finding.

    Args:
        effect: Identifier of its term.
        place: Where it would act.
        is_named: Whether it is an effect with a name.
    """

    effect: str
    place: str
    is_named: bool


@dataclass(frozen=True)
class Finding:
    """One effect that the model lacks.

    Args:
        unit: electrical, thermal, stiffness, mechanical, measurement or other.
        place: For people: `string[3]`, `all coils`.
        elements: Coils, strings or channels concerned, counted from 1.
        intervals: Times [s] in which it shows.
        channels: Channels in which it shows most.
        effect: Identifier in the catalogue, or of an unnamed term.
        is_named: Whether its standing is a name or a class of names.
        statement: In one or two sentences.
        law: Formula.
        parameters: Estimates.
        gain: Fall of -2 log posterior by it, all else kept.
        probability: Of this effect against all that were fitted in its place.
        ambiguous_with: Effects that the data cannot tell from it.
        alternatives: Others that were fitted, best first.
        confused_with: Effect to what would decide, from the catalogue.
        standing: `named` if the odds against every rival are at least 20 to 1 and its parameters are identified;
            `class` if it is one of several (`effect` is the most probable, `ambiguous_with` the others);
            else `unnamed`.
        is_accepted: Whether it gains on readings that it was not fitted to; else it is a suggestion.
        doubts: Why it is no name, or not accepted, in plain words.
        recording: Title of the recording that `intervals` are times of.
        held_out_gain: Fall of -2 log likelihood of the readings that judge by it, all else kept.
        members: Other laws and places whose predictions of all readings, training and held out, differ from its own by
            less than odds of 20 to 1 ask for, whether or not the search fitted them: it is one of this class.
        judged_by: Which readings these are, in plain words; of a fault of one recording other readings of that one.
        is_of_either: Whether its class holds laws of the rig beside laws of sensors or inputs: it accuses neither.
        is_coarse: Whether it is a suggestion because the macro-step is too long to tell, and for nothing else.
        is_within_rows: Whether it is a suggestion because changes of recorded inputs before their rows explain as much,
            and for nothing else.
    """

    unit: str
    place: str
    elements: tuple[str, ...]
    intervals: tuple[tuple[float, float], ...]
    channels: tuple[str, ...]
    effect: str
    is_named: bool
    statement: str
    law: str
    parameters: tuple[Estimate, ...]
    gain: float
    probability: float
    ambiguous_with: tuple[str, ...] = ()
    alternatives: tuple[Alternative, ...] = ()
    confused_with: dict[str, str] = field(default_factory=dict)
    standing: Standing = Standing.NAMED
    is_accepted: bool = True
    doubts: tuple[str, ...] = ()
    recording: str = ""
    held_out_gain: float = math.nan
    members: tuple[Member, ...] = ()
    judged_by: str = ""
    is_of_either: bool = False
    is_coarse: bool = False
    is_within_rows: bool = False

    @property
    def places(self) -> str:
        """Every place of its class: `coil[1,1] or coil[1,2]`."""
        return class_places(self.place, self.effect, self.members)


def class_places(place: str, effect: str, members: Sequence[Member]) -> str:
    """Every place of a class, those of the same law first."""
    ordered = sorted(members, key=lambda m: m.effect != effect)
    return " or ".join(dict.fromkeys([place, *(m.place for m in ordered)]))


@dataclass(frozen=True)
class Doubt:
    """Something about a recording that the check before the diagnosis stumbled over.

    Args:
        recording: Title of the recording.
        subject: Channel, input or key of recording.yaml concerned.
        kind: `programme`, `other run`, `swapped` (channels), `exchanged` (inputs), `unit`, `sign`, `dead time`,
            `clock`, `noise`, `sensor`, `input`, `start`, `scale`, `still`, `range`, `odd one out`, `number`,
            `no answer`.
        statement: What was seen, with numbers, in plain words.
        remedy: What to look at or to change.
        is_serious: Whether the recording and the scenario are not of the same experiment, if it is true.
        begin: Begin of the stretch concerned [s]; that of the recording where it is all of it.
        end: End of the stretch [s].
        z: Size of the evidence in deviations of the noise.
        is_far: Whether a start is farther off than the start of any day may be moved, or a response so late that no
            lag explains it.
        stretches: Where it is of an input: every interval in which recorded input and programme differ [s].
        same_as: Effects of the catalogue that leave the same readings: no data can tell them from it.
    """

    recording: str
    subject: str
    kind: str
    statement: str
    remedy: str
    is_serious: bool
    begin: float
    end: float
    z: float
    is_far: bool = False
    stretches: tuple[tuple[float, float], ...] = ()
    same_as: tuple[str, ...] = ()


@dataclass(frozen=True)
class ChannelFit:
    """How well one channel of one recording is met.

    Args:
        recording: Its title.
        is_held_out: Whether it was kept from all fits.
        channel: Name.
        unit: SI unit of the RMSE.
        rmse: By `before`, `recalibrated`, `after`.
        chi_square: Per sample, by the same.
        whiteness: Largest standardised sum of residuals over a window, by the same.
        samples: Samples that were used.
        scatter: Standard deviation by which the simulation scatters by itself (contacts) [unit of the channel]; it is
            part of the deviation that residuals are divided by.
        is_noise_stated: Whether the recording states the noise; else it was estimated from neighbouring readings.
    """

    recording: str
    is_held_out: bool
    channel: str
    unit: str
    rmse: dict[str, float]
    chi_square: dict[str, float]
    whiteness: dict[str, float]
    samples: int = 0
    scatter: float = 0.0
    is_noise_stated: bool = True


@dataclass(frozen=True)
class Spread:
    """Mean of a figure and its range over recordings.

    Args:
        mean: Over recordings.
        lowest: Of a recording.
        highest: Of a recording.
    """

    mean: float
    lowest: float
    highest: float


@dataclass(frozen=True)
class ChannelSpread:
    """How well one channel is met over all recordings of a part.

    Args:
        channel: Name.
        unit: SI unit of the RMSE.
        is_held_out: Whether these recordings were kept from all fits.
        recordings: How many have the channel.
        samples: Samples that were used in them.
        rmse: By `before`, `recalibrated`, `after`.
        chi_square: Per sample, by the same.
        whiteness: By the same.
    """

    channel: str
    unit: str
    is_held_out: bool
    recordings: int
    samples: int
    rmse: dict[str, Spread]
    chi_square: dict[str, Spread]
    whiteness: dict[str, Spread]


@dataclass(frozen=True)
class Difference:
    """A held-out channel that the fast simulation and a free run of the closed co-simulation predict differently.

    Args:
        recording: Its title.
        channel: Name.
        stage: `before`, `recalibrated` or `after`.
        size: Root mean square of the difference, in deviations of the noise.
        chi_square: Per sample, by the fast simulation; that by the free run is in `fit`.
    """

    recording: str
    channel: str
    stage: str
    size: float
    chi_square: float


@dataclass(frozen=True)
class Used:
    """A recording that was used.

    Args:
        title: Of the recording.
        path: Its folder.
        is_held_out: Whether nothing was fitted to it.
        begin: Time of its first sample [s].
        end: Time of its last sample [s].
        channels: Names of its channels.
        readings: Readings of all channels that were compared.
        thinned: Readings that were not because there were so many, at even distances.
        zero: Time of its table's clock from which its times are counted [s].
    """

    title: str
    path: str
    is_held_out: bool
    begin: float
    end: float
    channels: tuple[str, ...]
    readings: int = 0
    thinned: int = 0
    zero: float = 0.0


@dataclass(frozen=True)
class Left:
    """What is left in one channel of one recording.

    Args:
        recording: Its title.
        channel: Name.
        unit: SI unit.
        rmse: Root mean square of measured minus predicted [unit].
        noise: Standard deviation of the sensor's noise, as stated or from neighbouring readings [unit].
        chi_square: Per reading.
        limit: Noise alone exceeds it in one of a thousand diagnoses.
        scatter: Root mean square of what is left as far as it changes from one reading to the next [unit].
        is_noise_stated: Whether the recording states this noise; else it was estimated from neighbouring readings.
        by_rows: Root mean square change of it where inputs of its recording changed anywhere within the row before
            their own; 0 where that was not asked [unit].
        correlation: Of the noise of neighbouring readings, where these differ by less than is stated; else 0.
    """

    recording: str
    channel: str
    unit: str
    rmse: float
    noise: float
    chi_square: float
    limit: float
    scatter: float = 0.0
    is_noise_stated: bool = True
    by_rows: float = 0.0
    correlation: float = 0.0


@dataclass(frozen=True)
class Met:
    """How the model meets one channel of one recording, every reading counted, wild ones too.

    Args:
        recording: Its title.
        channel: Name.
        unit: SI unit.
        rmse: Root mean square of measured minus predicted [unit], with the numbers of the day as they were estimated.
        samples: Readings.
    """

    recording: str
    channel: str
    unit: str
    rmse: float
    samples: int


@dataclass(frozen=True)
class Moved:
    """A number that is taken to be another than was written down.

    Args:
        name: Of the number.
        unit: Its unit; 1 of a factor.
        amount: How far it was moved, or by which factor.
        is_factor: Whether it was multiplied by `amount`; else `amount` was added.
        deviations: How far that is in deviations of what is usual or stated (its prior).
        value: The number itself, SI; NaN where it is not known.
        value_unit: Its unit.
        is_at_bound: Whether it is at the bound of its fit, so that it would have gone farther.
    """

    name: str
    unit: str
    amount: float
    is_factor: bool
    deviations: float
    value: float = math.nan
    value_unit: str = ""
    is_at_bound: bool = False

    @property
    def is_measured(self) -> bool:
        """Whether its value may be read as a measurement: it is neither at its bound nor far from its prior."""
        return not self.is_at_bound and abs(self.deviations) < FAR


@dataclass(frozen=True)
class Adequacy:
    """How right the amended model is: what it leaves of readings that it was not fitted to.

    Args:
        basis: Which readings: `held-out recordings`, or stretches of the training that were left out of fits.
        is_rejected: Whether the readings reject the model, by the noise of the sensors and the error of fitted numbers.
        chi_square: Per reading, by stage; single wild readings left out, the day's own numbers estimated.
        limit: Noise alone exceeds it in one of a thousand diagnoses.
        explained: Share of the mismatch of the scenario as it is (its squares beyond the noise) that is gone, at most
            1; negative where the model got worse; 0 where there was none.
        by_recalibration: The part of it that recalibrated parameters explain.
        worst: The channel that is met worst by its noise; None where there is no reading.
        rejected: Channels that reject the model, and channels in all.
        day: Numbers of the day (its room, its start) that had to be moved by more than half of what is usual.
        wild: Single wild readings that were not counted.
        is_noise_stated: Whether the noise of every channel was stated; else it comes from neighbouring readings.
        is_nominal_rejected: Whether the readings reject the scenario as it is.
        is_training_rejected: Whether the training recordings reject the model as well.
        is_recalibration_worse: Whether the recalibrated parameters predict worse than those of the scenario.
        is_irregular: Whether every channel that rejects the model does so by what changes from one reading to the next
            alone, as a noise does that is larger than stated.
        is_recalibrated: Whether the model has any number that could be fitted.
        has_scatter: Whether the noise holds what the simulation scatters by itself (contacts), beside the sensors'.
        met: How each channel is met by all readings of the basis: who knows the truth can tell by it how far the model
            is off, whatever was set aside here.
        needs_parameter_error: Whether noise alone would reject the model, and noise with the error of the fitted
            parameters does not.
        noises_stated: How many channels state their noise, of how many: each channel of each recording of the basis.
        by_day: Chi-square per reading that estimating the day's own numbers takes from the scenario as it is.
        alike: Channel of the training to the correlation of neighbouring readings, where these differ by less than the
            stated noise says: behind a filter noise does so, and a missing effect smaller than that noise too.
        louder: Channel to how many times its stated noise it scatters from reading to reading, where the readings
            reject the model by that noise and do not by the scatter.
        by_solving: How far an error of the macro-step may move a training reading at most, in deviations of its noise,
            where readings reject the model and that error may be half of what is left; else 0.
    """

    basis: str
    is_rejected: bool
    chi_square: dict[str, float]
    limit: float
    explained: float
    by_recalibration: float
    worst: Left | None
    rejected: tuple[int, int]
    day: tuple[Moved, ...]
    wild: int
    is_noise_stated: bool
    is_nominal_rejected: bool
    is_training_rejected: bool
    is_recalibration_worse: bool
    is_irregular: bool = False
    is_recalibrated: bool = True
    has_scatter: bool = False
    met: tuple[Met, ...] = ()
    needs_parameter_error: bool = False
    noises_stated: tuple[int, int] = (0, 0)
    by_day: float = 0.0
    alike: dict[str, float] = field(default_factory=dict)
    louder: dict[str, float] = field(default_factory=dict)
    by_solving: float = 0.0

    @property
    def is_open(self) -> bool:
        """Whether readings reject the model by their scatter too, where that is larger than the stated noise."""
        return (self.is_rejected or self.is_training_rejected) and not self.louder

    @property
    def needs_day(self) -> bool:
        """Whether the scenario as it is meets the readings only with the day's own numbers estimated."""
        before = self.chi_square["before"]
        return before <= self.limit < before + self.by_day

    @property
    def noise_may_last(self) -> bool:
        """Whether what is left may be noise that lasts: neighbours differ by less than the noise that is stated."""
        return self.worst is not None and self.worst.correlation > 0.0


@dataclass(frozen=True)
class Domain:
    """Laws of one domain that were tried.

    Args:
        name: electrical, thermal, stiffness, mechanical, measurement or other.
        laws: How many.
        generic: How many of them have no name.
        places: Places at which they were tried.
    """

    name: str
    laws: int
    generic: int
    places: int


@dataclass(frozen=True)
class Searched:
    """What was searched, and what could not be.

    Args:
        domains: Laws that were tried, by domain.
        untried: What could not be tried and why, in plain words.
    """

    domains: tuple[Domain, ...] = ()
    untried: tuple[str, ...] = ()

    @property
    def has_physics(self) -> bool:
        """Whether any law that is no fault of a sensor or input was tried."""
        return any(d.laws for d in self.domains if d.name not in ("measurement", "input"))


@dataclass(frozen=True)
class Diagnosis:
    """The answer.

    Args:
        verdict: One word.
        statement: In one or two sentences.
        findings: Effects, the largest gain first.
        fit: Per channel.
        margin: Gain that an effect had to exceed.
        false_alarm_rate: Probability that chance alone gives the first finding its gain.
        structure_before: Largest standardised sum of residuals left after recalibration.
        structure_after: The same with the findings.
        recalibration: Parameters of the model that was judged that are more than two prior deviations from the
            scenario's values, or at their bounds.
        isolability: What these channels can tell apart.
        amended_model: Path of the amended scenario, or None.
        seconds: Wall time.
        simulations: Simulations made.
        seed: Of all random numbers.
        scenario: Path of the scenario that was compared.
        recordings: Those that were fitted and those that were held out.
        nulls: Recordings without any effect, simulated from the recalibrated model, that the search was run on; 0 if
            chance was taken from the linearised search alone.
        spread: Fit of every channel over recordings.
        left: What is left at the end, the largest first; only what noise does not explain.
        locations: Where residuals of units that were driven alone have structure, the strongest first.
        waveforms: Unknown inputs at the located equations.
        proposals: Laws without a name for these inputs, by sparse regression, the best first.
        next_experiment: What would decide between explanations that are left open, or None.
        held_out_by: What the fits of held-out recordings come from; empty if none was held out.
        differences: Held-out channels on which the fast simulation and the free run differ by more than a tenth of the
            noise, the most first.
        adequacy: How right the amended model is; None where no reading was left to judge.
        searched: What was searched.
        doubts: What the check of the recordings before the search stumbled over.
        units: Units of channels and clocks as the user wrote them: terminal and report show quantities in them. All
            numbers here are SI; each stands beside its unit.
        channel_units: Names of channels to the unit of each, as the user wrote it.
        notes: What stands below the statement, a sentence each: further reasons, findings of which it says nothing,
            and what is taken for granted of the day.
    """

    verdict: Verdict
    statement: str
    findings: tuple[Finding, ...]
    fit: tuple[ChannelFit, ...]
    margin: float
    false_alarm_rate: float
    structure_before: float
    structure_after: float
    recalibration: tuple[Moved, ...]
    isolability: Isolability
    amended_model: str | None
    seconds: float
    simulations: int
    seed: int
    scenario: str = ""
    recordings: tuple[Used, ...] = ()
    nulls: int = 0
    spread: tuple[ChannelSpread, ...] = ()
    left: tuple[Remainder, ...] = ()
    locations: tuple[Location, ...] = ()
    waveforms: tuple[Waveform, ...] = ()
    proposals: tuple[Proposal, ...] = ()
    next_experiment: NextExperiment | None = None
    held_out_by: str = ""
    differences: tuple[Difference, ...] = ()
    adequacy: Adequacy | None = None
    searched: Searched = Searched()
    doubts: tuple[Doubt, ...] = ()
    units: tuple[str, ...] = ()
    channel_units: dict[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    @property
    def accepted(self) -> tuple[Finding, ...]:
        """Findings that gain on readings that they were not fitted to."""
        return tuple(f for f in self.findings if f.is_accepted)

    @property
    def suggestions(self) -> tuple[Finding, ...]:
        """Findings that do not."""
        return tuple(f for f in self.findings if not f.is_accepted)
