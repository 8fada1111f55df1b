"""Files that nobody writes on purpose: one clear error each, and no traceback."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from cosim.assemble import assemble
from cosim.cli import app
from cosim.scenario import find_scenario, load_scenario
from cosim.unit.errors import InputError
from cosim.yaml_file import DEEPEST

BASE = """
title: t
time: {stop: 1 s, macro_step: 0.1 s, output_step: 0.1 s}
components:
  u: {kind: fmu, fmu: x.fmu, fmi: 2, parameters: {p: 1}}
"""
DIGITS = "9" * 400
HOSTILE = {
    "macro_step of a picosecond": (("macro_step: 0.1 s", "macro_step: 1e-12 s"), "time", "less than a nanosecond"),
    "an integer of 400 digits": (
        ("{p: 1}", f"{{p: {DIGITS}}}"),
        "components.u.parameters.p",
        "400 digits is too large",
    ),
    "a time of 400 digits": (("stop: 1 s", f"stop: {DIGITS} s"), "time.stop", "is not a finite number"),
    "a bare time of 400 digits": (("stop: 1 s", f"stop: {DIGITS}"), "time.stop", "400 digits is too large"),
    "a time that is too large": (("stop: 1 s", "stop: 1e400 s"), "time.stop", "is not a finite number"),
    "a time that is none": (("stop: 1 s", "stop: .nan"), "time.stop", "is not a finite number"),
    "an infinite step": (("macro_step: 0.1 s", "macro_step: .inf"), "time.macro_step", "is not a finite number"),
    "a negative step": (("macro_step: 0.1 s", "macro_step: -1 s"), "time.macro_step", ""),
    "an FMU's name of 300 letters": (("x.fmu", "y" * 300 + ".fmu"), "", "there is no such FMU"),
    "an actuator's name of 300 letters": (("x.fmu", "y" * 300), "components.u.fmu", "there is no shipped FMU"),
    "a stop beyond 292 years": (
        ("stop: 1 s, macro_step: 0.1 s, output_step: 0.1 s", "stop: 1e30 s, macro_step: 0.5 s, output_step: 0.5 s"),
        "time",
        "ends at 9.22e+09 s",
    ),
    "a name with a slash": (("  u: {", "  a/b: {"), "components.a/b", "`a/b` is not a name"),
    "an FMU that is a folder": (("x.fmu", "/.fmu"), "", "there is no such FMU"),
}


@pytest.mark.parametrize(("change", "key", "what"), HOSTILE.values(), ids=HOSTILE)
def test_a_hostile_value_is_refused_in_words(tmp_path: Path, change: tuple[str, str], key: str, what: str) -> None:
    path = tmp_path / "scenario.yaml"
    assert change[0] in BASE
    path.write_text(BASE.replace(*change))
    with pytest.raises(InputError) as refused:
        assemble(load_scenario(path))
    assert refused.value.key.startswith(key)
    assert what in str(refused.value)
    assert "union" not in str(refused.value)


@pytest.mark.parametrize(
    "text",
    [
        "[" * 100_000,
        "{a: " * 100_000,
        "- " * 100_000,
        "? " * 100_000,
        "[" * 1200 + "]" * 1200,
        "\n".join(" " * n + f"a{n}:" for n in range(1500)),
    ],
    ids=["lists", "mappings", "blocks", "keys", "closed lists", "indented"],
)
def test_nesting_beyond_reason_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "scenario.yaml"
    path.write_text(text)
    with pytest.raises(InputError, match=r"not valid YAML|is missing|must be|is a mapping"):
        load_scenario(path)


def test_long_files_are_no_deep_ones(tmp_path: Path) -> None:
    points = ", ".join(f"[{n} ms, {n % 7} V]" for n in range(5000))
    text = f"""
title: many points
time: {{stop: 5 s, macro_step: 1 ms, output_step: 1 ms}}
components:
  drive: {{kind: programme, outputs: {{u: {{unit: V, points: [{points}]}}}}}}
"""
    path = tmp_path / "scenario.yaml"
    path.write_text(text)
    assert len(load_scenario(path).components["drive"].outputs["u"].points) == 5000  # type: ignore[union-attr]
    assert DEEPEST < 1000


def test_a_scenario_s_name_of_300_letters_is_unknown() -> None:
    with pytest.raises(InputError, match="there is no such scenario"):
        find_scenario("y" * 300)


def test_a_folder_is_no_scenario(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="this is a folder"):
        find_scenario(tmp_path)


@pytest.mark.parametrize("encoding", ["utf-16", "latin-1"])
def test_text_that_is_not_utf_8_is_refused_with_what_to_do(tmp_path: Path, encoding: str) -> None:
    path = tmp_path / "scenario.yaml"
    path.write_bytes(BASE.replace("title: t", "title: Wärme").encode(encoding))
    with pytest.raises(InputError, match=r"its byte \d+ is no UTF-8\n  remedy: give a YAML file, saved as UTF-8"):
        load_scenario(path)


@pytest.mark.parametrize(
    ("connection", "key", "what"),
    [
        ("a.b => c.d", "connections[1]", "`a.b => c.d` is no connection"),
        ("{connect: a.b -> c.d, factr: 2.0}", "connections[1].factr", "did you mean `factor`?"),
        ("5", "connections[1]", "`5`"),
    ],
)
def test_a_wrong_connection_has_one_message_in_our_words(tmp_path: Path, connection: str, key: str, what: str) -> None:
    path = tmp_path / "scenario.yaml"
    path.write_text(f"{BASE}connections: [{connection}]\n")
    with pytest.raises(InputError) as refused:
        load_scenario(path)
    assert refused.value.key == key
    assert what in refused.value.problem
    assert "also" not in refused.value.problem
    assert "constrained" not in str(refused.value)
    assert "ScaledConnection" not in str(refused.value)


def test_foreign_text_does_not_steer_the_terminal(tmp_path: Path) -> None:
    path = tmp_path / "wrong.yaml"
    path.write_text(BASE.replace("fmi: 2", '"\\e[31mred": 2'))
    done = subprocess.run([sys.executable, "-m", "cosim.cli", "validate", str(path)], capture_output=True, text=True)
    assert done.returncode == 2
    assert " [31mred: there is no such key here" in done.stderr
    assert "\x1b" not in done.stderr


def test_commands_that_are_suggested_can_be_pasted(tmp_path: Path) -> None:
    folder = tmp_path / "my rig [1]"
    assert (
        CliRunner()
        .invoke(app, ["example", "passive_drape", "--out", str(folder)])
        .output.endswith(f"  cosim run '{folder}'\n")
    )
