"""Where laws of the library fit in a system of FMUs: by the units of its quantities and by its equations."""

from __future__ import annotations

import ast
import itertools
import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from cosim.formula import Formula, FormulaError
from cosim.unit.protocol import Array
from cosim.unit.quantity import PhysicalValue, parse_unit, registry
from diagnosis.laws.at_inputs import OVER
from diagnosis.laws.expression import names_in, renamed
from diagnosis.laws.law import Law, Number, Role
from diagnosis.models.systems.changeable import changeable, why_none
from diagnosis.models.systems.derivative_outputs import (
    FACTOR,
    outputs_read,
    parts_read,
    read_by_outputs,
    read_in_part,
    states_read,
)
from diagnosis.models.systems.far import far_quantities
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.fmu_layout import FastFmu, NotFast
from diagnosis.models.systems.placed import Placed, PlacedDelay, PlacedInput, PlacedState
from diagnosis.models.systems.quantities import Places, Quantity, quantity_of
from diagnosis.models.systems.steps import resolve
from diagnosis.models.systems.surroundings import hidden_surroundings, surroundings
from diagnosis.models.systems.targets import ACROSS, AT_PARAMETERS, MODULATED, SURROUNDINGS, is_of, parameter, targets
from diagnosis.search.problem import Term, TermParameter

#: Points at which the equations are asked whether a state is the derivative of another.
PROBES = 5
#: Seed of these points.
SEED = 20
#: A quantity that is farther from 0 than so many times what it moves has its power series from where it is: a curvature
#: comes with a slope of twice, and a constant of the square, of that else.
FAR = 5.0
#: The same of a state that drives an exchange: from there on it begins away from 0.
BEGUN = 0.5
#: What an output that is a part of a derivative reads of a law in it: the inertia that turns one into the other is the
#: scenario's, which may be off.
SHARE = TermParameter(
    "share_read", "1", 0.5, 2.0, (1.0,), meaning="what the output reads of it, over what the scenario's inertia gives"
)
#: Roles whose laws act on an input. Where the FMU hides its states, what a lag passes is held over a macro-step, late
#: by half of one in the mean: the lag that is found is short by that.
HELD = (Role.INPUT, Role.STARTED_INPUT, Role.PORT)


@dataclass(frozen=True)
class Fit:
    """A law at a place.

    Args:
        law: The law.
        placed: In the names of the FMU.
        term: For the search.
        reaction: What is added with it to the other part of which it loses or gets something; None: nothing.
        beside: Name of that part, of the surroundings where there are several, of what a parameter changes with, or of
            the quantities of other components;
            empty where there is one choice.
        read: The same in outputs that are derivatives which it is added to: an accelerometer reads a force that the
            equations of the FMU do not have. Or in one that is the part of a derivative in which it acts.
        seen_by: That output; empty where it acts beside what an output reads in part.
    """

    law: Law
    placed: Placed
    term: Term
    reaction: Placed | None = None
    beside: str = ""
    read: tuple[Placed, ...] = ()
    seen_by: str = ""

    @property
    def every(self) -> tuple[Placed, ...]:
        """What is added, to one derivative, input or output each."""
        return (self.placed, *(() if self.reaction is None else (self.reaction,)), *self.read)

    def values_of(self, placed: Placed, values: Sequence[float]) -> tuple[float, ...]:
        """Values of the numbers that one of them uses, from those of the law."""
        given = dict(zip((p.name for p in self.term.parameters), values))
        return tuple(given[name] for name, _ in placed.numbers)


