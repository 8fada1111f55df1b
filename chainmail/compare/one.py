"""One variant of a comparison, in a process of its own: it loads what a run needs, no figures and no tables."""

from __future__ import annotations

from pathlib import Path

from chainmail.compare.variants import Variant
from cosim.assemble import assemble
from cosim.progress import reporter
from cosim.run import RunStopped, run
from cosim.run_folder import RunFolder
from cosim.scenario import Scenario
from cosim.unit.errors import InputError

INTERRUPTED = "interrupted; the same command goes on from here"


def run_one(made: Variant, folder: Path, number: int) -> str:
    """Run or resume one variant, which has this number on the board; returns an empty text, or why it stopped."""
    kept = RunFolder(folder)
    try:
        is_begun = kept.scenario.exists()
        if kept.is_complete():
            _refuse_other(kept, made.scenario)
            return ""
        run(made.scenario, folder, is_begun, reporter(number))
    except RunStopped as stopped:
        return INTERRUPTED if stopped.is_interrupt else stopped.reason
    except InputError as error:
        return str(error)
    except KeyboardInterrupt:
        return INTERRUPTED
    return ""


def _refuse_other(kept: RunFolder, scenario: Scenario) -> None:
    assembly = assemble(scenario)
    try:
        kept.refuse_other(assembly.scenario, assembly.parameters)
    finally:
        assembly.system.terminate()
