"""How strong a composed law must be: what a recalibration leaves of it in readings that it was not fitted to.

Many copies of a rig stand side by side and run as one: a plain one, one for each parameter that a recalibration may
move, and one for each strength. Strings on a stiff supply do not know of each other, so the copies stay apart. The
parameters are moved by a straight line (finite differences), with the scatter of `drawn_rig` as their priors.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from evaluation.proving.composed.effect import Composed, Distortion
from evaluation.proving.composed.law import Scale
from evaluation.proving.effects.effect import Effect
from evaluation.proving.programme import Programme
from evaluation.proving.rig import ROOM, Array, Rig
from evaluation.proving.sensors import Sensors, variables_of
from evaluation.proving.setups import Setup
from evaluation.proving.truth import Trace, Truth

#: Chi-square per sample that a recalibration is to leave in the held-out recording.
LEFT = (2.0, 20.0)
#: What a first search aims between, so that the finer truth ends within `LEFT`.
AIM = (2.4, 16.0)
#: Chi-square per sample that must be left in training too: a law that only the last recording shows cannot be learnt.
LEAST_IN_TRAINING = 1.3
#: Step of finite differences: relative, [K] for temperatures, [s] for clocks.
_STEP = {"resistance": 0.01, "conductance": 0.01, "capacity": 0.01, "stiffness": 0.01, "shift": 0.3, "room": 0.3}
#: Standard deviation by which a recalibration may move them: own and shared scatter of `drawn_rig` together.
_PRIOR = {
    "resistance": 0.022,
    "conductance": 0.042,
    "capacity": 0.028,
    "stiffness": 0.015,
    "shift": 0.54,
    "room": 0.3,
    "clock": 0.1,
}
#: Readings this close to a switch are not judged [s].
_MARGIN = 0.3


@dataclass(frozen=True)
class Fineness:
    """How finely a truth is solved.

    Args:
        cells: Pieces of each wire.
        step: Longest step, as a factor on the rig's.
    """

    cells: int
    step: float


COARSE, FINE = Fineness(3, 2.5), Fineness(12, 1.0)


@dataclass(frozen=True)
class Left:
    """Chi-square per sample that a recalibration leaves, noise included (1).

    Args:
        training: In the recordings that it was fitted to.
        held_out: In the one that it was not.
    """

    training: float
    held_out: float


class Gauge:
    """Measures composed laws on one rig with its programmes and sensors.

    Args:
        setup: The kind of rig.
        rig: Its true numbers.
        sensors: By kind.
        programmes: Two to learn from and one to judge by.
    """

    def __init__(self, setup: Setup, rig: Rig, sensors: Mapping[str, Sensors], programmes: Sequence[Programme]) -> None:
        self.setup, self.rig, self.sensors, self.programmes = setup, rig, dict(sensors), tuple(programmes)
        self._moments = [_moments(p, self.sensors) for p in self.programmes]
        self._plain: list[Trace] = []
        self._columns = [self._jacobian(p, m) for p, m in zip(self.programmes, self._moments)]
        training = np.concatenate(self._columns[:-1])
        self._normal = training.T @ training + np.eye(training.shape[1])

    def scales(self, names: Sequence[str]) -> dict[str, Scale]:
        """Scales of variables by what the plain rig makes of them in training; those that stand still are left out."""
        courses = [_courses(t) for t in self._plain[:-1]]
        found = {}
        for name in names:
            values = np.concatenate([c[name].ravel() for c in courses])
            zero = {"warmth": ROOM, "extension": float(np.median(values))}.get(name, 0.0)
            size = float(np.quantile(np.abs(values - zero), 0.98))
            if name == "time":
                size = self.setup.stop
            if size > 1e-9:
                found[name] = Scale(_SYMBOLS[name], zero, size, name in ("rate", "speed", "extension"))
        return found

    def scales_of_reading(self, kind: str, names: Sequence[str]) -> dict[str, Scale]:
        """Scales of the variables of what sensors of a kind read."""
        own = np.concatenate([t.states[kind].ravel() for t in self._plain[:-1]])
        zero = ROOM if kind == "temperature" else 0.0
        size = float(np.quantile(np.abs(own - zero), 0.98))
        return self.scales([n for n in names if n != "own"]) | {"own": Scale(_SYMBOLS["own"], zero, size)}

    def left(self, effects: Sequence[Effect], amounts: Sequence[float], fineness: Fineness = COARSE) -> list[Left]:
        """What recalibrations leave of effects times each of these amounts.

        Raises:
            WireError: With one of the amounts the temperatures do not converge.
        """
        changes = []
        for programme, moments in zip(self.programmes, self._moments):
            traces = self._side_by_side(programme, effects, [0.0, *amounts], fineness)
            seen = [self._scaled(t, moments) for t in traces]
            changes.append(np.stack([s - seen[0] for s in seen[1:]], axis=1))
        return self._judged(changes)

    def left_of_reading(self, kind: str, distortion: Distortion) -> Left:
        """The same of what is added to readings."""
        changes = []
        for trace, moments in zip(self._plain, self._moments):
            added = distortion.along(trace.time, variables_of(trace, kind))
            parts = []
            for name, times in moments.items():
                columns = added if name == kind else np.zeros((trace.time.size, len(self.sensors[name].names)))
                parts.append((_at(trace.time, columns, times) / self._noise(name)).ravel())
            changes.append(np.concatenate(parts)[:, None])
        return self._judged(changes)[0]

    def _judged(self, changes: Sequence[Array]) -> list[Left]:
        right = sum(j.T @ d for j, d in zip(self._columns[:-1], changes[:-1]))
        moved = np.linalg.solve(self._normal, np.asarray(right))
        rests = [d - j @ moved for j, d in zip(self._columns, changes)]
        training = np.mean(np.concatenate(rests[:-1]) ** 2, axis=0)
        held_out = np.mean(rests[-1] ** 2, axis=0)
        training, held_out = (np.where(np.isfinite(v), v, np.inf) for v in (training, held_out))
        return [Left(1.0 + float(t), 1.0 + float(h)) for t, h in zip(training, held_out)]

    def _noise(self, kind: str) -> float:
        sensors = self.sensors[kind]
        return float(np.hypot(sensors.noise, sensors.kind.quantum / np.sqrt(12.0)))

    def _scaled(self, trace: Trace, moments: Mapping[str, Array], late: float = 0.0) -> Array:
        """All readings without their noise, in units of it."""
        return np.concatenate([v.ravel() for v in self._readings(trace, moments, late).values()])

    def _readings(self, trace: Trace, moments: Mapping[str, Array], late: float = 0.0) -> dict[str, Array]:
        """By kind, in units of the noise, shape (moments, channels)."""
        return {
            k: _at(*trace.signal(k), np.maximum(times - late, 0.0)) / self._noise(k) for k, times in moments.items()
        }

    def _side_by_side(
        self,
        programme: Programme,
        effects: Sequence[Effect],
        amounts: Sequence[float],
        fineness: Fineness,
        rigs: Sequence[Rig] = (),
    ) -> list[Trace]:
        """Traces of copies of the rig, each with the effects times its amount, or each with numbers of its own."""
        copies = list(rigs) or [self.rig] * len(amounts)
        stacked = _stacked(copies)
        every = [_spread(e, amounts) for e in effects]
        with np.errstate(over="ignore", invalid="ignore"):  # of amounts that are far too large
            trace = Truth(stacked, every, fineness.cells).run(
                _repeated(programme, len(copies)), fineness.step * self.setup.step
            )
        return [_part(trace, self.rig, n) for n in range(len(copies))]

    def _jacobian(self, programme: Programme, moments: Mapping[str, Array]) -> Array:
        """Change of every reading by one prior deviation of every parameter, shape (readings, parameters)."""
        rig, sheet = self.rig, self.rig.sheet
        coils, place, string = sheet.coils, sheet.place_in_string, sheet.string_of_coil
        is_electric = not (sheet.is_bath or sheet.is_driven_by_power)
        names = [n for n in ("conductance", "capacity", "stiffness") if n != "stiffness" or "extension" in self.sensors]
        changed = [replace(rig, **{n: getattr(rig, n) * (1.0 + _STEP[n])}) for n in names]
        if "extension" in self.sensors:
            names.append("shift")
            changed.append(replace(rig, shift=rig.shift + _STEP["shift"]))
        changed.append(replace(rig, room=rig.room + _STEP["room"]))
        depths = range(max(sheet.strings)) if is_electric else ()
        changed += [
            replace(rig, resistance=rig.resistance * (1.0 + _STEP["resistance"] * (place == d))) for d in depths
        ]
        traces = self._side_by_side(programme, (), [0.0] * (1 + len(changed)), COARSE, [rig, *changed])
        self._plain.append(traces[0])
        plain = self._readings(traces[0], moments)
        change = [{k: v - plain[k] for k, v in self._readings(t, moments).items()} for t in traces[1:]]
        columns = []
        for name, found in zip(names, change):
            columns += [_only(found, (c,), ()) * _PRIOR[name] / _STEP[name] for c in range(coils)]
        columns.append(_only(change[len(names)]) * _PRIOR["room"] / _STEP["room"])
        for d, found in zip(depths, change[len(names) + 1 :]):
            for s in np.unique(string[place == d]).tolist():
                one = _only(found, tuple(np.flatnonzero(string == s).tolist()), (s,))
                columns.append(one * _PRIOR["resistance"] / _STEP["resistance"])
        late = self._readings(traces[0], moments, 0.05)
        for kind in moments:
            moved = {k: (late[k] - plain[k]) * (k == kind) for k in moments}
            columns.append(_only(moved) * _PRIOR["clock"] / 0.05)
        return np.stack(columns, axis=1)


_SYMBOLS = {
    "warmth": "T",
    "power": "P",
    "current": "I",
    "rate": "d(T)",
    "time": "t",
    "phase": "phase",
    "extension": "extension",
    "speed": "d(extension)",
    "own": "truth",
}


def _only(found: Mapping[str, Array], coils: tuple[int, ...] = (), strings: tuple[int, ...] = ()) -> Array:
    """All readings as one column, or those of some coils and strings alone (and what these add to the supply)."""
    if not coils:
        return np.concatenate([v.ravel() for v in found.values()])
    parts = []
    for kind, values in found.items():
        kept = np.zeros_like(values)
        chosen = {"string": strings, "supply": ()}.get(kind, coils)
        kept[:, list(chosen)] = values[:, list(chosen)]
        if kind == "supply" and strings:  # the currents of the strings add up; the other strings keep theirs
            kept[:, 0] = values[:, 0] / max(found["string"].shape[1], 1)
        parts.append(kept.ravel())
    return np.concatenate(parts)


def _moments(programme: Programme, sensors: Mapping[str, Sensors]) -> dict[str, Array]:
    """Times at which readings are compared, half as many as the sensors have, by kind."""
    found = {}
    for name, network in sensors.items():
        times = np.arange(0.5 / network.kind.rate, programme.stop, 2.0 / network.kind.rate)
        if not programme.is_ramped:
            away = np.abs(times[:, None] - programme.times[None, :]).min(axis=1)
            times = times[away > _MARGIN]
        found[name] = times
    return found


def _at(knots: Array, values: Array, times: Array) -> Array:
    """Courses that are straight between their knots, at some times, shape (times, columns)."""
    right = np.clip(np.searchsorted(knots, times, side="right"), 1, knots.size - 1)
    low, high = knots[right - 1], knots[right]
    share = np.clip((times - low) / np.maximum(high - low, 1e-12), 0.0, 1.0)[:, None]
    return np.asarray((1.0 - share) * values[right - 1] + share * values[right])


def _stacked(rigs: Sequence[Rig]) -> Rig:
    sheet = rigs[0].sheet
    together = replace(sheet, strings=sheet.strings * len(rigs))
    arrays = {
        n: np.concatenate([getattr(r, n) for r in rigs])
        for n in ("resistance", "conductance", "capacity", "weight", "stiffness", "shift", "end", "thermometer")
    }
    room = np.concatenate([np.broadcast_to(np.asarray(r.room, dtype=np.float64), sheet.coils) for r in rigs])
    return Rig(
        sheet=together,
        room=room,
        slew=rigs[0].slew,
        duhem=rigs[0].duhem,
        spread=rigs[0].spread,
        **arrays,
    )


def _repeated(programme: Programme, copies: int) -> Programme:
    if programme.levels.ndim == 1:
        return programme
    return replace(programme, levels=np.tile(programme.levels, (1, copies)))


def _spread(effect: Effect, amounts: Sequence[float]) -> Effect:
    """The effect on copies side by side, times an amount in each."""
    assert isinstance(effect, Composed), "only composed laws are measured"
    amount = np.concatenate([a * effect.place.amount for a in amounts])
    return Composed(replace(effect.place, amount=amount), effect.target, effect.composition)


def _part(trace: Trace, rig: Rig, number: int) -> Trace:
    """What one of the copies did; its supply gives the sum of its strings."""
    coils, strings = rig.sheet.coils, len(rig.sheet.strings)
    at = {"string": slice(number * strings, (number + 1) * strings)}
    own = slice(number * coils, (number + 1) * coils)
    flows = {n: v[:, :, at.get(n, own)] for n, v in trace.flows.items() if n != "supply"}
    flows["supply"] = flows["string"].sum(axis=2, keepdims=True)
    return Trace(trace.time, {n: v[:, own] for n, v in trace.states.items()}, flows, trace.ambient[:, own])


def _courses(trace: Trace) -> dict[str, Array]:
    """Variables of laws at the ends of steps, shape (steps + 1, coils)."""
    found = variables_of(trace, "temperature")
    sizes = np.maximum(np.diff(trace.time), 1e-9)[:, None]
    found["rate"] = np.diff(found["warmth"], axis=0) / sizes
    found["speed"] = np.diff(trace.states["extension"], axis=0) / sizes
    found["extension"] = trace.states["extension"]
    found["phase"] = np.clip((trace.states["stiffness"] - 157.1) / 230.5, 0.0, 1.0)
    return found
