"""FMUs of public collections, run by our units and compared with FMPy's own simulation.

    python -m benchmarks.public_fmus FOLDER...

Every .fmu below the folders that has a binary for this platform runs for 1 s in 100 steps with its own start values,
in each interface that it offers, each in a process of its own; Co-Simulation is repeated with FMPy's `simulate_fmu`.
The files are fetched outside the project.
"""

from __future__ import annotations

import hashlib
import json
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

from benchmarks.machine import heading, results_folder
from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.model_exchange import ModelExchangeUnit
from cosim.fmu.unit import FmuSettings
from cosim.unit.errors import InputError
from cosim.unit.protocol import NANOSECONDS, Causality, StepStatus, UnitError

STEPS, SIZE = 100, NANOSECONDS // 100
#: Wall time after which an FMU is given up [s].
LIMIT = 30
UNITS = {"CS": CoSimulationUnit, "ME": ModelExchangeUnit}


@dataclass(frozen=True)
class Outcome:
    """What came of one FMU.

    Args:
        name: Path below the folder given.
        kind: FMI version and interface.
        result: `ran`, or why not.
        deviation: Largest deviation of an output at 1 s from FMPy's, relative to max(1, value); None: not compared.
    """

    name: str
    kind: str
    result: str
    deviation: float | None = None


def run(path: Path, interface: str) -> tuple[str, float | None]:
    """Result and deviation of one FMU, in this process."""
    try:
        archive = open_fmu(path)
    except InputError as error:
        return f"refused: {error.problem}", None
    try:
        unit = UNITS[interface]("unit", archive, FmuSettings())
        unit.initialise(0)
        unit.exit_initialisation()
        for index in range(STEPS):
            outcome = unit.do_step(index * SIZE, SIZE)
            if outcome.status is not StepStatus.OK:
                return f"{outcome.status.value} at {outcome.time / NANOSECONDS:g} s", None
    except InputError as error:
        return re.sub(r"/\S*/(?=binaries/)", "", error.problem), None
    except UnitError as error:
        return str(error), None
    found = {
        n: np.array(unit.get(n), dtype=float)
        for n, v in unit.variables.items()
        if v.causality is Causality.OUTPUT and v.type.is_float and not v.shape
    }
    unit.terminate()
    return "ran", _against_fmpy(path, found) if interface == "CS" and found else None


def _against_fmpy(path: Path, found: dict[str, np.ndarray]) -> float | None:
    try:
        result = fmpy.simulate_fmu(
            str(path),
            stop_time=1.0,
            step_size=0.01,
            output_interval=0.01,
            fmi_type="CoSimulation",
            output=list(found),
            set_stop_time=False,
            validate=False,
        )
    except Exception:  # fmpy raises bare Exception
        return None
    last = {n: float(result[n][-1]) for n in found}
    return max(abs(found[n] - last[n]) / max(1.0, abs(last[n])) for n in found)


def in_process(path: Path, interface: str) -> tuple[str, float | None]:
    """The same in a forked process, so that a crash or an endless step is only its own."""
    with tempfile.TemporaryFile() as answer:
        child = os.fork()
        if child == 0:
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
            os.dup2(1, 2)
            signal.alarm(LIMIT)
            try:
                text = json.dumps(run(path, interface))
            except Exception as error:
                text = json.dumps((f"{type(error).__name__}: {error}", None))
            answer.write(text.encode())
            answer.flush()
            os._exit(0)
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        answer.seek(0)
        data = answer.read()
    if status == -signal.SIGALRM:
        return f"not finished in {LIMIT} s", None
    if status < 0:
        return f"crashed with {signal.Signals(-status).name}", None
    result, deviation = json.loads(data)
    return result, deviation


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
