"""`--version`, `--set`, `--overwrite`, completion, `cosim example`, and the lines of a run that goes on."""

import re
from multiprocessing import get_context

import pytest
import yaml
from rich.console import Console
from typer.testing import CliRunner

from cosim.cli import app
from cosim.overrides import with_changes
from cosim.progress import Board, line, progress_bar, report_to, reporter, shortened, time_left
from cosim.run import Progress
from cosim.scenario import load_scenario, shipped_scenarios
from cosim.unit.errors import InputError

SHORT = ("--set", "time.stop=100 ms", "--no-plots")
COIL = "single_coil_heating"


def test_the_version_is_shown(cosim):
    answer = cosim("--version")
    assert answer.code == 0
    assert re.fullmatch(r"cosim (\d+\.\d+\S*|unknown)\n", answer.out)


@pytest.mark.parametrize(
    ("change", "read"),
    [
        ("time.stop=5 s", lambda s: str(s.time.stop) == "5 s"),
        ("title=other", lambda s: s.title == "other"),
        ("actuator.fmi=2", lambda s: s.components["actuator"].fmi == 2),
        ("components.actuator.fmi=2", lambda s: s.components["actuator"].fmi == 2),
        ("circuit.strings[1]=5", lambda s: s.components["circuit"].strings == [5]),
        ("circuit.strings=[2, 3]", lambda s: s.components["circuit"].strings == [2, 3]),
        ("algorithm.kind=jacobi", lambda s: s.algorithm.kind == "jacobi"),
        ('actuator.start."a.b"=3', lambda s: "a.b" in s.components["actuator"].start),
        ("supply.outputs.voltage.constant=3 V", lambda s: s.components["supply"].outputs["voltage"].points is None),
    ],
)
def test_set_replaces_one_key(change, read):
    assert read(load_scenario("hanging_coils", [change]))


@pytest.mark.parametrize(
    ("change", "key", "value"),
    [
        ("fabric.parameters.steel_loss[8]=50 %", "steel_loss[8]", "50 %"),
        ('fabric.parameters."steel_loss[8]"=50 %', "steel_loss[8]", "50 %"),
    ],
)
def test_a_parameter_of_a_single_link_is_set_by_its_name(change, key, value):
    assert str(load_scenario("passive_drape", [change]).components["fabric"].parameters[key]) == value


def test_a_list_of_values_keeps_its_places():
    one = with_changes({"components": {"x": {"parameters": {"gains": [1, 2]}}}}, ["x.parameters.gains[2]=5"], [])
    assert one["components"]["x"]["parameters"] == {"gains": [1, 5]}


@pytest.mark.parametrize(
    ("change", "what"),
    [
        ("time.stop", "a key, an equals sign and a value"),
        ("=3", "a key, an equals sign and a value"),
        ("time.stop=", "no value behind the equals sign"),
        ("time.stop=[", "not valid YAML"),
        ("tme.stop=5 s", "did you mean `time`?"),
        ("circit.strings=[6]", "did you mean `circuit`?"),
        ("components.circit.strings=[6]", "did you mean `circuit`?"),
        ("circuit.string=[6]", "did you mean `strings`?"),
        ("circuit.strings[2]=6", "there is no [2]"),
        ("circuit.strings[0]=6", "there is no [0]"),
        ("title[1]=6", "is no list"),
        ("title.x=6", "holds no keys"),
        ("circuit.strings=many", "`many` is not a list"),
        ("time.stop=5 V", "no quantity in s"),
        ('time."stop=5 s', "cannot be read"),
    ],
)
def test_a_change_that_does_not_fit_is_refused_with_its_text(change, what):
    with pytest.raises(InputError) as caught:
        load_scenario("hanging_coils", [change])
    assert what in str(caught.value)
    assert change in str(caught.value)


def test_what_was_set_is_in_the_run_folder(cosim, tmp_path):
    answer = cosim("run", COIL, "--out", tmp_path / "run", *SHORT, "--set", "title=changed")
    assert answer.code == 0, answer.err
    stored = yaml.safe_load((tmp_path / "run" / "scenario.yaml").read_text())
    assert (stored["title"], stored["time"]["stop"]) == ("changed", "100 ms")


def test_a_run_is_replaced_only_on_demand_and_only_its_own_files(cosim, tmp_path):
    out = tmp_path / "run"
    assert cosim("run", COIL, "--out", out, *SHORT).code == 0
    (out / "figures").mkdir()
    (out / "figures" / "old.png").touch()
    (out / "mine.txt").write_text("notes")
    before = (out / "results.nc").read_bytes()
    refused = cosim("run", COIL, "--out", out, *SHORT)
    assert refused.code == 2
    assert "--overwrite" in refused.err
    wrong = cosim("run", COIL, "--out", out, *SHORT, "--overwrite", "--set", "actuator.parameters.colour=1")
    assert wrong.code == 2
    assert (out / "results.nc").read_bytes() == before  # what cannot begin costs nothing
    again = cosim("run", COIL, "--out", out, "--no-plots", "--overwrite", "--set", "time.stop=200 ms")
    assert again.code == 0, again.err
    assert yaml.safe_load((out / "scenario.yaml").read_text())["time"]["stop"] == "200 ms"
    assert (out / "mine.txt").read_text() == "notes"
    assert not (out / "figures" / "old.png").exists()


