"""`python -m benchmarks.check_rates --seed N`: rates of detection and of false doubts, as a table."""

from __future__ import annotations

import argparse
import tempfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np

from benchmarks.check_rates import rig
from benchmarks.machine import heading, results_folder
from cosim.scenario import Scenario, load_scenario
from cosim.unit.protocol import Array
from diagnosis.check.check import check_recordings
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import load_recording

#: What is wrong with a recording: writes it, with a random generator and how slow its rig is.
Maker = Callable[[Path, np.random.Generator, float], Path]


def _drawn(rng: np.random.Generator, slowness: float, has_event: bool = False) -> tuple[rig.Rig, Array, Array, Array]:
    one, points = rig.drawn(rng, slowness, has_event), rig.programme(rng)
    return one, points, *rig.readings(one, points, rng)


def clean(folder: Path, rng: np.random.Generator, slowness: float) -> Path:
    """Nothing is wrong but the model."""
    one, points, times, values = _drawn(rng, slowness)
    return rig.write(folder, points, times, values, one.noise)


def event(folder: Path, rng: np.random.Generator, slowness: float) -> Path:
    """A loose contact or a draught."""
    one, points, times, values = _drawn(rng, slowness, True)
    return rig.write(folder, points, times, values, one.noise)


def shifted(folder: Path, rng: np.random.Generator, slowness: float) -> Path:
    """A clock that is 8 to 15 s early or late."""
    one, points, times, values = _drawn(rng, slowness)
    late = rng.uniform(8.0, 15.0) * rng.choice([-1.0, 1.0])
    return rig.write(folder, points, times + late, values, one.noise)


def drifting(folder: Path, rng: np.random.Generator, slowness: float) -> Path:
    """A clock that runs 3 to 6 % fast or slow."""
    one, points, times, values = _drawn(rng, slowness)
    return rig.write(
        folder, points, times * (1.0 + rng.uniform(0.03, 0.06) * rng.choice([-1.0, 1.0])), values, one.noise
    )


def programme(folder: Path, rng: np.random.Generator, slowness: float) -> Path:
    """Another programme than the one that was run; no recording has it."""
    one, _, times, values = _drawn(rng, slowness)
    return rig.write(folder, rig.programme(rng), times, values, one.noise)


def _held(points: Array, times: Array) -> Array:
    return np.asarray(points[:, 1:][np.maximum(np.searchsorted(points[:, 0], times + 1e-9, side="right") - 1, 0)])


def _with_column(
    folder: Path, rng: np.random.Generator, slowness: float, change: Callable[[Array, Array], Array]
) -> Path:
    one, points, times, values = _drawn(rng, slowness)
    stamps = np.arange(0.0, rig.SPAN, 1.0)
    return rig.write(folder, points, times, values, one.noise, (stamps, change(points, stamps)))


def recorded(folder: Path, rng: np.random.Generator, slowness: float) -> Path:
    """A column of the input that is the programme, with the noise of a meter."""
    return _with_column(folder, rng, slowness, lambda p, t: _held(p, t) + 0.003 * rng.standard_normal((len(t), 2)))


def column_off(folder: Path, rng: np.random.Generator, slowness: float) -> Path:
    """A column of the input that is 0 for 80 s of the longest heating of one heater."""

    def change(points: Array, stamps: Array) -> Array:
        found = _held(points, stamps)
        k = int(np.argmax(np.count_nonzero(found, axis=0)))
        begin = int(np.flatnonzero(found[:, k])[0]) + 10
        found[begin : begin + 80, k] = 0.0
        return found

    return _with_column(folder, rng, slowness, change)


def column_shifted(folder: Path, rng: np.random.Generator, slowness: float) -> Path:
    """A column of the input that comes 20 s late."""
    return _with_column(folder, rng, slowness, lambda p, t: _held(p, t - 20.0))


def column_scaled(folder: Path, rng: np.random.Generator, slowness: float) -> Path:
    """A column of the input that is 20 % low."""
    return _with_column(folder, rng, slowness, lambda p, t: 0.8 * _held(p, t))


def column_other(folder: Path, rng: np.random.Generator, slowness: float) -> Path:
    """A column of the input that is of another run."""
    return _with_column(folder, rng, slowness, lambda p, t: _held(rig.programme(rng), t))


#: What is wrong, what it is called in the table, the kinds of doubt that tell it, recordings of each speed.
CASES: tuple[tuple[Maker, str, tuple[str, ...], int], ...] = (
    (clean, "nothing (missing physics alone)", (), 4),
    (event, "nothing; a contact or a draught", (), 2),
    (recorded, "nothing; input recorded", (), 1),
    (shifted, "clock 8 to 15 s off", ("dead time",), 1),
    (drifting, "clock 3 to 6 % fast or slow", ("clock",), 1),
    (programme, "programme of no recording", ("programme",), 1),
    (column_off, "recorded input 0 for 80 s", ("input", "programme"), 1),
    (column_shifted, "recorded input 20 s late", ("input", "programme"), 1),
    (column_scaled, "recorded input 20 % low", ("input",), 1),
    (column_other, "recorded input of another run", ("input", "programme"), 1),
)
#: Mean time constants beside that of the scenario (170 s).
SLOWNESS = (1.0, 3.0)


def counted(
    scenario: Scenario, folder: Path, maker: Maker, seed: int, number: int, slowness: float
) -> list[tuple[Doubt, ...]]:
    """Doubts about as many recordings, each drawn anew."""
    found = []
    for k in range(number):
        rng = np.random.default_rng([seed, k, round(10 * slowness), *maker.__name__.encode()])
        path = maker(folder / f"{maker.__name__}{slowness:g}_{k}", rng, slowness)
        found.append(check_recordings(scenario, [load_recording(path)]))
    return found


def table(seed: int, number: int) -> list[str]:
    """Rows of the table; `number` recordings of each sabotage and speed."""
    scenario = load_scenario("tclab")
    lines = [
        "| what is wrong | time constant | recordings | told by its kind | serious doubt | other notes |",
        "|---|---|---|---|---|---|",
    ]
    with tempfile.TemporaryDirectory() as folder:
        for maker, name, kinds, times in CASES:
            for slowness in SLOWNESS:
                every = counted(scenario, Path(folder), maker, seed, times * number, slowness)
                told = sum(any(d.kind in kinds for d in one) for one in every)
                serious = Counter(d.kind for one in every for d in one if d.is_serious)
                any_serious = sum(any(d.is_serious for d in one) for one in every)
                notes = Counter(d.kind for one in every for d in one if not d.is_serious and d.kind not in kinds)
                shown = ", ".join(f"{kind} {count}" for kind, count in sorted(serious.items()))
                lines.append(
                    f"| {name} | {170 * slowness:.0f} s | {len(every)} | {told if kinds else '-'} | "
                    f"{any_serious}{f' ({shown})' if shown else ''} | "
                    f"{', '.join(f'{kind} {count}' for kind, count in sorted(notes.items())) or '-'} |"
                )
                print(lines[-1], flush=True)
    return lines


def main(arguments: list[str] | None = None) -> None:
    """Print and write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, required=True, help="one that the code was not developed with")
    parser.add_argument("--number", type=int, default=10, help="recordings of each sabotage and speed")
    given = parser.parse_args(arguments)
    command = f"python -m benchmarks.check_rates --seed {given.seed} --number {given.number}"
    text = "\n".join([heading("Rates of the recording check", command), *table(given.seed, given.number)]) + "\n"
    (results_folder() / "check_rates.md").write_text(text)


if __name__ == "__main__":
    main()
