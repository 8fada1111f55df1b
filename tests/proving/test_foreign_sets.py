"""Sets of foreign rigs: what is drawn, by which seed, and that nothing but the concealed is missing."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import yaml

from cosim.run import run
from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.strangers import eighth_set, fifth_set, seventh_set, sixth_set
from evaluation.strangers.__main__ import SETS, make
from evaluation.strangers.first_set import Rng
from evaluation.strangers.truth import FINE, Truth

#: Names of the fifth and the seventh set under which cases of other rigs were drawn later, in the twenty-second, the
#: twenty-ninth and the sixteenth: other names would be other draws.
TWICE = {"bank_null", "muscle_null", "jacket_null", "jacket_two"}


@pytest.mark.parametrize(
    ("key", "cases", "nulls", "pairs"),
    [("fifth", 27, 7, 3), ("sixth", 25, 7, 2), ("seventh", 26, 8, 2), ("eighth", 25, 7, 2)],
)
def test_set_has_nulls_effects_and_faults_under_names_of_their_own(
    key: str, cases: int, nulls: int, pairs: int
) -> None:
    names = [case.__name__ for case in SETS[key]]
    others = {case.__name__ for other, own in SETS.items() if other != key for case in own}
    assert len(set(names)) == len(names) == cases
    assert set(names) & others <= TWICE
    assert sum(name.endswith("_null") for name in names) == nulls
    assert sum(name.endswith("_two") for name in names) == pairs


@pytest.mark.parametrize(
    "case", [fifth_set.pan_steam, sixth_set.surge_throttle, seventh_set.heli_pivot, eighth_set.muffler_jet]
)
def test_draw_is_that_of_its_seed(case: Callable[[Path, Rng], Truth], tmp_path: Path) -> None:
    for folder, seed in (("a", 5), ("b", 5), ("c", 6)):
        make(case, tmp_path / folder, seed)
    first, again, other = ((tmp_path / n / "task" / "first" / "data.csv").read_bytes() for n in ("a", "b", "c"))
    assert first == again
    assert first != other
    concealed = [yaml.safe_load((tmp_path / n / "answer.json").read_text(encoding="utf-8")) for n in ("a", "c")]
    assert concealed[0]["concealed"] != concealed[1]["concealed"]
    assert not set(concealed[0]["right"]) & set(FINE)


def kept(column: Array) -> Array:
    return column


def grams(column: Array) -> Array:
    return np.asarray(1e3 * column)


def degrees(column: Array) -> Array:
    return np.asarray(np.degrees(column))


def millibar(column: Array) -> Array:
    return np.asarray(0.01 * column)


#: Set, case, channel, its column, that column from the unit of the FMU, deviation of its noise and its rounding.
RIGS = (
    (sixth_set, "dryer_falling", "cabinet.humidity", "x_g_kg", grams, 0.1, 0.1),
    (sixth_set, "rotor_bridge", "generator.current", "I_A", kept, 0.015, 0.005),
    (sixth_set, "cells_stagnant", "rig.probe3", "c3_g_l", kept, 0.02, 0.01),
    (seventh_set, "heli_pivot", "arm.rate", "gyro_dps", degrees, 2.0, 0.1),
    (seventh_set, "boost_diode", "rig.voltage", "U_out", kept, 0.1, 0.01),
    (seventh_set, "syringe_tubing", "line.pressure", "p_mbar", millibar, 1.0, 0.1),
    (eighth_set, "mirror_film", "mirror.angle", "psd_deg", degrees, 0.06, 0.01),
    (eighth_set, "muffler_jet", "muffler.second", "mic2_Pa", kept, 2.5, 0.1),
    (eighth_set, "dye_shade", "loop.cell", "c_cell", grams, 0.12, 0.02),
)


@pytest.mark.parametrize(
    ("rigs", "case", "channel", "column", "unit", "noise", "quantum"), RIGS, ids=[rig[1] for rig in RIGS]
)
def test_readings_of_a_rig_with_the_stated_numbers_are_the_fmu_and_noise_and_the_effect_exceeds_it(
    rigs: ModuleType,
    case: str,
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

    monkeypatch.setattr(rigs, "drawn", stated)
    name = f"_{case.partition('_')[0]}"
    whole = getattr(rigs, name)
    getattr(rigs, case)(tmp_path / "with", np.random.default_rng(9))
    monkeypatch.setattr(rigs, name, lambda folder, rng, **concealed: whole(folder, rng))
    getattr(rigs, case)(tmp_path / "without", np.random.default_rng(9))
    deviations = [missed(tmp_path / folder, channel, column, unit) for folder in ("without", "with")]
    assert deviations[0] == pytest.approx(np.hypot(noise, quantum / np.sqrt(12)), rel=0.15)
    assert deviations[1] > 2.5 * noise


def missed(folder: Path, channel: str, column: str, unit: Callable[[Array], Array]) -> float:
    """Root mean square of what the scenario leaves of the first recording."""
    scenario = yaml.safe_load((folder / "scenario.yaml").read_text(encoding="utf-8"))
    recording = yaml.safe_load((folder / "first" / "recording.yaml").read_text(encoding="utf-8"))
    table = np.genfromtxt(folder / "first" / "data.csv", delimiter=",", names=True)
    scale = {"s": 1.0, "ms": 1e-3, "min": 60.0}[recording["time"]["unit"]]
    times = scale * (table[recording["time"]["column"]] - recording["time"]["zero"])
    for source, keys in recording["overrides"].get("components", {}).items():
        for output, course in keys["outputs"].items():
            scenario["components"][source]["outputs"][output] = {
                "unit": scenario["components"][source]["outputs"][output]["unit"],
                **course,
            }
    for name, keys in recording.get("inputs", {}).items():
        source, _, output = name.partition(".")
        points = [
            [f"{t:.10g} s", f"{v:.10g} {keys['unit']}".strip()]
            for t, v in zip(times, table[keys["column"]], strict=True)
        ]
        scenario["components"][source]["outputs"][output] = {"unit": keys["unit"] or "1", "points": points}
    (folder / "run.yaml").write_text(yaml.safe_dump(scenario), encoding="utf-8")
    found = run(load_scenario(folder / "run.yaml"))
    simulated = np.interp(times, np.asarray(found["time"], dtype=np.float64), unit(np.asarray(found[channel])))
    return float(np.sqrt(np.nanmean((table[column] - simulated) ** 2)))
