"""Run every probe that its tool is installed for: `python -m benchmarks.peers.probes [NAME ...]`."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks.machine import heading, results_folder
from benchmarks.models.build import build
from benchmarks.peers.job import Job
from benchmarks.peers.tools import Tool, environment, tools

#: Question: job that asks it, through the tools' entries. What the answers mean stands in `meaning`.
JOBS = {
    "fmi3": Job("chain", 3, 10, 1e-3, False, ""),
    "loop": Job("loop", 2, 1, 1e-3, False, ""),
    "units": Job("wrong_units", 2, 10, 1e-3, False, ""),
    "crash": Job("crash", 2, 1000, 1e-3, True, ""),
}
#: Script in this folder, entry of the tool whose interpreter runs it, arguments.
SCRIPTS = [
    ("arrays_ecospy", "ecospy", ()),
    ("arrays_cofmupy", "cofmupy", ()),
    ("arrays_fmpy_container", "fmpy_container", ()),
    ("arrays_fmu_container", "fmu_container", ()),
    ("early_return_ecospy", "ecospy", ()),
    ("early_return_fmpy", "fmpy_loop", ()),
    ("loops_mastersim", "mastersim", ()),
    ("loops_cofmupy", "cofmupy", ()),
    ("loops_pyfmi", "pyfmi", ()),
    ("algorithms_mastersim", "mastersim", ()),
    ("ssp_ecospy", "ecospy", ()),
    ("ssp_libcosimpy", "libcosimpy", ("1.0",)),
    ("ssp_libcosimpy", "libcosimpy", ("2.0",)),
    ("ssp_fmpy", "fmpy_loop", ()),
    ("isolation_ecospy", "ecospy", ("feedthrough_fmi2",)),
    ("isolation_ecospy", "ecospy", ("crasher_fmi2",)),
    *(
        ("model_exchange", tool, (name, version))
        for name, tool in (
            ("fmpy", "fmpy_loop"),
            ("ecospy", "ecospy"),
            ("libcosimpy", "libcosimpy"),
            ("mastersim", "mastersim"),
            ("cofmupy", "cofmupy"),
        )
        for version in ("2", "3")
    ),
]


def start(python: str, arguments: list[str]) -> subprocess.CompletedProcess[str]:
    """One process; a probe that hangs is ended after a minute."""
    command = [python, "-m", *arguments]
    try:
        return subprocess.run(command, capture_output=True, text=True, env=environment(), timeout=60, check=False)
    except subprocess.TimeoutExpired:
        return subprocess.CompletedProcess(command, 1, "", "not done after 60 s")


def ending(done: subprocess.CompletedProcess[str]) -> str:
    """How a process that gave no answer ended."""
    if done.returncode < 0:
        return f"killed by signal {-done.returncode}"
    lines = [line for line in done.stderr.splitlines() if line.strip() and not line.startswith("[20")]
    last = re.sub(r"/[\w./+-]*/", "", lines[-1].strip())[:160] if lines else "no message"  # folders of this machine
    return f"exit code {done.returncode}: {last}"


def ask(tool: Tool, question: str) -> str:
    """One of `JOBS` through the tool's entry."""
    assert tool.python is not None
    with tempfile.TemporaryDirectory() as work:
        job = Job(**{**json.loads(JOBS[question].text()), "work": work})
        done = start(tool.python, [f"benchmarks.peers.entries.{tool.module}", job.text()])
        rows = [len(file.read_text(errors="replace").splitlines()) for file in Path(work).rglob("*.csv")]
        kept = [file for file in Path(work).rglob("*") if file.is_file() and "run" in file.parts]
    kept_text = f"; {max(rows, default=0)} lines of CSV, {len(kept)} files of a run" if question == "crash" else ""
    if done.returncode:
        return ending(done) + kept_text
    answer = done.stdout.strip().splitlines()[-1]
    found = json.loads(answer[answer.index("{") :])
    return f"time {found['end_time']:.6g} s, outputs {[round(v, 9) for v in found['values']]}{kept_text}"


def run_script(python: str, script: str, arguments: tuple[str, ...]) -> str:
    """One script of this folder."""
    done = start(python, [f"benchmarks.peers.probes.{script}", *arguments])
    lines = done.stdout.strip().splitlines()
    if done.returncode or not lines or "{" not in lines[-1]:
        return ending(done)
    return str(json.loads(lines[-1][lines[-1].index("{") :])["finding"])


def main(names: list[str]) -> None:
    """Print and write the table; with names, only those, and nothing is written."""
    build()
    installed = {tool.module: tool for tool in tools() if tool.python is not None}
    rows = []
    for question in JOBS:
        for tool in installed.values():
            if not names or question in names:
                rows.append((question, tool.name, ask(tool, question)))
                print(*rows[-1], sep=" | ", flush=True)
    for script, module, arguments in SCRIPTS:
        if module in installed and (not names or script in names):
            python = installed[module].python
            assert python is not None
            name = " ".join([script, *arguments])
            rows.append((name, installed[module].name, run_script(python, script, arguments)))
            print(*rows[-1], sep=" | ", flush=True)
    if not names:
        lines = [
            heading("What each tool does when it is asked", "python -m benchmarks.peers.probes"),
            "Questions: `fmi3`, two FMI 3.0 FMUs, expected [3.0]; `loop`, an algebraic loop after one macro-step,",
            "solution [2.0, 2.0]; `units`, a force connected to a velocity, to be refused; `crash`, an FMU that",
            "aborts its process at 0.5 s, 1 ms steps, results recorded. Others: the script of that name.",
            "",
            "| probe | tool | found |",
            "|---|---|---|",
            *(f"| {a} | {b} | {c.replace('|', '/')} |" for a, b, c in rows),
            "",
        ]
        (results_folder() / "peers_probes.md").write_text("\n".join(lines))


if __name__ == "__main__":
    main(sys.argv[1:])
