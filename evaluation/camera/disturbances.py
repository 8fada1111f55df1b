"""`python -m evaluation.camera.disturbances --seeds 3 --out DIR`: tracking under what the renderer does not have.

A fabric on an arc sways for 1.5 s; its rendered frames are changed afterwards, by code that tracking shares nothing
with, and tracked. The table says how large the errors are and how many of them the stated 95 % intervals hold.
"""

from __future__ import annotations

import argparse
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from chainmail.camera.camera_file import CameraFile
from chainmail.camera.measure import measure
from chainmail.camera.opencv import opencv
from chainmail.camera.render import Motion, Renderer
from chainmail.camera.rendered import motion_of_table, write_video
from chainmail.camera.rig import load_rig
from chainmail.camera.tracks import GAP
from cosim.unit.protocol import AnyArray, Array

CAMERA = {
    "width": 480,
    "height": 360,
    "scale": "0.4 mm",
    "centre": ["65 mm", "-8 mm"],
    "rate": "24 Hz",
    "exposure": "8 ms",
}
#: Time from the first to the last line of a rolling shutter [s], and bands of lines with one time each.
ROLLING, BANDS = 0.015, 24
Change = Callable[[AnyArray, np.random.Generator], AnyArray]


def swaying(rng: np.random.Generator) -> Motion:
    """Six rows on a circular arc whose curvature falls and rises again while the links shorten."""
    low, high = rng.uniform(0.5, 2.0), rng.uniform(6.0, 9.0)
    lean, pitch = np.radians(rng.uniform(40.0, 46.0)), rng.uniform(0.0215, 0.0235)
    times = np.linspace(0.0, 1.5, 121)
    part = np.sin(np.pi * times / 1.5) ** 2
    places = [_arc(high + (low - high) * p, 0.0335 - 0.0035 * p, lean, pitch) for p in part]
    return Motion(times, np.array(places))


def _arc(curvature: float, length: float, lean: float, pitch: float) -> Array:
    angle = -curvature * pitch * np.arange(6)
    along = angle - curvature * pitch / 2.0
    step = pitch * np.stack([np.cos(along), np.sin(along)], axis=1)
    centres = np.array([0.012, 0.010]) + np.concatenate([np.zeros((1, 2)), np.cumsum(step[:-1], axis=0)])
    half = length / 2.0 * np.stack([np.cos(angle + lean), np.sin(angle + lean)], axis=1)
    return np.asarray(np.stack([centres - half, centres + half], axis=1).reshape(-1, 2))


def shadow(picture: AnyArray, rng: np.random.Generator) -> AnyArray:
    """The edge of a shadow across the fabric, 6 pixels wide; half the light behind it."""
    height, width = picture.shape[:2]
    x, y = np.meshgrid(np.arange(width), np.arange(height))
    angle, at = rng.uniform(0.0, np.pi), rng.uniform(-40.0, 40.0)
    away = (x - width / 2.0) * np.cos(angle) + (y - height / 2.0) * np.sin(angle) - at
    return _lit(picture, 0.75 + 0.25 * np.tanh(away / 3.0))


def vignetting(picture: AnyArray, rng: np.random.Generator) -> AnyArray:
    """Light that falls off towards the corners, to a third there."""
    height, width = picture.shape[:2]
    x, y = np.meshgrid(np.linspace(-1.0, 1.0, width), np.linspace(-1.0, 1.0, height))
    return _lit(picture, 1.0 / (1.0 + 0.37 * (x**2 + y**2)) ** 2)


def hue(picture: AnyArray, rng: np.random.Generator) -> AnyArray:
    """Light of another colour, and a hue that is turned by up to 15 degrees."""
    cv2 = opencv()
    gains = np.exp(rng.uniform(-0.25, 0.25, 3))
    warm = np.clip(picture * (gains / gains.max()), 0, 255).astype(np.uint8)
    tones = cv2.cvtColor(warm, cv2.COLOR_BGR2HSV)
    tones[..., 0] = (tones[..., 0].astype(int) + int(rng.integers(-7, 8))) % 180
    return np.asarray(cv2.cvtColor(tones, cv2.COLOR_HSV2BGR))


def plain(picture: AnyArray, rng: np.random.Generator) -> AnyArray:
    """Nothing."""
    return picture


def _lit(picture: AnyArray, light: Array) -> AnyArray:
    """Coded brightness under less light."""
    return np.clip(picture * (light ** (1.0 / 2.2))[..., None], 0, 255).astype(np.uint8)