def places_of(systems: Sequence[FastSystem]) -> list[Places]:
    """Quantities of every FMU, with the sizes that they have in simulations of all recordings.

    Args:
        systems: One for each recording, without laws.

    Raises:
        NotFast: A simulation stops, or gives something else the second time.
    """
    courses: list[dict[tuple[str, str], Array]] = []
    for system in systems:
        first = resolve(system)
        rows = system.simulate()
        if first is None or rows is None:
            raise NotFast("a simulation stops, or an FMU cannot be reset; `cosim run` tells which")
        if not np.allclose(first, rows.values, rtol=1e-9, atol=1e-12 * float(np.max(np.abs(first), initial=1.0))):
            raise NotFast("an FMU that was reset is not as a new one")
        courses.append({key: first[:, s] for key, s in system.recorded.items()})
    step = systems[0].times[1] - systems[0].times[0] if len(systems[0].times) > 1 else 1.0
    found = []
    for name, fmu in systems[0].fmus.items():
        own = Places(name)
        connected = {t.variable.name for t in systems[0].assembly.system.transfers[name]}
        own.states = _quantities(fmu, fmu.states, [(name, f"state {s}") for s in fmu.states], courses, step)
        inputs = [n for n, s in fmu.inputs.items() if n in connected and s.stop - s.start == 1]
        own.inputs = _quantities(fmu, inputs, [(name, f"input {n}") for n in inputs], courses, step)
        if not fmu.is_model_exchange:
            outputs = [n for n, a in fmu.outputs.items() if a.size == 1]
            own.outputs = _quantities(fmu, outputs, [(name, n) for n in outputs], courses, step)
        probed = _probed(systems[0], fmu, own)
        own.velocity_of, own.twist_of = _kinematics(*probed)
        own.derivatives_read, composed = outputs_read(systems[0], fmu, own)
        own.states_read = states_read(fmu, own, composed)
        own.parts_read = parts_read(systems[0], fmu, own)
        read = [n for of in (own.derivatives_read, own.parts_read) for outputs in of.values() for n in outputs]
        own.output_units = {n: fmu.units[n] for n in read}
        own.readings = _quantities(fmu, composed, [(name, n) for n in composed], courses, step)
        own.apart = _apart(fmu, own, courses, step)
        own.acted_on_by = _acting(systems[0], own, *probed)
        own.parameters = changeable(systems[0], fmu, own)
        own.far = far_quantities(systems[0], fmu.name, courses, step)
        own.room = surroundings(systems[0], fmu, own, *probed) or hidden_surroundings(systems[0], fmu, own)
        own.untried = _untried(fmu, own)
        own.is_hidden = not fmu.is_model_exchange
        found.append(own)
    return found


def _untried(fmu: FastFmu, own: Places) -> list[str]:
    """What offers no place, in words."""
    if not fmu.is_model_exchange:
        places = [f"at its {_listed(kind, n)}" for kind, n in (("input", own.inputs), ("output", own.outputs)) if n]
        what = f"laws were tried {' and '.join(places)} alone" if places else "it offers no place for a law"
        is_both = fmu.unit.archive.description.modelExchange is not None
        remedy = "; with `integrator: cvode` they are tried at its states too" if is_both else ""
        return [f"`{own.component}` is used by Co-Simulation, which hides its states: {what}{remedy}"]
    if fmu.state_count and not fmu.states:
        return [f"`{own.component}` does not say which variables its states are: no law was tried at their derivatives"]
    lost = [n for n in fmu.states if n not in own.states]
    found = [
        f"`{own.component}.{n}` has a unit or a name that no formula can use: no law was tried there" for n in lost
    ]
    held = why_none(fmu) if fmu.states else ""
    return [*found, *([f"no parameter of `{own.component}` was tried as one that changes: {held}"] if held else [])]


def _listed(kind: str, names: Collection[str]) -> str:
    return f"{kind}{'s' if len(names) > 1 else ''} {', '.join(f'`{n}`' for n in names)}"


def _quantities(
    fmu: FastFmu,
    names: Sequence[str] | Mapping[str, int],
    keys: Sequence[tuple[str, str]],
    courses: Sequence[Mapping[tuple[str, str], Array]],
    step: float,
    is_difference: bool = False,
) -> dict[str, Quantity]:
    found = {}
    for name, key in zip(names, keys):
        if name not in fmu.units or not _is_nameable(name):
            continue
        values = [c[key].reshape(-1) for c in courses if key in c]
        if values:
            found[name] = quantity_of(name, fmu.units[name], values, step, is_difference)
    return found


