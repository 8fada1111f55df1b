"""`cosim sweep`: read, make the runs, write result, tables and figures."""

from __future__ import annotations

import json
import sys
import time as clock
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from cosim.alone import alone
from cosim.assemble import assemble
from cosim.compute.batch import Batches
from cosim.compute.cache import Cache
from cosim.compute.cluster import Place
from cosim.compute.package import Packer
from cosim.compute.progress import Progress, duration
from cosim.compute.result import Task
from cosim.run_folder import replacing, versions, write_atomically, writing
from cosim.scenario import Scenario, scenario_of_data
from cosim.sweep.axes import Points, axes_of, grid
from cosim.sweep.checks import check_outputs
from cosim.sweep.figures import draw, draw_all_indices
from cosim.sweep.file import SweepFile, base_scenario, load_sweep
from cosim.sweep.keys import changed
from cosim.sweep.one_run import Shared, simulate
from cosim.sweep.result import Made, dataset, failures_table, indices_table, reasons, table
from cosim.sweep.sensitivity import sobol_indices
from cosim.sweep.travel import packed_text, run_key
from cosim.unit.errors import InputError

#: Exit codes: as of the command line.
FAILED = 1


@dataclass(frozen=True)
class Plan:
    """A sweep that is ready to be made.

    Args:
        sweep: What was asked for.
        axes: Its axes.
        shared: What all runs have in common.
        tasks: One per run.
    """

    sweep: SweepFile
    axes: Sequence[Points]
    shared: Shared
    tasks: Sequence[Task]


def plan(path: Path) -> Plan:
    """Read a sweep and put together the scenario of every run; the first one is assembled, so that slips are told now.

    Raises:
        InputError: Something in the sweep, or in a scenario that it makes, is wrong.
    """
    sweep = load_sweep(path)
    data, source = base_scenario(sweep, path)
    base = scenario_of_data(data, source)
    axes = axes_of(sweep, _assembled(base), path)
    packer, texts = Packer(), []
    first: Scenario | None = None
    for place, changes in grid(axes):
        scenario = _scenario(data, source, changes, axes, place, path)
        if first is None:
            first = scenario
            assembly = assemble(scenario)
            assembly.system.terminate()
            check_outputs(sweep, assembly, path)
        elif sweep.series and scenario.time != first.time:
            raise InputError(
                path,
                "series",
                "the runs have different times, so their series have no common axis",
                "leave `series` out, or do not change `time`",
            )
        texts.append(packed_text(scenario, packer))
    files = packer.files()
    shared = Shared(files, sweep.outputs, sweep.series)
    return Plan(sweep, axes, shared, [Task(run_key(shared, t), t) for t in texts])


def _assembled(scenario: Scenario) -> Scenario:
    assembly = assemble(scenario)
    assembly.system.terminate()
    return assembly.scenario


def _scenario(
    data: Any, source: Path, changes: dict[str, Any], axes: Sequence[Points], place: Sequence[int], path: Path
) -> Scenario:
    try:
        return scenario_of_data(changed(data, changes), source)
    except ValueError as error:
        raise InputError(path, "axes", str(error), "write the path of a key of the scenario") from error
    except InputError as error:
        at = ", ".join(f"{a.name} = {a.columns[0].values[i]}" for a, i in zip(axes, place))
        raise InputError(
            path,
            "axes",
            f"with {at} the scenario is wrong: {error.key}: {error.problem}",
            error.remedy or "correct the axis",
        ) from error