@pytest.mark.parametrize("words", [("--out", ""), ("--out=",), ("--csv", "--out", "")])
def test_an_option_without_a_value_writes_nothing_into_the_working_folder(cosim, tmp_path, monkeypatch, words):
    monkeypatch.chdir(tmp_path)
    answer = cosim("run", COIL, *SHORT, *words)
    assert answer.code == 2
    assert "--out: its value is empty" in answer.err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("option", [("--set", "time.stop=1 s"), ("--overwrite",)])
def test_a_run_that_goes_on_stays_as_it_is(cosim, tmp_path, option):
    answer = cosim("run", COIL, "--out", tmp_path, "--resume", *option)
    assert answer.code == 2
    assert "a run that goes on stays as it is" in answer.err


def test_tab_completes_the_names_of_scenarios():
    words = {"_COSIM_COMPLETE": "complete_bash", "COMP_WORDS": "cosim run hanging", "COMP_CWORD": "2"}
    done = CliRunner().invoke(app, [], env=words, prog_name="cosim")
    assert done.output.split() == [n for n in shipped_scenarios() if n.startswith("hanging")]


def test_an_example_is_copied_and_never_over_something(cosim, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert cosim("example", "passive_drape", "--out", "mine.yaml").code == 0
    assert load_scenario(tmp_path / "mine.yaml").title == load_scenario("passive_drape").title
    assert cosim("example", "rig").code == 0
    assert (tmp_path / "rig" / "monday" / "recording.yaml").is_file()
    assert "exists already" in cosim("example", "rig").err
    wrong = cosim("example", "rigg")
    assert wrong.code == 2
    assert "did you mean `rig`?" in wrong.err


def progress(done, total, elapsed):
    return Progress(done, total, 0.01 * done, elapsed, 0.01 * done, 0.01)


@pytest.mark.parametrize("share", [0.0, 0.314, 0.999, 1.0])
@pytest.mark.parametrize("left", [0.0, 59.4, 61.0, 3599.0, 3.5e6, float("nan"), float("inf")])
def test_a_line_fits_80_columns_and_has_bar_share_and_time(share, left):
    made = line("A title that is much longer than a line of a terminal can be, with units [mm] and more", share, left)
    assert len(made) <= 79
    assert f"{int(100 * share)} %" in made
    assert ("left" in made) == (left < 3.6e6)


def test_titles_and_times_are_short():
    assert shortened("short") == "short"
    assert shortened("Prototype as a cantilever, 6 V from 0.37 s to 12.6 s") == "Prototype as a cantilever, 6 V..."
    assert [time_left(s) for s in (9, 125, 3780)] == ["9 s left", "2 min 5 s left", "1 h 3 min left"]


def test_a_terminal_shows_bar_share_and_time_left_whatever_the_title(capsys):
    console = Console(force_terminal=True, width=80, color_system=None)
    with progress_bar("A very long title [of a run] that would fill the whole width of the terminal", console) as tell:
        tell(progress(40, 100, 12.0))
    seen = re.sub(r"\x1b\[[0-9;?]*[a-zA-Z]", "", capsys.readouterr().out)
    last = next(part for part in re.split(r"[\r\n]+", seen) if "40 %" in part)
    assert "18 s left" in last  # 60 steps at 0.3 s each
    assert len(last) <= 80


def test_runs_in_other_processes_have_a_line_each(capsys):
    context = get_context("spawn")
    board = Board(["first", "second", "third"], context, Console(width=80))
    report_to(board.slots)
    try:
        reporter(0)(progress(50, 100, 5.0))
        reporter(2)(progress(10, 100, 1.0))
        assert board.running() == [(0, 0.5, pytest.approx(5.0)), (2, 0.1, pytest.approx(9.0))]
        board.ended(0, "done")
        assert [number for number, _, _ in board.running()] == [2]
    finally:
        report_to(None)
    assert "[1/3] first: done" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        (("compare", COIL, "--jobs", "x"), "`x` is not a whole number"),
        (("compare", COIL, "--jobs", "0"), "`0` must be at least 1"),
        (("compare", COIL, "--fmi", "7"), "`7` must be at most 3"),
        (("diagnose", "a", "--recording", "b", "--out", "c", "--level", "much"), "`much` is not a number"),
        (("fmu", "build", "tcp_muscle", "--coils", "1.5"), "`1.5` is not a whole number"),
        (("rnu", COIL), "Did you mean 'run'?"),
        (("run", COIL, "--overwritten"), "--overwrite"),
    ],
)
def test_a_wrong_argument_is_refused_in_our_words(cosim, arguments, what):
    answer = cosim(*arguments)
    assert answer.code == 2
    said = re.sub(r"[\s│]+", " ", answer.err)
    assert what in said
    assert "Input should" not in said
