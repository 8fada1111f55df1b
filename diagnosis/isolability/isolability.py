"""What the channels of the recordings can tell apart, and which further channel would help most."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from cosim.compute.steps import counted
from diagnosis.isolability.alike import SHOWS, Alike, Effect, effects, widest
from diagnosis.isolability.of_answers import of_answers
from diagnosis.isolability.structure import VARIABLES, Analysis, Rig, analyse
from diagnosis.judge.isolability import ExtraChannel, FaultClass, Isolability
from diagnosis.models.coil_network.kernel.layout import QUANTITIES
from diagnosis.models.coil_network.kernel.places import coil_label
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.search.fit import Fit
from diagnosis.search.problem import Term

#: Quantities by which stretched coils are known.
_LOADED = frozenset({"extension", "length", "stiffness", "tension"})
#: Quantity that may be recorded in addition to its words.
CHANNELS = {
    "terminal_voltage": "the voltage at the supply's terminals",
    "supply_current": "the current of the supply",
    "supply_power": "the power of the supply",
    "string_voltage": "the voltage of every string",
    "voltage": "the voltage of every coil",
    "current": "the current of every string",
    "second_temperature": "a second thermometer on every coil",
    "second_extension": "a second sensor of every extension",
}
#: Statements about single effects and pairs, at most.
MOST = 6
#: Effects of which the recalibration leaves less than this share are reported as absorbed.
ABSORBED = 0.1


def isolability(model: DiagnosisModel, fit: Fit, terms: Sequence[Term]) -> Isolability:
    """What can be told apart, by the structure of the equations and by the sizes of effects.

    Args:
        model: Model with its recordings.
        fit: Recalibrated, without terms.
        terms: Effects that may be missing, at their places.
    """
    answers = model.answers
    if answers is not None:
        return of_answers(answers)
    shown, alike = effects(model, fit, widest(terms))
    by_size = list(_by_size(shown, alike))
    network = model.coil_network
    if network is None:
        return Isolability(tuple(by_size))
    rig = rig_of(network)
    now = analyse(rig)
    classes = _generic(rig, now)
    extra = extra_channels(rig, now)
    statements = [*_structural(classes, now), *(e.statement for e in extra[:1]), *by_size]
    return Isolability(tuple(statements), tuple(classes), tuple(extra))


def rig_of(model: CoilNetworkModel) -> Rig:
    """At most two strings of at most two coils that stand for the rest: those with the most and the fewest channels."""
    layout = model.coils
    measured = {(s.quantity, s.element) for run in model.runs for s in run.series}
    coil_channels = [sum(1 for q, e in measured if e == c and _is_of_coil(q)) for c in range(layout.coils)]
    strings = list(range(len(layout.strings) or 1))
    of_string = [np.flatnonzero(layout.string_of_coil == s) for s in strings]
    string_channels = [
        sum(coil_channels[c] for c in of_string[s]) + sum((q, s) in measured for q in ("current", "string_voltage"))
        for s in strings
    ]
    chosen = _ends(strings, string_channels)
    names, channels = {}, []
    for s in chosen:
        coils = _ends(of_string[s].tolist(), [coil_channels[c] for c in of_string[s]])
        label = f"string[{s + 1}]"
        names[label] = [coil_label(layout, c) for c in coils]
        channels += [(q, coil_label(layout, e)) for q, e in measured if _is_of_coil(q) and e in coils]
        channels += [(q, label) for q in ("current", "string_voltage") if (q, s) in measured]
    channels += [("supply_current", "supply")] if any(q == "supply_current" for q, _ in measured) else []
    there = {q for q, _ in measured}
    channels += [(q, "supply") for q in ("terminal_voltage", "supply_power") if q in there]
    slope = model.runs[0].translation.parameters.base.get("resistance_temperature_coefficient", 0.0)
    is_common = layout.supply == "common"
    has_load = model.runs[0].translation.load is not None or bool(_LOADED & {q for q, _ in measured})
    feels_heat = bool(np.any(np.asarray(slope)))
    return Rig(names, bool(layout.strings), is_common, frozenset(channels), feels_heat, has_load)


def _is_of_coil(quantity: str) -> bool:
    return quantity in VARIABLES and QUANTITIES[quantity].axis == "coil"


def _ends(items: Sequence[int], channels: Sequence[int]) -> list[int]:
    """The items with the most and the fewest channels."""
    order = np.argsort(-np.asarray(channels), kind="stable")
    return [items[n] for n in dict.fromkeys((int(order[0]), int(order[-1])))]


def _generic(rig: Rig, analysis: Analysis) -> list[FaultClass]:
    """Classes with `a coil` for its name, each once."""
    found: dict[tuple[str, ...], FaultClass] = {}
    for members in analysis.classes():
        words = _anonymous(rig, members)
        found.setdefault(words, FaultClass(words))
    missing = _anonymous(rig, analysis.undetectable())
    return [*found.values(), *([FaultClass(missing, is_detectable=False)] if missing else [])]


def _anonymous(rig: Rig, faults: Iterable[str]) -> tuple[str, ...]:
    words = []
    for fault in faults:
        for string, coils in rig.strings.items():
            for coil in coils:
                fault = fault.replace(coil, "a coil")
            fault = fault.replace(string, "a string")
        words.append(fault)
    return tuple(sorted(dict.fromkeys(words)))


def _structural(classes: Sequence[FaultClass], analysis: Analysis) -> list[str]:
    unseen = [c for c in classes if not c.is_detectable]
    mixed = [c for c in classes if c.is_detectable and len(c.faults) > 1]
    clear = [c.faults[0] for c in classes if c.is_detectable and len(c.faults) == 1]
    found = [f"No channel shows a fault in the {_listed(c.faults)}." for c in unseen]
    found += [f"These channels cannot tell apart by their structure: {_listed(c.faults)}." for c in mixed]
    if clear:
        found.append(f"Each of these is told from all others: {_listed(clear)}.")
    return found


def extra_channels(rig: Rig, now: Analysis) -> list[ExtraChannel]:
    """Quantities that are not recorded everywhere, by how many faults could be told apart with them, the best first.

    Args:
        rig: As it is recorded.
        now: Its analysis.
    """
    own = set(now.faults)
    found = []
    for quantity in counted(list(VARIABLES), "further channels tried"):
        channels = set(rig.channels) | {(quantity, e) for e in _elements(rig, quantity)}
        is_second = quantity.startswith("second_")
        if channels == set(rig.channels) or is_second != _has(rig, quantity.removeprefix("second_")):
            continue
        if quantity == "length" and _has(rig, "extension"):
            continue
        if quantity in ("length", "extension", "stiffness", "second_extension") and not rig.has_load:
            continue
        then = analyse(replace(rig, channels=frozenset(channels)))
        kept = [n for n, f in enumerate(then.faults) if f in own]
        apart = (then.is_isolable & then.is_isolable.T)[np.ix_(kept, kept)]
        places = [now.faults.index(then.faults[n]) for n in kept]
        before = (now.is_isolable & now.is_isolable.T)[np.ix_(places, places)]
        gained = int(np.sum(apart & ~before) // 2)
        seen = int(np.sum(then.is_detectable[kept])) - int(np.sum(now.is_detectable))
        if gained > 0 or seen > 0:
            pairs = [(then.faults[kept[a]], then.faults[kept[b]]) for a, b in np.argwhere(apart & ~before) if a < b]
            found.append((gained + seen, _extra(rig, quantity, pairs, len(then.classes()) - len(now.classes()))))
    return [channel for _, channel in sorted(found, key=lambda item: -item[0])]


def _has(rig: Rig, quantity: str) -> bool:
    return any(q == quantity for q, _ in rig.channels)


def _elements(rig: Rig, quantity: str) -> list[str]:
    if quantity in ("supply_current", "terminal_voltage", "supply_power"):
        return ["supply"] if rig.has_circuit and rig.is_common else []
    if quantity in ("current", "string_voltage"):
        return list(rig.strings) if rig.has_circuit else []
    if quantity in ("resistance", "power", "voltage") and not rig.has_circuit:
        return []
    return [c for coils in rig.strings.values() for c in coils]


def _extra(rig: Rig, quantity: str, pairs: Sequence[tuple[str, str]], classes: int) -> ExtraChannel:
    what = CHANNELS.get(quantity, f"the {quantity} of every coil")
    told = {tuple(sorted(dict.fromkeys(_anonymous(rig, (a,)) + _anonymous(rig, (b,))))) for a, b in pairs}
    words = sorted(" from ".join(p) if len(p) > 1 else f"one {p[0]} from another" for p in told)
    plain = [w for w in words if "sensor" not in w] or words
    gives = f"it would tell {'; '.join(plain[:MOST])}" if plain else "more faults would show with it"
    statement = f"The extra channel that would help most is {what}: {gives}."
    return ExtraChannel(what.removeprefix("the "), max(classes, 0), statement)


def _by_size(shown: Sequence[Effect], alike: Sequence[Alike]) -> Iterable[str]:
    """Statements about effects of the catalogue at the recalibrated point."""
    absorbed = [e for e in shown if 0.0 < e.visibility < ABSORBED and e.gain > 0.0]
    for effect in sorted(absorbed, key=lambda e: (e.term.unit == "measurement", e.visibility))[:MOST]:
        least = abs(effect.strength) * float(np.sqrt(SHOWS / effect.gain))
        unit = effect.term.parameters[0].unit
        yield (
            f"{_plain(effect.term)} shows from {least:.2g}{f' {unit}' if unit != '1' else ''} on: all but "
            f"{100 * effect.visibility:.2g} % of its change (root mean square, training) is also made by "
            f"{effect.absorbed_by}."
        )
    for pair in alike[:MOST]:
        yield (
            f"{pair.one.replace('_', ' ')} and {pair.other.replace('_', ' ')} look alike in these recordings "
            f"(cosine {pair.cosine:.3f})."
        )


def _plain(term: Term) -> str:
    return f"{term.identifier.replace('_', ' ')} ({term.place})"


def _listed(words: Sequence[str]) -> str:
    return ", ".join(words)
