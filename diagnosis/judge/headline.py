"""The answer in a few sentences: what was found, and how right the model is now."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from diagnosis.faults.law import OF_THE_RIG, is_one_of
from diagnosis.judge.diagnosis import Adequacy, Doubt, Finding, Standing, Verdict
from diagnosis.judge.doubts import accuses, faults, is_explained, is_physics, of_another_experiment
from diagnosis.report.display import clean, listed, moved, number, user_unit
from diagnosis.report.user_units import IN_SI, Units

#: Faults seen by the check that are listed in one sentence.
SEEN = 2
#: Findings that are named in one sentence.
TOLD = 3
#: Explained share from which a whole number of per cent would read as everything.
ALL = 0.995
#: What serious doubts say, as a rule.
_OF_ANOTHER = "The recording and the scenario are not of the same experiment"
#: Kinds of serious doubts that say less than that the experiment is another one, with what they say.
_LESS = (
    ({"swapped"}, "Channels are exchanged"),
    ({"exchanged"}, "Inputs are exchanged"),
    ({"unit", "sign"}, "A column is not what its recording says"),
    ({"turned"}, "Sign, start or clock of a recording are not what it says"),
    ({"no answer"}, "Readings show no answer to the inputs of the scenario"),
    ({"start"}, "The first readings of a recording are not where it is said to begin"),
    ({"clock", "dead time"}, "Times of the recording are not those of the scenario"),
    ({"clock", "dead time", "late"}, "Readings come later than the scenario says"),
)
#: Said of several laws of which one at least has no name: they fit what is left out, in parts that need not be its own.
_TOGETHER = (
    "; laws without a name describe together what is missing, which need not be as many effects, nor act at these "
    "places"
)
#: What is at fault where nothing of the rig is; and where it is, in several ways.
_SENSOR = "A sensor or an input is at fault"
_RIG_OFTEN = "In single recordings the rig was another than in the others"
#: Share of what stays from which instants of inputs within a row are named as a possible reason.
ROWS = 0.5
#: Share below which what recalibration explains would read as 0 %.
LEAST_SHARE = 0.005


def headline(
    verdict: Verdict,
    found: Sequence[Finding],
    adequacy: Adequacy | None,
    reasons: Sequence[str] = (),
    doubts: Sequence[Doubt] = (),
    units: Units = IN_SI,
) -> str:
    """Both answers in one or two sentences: what was found, and how right the model is now; `notes` has the rest.

    Args:
        verdict: One word.
        found: Findings, accepted and suggested.
        adequacy: How right the accepted model is; None where nothing was simulated.
        reasons: Why it cannot be told, where it cannot.
        doubts: About the recordings.
        units: In which quantities are shown.
    """
    if verdict is Verdict.RECORDING_FAULT:
        return _not_comparable(of_another_experiment(doubts))
    named = _named(verdict, found, doubts)
    assert adequacy is not None, "only a recording fault is reported without a simulation"
    first = {
        Verdict.CONSISTENT: f"The model as it is agrees with the {_basis(adequacy)} within "
        f"{_noise(adequacy, is_fitted=False)}{_OWN if adequacy.needs_day else ''}.",
        Verdict.RECALIBRATED: f"The model agrees with the {_basis(adequacy)} within {_noise(adequacy)} once its own "
        "parameters are recalibrated.",
        Verdict.MEASUREMENT_FAULT: f"{_at_fault(found, doubts)}: {_fault(named.measured, doubts)}.",
        Verdict.MISSING_PHYSICS: f"The model leaves out: {named.physics}.",
        Verdict.UNNAMED_PHYSICS: f"The model leaves out something without a name: {named.physics}.",
        Verdict.CANNOT_TELL: f"It cannot be told {_open(adequacy)}: {reasons[0] if reasons else ''}.",
    }[verdict]
    if verdict in (Verdict.CONSISTENT, Verdict.RECALIBRATED):
        return first
    is_of_rig = any(f.is_accepted and is_physics(f) for f in found)
    is_of_sensor = any(f.is_accepted and not is_physics(f) for f in found)
    return f"{first} {how_right(adequacy, is_of_rig, units, is_of_sensor)}"


def notes(
    verdict: Verdict,
    found: Sequence[Finding],
    adequacy: Adequacy | None,
    reasons: Sequence[str] = (),
    doubts: Sequence[Doubt] = (),
    units: Units = IN_SI,
) -> tuple[str, ...]:
    """What stands below the headline, a sentence each: further reasons, findings beside it, the day; see `headline`."""
    if verdict is Verdict.RECORDING_FAULT or adequacy is None:
        return ()
    named, told = _named(verdict, found, doubts), []
    if verdict is Verdict.CANNOT_TELL:
        told += [f"A further reason: {reason.rstrip('.')}." for reason in reasons[1:]]
    if named.physics and named.measured:
        what = _at_fault(found, ())
        told.append(f"Besides, {what[0].lower()}{what[1:]}: {named.measured}.")
    if named.described:
        if verdict is Verdict.CANNOT_TELL:
            told.append(
                f"Accepted, as it improves the prediction of {_judges(found, adequacy)} but not identified, so it does "
                f"not decide: {named.described}. The rig, a sensor or an input may do that."
            )
        else:
            told.append(f"What else improves the prediction the rig, a sensor or an input may do: {named.described}.")
    if named.suggested:
        told.append(f"Suggested by the training recordings alone, not accepted: {named.suggested}.")
    if adequacy.day:
        told.append(
            f"That takes for granted: {day_of(adequacy, units)}. The rows of fits of each channel are without it."
        )
    if verdict in (Verdict.CONSISTENT, Verdict.RECALIBRATED):
        told += _of_noise(adequacy)
    if adequacy.wild:
        one = (
            "1 reading stands out alone and is"
            if adequacy.wild == 1
            else f"{adequacy.wild} readings stand out, each alone or two in a row, and are"
        )
        told.append(f"Of the {_basis(adequacy)} {one} not counted against the model; errors of channels count all.")
    return tuple(told)


def _of_noise(adequacy: Adequacy) -> list[str]:
    """What the agreement of a model takes for granted of the noise: that it is larger than stated, or lasts."""
    told = []
    if adequacy.louder:
        times = listed([f"{number(n)} times ({clean(name)})" for name, n in adequacy.louder.items()], TOLD)
        which = "readings" if adequacy.is_rejected else "training readings"
        told.append(
            f"By the noise that is stated the {which} would reject the model: they scatter from one to the next by "
            f"{times} that noise. What is left is alike at no longer interval, as noise is; something missing that "
            "changes as fast would not be seen. Correct `noise` in recording.yaml."
        )
    if adequacy.alike:
        told.append(
            f"Neighbouring readings of {listed(list(adequacy.alike), TOLD)} differ by less than their stated noise "
            "says. Noise behind a filter does so; a missing effect smaller than that noise would not be seen."
        )
    return told


@dataclass(frozen=True)
class _Named:
    """Findings by what is said of them, listed; empty where there is none.

    Args:
        physics: Of the rig, where the verdict is that they are missing.
        measured: Of sensors and inputs that are at fault.
        described: Accepted, of which neither is said.
        suggested: Not accepted.
    """

    physics: str
    measured: str
    described: str
    suggested: str


def _named(verdict: Verdict, found: Sequence[Finding], doubts: Sequence[Doubt]) -> _Named:
    of_the_rig = [f for f in found if f.is_accepted and is_physics(f)]
    at_fault = [f for f in found if f.is_accepted and not is_physics(f)]
    is_told = verdict in (Verdict.MISSING_PHYSICS, Verdict.UNNAMED_PHYSICS)
    measured = _listed([f for f in at_fault if accuses(f)])
    unsure = [f for f in at_fault if not accuses(f)]
    if verdict is Verdict.MEASUREMENT_FAULT and not measured:  # what the check saw is named, and nothing else
        unsure = [f for f in unsure if not any(is_explained(d, f) for d in faults(doubts)[:SEEN])]
    suggested = _listed([f for f in found if not f.is_accepted])
    if any(f.statement in suggested for f in found if f.is_accepted):
        suggested = f"one more law beside these: {suggested}"
    physics = _listed(of_the_rig if is_told else [])
    if len(of_the_rig) > 1 and any(f.standing is Standing.UNNAMED for f in of_the_rig):
        physics = f"{physics}{_TOGETHER}" if physics else ""
    return _Named(
        physics,
        measured,
        _listed([*([] if is_told else of_the_rig), *unsure]),
        suggested,
    )


def _at_fault(found: Sequence[Finding], doubts: Sequence[Doubt]) -> str:
    """What is at fault: sensors and inputs, the rig in one recording, or both."""
    blamed = [f for f in found if f.is_accepted and not is_physics(f) and accuses(f)]
    of_the_rig = [is_one_of(f.effect, OF_THE_RIG) for f in blamed]
    if of_the_rig and all(of_the_rig) and not faults(doubts):
        return "In one recording the rig was another than in the others" if len(blamed) == 1 else _RIG_OFTEN
    return "A sensor, an input or the rig of one recording is at fault" if any(of_the_rig) else _SENSOR


def _open(adequacy: Adequacy) -> str:
    """What cannot be told: a model that readings reject, and no noise that may be larger, lacks something.

    Noise that is not stated is that of neighbouring readings: a sensor that drifts to and fro has more.
    """
    is_wrong = adequacy.is_rejected and not adequacy.is_irregular and adequacy.is_noise_stated
    return "what is missing or wrong" if is_wrong else "whether something is missing"


def _not_comparable(serious: Sequence[Doubt]) -> str:
    """Why nothing was fitted. Exchanged sensors are of the same experiment, and readings do not tell them apart."""
    kinds = {d.kind for d in serious}
    what = next((text for own, text in _LESS if kinds <= own), _OF_ANOTHER)
    told = list(dict.fromkeys(d.kind for d in serious))[: 1 if kinds == {"swapped"} else 2]
    return f"{what}: {'; '.join(_once([d for d in serious if d.kind == k]) for k in told)}."


def _once(alike: Sequence[Doubt]) -> str:
    """The first of several doubts of one kind, and how many other recordings raise it too."""
    others = len({d.recording for d in alike} - {alike[0].recording})
    which = "1 more recording raises" if others == 1 else f"{others} more recordings raise"
    more = f" ({which} a doubt of this kind)" if others else ""
    channel = f"{alike[0].subject}: " if alike[0].kind in ("unit", "sign", "turned", "start") else ""
    return f"in {clean(alike[0].recording)}, {channel}{alike[0].statement.rstrip('.')}{more}"


def _listed(found: Sequence[Finding]) -> str:
    """Statements of findings; of many the first ones."""
    counts = Counter(f.statement for f in found)
    told = [s if n == 1 else f"{s} ({n} such laws)" for s, n in counts.items()]
    more = f"; and {len(told) - TOLD} more" if len(told) > TOLD else ""
    return "; ".join(told[:TOLD]) + more


def _fault(accepted: str, doubts: Sequence[Doubt]) -> str:
    """What was fitted of the faults, or else what the check saw."""
    seen = faults(doubts)[:SEEN]
    return accepted or "; ".join(f"{d.subject} of {clean(d.recording)}: {d.statement.rstrip('.')}" for d in seen)


def _basis(adequacy: Adequacy) -> str:
    """Which readings judged, within a sentence: a clause at its end is closed by a comma."""
    return f"{adequacy.basis}," if "," in adequacy.basis else adequacy.basis


def _judges(found: Sequence[Finding], adequacy: Adequacy) -> str:
    """Which readings accepted findings improve: those of a stretch of one recording are judged by others of it."""
    judged = {f.judged_by or adequacy.basis for f in found if f.is_accepted}
    return f"the {_basis(adequacy)}" if judged <= {adequacy.basis} else "readings that were left out of its fit,"


def noise_of(adequacy: Adequacy) -> str:
    """Where the noise comes from that readings are compared with."""
    if adequacy.louder and adequacy.is_rejected:
        return "the scatter of neighbouring readings, which is more than the noise that is stated,"
    if adequacy.is_noise_stated:
        return "the stated noise of the sensors"
    stated, channels = adequacy.noises_stated
    if stated:
        return (
            f"the noise of the sensors (stated for {stated} of {channels} channels, estimated from the scatter of "
            "neighbouring readings for the others)"
        )
    return "the scatter of neighbouring readings (no noise was stated)"


def _noise(adequacy: Adequacy, is_fitted: bool = True) -> str:
    """What the readings agree within; of a model as it is no number was fitted."""
    noise = noise_of(adequacy)
    noise += " and what simulations of an equal fabric differ by" if adequacy.has_scatter else ""
    return f"{noise} and the error of the fitted parameters" if is_fitted and adequacy.needs_parameter_error else noise


def _model(adequacy: Adequacy, is_amended: bool, has_fault: bool) -> str:
    """What the model that judged is called: what was added to it, or fitted."""
    if is_amended:
        return "The amended model"
    if has_fault:
        return "The model with what was found of sensors, inputs and single recordings"
    return "The recalibrated model" if adequacy.is_recalibrated else "The model as it is"


def how_right(adequacy: Adequacy, is_amended: bool, units: Units = IN_SI, has_fault: bool = False) -> str:
    """What the model explains of the mismatch, and what it leaves.

    A model that was not rejected leaves no more than the noise explains; that is not a proof that nothing is missing.

    Args:
        adequacy: How right it is.
        is_amended: Whether anything was added to it; else it was recalibrated at most.
        units: In which quantities are shown.
        has_fault: Whether laws of sensors or inputs were accepted.
    """
    name, noise = _model(adequacy, is_amended, has_fault), _noise(adequacy)
    has_more = is_amended or has_fault
    is_changed = has_more or adequacy.is_recalibrated
    before = adequacy.chi_square["before"]
    is_met = not adequacy.is_rejected
    if is_met and not (is_changed and adequacy.is_nominal_rejected):
        text = f"The {adequacy.basis} are met within {noise}" + (", before and after" if is_changed else "")
    elif is_met and before <= 1.0:  # one channel alone was missed
        text = f"The {adequacy.basis} are met within {noise} now; the model as it is misses them"
    elif not is_changed:
        text = f"The model as it is misses the {adequacy.basis}"
    elif adequacy.explained < 0.0:
        text = f"{name} predicts the {_basis(adequacy)} worse"
        text += f"; what is left is not more than {noise}" if is_met else ""
    else:
        is_whole = adequacy.explained >= 1.0 and is_met
        alone = min(adequacy.by_recalibration, adequacy.explained)
        share = "100 %" if is_whole else _percent(adequacy.explained)
        text = f"{name} explains {share} of the squared mismatch in the {_basis(adequacy)}"
        if has_more and adequacy.by_recalibration >= LEAST_SHARE:
            text += f" (recalibration alone {_percent(alone)}{_course(adequacy) if alone > ALL else ''})"
        text += f"; what is left is not more than {noise}" if is_met else ""
    if not is_met and adequacy.worst is not None:
        text += f"; {what_stays(adequacy, units)}: {_cause(adequacy, has_more, units)}"
    return f"{text}."


def _percent(share: float) -> str:
    """A share of the mismatch; what is nearly all of it is not called all."""
    return "more than 99 %" if share > ALL else f"{100.0 * share:.0f} %"


_OWN = " once what each of them has of its own (its start, say) is estimated"


def _course(adequacy: Adequacy) -> str:
    """Chi-square per reading with recalibration alone and with what was found, where per cent tell no difference."""
    chi = adequacy.chi_square
    return f"; chi-square per reading {number(chi['recalibrated'])} by it, {number(chi['after'])} now"


def _cause(adequacy: Adequacy, has_more: bool, units: Units) -> str:
    """Why something stays."""
    if adequacy.is_irregular:
        worst = adequacy.worst
        is_stated = adequacy.is_noise_stated if worst is None else worst.is_noise_stated
        source = "is stated" if is_stated else "was estimated from neighbouring readings"
        return (
            f"as much as it changes from one reading to the next: noise is larger than {source}, single readings are "
            "wild, or a little is missing that changes as fast"
        )
    slow = "" if adequacy.is_noise_stated else ", or noise lasts longer than neighbouring readings, which tell it, show"
    if adequacy.noise_may_last:
        slow = ", or noise lasts for several readings: neighbours differ by less than the noise that is stated"
    return f"something {'else ' if has_more else ''}is missing or wrong{slow}{_by_rows(adequacy, units)}"


def _by_rows(adequacy: Adequacy, units: Units) -> str:
    """That inputs may be the reason, where what their table does not say moves the channel by much of what stays."""
    worst = adequacy.worst
    if worst is None or worst.by_rows < ROWS * worst.rmse:
        return ""
    factor, unit = units.of(worst.channel).difference(worst.unit)
    size = f"{number(factor * worst.by_rows, 2)} {unit}".strip()
    return f", or its inputs changed between rows of their table, which alone may move it by {size}"


def what_stays(adequacy: Adequacy, units: Units = IN_SI) -> str:
    """What is left where most is left, in the user's unit and in multiples of the noise."""
    assert adequacy.worst is not None
    worst = adequacy.worst
    factor, unit = units.of(worst.channel).difference(worst.unit)
    size = f"{number(factor * worst.rmse, 2)} {unit}".strip()
    times = worst.rmse / worst.noise if worst.noise > 0.0 else float("inf")
    source = "that is stated" if worst.is_noise_stated else "estimated from neighbouring readings"
    return f"{size} of {clean(worst.channel)} stays, {number(times, 2)} times the noise {source}"


def day_of(adequacy: Adequacy, units: Units = IN_SI) -> str:
    """What was taken for granted of the day: how far its own numbers were moved."""
    return "; ".join(
        moved(m.name, m.amount, m.is_factor, m.unit, user_unit(m.unit, units.written)) for m in adequacy.day
    )
