"""A rig of two heaters with time constants of twenty minutes, 85 minutes at 0.1 Hz, as a user diagnoses it."""

import json
import resource

import numpy as np
import pytest
import yaml

from cosim.alone import alone
from cosim.scenario import load_scenario
from cosim.unit.errors import InputError
from diagnosis.candidates.registry import catalogue
from diagnosis.command import diagnose
from diagnosis.models.build import model_of
from diagnosis.recording.recording import load_recording

STOP, EVERY, NOISE, ROOM = 5100.0, 10.0, 0.1, 294.15
CONDUCTANCE, CAPACITY = 0.012, 17.6  # W/K, J/K: the scenario has 16 J/K
PROGRAMMES = {
    "monday": {
        "power_1": [(0, 0.0), (60, 0.4), (2400, 0.1), (4000, 0.3)],
        "power_2": [(0, 0.0), (600, 0.3), (3000, 0.05)],
    },
    "tuesday": {
        "power_1": [(0, 0.0), (30, 0.2), (1500, 0.45), (3600, 0.0)],
        "power_2": [(0, 0.25), (1200, 0.0), (2400, 0.35)],
    },
}


def points(steps):
    return [[f"{t} s", f"{p} W"] for t, p in steps]


def temperature(steps, times):
    """Exact temperature of a lump under power that is held [K]."""
    found, start, tau = np.full(times.size, ROOM), ROOM, CAPACITY / CONDUCTANCE
    for (begin, power), end in zip(steps, [t for t, _ in steps[1:]] + [STOP + 1.0]):
        final = ROOM + power / CONDUCTANCE
        inside = (times >= begin) & (times <= end)
        found[inside] = final + (start - final) * np.exp(-(times[inside] - begin) / tau)
        start = final + (start - final) * np.exp(-(end - begin) / tau)
    return found


@pytest.fixture(scope="module")
def rig(tmp_path_factory):
    """Folder with scenario.yaml, monday and tuesday."""
    folder = tmp_path_factory.mktemp("slow")
    heaters = {
        "kind": "fmu",
        "fmu": "thermal_stiffness",
        "structure": {"coils": 2},
        "parameter_set": "tclab_heater",
        "parameters": {"initial_temperature": "21 degC", "specific_heat": "4000 J/(kg*K)"},
    }
    drive = {name: {"unit": "W", "points": points(p)} for name, p in PROGRAMMES["monday"].items()}
    scenario = {
        "title": "Two slow heaters",
        "time": {"stop": f"{STOP} s", "macro_step": "1 s", "output_step": "10 s", "checkpoint_step": "1000 s"},
        "components": {
            "drive": {"kind": "programme", "outputs": drive},
            "room": {"kind": "programme", "outputs": {"temperature": {"unit": "K", "constant": "21 degC"}}},
            "heaters": heaters,
        },
        "connections": [
            "drive.power_1 -> heaters.power[1]",
            "drive.power_2 -> heaters.power[2]",
            "room.temperature -> heaters.ambient_temperature",
        ],
    }
    (folder / "scenario.yaml").write_text(yaml.safe_dump(scenario))
    rng = np.random.default_rng(5)
    times = np.arange(0.0, STOP + 1.0, EVERY)
    for day, programmes in PROGRAMMES.items():
        (folder / day).mkdir()
        readings = [
            temperature(p, times) - 273.15 + NOISE * rng.standard_normal(times.size) for p in programmes.values()
        ]
        table = np.column_stack([times, *readings])
        np.savetxt(folder / day / "data.csv", table, delimiter=",", header="t,T1,T2", comments="", fmt="%.4f")
        outputs = {name: {"points": points(p)} for name, p in programmes.items()}
        sidecar = {
            "title": day,
            "table": "data.csv",
            "time": {"column": "t", "unit": "s", "zero": 0},
            "overrides": {"components": {"drive": {"outputs": outputs}}},
            "channels": {
                f"coil[{n}].temperature": {"column": f"T{n}", "unit": "degC", "noise": f"{NOISE} degC"} for n in (1, 2)
            },
        }
        (folder / day / "recording.yaml").write_text(yaml.safe_dump(sidecar))
    return folder


def answer(rig, out):
    diagnose(str(rig / "scenario.yaml"), [rig / "monday"], out, [rig / "tuesday"], jobs=1, brief=True)


def test_a_recording_of_85_minutes_is_simulated_in_hundreds_of_steps(rig, shipped_fmus, monkeypatch):
    monkeypatch.setenv("COSIM_FMU_PATH", str(shipped_fmus))
    model = model_of(load_scenario(rig / "scenario.yaml"), [load_recording(rig / "monday")], catalogue(), 1)
    assert len(model.runs[0].inputs.time) < 2 * STOP / EVERY  # 12,751 before


def test_its_diagnosis_is_right_and_a_second_one_at_once_is_refused(rig, shipped_fmus, monkeypatch, tmp_path, capsys):
    monkeypatch.setenv("COSIM_FMU_PATH", str(shipped_fmus))
    out = tmp_path / "out"
    with alone(out, "diagnosis"), pytest.raises(InputError, match="another diagnosis is at work in this folder"):
        answer(rig, out)
    assert not out.exists()
    answer(rig, out)
    found = json.loads((out / "diagnosis.json").read_text())
    assert found["verdict"] == "recalibrated"
    held_out = [f for f in found["fit"] if f["is_held_out"]]
    assert max(f["chi_square"]["after"] for f in held_out) < 1.25  # 510 readings: 4 deviations of their mean square
    assert [p.name for p in out.iterdir()] == ["diagnosis.json"]
    assert ".at-work" not in capsys.readouterr().out


def test_a_full_disk_does_not_cost_the_answer(rig, shipped_fmus, monkeypatch, tmp_path, capsys):
    monkeypatch.setenv("COSIM_FMU_PATH", str(shipped_fmus))
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)

    def limited(text):
        if text.startswith("judging"):  # from here on no file may become larger than 100 byte
            resource.setrlimit(resource.RLIMIT_FSIZE, (100, hard))

    monkeypatch.setattr("cosim.compute.display.Display.stage", lambda _, text: limited(text))
    try:
        with pytest.raises(InputError, match="cannot be written: File too large"):
            answer(rig, tmp_path / "out")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert "RECALIBRATED" in capsys.readouterr().out
    assert not (tmp_path / "out").exists()
