"""`python -m evaluation.real --recordings RAW --out DIR`: public data sets as recording folders."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

from cosim.unit.errors import InputError
from evaluation.real.emps import emps
from evaluation.real.folder import DataSet, write_data_set
from evaluation.real.pendulum import pendulum
from evaluation.real.raw_files import SOURCES, VARIABLE, recordings_folder
from evaluation.real.silverbox import silverbox
from evaluation.real.sma_limb import sma_limb
from evaluation.real.sma_limb_angle import sma_limb_angle
from evaluation.real.tclab import tclab

#: Name of a data set to its reader, called with the folder of the raw files and that of the data sets.
DATA_SETS: dict[str, Callable[[Path, Path], DataSet]] = {
    "tclab": lambda raw, _: tclab(raw),
    "sma-limb": lambda raw, _: sma_limb(raw),
    "sma-limb-angle": sma_limb_angle,
    "cart-pendulum": lambda raw, _: pendulum(raw),
    "emps": emps,
    "silverbox": silverbox,
}


def main(arguments: list[str] | None = None) -> int:
    """Write the data sets; returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m evaluation.real", description=__doc__)
    parser.add_argument("--recordings", type=Path, help=f"folder of the raw files; default ${VARIABLE}")
    parser.add_argument("--out", type=Path, required=True, help="folder for the recordings")
    parser.add_argument(
        "--only",
        nargs="+",
        choices=DATA_SETS,
        metavar="NAME",
        default=[*DATA_SETS],
        help=f"data sets; default: {', '.join(DATA_SETS)}",
    )
    given = parser.parse_args(arguments)
    raw = recordings_folder(given.recordings)
    try:
        if raw is None:
            fetch = "; ".join(f"{name}: {where}" for name, where in SOURCES.items())
            raise InputError(
                "--recordings",
                "",
                "no folder of raw files is given",
                f"fetch them ({fetch}), then give the folder or set {VARIABLE}",
            )
        for name in given.only:
            for folder in write_data_set(DATA_SETS[name](raw, given.out), given.out):
                print(folder)
    except InputError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
