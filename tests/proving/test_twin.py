"""The twin of a case with an effect outside the catalogue: the same recordings without the effect."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from evaluation.proving.case import Case
from evaluation.proving.cases import drawn_cases, write_cases
from evaluation.proving.draw import drawn_effect
from evaluation.proving.effects.effect import Effect
from evaluation.proving.effects.measurement import BentScale, CurrentPickup, SensorFault, drawn_fault
from evaluation.proving.effects.outside import ContactVoltage, PeltierJunction, TwoWaySquare
from evaluation.proving.setups import SETUPS

RECORDINGS = ("training_1", "training_2", "held_out_1")


def _outside(wanted: type[Effect] | type[SensorFault], setup: str) -> Case:
    """A case with a strong effect or fault on a drawn rig."""
    ((case, _),) = drawn_cases(1, 5, ["null"], [setup])
    assert isinstance(case, Case)
    rng = np.random.default_rng(1)
    case = replace(case, kind="outside", strengths={wanted.identifier: "strong"})
    if issubclass(wanted, SensorFault):
        return replace(case, faults=[drawn_fault(wanted, case.sensors, "strong", rng)])
    return replace(case, effects=[drawn_effect(wanted, SETUPS[setup], case.rig, "strong", rng)])


def _write(case: Case, folder: Path) -> Path:
    case.write(folder / "cases", folder / "answers", np.random.default_rng(3))
    return folder


def _files(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def _pair(folder: Path) -> tuple[dict[str, bytes], dict[str, bytes]]:
    """Recordings of the case and of its twin."""
    case = _files(folder / "cases" / "case_0001")
    recorded = {n: content for n, content in case.items() if n.startswith(RECORDINGS)}
    return recorded, _files(folder / "answers" / "case_0001_twin")


@pytest.mark.parametrize(
    ("wanted", "setup"),
    [(PeltierJunction, "small"), (ContactVoltage, "small"), (TwoWaySquare, "bath"), (BentScale, "heaters")],
)
def test_an_effect_without_strength_has_the_twins_recordings(wanted, setup: str, tmp_path: Path) -> None:
    case = _outside(wanted, setup)
    for effect in (*case.effects, *case.faults):
        effect.parameters = dict.fromkeys(effect.parameters, 0.0)
    recorded, twin = _pair(_write(case, tmp_path))
    assert len(twin) == 3 * (1 + len(case.sensors))  # of each recording a sidecar and a table for each kind of sensor
    assert twin == recorded


def test_the_twin_has_the_same_noise_where_the_effect_does_not_reach(tmp_path: Path) -> None:
    recorded, twin = _pair(_write(_outside(TwoWaySquare, "small"), tmp_path))
    differing = {n for n in twin if twin[n] != recorded[n]}
    assert differing == {f"{name}/extension.csv" for name in RECORDINGS}


def test_the_twins_sensors_are_those_before_they_were_spoiled(tmp_path: Path) -> None:
    case = _outside(CurrentPickup, "small")
    (fault,) = case.faults
    fault.place = replace(fault.place, channels=("coil[2,1].temperature",))
    recorded, twin = _pair(_write(case, tmp_path))
    assert {n for n in twin if twin[n] != recorded[n]} == {f"{name}/temperature.csv" for name in RECORDINGS}
    for name in RECORDINGS:
        tables = [f[f"{name}/temperature.csv"].decode().splitlines() for f in (recorded, twin)]
        assert tables[0][0] == tables[1][0]
        rows = [np.genfromtxt(t[1:], delimiter=",") for t in tables]
        spoiled = tables[0][0].split(",").index("temperature_2_1")
        away = np.nan_to_num(np.abs(rows[0] - rows[1])).max(axis=0)
        assert np.flatnonzero(away).tolist() == [spoiled]
        assert away[spoiled] > 1.0  # 16 K/A in a string that carries 0.3 A and more


def test_what_the_diagnosis_is_given_does_not_depend_on_the_twin(tmp_path: Path) -> None:
    with_twin = _write(_outside(CurrentPickup, "small"), tmp_path / "with")
    without = _write(replace(_outside(CurrentPickup, "small"), kind="sensor"), tmp_path / "without")
    assert (with_twin / "answers" / "case_0001_twin").is_dir()
    assert not (without / "answers" / "case_0001_twin").exists()
    assert _files(with_twin / "cases") == _files(without / "cases")


def test_twins_lie_among_the_answers_of_cases_outside_the_catalogue_alone(tmp_path: Path) -> None:
    write_cases(tmp_path, 3, 2, ["outside", "leave_one_out", "null"], ["bath"])
    kinds = {c.identifier: c.kind for c, _ in drawn_cases(3, 2, ["outside", "leave_one_out", "null"], ["bath"])}
    twins = sorted(p.name for p in (tmp_path / "answers").iterdir() if p.is_dir())
    assert twins == [f"{name}_twin" for name, kind in kinds.items() if kind == "outside"]
    assert len(twins) == 1
    assert sorted(p.name for p in (tmp_path / "cases").iterdir()) == sorted(kinds)
    assert not list((tmp_path / "cases").rglob("*twin*"))
