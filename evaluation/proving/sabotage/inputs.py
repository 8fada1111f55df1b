"""Something else was done than the recording says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from evaluation.proving.programme import Programme, delayed, offset
from evaluation.proving.sabotage.sabotage import OF_INPUT, OF_STRUCTURE, Bench, Sabotage

_BENCHES: tuple[str, ...] = ("network", "small", "zones", "bath", "heaters")
#: Readings of a recorded input per second: every switch of a programme is on that grid.
_INPUT_RATE = 10.0


class WrongProgramme(Sabotage):
    """The recording states another programme than the one that was applied."""

    kind = "wrong_programme"
    law = "applied(t) is not stated(t)"
    verdicts = OF_INPUT
    setups = _BENCHES

    def __init__(self, recordings: Sequence[int], others: Mapping[int, Programme]) -> None:
        super().__init__(recordings)
        self._others = dict(others)

    @classmethod
    def drawn(cls, bench: Bench, rng: np.random.Generator) -> Sabotage:
        numbers = bench.all if rng.random() < 0.3 else (bench.drawn_training(rng),)
        return cls(numbers, {n: other_programme(bench, n, rng) for n in numbers})

    def stated(self, number: int, programme: Programme) -> Programme:
        return self._others.get(number, programme)


class OtherRunInput(WrongProgramme):
    """The column of the input belongs to another run."""

    kind = "other_run_input"
    law = "recorded_input(t) is not applied(t)"
    setups = ("network", "small", "bath")

    def __init__(self, recordings: Sequence[int], others: Mapping[int, Programme], input_of: tuple[str, str]) -> None:
        super().__init__(recordings, others)
        self._input = input_of

    @classmethod
    def drawn(cls, bench: Bench, rng: np.random.Generator) -> Sabotage:
        number = bench.drawn_training(rng)
        return cls((number,), {number: other_programme(bench, number, rng)}, bench.setup.component)

    def tell(self, number: int, sidecar: dict[str, Any]) -> dict[str, str]:
        """Every recording has the column of its input in place of its programme; one of them is of another run."""
        component, output = self._input
        points = sidecar["overrides"].pop("components")[component]["outputs"][output]["points"]
        times = np.array([float(t.split()[0]) for t, _ in points])
        levels = np.array([float(v.split()[0]) for _, v in points])
        unit = points[0][1].split()[1]
        stamps = np.arange(0.0, float(sidecar["overrides"]["time"]["stop"].split()[0]) + 1e-9, 1.0 / _INPUT_RATE)
        if unit == "degC":  # a ramp
            column = np.interp(stamps, times, levels)
        else:
            column = levels[np.searchsorted(times, stamps + 1e-6, side="right") - 1]
        sidecar["inputs"] = {
            f"{component}.{output}": {
                "column": output,
                "unit": unit,
                "table": "input.csv",
                "time": {"column": "time", "unit": "s", "zero": 0},
            }
        }
        rows = [f"{t:.6g},{v:.6g}" for t, v in zip(stamps.tolist(), column.tolist())]
        return {"input.csv": "\n".join([f"time,{output}", *rows]) + "\n"}


def other_programme(bench: Bench, number: int, rng: np.random.Generator) -> Programme:
    """A programme of the same rig that is none of the case's."""
    names = list(bench.setup.shapes)
    shape = bench.setup.shapes[names[int(rng.integers(len(names)))]]
    return shape(rng, bench.setup.top, bench.setup.stop)


class InputOffset(Sabotage):
    """The source gave more or less for a while, which no record shows."""

    kind = "input_offset"
    law = "applied(t) = stated(t) * factor + added for begin <= t < end"
    verdicts = OF_INPUT
    setups = _BENCHES

    @classmethod
    def drawn(cls, bench: Bench, rng: np.random.Generator) -> Sabotage:
        number = bench.drawn_training(rng)
        sign = float(rng.choice([-1.0, 1.0]))
        share = sign * float(np.exp(rng.uniform(np.log(0.06), np.log(0.15))))
        bath = sign * float(rng.uniform(2.0, 6.0))
        numbers = {"factor": 1.0, "added": bath} if bench.setup.sheet.is_bath else {"factor": 1.0 + share, "added": 0.0}
        return cls((number,), numbers, (), _driven_span(bench, number, rng))

    def applied(self, number: int, programme: Programme) -> Programme:
        if not self.concerns(number) or self.span is None:
            return programme
        return offset(programme, self.span, self.parameters["factor"], self.parameters["added"])


