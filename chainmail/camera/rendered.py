"""Rendered frames as files: pictures, the rig file that belongs to them, and the truth."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd  # type: ignore[import-untyped]
import xarray as xr
import yaml

from chainmail.camera.camera_file import CameraFile
from chainmail.camera.curvature import curvatures
from chainmail.camera.opencv import opencv
from chainmail.camera.render import FIDUCIAL_COLOUR, FIDUCIAL_DIAMETER, Motion, Renderer
from cosim.run_folder import write_atomically, writing
from cosim.unit.errors import InputError
from cosim.unit.protocol import Array

#: A fiducial's pixel in the rig file is off by so much, as if somebody had clicked on it [px].
_CLICKED = 1.0


def motion_of_results(results: xr.Dataset, source: Path) -> Motion:
    """Motion of the markers of a run with one fabric.

    Raises:
        InputError: The run has no fabric, or several.
    """
    names = [str(n) for n in results if str(n).rpartition(".")[2] == "marker_position"]
    if len(names) != 1:
        raise InputError(
            source,
            "",
            f"it has {len(names)} fabrics with markers; one is rendered",
            "give a run with one fabric, or a CSV file of markers",
        )
    return _checked(results["time"].values, np.asarray(results[names[0]].values)[..., 1:3], source)


def motion_of_table(file: Path) -> Motion:
    """Motion from a CSV file with the columns time [s], marker[1].y, marker[1].z, marker[2].y ... [mm].

    Raises:
        InputError: It cannot be read, a column is missing, or a value is no number.
    """
    try:
        table = pd.read_csv(file)
    except (OSError, ValueError) as error:
        raise InputError(
            file, "", f"it cannot be read as a CSV table: {error}", "give time and marker[n].y, .z"
        ) from error
    count = sum(str(name).startswith("marker[") and str(name).endswith("].y") for name in table.columns)
    wanted = ["time"] + [f"marker[{k + 1}].{axis}" for k in range(count) for axis in "yz"]
    missing = [name for name in wanted if name not in table.columns]
    if missing or not count:
        raise InputError(
            file,
            "",
            f"there is no column `{(missing or ['marker[1].y'])[0]}`",
            "give time in s, and marker[n].y and marker[n].z in mm",
        )
    try:
        values = table[wanted].to_numpy(dtype=np.float64)
    except ValueError as error:
        raise InputError(file, "", f"it holds text: {error}", "give numbers alone") from error
    return _checked(values[:, 0], 1e-3 * values[:, 1:].reshape(len(values), count, 2), file)


def _checked(times: Array, places: Array, source: Path) -> Motion:
    if places.shape[1] % 2 or places.shape[1] < 6:
        raise InputError(
            source,
            "",
            f"it has {places.shape[1]} markers; a fabric has two to a row, and three rows",
            "give back and front marker of every row",
        )
    if len(times) < 4 or np.any(np.diff(times) <= 0.0):
        raise InputError(source, "", "it needs four or more times that rise", "give a longer motion")
    if not (np.isfinite(times).all() and np.isfinite(places).all()):
        raise InputError(source, "", "a time or a place is no number", "fill the gaps first")
    return Motion(np.asarray(times, dtype=np.float64), np.asarray(places, dtype=np.float64))


def write_video(
    out: Path,
    camera: CameraFile,
    camera_file: Path,
    motion: Motion,
    seed: int,
    title: str,
    on_frame: Callable[[int, int], None] = lambda done, total: None,
) -> int:
    """Render a motion into a folder: frames/, rig.yaml, truth.csv.

    Args:
        out: Folder without such files.
        camera: The camera.
        camera_file: Its file, for errors.
        motion: What moves.
        seed: Of noise and texture.
        title: For the rig file.
        on_frame: Called with the frames done and all of them.

    Returns:
        Number of frames.

    Raises:
        InputError: The folder holds such files already, the camera does not fit the motion, or the folder cannot be
            written.
    """
    for name in ("frames", "rig.yaml", "truth.csv"):
        if (out / name).exists():
            raise InputError(out / name, "", "it exists already", "give another folder with `--out`")
    try:
        renderer = Renderer(camera, motion, seed)
    except ValueError as error:
        raise InputError(camera_file, "", str(error), "correct begin, end, exposure or distortion") from error
    cv2, total = opencv(), len(renderer.begins)
    with writing(out):
        (out / "frames").mkdir(parents=True)
        for number, frame in enumerate(renderer.frames()):
            coded = cv2.imencode(".jpg", frame, [cv2.IMWRITE_JPEG_QUALITY, camera.jpeg])[1]
            (out / "frames" / f"{number + 1:06d}.jpg").write_bytes(coded.tobytes())
            on_frame(number + 1, total)
        write_atomically(out / "truth.csv", _truth(renderer).to_csv(index=False).encode())
        text = yaml.safe_dump(_rig(renderer, title), sort_keys=False, width=110)
        write_atomically(out / "rig.yaml", text.encode())
    return total


def _truth(renderer: Renderer) -> pd.DataFrame:
    places = renderer.truth()
    columns: dict[str, Array] = {"time": np.round(renderer.middles, 9)}
    for marker in range(places.shape[1]):
        for axis, letter in enumerate("yz"):
            columns[f"marker[{marker + 1}].{letter}"] = np.round(1e3 * places[:, marker, axis], 6)
    bent = curvatures((places[:, 0::2] + places[:, 1::2]) / 2.0)
    columns["fabric.max_curvature"] = np.round(np.max(np.abs(bent), axis=1), 8)
    return pd.DataFrame(columns)


def _rig(renderer: Renderer, title: str) -> dict[str, Any]:
    camera = renderer.file
    rig: dict[str, Any] = {"title": title, "source": "rendered by cosim record --video"}
    rig["picture"] = [camera.width, camera.height]
    # A picture with fiducials knows its plane; one without is right for a camera that looks squarely.
    if camera.distortion or camera.fiducials:
        u, v = renderer.middle
        rig["lens"] = {"focal": [renderer.focal] * 2, "centre": [u, v], "distortion": list(camera.distortion)}
    if camera.fiducials:
        places = renderer.fiducials()
        pixels = np.round(renderer.project(places)) + _CLICKED
        rig["plane"] = {
            "fiducials": [
                {"at": [f"{1e3 * p[0]:.6g} mm", f"{1e3 * p[1]:.6g} mm"], "pixel": [float(q[0]), float(q[1])]}
                for p, q in zip(places, pixels)
            ],
            "colour": FIDUCIAL_COLOUR,
            "diameter": f"{1e3 * FIDUCIAL_DIAMETER:g} mm",
        }
    else:
        origin = renderer.project(np.zeros((1, 2)))[0]
        rig["plane"] = {"scale": str(camera.scale), "origin": [round(float(c), 4) for c in origin]}
    rig["markers"] = {
        "colour": camera.colour,
        "diameter": str(camera.diameter),
        "layout": {"kind": "fabric", "rows": renderer.motion.places.shape[1] // 2},
    }
    begin = float(renderer.begins[0])
    rig["clock"] = {
        "rate": str(camera.rate),
        "exposure": str(camera.exposure),
        "offset": f"{begin:.9g} s",
    }
    return rig
