"""`cosim record`: a run, read by sensors, as a recording folder."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cosim.errors import InputError
from cosim.loading import load_scenario
from cosim.run_folder import RunFolder

if TYPE_CHECKING:
    import xarray as xr

    from cosim.scenario import Scenario


def record(
    scenario: Annotated[str, typer.Argument(help="A scenario file or name, or the folder of a run.")],
    out: Annotated[Path, typer.Option(help="Folder for the recording.")],
    channels: Annotated[
        str, typer.Option(help="Quantities, separated by spaces, for example `supply.current coil[*].temperature`.")
    ] = "",
    sensor: Annotated[Path | None, typer.Option(help="Sensors; default: perfect ones, ten times a second.")] = None,
    seed: Annotated[int, typer.Option(min=0, help="Of noise, jitter and losses.")] = 0,
) -> None:
    """Run a scenario, read it with sensors, and write a recording.

    The recording says what was done (programmes, room, how it started) and what a laboratory would know of its sensors
    (noise, steps, limits, bounds). Lag, gain, bias, drift and the offset of a clock are in its readings alone.
    """
    from diagnosis.recording.done import conditions  # late: it loads every kind of unit
    from diagnosis.recording.readings import read_results
    from diagnosis.recording.sensor import SensorFile, load_sensors
    from diagnosis.recording.write import Notes, write_recording

    if (out / "recording.yaml").exists():
        raise InputError(out, "", "this folder already holds a recording", "give another folder with `--out`")
    sensors = SensorFile() if sensor is None else load_sensors(sensor)
    loaded, results = _results(scenario)
    done = conditions(loaded)
    done["time"]["stop"] = f"{float(results['time'].values[-1]):.12g} s"
    read = read_results(results, channels.split(), sensors, seed, sensor or Path(scenario))
    write_recording(out, read, Notes(loaded.title, f"cosim record {scenario}, seed {seed}", done))
    readings = sum(len(r.reading.times) for r in read.values())
    print(f"{out}: {len(read)} channels, {readings} readings of `{loaded.title}`")


def _results(scenario: str) -> tuple[Scenario, xr.Dataset]:
    """Scenario and results of a finished run, or of one made now."""
    import xarray as xr  # late: `cosim --help` does without

    if not Path(scenario).is_dir():
        return _run(scenario)
    folder = RunFolder(Path(scenario))
    if not folder.is_complete():
        raise InputError(folder.path, "", "this folder holds no complete run", "give a scenario, or finish the run")
    with xr.open_dataset(folder.results) as stored:
        return load_scenario(folder.scenario), stored.load()


def _run(scenario: str) -> tuple[Scenario, xr.Dataset]:
    from cosim.progress import progress_bar  # late: `--help` must not load Bullet
    from cosim.run import RunStopped, run

    loaded = load_scenario(scenario)
    try:
        with progress_bar(loaded.title) as on_progress:
            return loaded, run(loaded, on_progress=on_progress)
    except RunStopped as stopped:
        print(f"stopped: {stopped.reason}; nothing is recorded", file=sys.stderr)
        raise typer.Exit(130 if stopped.is_interrupt else 1) from stopped
