"""Components that are called as a kind of element of this program's own: coil, supply, string, link, marker, fabric."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from cosim.unit.errors import InputError
from diagnosis.check.check import check_recordings
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.diagnosis import Verdict
from diagnosis.recording.recording import load_recording
from diagnosis.search.search import Settings
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import held, write_recording

STEP, COUNT = 0.5, 400
SCENARIO = """\
title: A first-order rig
time: {{stop: 200 s, macro_step: 0.5 s, output_step: 0.5 s}}
components:
  drive: {{kind: programme, outputs: {{value: {{unit: V, constant: 1 V}}}}}}
  {name}: {{kind: fmu, fmu: {name}.fmu, integrator: cvode}}
connections: [drive.value -> {name}.u]
"""
#: Names of components with an output each; some pairs name a quantity of a circuit or of a fabric.
NAMES = [
    ("coil", "current"),
    ("coil", "temperature"),
    ("supply", "current"),
    ("supply", "voltage"),
    ("supply", "pressure"),
    ("string", "voltage"),
    ("link", "length"),
    ("link", "force"),
    ("marker", "x"),
    ("fabric", "length"),
    ("fabric", "strain"),
]
UNITS = {"current": "A", "temperature": "K", "voltage": "V", "pressure": "Pa", "length": "m", "x": "m", "force": "N"}


def _recordings(folder: Path, name: str, output: str) -> list[Path]:
    unit = UNITS.get(output, "1")
    model = OdeModel(name, {"tau": (10.0, "s")}, {"u": "V"}, {"y": (unit, "0", "(2*u - y)/tau")}, {output: (unit, "y")})
    model.build(folder)
    (folder / "scenario.yaml").write_text(SCENARIO.format(name=name), encoding="utf-8")
    found = []
    for number in range(3):
        rng = np.random.default_rng(number)
        u = np.repeat(rng.uniform(0.0, 4.0, 20), COUNT // 20)
        y = held(lambda x, v: np.array([(2.0 * v - x[0]) / 10.0]), np.zeros(1), u, STEP)[:, 0]
        columns = {"t": STEP * np.arange(COUNT), "u": u, "y": y + 0.02 * rng.standard_normal(COUNT)}
        channels = {f"{name}.{output}": ("y", unit, f"0.02 {unit}")}
        found.append(write_recording(folder / f"run_{number + 1}", columns, {"drive.value": ("u", "V")}, channels))
    return found


@pytest.mark.parametrize(("name", "output"), NAMES)
def test_a_component_of_any_name_is_compared(tmp_path: Path, name: str, output: str) -> None:
    recordings = [load_recording(r) for r in _recordings(tmp_path, name, output)]
    assert check_recordings(load_scenario(str(tmp_path / "scenario.yaml")), recordings) == ()


@pytest.mark.parametrize(("name", "output"), [("coil", "current"), ("supply", "current"), ("fabric", "length")])
def test_a_component_of_any_name_is_diagnosed(tmp_path: Path, name: str, output: str) -> None:
    every = [load_recording(r) for r in _recordings(tmp_path, name, output)]
    scenario = load_scenario(str(tmp_path / "scenario.yaml"))
    found = diagnose(scenario, every[:2], every[2:], Settings(), options=Options(is_brief=True)).diagnosis
    assert found.verdict is Verdict.CONSISTENT, found.statement


@pytest.mark.parametrize(("name", "output"), NAMES)
def test_a_table_of_such_a_component_is_proposed_and_read(command, tmp_path: Path, name: str, output: str) -> None:
    (recording, *_) = _recordings(tmp_path, name, output)
    raw = recording / "data.csv"
    text = raw.read_text(encoding="utf-8")
    unit = UNITS.get(output, "1")
    head, _, rest = text.partition("\n")
    raw.write_text(head.replace("t,u,y", f"t_s,value [V],{output} [{unit}]") + "\n" + rest, encoding="utf-8")
    out = tmp_path / "proposed"
    code, said, error = command("recording", "new", raw, "--scenario", tmp_path / "scenario.yaml", "--out", out)
    assert code == 0, said + error
    assert f"{name}.{output}" in load_recording(out).channels


def test_a_coil_of_a_circuit_without_its_number_is_refused_with_how_to_name_it(tmp_path: Path) -> None:
    scenario = load_scenario("tclab")
    columns = {"t": 2.0 * np.arange(60), "T": 300.0 + np.zeros(60)}
    path = write_recording(tmp_path / "run", columns, {}, {"coil.temperature": ("T", "K", "0.1 K")})
    with pytest.raises(InputError, match=r"write `coil\[1\].temperature`, counted from 1"):
        check_recordings(scenario, [load_recording(path)])