def _driven_span(bench: Bench, number: int, rng: np.random.Generator) -> tuple[float, float]:
    """A stretch in which something is applied for at least a third of the time."""
    programme = bench.programmes[number - 1]
    for _ in range(100):
        span = bench.span(rng)
        levels = [np.abs(programme.at(t)).max() for t in np.linspace(*span, 60)]
        if bench.setup.sheet.is_bath or np.mean(np.array(levels) > 0.0) > 0.33:
            break
    return span


class UnequalRooms(Sabotage):
    """Two recordings that are said to be of one day, in a room that was warmer or colder in one of them."""

    kind = "unequal_rooms"
    law = "T_ambient = T_ambient_stated + difference"
    verdicts = OF_INPUT
    setups = ("network", "small", "zones", "heaters")
    same_as = ("ambient_step",)

    @classmethod
    def drawn(cls, bench: Bench, rng: np.random.Generator) -> Sabotage:
        difference = float(rng.choice([-1.0, 1.0])) * float(rng.uniform(2.5, 6.0))
        return cls((bench.drawn_training(rng),), {"difference": difference})

    def room(self, number: int) -> float:
        return self.parameters["difference"] if self.concerns(number) else 0.0

    def tell(self, number: int, sidecar: dict[str, Any]) -> dict[str, str]:
        sidecar["day"] = "one day"
        return {}


class WrongStart(Sabotage):
    """The rig was still warm from the run before; the recording says that it is as cold as the room."""

    kind = "wrong_start"
    law = "T(0) = T_ambient + excess"
    verdicts = OF_INPUT
    setups = _BENCHES

    @classmethod
    def drawn(cls, bench: Bench, rng: np.random.Generator) -> Sabotage:
        numbers = bench.all[: bench.training] if rng.random() < 0.3 else (bench.drawn_training(rng),)
        return cls(numbers, {"excess": float(rng.uniform(8.0, 20.0))})

    def start(self, number: int) -> float:
        return self.parameters["excess"] if self.concerns(number) else 0.0


class OtherSupply(Sabotage):
    """Two strings are wired to each other's supply, two heaters to each other's driver."""

    kind = "other_supply"
    units = ("electrical", "thermal")
    law = "applied of one is what is stated of the other"
    verdicts = OF_STRUCTURE
    setups = ("zones", "heaters")

    @classmethod
    def drawn(cls, bench: Bench, rng: np.random.Generator) -> Sabotage:
        count = len(bench.setup.sheet.strings)
        first, second = rng.permutation(count)[:2].tolist()
        return cls(bench.all, {"first": float(first + 1), "second": float(second + 1)})

    def applied(self, number: int, programme: Programme) -> Programme:
        first, second = (int(self.parameters[n]) - 1 for n in ("first", "second"))
        levels = programme.levels.copy()
        levels[:, [first, second]] = levels[:, [second, first]]
        return Programme(programme.times, levels, programme.stop, programme.is_ramped)


class DelayLine(Sabotage):
    """What is set reaches the rig after a dead time: a heat carrier flows there through a hose."""

    kind = "delay_line"
    units = ("thermal",)
    law = "applied(t) = stated(t - dead_time)"
    verdicts = OF_STRUCTURE
    setups = ("bath", "heaters")

    @classmethod
    def drawn(cls, bench: Bench, rng: np.random.Generator) -> Sabotage:
        return cls(bench.all, {"dead_time": round(float(rng.uniform(0.02, 0.07)) * bench.setup.stop, 1)})

    def applied(self, number: int, programme: Programme) -> Programme:
        return delayed(programme, self.parameters["dead_time"])


SABOTAGES: tuple[type[Sabotage], ...] = (
    WrongProgramme,
    OtherRunInput,
    InputOffset,
    UnequalRooms,
    WrongStart,
    OtherSupply,
    DelayLine,
)
