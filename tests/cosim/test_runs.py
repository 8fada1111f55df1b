"""Whole runs: folder, resumption, repetition, balances."""

import csv
import itertools
import json
import math

import numpy as np
import pytest
import xarray as xr

from cosim.run import RunStopped, run
from cosim.run_folder import RunFolder
from cosim.scenario import GaussSeidel, Jacobi, load_scenario
from cosim.unit.errors import InputError

from .short_runs import changed, drape, heating, prototype, quantity, shortened, with_parameters

ALGORITHMS = {"jacobi": Jacobi(kind="jacobi"), "gauss_seidel": GaussSeidel(kind="gauss_seidel")}
SHORT = {"drape": drape, "heating": heating, "prototype": prototype}


def assert_same(one, other):
    assert set(one.data_vars) == set(other.data_vars)
    for name in one.data_vars:
        assert np.array_equal(one[name].values, other[name].values, equal_nan=True), name


@pytest.mark.parametrize("name", SHORT)
def test_a_run_repeats_to_the_last_bit(name):
    assert_same(run(SHORT[name]()), run(SHORT[name]()))


@pytest.mark.parametrize("name", SHORT)
def test_an_interrupted_run_resumes_to_the_same_result(tmp_path, name):
    scenario, folder = SHORT[name](), tmp_path / "run"
    whole = run(scenario, tmp_path / "whole")

    def interrupt(progress):
        if progress.done >= 0.55 * progress.total:
            raise KeyboardInterrupt

    with pytest.raises(RunStopped) as stopped:
        run(scenario, folder, on_progress=interrupt)
    assert stopped.value.is_interrupt
    kept = xr.load_dataset(folder / "results.nc")
    assert 0 < kept.sizes["time"] < whole.sizes["time"]
    assert_same(kept, whole.isel(time=slice(0, kept.sizes["time"])))
    resumed = run(load_scenario(folder / "scenario.yaml"), folder, resume=True)
    assert_same(resumed, whole)
    assert_same(xr.load_dataset(folder / "results.nc"), whole)


def test_keeping_a_run_does_not_change_it(tmp_path):
    assert_same(run(drape()), run(drape(), tmp_path / "kept"))


def test_the_resolved_scenario_gives_the_same_run_on_its_own(tmp_path):
    whole = run(prototype(), tmp_path / "run")
    assert_same(run(load_scenario(tmp_path / "run" / "scenario.yaml")), whole)


def test_a_run_folder_holds_what_the_documents_promise(tmp_path):
    run(prototype(), tmp_path / "run")
    folder = tmp_path / "run"
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["status"] == "complete"
    assert set(summary["wall_time_s"]["units"]) == {"supply", "room", "circuit", "actuator", "fabric"}
    assert all(v > 0 for v in summary["wall_time_s"]["units"].values())
    assert abs(summary["energy_J"]["relative_residual"]) < 1e-9
    versions = json.loads((folder / "versions.json").read_text())
    assert {"numpy", "pybullet", "fmpy"} <= set(versions) or {"numpy", "pybullet", "fmpy"} <= set(versions["packages"])
    with (folder / "parameters.csv").open() as file:
        rows = {(r["component"], r["parameter"]): r for r in csv.DictReader(file)}
    assert rows["fabric", "link_mass"]["value"] == "7.3 g"
    assert "paper" in rows["fabric", "link_mass"]["source"]
    with (folder / "series.csv").open() as file:
        series = list(csv.reader(file))
    assert series[0][0] == "time [s]"
    assert "fabric.max_curvature [1/m]" in series[0]
    assert len(series) == 1 + 11
    assert all(math.isfinite(float(cell)) for row in series[1:] for cell in row)


def test_results_open_in_xarray_with_names_units_and_coordinates(tmp_path):
    run(prototype(), tmp_path / "run")
    with xr.open_dataset(tmp_path / "run" / "results.nc") as data:
        assert data["fabric.position"].dims == ("time", "link", "axis")
        assert data["fabric.position"].attrs["units"] == "m"
        assert data["actuator.temperature"].dims == ("time", "coil")
        assert data["time"].attrs["units"] == "s"
        assert data["axis"].values.tolist() == ["x", "y", "z"]
        rows = data["fabric.link_length"].groupby("link_row").mean("link")
        assert rows.sizes["link_row"] == 6
        assert data.sizes["link"] == 18
        assert float(data["time"][0]) == -4.0
        assert float(data["time"][-1]) == -3.8


def test_a_folder_that_holds_a_run_is_never_overwritten(tmp_path):
    run(heating(), tmp_path / "run")
    before = (tmp_path / "run" / "results.nc").read_bytes()
    with pytest.raises(InputError, match="already holds a run"):
        run(heating(), tmp_path / "run")
    with pytest.raises(InputError, match="this run is complete"):
        run(heating(), tmp_path / "run", resume=True)
    assert (tmp_path / "run" / "results.nc").read_bytes() == before


