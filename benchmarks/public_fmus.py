"""FMUs of public collections: `cosim fmu info`, `cosim run`, and FMPy's own simulation of the same.

    python -m benchmarks.public_fmus FOLDER...

Every .fmu below the folders that has a binary for this platform is described by `fmu info` and run as a scenario of one
component, with its own start values, over its default experiment (1 s without one, `STEPS` steps where it names no step
size, at most `MOST` of them), in each interface that it offers, each in a process of its own. FMPy's `simulate_fmu`
repeats it with the same steps; every number of every output is compared at every recorded time. The files are fetched
outside the project.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import json
import math
import os
import re
import signal
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import fmpy
import numpy as np
import yaml

from benchmarks.machine import heading, results_folder
from cosim.cli import main as cosim
from cosim.run import RunStopped, run
from cosim.scenario import load_scenario
from cosim.unit.errors import InputError

STEPS, MOST = 500, 2000
#: Relative tolerance that both hand over.
TOLERANCE = 1e-6
#: Local variables that are compared where there are no outputs.
LOCALS = 20
#: Wall time after which an FMU is given up [s].
LIMIT = 60
INTERFACES = {"CS": ("internal", "CoSimulation"), "ME": ("cvode", "ModelExchange")}


@dataclass(frozen=True)
class Outcome:
    """What came of one FMU.

    Args:
        name: Path below the folder given.
        kind: FMI version and interface.
        result: `ran`, or why not.
        deviation: Largest deviation of an output from FMPy's, relative to max(1, its largest value); None: not
            compared.
        peer: What FMPy did where nothing could be compared.
    """

    name: str
    kind: str
    result: str
    deviation: float | None = None
    peer: str = ""


def experiment(path: Path) -> tuple[float, float, float]:
    """Start, stop and step [s] of an FMU's default experiment; steps are whole microseconds."""
    found = fmpy.read_model_description(str(path), validate=False).defaultExperiment

    def number(text: str | None, default: float) -> float:
        with contextlib.suppress(TypeError, ValueError):
            if math.isfinite(value := float(text)):  # type: ignore[arg-type]
                return value
        return default

    start = number(found.startTime, 0.0) if found else 0.0
    stop = number(found.stopTime, start + 1.0) if found else start + 1.0
    stop = stop if stop > start else start + 1.0
    step = number(found.stepSize, 0.0) if found else 0.0
    step = max(round(step if 0.0 < step < stop - start else (stop - start) / STEPS, 6), 1e-6)
    return start, step, start + step * min(round((stop - start) / step), MOST)


def described(path: Path) -> str:
    """What is wrong with `cosim fmu info` of an FMU; empty where it says something and ends as it should."""
    out, error = io.StringIO(), io.StringIO()
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(error):
            sys.argv = ["cosim", "fmu", "info", str(path)]
            cosim()
    except SystemExit as end:
        if end.code not in (0, None, 2):
            return f"fmu info ended with {end.code}: {error.getvalue()[-200:]}"
    return "" if out.getvalue() or error.getvalue() else "fmu info said nothing"


def once(path: Path, interface: str, folder: Path) -> tuple[str, float | None, str]:
    """Result, deviation and peer of one FMU, in this process."""
    wrong = described(path)
    if wrong:
        return wrong, None, ""
    start, step, stop = experiment(path)
    grid = {"start": start, "stop": stop, "macro_step": step, "output_step": step}
    time = {name: f"{value:.9g} s" for name, value in grid.items()}
    own = {"kind": "fmu", "fmu": str(path), "integrator": INTERFACES[interface][0], "record": _locals(path)}
    if interface == "CS":  # FMPy takes that of the default experiment, we the FMU's own
        own["tolerance"] = TOLERANCE
    file = folder / "scenario.yaml"
    file.write_text(yaml.safe_dump({"title": path.stem, "time": time, "components": {"unit": own}}))
    try:
        results = run(load_scenario(str(file)))
    except InputError as error:
        problem = re.sub(r"/[^ ]*/(?=binaries/)| \(needed by [^)]*\)", "", error.problem)
        return f"refused: {problem}", None, ""
    except RunStopped as error:
        return f"stopped: {error.reason}", None, ""
    found = {
        str(n).removeprefix("unit."): v.values
        for n, v in results.items()
        if np.issubdtype(v.dtype, np.number) and v.dims == ("time",)
    }
    if not found:
        return "ran", None, "no number to compare"
    return "ran", *_against_fmpy(path, INTERFACES[interface][1], (start, step, stop), results["time"].values, found)


def _locals(path: Path) -> list[str]:
    """Local numbers of an FMU that has no outputs, the first `LOCALS`: else there is nothing to compare."""
    with contextlib.suppress(Exception):  # what is wrong with it is said where it runs
        every = fmpy.read_model_description(str(path), validate=False).modelVariables
        if not any(v.causality == "output" for v in every):
            kinds = ("Real", "Float64", "Float32", "Integer", "Int32")
            named = [v.name for v in every if v.causality == "local" and v.type in kinds and not v.dimensions]
            return named[:LOCALS]
    return []


