"""What `cosim validate` and `cosim run` say of size, memory and time before a run."""

import pytest

from cosim import estimate as module
from cosim.assemble import assemble
from cosim.cli import main
from cosim.estimate import Estimate, announcement, computing_time, estimate, refuse_too_large
from cosim.run import run
from cosim.scenario import load_scenario
from cosim.unit.errors import InputError


def of(name, *changes):
    assembly = assemble(load_scenario(name, changes))
    try:
        return estimate(assembly)
    finally:
        assembly.system.terminate()


def test_the_size_is_that_of_the_recorded_values():
    changes = ["time.stop=2 s", "time.checkpoint_step=2 s"]
    told = of("tclab", *changes)
    recorded = run(load_scenario("tclab", changes))
    assert told.outputs == recorded.sizes["time"]
    sizes = [values.nbytes for name, values in recorded.data_vars.items() if "." in name]
    assert told.bytes == sum(sizes) + 8 * told.outputs
    assert told.simulated == 2.0


def test_a_large_fabric_is_valid_and_told_to_take_long():
    """The pairs of its 79,800 links were looked for in a table of 47 GB."""
    small, large = of("passive_drape"), of("passive_drape", "fabric.rows=200", "fabric.columns=200")
    assert 20.0 < small.seconds < 200.0  # 18 free links, 10,000 micro-steps: about 50 s
    # 8 x 2 links less two rows held; 200 x 200 less two rows held; each link costs the more, the more there are
    assert large.seconds / small.seconds == pytest.approx((198 * 399 / 18) ** 1.2, rel=0.01)


def test_a_cheaper_solver_is_told_to_take_less():
    whole = of("passive_drape").seconds
    fewer = 1.0 - 0.83 / 2.0  # of the time 83 % are iterations
    assert of("passive_drape", "fabric.solver.iterations=100").seconds == pytest.approx(fewer * whole, rel=0.01)
    assert of("passive_drape", "fabric.solver.friction_model=pyramid").seconds == pytest.approx(0.6 * whole, rel=0.01)


def test_validate_and_run_estimate_by_the_same_numbers():
    """They had constants of their own: 31 s and 49 s for the same drape."""
    for name in ("passive_drape", "single_coil_heating", "tclab"):
        assert of(name).seconds == pytest.approx(computing_time(load_scenario(name)), rel=0.02)


def test_the_constants_are_those_that_were_measured():
    assert (module.PER_FREE_LINK, module.GROWTH, module.OF) == (
        {"bullet": 2.5e-4, "mujoco": 2.7e-5},
        {"bullet": 0.2, "mujoco": 1.2},
        12,
    )
    assert (module.SOLVER, module.ITERATIONS, module.PYRAMID) == (0.83, 200, 0.6)
    assert (module.SOLUTION, module.COIL, module.STEP, module.NUMBER) == (7e-5, 6e-6, 5e-6, 1e-8)
    assert (module.PROGRAM, module.ENGINE, module.LINK, module.COPIES) == (180e6, 25e6, 0.1e6, 2.0)
    assert (module.FILES, module.CERTAIN, module.WORTH_SAYING) == (4.0, 2.0, 120.0)


def test_the_time_goes_with_free_links_micro_steps_and_starts():
    small = computing_time(load_scenario("passive_drape"))
    # 8 x 2 links less two rows held; 5 rows of 4 columns less two rows held.
    wide = computing_time(load_scenario("passive_drape", ["fabric.rows=5", "fabric.columns=4"]))
    assert wide / small == pytest.approx((3 * 7 / (6 * 3)) ** 1.2, rel=1e-3)
    assert computing_time(load_scenario("passive_drape"), 12) == pytest.approx(12 * small)
    fine = computing_time(load_scenario("passive_drape", ["fabric.solver.micro_step=0.25 ms"]))
    assert fine == pytest.approx(2 * small, rel=1e-3)


