"""`python -m evaluation.proving FOLDER --cases N --seed S`: writes cases with concealed effects."""

from __future__ import annotations

import argparse
import sys

from evaluation.proving.cases import KINDS, write_cases


def main(arguments: list[str] | None = None) -> int:
    """Runs the command; returns its exit code."""
    parser = argparse.ArgumentParser(
        "python -m evaluation.proving", description="Writes recordings with concealed effects."
    )
    parser.add_argument("folder", help="gets cases/ for the diagnosis and answers/ for the scoring")
    parser.add_argument("--cases", type=int, default=20, help="how many")
    parser.add_argument("--seed", type=int, default=1, help="of all draws")
    parser.add_argument("--kinds", default="", help=f"only these, separated by commas: {', '.join(KINDS)}")
    parser.add_argument("--setups", default="", help="only these rigs: network, small, zones, bath, heaters, pendulum")
    given = parser.parse_args(arguments)
    try:
        kinds, setups = ([k for k in names.split(",") if k] for names in (given.kinds, given.setups))
        write_cases(given.folder, given.cases, given.seed, kinds, setups)
    except ValueError as error:
        print(f"python -m evaluation.proving: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
