"""Every model of modelica/Reference-FMUs, in both FMI versions and both interfaces, against its reference results.

The FMUs are built outside the project (`cmake -DFMI_VERSION=2` and `=3` in a copy of the repository). Usage:

    python -m benchmarks.reference_fmus FOLDER_OF_FMUS FOLDER_OF_CSV

FOLDER_OF_FMUS holds `fmi2/*.fmu` and `fmi3/*.fmu`; FOLDER_OF_CSV the repository's `*_out.csv`. The CSV files were made
by the FMUs' own forward Euler, so Co-Simulation must meet them to rounding, while Model Exchange, integrated by CVODE,
must meet the exact solution of the equations instead.
"""

from __future__ import annotations

import csv
import itertools
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.machine import heading, results_folder
from benchmarks.reference_solutions import EXACT, Exact
from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.model_exchange import ModelExchangeUnit
from cosim.fmu.unit import FmuSettings, FmuUnit
from cosim.unit.errors import InputError
from cosim.unit.protocol import NANOSECONDS, StepStatus, UnitError, VariableType, seconds

INTERFACES: dict[str, Callable[[str, Any, FmuSettings], FmuUnit]] = {
    "CS": CoSimulationUnit,
    "ME": ModelExchangeUnit,
}
#: Co-Simulation repeats the same sums in the same order; the CSV has 16 digits.
SAME = 1e-12
#: CVODE at its default tolerance of 1e-8 per step.
INTEGRATED = 1e-5
#: Times [s] at which the Robertson problem is compared; its own CSV is a copy of the bouncing ball's,
#: and in Co-Simulation it steps by 1 us inside.
ROBERTSON_TIMES = {"ME": (1e-5, 0.4, 4.0, 40.0, 400.0, 4000.0), "CS": (1e-5, 1e-4, 1e-3, 0.01, 0.1)}


@dataclass(frozen=True)
class Row:
    """One comparison.

    Args:
        case: Model, version and interface.
        points: Output times compared.
        deviation: Largest deviation, relative to the largest value of the variable (or absolute below 1).
        limit: What it may be.
        remark: Against what, or why not.
    """

    case: str
    points: int
    deviation: float
    limit: float
    remark: str

    @property
    def is_met(self) -> bool:
        """Whether it is within the limit."""
        return self.deviation <= self.limit


def read_reference(path: Path) -> tuple[list[int], dict[str, list[str]]]:
    """Times [ns] and columns of a reference result; of rows with equal times the last counts."""
    with path.open(newline="") as file:
        rows = {round(float(row["time"]) * NANOSECONDS): row for row in csv.DictReader(file)}
    names = [n for n in next(iter(rows.values())) if n != "time"]
    return list(rows), {n: [row[n] for row in rows.values()] for n in names}


def simulate(unit: FmuUnit, times: Sequence[int], names: Sequence[str]) -> tuple[list[dict[str, Any]], str]:
    """Values at every time [ns], and why it ended early."""
    unit.initialise(times[0])
    unit.exit_initialisation()
    values = [{n: unit.get(n).copy() for n in names}]
    for begin, end in itertools.pairwise(times):
        try:
            outcome = unit.do_step(begin, end - begin)
        except UnitError as error:  # an FMU that asks to terminate leaves the outputs of its last instant
            if "asks to terminate" in str(error) and error.time == end:
                values.append({n: unit.get(n).copy() for n in names})
            return values, str(error)
        if outcome.status is not StepStatus.OK:
            return values, outcome.message
        values.append({n: unit.get(n).copy() for n in names})
    return values, ""


def expected(unit: FmuUnit, name: str, text: str) -> np.ndarray[Any, Any]:
    """A field of the CSV as an array of the variable's type."""
    v = unit.variables[name]
    if v.type is VariableType.STRING:
        return np.array(text, dtype=object)
    if v.type is VariableType.BINARY:
        return np.array(bytes.fromhex(text), dtype=object)
    if v.type is VariableType.BOOLEAN:
        return np.array(text in ("true", "1"))
    return np.array(text.split(), dtype=v.type.dtype).reshape(v.shape)


def deviation(found: np.ndarray[Any, Any], wanted: np.ndarray[Any, Any]) -> float:
    """Largest deviation of (time, ...) arrays relative to the largest value; 0 or infinity for what is no number."""
    if found.dtype.kind not in "fiu":
        return 0.0 if (found == wanted).all() else float("inf")
    scale = max(1.0, float(np.abs(wanted.astype(np.float64)).max()))
    return float(np.abs(found.astype(np.float64) - wanted.astype(np.float64)).max()) / scale


