"""One case: recordings of a rig with concealed effects, as a laboratory would have them, and the answer apart."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cosim.unit.protocol import Array
from evaluation.systems.effects import (
    AT_INPUT,
    Course,
    Effect,
    composed,
    effects_inside,
    effects_of_actuators,
    with_memory,
)
from evaluation.systems.rigs import RIGS, Rig

#: Kinds of cases with their shares. hidden: a law that the library is without; memory: a hidden state with its own
#: equation, of which the library is without a name; composed: a law put together at random; fault: of one stretch of
#: one recording, no physics.
KINDS = {"null": 0.22, "single": 0.26, "two": 0.1, "hidden": 0.08, "memory": 0.08, "composed": 0.12, "fault": 0.14}
#: Faults, in turn by chance.
FAULTS = ("sensor offset", "sensor stuck", "wild readings", "input gain")
#: Standard deviation of ln(number) of the truth from what the model says.
OFF = 0.03
#: Steps of the truth's integration between two readings.
INNER = 8
#: Draws of a case of which the truth may run away.
TRIES = 10
#: Standard deviation of a state of the truth over that of the model, beyond which nobody would record the rig.
WILDEST = 5.0
RECORDINGS = ("first", "second", "third")


@dataclass(frozen=True)
class Case:
    """What was made.

    Args:
        kind: See `KINDS`.
        rig: Its name.
        places: Where effects act.
        answers: Of each effect, the identifiers that name it rightly.
        without: Laws that the library must not know.
        fault: See `FAULTS`; empty: none.
    """

    kind: str
    rig: str
    places: list[str]
    answers: list[list[str]]
    without: list[str]
    fault: str = ""


def drive(rig: Rig, rng: np.random.Generator) -> Array:
    """Inputs of one recording, shape (samples, inputs): steps of random height; a room outside follows the day."""
    columns = []
    for unit, size in rig.inputs.values():
        if unit == "K":
            phase = rng.uniform(0.0, 6.28)
            columns.append(278.0 + size * np.sin(np.arange(rig.count) / rig.count * 9.0 + phase))
            continue
        values, level = np.empty(rig.count), 0.0
        place = 0
        while place < rig.count:
            length = int(rng.integers(rig.dwell // 2, 3 * rig.dwell // 2))
            level = float(rng.uniform(0.1, 1.0) if unit in ("W", "m^3/s") else rng.uniform(-1.0, 1.0))
            values[place : place + length] = size * level
            place += length
        columns.append(values)
    return np.stack(columns, axis=1)


def start(rig: Rig) -> Array:
    """States at the start."""
    found = []
    for name in rig.states:
        component, _, state = name.partition(".")
        text = rig.models[component].states[state][1]
        found.append(float(rig.models[component].parameters.get(text, (text, ""))[0]))
    return np.array(found)


def course(rig: Rig, numbers: dict[str, float], inputs: Array, effects: Sequence[Effect]) -> Array:
    """The truth: classical Runge-Kutta steps with inputs held, shape (samples, states)."""
    count, h = len(rig.states), rig.step / INNER
    own = [e for e in effects if e.own_rate is not None]
    fine = np.repeat(inputs[:-1], INNER, axis=0)
    for effect in effects:
        if effect.passed is not None:
            fine[:, effect.port] = effect.passed(fine[:, effect.port].copy(), h)
    x = np.concatenate([start(rig), [e.own_start for e in own]])
    states = [x[:count]]

    def rate(y: Array, u: Array) -> Array:
        found = np.concatenate([rig.rates(numbers, y[:count], u), np.zeros(len(own))])
        for effect in effects:
            memory = float(y[count + own.index(effect)]) if effect in own else 0.0
            if effect.added is not None:
                found[effect.state] += effect.added(y[:count], u, memory)
            if effect.own_rate is not None:
                found[count + own.index(effect)] = effect.own_rate(y[:count], u, memory)
        return found

    for number, u in enumerate(fine):
        a = rate(x, u)
        b = rate(x + 0.5 * h * a, u)
        c = rate(x + 0.5 * h * b, u)
        x = x + h / 6.0 * (a + 2.0 * (b + c) + rate(x + h * c, u))
        if (number + 1) % INNER == 0:
            states.append(x[:count])
    return np.array(states)


def make(folder: Path, kind: str, seed: int, number: int) -> Case:
    """Write scenario, FMUs and recordings into `task`, the answer into `answer.json`.

    Raises:
        RuntimeError: Every truth that was drawn runs away.
    """
    for again in range(TRIES):
        try:
            with np.errstate(over="raise", invalid="raise"):
                return _make(folder, kind, [seed, number, *([again] if again else [])], number)
        except (OverflowError, FloatingPointError):
            continue  # a spring that softens may throw the mass out
    raise RuntimeError(f"case {number + 1}: every truth runs away")


def _drawn(kind: str, rig: Rig, plain: Course, rng: np.random.Generator) -> tuple[list[Effect], list[str]]:
    """Effects of a case, and laws that the library must not know."""
    inside, actuators = effects_inside(rig, plain, rng), effects_of_actuators(rig, plain)
    #: Effects that have a law of their name at their place: inside an FMU that hides its states there is none.
    known = [e for e in (*inside, *actuators) if e.place.partition(".")[0] not in rig.hidden or e.passed is not None]
    known += [e for e in inside if e not in known and e.name in AT_INPUT]
    if kind == "single":
        return [known[int(rng.integers(len(known)))]], []
    if kind == "two":
        return [known[int(i)] for i in rng.choice(len(known), 2, replace=False)], []
    if kind == "hidden":
        unseen = [e for e in inside if e not in known]
        one = (unseen or inside)[int(rng.integers(len(unseen or inside)))]
        return [one], [] if unseen else list(one.answers)
    if kind == "memory":
        one = with_memory(rig, plain, rng)
        return [one], list(one.answers)
    return ([composed(rig, plain, rng)] if kind == "composed" else []), []


def _make(folder: Path, kind: str, seed: list[int], number: int) -> Case:
    rng = np.random.default_rng(seed)
    rig = RIGS[number % len(RIGS)]
    numbers = {n: v * float(np.exp(OFF * rng.standard_normal())) for n, v in rig.numbers.items()}
    plain = drive(rig, rng)
    states = course(rig, dict(rig.numbers), plain, [])
    rates = np.array([rig.rates(rig.numbers, x, u) for x, u in zip(states, plain)])
    effects, without = _drawn(kind, rig, Course(states, rates, plain), rng)
    fault = str(rng.choice(FAULTS)) if kind == "fault" else ""
    task = folder / "task"
    task.mkdir(parents=True, exist_ok=True)
    for model in rig.models.values():
        model.build(task)
    (task / "scenario.yaml").write_text(rig.scenario(), encoding="utf-8")
    sizes = np.std(states, axis=0)
    for i, name in enumerate(RECORDINGS):
        inputs = plain if i == 0 else drive(rig, rng)
        stretch = _stretch(rig, rng)
        driven = inputs.copy()
        if fault == "input gain" and i == 1:
            driven[stretch, next(iter(rig.driven()))] *= 1.3
        truth = course(rig, numbers, driven, effects)
        if not np.isfinite(truth).all() or (np.std(truth, axis=0) > WILDEST * sizes).any():
            raise FloatingPointError("the truth runs away")
        _write(task / name, rig, inputs, truth, sizes, rng, (fault, stretch) if i == 1 else ("", stretch))
    case = Case(kind, rig.name, [e.place for e in effects], [list(e.answers) for e in effects], without, fault)
    (folder / "answer.json").write_text(json.dumps(case.__dict__, indent=1), encoding="utf-8")
    return case


def _stretch(rig: Rig, rng: np.random.Generator) -> slice:
    """Samples of a fault: an eighth of the recording at least."""
    first, last = sorted(rng.integers(rig.count // 6, rig.count, 2).tolist())
    return slice(first, max(last, first + rig.count // 8))


def _faulty(values: Array, fault: str, stretch: slice, size: float, rng: np.random.Generator) -> Array:
    """Readings of the first channel with a fault of its sensor."""
    found = values.copy()
    if fault == "sensor offset":
        found[stretch] += 0.4 * size
    elif fault == "sensor stuck":
        found[stretch] = values[stretch.start]
    elif fault == "wild readings":
        wild = rng.choice(len(values), len(values) // 60, replace=False)
        found[wild] += rng.choice([-1.0, 1.0], len(wild)) * rng.uniform(1.0, 3.0, len(wild)) * size
    return found


def _write(
    folder: Path,
    rig: Rig,
    inputs: Array,
    truth: Array,
    sizes: Array,
    rng: np.random.Generator,
    fault: tuple[str, slice],
) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    times = rig.step * np.arange(rig.count)
    columns = {"t": times, **{f"u{i + 1}": inputs[:, i] for i in range(inputs.shape[1])}}
    lines = [f"title: {folder.name}", "source: made", "table: data.csv", "time: {column: t, unit: s}", "inputs:"]
    for i, (name, (unit, _)) in enumerate(rig.inputs.items()):
        lines.append(f"  {name}: {{column: u{i + 1}, unit: {unit}}}")
    lines.append("channels:")
    for i, (name, state) in enumerate(rig.outputs.items()):
        unit, share = rig.channels[name]
        noise = share * float(sizes[state])
        values = truth[:, state] + noise * rng.standard_normal(rig.count)
        if i == 0:
            values = _faulty(values, *fault, float(sizes[state]), rng)
        columns[f"y{i + 1}"] = values
        lines.append(f"  {name}: {{column: y{i + 1}, unit: {unit}, noise: {noise:.4g} {unit}}}")
    table = np.column_stack(list(columns.values()))
    np.savetxt(folder / "data.csv", table, delimiter=",", header=",".join(columns), comments="", fmt="%.10g")
    (folder / "recording.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
