"""`cosim compare`: what is measured, written, resumed; one actuator that fails does not lose the others."""

import csv
import json
import math
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from chainmail.compare.layout import Layout, layout_of
from chainmail.compare.measures import measures
from cosim.run import run
from cosim.run_folder import RunFolder
from cosim.scenario import load_scenario

from .scenarios import changed, quantity, short

ROOT = Path(__file__).resolve().parents[2]
LAYOUT = Layout("actuator", "circuit", "load", 1.0, 21.0)


def values(found):
    return {m.key: m.value for m in found}


@pytest.fixture
def scenario_file(tmp_path):
    """4 s of hanging_coils as a file."""
    path = tmp_path / "mine.yaml"
    path.write_text(short().to_yaml())
    return path


def test_measures_of_the_paper_s_coil_are_those_of_its_closed_forms():
    found = values(measures(run(load_scenario("hanging_coils")), LAYOUT))
    # 1 V across 2.2 ohm for 20 s, six coils.
    assert found["energy_J"] == pytest.approx(6 * 20 / 2.2, rel=1e-9)
    assert found["peak_power_W"] == pytest.approx(6 / 2.2, rel=1e-12)
    assert found["peak_current_A"] == pytest.approx(1 / 2.2, rel=1e-12)
    # Equation (3): rise V^2 / (R h A) times 1 - exp(-rate t), printed constants.
    rate = 90 * 97.85e-6 / (6450 * 7.328e-9 * 837)
    rise = (1 / 2.2) / (90 * 97.85e-6) * (1 - math.exp(-20 * rate))
    assert found["peak_temperature_degC"] == pytest.approx(22 + rise, abs=1e-6)
    assert found["cold_length_mm"] == pytest.approx(9.4 + 981 / found["cold_stiffness_N_per_m"], rel=1e-9)
    assert found["length_change_percent"] == pytest.approx(
        100 * (found["driven_length_mm"] / found["cold_length_mm"] - 1), rel=1e-12
    )
    assert 3.0 < found["delay_on_stiffness_s"] < 9.0  # between one and two time constants, 4.5 s
    assert abs(found["energy_residual"]) < 1e-12
    assert all(math.isnan(found[k]) for k in found if "curvature" in k)  # nothing bends


def series(time, values, unit):
    return xr.DataArray(np.asarray(values, float), dims="time", coords={"time": time}, attrs={"units": unit})


def test_delays_and_levels_are_those_of_a_known_curve():
    time = np.round(np.arange(0.0, 10.001, 0.01), 9)
    bent = 10.0 - 8.0 * np.clip((time - 3.0) / 2.0, 0, 1) + 6.0 * np.clip((time - 7.0) / 1.0, 0, 1)
    dataset = xr.Dataset({"fabric.max_curvature": series(time, bent, "1/m")})
    found = values(measures(dataset, Layout("actuator", None, "fabric", 2.0, 6.0)))
    assert found["cold_curvature_per_cm"] == pytest.approx(0.10, rel=1e-12)
    assert found["driven_curvature_per_cm"] == pytest.approx(0.02, rel=1e-12)
    assert found["after_curvature_per_cm"] == pytest.approx(0.08, rel=1e-12)
    # Half-way at 4.0 s and 7.5 s; the first sample beyond it counts.
    assert found["delay_on_shape_s"] == pytest.approx(2.0, abs=0.011)
    assert found["delay_off_shape_s"] == pytest.approx(1.5, abs=0.011)
    assert math.isnan(found["peak_current_A"])


def test_what_is_under_power_from_the_begin_has_no_cold_state():
    time = np.round(np.arange(0.0, 4.001, 0.01), 9)
    dataset = xr.Dataset({"actuator.stiffness": series(time, 350.0 + 0.0 * time, "N/m")})
    found = values(measures(dataset, Layout("actuator", None, None, 0.0, 3.0)))
    assert math.isnan(found["cold_stiffness_N_per_m"])
    assert math.isnan(found["delay_on_stiffness_s"])


