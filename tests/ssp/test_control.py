"""Sensors and controllers in SSP packages."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from cosim.scenario import load_scenario
from cosim.unit.errors import InputError
from tests.control.files import loop
from tests.ssp.runs import round_trip

EXAMPLES = Path(__file__).resolve().parents[2] / "docs" / "examples" / "control"


def test_a_closed_loop_comes_back_as_it_was(tmp_path):
    round_trip(load_scenario("closed_loop_coil"), tmp_path, "2.0")


def test_a_law_in_python_does_not_travel(tmp_path):
    shutil.copy(EXAMPLES / "my_law.py", tmp_path / "my_law.py")
    law = {"kind": "python", "file": "my_law.py", "parameters": {"gain": "0.004 W/K", "integral_time": "4 s"}}
    with pytest.raises(InputError, match="cannot be exported"):
        round_trip(loop({"controller.law": law}, 1.0, tmp_path), tmp_path, "2.0")
