"""`cosim recording new` with odd names of files and columns: the next command works when it is pasted."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest
import yaml

from cosim.terminal import as_argument
from diagnosis.recording.recording import load_recording
from tests.check import rig


def table(path: Path, first: str = "T1_degC", second: str = "T2_degC", more: str = "", cells: str = "") -> Path:
    """Readings of both heaters, and further columns with the same cells in each row."""
    values = rig.readings(rig.FIRST)[:60]
    rows = [f"{2.0 * n},{a:.2f},{b:.2f}{cells}" for n, (a, b) in enumerate(values)]
    path.write_text("\n".join([f"time_s,{first},{second}{more}", *rows]) + "\n", encoding="utf-8")
    return path


ODD = ["my runs", "O'Brien", 'a"b', "Prüfstand 1", "-out", "$HOME", "a;b", "überall & nirgends"]


@pytest.mark.parametrize("name", ODD)
def test_the_next_command_works_as_it_is_printed(command, tmp_path, monkeypatch, name):
    """A folder with a blank gave two arguments, one with a dash an option."""
    monkeypatch.chdir(tmp_path)
    raw = table(tmp_path / f"{name}.csv")
    code, said, error = command("recording", "new", raw, "--scenario", "tclab", f"--out={name}")
    assert code == 0, error
    line = next(text for text in said.splitlines() if text.startswith("read it, then: "))
    words = shlex.split(line.removeprefix("read it, then: "))
    assert words[:3] == ["cosim", "recording", "check"]
    code, said, error = command(*words[1:])
    assert error == ""
    assert code in (0, 1)  # a doubt is an answer too
    assert "coil[1].temperature" in said


@pytest.mark.parametrize("name", [*ODD, "plain", "a\nb"])
def test_a_path_is_one_argument_and_no_option(name):
    (word,) = shlex.split(as_argument(name))
    assert Path(word) == Path(name)
    assert not word.startswith("-")


@pytest.mark.parametrize(
    "name", ['"Temp ""1"" [°C]"', '"Temp 1, [°C]"', "Temp 1: [°C]", "Temp '1' [°C]", "-Temp 1 [°C]"]
)
def test_odd_names_of_columns_are_copied_so_that_they_are_found(command, tmp_path, name):
    """A quote in a name broke the copy."""
    raw = table(tmp_path / "raw.csv", first=name)
    code, _, error = command("recording", "new", raw, "--scenario", "tclab", "--out", tmp_path / "out")
    assert code == 0, error
    sidecar = yaml.safe_load((tmp_path / "out" / "recording.yaml").read_text())
    assert "coil[1].temperature" in sidecar["channels"]
    assert load_recording(tmp_path / "out").channels["coil[1].temperature"].times[1] == 2.0


UNCLEAR = {
    "depth": "depth: its name has no unit that is known: write for example "
    "`coil[1].temperature: {column: depth, unit: UNIT}`",
    "T7_degC": "T7_degC: it may be coil[1].temperature, coil[2].temperature: write for example "
    "`coil[1].temperature: {column: T7_degC, unit: degC}` under `channels`",
    "spot_degC": "spot_degC: its name does not say which quantity it is",
    "I_mA": "I_mA: the scenario has no channel in A: leave it out, or correct the unit",
    "setpoint_degC": "setpoint_degC: by its name it is a set point, not a reading: write "
    "`PROGRAMME.OUTPUT: {column: setpoint_degC, unit: degC}` under `inputs`",
    "power_1 [W]": "power_1 [W]: by its name it is the input drive.power_1: write "
    "`drive.power_1: {column: 'power_1 [W]', unit: W}` under `inputs`",
    "Q1 [W]": "Q1 [W]: by its unit it is the input drive.power_1: write "
    "`drive.power_1: {column: 'Q1 [W]', unit: W}` under `inputs` if it was applied so",
    "heat [mW]": "heat [mW]: by its unit it is one of the inputs drive.power_1, drive.power_2: write "
    "`drive.power_1: {column: 'heat [mW]', unit: mW}` under `inputs` if it was applied so",
}


@pytest.mark.parametrize("name", UNCLEAR)
def test_an_unclear_column_is_named_with_what_to_write(command, tmp_path, name):
    """The terminal gave a number alone, and some reasons no remedy."""
    raw = table(tmp_path / "raw.csv", more=f",{name}", cells=",1.5")
    code, said, _ = command("recording", "new", raw, "--scenario", "tclab", "--out", tmp_path / "out")
    assert code == 0
    assert f"unclear column {UNCLEAR[name]}" in said
    text = (tmp_path / "out" / "recording.yaml").read_text()
    assert f"# unclear column {UNCLEAR[name]}" in text
    if name in ("power_1 [W]", "Q1 [W]"):  # followed literally, it loads
        sidecar = yaml.safe_load(text) | {"inputs": yaml.safe_load(UNCLEAR[name].split("`")[1])}
        (tmp_path / "out" / "recording.yaml").write_text(yaml.safe_dump(sidecar))
        assert load_recording(tmp_path / "out").inputs[0].output == "power_1"