def test_energy_counts_the_power_at_the_end_of_each_step_to_the_last():
    time = np.array([0.0, 1.0, 2.0, 4.0])
    dataset = xr.Dataset({"circuit.power": series(time, [0.0, 0.0, 2.0, 3.0], "W")})
    found = values(measures(dataset, LAYOUT))
    assert found["energy_J"] == 0.0 * 1 + 2.0 * 1 + 3.0 * 2
    assert found["peak_power_W"] == 3.0


def test_no_delay_is_given_where_nothing_moves():
    found = values(measures(run(short(fmu="tcp_muscle")), layout_of(short(), "actuator")))
    assert math.isnan(found["delay_on_stiffness_s"])  # its stiffness is constant
    assert found["cold_stiffness_N_per_m"] == pytest.approx(found["peak_stiffness_N_per_m"], rel=1e-12)


def test_switching_times_come_from_the_programme_that_feeds_the_circuit():
    assert layout_of(load_scenario("hanging_coils"), "actuator") == LAYOUT
    fabric = layout_of(load_scenario("prototype_cantilever"), "actuator")
    assert (fabric.on, fabric.off, fabric.mechanical) == (0.37, 12.6, "fabric")
    spatial = layout_of(load_scenario("spatial_control"), "actuator")
    assert (spatial.on, spatial.off) == (0.0, None)
    bath = layout_of(load_scenario("water_bath"), "actuator")
    assert (bath.on, bath.off) == (None, None)


def test_all_shipped_actuators_stand_side_by_side(cosim, scenario_file, tmp_path):
    out = tmp_path / "out"
    answer = cosim("compare", scenario_file, "--out", out, "--jobs", 1)
    assert answer.code == 0, answer.err
    rows = {row["actuator"]: row for row in csv.DictReader((out / "comparison.csv").read_text().splitlines())}
    assert set(rows) == {"thermal_stiffness", "instant_stiffness", "niti_kinetics", "tcp_muscle", "polypyrrole_film"}
    data = json.loads((out / "comparison.json").read_text())
    for name, row in rows.items():
        dataset = xr.load_dataset(out / name / "results.nc")
        hottest = float(dataset["actuator.temperature"].max()) - 273.15
        assert float(row["peak_temperature_degC"]) == hottest
        assert data["actuators"][name]["peak_temperature_degC"] == hottest
        assert f"{hottest:.4g}" in answer.out
    assert rows["tcp_muscle"]["delay_on_stiffness_s"] == ""
    assert data["actuators"]["tcp_muscle"]["delay_on_stiffness_s"] is None
    assert "| - |" in (out / "comparison.md").read_text()
    assert "delay on, shape half-way [s]" in answer.out
    assert (out / "comparison.png").read_bytes()[:4] == b"\x89PNG"


def test_an_actuator_that_fails_does_not_lose_the_others(cosim, scenario_file, tmp_path, fmus):
    wrong = tmp_path / "wrong.fmu"
    wrong.write_bytes(b"this is no FMU")
    small = fmus / "instant_stiffness_fmi2.fmu"  # 36 coils
    answer = cosim(
        "compare",
        scenario_file,
        "--actuators",
        f"thermal_stiffness,{wrong},{small},tcp_muscle",
        "--out",
        tmp_path / "out",
        "--jobs",
        1,
    )
    assert answer.code == 1
    data = json.loads((tmp_path / "out" / "comparison.json").read_text())
    assert data["actuators"]["wrong"] is None
    assert data["actuators"]["thermal_stiffness"]["energy_J"] == pytest.approx(6 * 2 / 2.2, rel=1e-9)
    assert data["actuators"]["tcp_muscle"]["energy_J"] > 0
    assert "this is not an FMU" in data["problems"]["wrong"]
    assert "is built for 36 coils, its neighbours have 6" in data["problems"]["instant_stiffness_fmi2"]
    assert "failed" in answer.out
    assert "Traceback" not in answer.err