def _against_fmpy(
    path: Path, kind: str, grid: tuple[float, float, float], times: np.ndarray, found: dict[str, np.ndarray]
) -> tuple[float | None, str]:
    start, step, stop = grid
    try:
        result = fmpy.simulate_fmu(
            str(path),
            start_time=start,
            stop_time=stop,
            step_size=step if kind == "CoSimulation" else None,
            output_interval=step,
            relative_tolerance=TOLERANCE,
            fmi_type=kind,
            output=list(found),
            validate=False,
            record_events=False,
        )
    except Exception as error:  # fmpy raises bare Exception
        return None, f"FMPy: {str(error)[:150]}"
    theirs = np.asarray(result["time"], dtype=float)
    index = np.searchsorted(theirs, times - 0.5 * step)
    index = np.minimum(index, len(theirs) - 1)
    both = np.abs(theirs[index] - times) < 1e-6 * max(step, 1e-9) + 1e-9
    worst = 0.0
    for name, own in found.items():
        other = np.asarray(result[name], dtype=float)[index][both]
        off = np.abs(own[both].astype(float) - other)
        off = np.where(own[both] == other, 0.0, off)
        if len(off):
            worst = max(worst, float(np.nanmax(off)) / max(1.0, float(np.nanmax(np.abs(other)))))
    return worst, "" if both.all() else f"compared at {np.count_nonzero(both)} of {len(both)} times"


def in_process(path: Path, interface: str) -> tuple[str, float | None, str]:
    """The same in a forked process, so that a crash or an endless step is only its own."""
    with tempfile.TemporaryFile() as answer:
        child = os.fork()
        if child == 0:
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
            os.dup2(1, 2)
            signal.alarm(LIMIT)
            try:
                with tempfile.TemporaryDirectory() as folder:
                    text = json.dumps(once(path, interface, Path(folder)))
            except Exception as error:
                text = json.dumps((f"{type(error).__name__}: {error}", None, ""))
            answer.write(text.encode())
            answer.flush()
            os._exit(0)
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        answer.seek(0)
        data = answer.read()
    if status == -signal.SIGALRM:
        return f"not finished in {LIMIT} s", None, ""
    if status < 0:
        return f"crashed with {signal.Signals(-status).name}", None, ""
    result, deviation, peer = json.loads(data)
    return result, deviation, peer


def examine(folder: Path) -> list[Outcome]:
    """All FMUs below a folder, each once."""
    seen: set[str] = set()
    outcomes = []
    for path in sorted(folder.rglob("*.fmu")):
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        if digest in seen:
            continue
        seen.add(digest)
        name = str(path.relative_to(folder.parent))
        try:
            description = fmpy.read_model_description(str(path), validate=False)
            platforms = fmpy.supported_platforms(str(path))
        except Exception as error:
            outcomes.append(Outcome(name, "?", f"no FMU: {error}"))
            continue
        if not {fmpy.platform, fmpy.platform_tuple} & set(platforms):
            outcomes.append(
                Outcome(name, f"FMI {description.fmiVersion}", f"no binary for this platform ({', '.join(platforms)})")
            )
            continue
        for interface, kind in (("CS", description.coSimulation), ("ME", description.modelExchange)):
            if kind is not None:
                outcomes.append(
                    Outcome(name, f"FMI {description.fmiVersion} {interface}", *in_process(path, interface))
                )
                print(outcomes[-1], flush=True)
    return outcomes


def main(arguments: Sequence[str]) -> None:
    """Examine all folders and write the table."""
    if not arguments:
        sys.exit(__doc__)
    outcomes = [o for folder in arguments for o in examine(Path(folder))]
    lines = ["| FMU | kind | result | deviation from FMPy |", "|---|---|---|---|"]
    for o in outcomes:
        deviation = "" if o.deviation is None else f"{o.deviation:.1e}"
        deviation = "; ".join(filter(None, (deviation, o.peer.replace("|", "/").replace("\n", " "))))
        lines.append(f"| {o.name} | {o.kind} | {o.result.replace('|', '/')[:240]} | {deviation} |")
    ran = sum(o.result == "ran" for o in outcomes)
    text = heading("Public FMUs", "python -m benchmarks.public_fmus FOLDER...")
    counts = {
        "ran": ran,
        "without a binary for this platform": sum("no binary" in o.result for o in outcomes),
        "of FMI 1.0": sum("FMI 1.0" in o.result for o in outcomes),
        "that need a library which is not installed": sum("shared object" in o.result for o in outcomes),
    }
    rest = len(outcomes) - sum(counts.values())
    text += "\nOf " + f"{len(outcomes)}: " + ", ".join(f"{n} {what}" for what, n in counts.items())
    text += f", {rest} others.\n\n" + "\n".join(lines) + "\n"
    (results_folder() / "public_fmus.md").write_text(text)


if __name__ == "__main__":
    main(sys.argv[1:])
