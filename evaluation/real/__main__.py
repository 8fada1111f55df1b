"""`python -m evaluation.real --recordings RAW --out DIR`: public data sets of systems as recording folders."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from cosim.errors import InputError
from diagnosis.real.folder import write_data_set
from evaluation.real.emps import emps
from evaluation.real.silverbox import silverbox


def main(arguments: list[str] | None = None) -> int:
    """Write all data sets; returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m evaluation.real", description=__doc__)
    parser.add_argument("--recordings", type=Path, required=True, help="folder of the raw files")
    parser.add_argument("--out", type=Path, required=True, help="folder for the recordings")
    given = parser.parse_args(arguments)
    try:
        for read in (emps, silverbox):
            for folder in write_data_set(read(given.recordings, given.out), given.out):
                print(folder)
    except InputError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
