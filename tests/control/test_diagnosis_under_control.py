"""A controller hides an effect: readings follow the setpoint. The diagnosis sees it in what drives."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from cosim.run import run
from tests.control.concealed import closed_loop, rig

ROOT = Path(__file__).resolve().parents[2]


def test_the_controller_hides_the_effect():
    """With a resistance that rises by 4 % the temperatures stay the same, and only the voltage tells."""
    plain, other = run(closed_loop("none", "monday")), run(closed_loop("resistance", "monday"))
    late = slice(70.0, 74.9)
    temperatures = [d["actuator.temperature"].sel(time=late).mean() for d in (plain, other)]
    voltages = [d["controller.command"].sel(time=late).mean() for d in (plain, other)]
    assert abs(float(temperatures[1] - temperatures[0])) < 0.1
    # U^2 / R holds the temperature: U goes with the root of 1 + 0.0011 (58 - 22).
    assert float(voltages[1] / voltages[0]) == pytest.approx(np.sqrt(1.0 + 0.0011 * 36.0), abs=0.003)


@pytest.mark.slow
def test_a_resistance_that_rises_is_found_behind_a_controller(tmp_path):
    scenario = rig(tmp_path, "resistance")
    days = ["--recording", str(tmp_path / "monday"), "--recording", str(tmp_path / "tuesday")]
    days += ["--held-out", str(tmp_path / "wednesday")]
    command = [sys.executable, "-m", "cosim.cli", "diagnose", str(scenario), *days, "--brief", "--jobs", "1"]
    done = subprocess.run(
        [*command, "--out", str(tmp_path / "answer")], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    found = json.loads((tmp_path / "answer" / "diagnosis.json").read_text())
    assert found["verdict"] == "missing physics"
    assert "temperature-dependent resistance, all coils" in " ".join(found["statement"].split())
    assert "0.0011" in done.stdout
