"""The prototype in Bullet and in MuJoCo from the same starts: curvature, sag, lengths, overlap and speed, side by side.

Runs are interleaved: every start goes through all settings before the next one, so that a busy machine slows all alike.
Each run is a line of a JSON file; a run that is there is not made again.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.bullet_convergence import COLD, HOT, MACRO_STEP, prototype, woven_unit
from benchmarks.machine import heading, results_folder
from cosim.unit.protocol import UnitError
from mechanics.solver import SolverSettings

#: Overlap that ends a run [m].
ESCAPED = 2e-3
#: Name to the settings.
SETTINGS: dict[str, dict[str, Any]] = {
    "Bullet, cone, 200": {"micro_step": 5e-4, "iterations": 200},
    "Bullet, anchors, 200": {"micro_step": 5e-4, "iterations": 200, "friction_anchors": True},
    "Bullet, anchors, 0.25 ms, 100": {"micro_step": 2.5e-4, "iterations": 100, "friction_anchors": True},
    "Bullet, pyramid, 200": {"micro_step": 5e-4, "iterations": 200, "friction_model": "pyramid"},
    "Bullet, pyramid, 100": {"micro_step": 5e-4, "iterations": 100, "friction_model": "pyramid"},
    "MuJoCo, 0.5 ms": {"micro_step": 5e-4, "iterations": 200, "engine": "mujoco"},
    "MuJoCo, 0.25 ms": {"micro_step": 2.5e-4, "iterations": 200, "engine": "mujoco"},
}
#: Simulated time cold, then hot [s].
DURATIONS = (2.0, 2.5)


def drape(settings: dict[str, Any], start: int, durations: tuple[float, float], **design: Any) -> dict[str, Any]:
    """Cold, then hot at once, from one random start; means over the last half second of each."""
    unit = woven_unit(prototype(**design), SolverSettings(penetration_limit=ESCAPED, **settings), start)
    found: dict[str, Any] = {"failure": ""}
    now, contacts = 0, 0.0
    try:
        for name, stiffness, duration in (("cold", COLD, durations[0]), ("hot", HOT, durations[1])):
            unit.set("stiffness", np.full(unit.variables["stiffness"].shape, stiffness))
            rows, begin = [], time.process_time()
            for _ in range(round(duration * 1e9) // MACRO_STEP):
                unit.do_step(now, MACRO_STEP)
                now += MACRO_STEP
                centre, lengths = unit.get("row_centre"), unit.get("link_length")
                sag = float(centre[0, 2] - centre[-1, 2])
                rows.append(
                    (
                        float(unit.get("max_curvature")),
                        sag,
                        float(lengths.mean()),
                        float(lengths.max()),
                        float(unit.get("max_penetration")),
                    )
                )
                contacts = float(unit.get("contact_count"))
            taken = time.process_time() - begin
            last, whole = np.mean(rows[-50:], axis=0), np.array(rows)
            found |= {
                f"curvature_{name}": last[0],
                f"sag_{name}": last[1],
                f"length_{name}": last[2],
                f"longest_{name}": last[3],
                f"overlap_{name}": float(whole[:, 4].max()),
                f"real_time_{name}": duration / taken,
                f"contacts_{name}": contacts,
            }
    except UnitError as error:
        found["failure"] = error.what
    unit.terminate()
    return found


def measure(target: Path, starts: int, names: list[str]) -> list[dict[str, Any]]:
    """All runs, those that the file lacks made now."""
    known = [json.loads(line) for line in target.read_text().splitlines()] if target.exists() else []
    there = {(row["settings"], row["start"]) for row in known}
    for start in range(starts):
        for name in names:
            if (name, start) in there:
                continue
            row = {"settings": name, "start": start, **drape(SETTINGS[name], start, DURATIONS)}
            known.append(row)
            with target.open("a") as file:
                file.write(json.dumps(row) + "\n")
    return known


def _band(rows: list[dict[str, Any]], key: str, factor: float = 1.0) -> str:
    values = np.array([row[key] for row in rows if key in row]) * factor
    if not values.size:
        return "-"
    return f"{np.median(values):.2f} ({values.min():.2f} to {values.max():.2f})"


_OVERLAPS = ("overlap_cold", "overlap_hot")
#: Column to the cell that the runs of one setting give.
COLUMNS: dict[str, Callable[[list[dict[str, Any]]], str]] = {
    "starts": lambda rows: str(len(rows)),
    "failed": lambda rows: str(sum(bool(r["failure"]) for r in rows)),
    "cold [1/m]": lambda rows: _band(rows, "curvature_cold"),
    "hot [1/m]": lambda rows: _band(rows, "curvature_hot"),
    "sag of the tip, cold [mm]": lambda rows: _band(rows, "sag_cold", 1e3),
    "sag, hot [mm]": lambda rows: _band(rows, "sag_hot", 1e3),
    "mean l, hot [mm]": lambda rows: _band(rows, "length_hot", 1e3),
    "worst overlap [mm]": lambda rows: f"{1e3 * max(r.get(k, 0) for r in rows for k in _OVERLAPS):.2f}",
    "times real time, cold": lambda rows: _band(rows, "real_time_cold"),
    "times real time, hot": lambda rows: _band(rows, "real_time_hot"),
}


def table(rows: list[dict[str, Any]]) -> str:
    """Markdown: one line per setting."""
    lines = ["| | " + " | ".join(COLUMNS) + " |", "|---" * (len(COLUMNS) + 1) + "|"]
    for name in SETTINGS:
        own = [r for r in rows if r["settings"] == name]
        if own:
            lines.append(f"| {name} | " + " | ".join(cell(own) for cell in COLUMNS.values()) + " |")
    return "\n".join(lines) + "\n"


def main(arguments: list[str] | None = None) -> None:
    """Print and write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--starts", type=int, default=12)
    parser.add_argument("--settings", nargs="*", default=list(SETTINGS), choices=list(SETTINGS))
    parser.add_argument("--runs", type=Path, default=Path("runs/engines.jsonl"), help="file of the single runs")
    given = parser.parse_args(arguments)
    given.runs.parent.mkdir(parents=True, exist_ok=True)
    text = heading("Bullet and MuJoCo, side by side", "python -m benchmarks.engines") + (
        f"\nPrototype cantilever from flat, {DURATIONS[0]:g} s at {COLD} N/m, then {DURATIONS[1]:g} s at {HOT} N/m, "
        "switched at once. Medians with the range over starts that differ by speeds of up to 1 mm/s; means over the "
        "last half second. Speed: simulated time per processor time, runs interleaved on a busy machine.\n\n"
    )
    text += table(measure(given.runs, given.starts, given.settings))
    (results_folder() / "engines.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