def test_a_comparison_goes_on_from_what_is_there(cosim, scenario_file, tmp_path):
    out = tmp_path / "out"
    command = ("compare", scenario_file, "--actuators", "thermal_stiffness,tcp_muscle", "--out", out, "--jobs", 1)
    assert cosim(*command).code == 0
    kept = RunFolder(out / "thermal_stiffness").results
    before = kept.stat().st_mtime_ns
    # As if it had been stopped in the second run, after a checkpoint.
    begun = RunFolder(out / "tcp_muscle")
    whole = xr.load_dataset(begun.results)
    begun.results.unlink()
    begun.summary.unlink()
    begun.checkpoints()[-1].unlink()
    assert cosim(*command).code == 0
    assert kept.stat().st_mtime_ns == before
    resumed = xr.load_dataset(begun.results)
    assert json.loads(begun.summary.read_text())["resumed"]
    for name in whole.data_vars:
        assert np.array_equal(whole[name], resumed[name]), name


def test_ctrl_c_keeps_what_is_computed_and_the_same_command_goes_on(tmp_path, fmus):
    """A run of 300 s that is interrupted after its first checkpoint."""
    file, out = tmp_path / "long.yaml", tmp_path / "out"
    long = short("300 s")
    file.write_text(long.to_yaml())
    program = [
        sys.executable,
        "-c",
        "from cosim.cli import main; main()",
        "compare",
        str(file),
        "--actuators",
        "thermal_stiffness,tcp_muscle",
        "--out",
        str(out),
        "--jobs",
        "1",
    ]
    environment = {**os.environ, "COSIM_FMU_PATH": str(fmus), "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path])}
    process = subprocess.Popen(
        program, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    while process.poll() is None and not RunFolder(out / "thermal_stiffness").checkpoints():
        time.sleep(0.02)
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does: to every process of the group
    _, err = process.communicate()
    assert process.returncode == 130, err
    assert "the same command goes on from here" in err
    assert "Traceback" not in err
    assert not RunFolder(out / "thermal_stiffness").is_complete()
    again = subprocess.run(program, env=environment, capture_output=True, text=True, check=False)
    assert again.returncode == 0, again.stderr
    assert json.loads(RunFolder(out / "thermal_stiffness").summary.read_text())["resumed"]
    resumed, whole = xr.load_dataset(out / "thermal_stiffness" / "results.nc"), run(long)
    for name in whole.data_vars:
        assert np.array_equal(whole[name], resumed[name]), name


def test_a_folder_of_another_comparison_is_not_taken_for_this_one(cosim, scenario_file, tmp_path):
    command = ("--actuators", "thermal_stiffness", "--out", tmp_path / "out", "--jobs", 1)
    assert cosim("compare", scenario_file, *command).code == 0
    heavier = tmp_path / "heavier.yaml"
    heavier.write_text(changed(short(), "load", mass=quantity("200 g")).to_yaml())
    answer = cosim("compare", heavier, *command)
    assert answer.code == 1
    assert "it holds the run of another scenario" in answer.out


def test_parameters_that_another_actuator_does_not_have_are_left_out_and_said(cosim, tmp_path):
    file = tmp_path / "mine.yaml"
    parameters = {"volume": quantity("8 mm^3"), "coil_rest_length": quantity("12 mm")}
    file.write_text(short(parameters=parameters).to_yaml())
    out = tmp_path / "out"
    answer = cosim("compare", file, "--actuators", "instant_stiffness,thermal_stiffness", "--out", out, "--jobs", 1)
    assert answer.code == 0, answer.err
    assert "instant_stiffness has no volume: left out" in answer.out
    for name in ("instant_stiffness", "thermal_stiffness"):
        assert float(xr.load_dataset(out / name / "results.nc")["actuator.rest_length"][0, 0]) == 0.012


@pytest.mark.parametrize(
    ("scenario", "more", "what"),
    [
        ("passive_drape", (), "no component is of kind actuator"),
        ("hanging_coils", ("--component", "load"), "`load` is no component of kind actuator"),
        ("hanging_coils", ("--actuators", "tcp_muscle,tcp_muscle"), "a name stands twice"),
        ("no_such", (), "there is no such scenario"),
    ],
)
def test_what_cannot_be_compared_is_one_clear_error(cosim, tmp_path, scenario, more, what):
    answer = cosim("compare", scenario, *more, "--out", tmp_path / "out")
    assert answer.code == 2
    assert what in answer.err
    assert "remedy:" in answer.err
