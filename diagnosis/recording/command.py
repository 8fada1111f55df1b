"""`cosim record`: a run, read by sensors, as a recording folder."""

from __future__ import annotations

import sys
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cosim.alone import alone
from cosim.loading import load_scenario
from cosim.options import Changes, complete_scenario
from cosim.run_folder import RunFolder
from cosim.terminal import as_argument
from cosim.unit.errors import InputError

if TYPE_CHECKING:
    import xarray as xr

    from cosim.scenario import Scenario


def record(
    scenario: Annotated[
        str,
        typer.Argument(help="A scenario file or name, or the folder of a run.", autocompletion=complete_scenario),
    ],
    out: Annotated[Path, typer.Option(help="Folder for the recording.")],
    channels: Annotated[
        str, typer.Option(help="Quantities, separated by spaces, for example `supply.current coil[*].temperature`.")
    ] = "",
    sensor: Annotated[Path | None, typer.Option(help="Sensors; default: perfect ones, ten times a second.")] = None,
    seed: Annotated[int, typer.Option(min=0, help="Of noise, jitter and losses.")] = 0,
    video: Annotated[
        Path | None, typer.Option(help="Camera file: render frames of the fabric's side instead (docs/camera.md).")
    ] = None,
    changes: Changes = None,
) -> None:
    """Run a scenario, read it with sensors, and write a recording; or render it as a camera sees it.

    The recording says what was done (programmes, room, how it started) and what a laboratory would know of its sensors
    (noise, steps, limits, bounds). Lag, gain, bias, drift and the offset of a clock are in its readings alone.
    With `--video` the folder gets frames, the rig file for `cosim track`, and the true places of the markers.
    """
    if video is not None:
        if channels or sensor is not None:
            raise InputError("--video", "", "a camera has neither --channels nor --sensor", "leave them out")
        with alone(out, "rendering"):
            _render(scenario, out, video, seed, changes or [])
        return
    with alone(out, "recording"):
        if (out / "recording.yaml").exists():
            raise InputError(out, "", "this folder already holds a recording", "give another folder with `--out`")
        _read(scenario, out, channels, sensor, seed, changes or [])


def _read(scenario: str, out: Path, channels: str, sensor: Path | None, seed: int, changes: list[str]) -> None:
    """Readings of a run, or of a scenario that is run now."""
    from diagnosis.recording.done import conditions  # late: it loads every kind of unit
    from diagnosis.recording.fits import no_results
    from diagnosis.recording.readings import check_channels, read_results
    from diagnosis.recording.sensor import SensorFile, load_sensors
    from diagnosis.recording.write import Notes, write_recording

    sensors = SensorFile() if sensor is None else load_sensors(sensor)
    if not Path(scenario).is_dir():  # a run may take long: what is wrong with the readings must not cost it
        base = load_scenario(scenario, changes or [])
        span = base.time.stop.to("s") - base.time.start.to("s")
        wanted, source = channels.split(), sensor or Path(scenario)
        check_channels(no_results(base), wanted, sensors, span, Path(scenario), source)
    loaded, results = _results(scenario, changes or [])
    done = conditions(loaded)
    done["time"]["stop"] = f"{float(results['time'].values[-1]):.12g} s"
    read = read_results(results, channels.split(), sensors, seed, sensor or Path(scenario))
    write_recording(
        out,
        read,
        Notes(
            loaded.title, f"cosim record {scenario}{''.join(f' --set {c}' for c in changes or [])}, seed {seed}", done
        ),
    )
    readings = sum(len(r.reading.times) for r in read.values())
    print(f"{out}: {len(read)} channels, {readings} readings of `{loaded.title}`")


def _render(scenario: str, out: Path, camera: Path, seed: int, changes: list[str]) -> None:
    """Frames of a run, or of the markers of a CSV file."""
    from rich.console import Console

    from chainmail.camera.camera_file import load_camera  # late: OpenCV is an extra
    from chainmail.camera.opencv import opencv
    from chainmail.camera.rendered import motion_of_results, motion_of_table, write_video

    opencv()
    loaded_camera = load_camera(camera)
    if Path(scenario).suffix.lower() == ".csv":
        motion, title = motion_of_table(Path(scenario)), f"Markers of {Path(scenario).name}"
    else:
        loaded, results = _results(scenario, changes)
        motion, title = motion_of_results(results, Path(scenario)), loaded.title
    console = Console(stderr=True)
    with console.status("rendering") if console.is_terminal else nullcontext() as status:
        count = write_video(
            out,
            loaded_camera,
            camera,
            motion,
            seed,
            title,
            lambda done, total: status.update(f"{done} of {total} frames") if status else None,
        )
    print(
        f"{out}: {count} frames, rig.yaml and truth.csv; go on with: "
        f"cosim track {as_argument(out / 'frames')} --rig {as_argument(out / 'rig.yaml')} --out RECORDING"
    )


def _results(scenario: str, changes: list[str]) -> tuple[Scenario, xr.Dataset]:
    """Scenario and results of a finished run, or of one made now."""
    import xarray as xr  # late: `cosim --help` does without

    if not Path(scenario).is_dir():
        return _run(scenario, changes)
    if changes:
        raise InputError("--set", "", f"{scenario} is a run that is made already", "give its scenario instead")
    folder = RunFolder(Path(scenario))
    if not folder.is_complete():
        raise InputError(folder.path, "", "this folder holds no complete run", "give a scenario, or finish the run")
    with xr.open_dataset(folder.results) as stored:
        return load_scenario(folder.scenario), stored.load()


def _run(scenario: str, changes: list[str]) -> tuple[Scenario, xr.Dataset]:
    from cosim.progress import progress_bar  # late: `--help` must not load Bullet
    from cosim.run import RunStopped, run

    loaded = load_scenario(scenario, changes)
    try:
        with progress_bar(loaded.title) as on_progress:
            return loaded, run(loaded, on_progress=on_progress)
    except RunStopped as stopped:
        print(f"stopped: {stopped.reason}; nothing is recorded", file=sys.stderr)
        raise typer.Exit(130 if stopped.is_interrupt else 1) from stopped