def _apart(
    fmu: FastFmu, own: Places, courses: Sequence[Mapping[tuple[str, str], Array]], step: float
) -> dict[tuple[str, str], Quantity]:
    """What two states of one unit are apart by, for every two."""
    found = {}
    for one, other in itertools.combinations(own.states, 2):
        if fmu.units[one] != fmu.units[other]:
            continue
        keys = [(own.component, f"state {n}") for n in (one, other)]
        gaps = [{keys[0]: c[keys[0]] - c[keys[1]]} for c in courses]
        gap = _quantities(fmu, (one,), (keys[0],), gaps, step, is_difference=True)[one]
        found[one, other] = replace(gap, name=f"({one} - {other})")
        found[other, one] = replace(
            gap, name=f"({other} - {one})", middle=-gap.middle, least=-gap.most, most=-gap.least
        )
    return found


def _is_nameable(name: str) -> bool:
    """Whether a formula can hold it."""
    try:
        return names_in(name) == {name}
    except (SyntaxError, ValueError):
        return False


def _probed(system: FastSystem, fmu: FastFmu, own: Places) -> tuple[list[str], Array, Array]:
    """States, random points of them, and their derivatives there, shape (points, states); none where one is unknown."""
    if not fmu.states or set(fmu.states) != set(own.states):
        return [], np.zeros((0, 0)), np.zeros((0, 0))
    names = list(fmu.states)
    middle, size = np.array([own.states[n].in_fmu for n in names]).T
    points = middle + size * np.random.default_rng(SEED).standard_normal((PROBES, len(names)))
    return names, points, system.rates_at(own.component, points)


def _kinematics(names: Sequence[str], points: Array, rates: Array) -> tuple[dict[str, str], dict[str, tuple[str, str]]]:
    """Positions with the states that are their derivatives, and states whose derivative is a difference of two others.

    The equations are asked at random points, see `_probed`.
    """
    velocities: dict[str, str] = {}
    twists: dict[str, tuple[str, str]] = {}
    for i, position in enumerate(names):
        others = [j for j in range(len(names)) if j != i]
        for j in others:
            if _are_equal(rates[:, i], points[:, j], points[:, j]):
                velocities[position] = names[j]
        for j, k in itertools.permutations(others, 2):
            if _are_equal(rates[:, i], points[:, j] - points[:, k], points[:, [j, k]]):
                twists[position] = names[j], names[k]
    return velocities, twists


def _acting(
    system: FastSystem, own: Places, names: Sequence[str], points: Array, rates: Array
) -> dict[str, frozenset[str]]:
    """State to the other states that its derivative depends on, at any of some random points, see `_probed`."""
    found: dict[str, set[str]] = {n: set() for n in names}
    for j, name in enumerate(names):
        step = own.states[name].in_fmu[1] * (np.arange(len(names)) == j)
        for point, here in zip(points, rates):
            moved = system.rates(own.component, system.start / 1e9, point + step)
            for i in np.flatnonzero(np.abs(moved - here) > 1e-9 * (np.abs(moved) + np.abs(here))):
                found[names[int(i)]].add(name)
    return {n: frozenset(others - {n}) for n, others in found.items()}


def _are_equal(rates: Array, values: Array, parts: Array) -> bool:
    """Whether rates are some values, to the rounding of what these are made of."""
    return bool(np.allclose(rates, values, rtol=1e-9, atol=1e-12 * float(np.max(np.abs(parts)) or 1.0)))


# fitting laws


class Times(NamedTuple):
    """Times that sizes of numbers are made of [s].

    Args:
        reading: Between two readings, typically.
        macro_step: Of the co-simulation.
        duration: Of the longest recording.
    """

    reading: float
    macro_step: float
    duration: float