def test_only_what_takes_minutes_is_announced_with_what_would_be_faster():
    assert announcement(load_scenario("single_coil_heating")) == ""
    assert announcement(load_scenario("passive_drape")) == ""
    said = announcement(load_scenario("prototype_cantilever"), 12, 2)
    assert said.startswith("18 links, 12 starts: about ")
    assert "--set fabric.engine=mujoco" in said
    large = announcement(load_scenario("large_row_by_row"))
    assert large.startswith("276 links: about ")
    assert "engine=mujoco" not in large  # there it is no faster


@pytest.mark.parametrize(
    ("command", "said"),
    [
        (("large_row_by_row",), "276 links: about "),
        (("tclab", "--set", "time.macro_step=1 ns"), "600000000000 macro-steps: about 104 days on an idle machine."),
    ],
)
def test_a_large_run_is_announced_before_it_begins(tmp_path, monkeypatch, capsys, command, said):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("cosim.cli.run_into", lambda *given: None)
    monkeypatch.setattr("sys.argv", ["cosim", "run", *command, "--no-plots"])
    with pytest.raises(SystemExit):
        main()
    assert capsys.readouterr().err.startswith(said)


ENDLESS = ("--set", "time.stop=9e9 s")


def test_a_run_that_no_disk_holds_is_refused_before_anything_is_reserved(cosim, tmp_path):
    answer = cosim("run", "tclab", *ENDLESS, "--out", tmp_path / "run", "--no-plots")
    assert answer.code == 2
    assert "tclab.yaml: time.output_step: 90000000000 macro-steps with 18000000001 recorded times take 4.61 TB;" in (
        answer.err
    )
    assert "free on the disk of" in answer.err
    assert "remedy: take a longer output_step or a nearer stop, or make room" in answer.err
    assert not (tmp_path / "run").exists()


def test_validate_tells_macro_steps_memory_and_files(cosim):
    answer = cosim("validate", "tclab", *ENDLESS)
    assert answer.code == 0
    assert "90000000000 macro-steps; 18000000001 recorded times, 2.3 TB of values" in answer.out
    assert "about 4.61 TB of memory and up to 9.22 TB of files" in answer.out


def test_without_a_folder_the_memory_is_the_limit(monkeypatch):
    scenario = load_scenario("tclab")
    monkeypatch.setattr(module, "_free_memory", lambda: 1e9)
    refuse_too_large(scenario, 900_000_000, 100, None)
    with pytest.raises(InputError, match=r"take 1\.1 GB; there are 1 GB of free memory"):
        refuse_too_large(scenario, 1_100_000_000, 100, None)
    monkeypatch.setattr(module, "_free_memory", lambda: None)  # where the system does not tell
    refuse_too_large(scenario, 1_100_000_000, 100, None)


@pytest.mark.parametrize(
    ("key", "value", "what"),
    [
        ("stop", "1e12 s", "`1000000000000 s` cannot be simulated: time ends at 9.22e+09 s"),
        ("macro_step", "1e-12 s", "`1e-12 s` is less than a nanosecond"),
        ("output_step", "1e-12 s", "`1e-12 s` is less than a nanosecond"),
    ],
)
def test_times_that_cannot_be_counted_are_refused_by_their_key(cosim, tmp_path, key, value, what):
    for command in (("validate",), ("run", "--out", tmp_path / "run")):
        answer = cosim(command[0], "tclab", "--set", f"time.{key}={value}", *command[1:])
        assert answer.code == 2
        assert f"time.{key}: {what}" in answer.err
    assert not (tmp_path / "run").exists()


@pytest.mark.parametrize(
    ("seconds", "size", "words"),
    [
        (
            0.04,
            300,
            "300 bytes of values; about 1 MB of memory and up to 1.2 kB of files; computing takes about 0.04 s",
        ),
        (45.0, 2_400_000, "2.4 MB of values"),
        (45.0, 2_400_000, "computing takes about 45 s, 0.044 simulated seconds a second"),
        (400.0, 3_000_000_000, "up to 12 GB of files; computing takes about 6.7 min"),
        (1e6, 12_000, "computing takes about 12 days"),
        (1e10, 12_000, "computing takes about 317 years"),
    ],
)
def test_numbers_are_told_as_people_read_them(seconds, size, words):
    assert words in str(Estimate(100, 10, size, 1e6, seconds, 2.0))
