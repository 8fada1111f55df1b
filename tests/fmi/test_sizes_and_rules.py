"""Sizes that an FMU claims, and rules that it must keep: refused in words before memory is taken."""

from __future__ import annotations

import tracemalloc
from pathlib import Path
from typing import Any

import pytest
import yaml

from cosim.fmu import access, settings, sizes
from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.settings import FmuSettings
from cosim.fmu_tools.info import read_info
from cosim.run import RunStopped, run
from cosim.scenario import load_scenario
from cosim.ssp.fmus import Fmu
from cosim.unit.errors import InputError
from cosim.unit.protocol import NANOSECONDS, UnitError
from tests.fmi.fmi_models import described

Built = dict[tuple[str, int], Path]


def loaded(path: Path, **given: Any) -> CoSimulationUnit:
    return CoSimulationUnit("u", open_fmu(path), FmuSettings(**given))


@pytest.mark.parametrize("far", ["3000000", "2000,2000", "999999999"])
def test_a_large_index_makes_no_large_array(built: Built, tmp_path: Path, far: str) -> None:
    path = described(built["echo", 2], tmp_path / "far.fmu", 'name="a[2,2]"', f'name="a[{far}]"')
    tracemalloc.start()
    unit = loaded(path)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert f"a[{far}]" in unit.variables
    assert unit.variables["a[1,1]"].shape == ()
    assert peak < 20e6  # the box of these indices had 3 million tuples, some 300 MB
    unit.terminate()


def test_an_index_of_many_digits_is_a_name(built: Built, tmp_path: Path) -> None:
    name = f"a[{'9' * 5000}]"
    unit = loaded(described(built["echo", 2], tmp_path / "long.fmu", 'name="a[2,2]"', f'name="{name}"'))
    assert name in unit.variables
    unit.terminate()


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('<Dimension start="2"/>', '<Dimension start="100000000000"/>', "elements, more than 33554432"),
        ('<Dimension start="2"/>', '<Dimension start="-2"/>', "has a negative size"),
        ('<Dimension start="2"/>', '<Dimension start="1"/>' * 40, "dimensions, more than 32"),
        ('<Dimension start="2"/>', '<Dimension start="x"/>', "it cannot be read"),
    ],
)
def test_a_dimension_is_judged_before_memory_is_taken(
    built: Built, tmp_path: Path, old: str, new: str, message: str
) -> None:
    path = described(built["echo", 3], tmp_path / "large.fmu", old, new)
    for read in (open_fmu, read_info, Fmu):
        with pytest.raises(InputError, match=message) as caught:
            read(path)
        assert str(path) in str(caught.value)
        assert "remedy" in str(caught.value)


def test_a_size_that_the_user_gives_is_judged_too(built: Built, tmp_path: Path) -> None:
    path = described(built["echo", 3], tmp_path / "free.fmu", ' max="3"', "")
    with pytest.raises(InputError, match=r"matrix_in has 10000000000 x 3 elements") as caught:
        loaded(path, structure={"rows": 10**10})
    assert "give a smaller rows or columns under `structure`" in str(caught.value)
    with pytest.raises(InputError, match=r"u\.structure"):
        loaded(path, structure={"rows": -1})


def test_all_that_is_exchanged_together_has_a_limit(built: Built, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sizes, "MOST_ELEMENTS", 30)
    with pytest.raises(InputError, match=r"have \d+ elements, more than 30 \(most in cube_out: 12\)"):
        loaded(built["echo", 3])
    assert settings.check_total is sizes.check_total


@pytest.mark.parametrize("version", [2, 3])
def test_a_state_that_claims_to_be_huge_is_not_kept(built: Built, version: int) -> None:
    unit = loaded(built["trouble", version], parameters={"state_size": 2.0**50})
    unit.initialise(0)
    with pytest.raises(UnitError, match=f"says that its state has {2**50} bytes, more than {2**30}") as caught:
        unit.checkpoint()
    assert "checkpoint_step" in str(caught.value.remedy)
    unit.do_step(0, NANOSECONDS)  # it goes on
    unit.terminate()


def test_a_run_that_stops_at_a_huge_state_keeps_its_results_and_the_remedy_helps(built: Built, tmp_path: Path) -> None:
    times = {"stop": "5 s", "macro_step": "1 s", "output_step": "1 s"}
    component = {"kind": "fmu", "fmu": str(built["trouble", 3]), "parameters": {"state_size": 2.0**50}}
    path = tmp_path / "scenario.yaml"
    path.write_text(yaml.safe_dump({"title": "huge", "time": times, "components": {"u": component}}))
    with pytest.raises(RunStopped, match="says that its state has") as caught:
        run(load_scenario(path), tmp_path / "stopped")
    assert caught.value.dataset["u.integral"].values.tolist() == [0.0, 1.0, 2.0]
    times["checkpoint_step"] = "5 s"
    path.write_text(yaml.safe_dump({"title": "huge", "time": times, "components": {"u": component}}))
    assert run(load_scenario(path), tmp_path / "whole")["u.integral"].values[-1] == 5.0


def test_binary_data_of_a_huge_size_is_not_read(built: Built, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(access, "MOST_BYTES", 3)
    unit = loaded(built["echo", 3], start={"binary_in": "00112233"})
    with pytest.raises(UnitError, match="gives 4 bytes, more than 3"):
        unit.initialise(0)
    unit.terminate()


@pytest.mark.parametrize(
    ("version", "old", "new", "message"),
    [
        (
            2,
            'name="state_size" valueReference="11"',
            'name="state_size" valueReference="-1"',
            "value reference -1 is outside 0 to",
        ),
        (
            3,
            'name="state_size" valueReference="11"',
            'name="state_size" valueReference="-1"',
            "value reference -1 is outside 0 to",
        ),
        (
            3,
            'name="state_size" valueReference="11"',
            'name="state_size" valueReference="4294967296"',
            "4294967296 is outside 0 to",
        ),
        (2, 'name="sum"', 'name="u"', r"variable u, line \d+: another variable has this name \(line \d+\)"),
        (3, 'name="sum"', 'name="u"', r"variable u, line \d+: another variable has this name \(line \d+\)"),
        (2, '<Real start="1"/>', '<Real start="one"/>', "its start value `one` is no Real"),
        (3, 'causality="input" start="1"', 'causality="input" start="one"', "its start value `one` is no Float64"),
        (3, 'causality="input" start="1"', 'causality="input" start="1_0"', "its start value `1_0` is no Float64"),
        (2, '<Boolean start="false"/>', '<Boolean start="no"/>', "its start value `no` is no Boolean"),
    ],
)
def test_what_would_go_to_the_wrong_variable_or_be_lost_is_refused(
    built: Built, tmp_path: Path, version: int, old: str, new: str, message: str
) -> None:
    path = described(built["trouble", version], tmp_path / "broken.fmu", old, new)
    with pytest.raises(InputError, match=message):
        open_fmu(path)
