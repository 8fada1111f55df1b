"""One case: a small fabric with a concealed effect, filmed twice, tracked, and its true markers beside it."""

from __future__ import annotations

import json
import shutil
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd  # type: ignore[import-untyped]
import yaml

from chainmail.camera.camera_file import CameraFile
from chainmail.camera.measure import measure
from chainmail.camera.output import write_tracks
from chainmail.camera.rendered import motion_of_results, write_video
from chainmail.camera.rig import load_rig
from cosim.components import FabricComponent
from cosim.run import run
from cosim.scenario import Scenario, load_scenario
from cosim.unit.quantity import PhysicalValue

SCENARIO = Path(__file__).with_name("fabric.yaml")
#: One recording is fitted, the other judges.
RECORDINGS = ("first", "second")
#: Where the places are from.
SOURCES = ("video", "markers")
#: Effect to its parameter, unit, least and greatest strength, and whether it has a sign.
EFFECTS: dict[str, tuple[str, str, float, float, bool]] = {
    "contact_friction": ("added_friction", "1", 0.2, 0.8, False),
    "slide_friction": ("slide_friction", "N", 0.3, 1.2, False),
    "viscous_damping": ("slide_damping", "N*s/m", 2.0, 8.0, False),
    "hinge_friction": ("hinge_friction", "m", 0.002, 0.008, False),
    "supply_wire_stiffness": ("wire_stiffness", "N/m", 0.5, 2.0, False),
    "backlash": ("coil_play", "m", 0.0006, 0.0024, False),
    "thermal_contraction": ("coil_contraction", "m^2/N", 6e-6, 2.4e-5, False),
    "payload": ("payload", "kg", 0.004, 0.016, False),
    "tilt": ("tilt", "rad", 0.05, 0.2, True),
    "roll": ("roll", "rad", 0.05, 0.2, True),
}
#: The last kind lacks nothing.
KINDS = (*EFFECTS, "nothing")
#: The picture holds the whole fabric; 29 frames.
CAMERA = {
    "width": 480,
    "height": 360,
    "scale": "0.33 mm",
    "centre": ["52 mm", "-2 mm"],
    "rate": "100 Hz",
    "exposure": "4 ms",
}


@dataclass(frozen=True)
class Truth:
    """What is concealed.

    Args:
        kind: Effect, or `nothing`.
        strength: Its number, in `unit`.
        unit: Of the strength.
        camera: What disturbs the pictures, besides `CAMERA`.
    """

    kind: str
    strength: float
    unit: str
    camera: dict[str, Any]


def drawn_camera(rng: np.random.Generator) -> dict[str, Any]:
    """Light, gradient, noise and compression; for half of them a lens and a camera that looks from the side."""
    camera: dict[str, Any] = {
        "light": round(float(rng.uniform(0.6, 1.0)), 3),
        "gradient": round(float(rng.uniform(-0.5, 0.5)), 3),
        "noise": round(float(rng.uniform(1.0, 3.0)), 2),
        "jpeg": int(rng.integers(50, 96)),
    }
    if rng.random() < 0.5:
        yaw, pitch = rng.uniform(-12.0, 12.0), rng.uniform(-6.0, 6.0)
        camera |= {
            "fiducials": True,
            "yaw": f"{yaw:.2f} deg",
            "pitch": f"{pitch:.2f} deg",
            "distortion": [-0.25, 0.08, 0.001, -0.0008],
        }
    return camera


def with_parameters(scenario: Scenario, **numbers: PhysicalValue) -> Scenario:
    """The scenario with other parameters of its fabric."""
    fabric = scenario.components["fabric"]
    assert isinstance(fabric, FabricComponent)
    own = fabric.model_copy(update={"parameters": {**fabric.parameters, **numbers}})
    return scenario.model_copy(update={"components": {**scenario.components, "fabric": own}})


def make(folder: Path, seed: int, number: int, recordings: Sequence[str]) -> Truth:
    """Write recordings that are not there yet, from `video` and from `markers`, and the answer into `truth.json`.

    Args:
        folder: Of the case.
        seed: Of the whole draw.
        number: Of the case, from 0; its kind follows from it.
        recordings: Which of `RECORDINGS`.
    """
    rng = np.random.default_rng([seed, number])
    kind, camera = KINDS[number % len(KINDS)], drawn_camera(rng)
    numbers, strength, unit = {}, 0.0, "1"
    if kind in EFFECTS:
        name, unit, least, most, has_sign = EFFECTS[kind]
        strength = float(rng.uniform(least, most)) * (float(rng.choice([-1.0, 1.0])) if has_sign else 1.0)
        numbers[name] = PhysicalValue(strength, unit)
    for index, recording in enumerate(RECORDINGS):
        if recording not in recordings or (folder / "markers" / recording / "data.csv").is_file():
            continue
        own = np.random.default_rng([seed, number, 1 + index])
        start = {
            "start_speed": PhysicalValue(1.0, "mm/s"),
            "start_number": PhysicalValue(float(own.integers(1000, 10**6)), "1"),
        }
        results = run(with_parameters(load_scenario(SCENARIO), **start, **numbers))
        film, tracked = folder / "film", folder / "video" / recording
        for old in (film, tracked):
            shutil.rmtree(old, ignore_errors=True)
        film.mkdir(parents=True)
        (film / "camera.yaml").write_text(yaml.safe_dump({**CAMERA, **camera}), encoding="utf-8")
        view = CameraFile.model_validate({**CAMERA, **camera})
        write_video(film, view, film / "camera.yaml", motion_of_results(results, film), int(own.integers(2**31)), kind)
        rig = load_rig(film / "rig.yaml")
        write_tracks(tracked, measure(film / "frames", rig, film / "rig.yaml"), rig, "tracked")
        write_true(tracked, film / "truth.csv", folder / "markers" / recording)
        shutil.rmtree(film)
    truth = Truth(kind, strength, unit, camera)
    (folder / "truth.json").write_text(json.dumps(asdict(truth), indent=1), encoding="utf-8")
    return truth


def write_true(tracked: Path, true: Path, out: Path) -> None:
    """The recording of a video once more, each reading the true one.

    Deviations and gaps stay those of the video, so that the two differ by the errors of the readings alone.

    Args:
        tracked: Recording of a video.
        true: Its true places, truth.csv.
        out: Folder of the new recording.
    """
    out.mkdir(parents=True, exist_ok=True)
    table, places = pd.read_csv(tracked / "data.csv"), pd.read_csv(true)
    for column in places.columns[1:]:
        table[column] = places[column].where(table[column].notna())
    text = (tracked / "recording.yaml").read_text(encoding="utf-8").replace("source: tracked", "source: true markers")
    (out / "recording.yaml").write_text(text, encoding="utf-8")
    table.to_csv(out / "data.csv", index=False)


def errors(folder: Path, recording: str) -> tuple[float, float]:
    """Root mean square error of the places that a video gives [mm], and the share of gaps."""
    read, true = (pd.read_csv(folder / source / recording / "data.csv") for source in SOURCES)
    columns = [c for c in true.columns if c.startswith("marker[") and c.endswith(("].y", "].z"))]
    off = read[columns].to_numpy(dtype=np.float64) - true[columns].to_numpy(dtype=np.float64)
    return float(np.sqrt(np.nanmean(off**2))), float(np.mean(np.isnan(off)))


def kinds_of(count: int) -> Sequence[str]:
    """Kinds of the first cases."""
    return [KINDS[n % len(KINDS)] for n in range(count)]
