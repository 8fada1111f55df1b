"""Time, memory and overlap of fabrics of many sizes, in both engines: short drapes from flat, cold."""

from __future__ import annotations

import argparse
import json
import multiprocessing
import time
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.bullet_convergence import MACRO_STEP, prototype, woven_unit
from benchmarks.engines import ESCAPED
from benchmarks.machine import heading, resident_memory, results_folder
from cosim.unit.protocol import UnitError
from mechanics.solver import SolverSettings

#: (rows, columns), and the simulated time [s] of each.
SIZES = ((6, 2, 0.5), (3, 8, 0.5), (6, 6, 0.3), (6, 12, 0.2), (12, 12, 0.1), (12, 24, 0.1))
ENGINES: dict[str, dict[str, Any]] = {
    "Bullet": {"micro_step": 5e-4, "iterations": 200},
    "MuJoCo": {"micro_step": 2.5e-4, "iterations": 200, "engine": "mujoco"},
}


def measure(engine: str, rows: int, columns: int, duration: float) -> dict[str, Any]:
    """One drape; processor time, contacts over its second half, deepest overlap, memory of the process."""
    found: dict[str, Any] = {"engine": engine, "rows": rows, "columns": columns, "duration": duration, "failure": ""}
    begin = time.process_time()
    design = prototype(rows=rows, columns=columns, tether_rows=1 if rows < 6 else 2)
    unit = woven_unit(design, SolverSettings(penetration_limit=ESCAPED, **ENGINES[engine]), 0)
    found |= {"links": design.links, "free": int((~unit._layout.is_fixed).sum()), "load": time.process_time() - begin}
    steps = round(duration * 1e9) // MACRO_STEP
    contacts, overlap, seconds = [], 0.0, []
    try:
        for index in range(steps):
            begin = time.process_time()
            unit.do_step(index * MACRO_STEP, MACRO_STEP)
            seconds.append(time.process_time() - begin)
            contacts.append(float(unit.get("contact_count")))
            overlap = max(overlap, float(unit.get("max_penetration")))
    except UnitError as error:
        found["failure"] = error.what
    unit.terminate()
    half = len(seconds) // 2
    return found | {
        "simulated": len(seconds) * MACRO_STEP / 1e9,
        "per_second": float(np.sum(seconds)) / (len(seconds) * MACRO_STEP / 1e9),
        "contacts": float(np.mean(contacts[half:])),
        "per_contact": float(np.sum(seconds[half:]) / np.sum(contacts[half:]) / (MACRO_STEP / 1e9)),
        "overlap": overlap,
        "memory": resident_memory(),
    }


def table(rows: list[dict[str, Any]]) -> str:
    """Markdown, one line per run."""
    lines = [
        "| engine | rows x columns | links (free) | simulated [s] | loaded in [s] | time per simulated second [s] "
        "| contacts | the same per contact [ms] | deepest overlap [mm] | memory [MiB] | |",
        "|---" * 11 + "|",
    ]
    for r in rows:
        lines.append(
            f"| {r['engine']} | {r['rows']} x {r['columns']} | {r['links']} ({r['free']}) | {r['simulated']:g} | "
            f"{r['load']:.2f} | {r['per_second']:.3g} | {r['contacts']:.0f} | {1e3 * r['per_contact']:.3g} | "
            f"{1e3 * r['overlap']:.3f} | {r['memory']:.0f} | {r['failure']} |"
        )
    return "\n".join(lines) + "\n"


def main(arguments: list[str] | None = None) -> None:
    """Print and write the table; runs that the file of single runs has are not made again."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--most", type=int, default=564, help="links of the largest fabric")
    parser.add_argument("--runs", type=Path, default=Path("runs/fabric_size.jsonl"), help="file of the single runs")
    given = parser.parse_args(arguments)
    given.runs.parent.mkdir(parents=True, exist_ok=True)
    known = [json.loads(line) for line in given.runs.read_text().splitlines()] if given.runs.exists() else []
    there = {(r["engine"], r["rows"], r["columns"]) for r in known}
    context = multiprocessing.get_context("spawn")  # each in a process of its own: memory is that of one fabric
    for rows, columns, duration in SIZES:
        for engine in ENGINES:
            if (engine, rows, columns) in there or rows * (2 * columns - 1) > given.most:
                continue
            with context.Pool(1) as pool:
                known.append(pool.apply(measure, (engine, rows, columns, duration)))
            with given.runs.open("a") as file:
                file.write(json.dumps(known[-1]) + "\n")
    text = heading("Fabrics of many sizes", "python -m benchmarks.fabric_size") + (
        "\nCold drapes from flat. Times are of a processor, which a busy machine changes little; contacts and time per "
        "contact are means over the second half of a run.\n\n"
    )
    text += table(known)
    (results_folder() / "fabric_size.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
