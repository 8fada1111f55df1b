"""Tracking on rendered videos with known truth: `python -m benchmarks.camera RUN --out FOLDER [--cases 1,5]`.

RUN is the folder of a finished run of `prototype_cantilever`. Writes FOLDER/camera.md.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
import yaml

from benchmarks.machine import heading
from chainmail.camera.camera_file import CameraFile
from chainmail.camera.measure import Measured, measure
from chainmail.camera.rendered import motion_of_results, motion_of_table, write_video
from chainmail.camera.rig import load_rig
from chainmail.camera.tracks import GAP, SEEN

DISTURBED = {"light": 0.65, "gradient": 0.5, "jpeg": 50, "noise": 3.0}
LENS = {"fiducials": True, "yaw": "12 deg", "pitch": "-6 deg", "distortion": [-0.25, 0.08, 0.001, -0.0008]}
ROD = {"width": "6 mm", "start": ["-40 mm", "0 mm"], "stop": ["180 mm", "0 mm"], "direction": "80 deg"}
#: Name to what a camera differs in; 960 x 720, 0.25 mm to a pixel, 30 frames per second, exposed for 8 ms.
CASES: dict[str, dict[str, Any]] = {
    "ideal": {},
    "light -35 %, gradient, JPEG 50": DISTURBED,
    "lens and yaw, calibrated": LENS,
    "all of these": {**DISTURBED, **LENS},
    "crossing rod": {"rods": [{**ROD, "begin": "2 s", "end": "7 s"}, {**ROD, "begin": "14 s", "end": "18 s"}]},
    "rod and JPEG 50": {**DISTURBED, "rods": [{**ROD, "begin": "2 s", "end": "7 s"}]},
    "markers of 4 mm": {"diameter": "4 mm"},
}
BASE = {"rate": "30 Hz", "exposure": "8 ms", "begin": "0 s", "end": "20 s"}
#: By how much at most further placements of the camera look elsewhere [mm]. A block of a compressed picture has eight
#: pixels,
#: and a fabric that stands still has the same error of compression in all frames.
AWAY = 2.0
#: A fabric is hot where its largest curvature is below this [1/m].
HOT = 3.0


@dataclass(frozen=True)
class Score:
    """What tracking gave against the truth; curvature in 1/m, places in mm, times in ms."""

    curvature: float
    hot_bias: float
    inside: float
    place: float
    place_inside: float
    missing: float
    wrong: float
    clock: float
    rate: float


def score(folder: Path) -> Score:
    """Track a rendered video and compare with its truth."""
    rig = load_rig(folder / "rig.yaml")
    begin = time.process_time()
    measured = measure(folder / "frames", rig, folder / "rig.yaml")
    spent = time.process_time() - begin
    truth = motion_of_table(folder / "truth.csv")
    true_curvature = np.genfromtxt(folder / "truth.csv", delimiter=",", skip_header=1)[:, -1]
    return _compared(measured, truth.times, truth.places, true_curvature, len(truth.times) / spent)


def _compared(measured: Measured, times: Any, places: Any, bent: Any, rate: float) -> Score:
    tracks, curvature = measured.tracks, measured.curvature
    if curvature is None:
        raise ValueError("a fabric has a curvature")
    off, state = tracks.places - places, tracks.state
    known = np.isfinite(curvature.values)
    error = (curvature.values - bent)[known]
    hot = bent[known] < HOT
    is_read = state != GAP
    # A reading nearer to another marker than to its own has a wrong identity.
    apart = np.linalg.norm(tracks.places[:, :, None] - places[:, None], axis=3)
    nearest = np.where(is_read, np.argmin(np.where(np.isfinite(apart), apart, np.inf), axis=2), -1)
    wrong = is_read & (nearest != np.arange(tracks.markers)[None, :])
    speed = np.gradient(places, times, axis=0)
    whole = (state == SEEN)[..., None] & np.isfinite(off)
    shift = float(np.sum((off * speed)[whole]) / np.sum((speed**2)[whole]))
    return Score(
        float(np.sqrt(np.mean(error**2))),
        float(np.mean(error[hot])) if hot.any() else float("nan"),
        float(np.mean(np.abs(error) < 1.96 * curvature.deviation[known])),
        float(1e3 * np.sqrt(np.mean(off[is_read] ** 2))),
        float(np.mean(np.abs(off[is_read]) < 1.96 * tracks.deviation[is_read])),
        float(1.0 - np.mean(known)),
        float(wrong.sum()),
        1e3 * shift,
        rate,
    )


def _placed(spec: dict[str, Any], placement: int) -> dict[str, Any]:
    """The camera of a case, from the second placement on moved by less than a block of the picture."""
    if placement == 0:
        return {**BASE, **spec}
    moved = np.array([c.to("mm") for c in CameraFile().centre]) + np.random.default_rng(placement).uniform(
        -AWAY, AWAY, 2
    )
    return {**BASE, **spec, "centre": [f"{float(m):.3f} mm" for m in moved]}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("run", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--cases", default="", help="Numbers from 1, with commas; default: all.")
    parser.add_argument("--placements", type=int, default=1, help="Places of the camera for each case.")
    given = parser.parse_args()
    with xr.open_dataset(given.run / "results.nc") as stored:
        motion = motion_of_results(stored.load(), given.run)
    chosen = [int(n) - 1 for n in given.cases.split(",") if n] or range(len(CASES))
    lines = [
        heading("Tracking of rendered videos", "python -m benchmarks.camera RUN --out FOLDER"),
        "The prototype cantilever from 0 to 20 s, rendered at 960 x 720, 0.25 mm to a pixel, 30 frames per second, "
        "exposed for 8 ms.",
        "",
        "| case | curvature rms [1/m] | bias when hot [1/m] | in 95 % interval: curvature, places | places rms [mm] "
        "| frames without curvature | wrong identities | clock [ms] | frames per CPU second |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for number, (name, spec) in enumerate(CASES.items()):
        if number not in chosen:
            continue
        for placement in range(given.placements):
            folder = given.out / f"case_{number + 1}{f'_{placement + 1}' if placement else ''}"
            keys = _placed(spec, placement)
            if not (folder / "truth.csv").exists():
                camera = CameraFile.model_validate(keys)
                folder.mkdir(parents=True, exist_ok=True)
                (folder / "camera.yaml").write_text(yaml.safe_dump(keys))
                write_video(folder, camera, folder / "camera.yaml", motion, number + 1, name)
            s = score(folder)
            lines.append(
                f"| {name}{f', placement {placement + 1}' if placement else ''} "
                f"| {s.curvature:.3f} | {s.hot_bias:+.3f} "
                f"| {100 * s.inside:.1f} %, {100 * s.place_inside:.1f} % "
                f"| {s.place:.4f} | {100 * s.missing:.1f} % | {s.wrong:.0f} | {s.clock:+.2f} | {s.rate:.0f} |"
            )
            print(lines[-1], flush=True)
    (given.out / "camera.md").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
