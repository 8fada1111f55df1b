"""The seventh set of foreign rigs: what is drawn, by which seed, and that nothing but the concealed is missing."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pytest
import yaml

from cosim.run import run
from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.strangers import seventh_set
from evaluation.strangers.__main__ import SETS, make
from evaluation.strangers.first_set import Rng
from evaluation.strangers.truth import FINE, Truth


def test_set_has_nulls_effects_and_faults_under_names_of_their_own() -> None:
    names = [case.__name__ for case in SETS["seventh"]]
    others = {case.__name__ for key, cases in SETS.items() if key != "seventh" for case in cases}
    assert len(set(names)) == len(names) == 26
    assert not set(names) & others
    assert sum(name.endswith("_null") for name in names) == 8
    assert sum(name.endswith("_two") for name in names) == 2


def test_draw_is_that_of_its_seed(tmp_path: Path) -> None:
    for folder, seed in (("a", 5), ("b", 5), ("c", 6)):
        make(seventh_set.heli_pivot, tmp_path / folder, seed)
    first, again, other = ((tmp_path / n / "task" / "first" / "data.csv").read_bytes() for n in ("a", "b", "c"))
    assert first == again
    assert first != other
    concealed = [yaml.safe_load((tmp_path / n / "answer.json").read_text(encoding="utf-8")) for n in ("a", "c")]
    assert concealed[0]["concealed"] != concealed[1]["concealed"]
    assert not set(concealed[0]["right"]) & set(FINE)


def test_charge_of_a_cycle_stays_within_its_room() -> None:
    course = seventh_set.cycling(np.random.default_rng(3), 1500.0, 12.0, 1.5, 8.0, 60.0, 0.5)
    charge = np.cumsum(np.diff(course.times) * course.levels[:-1])
    assert course.times[0] == course.levels[0] == 0.0
    assert np.all(np.diff(course.times) >= 6.0)
    assert np.max(np.abs(course.levels)) <= 8.0
    assert np.max(np.abs(charge)) <= 60.0 * 1.01  # levels are rounded to three digits


def test_reading_of_a_fast_clock_is_one_of_an_earlier_instant() -> None:
    times = np.linspace(0.0, 10.0, 11)
    read = seventh_set.clocked(0, 2.0, times, times[:, None], 0.01)
    assert read(np.array([0.0, 5.0, 10.0]), times, times) == pytest.approx([0.0, 9.9, 19.8], rel=1e-12)


def kept(column: Array) -> Array:
    return column


def degrees(column: Array) -> Array:
    return np.asarray(np.degrees(column))


def millibar(column: Array) -> Array:
    return np.asarray(0.01 * column)


#: Case, channel, its column, that column from the unit of the FMU, standard deviation of its noise and its rounding.
RIGS = (
    (seventh_set.heli_pivot, "arm.rate", "gyro_dps", degrees, 2.0, 0.1),
    (seventh_set.boost_diode, "rig.voltage", "U_out", kept, 0.1, 0.01),
    (seventh_set.syringe_tubing, "line.pressure", "p_mbar", millibar, 1.0, 0.1),
)


@pytest.mark.parametrize(("case", "channel", "column", "unit", "noise", "quantum"), RIGS)
def test_readings_of_a_rig_with_the_stated_numbers_are_the_fmu_and_noise_and_the_effect_exceeds_it(
    case: Callable[[Path, Rng], Truth],
    channel: str,
    column: str,
    unit: Callable[[Array], Array],
    noise: float,
    quantum: float,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def stated(rng: np.random.Generator, model: OdeModel, known: Mapping[str, float]) -> list[float]:
        return [value for value, _ in model.parameters.values()]

    monkeypatch.setattr(seventh_set, "drawn", stated)
    name = f"_{case.__name__.partition('_')[0]}"
    whole = getattr(seventh_set, name)
    case(tmp_path / "with", np.random.default_rng(9))
    monkeypatch.setattr(seventh_set, name, lambda folder, rng, **concealed: whole(folder, rng))
    case(tmp_path / "without", np.random.default_rng(9))
    deviations = [missed(tmp_path / folder, channel, column, unit) for folder in ("without", "with")]
    assert deviations[0] == pytest.approx(np.hypot(noise, quantum / np.sqrt(12)), rel=0.15)
    assert deviations[1] > 2.5 * noise


def missed(folder: Path, channel: str, column: str, unit: Callable[[Array], Array]) -> float:
    """Root mean square of what the scenario leaves of the first recording."""
    scenario = yaml.safe_load((folder / "scenario.yaml").read_text(encoding="utf-8"))
    recording = yaml.safe_load((folder / "first" / "recording.yaml").read_text(encoding="utf-8"))
    table = np.genfromtxt(folder / "first" / "data.csv", delimiter=",", names=True)
    scale = {"s": 1.0, "ms": 1e-3}[recording["time"]["unit"]]
    times = scale * (table[recording["time"]["column"]] - recording["time"]["zero"])
    for source, keys in recording["overrides"].get("components", {}).items():
        for output, course in keys["outputs"].items():
            scenario["components"][source]["outputs"][output] = {
                "unit": scenario["components"][source]["outputs"][output]["unit"],
                **course,
            }
    (folder / "run.yaml").write_text(yaml.safe_dump(scenario), encoding="utf-8")
    found = run(load_scenario(folder / "run.yaml"))
    simulated = np.interp(times, np.asarray(found["time"], dtype=np.float64), unit(np.asarray(found[channel])))
    return float(np.sqrt(np.nanmean((table[column] - simulated) ** 2)))
