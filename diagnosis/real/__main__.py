"""`python -m diagnosis.real --recordings RAW --out DIR`: public data sets as recording folders."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from cosim.errors import InputError
from diagnosis.real.folder import write_data_set
from diagnosis.real.pendulum import pendulum
from diagnosis.real.raw_files import SOURCES, VARIABLE, recordings_folder
from diagnosis.real.sma_limb import sma_limb
from diagnosis.real.tclab import tclab


def main(arguments: list[str] | None = None) -> int:
    """Write all data sets; returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m diagnosis.real", description=__doc__)
    parser.add_argument("--recordings", type=Path, help=f"folder of the raw files; default ${VARIABLE}")
    parser.add_argument("--out", type=Path, required=True, help="folder for the recordings")
    given = parser.parse_args(arguments)
    raw = recordings_folder(given.recordings)
    try:
        if raw is None:
            fetch = "; ".join(f"{name}: {where}" for name, where in SOURCES.items())
            raise InputError("--recordings", "", "no folder of raw files is given",
                             f"fetch them ({fetch}), then give the folder or set {VARIABLE}")  # fmt: skip
        for read in (tclab, sma_limb, pendulum):
            for folder in write_data_set(read(raw), given.out):
                print(folder)
    except InputError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
