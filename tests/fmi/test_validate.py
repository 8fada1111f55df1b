"""`cosim fmu validate` with FMUs that are sound but unlike the shipped ones."""

from __future__ import annotations

import shutil
import zipfile
from pathlib import Path

import numpy as np
import pytest

from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.settings import FmuSettings
from cosim.fmu_tools.isolated import Verdict
from cosim.fmu_tools.run_checks import _difference
from cosim.fmu_tools.validate import validate
from cosim.unit.errors import InputError
from tests.fmi import fmi_models
from tests.fmi.fmi_models import build, described


def verdicts(path: Path) -> dict[str, Verdict]:
    return dict(validate(path))


@pytest.mark.parametrize("version", [2, 3])
def test_outputs_that_are_text_are_compared_as_text(built, version):
    said = verdicts(built["echo", version])["CS and ME agree"]
    assert said.is_met, said.text


def test_scheduled_execution_alone_fails_one_check_and_says_why(built, tmp_path):
    with zipfile.ZipFile(built["clocks", 3]) as archive:
        text = archive.read("modelDescription.xml").decode()
    old = text[text.index("<CoSimulation") : text.index(">", text.index("<CoSimulation")) + 1]
    only = described(built["clocks", 3], tmp_path / "s.fmu", old, '<ScheduledExecution modelIdentifier="clocks"/>')
    found = verdicts(only)
    assert [n for n, v in found.items() if v.is_met is False] == ["initialises and steps"]
    assert "it has Scheduled Execution alone, which is not supported" in found["initialises and steps"].text
    assert found["binary for this platform"].is_met
    assert found["restored state replays"] == Verdict(None, "cannot be run here")
    assert len(found) == 11


def test_a_rough_solver_of_its_own_is_reported_and_is_no_failure(tmp_path, monkeypatch):
    models = tmp_path / "models"
    shutil.copytree(fmi_models.MODELS, models)
    source = models / "ball" / "model.c"
    text = source.read_text()
    rough = text.replace("h + w * size + 0.5 * a * size * size", "h + w * size")  # forward Euler
    assert rough != text
    source.write_text(rough)
    monkeypatch.setattr(fmi_models, "MODELS", models)
    said = verdicts(build("ball", 3, tmp_path))["CS and ME agree"]
    assert said.is_met is None
    assert "height differs by" in said.text
    assert said.text.endswith("(FMI leaves this open)")


@pytest.mark.parametrize(
    ("one", "other", "difference"),
    [
        ([1.0, 2.0], [1.0, 2.0], 0.0),
        ([1.0, 2.0], [1.0, 2.5], 0.25),
        ([0.0, 0.0], [0.0, 1e-3], 1e-3),
        ([np.nan, 1.0], [np.nan, 1.0], 0.0),
        ([np.nan, 1.0], [0.0, 1.0], np.inf),
        ([0.0, 1.0], [np.inf, 1.0], np.inf),
        ([1, 2], [1, 3], np.inf),
        ([True, False], [True, False], 0.0),
        (["a", "b"], ["a", "b"], 0.0),
        (["a", "b"], ["a", "c"], np.inf),
    ],
)
def test_traces_of_every_type_are_compared(one, other, difference):
    kind = object if isinstance(one[0], str) else None
    assert _difference(np.array(one, dtype=kind), np.array(other, dtype=kind)) == difference


def test_a_library_that_is_not_named_after_the_model_is_told_with_the_name_it_has(built, tmp_path):
    path = tmp_path / "other.fmu"
    with zipfile.ZipFile(built["ball", 2]) as source, zipfile.ZipFile(path, "w") as target:
        for name in source.namelist():
            target.writestr(name.replace("ball.so", "tank-ball.so"), source.read(name))
    found = verdicts(path)
    assert "no ball.so for" in found["binary for this platform"].text
    assert found["initialises and steps"].text.endswith("where it holds tank-ball.so")
    assert found["instances independent"] == Verdict(None, "cannot be run here")
    with pytest.raises(InputError, match=r"it holds tank-ball\.so[\s\S]*after the modelIdentifier"):
        CoSimulationUnit("ball", open_fmu(path), FmuSettings())


def test_one_instance_per_process_is_no_fault_and_warnings_are_given_once(built, tmp_path, capfd, caplog):
    once = described(
        built["ball", 2],
        tmp_path / "once.fmu",
        '<CoSimulation modelIdentifier="ball"',
        '<CoSimulation modelIdentifier="ball" canBeInstantiatedOnlyOncePerProcess="true"',
    )
    twice = described(
        once,
        tmp_path / "twice.fmu",
        'name="impacts" valueReference="6" causality="output" variability="discrete"',
        'name="impacts" valueReference="6" causality="output" variability="tunable"',
    )
    found = verdicts(once)
    assert found["instances independent"] == Verdict(None, "it allows one instance per process")
    assert [n for n, v in found.items() if v.is_met is False] == []
    caplog.clear()
    verdicts(twice)
    assert capfd.readouterr().err.count("is not valid") + caplog.text.count("is not valid") == 1
