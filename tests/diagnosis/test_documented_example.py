"""The example of docs/diagnosis.md gives what the page says, all files included."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from typer.testing import CliRunner

from cosim.cli import app

ROOT = Path(__file__).resolve().parents[2]
RIG = ROOT / "docs" / "examples" / "rig"
#: What was concealed in the readings [1/K].
ALPHA = 0.0011


@pytest.fixture(scope="module")
def answer(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    folder = Path(shutil.copytree(RIG, tmp_path_factory.mktemp("example") / "my_rig"))
    out = folder / "answer"
    arguments = ["diagnose", str(folder / "scenario.yaml"), "--recording", str(folder / "monday")]
    result = CliRunner().invoke(app, [*arguments, "--held-out", str(folder / "tuesday"), "--out", str(out)])
    assert result.exit_code == 0, result.output
    return result.output, out


def test_the_effect_and_its_strength_are_found(answer: tuple[str, Path]) -> None:
    told = json.loads((answer[1] / "diagnosis.json").read_text())
    assert told["verdict"] == "missing physics"
    (finding,) = told["findings"]
    assert (finding["effect"], finding["place"]) == ("temperature_dependent_resistance", "all coils")
    assert finding["ambiguous_with"] == []
    (alpha,) = finding["parameters"]
    assert alpha["lower"] < ALPHA < alpha["upper"]
    assert alpha["upper"] - alpha["lower"] < 0.2 * ALPHA


def test_held_out_readings_are_predicted_within_their_noise(answer: tuple[str, Path]) -> None:
    told = json.loads((answer[1] / "diagnosis.json").read_text())["adequacy"]
    # 1 is noise alone; some 3500 readings scatter it by 0.024.
    assert told["chi_square"]["after"] == pytest.approx(1.0, abs=0.1)
    assert told["chi_square"]["recalibrated"] > 1.3 * told["chi_square"]["after"]
    assert told["explained"] > 0.99
    assert not told["is_rejected"]


def test_every_file_of_the_page_is_there_and_the_terminal_shows_what_the_page_shows(answer: tuple[str, Path]) -> None:
    output, out = answer
    for name in ("report.html", "diagnosis.json", "amended/scenario.yaml", "amended_without_terms/scenario.yaml"):
        assert (out / name).is_file(), name
    page = (ROOT / "docs" / "diagnosis.md").read_text()
    shown = page.split("The terminal shows, among more:")[1].split("```")[1].strip().splitlines()
    said = [line.rstrip() for line in output.splitlines()]
    for line in shown:
        assert line.rstrip() in said, line


@pytest.mark.parametrize("part", ["actuator", "load"])
def test_amended_fmus_are_valid_in_both_versions_of_fmi(answer: tuple[str, Path], part: str, tmp_path: Path) -> None:
    amended = answer[1] / "amended"
    second = tmp_path / f"{part}_fmi2.fmu"
    build = ["fmu", "build", str(amended / "sources" / part), "--coils", "2", "--fmi", "2", "--out", str(second)]
    assert CliRunner().invoke(app, build).exit_code == 0
    for fmu in (amended / f"amended_{part}_fmi3.fmu", second):
        result = CliRunner().invoke(app, ["fmu", "validate", str(fmu)])
        assert result.exit_code == 0, result.output
        assert "every check passes" in result.output
