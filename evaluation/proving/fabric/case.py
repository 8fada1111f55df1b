"""Cases of small fabrics: a drape from flat, seen by a camera, with what is concealed drawn from a seed."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from evaluation.proving.fabric.truth import COLUMNS, HELD, ROWS, Specimen, drape
from evaluation.proving.rig import Array

_SCENARIO = Path(__file__).resolve().parents[1] / "scenarios" / "small_fabric.yaml"
#: Duration of a recording and time between two pictures [s]; noise of a marker along every axis [m].
STOP, INTERVAL, NOISE = 0.4, 0.04, 3e-4
#: Share of readings that are lost behind a link.
LOST = 0.03
#: Deviation of what is never quite as the scenario says: masses, springs and friction, as shares.
OFF = {"mass": 0.01, "steel": 0.02, "friction": 0.03, "coil": 0.01}
#: Effects of all links: range of the strength, whether it has a sign, and the share of draws.
GLOBAL = {
    "tilt": (0.05, 0.12, True),
    "roll": (0.05, 0.12, True),
    "payload": (0.02, 0.06, False),
    "slide_friction": (0.5, 2.0, False),
    "viscous_damping": (5.0, 30.0, False),
    "contact_friction": (0.3, 0.8, False),
}
#: Effects of one link, and of the camera; the catalogue of the diagnosis has none of them.
LOCAL = {"weak_steel": (0.5, 0.9), "jammed_link": (20.0, 20.0)}
CAMERA = ("exchanged_markers", "turned_camera", "slipped_marker")
#: Kind to its share.
KINDS = {"null": 0.35, "global": 0.4, "local": 0.15, "camera": 0.1}


@dataclass(frozen=True)
class FabricCase:
    """A case before it is run.

    Args:
        identifier: Says nothing about the answer.
        kind: One of `KINDS`.
        effect: What is concealed; empty: nothing.
        strength: In SI; of an exchange 1.
        specimen: The fabric with its effect.
    """

    identifier: str
    kind: str
    effect: str
    strength: float
    specimen: Specimen

    def write(self, cases: Path, answers: Path, rng: np.random.Generator) -> None:
        """Make the recordings and write them, the task and the answer.

        Args:
            cases: Folder that the diagnosis is given.
            answers: Folder that it is not given.
            rng: Of starts and noise.
        """
        folder = cases / self.identifier
        for order, name in enumerate(("training_1", "held_out_1"), start=1):
            markers = drape(self.specimen, STOP, INTERVAL, rng)
            _write_recording(folder / name, self._seen(markers, rng), order)
        (folder / "scenario.yaml").write_text(_SCENARIO.read_text())
        task = {"scenario": "scenario.yaml", "training": ["training_1"], "held_out": ["held_out_1"], "hidden": []}
        (folder / "task.yaml").write_text(yaml.safe_dump(task, sort_keys=False))
        answers.mkdir(parents=True, exist_ok=True)
        answer = {"case": self.identifier, "kind": self.kind, "effect": self.effect, "strength": self.strength}
        (answers / f"{self.identifier}.json").write_text(json.dumps(answer, indent=1) + "\n")

    def _seen(self, markers: Array, rng: np.random.Generator) -> Array:
        """What the camera reads of the free rows' markers [m], shape (pictures, markers, 3)."""
        seen = markers[:, 2 * HELD :].copy()
        if self.effect == "exchanged_markers":
            seen[:, [0, 1]] = seen[:, [1, 0]]
        if self.effect == "slipped_marker":
            seen[len(seen) // 2 :, 1, 1] += self.strength
        if self.effect == "turned_camera":
            cosine, sine = math.cos(self.strength), math.sin(self.strength)
            y, z = seen[..., 1].copy(), seen[..., 2].copy()
            seen[..., 1], seen[..., 2] = cosine * y - sine * z, sine * y + cosine * z
        seen += NOISE * rng.standard_normal(seen.shape)
        seen[rng.random(seen.shape[:2]) < LOST] = np.nan
        return seen


def drawn_case(identifier: str, rng: np.random.Generator, kind: str = "") -> FabricCase:
    """A case with its fabric, kind, effect and strength drawn.

    Args:
        identifier: Of the case.
        rng: Of all draws.
        kind: This one; empty: drawn by `KINDS`.
    """
    kind = kind or str(rng.choice(list(KINDS), p=list(KINDS.values())))
    base = Specimen()
    off = {n: getattr(base, n) * math.exp(share * float(rng.standard_normal())) for n, share in OFF.items()}
    specimen = replace(base, **off)
    if kind == "null":
        return FabricCase(identifier, kind, "", 0.0, specimen)
    if kind == "camera":
        effect = str(rng.choice(CAMERA))
        strength = {"turned_camera": math.copysign(0.05, rng.uniform(-1, 1)), "slipped_marker": 2e-3}.get(effect, 1.0)
        return FabricCase(identifier, kind, effect, strength, specimen)
    if kind == "local":
        effect = str(rng.choice(list(LOCAL)))
        strength = float(rng.uniform(*LOCAL[effect]))
        per_row = 2 * COLUMNS - 1
        link = int(rng.integers(HELD * per_row, ROWS * per_row))
        return FabricCase(
            identifier, kind, effect, strength, replace(specimen, effects={effect: strength}, at_link=link)
        )
    effect = str(rng.choice(list(GLOBAL)))
    low, high, has_sign = GLOBAL[effect]
    strength = float(rng.uniform(low, high))
    if has_sign and rng.random() < 0.5:
        strength = -strength
    return FabricCase(identifier, kind, effect, strength, replace(specimen, effects={effect: strength}))


def write_cases(folder: Path, count: int, seed: int, kind: str = "") -> list[str]:
    """Draw cases and write them into `cases/` and `answers/`; returns their names.

    Args:
        folder: Gets both.
        count: How many.
        seed: Of all draws.
        kind: This one alone; empty: all.
    """
    names = []
    for number in range(count):
        rng = np.random.default_rng([seed, number])
        case = drawn_case(f"fabric_{number + 1:03d}", rng, kind)
        if not (folder / "answers" / f"{case.identifier}.json").is_file():
            case.write(folder / "cases", folder / "answers", rng)
        names.append(case.identifier)
    return names


def _write_recording(folder: Path, seen: Array, order: int) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    names = [f"marker[{2 * HELD + m + 1}].{axis}" for m in range(seen.shape[1]) for axis in "xyz"]
    columns = [n.replace("[", "_").replace("].", "_") for n in names]
    lines = [",".join(["time", *columns])]
    for number, picture in enumerate(seen.reshape(len(seen), -1).tolist()):
        lines.append(",".join([f"{number * INTERVAL:.6g}", *("" if v != v else f"{v:.6f}" for v in picture)]))
    (folder / "camera.csv").write_text("\n".join(lines) + "\n")
    channels: dict[str, Any] = {
        n: {"column": c, "unit": "m", "noise": f"{NOISE:g} m"} for n, c in zip(names, columns, strict=True)
    }
    sidecar = {
        "title": "fabric, falls from flat",
        "table": "camera.csv",
        "time": {"column": "time", "unit": "s", "zero": 0},
        "order": order,
        "channels": channels,
    }
    (folder / "recording.yaml").write_text(yaml.safe_dump(sidecar, sort_keys=False, width=120, default_flow_style=None))
