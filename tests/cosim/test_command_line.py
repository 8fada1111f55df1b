"""The command line: exit codes, messages, help."""

import json
import signal
import time

import pytest
import xarray as xr
import yaml
from typer.testing import CliRunner

from cosim.assemble import assemble
from cosim.cli import app
from cosim.run import run
from cosim.scenario import json_schema, load_scenario, shipped_scenarios

from .conftest import finish
from .short_runs import drape, heating, shortened, with_parameters

FOUND = ("hanging_contraction", "passive_drape", "prototype_cantilever", "single_coil_heating", "water_bath")


def file(folder, scenario, name="mine.yaml"):
    """A scenario written to a folder of its own."""
    path = folder / name
    path.write_text(scenario.to_yaml())
    return path


def is_one_clear_error(answer):
    """One `error:` with a remedy, on stderr, without a traceback."""
    assert answer.err.count("error:") == 1, answer.err
    assert "remedy:" in answer.err
    assert "Traceback" not in answer.err
    return True


@pytest.mark.parametrize("command", ["run", "validate", "list", "schema", "plot", "reproduce"])
def test_every_command_explains_itself(command):
    answer = CliRunner().invoke(app, [command, "--help"])
    assert answer.exit_code == 0
    assert len(answer.output.splitlines()) > 5


def test_without_arguments_the_help_tells_where_to_begin():
    answer = CliRunner().invoke(app, [])
    assert "cosim list" in answer.output
    for command in ("run", "plot", "reproduce", "list", "validate"):
        assert command in answer.output


def test_the_list_names_every_shipped_scenario(cosim):
    answer = cosim("list")
    assert answer.code == 0
    assert set(FOUND) < set(shipped_scenarios())
    assert all(name in answer.out for name in shipped_scenarios())


@pytest.mark.parametrize("name", sorted(shipped_scenarios()))
def test_every_shipped_scenario_is_valid(cosim, name):
    answer = cosim("validate", name)
    assert answer.code == 0, answer.err
    assert f"{name}.yaml: valid" in answer.out
    assembly = assemble(load_scenario(name))  # actuators make connections of their own
    assembly.system.terminate()
    assert f"{len(assembly.scenario.connections)} connections" in answer.out


def test_the_schema_is_printed_as_json(cosim):
    answer = cosim("schema")
    assert answer.code == 0
    assert json.loads(answer.out) == json_schema()


def test_a_run_that_ends_well_exits_with_0_and_names_its_folder(cosim, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    answer = cosim("run", file(tmp_path, heating()), "--no-plots")
    assert (answer.code, answer.err) == (0, "")
    assert "runs/mine" in answer.out
    assert xr.load_dataset("runs/mine/results.nc").sizes["time"] == 31


def test_bad_input_exits_with_2_and_one_error(cosim, tmp_path):
    wrong = tmp_path / "wrong.yaml"
    wrong.write_text(heating().to_yaml().replace("stop: 3 s", "stop: 3 V"))
    for command in (("run", wrong, "--out", tmp_path / "run"), ("validate", wrong)):
        answer = cosim(*command)
        assert answer.code == 2
        assert is_one_clear_error(answer)
        assert "wrong.yaml: time.stop: `3 V` is no quantity in s" in answer.err
    assert not (tmp_path / "run").exists()


def test_a_missing_scenario_exits_with_2_and_lists_those_there_are(cosim):
    answer = cosim("run", "no_such_scenario")
    assert answer.code == 2
    assert is_one_clear_error(answer)
    assert "passive_drape" in answer.err


def test_an_unknown_option_exits_with_2(cosim):
    assert cosim("run", "passive_drape", "--colour").code == 2


def test_an_existing_run_is_never_overwritten(cosim, tmp_path):
    path = file(tmp_path, heating())
    assert cosim("run", path, "--out", tmp_path / "run", "--no-plots").code == 0
    before = {p: p.read_bytes() for p in (tmp_path / "run").rglob("*") if p.is_file()}
    answer = cosim("run", path, "--out", tmp_path / "run", "--no-plots")
    assert answer.code == 2
    assert is_one_clear_error(answer)
    assert "already holds a run" in answer.err
    assert {p: p.read_bytes() for p in (tmp_path / "run").rglob("*") if p.is_file()} == before


@pytest.mark.parametrize("left", ["results.nc", "summary.json"])
def test_results_without_their_scenario_are_not_overwritten_either(cosim, tmp_path, left):
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / left).write_text("precious")
    answer = cosim("run", file(tmp_path, heating()), "--out", tmp_path / "run", "--no-plots")
    assert answer.code == 2
    assert (tmp_path / "run" / left).read_text() == "precious"


def test_nothing_to_resume_exits_with_2(cosim, tmp_path):
    answer = cosim("run", file(tmp_path, heating()), "--out", tmp_path / "run", "--resume", "--no-plots")
    assert answer.code == 2
    assert is_one_clear_error(answer)
    assert "no run to resume" in answer.err


