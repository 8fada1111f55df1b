"""`cosim fmu validate`: one line per check, pass or fail."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from cosim.fmu.archive import FmuArchive, open_fmu
from cosim.fmu.binding import other_interface
from cosim.fmu.shared_library import fault_of_library
from cosim.fmu_tools import file_checks, run_checks
from cosim.fmu_tools.isolated import Verdict, run_isolated


@dataclass(frozen=True)
class Check:
    """One check.

    Args:
        name: What the line says.
        run: Returns what it found; raises to fail.
        is_for_actuators: Whether failing it only counts for an actuator; FMI leaves it open.
    """

    name: str
    run: Callable[[Path], str]
    is_for_actuators: bool = False


FILE_CHECKS = (
    Check("model description", file_checks.description),
    Check("binary for this platform", file_checks.binary),
    Check("exported functions", file_checks.symbols),
    Check("libraries found", file_checks.libraries),
    Check("actuator interface", file_checks.interface),
)
RUN_CHECKS = (
    Check("initialises and steps", run_checks.steps),
    Check("instances independent", run_checks.repeats),
    Check("refuses NaN", run_checks.refuses_nan, True),
    Check("refuses wrong call order", run_checks.refuses_wrong_order, True),
    Check("restored state replays", run_checks.replays),
    # A Co-Simulation FMU may solve its equations as roughly as it likes: the Reference FMUs do so by forward Euler.
    Check("CS and ME agree", run_checks.interfaces_agree, True),
)


def validate(path: Path) -> Iterator[tuple[str, Verdict]]:
    """Carry out every check.

    Yields:
        Name and verdict of each, as it is done.

    Raises:
        InputError: It cannot even be opened as an FMU.
    """
    archive = open_fmu(path)
    kind = archive.description.coSimulation or archive.description.modelExchange
    instead = other_interface(archive) if kind is None else _fault(archive, kind.modelIdentifier)
    is_actuator = file_checks.is_actuator(path)
    archive.remove()
    for check in FILE_CHECKS if instead else FILE_CHECKS + RUN_CHECKS:
        verdict = run_isolated(check.run, path)
        if verdict.is_met is False and check.is_for_actuators and not is_actuator:
            verdict = Verdict(None, f"{verdict.text} (FMI leaves this open)")
        yield check.name, verdict
    if instead:
        first, *others = RUN_CHECKS
        yield first.name, Verdict(False, instead)
        for check in others:
            yield check.name, Verdict(None, "cannot be run here")


def _fault(archive: FmuArchive, identifier: str) -> str:
    fault = fault_of_library(archive, identifier)
    return "" if fault is None else fault[0]
