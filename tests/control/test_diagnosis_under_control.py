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


#: Concealed effect to verdict, what its statement names, and the number that was put in.
CONCEALED = {
    "resistance": ("missing physics", "temperature-dependent resistance, all coils", 0.0011),
    "thermometer": ("measurement fault", "bias of a sensor, coil[2,1].temperature", 3.0),
    "drift": ("measurement fault", "drift of a sensor, every temperature", 0.02),
}


@pytest.mark.slow
@pytest.mark.parametrize(("effect", "verdict", "named", "true"), [(e, *w) for e, w in CONCEALED.items()], ids=CONCEALED)
def test_what_a_controller_conceals_is_found(tmp_path, effect, verdict, named, true):
    scenario = rig(tmp_path, effect)
    days = ["--recording", str(tmp_path / "monday"), "--recording", str(tmp_path / "tuesday")]
    days += ["--held-out", str(tmp_path / "wednesday")]
    command = [sys.executable, "-m", "cosim.cli", "diagnose", str(scenario), *days, "--brief", "--jobs", "1"]
    done = subprocess.run(
        [*command, "--out", str(tmp_path / "answer")], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    _check_answer(tmp_path / "answer", verdict, named, true)


def _check_answer(folder: Path, verdict: str, named: str, true: float) -> None:
    found = json.loads((folder / "diagnosis.json").read_text())
    assert found["verdict"] == verdict
    assert named in " ".join(found["statement"].split())
    number = found["findings"][0]["parameters"][0]
    number = number["physical"] or number
    assert number["lower"] < true < number["upper"]
