"""A solver that gives up says so in the error, and writes nothing of its own."""

from __future__ import annotations

from pathlib import Path

import pytest

from cosim.run import RunStopped, run
from cosim.scenario import parse_scenario
from evaluation.fmus.model import OdeModel

BLOWN = OdeModel(
    "blown",
    {"k": (1.0, "1/s")},
    {"u": "1"},
    {"x": ("1", "0", "(x > 0.5 ? -1e30*x*x*x : 1.0)*k + u")},
    {"seen": ("1", "x")},
)
SCENARIO = """
title: A rate that jumps beyond what any step can follow
time: {stop: 2 s, macro_step: 1 s, output_step: 1 s}
components:
  drive: {kind: programme, outputs: {u: {unit: "1", constant: "0"}}}
  blown: {kind: fmu, fmu: blown.fmu, integrator: cvode}
connections: [drive.u -> blown.u]
"""


def test_a_failure_of_cvode_is_in_the_error_alone(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    BLOWN.build(tmp_path)
    capfd.readouterr()
    with pytest.raises(RunStopped, match="CVODE failed"):
        run(parse_scenario(SCENARIO, tmp_path / "scenario.yaml"))
    assert capfd.readouterr() == ("", "")