def test_there_is_nothing_to_resume_in_an_empty_folder(tmp_path):
    with pytest.raises(InputError, match="no checkpoint to resume from"):
        run(heating(), tmp_path / "run", resume=True)
    assert RunFolder(tmp_path / "run").checkpoints() == []


@pytest.mark.parametrize("algorithm", ["jacobi", "gauss_seidel"])
@pytest.mark.parametrize("integrator", ["internal", "cvode"])
def test_energy_that_goes_in_is_stored_or_given_to_the_air(algorithm, integrator):
    scenario = heating()
    scenario = changed(scenario, "actuator", integrator=integrator)
    scenario = scenario.model_copy(update={"algorithm": ALGORITHMS[algorithm]})
    result = run(scenario)
    assert result.attrs["energy_electrical_J"] > 1.0
    # Closed-form steps lose nothing but rounding; CVODE integrates both energies with rtol 1e-8.
    assert abs(result.attrs["energy_residual"]) < (1e-12 if integrator == "internal" else 1e-6)


def test_energy_balances_with_resistance_that_rises_with_temperature_and_in_water():
    warm = with_parameters(heating(), "actuator", resistance_temperature_coefficient="1e-3 1/K")
    assert abs(run(warm).attrs["energy_residual"]) < 1e-12
    bath = run(shortened("water_bath", "300 s", checkpoint_step="100 s"))
    stored, convected = bath.attrs["energy_stored_J"], bath.attrs["energy_convected_J"]
    assert stored > 0.1
    assert convected == pytest.approx(-stored, rel=1e-12)


def test_kirchhoff_holds_at_every_recorded_step():
    result = run(with_parameters(prototype(), "actuator", resistance_temperature_coefficient="1e-3 1/K"))
    current, voltage = result["circuit.current"].values, result["circuit.voltage"].values
    strings = result["circuit.string_current"].values
    np.testing.assert_allclose(current.reshape(-1, 6, 6), strings[:, :, None] * np.ones(6), rtol=1e-9)
    np.testing.assert_allclose(voltage.reshape(-1, 6, 6).sum(axis=2), 6.0, rtol=1e-9)
    np.testing.assert_allclose(strings.sum(axis=1), result["circuit.supply_current"].values, rtol=1e-9)
    np.testing.assert_allclose(result["circuit.power"].sum("coil"), result["circuit.supply_power"].values, rtol=1e-9)
    assert np.ptp(result["circuit.supply_current"].values) > 1e-3  # the feedback of R(T) is at work


@pytest.mark.parametrize("algorithm", ["jacobi", "gauss_seidel"])
def test_the_electro_thermal_loop_converges_with_first_order(algorithm):
    def temperature(step):
        scenario = shortened("single_coil_heating", "4 s", macro_step=step, output_step="400 ms", checkpoint_step="4 s")
        scenario = with_parameters(scenario, "actuator", resistance_temperature_coefficient="2e-3 1/K")
        scenario = scenario.model_copy(update={"algorithm": ALGORITHMS[algorithm]})
        return run(scenario)["actuator.temperature"].values[-1]

    exact = temperature("1 ms")
    errors = [np.abs(temperature(f"{h} ms") - exact).max() for h in (200, 100, 50)]
    orders = [math.log2(a / b) for a, b in itertools.pairwise(errors)]
    assert orders == pytest.approx([1.0, 1.0], abs=0.1)


def test_co_simulation_and_model_exchange_agree_over_a_run():
    runs = {k: run(changed(heating(), "actuator", integrator=k)) for k in ("internal", "cvode")}
    difference = np.abs(runs["internal"]["actuator.temperature"] - runs["cvode"]["actuator.temperature"])
    # rtol 1e-8 of CVODE on 300 K, restarted at each of 30 steps.
    assert float(difference.max()) < 1e-3


def test_the_two_fmi_versions_give_the_same_run_to_the_last_bit():
    runs = [run(changed(prototype("-3.96 s"), "actuator", fmi=version)) for version in (3, 2)]
    assert_same(*runs)


@pytest.mark.usefixtures("_one_step_per_turn")
def test_progress_counts_steps_and_estimates_what_is_left():
    seen = []
    run(heating(), on_progress=seen.append)
    assert seen[-1].done == seen[-1].total == 30
    assert [p.time for p in seen] == pytest.approx(np.arange(1, 31) / 10)
    assert seen[-1].remaining == 0.0
    assert all(p.remaining >= 0 for p in seen)


def test_a_component_with_another_stiffness_gives_another_run():
    """Guards the comparisons above: results do react to the scenario."""
    soft = changed(
        drape(),
        "coil",
        outputs={
            n: o.model_copy(update={"constant": quantity("0.356 N/mm")}) if n == "stiffness" else o
            for n, o in drape().components["coil"].outputs.items()
        },
    )
    one, other = run(drape()), run(soft)
    assert not np.array_equal(one["fabric.position"].values, other["fabric.position"].values)
