"""One run of a sweep, in whatever process it is made."""

from __future__ import annotations

import time as clock
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from cosim.compute.package import Files, unpacked
from cosim.compute.result import Result
from cosim.run import RunStopped, run
from cosim.scenario import parse_scenario
from cosim.sweep.file import Output, Recorded
from cosim.sweep.outputs import number, series
from cosim.unit.errors import InputError


@dataclass(frozen=True)
class Shared:
    """What all runs have in common.

    Args:
        files: FMUs and controllers of the scenarios.
        outputs: Numbers that are read off every run.
        series: Series that are kept of every run.
    """

    files: Files
    outputs: Mapping[str, Output]
    series: Mapping[str, Recorded]


def simulate(shared: Shared, text: str) -> Result:
    """Run a scenario and read off what is asked for.

    Args:
        shared: What all runs have in common.
        text: The scenario, with parameter sets written out.

    Returns:
        The numbers, shape (outputs,); then the time [s], shape (time,), and every series, shape (time,), where there
        are series; as text the units of outputs and series. Or why the run stopped.

    Raises:
        KeyboardInterrupt: The user stopped it.
    """
    begin = clock.perf_counter()
    try:
        folder = unpacked(shared.files)
        found = run(parse_scenario(text, folder / "scenario.yaml"))
        numbers = [number(found, o) for o in shared.outputs.values()]
        kept = [series(found, s) for s in shared.series.values()]
    except RunStopped as stop:
        if stop.is_interrupt:
            raise KeyboardInterrupt from stop
        return Result((), stop.reason, clock.perf_counter() - begin)
    except InputError as error:
        problem = f"{error.key}: {error.problem}" if error.key else error.problem
        return Result((), problem, clock.perf_counter() - begin)
    except (ValueError, RuntimeError) as error:
        return Result((), str(error), clock.perf_counter() - begin)
    values = np.array([float(v.values) for v in numbers])
    units = tuple(v.unit for v in (*numbers, *kept))
    time = (np.asarray(found["time"].values, dtype=np.float64), *(v.values for v in kept)) if kept else ()
    return Result((values, *time), "", clock.perf_counter() - begin, units)
