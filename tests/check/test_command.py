"""`cosim recording check`: what is printed, the page, exit codes."""

from __future__ import annotations

import base64
import re
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from cosim.cli import app
from cosim.unit.errors import InputError
from tests.check import rig
from tests.diagnosis.test_report import Page


def check(*arguments: str, columns: int = 200) -> tuple[int, str]:
    width = {"COLUMNS": str(columns)}
    result = CliRunner().invoke(app, ["recording", "check", *arguments], catch_exceptions=False, env=width)
    return result.exit_code, result.output


def test_no_doubt_is_exit_code_0_and_a_page(tmp_path: Path) -> None:
    a = rig.write(tmp_path / "a", rig.FIRST, rig.readings(rig.FIRST))
    page = tmp_path / "page.html"
    code, text = check(str(a), "--scenario", "tclab", "--out", str(page))
    assert code == 0
    assert "No serious doubt. That is no statement about the model" in text
    assert "300 readings each, 0 to 598 s" in text
    assert re.search(r"coil\[2\]\.temperature +°C +0\.08/0\.0[789]", text)
    assert "drive.power_1: programme, 0 to 1 W, switches at 10, 250, 430 s" in text
    html = page.read_text()
    (picture,) = re.findall(r'src="data:image/svg\+xml;base64,([^"]+)"', html)
    svg = base64.b64decode(picture).decode()
    assert "http:" not in html.replace("http://www.w3.org", "")
    assert "https:" not in html
    assert svg.count("<!-- measured -->") == svg.count("<!-- simulated -->") == 2


def test_a_terminal_of_80_columns_has_a_line_for_each_channel_and_cuts_none(tmp_path: Path) -> None:
    a = rig.write(tmp_path / "a", rig.FIRST, rig.readings(rig.FIRST))
    _, text = check(str(a), "--scenario", "tclab", columns=80)
    lines = [line for line in text.splitlines() if "].temperature" in line]
    assert len(lines) == 2
    number = r"-?\d+(\.\d+)?"
    span = f"{number} to {number}"
    for line in lines:
        whole = rf"coil\[[12]\]\.temperature +°C +0\.08/{number} +{span} +{span}( +{number}){{2}} *"
        assert re.fullmatch(whole, line), line
    assert "…" not in text


def test_serious_doubt_is_exit_code_1_with_its_remedy(tmp_path: Path) -> None:
    a = rig.write(tmp_path / "a", rig.FIRST, rig.readings(rig.FIRST)[:, ::-1])
    code, text = check(str(a), "--scenario", "tclab")
    assert code == 1
    assert "`coil[1].temperature` reads like `coil[2].temperature`" in text
    assert "-> look which of them are exchanged" in text
    assert text.rstrip().endswith("1 serious doubt: settle it first.")


def test_a_fabric_that_takes_long_is_not_simulated_and_the_page_says_so(tmp_path: Path) -> None:
    folder = tmp_path / "f"
    folder.mkdir()
    times = np.arange(0.0, 40.0, 1.0)
    rows = "\n".join(f"{t},{0.1 + 0.001 * (n % 7)}" for n, t in enumerate(times))
    (folder / "data.csv").write_text("time,kappa\n" + rows)
    (folder / "recording.yaml").write_text(
        "title: f\ntable: data.csv\nchannels:\n  fabric.max_curvature: {column: kappa, unit: 1/cm}\n"
    )
    code, text = check(str(folder), "--scenario", "passive_drape")
    assert code == 0
    assert "3 simulations of this fabric take about 19 min on one core: only the readings by themselves" in text
    assert "they were not compared with a simulation" in text


def test_titles_are_escaped_once_on_the_page(tmp_path: Path) -> None:
    title = "<script>&\"' of Monday"
    a = rig.write(tmp_path / "a", rig.FIRST, rig.readings(rig.FIRST)[:, ::-1], title=title)
    check(str(a), "--scenario", "tclab", "--out", str(tmp_path / "page.html"))
    text = (tmp_path / "page.html").read_text()
    page = Page(text)
    assert not page.open
    assert "script" not in page.names
    assert page.text.count(title) == 2  # its heading and the doubt
    assert "coil[1].temperature reads like coil[2].temperature" in page.text
    assert "<code>coil[1].temperature</code> reads like" in text


def test_page_is_not_overwritten(tmp_path: Path) -> None:
    (tmp_path / "page.html").write_text("mine")
    with pytest.raises(InputError, match="this file exists already"):
        check(str(tmp_path), "--scenario", "tclab", "--out", str(tmp_path / "page.html"))


def test_a_recording_that_is_given_twice_is_refused(tmp_path: Path) -> None:
    """It would count as two, and every finding would seem surer than it is."""
    a = rig.write(tmp_path / "a", rig.FIRST, rig.readings(rig.FIRST))
    with pytest.raises(InputError, match="given twice"):
        check(str(a), str(a.parent / "." / "a"), "--scenario", "tclab")
    arguments = ["diagnose", "tclab", "--recording", str(a), "--recording", f"{a}/", "--out", str(tmp_path / "out")]
    with pytest.raises(InputError, match="given twice"):
        CliRunner().invoke(app, arguments, catch_exceptions=False)