def test_a_run_that_fails_exits_with_1_and_says_what_is_kept(start, tmp_path):
    broken = with_parameters(heating(), "actuator", resistance_temperature_coefficient="-0.05 1/K")
    answer = finish(start("run", file(tmp_path, broken), "--out", tmp_path / "run", "--no-plots"))
    assert answer.code == 1
    assert "stopped: actuator at t = 0.7 s: fmi3DoStep returned error: resistance[6]" in answer.err
    assert f"kept: {tmp_path / 'run' / 'results.nc'}" in answer.err
    assert "Traceback" not in answer.err


#: As a shell without job control has it for what it starts with `&`.
IGNORED = "import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)"


@pytest.mark.parametrize(("number", "prelude"), [(signal.SIGINT, ""), (signal.SIGTERM, ""), (signal.SIGTERM, IGNORED)])
def test_ctrl_c_exits_with_130_and_the_run_resumes_to_the_same_result(start, cosim, tmp_path, number, prelude):
    scenario, folder = shortened("passive_drape", "1 s", checkpoint_step="0.1 s"), tmp_path / "run"
    process = start("run", file(tmp_path, scenario), "--out", folder, "--no-plots", prelude=prelude)
    while process.poll() is None and not list(folder.glob("checkpoints/*.npz")):
        time.sleep(0.02)
    process.send_signal(number)
    answer = finish(process)
    assert answer.code == 130, answer.err
    assert "stopped: interrupted at t = " in answer.err
    assert f"go on with: cosim run {folder} --resume" in answer.err
    assert "Traceback" not in answer.err
    kept = xr.load_dataset(folder / "results.nc")
    whole = run(scenario)
    assert 0 < kept.sizes["time"] < whole.sizes["time"]
    assert cosim("run", folder, "--resume", "--no-plots").code == 0
    resumed = xr.load_dataset(folder / "results.nc")
    assert all((resumed[name].values == whole[name].values).all() for name in whole.data_vars)


def test_a_missing_libngspice_is_one_error_that_names_the_packages(start, tmp_path):
    answer = finish(start("validate", "single_coil_heating", NGSPICE_LIBRARY_PATH=str(tmp_path / "libngspice.so")))
    assert answer.code == 2
    assert is_one_clear_error(answer)
    assert "components.circuit" in answer.err
    assert "libngspice0" in answer.err


def test_fmus_that_were_never_built_are_one_error_with_the_command(cosim, tmp_path, monkeypatch):
    monkeypatch.setenv("COSIM_FMU_PATH", str(tmp_path))
    answer = cosim("validate", "single_coil_heating")
    assert answer.code == 2
    assert is_one_clear_error(answer)
    assert "components.actuator.fmu" in answer.err
    assert "cosim fmu build thermal_stiffness --fmi 3" in answer.err
    assert not list(tmp_path.iterdir())  # nothing is built in a folder that the user named


@pytest.mark.parametrize("size", [2_000, 60_000, 400_000])
def test_a_full_disk_is_one_clear_error_and_the_run_resumes_once_there_is_room(start, cosim, tmp_path, size):
    """No file may grow beyond `size` bytes: the operating system refuses as it does on a full disk."""
    scenario, folder = drape(), tmp_path / "run"
    # 2 kB stops the first checkpoint; 400 kB is enough for this run, so the limit does bite.
    limit = f"import resource; resource.setrlimit(resource.RLIMIT_FSIZE, ({size}, {size}))"
    answer = finish(start("run", file(tmp_path, scenario), "--out", folder, "--no-plots", prelude=limit))
    assert "Traceback" not in answer.err, answer.err
    if size == 400_000:
        assert answer.code == 0, answer.err
        return
    assert answer.code == 1
    assert answer.err.count("cannot be written") == 1, answer.err
    assert "free some room, then go on with `--resume`" in answer.err
    assert not list(folder.rglob("*.part"))
    assert cosim("run", folder, "--resume", "--no-plots").code == 0
    whole, resumed = run(scenario), xr.load_dataset(folder / "results.nc")
    assert all((resumed[name].values == whole[name].values).all() for name in whole.data_vars)


def test_a_folder_that_cannot_be_made_is_one_clear_error(cosim, tmp_path):
    (tmp_path / "taken").write_text("a file")
    answer = cosim("run", file(tmp_path, heating()), "--out", tmp_path / "taken" / "run", "--no-plots")
    assert answer.code == 2
    assert is_one_clear_error(answer)
    assert "cannot be written" in answer.err


def test_the_resolved_scenario_stands_alone_and_writes_its_defaults(cosim, tmp_path):
    assert cosim("run", file(tmp_path, drape()), "--out", tmp_path / "run", "--no-plots").code == 0
    written = yaml.safe_load((tmp_path / "run" / "scenario.yaml").read_text())
    assert "parameter_set" not in written["components"]["fabric"]
    assert written["components"]["fabric"]["parameters"]["link_mass"] == "7.3 g"
    assert written["components"]["fabric"]["solver"]["iterations"] == 200
    assert written["algorithm"]["kind"] == "gauss_seidel"
    again = load_scenario(tmp_path / "run" / "scenario.yaml")
    assert yaml.safe_load(again.to_yaml(is_complete=True)) == written
