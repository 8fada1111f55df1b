"""Run one check of an FMU in a process of its own: an FMU that crashes or hangs fails that check alone."""

from __future__ import annotations

import logging
import multiprocessing
import signal
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path

from cosim.unit.errors import InputError
from cosim.unit.protocol import UnitError

#: Wall time that a check may take [s].
LIMIT = 60.0


class Skipped(Exception):
    """The check does not apply to this FMU; the text says why."""


@dataclass(frozen=True)
class Verdict:
    """How one check went.

    Args:
        is_met: True, False, or None where it does not apply.
        text: What was found.
    """

    is_met: bool | None
    text: str


def run_isolated(check: Callable[[Path], str], path: Path) -> Verdict:
    """Run `check(path)`, which returns what it found, raises Skipped, or raises anything else to fail."""
    # A server that has loaded no FMU, so that children start clean and at once.
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["cosim.fmu_tools.run_checks"])
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=_work, args=(check, path, sender))
    process.start()
    sender.close()
    try:
        if not receiver.poll(LIMIT):
            return Verdict(False, f"no answer within {LIMIT:g} s")
        return Verdict(*receiver.recv())
    except EOFError:
        process.join()
        code = process.exitcode or 0
        how = signal.Signals(-code).name if code < 0 else f"exit code {code}"
        return Verdict(False, f"the FMU ended the process ({how})")
    finally:
        if process.is_alive():
            process.kill()
        process.join()


def _work(check: Callable[[Path], str], path: Path, sender: Connection) -> None:
    logging.disable(logging.WARNING)  # what is wrong with the description is a check of its own
    try:
        answer: tuple[bool | None, str] = True, check(path)
    except Skipped as reason:
        answer = None, str(reason)
    except (UnitError, InputError, ValueError) as error:
        answer = False, " ".join(str(error).split())
    except Exception as error:  # fmpy raises bare Exception
        answer = False, f"{type(error).__name__}: {error}"
    sender.send(answer)
    sender.close()