def fits(
    places: Sequence[Places], laws: Sequence[Law], sample_step: float, macro_step: float = 0.0, duration: float = 0.0
) -> Iterator[Fit]:
    """Every law at every place where its quantities fit.

    Args:
        places: Of the system.
        laws: The library.
        sample_step: Typical time between readings [s].
        macro_step: Of the co-simulation [s]: values that pass between FMUs are early or late by up to so much, and a
            lag that is no longer is none of the rig.
        duration: Of the longest recording [s]; by default a thousand readings.
    """
    steps = Times(sample_step, macro_step, duration or 1000.0 * sample_step)
    seen: dict[tuple[str, str, str], Fit] = {}
    for own in places:
        for law in laws:
            for to, target, symbols in targets(own, law.role):
                fit = _fit(own, law, to, target, symbols, steps)
                if fit is None:
                    continue
                signature = own.component, to, _form(fit.placed)
                if signature not in seen:
                    seen[signature] = fit
                    yield fit
                    yield from _in_what_is_read(own, fit)
                elif (other := _other_sign(fit, seen[signature])) is not None:
                    yield other


def _fit(own: Places, law: Law, to: str, target: Quantity, symbols: Mapping[str, Quantity], steps: Times) -> Fit | None:
    numbers = {n.name for n in law.numbers} | set(law.constants) | {s.name for s in law.states}
    numbers |= {d.name for d in law.delays}
    formulas = (law.formula, *(s.rate for s in law.states), *((law.reaction,) if law.reaction else ()))
    products = (*(n.of for n in law.numbers), *(of for of, _ in law.constants.values()), *(s.of for s in law.states))
    needed = {n for f in formulas for n in names_in(f)} - numbers - {"time"}
    needed |= {n for of in products for n in names_in(of)} - _SCALES
    if law.is_share and own.derivatives_read.get(target.name):
        return None  # an output that reads the derivative would have to read the share of it too
    if not needed <= set(symbols) or any(symbols[d.of].name not in own.inputs for d in law.delays):
        return None
    taken = {*own.states, *own.inputs, *own.outputs, *own.far, "time"}
    room = {} if own.room is None or "T_a" not in needed else {SURROUNDINGS: PhysicalValue(own.room, "K")}
    if taken & set(room):
        return None
    fresh = {n: n if n not in taken else f"{n}_law" for n in numbers}
    if any(v in taken for v in fresh.values()):
        return None
    names = {**{s: q.name for s, q in symbols.items()}, **fresh}
    references = _references(law, symbols, own.states, taken)
    names |= {s: f"({names[s]} - {reference})" for s, (reference, _) in references.items()}
    scale = _Scale(symbols, target, to.startswith("der("), steps)
    try:
        constants = {
            fresh[n]: PhysicalValue(float(f"{share * scale.size(of):.3g}"), scale.unit(of))
            for n, (of, share) in law.constants.items()
        } | {**dict(references.values()), **room}
        placed = Placed(
            own.component,
            to,
            renamed(law.formula, names),
            tuple((fresh[n.name], scale.unit(n.of)) for n in law.numbers),
            constants,
            tuple(
                PlacedState(fresh[s.name], renamed(s.rate, names), renamed(s.start, names), scale.unit(s.of))
                for s in law.states
            ),
            tuple(PlacedDelay(fresh[d.name], symbols[d.of].name, fresh[d.by]) for d in law.delays),
            law.is_share,
            tuple(PlacedInput(q.name, own.far[q.name][1], q.unit) for q in symbols.values() if q.name in own.far),
        )
        placed = replace(placed, numbers=_used(placed)) if law.reaction else placed
        _check(own, placed, to)
        reaction = _reaction(law, placed, names, symbols, scale, fresh)
        if reaction is not None:
            _check(own, reaction, reaction.to)
        read = tuple(r for p in (placed, reaction) if p is not None for r in read_by_outputs(own, p))
        for one in read:
            _check(own, one, one.to)
    except (FormulaError, ValueError, ZeroDivisionError):
        return None
    changed = own.parameters.get(target.name) if law.role in AT_PARAMETERS else None
    domain = domain_of(target.unit if changed is None else own.states[changed.moves[0]].unit, own)
    is_held = law.role in HELD and bool(law.states) and not own.states
    parameters = tuple(_parameter(n, fresh[n.name], scale, symbols, steps.macro_step, is_held) for n in law.numbers)
    label = f"{own.component}.{target.name}"
    what = f"{to} {'*= 1 +' if law.is_share else '+='} {placed.formula}" + "".join(
        f", der({s.name}) = {s.rate}" for s in placed.states
    )
    what += "".join(f", {s.name} = 0 at the begin" for s in placed.states if s.start.startswith("0 * "))
    what += "".join(f", {d.name}(t) = {d.of}(t - {d.by})" for d in placed.delays)
    what += f", {reaction.to} += {reaction.formula}" if reaction is not None else ""
    what += "" if changed is None else "".join(f", or {parameter(n)} alike" for n in changed.alike)
    what += "".join(f", {n} = {v.number:g} {v.unit}".rstrip() for n, v in placed.constants.items())
    what += "".join(f", {i.name} = {i.of}" for i in placed.inputs)
    beside = _beside(own, law, symbols, needed)
    over = OVER.get(law.role, ("o",))[0]
    others = [n for n in dict.fromkeys((beside, symbols[over].name if over in symbols else "")) if n]
    identifier = law.identifier + "".join(f"_of_{n}" for n in others)
    term = Term(identifier, label, domain, parameters, law.is_named, what, is_completing=law.is_completing)
    if law.role in ACROSS:
        beside = ", ".join([*([beside] if law.role is Role.FAR_PORT else []), *(i.of for i in placed.inputs)])
    return Fit(law, placed, term, reaction, beside, read)


