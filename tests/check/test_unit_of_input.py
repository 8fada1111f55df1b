"""A column of an input that one recording states in another unit than it was logged in."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from cosim.run import RunStopped
from cosim.scenario import load_scenario
from cosim.unit.protocol import Array
from cosim.unit.quantity import conversion
from diagnosis.check import unit_of_input
from diagnosis.check.beside import Compared, compare
from diagnosis.check.input_runs import InputRuns
from diagnosis.check.unit_of_one import other_units
from diagnosis.judge.diagnosis import Verdict
from diagnosis.recording.recording import load_recording
from tests.check.test_other_course import _doubts, _power, recordings_of, temperatures
from tests.systems.rigs import diagnosed


def _recordings(folder: Path, logged: str, level: float = 1.0) -> list[Path]:
    """Three runs, the second with its power in a unit that it does not state; it acted `level` times as hard."""
    factor = conversion("W", logged)[0]

    def made(run: int) -> tuple[Array, Array]:
        power = _power(run)
        return (factor * power, temperatures(level * power)) if run == 2 else (power, temperatures(power))

    return recordings_of(folder, made)


@pytest.mark.parametrize("logged", ["Btu/h", "kcal/h", "mW"])
def test_a_column_in_another_unit_is_told_with_the_unit(tmp_path: Path, logged: str) -> None:
    (doubt,) = [d for d in _doubts(tmp_path, _recordings(tmp_path, logged)) if d.is_serious]
    assert (doubt.recording, doubt.subject, doubt.kind) == ("run_2", "heater.power", "unit")
    assert f"with its column of heater.power in {logged} and not in W at least" in doubt.statement
    assert "inputs.heater.power.unit" in doubt.remedy


def test_a_diagnosis_says_it_and_searches_nothing(tmp_path: Path) -> None:
    every = [load_recording(r) for r in _recordings(tmp_path, "Btu/h")]
    found = diagnosed(tmp_path / "scenario.yaml", every)
    assert found.verdict is Verdict.RECORDING_FAULT
    assert "in Btu/h and not in W" in found.statement


@pytest.mark.parametrize("level", [1.0, 1.3, 1.8])
def test_a_heater_that_is_stronger_by_the_factor_to_no_unit_is_in_no_other_unit(tmp_path: Path, level: float) -> None:
    """1.8 is a factor of thermometers in degF, whose zero is another too."""
    assert not [d for d in _doubts(tmp_path, _recordings(tmp_path, "W", level)) if d.kind == "unit"]


def test_a_programme_has_no_column(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    recordings = _recordings(tmp_path, "Btu/h")
    (one, *others) = _compared(tmp_path, recordings)
    assert unit_of_input.unit_of_input(one, others) is not None
    bare = replace(one, recording=replace(one.recording, inputs=()))
    assert unit_of_input.unit_of_input(bare, others) is None
    monkeypatch.setattr(unit_of_input, "MOST", 0)  # too many units explain it
    assert unit_of_input.unit_of_input(one, others) is None


def test_a_long_run_and_one_that_runs_away_are_not_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (one, *others) = _compared(tmp_path, _recordings(tmp_path, "Btu/h"))

    def away(self: InputRuns, given: object) -> None:
        raise RunStopped("away", None, False)  # type: ignore[arg-type]

    with monkeypatch.context() as patch:
        patch.setattr(InputRuns, "results", away)
        assert unit_of_input.unit_of_input(one, others) is None
    monkeypatch.setattr(unit_of_input, "is_quick", lambda scenario: False)
    assert unit_of_input.unit_of_input(one, others) is None


def _compared(folder: Path, recordings: list[Path]) -> list[Compared]:
    """The second recording, then the others."""
    scenario = load_scenario(str(folder / "scenario.yaml"))
    first, second, third = (compare(scenario, load_recording(r)) for r in recordings)
    return [second, first, third]


def test_units_are_those_of_the_same_quantity_that_are_others() -> None:
    """A torque is in no calories, and a unit that nobody lists has no others."""
    assert {"m/s", "knot", "mph"} <= set(other_units("km/h"))
    assert "km/h" not in other_units("km/h")
    assert "cal" in other_units("J")
    assert "cal" not in other_units("N*m")
    assert set(other_units("degC")) == {"K", "degF"}
    assert other_units("candela") == []
