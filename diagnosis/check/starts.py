"""A fabric from several starts: contacts decide where it comes to lie, so one run of it is one draw."""

from __future__ import annotations

import os
from concurrent.futures import ProcessPoolExecutor

import xarray as xr

from chainmail.ensemble.members import member
from cosim.estimate import computing_time
from cosim.run import RunStopped, run
from cosim.scenario import Scenario

#: Computing time from which processes of their own are worth their begin [s].
WORTH = 20.0


def runs_from_starts(scenario: Scenario, starts: int) -> tuple[list[xr.Dataset], str]:
    """Results of a scenario with a fabric from several starts, those that reached their end; and why others did not.

    Args:
        scenario: With a fabric.
        starts: How many; the first is the scenario as it is.

    Raises:
        InputError: The scenario is wrong.
    """
    members = [member(scenario, number) for number in range(1, starts + 1)]
    jobs = min(starts, os.cpu_count() or 1)
    if jobs > 1 and computing_time(scenario, starts) > WORTH:
        with ProcessPoolExecutor(jobs) as pool:
            found = list(pool.map(_run, members))
    else:
        found = [_run(one) for one in members]
    ended = [one for one in found if isinstance(one, xr.Dataset)]
    return ended, next((one for one in found if isinstance(one, str)), "")


def _run(scenario: Scenario) -> xr.Dataset | str:
    """Results, or why it stopped: an error need not travel between processes."""
    try:
        return run(scenario)
    except RunStopped as stopped:
        if stopped.is_interrupt:
            raise KeyboardInterrupt from stopped
        return stopped.reason