def _in_what_is_read(own: Places, fit: Fit) -> Iterator[Fit]:
    """The law in each part of a derivative that an output reads, as a load cell or a flow meter does."""
    if fit.law.is_completing:
        return
    found: dict[str, Placed] = {}
    for placed in fit.every:
        for read in read_in_part(own, placed):
            found.setdefault(read.to, read)
    for output, read in found.items():
        factor = read.constants[FACTOR]
        numbers = (*read.numbers, (SHARE.name, SHARE.unit))
        read = replace(read, formula=f"{SHARE.name} * {read.formula}", numbers=numbers)
        law = f"{fit.term.law}, {output} += {read.formula}, {FACTOR} = {factor.number:g} {factor.unit}".rstrip()
        term = replace(
            fit.term,
            identifier=f"{fit.term.identifier}_of_what_{output}_reads",
            parameters=(*fit.term.parameters, SHARE),
            law=law,
        )
        try:
            _check(own, read, read.to)
        except (FormulaError, ValueError):
            continue
        yield replace(fit, term=term, read=(*fit.read, read), seen_by=output)


def _other_sign(fit: Fit, first: Fit) -> Fit | None:
    """A law without a name that a named one at an input leaves over: with the sign that the named one cannot have.

    An input may count the other way, and what takes energy out of one part may be given to another.
    """
    strength = fit.term.parameters[0]
    if first.law.role not in OVER or first.term.parameters[0].lower < 0.0 or strength.lower >= 0.0:
        return None
    is_positive = first.placed.formula.startswith("-") != fit.placed.formula.startswith("-")
    starts = tuple(dict.fromkeys(abs(s) if is_positive else -abs(s) for s in strength.starts))
    lower, upper = (0.0, strength.upper) if is_positive else (strength.lower, 0.0)
    strength = replace(strength, starts=starts, lower=lower, upper=upper)
    return replace(fit, term=replace(fit.term, parameters=(strength, *fit.term.parameters[1:])))


def _beside(own: Places, law: Law, symbols: Mapping[str, Quantity], needed: Collection[str]) -> str:
    """Name of what a law acts with, where there are several; see `Fit`."""
    if law.reacts_on or "r" in symbols:
        return symbols[law.reacts_on or "r"].name
    if "T_a" in needed and sum(is_of(q, "K") for q in own.inputs.values()) > 1:
        return symbols["T_a"].name  # which of them are the surroundings
    return symbols[_BESIDE[law.role]].name if law.role in _BESIDE else ""


#: Role to the symbol of what there may be several of.
_BESIDE = {Role.PARAMETER: "o", Role.FAR_PARAMETER: "o", Role.FAR_PORT: "y"}


