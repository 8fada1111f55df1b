"""Every command of docs/gallery.md runs, in the order of the page, and leaves what it says."""

import re
import shlex
from pathlib import Path

import pytest
from typer.testing import CliRunner

from cosim.cli import app

ROOT = Path(__file__).resolve().parents[1]
PAGE = (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8")
SECTIONS = {
    section.splitlines()[0]: [
        line
        for block in re.findall(r"^```sh\n(.*?)^```", section, re.MULTILINE | re.DOTALL)
        for line in block.splitlines()
    ]
    for section in PAGE.split("\n## ")[1:]
}
#: What the commands of a section leave.
LEFT = {
    "Heat coils, and look at them": [
        "coils/results.nc",
        "coils/figures/temperatures.svg",
        "coils/figures/currents.pdf",
    ],
    "Another actuator, side by side": ["side_by_side/comparison.md", "side_by_side/comparison.png"],
    "A fabric of one's own": ["my_fabric.yaml", "fabric/results.nc"],
    "An actuator of one's own": ["latex_coil/latex_coil_fmi3.fmu"],
    "A recording, and what it says about the model": ["recorded/recording.yaml", "rig/tuesday/recording.yaml"],
    "A system for other tools": ["heating.ssp", "exported/tcp_muscle_fmi2_n4.fmu"],
}


def test_every_section_is_known_here():
    assert set(SECTIONS) == set(LEFT)
    assert all(SECTIONS.values())


@pytest.mark.parametrize(
    "section", [pytest.param(s, marks=[pytest.mark.slow] if s.startswith("Another actuator") else []) for s in LEFT]
)
def test_the_commands_of_a_section_run(section, shipped_fmus, tmp_path, monkeypatch):
    monkeypatch.setenv("COSIM_FMU_PATH", str(shipped_fmus))
    monkeypatch.chdir(tmp_path)
    for command in SECTIONS[section]:
        program, *arguments = shlex.split(command)
        assert program == "cosim"
        done = CliRunner().invoke(app, arguments)
        assert done.exit_code == 0, f"{command}\n{done.output}\n{done.exception}"
    for file in LEFT[section]:
        assert (tmp_path / file).is_file(), file
