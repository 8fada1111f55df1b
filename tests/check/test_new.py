"""`cosim recording new`: tables of any make become a recording that loads, or are refused in one sentence."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

from cosim.cli import app
from cosim.components import ProgrammeComponent
from cosim.scenario import load_scenario
from cosim.unit.errors import InputError
from diagnosis.check.heading import heading
from diagnosis.check.sniff import read_table
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import load_recording
from tests.check import rig


def lines(separator: str, is_comma: bool, time: str = "seconds") -> str:
    """Three columns of the first programme's readings."""
    values = rig.readings(rig.FIRST)[:60]
    found = []
    for n, row in enumerate(values):
        clock = f"{2.0 * n:.1f}" if time == "seconds" else f"2026-11-22T10:{2 * n // 60:02d}:{2 * n % 60:02d}"
        cells = [clock, f"{row[0]:.2f}", f"{row[1]:.2f}"]
        found.append(separator.join(c.replace(".", ",") if is_comma else c for c in cells))
    return "\n".join(found)


def new(table: Path, out: Path) -> object:
    return CliRunner().invoke(
        app, ["recording", "new", str(table), "--scenario", "tclab", "--out", str(out)], catch_exceptions=False
    )


@pytest.mark.parametrize(
    ("header", "separator", "is_comma", "time", "mark"),
    [
        ("time_s,T1_degC,T2_degC", ",", False, "seconds", ""),
        ("Logger 5\n;;\ntime [s];T1 [°C];T2 [°C]", ";", True, "seconds", "\ufeff"),
        ("timestamp\tTemp 1 (degC)\tTemp 2 (degC)", "\t", False, "dates", ""),
    ],
    ids=["plain", "decimal comma, mark, lines before", "dates"],
)
def test_three_makes_of_one_table(
    tmp_path: Path, header: str, separator: str, is_comma: bool, time: str, mark: str
) -> None:
    table = tmp_path / "raw.csv"
    table.write_text(mark + header + "\n" + lines(separator, is_comma, time) + "\n", encoding="utf-8")
    new(table, tmp_path / "out")
    recording = load_recording(tmp_path / "out")
    assert list(recording.channels) == ["coil[1].temperature", "coil[2].temperature"]
    channel = recording.channels["coil[2].temperature"]
    np.testing.assert_allclose(channel.times, 2.0 * np.arange(60))
    np.testing.assert_allclose(channel.values, np.round(rig.readings(rig.FIRST)[:60, 1], 2) + 273.15, atol=1e-9)
    # 60 readings tell a deviation to about 15 %
    assert 0.5 * rig.NOISE < channel.deviation < 1.6 * rig.NOISE


def test_unclear_columns_are_comments_with_the_reason(tmp_path: Path) -> None:
    table = tmp_path / "raw.csv"
    rows = [f"{n},{20 + n % 3},{n},{n},{n},ok" for n in range(20)]
    table.write_text("\n".join(["time_s,T1_degC,T7_degC,I_mA,depth,note", *rows]))
    new(table, tmp_path / "out")
    text = (tmp_path / "out" / "recording.yaml").read_text()
    assert list(yaml.safe_load(text)["channels"]) == ["coil[1].temperature"]
    assert "# unclear column T7_degC: it may be coil[1].temperature, coil[2].temperature" in text
    assert "# unclear column I_mA: the scenario has no channel in A" in text
    assert "# unclear column depth: its name has no unit that is known" in text
    assert "# unclear column note: it holds text (`ok`)" in text


def test_nothing_is_overwritten(tmp_path: Path) -> None:
    table = tmp_path / "raw.csv"
    table.write_text("time_s,T1_degC,T2_degC\n" + lines(",", False))
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "recording.yaml").write_text("mine")
    with pytest.raises(InputError, match="this file exists already"):
        new(table, tmp_path / "out")
    assert (tmp_path / "out" / "recording.yaml").read_text() == "mine"


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "no table with a header row"),
        ("a,b\n1,2\n", "no table with a header row"),
        ("time_s,T1\n" + "\n".join(f"{n},{n}" for n in range(5)) + "\n5,broken", "`broken` in row 6 of this column"),
        ("time_s,T1\n" + "\n".join(f"{n},{n}" for n in range(5)) + "\n5,5,5", "it has 3 values, the header 2"),
        ("time_s,T1,T1\n" + "\n".join(f"{n},{n},{n}" for n in range(5)), "two columns have this name"),
        (
            "time_s;T1;T2\n" + "\n".join(f"{n};{n},5;{n}.5" for n in range(5)),
            "decimal commas (`0,5`) and decimal points",
        ),
    ],
    ids=["empty", "too short", "text", "ragged", "doubled", "both signs"],
)
def test_refused_in_one_sentence(tmp_path: Path, text: str, problem: str) -> None:
    table = tmp_path / "raw.csv"
    table.write_text(text)
    with pytest.raises(InputError) as caught:
        read_table(table)
    assert problem in str(caught.value)


def test_no_column_of_times(tmp_path: Path) -> None:
    table = tmp_path / "raw.csv"
    table.write_text("T1_degC,T2_degC\n" + "\n".join("20.5,20.4" for _ in range(12)))
    with pytest.raises(InputError, match="no column holds rising times"):
        new(table, tmp_path / "out")


def test_names_of_columns() -> None:
    assert (heading("I1_mA").unit, heading("I1_mA").numbers) == ("mA", (1,))
    assert (heading("coil[2,3].temperature [degC]").numbers, heading("x1_mm").si_unit) == ((2, 3), "m")
    assert heading("T1").unit is None


@pytest.mark.parametrize("scenario", ["tclab", "sma_limb", "pendulum"])
def test_the_proposed_conditions_load_once_their_comment_signs_are_gone(tmp_path: Path, scenario: str) -> None:
    """What a recording changes was named in no form that could be used."""
    table = tmp_path / "raw.csv"
    table.write_text("time_s,T1_degC,angle_rad\n" + "\n".join(f"{n / 10},{22 + n % 3},{n % 5}" for n in range(60)))
    CliRunner().invoke(
        app,
        ["recording", "new", str(table), "--scenario", scenario, "--out", str(tmp_path / "out")],
        catch_exceptions=False,
    )
    sidecar = tmp_path / "out" / "recording.yaml"
    lines = sidecar.read_text().splitlines()
    begin = lines.index("# overrides:") if "# overrides:" in lines else len(lines)
    end = next((k for k in range(begin, len(lines)) if not lines[k].startswith("#  ") and k > begin), len(lines))
    block = [line.removeprefix("# ") for line in lines[begin:end]]
    proposed = yaml.safe_load("\n".join(block))["overrides"]["components"]
    sidecar.write_text("\n".join([*lines[:begin], *block, *lines[end:]]) + "\n")
    loaded = load_scenario(scenario)
    same = scenario_of(loaded, load_recording(tmp_path / "out"))
    programmes = {n: c for n, c in loaded.components.items() if isinstance(c, ProgrammeComponent)}
    assert {n: same.components[n] for n in programmes} == programmes
    assert programmes.keys() <= proposed.keys()
    assert len(proposed) == len(programmes) + 1  # how one component starts
