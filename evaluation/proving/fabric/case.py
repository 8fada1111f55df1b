"""Cases of small fabrics, seen by a camera, with what is concealed drawn from a seed.

`drape`: 4 x 2 links fall from flat. `heated`: 5 x 2 links fall, are heated by programmes, and cool.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from evaluation.proving.fabric.truth import COLUMNS, HELD, Specimen, drape
from evaluation.proving.rig import Array

_SCENARIOS = Path(__file__).resolve().parents[1] / "scenarios"
#: Time between two pictures [s]; noise of a marker along every axis [m].
INTERVAL, NOISE = 0.04, 3e-4
#: Share of readings that are lost behind a link.
LOST = 0.03
#: Starts of which each mean is taken, where it is asked what an effect moves.
STARTS = 2
#: Most effects that are drawn for one that shows.
TRIES = 40
#: Deviation of what is never quite as the scenario says: masses, springs and friction, as shares.
OFF = {"mass": 0.01, "steel": 0.02, "friction": 0.03, "coil": 0.01}


@dataclass(frozen=True)
class Rig:
    """A fabric that cases are drawn of.

    Args:
        scenario: File name.
        stop: Duration of a recording [s].
        base: The fabric without what is concealed.
        spread: Effects of all links: range of the strength, and whether it has a sign.
        local: Effects of one link or one row: range of the strength.
        camera: What cameras and markers do: range of the strength, and whether it has a sign.
        has_rows: Whether a local effect may act in all links of a row.
    """

    scenario: str
    stop: float
    base: Specimen
    spread: Mapping[str, tuple[float, float, bool]]
    local: Mapping[str, tuple[float, float]]
    camera: Mapping[str, tuple[float, float, bool]]
    has_rows: bool = False


_SPREAD = {
    "tilt": (0.05, 0.12, True),
    "roll": (0.05, 0.12, True),
    "payload": (0.02, 0.06, False),
    "slide_friction": (0.5, 2.0, False),
    "viscous_damping": (5.0, 30.0, False),
    "contact_friction": (0.3, 0.8, False),
}
_CAMERA = {
    "exchanged_markers": (1.0, 1.0, False),
    "turned_camera": (0.05, 0.05, True),
    "slipped_marker": (2e-3, 2e-3, False),
}
#: Factor of the stiffness of coils that are hot.
_HOT = 387.0 / 157.1
RIGS = {
    "drape": Rig(
        "small_fabric.yaml",
        0.4,
        Specimen(),
        _SPREAD,
        {"weak_steel": (0.5, 0.9), "jammed_link": (20.0, 20.0)},
        _CAMERA,
    ),
    "heated": Rig(
        "heated_fabric.yaml",
        1.2,
        Specimen(rows=5, heating=((0.0, 1.0), (0.4, 1.0), (0.55, _HOT), (0.9, _HOT), (1.0, 1.0))),
        {
            "tilt": (0.08, 0.25, True),
            "roll": (0.1, 0.3, True),
            "payload": (0.015, 0.05, False),
            "slide_friction": (1.0, 4.0, False),
            "viscous_damping": (15.0, 60.0, False),
            "contact_friction": (0.4, 1.0, False),
            "supply_wire_stiffness": (1.5, 5.0, False),
        },
        {
            "weak_steel": (0.3, 0.9),
            "weak_coil": (0.3, 0.8),
            "unheated_coil": (0.6, 1.0),
            "jammed_link": (20.0, 20.0),
        },
        {
            "exchanged_markers": (1.0, 1.0, False),
            "turned_camera": (0.03, 0.1, True),
            "camera_scale": (0.03, 0.1, True),
            "camera_origin": (2e-3, 5e-3, True),
            "marker_elsewhere": (1.5e-3, 4e-3, True),
            "slipped_marker": (1.5e-3, 4e-3, True),
        },
        has_rows=True,
    ),
}
#: Kind to its share.
KINDS = {"null": 0.35, "global": 0.4, "local": 0.15, "camera": 0.1}
#: Those whose effects move links.
MOVING = ("global", "local")


@dataclass(frozen=True)
class FabricCase:
    """A case before it is run.

    Args:
        identifier: Says nothing about the answer.
        kind: One of `KINDS`.
        effect: What is concealed; empty: nothing.
        strength: In SI; of an exchange 1.
        specimen: The fabric with its effect.
        rig: One of `RIGS`.
        moves: What the effect moves the markers by, root mean square over markers and pictures, means of `STARTS`
            starts with and without it [m]; nan: it was not asked.
    """

    identifier: str
    kind: str
    effect: str
    strength: float
    specimen: Specimen
    rig: str = "drape"
    moves: float = math.nan

    def write(self, cases: Path, answers: Path, rng: np.random.Generator) -> None:
        """Make the recordings and write them, the task and the answer.

        Args:
            cases: Folder that the diagnosis is given.
            answers: Folder that it is not given.
            rng: Of starts and noise.
        """
        folder = cases / self.identifier
        for order, name in enumerate(("training_1", "held_out_1"), start=1):
            markers = drape(self.specimen, RIGS[self.rig].stop, INTERVAL, rng)
            _write_recording(folder / name, self._seen(markers, rng), order)
        (folder / "scenario.yaml").write_text((_SCENARIOS / RIGS[self.rig].scenario).read_text(encoding="utf-8"))
        task = {"scenario": "scenario.yaml", "training": ["training_1"], "held_out": ["held_out_1"], "hidden": []}
        (folder / "task.yaml").write_text(yaml.safe_dump(task, sort_keys=False))
        answers.mkdir(parents=True, exist_ok=True)
        answer = {"case": self.identifier, "kind": self.kind, "effect": self.effect, "strength": self.strength}
        answer |= {"link": self.specimen.at_link + 1, "row": self.specimen.at_row + 1}
        answer["moves_mm"] = None if math.isnan(self.moves) else round(1e3 * self.moves, 3)
        (answers / f"{self.identifier}.json").write_text(json.dumps(answer, indent=1) + "\n")

    def _seen(self, markers: Array, rng: np.random.Generator) -> Array:
        """What the camera reads of the free rows' markers [m], shape (pictures, markers, 3)."""
        seen = markers[:, 2 * HELD :].copy()
        if self.effect == "exchanged_markers":
            seen[:, [0, 1]] = seen[:, [1, 0]]
        if self.effect == "marker_elsewhere":
            seen[:, 1, 1] += self.strength
        if self.effect == "slipped_marker":
            seen[len(seen) // 2 :, 1, 1] += self.strength
        if self.effect == "camera_scale":
            seen *= 1.0 + self.strength
        if self.effect == "camera_origin":
            seen[..., 2] += self.strength
        if self.effect == "turned_camera":
            cosine, sine = math.cos(self.strength), math.sin(self.strength)
            y, z = seen[..., 1].copy(), seen[..., 2].copy()
            seen[..., 1], seen[..., 2] = cosine * y - sine * z, sine * y + cosine * z
        seen += NOISE * rng.standard_normal(seen.shape)
        seen[rng.random(seen.shape[:2]) < LOST] = np.nan
        return seen


def drawn_case(
    identifier: str, rng: np.random.Generator, kind: str = "", rig: str = "drape", least: float = 0.0
) -> FabricCase:
    """A case with its fabric, kind, effect and strength drawn.

    Args:
        identifier: Of the case.
        rng: Of all draws.
        kind: This one; empty: drawn by `KINDS`.
        rig: One of `RIGS`.
        least: What an effect of links moves the markers by at least, root mean square [m]: one that moves them by less
            is drawn again. 0: as drawn.

    Raises:
        ValueError: No effect of `TRIES` moves the markers by so much.
    """
    kind = kind or str(rng.choice(list(KINDS), p=list(KINDS.values())))
    own = RIGS[rig]
    off = {n: getattr(own.base, n) * math.exp(share * float(rng.standard_normal())) for n, share in OFF.items()}
    plain = FabricCase(identifier, kind, "", 0.0, replace(own.base, **off), rig)
    case = _with_effect(plain, rng)
    if not least or kind not in MOVING:
        return case
    nominal = _mean_markers(plain, rng)
    for _ in range(TRIES):
        moves = float(np.sqrt(np.mean((_mean_markers(case, rng) - nominal) ** 2)))
        if moves >= least:
            return replace(case, moves=moves)
        case = _with_effect(plain, rng)
    raise ValueError(f"none of {TRIES} effects that were drawn moves the markers of {rig} by {1e3 * least:g} mm")


def _mean_markers(case: FabricCase, rng: np.random.Generator) -> Array:
    """Places of the free rows' markers [m], mean of `STARTS` starts, shape (pictures, markers, 3)."""
    runs = [drape(case.specimen, RIGS[case.rig].stop, INTERVAL, rng)[:, 2 * HELD :] for _ in range(STARTS)]
    return np.asarray(np.mean(runs, axis=0))


def _with_effect(plain: FabricCase, rng: np.random.Generator) -> FabricCase:
    """A fabric that lacks nothing with an effect of its kind, strength and place drawn."""
    kind, specimen, own = plain.kind, plain.specimen, RIGS[plain.rig]
    if kind == "null":
        return plain
    if kind == "camera":
        effect, strength = _drawn(own.camera, rng)
        return replace(plain, effect=effect, strength=strength)
    if kind == "local":
        effect = str(rng.choice(list(own.local)))
        strength = float(rng.uniform(*own.local[effect]))
        per_row = 2 * COLUMNS - 1
        link = int(rng.integers(HELD * per_row, specimen.rows * per_row))
        is_row = own.has_rows and rng.random() < 0.4
        at_row, at_link = (link // per_row, -1) if is_row else (-1, link)
        specimen = replace(specimen, effects={effect: strength}, at_row=at_row, at_link=at_link)
        return replace(plain, effect=effect, strength=strength, specimen=specimen)
    effect, strength = _drawn(own.spread, rng)
    return replace(plain, effect=effect, strength=strength, specimen=replace(specimen, effects={effect: strength}))


def _drawn(effects: Mapping[str, tuple[float, float, bool]], rng: np.random.Generator) -> tuple[str, float]:
    """One of the effects, and its strength."""
    effect = str(rng.choice(list(effects)))
    low, high, has_sign = effects[effect]
    strength = float(rng.uniform(low, high))
    return effect, -strength if has_sign and rng.random() < 0.5 else strength


def write_cases(
    folder: Path, count: int, seed: int, kind: str = "", rig: str = "drape", least: float = 0.0
) -> list[str]:
    """Draw cases and write them into `cases/` and `answers/`; returns their names.

    Args:
        folder: Gets both.
        count: How many.
        seed: Of all draws.
        kind: This one alone; empty: all.
        rig: One of `RIGS`.
        least: What an effect moves the markers by at least, root mean square [m]; 0: it is not asked.
    """
    names = []
    for number in range(count):
        rng, name = np.random.default_rng([seed, number]), f"fabric_{number + 1:03d}"
        if not (folder / "answers" / f"{name}.json").is_file():
            case = drawn_case(name, rng, kind, rig, least)
            case.write(folder / "cases", folder / "answers", rng)
        names.append(name)
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