def compare(path: Path, reference: Path, version: int, interface: str) -> Row:
    """Run one FMU through its default experiment."""
    model, case = path.stem, f"{path.stem}, FMI {version}, {interface}"
    exact = EXACT.get(model) if interface == "ME" or model == "Roberts" else None
    if model == "Clocks":
        return Row(case, 0, float("nan"), 0.0, "it offers Scheduled Execution alone, which needs a real-time scheduler")
    if model == "Roberts":
        times, columns = [round(t * NANOSECONDS) for t in ROBERTSON_TIMES[interface]], {"y1": [], "y2": [], "y3": []}
    else:
        times, columns = read_reference(reference / f"{model}_out.csv")
    archive = open_fmu(path)
    try:
        unit = INTERFACES[interface]("unit", archive, FmuSettings())
    except InputError as error:
        archive.remove()
        return Row(case, 0, float("inf"), 0.0, error.problem)
    try:
        columns = {n: texts for n, texts in columns.items() if n in unit.variables}  # FMI 2.0 has fewer types
        values, ended = simulate(unit, times, list(columns))
        worst = _worst(unit, times[: len(values)], values, columns, exact)
    finally:
        unit.terminate()
    limit = INTEGRATED if exact is not None else SAME
    remark = "exact solution" if exact is not None else "CSV"
    missing = len(times) - len(values)
    if missing:
        remark += f"; {missing} of {len(times)} points missing"
    if ended:
        remark += f"; ends with: {ended}"
    return Row(case, len(values), worst, limit, remark)


def _worst(
    unit: FmuUnit,
    times: Sequence[int],
    values: Sequence[dict[str, Any]],
    columns: dict[str, list[str]],
    exact: Exact | None,
) -> float:
    solution = exact(np.array([seconds(t) for t in times])) if exact is not None else {}
    worst = 0.0
    for name, texts in columns.items():
        found = np.array([row[name] for row in values])
        if name in solution:
            wanted = solution[name]
        else:
            wanted = np.array([expected(unit, name, text) for text in texts[: len(values)]])
        worst = max(worst, deviation(found, wanted))
    return worst


def feedthrough_of_extremes(path: Path, version: int, interface: str) -> Row:
    """Feedthrough with the largest and smallest value of every integer type, text and bytes: what goes in comes out."""
    unit = INTERFACES[interface]("unit", open_fmu(path), FmuSettings())
    faults, count = 0, 0
    try:
        unit.initialise(0)
        unit.exit_initialisation()
        for index, pick in enumerate((min, max)):
            given = {n: _extreme(v.type, pick) for n, v in unit.variables.items() if n.endswith("_input")}
            for name, value in given.items():
                unit.set(name, np.array(value, dtype=unit.variables[name].type.dtype))
            unit.do_step(index * NANOSECONDS, NANOSECONDS)
            for name, value in given.items():
                output = name.removesuffix("_input") + "_output"
                faults += unit.get(output) != np.array(value, dtype=unit.variables[name].type.dtype)
                count += 1
    finally:
        unit.terminate()
    return Row(f"Feedthrough of extremes, FMI {version}, {interface}", count, float(faults), 0.0, "its own inputs")


def _extreme(vtype: VariableType, pick: Callable[..., Any]) -> Any:
    special = {
        VariableType.STRING: pick("", "größer"),
        VariableType.BINARY: pick(b"", b"\x00\xff\x00"),
        VariableType.BOOLEAN: pick(False, True),
        VariableType.ENUMERATION: pick(1, 2),
    }
    if vtype in special:
        return special[vtype]
    info: Any = np.finfo(vtype.dtype) if vtype.is_float else np.iinfo(vtype.dtype)
    return pick(info.min, info.max)


def table(rows: Sequence[Row]) -> str:
    """Markdown table."""
    lines = ["| case | points | largest deviation | limit | met | against |", "|---|---|---|---|---|---|"]
    for row in rows:
        met = "yes" if row.is_met else "no"
        lines.append(f"| {row.case} | {row.points} | {row.deviation:.1e} | {row.limit:.0e} | {met} | {row.remark} |")
    return "\n".join(lines)


def main(arguments: Sequence[str]) -> None:
    """Compare all FMUs and write the table."""
    if len(arguments) != 2:
        sys.exit(__doc__)
    fmus, reference = map(Path, arguments)
    rows = []
    for version in (2, 3):
        for path in sorted((fmus / f"fmi{version}").glob("*.fmu")):
            for interface in INTERFACES:
                rows.append(compare(path, reference, version, interface))
                if path.stem == "Feedthrough":
                    rows.append(feedthrough_of_extremes(path, version, interface))
    met = sum(row.is_met for row in rows)
    text = heading("Reference FMUs", "python -m benchmarks.reference_fmus FMUS CSV")
    text += "\n" + __doc__.split("\n\n")[-1].strip() + "\n\n" + table(rows) + f"\n\n{met} of {len(rows)} met.\n"
    (results_folder() / "reference_fmus.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main(sys.argv[1:])
