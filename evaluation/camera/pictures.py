"""`python -m evaluation.camera.pictures --boards DIR --targets DIR --out DIR`: tracking on photographs of others.

Neither set is committed. `--boards` is a copy of github.com/Barry-Liang/stereoCalibrate (25 pairs of pictures of a
chessboard with 9 x 6 inner corners), `--targets` one of github.com/chulminy/Vision_Based_Vibration_Measurement
(582 photographs of a swaying model with 28 round targets on four bars). What is true of them without another
instrument: corners of a flat board fit one lens, and targets on one bar keep their distance.
"""

from __future__ import annotations

import argparse
import shutil
from itertools import combinations
from pathlib import Path

import numpy as np
import yaml

from chainmail.camera.lens import calibrate, pictures_in
from chainmail.camera.measure import measure
from chainmail.camera.rig import load_rig
from chainmail.camera.tracks import GAP, Tracks
from cosim.unit.protocol import AnyArray, Array

CORNERS = (9, 6)
#: Columns and lines of the targets in the first photograph, as its authors state them (`RunDemo.m`) [px].
COLUMNS = (148, 310, 466, 625, 778, 940, 1111)
LINES = (1904, 1420, 931, 471)
#: Of a target [px].
DIAMETER = 20
#: One millimetre of this rig is one pixel.
PIXEL = 1e-3
#: Of a target; the top bar sways by up to 80 px, and is in part not read then.
REACH = "70 mm"
#: Of `camerafs` in `RunDemo.m`; distances do not depend on it [Hz].
RATE = 20.0
#: Nothing moves where targets moved by less than the first since the photograph before, and they sway where they moved
#: by more than the second (median) [px].
STILL, MOVING = 0.2, 1.0
#: Fewest readings of a pair from which a scatter is taken.
FEWEST_READINGS = 15


def targets_rig() -> dict[str, object]:
    """Rig of the photographs: points where the authors state them, in pixels."""
    points = [[f"{column} mm", f"{-line} mm"] for line in LINES for column in COLUMNS]
    return {
        "title": "Targets on a swaying model",
        "plane": {"scale": "1 mm", "origin": [0, 0], "y": "right", "z": "up"},
        "markers": {
            "colour": "dark",
            "diameter": f"{DIAMETER} mm",
            "layout": {"kind": "points", "points": points, "reach": REACH},
        },
        "clock": {"rate": f"{RATE} Hz", "exposure": "1 ms"},
        "largest_noise": "2 mm",
    }


def kinds_of(tracks: Tracks) -> tuple[AnyArray, AnyArray]:
    """Which photographs stand still and which sway, shape (frames,) both.

    The longest stretch without a movement stands still: at the turning points of the sway the model is bent.
    """
    step = np.linalg.norm(np.diff(tracks.places, axis=0), axis=2) / PIXEL
    moved = np.concatenate([[np.inf], np.nanmedian(step, axis=1)])
    ends = np.flatnonzero(np.concatenate([~(moved < STILL), [True]]))
    longest = int(np.argmax(np.diff(ends)))
    still = np.zeros(len(moved), dtype=bool)
    still[ends[longest] : ends[longest + 1]] = True
    return still, np.isfinite(moved) & (moved > MOVING)


def scatter_of_distances(tracks: Tracks, chosen: AnyArray, farthest: int) -> Array:
    """Standard deviation of the distance of two targets on one bar over the chosen photographs, of each pair [px].

    Args:
        tracks: Of the targets.
        chosen: Photographs, shape (frames,).
        farthest: How many targets apart on their bar; 1 for neighbours.
    """
    per_bar, found = len(COLUMNS), []
    for one, other in combinations(range(len(LINES) * per_bar), 2):
        if one // per_bar != other // per_bar or other - one > farthest:
            continue
        apart = np.linalg.norm(tracks.places[chosen, one] - tracks.places[chosen, other], axis=1) / PIXEL
        apart = apart[np.isfinite(apart)]
        if len(apart) >= FEWEST_READINGS:
            found.append(float(apart.std(ddof=1)))
    return np.array(found)


def strays(tracks: Tracks) -> int:
    """Number of readings that are farther from where their bar puts them than a target is wide: other things."""
    stated = np.array([[column, -line] for line in LINES for column in COLUMNS])
    away = (tracks.places / PIXEL - stated).reshape(len(tracks.times), len(LINES), len(COLUMNS), 2)
    away = away - np.nanmedian(away, axis=(0,), keepdims=True)
    with np.errstate(invalid="ignore"):
        off = np.linalg.norm(away - np.nanmedian(away, axis=2, keepdims=True), axis=3)
    return int(np.sum(off > DIAMETER))


def track_targets(folder: Path, out: Path, every: int) -> Tracks:
    """Tracks of the targets in every n-th photograph of a folder."""
    frames = out / "frames"
    shutil.rmtree(frames, ignore_errors=True)
    frames.mkdir(parents=True)
    for number, file in enumerate(pictures_in(folder, "--targets")[::every], start=1):
        (frames / f"{number:04d}{file.suffix}").symlink_to(file.resolve())
    rig_file = out / "rig.yaml"
    rig_file.write_text(yaml.safe_dump(targets_rig()), encoding="utf-8")
    return measure(frames, load_rig(rig_file), rig_file).tracks


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(prog="python -m evaluation.camera.pictures", description=__doc__)
    parser.add_argument("--boards", type=Path, required=True)
    parser.add_argument("--targets", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--every", type=int, default=2, help="take every n-th photograph of the targets")
    given = parser.parse_args()
    print("| pictures | what | reached |\n|---|---|---|")
    for side in ("left", "right"):
        found = calibrate(pictures_in(given.boards, "--boards", f"{side}*"), CORNERS, "--boards")
        print(f"| boards, {side} | reprojection error | {found.error:.3f} px, {found.used} of {found.given} pictures |")
    tracks = track_targets(given.targets / "img", given.out, given.every)
    still, moving = kinds_of(tracks)
    for name, chosen in (("standing still", still), (f"more than {MOVING:g} px from one to the next", moving)):
        for pairs, farthest in (("neighbours", 1), ("all pairs", len(COLUMNS) - 1)):
            scatter = scatter_of_distances(tracks, chosen, farthest)
            low, middle, high = np.quantile(scatter, [0.1, 0.5, 0.9]) if len(scatter) else (np.nan,) * 3
            print(
                f"| targets, {name}, {int(np.sum(chosen))} photographs | scatter of distances on one bar, {pairs} "
                f"({len(scatter)}) | {middle:.3f} px median ({low:.3f} to {high:.3f}, 10 to 90 %) |"
            )
    gaps = 100.0 * np.mean(tracks.state == GAP)
    print(f"\n{gaps:.1f} % of the readings of targets are gaps; {strays(tracks)} readings are of other things.")


if __name__ == "__main__":
    main()
