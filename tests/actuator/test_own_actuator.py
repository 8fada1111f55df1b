"""docs/write-your-own-actuator.md, followed to the letter: its commands and its code, in an empty folder."""

import importlib.util
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from cosim.run import RunStopped, run

from .scenarios import quantity, short

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "write-your-own-actuator.md").read_text()
needs_pythonfmu3 = pytest.mark.skipif(
    importlib.util.find_spec("pythonfmu3") is None, reason="pythonfmu3 is not installed"
)


def section(title):
    """Text of one section of the page."""
    return PAGE.split(f"\n## {title}\n")[1].split("\n## ")[0]


def blocks(text, language):
    """Code blocks of a language, with what stands behind its name."""
    return re.findall(rf"^```{language} ?([^\n]*)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def commands(text):
    """Lines of the shell blocks, but installations."""
    lines = [line for _, block in blocks(text, "sh") for line in block.splitlines()]
    return [line for line in lines if line.startswith("cosim ")]


def follow(line, folder, fmus):
    """Run one command of the page."""
    program = [sys.executable, "-c", "from cosim.cli import main; main()", *shlex.split(line)[1:]]
    path = os.pathsep.join([str(ROOT), *sys.path])
    done = subprocess.run(
        program,
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": path, "COSIM_FMU_PATH": str(fmus), "COLUMNS": "200"},
    )
    assert done.returncode == 0, f"{line}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def replace_lines(file, names, text):
    """Put `text` in place of the entries (of one or more lines) of two parameters that follow each other."""
    lines = file.read_text().splitlines(keepends=True)
    (first,) = [i for i, line in enumerate(lines) if re.match(rf'\s*(V\(|Parameter\("){names[0]}\b', line)]
    (second,) = [i for i, line in enumerate(lines) if re.match(rf'\s*(V\(|Parameter\("){names[1]}\b', line)]
    end = second + 1
    while '")' not in lines[end - 1]:
        end += 1
    file.write_text("".join([*lines[:first], text, *lines[end:]]))


def replace_function(file, text):
    """Put a function in place of the one with the same first line."""
    head = text.splitlines()[0]
    old = file.read_text()
    begin = old.index(head)
    match = re.compile(r"^\}\n|\Z" if file.suffix == ".c" else r"^(?= {0,4}(def|class) )|\Z", re.MULTILINE).search(
        old, begin + len(head)
    )
    file.write_text(old[:begin] + text + old[match.end() :])


def law(kelvin):
    """Stiffness [N/m] that the page promises."""
    return 157.1 + (356.1 - 157.1) / (1 + np.exp((kelvin - 318.15) / 5.0))


def assert_it_softens(run):
    stiffness, kelvin = run["actuator.stiffness"].values, run["actuator.temperature"].values
    assert np.abs(stiffness - law(kelvin)).max() < 1e-9  # rounding of 356 N/m
    # 8 V across six coils for 2.5 s, constants of the template.
    rise = ((8 / 6) ** 2 / 2.2) / 0.00881 * (1 - np.exp(-0.00881 / 0.0396 * 2.5))
    assert kelvin.max() - 295.15 == pytest.approx(rise, rel=1e-9)
    assert stiffness[0].min() > 354.0
    assert stiffness.min() < 180.0
    assert np.isfinite(run["fabric.max_curvature"].values).all()
    assert abs(run.attrs["energy_residual"]) < 1e-9


@pytest.mark.slow
def test_the_page_leads_to_a_running_fabric_in_c(tmp_path, fmus):
    text = section("In C")
    new, *rest = commands(text)
    follow(new, tmp_path, fmus)
    folder = tmp_path / "glassy_coil"
    for name, block in blocks(text, "c"):
        if name == "config.h":
            replace_lines(folder / name, ("soft_temperature", "stiff_temperature"), block)
        else:
            replace_function(folder / name, block)
    answers = {line.split()[1]: follow(line, tmp_path, fmus) for line in rest[:3]}
    assert len(answers) == 2  # fmu (build, validate), run
    assert "every check passes" in answers["fmu"]
    assert_it_softens(xr.load_dataset(tmp_path / "glassy_run" / "results.nc"))
    compared = follow(rest[3], tmp_path, fmus)
    assert "thermal_stiffness" in compared
    assert (tmp_path / "glassy_compared" / "comparison.png").is_file()
    follow(rest[4], tmp_path, fmus)
    info = follow(rest[5], tmp_path, fmus)
    assert re.search(r"glass_temperature +parameter +Float64 +scalar +K +318\.15", info)
    assert re.search(r"stiffness +output +Float64 +12 +N/m", info)
    assert len(rest) == 6


@pytest.mark.slow
@needs_pythonfmu3
def test_the_page_leads_to_the_same_fabric_in_python(tmp_path, fmus):
    text = section("In Python")
    new, *rest = commands(text)
    follow(new, tmp_path, fmus)
    module = tmp_path / "glassy_coil_py" / "actuator.py"
    for name, block in blocks(text, "python"):
        if name == "parameters":
            replace_lines(module, ("soft_temperature", "stiff_temperature"), block)
        else:
            replace_function(module, block)
    outputs = [follow(line, tmp_path, fmus) for line in rest]
    assert len(outputs) == 3
    assert "every check passes" in outputs[1]
    run = xr.load_dataset(tmp_path / "glassy_run_py" / "results.nc")
    assert_it_softens(run)
    assert xr.load_dataset(tmp_path / "glassy_run_py" / "results.nc").sizes["coil"] == 24


def template(cosim, folder, language):
    """FMU of a template as it is."""
    name = f"{language}_coil"
    assert cosim("fmu", "new", folder / name, "--language", language).code == 0
    answer = cosim("fmu", "build", folder / name)
    assert answer.code == 0, answer.err
    return folder / name / f"{name}_fmi3.fmu"


@needs_pythonfmu3
def test_both_templates_give_the_same_run_and_the_python_one_passes_every_check(cosim, tmp_path):
    c, python = (template(cosim, tmp_path, language) for language in ("c", "python"))
    one, other = (run(short(fmu=str(file))) for file in (c, python))
    for name in one.data_vars:
        # The same equations in C and numpy: exp differs in its last digit, over 400 steps.
        assert np.allclose(one[name], other[name], rtol=1e-12, atol=1e-12), name
    assert cosim("fmu", "validate", python).code == 0


@needs_pythonfmu3
def test_two_actuators_in_python_of_different_sizes_live_in_one_process(cosim, tmp_path):
    first = template(cosim, tmp_path, "python")
    other = tmp_path / "other_coil"
    assert cosim("fmu", "new", other, "--language", "python").code == 0
    module = other / "actuator.py"
    module.write_text(module.read_text().replace('"soft_stiffness", 157.1', '"soft_stiffness", 200.0'))
    assert cosim("fmu", "build", other, "--coils", 6).code == 0
    runs = [run(short("1 s", fmu=str(f))) for f in (first, other / "other_coil_fmi3_n6.fmu", first)]
    assert [float(r["actuator.stiffness"][0, 0]) for r in runs] == [157.1, 200.0, 157.1]


@needs_pythonfmu3
def test_an_error_inside_an_actuator_in_python_stops_the_run_with_its_text(cosim, tmp_path):
    file = template(cosim, tmp_path, "python")
    with pytest.raises(RunStopped, match=r"stiffness\[1\] = -.*: it must be finite and positive"):
        run(short(fmu=str(file), parameters={"stiff_stiffness": quantity("-5 kN/m")}))


def test_without_pythonfmu3_the_build_says_what_to_install(cosim, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pythonfmu3.builder", None)
    assert cosim("fmu", "new", tmp_path / "mine", "--language", "python").code == 0
    answer = cosim("fmu", "build", tmp_path / "mine")
    assert answer.code == 2
    assert "pip install pythonfmu3" in answer.err
