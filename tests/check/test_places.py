"""`cosim recording check` and `cosim diagnose` accept the same names of places, and refuse the same."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from typer.testing import CliRunner

from cosim.cli import app
from cosim.scenario import load_scenario
from cosim.unit.errors import InputError
from diagnosis.models.build import model_of
from diagnosis.recording.recording import load_recording
from tests.check import rig


def recording(folder: Path, first: str, second: str) -> Path:
    """Readings of both heaters under names of one's own."""
    made = rig.write(folder, rig.FIRST, rig.readings(rig.FIRST))
    sidecar = yaml.safe_load((made / "recording.yaml").read_text())
    entries = list(sidecar["channels"].values())
    sidecar["channels"] = dict(zip((first, second), entries))
    (made / "recording.yaml").write_text(yaml.safe_dump(sidecar, sort_keys=False))
    return made


def call(*arguments: object) -> tuple[int, str]:
    result = CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False, env={"COLUMNS": "200"})
    return result.exit_code, result.output


@pytest.mark.parametrize("names", [("heaters.temperature[1]", "heaters.temperature[2]"), ("coil[1].temperature", "")])
def test_both_accept_a_variable_of_a_component_with_its_element(tmp_path: Path, names: tuple[str, str]) -> None:
    folder = recording(tmp_path / "a", names[0], names[1] or "coil[1,2].temperature")
    code, text = call("recording", "check", folder, "--scenario", "tclab")
    assert code == 0, text
    assert names[0] in text
    model = model_of(load_scenario("tclab"), [load_recording(folder)], [])  # what `cosim diagnose` searches with
    assert [(s.quantity, s.element) for s in model.runs[0].series] == [("temperature", 0), ("temperature", 1)]


@pytest.mark.parametrize(
    ("first", "second", "what"),
    [
        ("drive.power_1", "coil[1].temperature", "compared by the names"),
        ("coil[1].temperature", "heaters.temperature[1]", "measures the same as coil[1].temperature"),
        ("heaters.temperature[3]", "coil[1].temperature", "no such quantity"),
        ("heaters.temperature", "coil[1].temperature", ""),
    ],
)
def test_both_refuse_the_same(tmp_path: Path, first: str, second: str, what: str) -> None:
    folder = recording(tmp_path / "a", first, second)
    if first == "drive.power_1":
        text = (folder / "recording.yaml").read_text().replace("degC", "W", 1).replace("0.08 K", "0.08 W", 1)
        (folder / "recording.yaml").write_text(text)
    for command in (
        ("recording", "check", folder, "--scenario", "tclab"),
        ("diagnose", "tclab", "--recording", folder, "--out", tmp_path / "answer", "--despite-doubts"),
    ):
        with pytest.raises(InputError) as refused:
            call(*command)
        assert refused.value.key.startswith("channels.")
        assert refused.value.remedy
        if command[0] == "recording":
            assert what in str(refused.value)
