"""FMUs that cannot serialise their state, and output steps of any length: no run ends for a checkpoint."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
import xarray as xr
import yaml

from cosim.run import run
from cosim.scenario import Scenario, load_scenario
from cosim.unit.errors import InputError
from tests.fmi.fmi_models import described


def scenario(folder: Path, fmu: Path, **time: Any) -> Scenario:
    path = folder / "scenario.yaml"
    component = {"kind": "fmu", "fmu": str(fmu), "fmi": 2, **time.pop("component", {})}
    times = {"stop": "6 s", "macro_step": "0.1 s", "output_step": "0.5 s"} | time
    path.write_text(yaml.safe_dump({"title": "any", "time": times, "components": {"u": component}}))
    return load_scenario(path)


@pytest.fixture
def mute(built: dict[tuple[str, int], Path], tmp_path: Path) -> Path:
    """An FMU without canSerializeFMUstate."""
    stated = 'canSerializeFMUstate="{}"'
    return described(built["early", 2], tmp_path / "mute.fmu", stated.format("true"), stated.format("false"))


@pytest.mark.parametrize("isolation", ["none", "process"])
def test_a_long_run_goes_on_without_checkpoints_and_says_so_once(
    mute: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture, isolation: str
) -> None:
    run(scenario(tmp_path, mute, component={"isolation": isolation}), tmp_path / "run")
    assert xr.load_dataset(tmp_path / "run" / "results.nc").sizes["time"] == 13
    (line,) = caplog.messages
    assert line.startswith(
        "u: an FMU that cannot serialise its state (canSerializeFMUstate), so there are no checkpoints"
    )
    assert list((tmp_path / "run" / "checkpoints").iterdir()) == []


def test_a_short_run_has_no_checkpoint_to_miss(mute: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    run(scenario(tmp_path, mute, stop="2 s"), tmp_path / "run")
    assert caplog.messages == []


@pytest.mark.parametrize(("output", "wanted"), [("10 s", 10.0), ("0.3 s", 2.1), ("0.5 s", 2.0), ("2 s", 2.0)])
def test_the_interval_of_checkpoints_follows_the_output_step(
    mute: Path, tmp_path: Path, output: str, wanted: float
) -> None:
    found = scenario(tmp_path, mute, output_step=output, stop="60 s")
    assert found.time.checkpoint_step.to("s") == pytest.approx(wanted)
    again = tmp_path / "again.yaml"
    again.write_text(found.to_yaml())
    assert load_scenario(again).time.checkpoint_step.to("s") == pytest.approx(wanted)


def test_an_interval_that_was_written_and_does_not_fit_is_refused(mute: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"checkpoint_step \(2 s\) must be a multiple of output_step \(10 s\)"):
        scenario(tmp_path, mute, output_step="10 s", stop="60 s", checkpoint_step="2 s")


@pytest.mark.parametrize(
    ("stop", "output", "wanted"), [("200 s", "1 s", 2.0), ("1e6 s", "1 s", 1e4), ("1e6 s", "30 s", 10020.0)]
)
def test_a_long_run_has_at_most_a_hundred_checkpoints(
    mute: Path, tmp_path: Path, stop: str, output: str, wanted: float
) -> None:
    found = scenario(tmp_path, mute, macro_step="1 s", output_step=output, stop=stop.replace("1e6", "999990"))
    assert found.time.checkpoint_step.to("s") == pytest.approx(wanted)


def test_the_summary_says_how_many_checkpoints_were_written_and_how_long_they_took(
    built: dict[tuple[str, int], Path], tmp_path: Path
) -> None:
    run(scenario(tmp_path, built["early", 2], macro_step="1 s", output_step="1 s", stop="1000 s"), tmp_path / "run")
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert summary["checkpoints"] == 99 == len(list((tmp_path / "run" / "checkpoints").iterdir()))
    assert 0.0 < summary["wall_time_s"]["checkpoints"] < summary["wall_time_s"]["since_start_or_resumption"]
    assert summary["loop_without_python"] == (1.0 if summary["loop"] == "C" else 0.0)
