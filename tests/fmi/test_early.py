"""An FMU that initialises itself when the experiment is set up: what it was given holds all the same."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import xarray as xr
import yaml

from cosim.run import run
from cosim.scenario import load_scenario
from cosim.unit.errors import InputError
from tests.fmi.conftest import Maker

GIVEN: dict[str, Any] = {"gain": 3.0, "count": 5, "flipped": True, "single": 0.1}


def test_parameters_and_start_values_are_given_once_more(load: Maker) -> None:
    unit = load("early", 2, parameters=GIVEN, start={"level": 2.0})
    unit.initialise(0)
    unit.exit_initialisation()
    assert unit.get("y")[()] == -3.0 * 2.0 * 5.0


def test_a_value_that_the_fmu_does_not_keep_is_reported(load: Maker) -> None:
    unit = load("early", 2, parameters={"limited": 7.0})
    with pytest.raises(InputError, match="the FMU does not take 7: it keeps 1") as refused:
        unit.initialise(0)
    assert refused.value.key == "early.parameters.limited"


def test_the_fmu_is_told_the_stop_time(load: Maker) -> None:
    for stop in (12.5, None):
        unit = load("early", 2, stop_time=stop)
        unit.initialise(0)
        assert unit.get("stop")[()] == (-1.0 if stop is None else stop)


def scenario(folder: Path, fmu: Path, **parameters: Any) -> Path:
    path = folder / "scenario.yaml"
    component = {"kind": "fmu", "fmu": str(fmu), "parameters": parameters}
    times = {"stop": "2 s", "macro_step": "0.5 s", "output_step": "0.5 s"}
    path.write_text(yaml.safe_dump({"title": "early", "time": times, "components": {"early": component}}))
    return path


def test_a_run_has_the_stop_time_and_the_parameters_of_its_scenario(
    built: dict[tuple[str, int], Path], tmp_path: Path
) -> None:
    run(load_scenario(scenario(tmp_path, built["early", 2], gain=3)), tmp_path / "run")
    results = xr.load_dataset(tmp_path / "run" / "results.nc")
    assert results["early.y"].values.tolist() == [3.0] * 5
    assert results["early.stop"].values.tolist() == [2.0] * 5


def test_a_run_with_a_value_that_is_not_kept_ends_with_an_input_error(
    built: dict[tuple[str, int], Path], tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=r"early\.parameters\.limited.*does not take 7: it keeps 1"):
        run(load_scenario(scenario(tmp_path, built["early", 2], limited=7)), tmp_path / "run")