def _references(
    law: Law, symbols: Mapping[str, Quantity], states: Collection[str], taken: Collection[str]
) -> dict[str, tuple[str, PhysicalValue]]:
    """Symbols of a power series that is counted from where the quantity is, with a constant's name and value each.

    The square of an absolute temperature that moves by a hundredth of itself is a large constant and a slope, which
    nothing in the model takes back: a simulation with it runs away before its curvature is seen. An exchange that
    changes with a state is what the model has of it where the state begins, unless that is near 0. So is a parameter,
    but for one that changes with what has passed: a flow counts from 0, and an absolute temperature from a typical one.
    """
    found = {}
    for symbol in law.series_of:
        q, name = symbols[symbol], f"{symbol}_0"
        begins = (law.role in AT_PARAMETERS and not law.states) or (law.role in MODULATED and q.name in states)
        far = BEGUN if begins else FAR
        if abs(q.middle) > far * q.size and name not in taken:
            found[symbol] = name, PhysicalValue(float(f"{q.middle:.4g}"), q.unit)
    return found


def _reaction(
    law: Law,
    placed: Placed,
    names: Mapping[str, str],
    symbols: Mapping[str, Quantity],
    scale: _Scale,
    fresh: Mapping[str, str],
) -> Placed | None:
    """What a law adds to the other part; None where it acts on one alone."""
    if not law.reaction:
        return None
    numbers = tuple((fresh[n.name], scale.unit(n.of)) for n in law.numbers)
    to = f"der({symbols[law.reacts_on].name})"
    found = replace(placed, to=to, formula=renamed(law.reaction, names), numbers=numbers)
    return replace(found, numbers=_used(found))


def _used(placed: Placed) -> tuple[tuple[str, str], ...]:
    """Numbers that the formula of a law without states of its own uses."""
    used = names_in(placed.formula)
    return tuple((name, unit) for name, unit in placed.numbers if name in used)


#: Symbols of products that every place has.
_SCALES = {"rate", "reading", "duration", "T_abs", "o_peak"}


class _Scale:
    """Units and characteristic sizes of products of symbols."""

    def __init__(self, symbols: Mapping[str, Quantity], target: Quantity, is_rate: bool, steps: Times) -> None:
        seconds = registry().Quantity(1.0, "s")
        units = {s: registry().Quantity(1.0, parse_unit(q.unit)) for s, q in symbols.items()}
        sizes = {s: q.size for s, q in symbols.items()}
        units["rate"] = registry().Quantity(1.0, parse_unit(target.unit)) / seconds
        sizes["rate"] = target.rate if is_rate else target.size / steps.reading
        units["reading"], sizes["reading"] = seconds, max(steps.reading, steps.macro_step)
        units["duration"], sizes["duration"] = seconds, steps.duration
        if "T" in symbols:
            units["T_abs"], sizes["T_abs"] = registry().Quantity(1.0, "K"), 300.0
        if "o" in symbols:
            units["o_peak"], sizes["o_peak"] = units["o"], symbols["o"].peak or symbols["o"].size
        self._units, self._sizes = units, sizes

    def unit(self, of: str) -> str:
        found = _evaluated(of, self._units)
        unit = found.units if hasattr(found, "units") else registry().Unit("")
        text = f"{unit:~C}".replace("**", "^")
        return text or "1"

    def size(self, of: str) -> float:
        return float(_evaluated(of, self._sizes))


def _evaluated(of: str, values: Mapping[str, object]) -> Any:
    """A product of powers of symbols."""
    tree = ast.parse(of, mode="eval")
    return eval(compile(tree, "<law>", "eval"), {"__builtins__": {}}, dict(values))  # our own texts alone


