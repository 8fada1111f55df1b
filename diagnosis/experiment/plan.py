"""Shapes to programmes of a rig: in its units, on its grid of times, within its limits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.experiment.bench import Bench, Conditions
from diagnosis.experiment.drivers import Driver, Rig, drive
from diagnosis.experiment.programmes import Levels, Shape
from diagnosis.judge.next_experiment import Course

#: Coils may get this much hotter than in the recordings by the model's word [K].
HOTTER = 2.0
#: Zero of the temperature scale of the stiffness law [K] (fmus/thermal_stiffness: T in degC).
_ZERO = 273.15
#: Width of a branch of the stiffness in 1/c: from 5 % to 95 % of a logistic function.
_BRANCH = 3.0


def courses(rig: Rig, shape: Shape) -> tuple[Course, ...]:
    """A shape in the units of each driver, on the grid of macro-steps, values rounded to a thousandth of the range."""
    found, begin = [], 0
    for driver in rig.drivers:
        width = max(driver.columns, 1)
        values = driver.values(np.clip(shape.heat[:, begin : begin + width], 0.0, 1.0))
        begin += width
        step = 10.0 ** np.floor(np.log10(1e-3 * (driver.highest - driver.lowest)))
        values = np.clip(step * np.round(values / step), driver.lowest, driver.highest)
        found.append(_course(driver, rig, shape, values))
    return tuple(found)


def _course(driver: Driver, rig: Rig, shape: Shape, values: Array) -> Course:
    times, is_linear = shape.times, shape.is_linear
    if np.isfinite(driver.slew):
        times, values = _slowed(times, values, driver.slew, shape)
        is_linear = True
    steps = np.maximum.accumulate(np.round(times / rig.macro_step).astype(int))
    kept = np.concatenate([np.diff(steps) > 0, [True]])
    instants = tuple(float(f"{rig.start + k * rig.macro_step:.12g}") for k in steps[kept])
    rows = tuple(tuple(float(f"{v:.10g}") for v in row) for row in values[kept])
    return Course(driver.component, driver.output, driver.unit, instants, rows, is_linear)


def _slowed(times: Array, values: Array, slew: float, shape: Shape) -> tuple[Array, Array]:
    """Corners of a course that follows another as fast as it may."""
    knots, rows = [0.0], [values[0]]
    for i, row in enumerate(values):
        end = times[i + 1] if i + 1 < len(times) else shape.duration
        if shape.is_linear:
            end = times[i]
        here, now = rows[-1], knots[-1]
        if end <= now:
            continue
        needed = float(np.max(np.abs(row - here))) / slew
        share = min(1.0, (end - now) / needed) if needed > 0.0 else 1.0
        reached = here + share * (row - here)
        if not shape.is_linear and 0.0 < needed < end - now:
            knots.append(now + needed)
            rows.append(reached)
        knots.append(end)
        rows.append(reached)
    return np.array(knots), np.array(rows)


class Planner:
    """Makes conditions from shapes and keeps them within what the coils stood so far.

    Args:
        rig: What can be driven.
        bench: Simulates.
    """

    def __init__(self, rig: Rig, bench: Bench) -> None:
        self.rig, self.bench = rig, bench
        translations = [r.translation for r in bench.model.runs]
        self._like = translations[0]
        ambient = self._like.drive.ambient.values
        self.ambient = float(np.min(ambient))
        self.hottest = max(float(bench.temperatures(Conditions(t.drive, rig.duration)).max()) for t in translations)

    def conditions(self, shape: Shape, load: float | None = None) -> tuple[tuple[Course, ...], Conditions] | None:
        """Programmes and what they do, scaled down where coils would get too hot; None where that does not help."""
        for _ in range(3):
            made = courses(self.rig, shape)
            duration = self.rig.macro_step * np.floor(shape.duration / self.rig.macro_step + 1e-9)
            conditions = Conditions(drive(self.rig, made, self._like), float(duration), load)
            hottest = float(self.bench.temperatures(conditions).max())
            if hottest <= self.hottest + HOTTER:
                return made, conditions
            # how much too hot one is that runs away is not known
            less = (self.hottest - self.ambient) / (hottest - self.ambient) if np.isfinite(hottest) else 0.5
            shape = replace(shape, heat=shape.heat * less)
        return None

    def levels(self) -> Levels:
        """Shares of heating at which these coils stay below or within their transformation."""
        base = self._like.parameters.base
        if not all(float(np.max(np.asarray(base.get(f"{b}_c", 0.0)))) > 0.0 for b in ("heating", "cooling")):
            return Levels()
        middle, width = {}, {}
        for branch in ("heating", "cooling"):
            slope, factor = (float(np.mean(np.asarray(base[f"{branch}_{k}"]))) for k in ("c", "b"))
            middle[branch], width[branch] = _ZERO + np.log(max(factor, 1e-300)) / slope, 1.0 / slope
        soak = Shape("", np.array([0.0]), np.ones((1, self.rig.columns)), 3.0 * self.rig.duration)
        made = courses(self.rig, soak)
        reached = float(self.bench.temperatures(Conditions(drive(self.rig, made, self._like), soak.duration)).max())
        if not np.isfinite(reached):
            return Levels()
        span = reached - self.ambient
        # From the cold only the heating branch matters; back from within it, the middle of the cooling branch.
        below = (middle["heating"] - _BRANCH * width["heating"] - self.ambient) / span
        low, high = ((t - self.ambient) / span for t in (middle["cooling"], middle["heating"] + width["heating"]))
        if not 0.05 < below < 1.0:
            return Levels()
        return Levels(below, min(max(low, 0.05), 0.9), min(high, 1.0))