def sweep(path: Path, out: Path, place: Place, resume: bool, progress: Progress | None = None) -> int:
    """Make a sweep and write its folder.

    Args:
        path: Sweep file.
        out: Folder.
        place: Where the runs are made.
        resume: Use the runs that an earlier sweep left in the folder.
        progress: Told of every run.

    Returns:
        Exit code: 0 where every run reached its end, 1 where one did not (the others are in the result).

    Raises:
        InputError: Something is wrong with the sweep, the folder or the cluster.
        KeyboardInterrupt: The user stopped it; what was made is kept.
    """
    begin = clock.perf_counter()
    planned = plan(path)
    with alone(out, "sweep"):
        _check_folder(out, resume)
        with writing(out):
            write_atomically(out / "sweep.yaml", path.read_bytes())
        counted = progress or Progress()
        counted.enter(planned.sweep.title, len(planned.tasks))
        with Batches(place, Cache(out / "runs"), counted) as batches:
            results = batches.results(simulate, planned.shared, planned.tasks)
        made = Made(planned.sweep, planned.axes, results)
        files = write(made, out)
        with writing(out):
            write_atomically(
                out / "summary.json",
                json.dumps(
                    {
                        "title": planned.sweep.title,
                        "runs": len(results),
                        "made now": batches.made,
                        "failed": sum(not r.is_complete for r in results),
                        "wall_time_s": {
                            "now": clock.perf_counter() - begin,
                            "all runs": sum(r.seconds for r in results),
                        },
                        "versions": versions(),
                    },
                    indent=2,
                ).encode(),
            )
    _tell(made, out, files)
    return FAILED if any(not r.is_complete for r in results) else 0


def _check_folder(out: Path, resume: bool) -> None:
    is_begun = (out / "sweep.yaml").exists() or (out / "runs").exists()
    if is_begun and not resume:
        raise InputError(
            out,
            "",
            "this folder already holds a sweep",
            "go on from it with `--resume`, or give another folder with `--out`",
        )
    if resume and not is_begun:
        raise InputError(out, "", "there is no sweep to resume here", "leave `--resume` out, or give its folder")


def write(made: Made, out: Path) -> list[Path]:
    """Write data set, tables and figures; returns the figures.

    Raises:
        InputError: The folder cannot be written.
    """
    data = dataset(made)
    indices = _indices(made)
    with writing(out):
        (out / "figures").mkdir(parents=True, exist_ok=True)
        _write_netcdf(data, out / "sweep.nc")
        write_atomically(out / "table.csv", table(made).encode())
        write_atomically(out / "failures.csv", failures_table(made.results).encode())
        if indices:
            write_atomically(out / "indices.csv", indices_table(indices).encode())
        return [
            *draw(out / "figures", data, made.axes, list(made.sweep.outputs)),
            *draw_all_indices(out / "figures", indices),
        ]


def _write_netcdf(data: xr.Dataset, path: Path) -> None:
    encoding = {n: {"zlib": True, "complevel": 4} for n, v in data.data_vars.items() if v.dtype.kind in "biuf"}
    with replacing(path) as partial:
        data.to_netcdf(partial, engine="netcdf4", encoding=encoding)


def _indices(made: Made) -> dict[tuple[str, str], Any]:
    """Sobol' indices of every output, where the design is the only axis and every run reached its end."""
    axis = next((a for a in made.axes if a.kind == "indices"), None)
    if axis is None:
        return {}
    if len(made.axes) > 1 or any(not r.is_complete for r in made.results):
        why = "a run failed" if len(made.axes) == 1 else "the sweep has another axis beside the design"
        print(f"no Sobol' indices: {why}", file=sys.stderr)
        return {}
    keys = [c.key for c in axis.columns]
    given = made.sweep.axes[axis.name].sobol
    seed = given.seed if given is not None else 0
    found: dict[tuple[str, str], Any] = {}
    for number, name in enumerate(made.sweep.outputs):
        indices = sobol_indices(np.array([r.arrays[0][number] for r in made.results]), keys, seed)
        if indices is None:
            print(f"no Sobol' indices of {name}: it is the same in every run", file=sys.stderr)
        else:
            found[name, axis.name] = (keys, indices)
    return found


def _tell(made: Made, out: Path, files: Sequence[Path]) -> None:
    failed = sum(not r.is_complete for r in made.results)
    seconds = sum(r.seconds for r in made.results)
    print(f"{len(made.results)} runs ({duration(seconds)} of simulation), {failed} failed")
    for text, numbers in reasons(made.results)[:5]:
        print(f"  {len(numbers)} failed, first run {numbers[0]}: {' '.join(text.split())}")
    print(f"data:    {out / 'sweep.nc'}\ntable:   {out / 'table.csv'}")
    if failed:
        print(f"reasons: {out / 'failures.csv'}")
    for file in files:
        print(f"figure:  {file}")
