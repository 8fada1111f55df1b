"""One case: recordings of a rig with concealed effects, as a laboratory would have them, and the answer apart."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cosim.unit.protocol import Array
from evaluation.systems.effects import Effect, composed, effects_of
from evaluation.systems.rigs import RIGS, Rig

#: Kinds of cases with their shares.
KINDS = {"null": 0.25, "single": 0.3, "two": 0.1, "hidden": 0.1, "composed": 0.15, "fault": 0.1}
#: Standard deviation of ln(number) of the truth from what the model says.
OFF = 0.03
#: Steps of the truth's integration between two readings.
INNER = 8
#: Draws of a case of which the truth may run away.
TRIES = 10
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
    """

    kind: str
    rig: str
    places: list[str]
    answers: list[list[str]]
    without: list[str]


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


def course(rig: Rig, numbers: dict[str, float], inputs: Array, effects: list[Effect]) -> Array:
    """The truth: classical Runge-Kutta steps with inputs held, shape (samples, states)."""
    x, h = start(rig), rig.step / INNER
    states = [x]

    def rate(y: Array, u: Array) -> Array:
        found = rig.rates(numbers, y, u)
        for effect in effects:
            found[effect.state] += effect.added(y, u)
        return found

    for u in inputs[:-1]:
        for _ in range(INNER):
            a = rate(x, u)
            b = rate(x + 0.5 * h * a, u)
            c = rate(x + 0.5 * h * b, u)
            x = x + h / 6.0 * (a + 2.0 * (b + c) + rate(x + h * c, u))
        states.append(x)
    return np.array(states)


def make(folder: Path, kind: str, seed: int, number: int) -> Case:
    """Write scenario, FMUs and recordings into `task`, the answer into `answer.json`.

    Raises:
        RuntimeError: Every truth that was drawn runs away.
    """
    for again in range(TRIES):
        try:
            return _make(folder, kind, [seed, number, *([again] if again else [])], number)
        except (OverflowError, FloatingPointError):
            continue  # a spring that softens may throw the mass out
    raise RuntimeError(f"case {number + 1}: every truth runs away")


def _make(folder: Path, kind: str, seed: list[int], number: int) -> Case:
    rng = np.random.default_rng(seed)
    rig = RIGS[number % len(RIGS)]
    numbers = {n: v * float(np.exp(OFF * rng.standard_normal())) for n, v in rig.numbers.items()}
    plain = drive(rig, rng)
    states = course(rig, dict(rig.numbers), plain, [])
    rates = np.array([rig.rates(rig.numbers, x, u) for x, u in zip(states, plain)])
    known = effects_of(rig, states, rates, plain, rng)
    effects: list[Effect] = []
    if kind in ("single", "hidden"):
        effects = [known[int(rng.integers(len(known)))]]
    elif kind == "two":
        effects = [known[int(i)] for i in rng.choice(len(known), 2, replace=False)]
    elif kind == "composed":
        effects = [composed(rig, states, rates, rng)]
    task = folder / "task"
    task.mkdir(parents=True, exist_ok=True)
    for model in rig.models.values():
        model.build(task)
    (task / "scenario.yaml").write_text(rig.scenario(), encoding="utf-8")
    sizes = np.std(states, axis=0)
    for i, name in enumerate(RECORDINGS):
        inputs = plain if i == 0 else drive(rig, rng)
        truth = course(rig, numbers, inputs, effects)
        if not np.isfinite(truth).all():
            raise FloatingPointError("the truth runs away")
        _write(task / name, rig, inputs, truth, sizes, rng, kind == "fault" and i == 1)
    case = Case(
        kind,
        rig.name,
        [rig.states[e.state] for e in effects],
        [list(e.answers) for e in effects],
        [a for e in effects for a in e.answers] if kind == "hidden" else [],
    )
    (folder / "answer.json").write_text(json.dumps(case.__dict__, indent=1), encoding="utf-8")
    return case


def _write(
    folder: Path, rig: Rig, inputs: Array, truth: Array, sizes: Array, rng: np.random.Generator, is_faulty: bool
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
        if is_faulty and i == 0:
            first, last = sorted(rng.integers(rig.count // 6, rig.count, 2).tolist())
            last = max(last, first + rig.count // 8)
            values[first:last] += 0.4 * float(sizes[state])
        columns[f"y{i + 1}"] = values
        lines.append(f"  {name}: {{column: y{i + 1}, unit: {unit}, noise: {noise:.4g} {unit}}}")
    table = np.column_stack(list(columns.values()))
    np.savetxt(folder / "data.csv", table, delimiter=",", header=",".join(columns), comments="", fmt="%.10g")
    (folder / "recording.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