def _check(own: Places, placed: Placed, to: str) -> None:
    """Whether the co-simulation will take the formula, units and all."""
    every = (*own.states.values(), *own.inputs.values(), *own.outputs.values(), *own.readings.values())
    every += tuple(q for q, _ in own.far.values())
    units = {q.name: q.unit for q in every} | dict.fromkeys(map(parameter, own.parameters), "1")
    units |= own.output_units
    units |= {"time": "s", **dict(placed.numbers), **{n: v.unit for n, v in placed.constants.items()}}
    units |= {s.name: s.unit for s in placed.states}
    units |= {d.name: units[d.of] for d in placed.delays}
    target = to[4:-1] if to.startswith("der(") else to
    rate = "1" if placed.is_share else f"({units[target]})/s"
    Formula(placed.formula, units, rate if to.startswith("der(") else units[target])
    for state in placed.states:
        Formula(state.rate, units, f"({state.unit})/s")
        Formula(state.start, units, state.unit)


def _parameter(
    number: Number, name: str, scale: _Scale, symbols: Mapping[str, Quantity], macro_step: float, is_held: bool
) -> TermParameter:
    size = scale.size(number.of)
    lower = size * (-number.most if number.least is None else number.least)
    upper = size * number.most
    starts = tuple(size * s for s in number.starts)
    if number.origin:
        quantity = symbols[number.origin]
        starts = tuple(quantity.value_at(s) for s in number.starts)
        lower = min(quantity.middle + lower, quantity.value_at(0.0))
        upper = max(quantity.middle + upper, quantity.value_at(1.0))
    negligible = _negligible(number, scale, symbols, macro_step)
    return TermParameter(
        name,
        scale.unit(number.of),
        lower,
        upper,
        starts,
        negligible=negligible,
        resolution=0.5 * negligible / math.sqrt(3.0) if is_held else 0.0,
        meaning=number.meaning,
        is_reading=bool(number.origin),
    )


def _negligible(number: Number, scale: _Scale, symbols: Mapping[str, Quantity], macro_step: float) -> float:
    """Size of a number by which a law is late by no more than a macro-step: values that pass between FMUs are too."""
    if scale.unit(number.of) == "s":
        return macro_step
    if "u" in symbols and scale.unit(f"({number.of}) * u") == "s":  # time for each unit of an input's way
        return macro_step * scale.size("1 / u")
    return 0.0


def _form(placed: Placed) -> str:
    """The formula with its strength renamed and its sign dropped: laws of the same form and start are one."""
    first = placed.numbers[0][0]
    text = renamed(placed.formula, {first: "strength"})
    text = text.removeprefix("-")
    return (
        text
        + "".join(f"; {s.rate} from {s.start}" for s in placed.states)
        + "".join(f"; {d.of}, {d.by}" for d in placed.delays)
    )


def domain_of(unit: str, own: Places) -> str:
    """Part of physics that a unit belongs to; `other` where a length or a rate belongs to no mechanism.

    The level of a tank is a length, and its FMU has nothing that moves. All lengths of an FMU are of one part.

    Args:
        unit: Of the quantity that a law acts on.
        own: Quantities of its FMU.
    """
    for domain, units in _DOMAINS.items():
        if _has_dimension(unit, units):
            return domain if domain != "mechanical" or _is_mechanism(own) else "other"
    return "signal"


def _is_mechanism(own: Places) -> bool:
    """Whether an FMU has a velocity, a force, a torque or an angle."""
    every = (*own.states.values(), *own.inputs.values(), *own.outputs.values())
    return bool(own.velocity_of) or any(
        _has_dimension(q.unit, _MOVING) or any(word in q.unit for word in _ANGLES) for q in every
    )


def _has_dimension(unit: str, units: Sequence[str]) -> bool:
    dimension = parse_unit(unit).dimensionality
    return any(dimension == parse_unit(u).dimensionality for u in units)


#: Units that only a mechanism has, and words in units of angles, which have no dimension.
_MOVING = ("m/s", "N", "m/s^2")
_ANGLES = ("rad", "deg/", "rpm", "rev")


_DOMAINS = {
    "mechanical": ("m", "m/s", "rad/s", "N", "N*m", "m/s^2", "rad/s^2"),
    "thermal": ("K", "J", "W"),
    "electrical": ("A", "V", "C", "Wb"),
    "hydraulic": ("m^3", "Pa", "m^3/s", "kg/s"),
}