#: Name to what the camera has, and what is done to each frame; one draw of the change for a whole video.
KINDS: dict[str, tuple[dict[str, Any], Change]] = {
    "none": ({}, plain),
    "compression 30": ({"jpeg": 30}, plain),
    "exposure of 16 ms": ({"exposure": "16 ms"}, plain),
    "exposure of 32 ms, 0.77 of the period": ({"exposure": "32 ms"}, plain),
    "light of another colour": ({}, hue),
    "edge of a shadow": ({}, shadow),
    "vignetting": ({}, vignetting),
    "shadow, vignetting and compression 50": ({"jpeg": 50}, lambda p, r: shadow(vignetting(p, r), r)),
    "rolling shutter of 15 ms": ({"begin": "10 ms", "end": "1.48 s"}, plain),
    "rolling shutter of 15 ms, stated": ({"begin": "10 ms", "end": "1.48 s"}, plain),
}


def film(folder: Path, name: str, seed: int) -> None:
    """Render and change one video."""
    keys, change = KINDS[name]
    number = [*KINDS].index(name)
    folder.mkdir(parents=True)
    spec = {**CAMERA, **keys}
    (folder / "camera.yaml").write_text(yaml.safe_dump(spec), encoding="utf-8")
    camera, motion = CameraFile.model_validate(spec), swaying(np.random.default_rng([seed, 1]))
    write_video(folder, camera, folder / "camera.yaml", motion, seed, name)
    cv2, files = opencv(), sorted((folder / "frames").iterdir())
    if name.startswith("rolling"):
        for file, picture in zip(files, _rolling(camera, motion, seed), strict=False):
            cv2.imwrite(str(file), picture, [cv2.IMWRITE_JPEG_QUALITY, camera.jpeg])
        if name.endswith("stated"):
            rig = yaml.safe_load((folder / "rig.yaml").read_text(encoding="utf-8"))
            rig["clock"]["readout"] = f"{ROLLING} s"
            (folder / "rig.yaml").write_text(yaml.safe_dump(rig, sort_keys=False), encoding="utf-8")
    elif change is not plain:
        for file in files:
            picture = change(cv2.imread(str(file)), np.random.default_rng([seed, 2, number]))
            cv2.imwrite(str(file), picture, [cv2.IMWRITE_JPEG_QUALITY, camera.jpeg])


def _rolling(camera: CameraFile, motion: Motion, seed: int) -> list[AnyArray]:
    """Bands of lines that are exposed one after the other; the middle of the picture at the time that is stated."""
    delays = ROLLING * ((np.arange(BANDS) + 0.5) / BANDS - 0.5)
    late = [list(Renderer(camera, Motion(motion.times - d, motion.places), seed).frames()) for d in delays.tolist()]
    edges = np.linspace(0, camera.height, BANDS + 1).astype(int)
    count = min(map(len, late))
    return [np.concatenate([late[b][k][edges[b] : edges[b + 1]] for b in range(BANDS)]) for k in range(count)]


def scored(folder: Path) -> Array:
    """Errors of places [mm] and curvature [1/m], shares in their 95 % intervals, gaps, wrong identities."""
    rig = load_rig(folder / "rig.yaml")
    found = measure(folder / "frames", rig, folder / "rig.yaml")
    true = motion_of_table(folder / "truth.csv")
    bent = np.genfromtxt(folder / "truth.csv", delimiter=",", skip_header=1)[:, -1]
    off, read = found.tracks.places - true.places, found.tracks.state != GAP
    assert found.curvature is not None
    error = found.curvature.values - bent
    known = np.isfinite(error)
    return np.array(
        [
            1e3 * np.sqrt(np.mean(off[read] ** 2)),
            np.mean(np.abs(off[read]) < 1.96 * found.tracks.deviation[read]),
            np.sqrt(np.mean(error[known] ** 2)),
            np.mean(np.abs(error[known]) < 1.96 * found.curvature.deviation[known]),
            1.0 - np.mean(read),
            np.sum(np.linalg.norm(off[read], axis=1) > 8e-3),
        ]
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m evaluation.camera.disturbances", description=__doc__)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--first", type=int, default=101, help="first seed")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--only", nargs="+", choices=KINDS, default=[*KINDS])
    given = parser.parse_args()
    print("| disturbance | places rms [mm] | held by 95 % | curvature rms [1/m] | held by 95 % | gaps | wrong |")
    print("|---|---|---|---|---|---|---|")
    for name in given.only:
        rows = []
        for seed in range(given.first, given.first + given.seeds):
            folder = given.out / f"{name.replace(' ', '_')}_{seed}"
            if not (folder / "truth.csv").is_file():
                shutil.rmtree(folder, ignore_errors=True)
                film(folder, name, seed)
            rows.append(scored(folder))
        place, held, bent, kept, gaps, wrong = np.mean(rows, axis=0)
        print(
            f"| {name} | {place:.3f} | {100 * held:.0f} % | {bent:.3f} | {100 * kept:.0f} % | {100 * gaps:.1f} % "
            f"| {wrong * len(rows):.0f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
