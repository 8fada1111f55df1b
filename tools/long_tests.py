"""`python -m tools.long_tests REPORT.xml`: which tests `make test` leaves to `make test-long`, by measured seconds.

REPORT.xml is what `pytest --junitxml=REPORT.xml` wrote of a whole run. A test that is not in the list, a new one or one
of another name, is in `make test`; `tests/conftest.py` reads the list and gives those in it the marker `long`.
"""

from __future__ import annotations

import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable
from pathlib import Path

#: Seconds from which a test is long: what is shorter takes about ten minutes of two cores in all.
LONG = 2.5
#: The list: seconds and the test, as pytest calls it.
LIST = Path(__file__).resolve().parents[1] / "tests" / "long_tests.txt"


def long_tests(report: Path, least: float = LONG) -> dict[str, float]:
    """Tests of a report that took so many seconds, the longest first.

    Args:
        report: Written by `pytest --junitxml`.
        least: Seconds.

    Raises:
        ValueError: The report holds no test.
    """
    cases = list(ElementTree.parse(report).getroot().iter("testcase"))
    if not cases:
        raise ValueError(f"{report} holds no test: write it by `pytest --junitxml={report}`")
    found = {_name(c.get("classname", ""), c.get("name", "")): float(c.get("time", "0")) for c in cases}
    return dict(sorted(((n, s) for n, s in found.items() if s >= least), key=lambda item: -item[1]))


def _name(module: str, name: str) -> str:
    """A test as pytest calls it.

    >>> _name("tests.cosim.test_runs", "test_a_run[drape]")
    'tests/cosim/test_runs.py::test_a_run[drape]'
    """
    return f"{module.replace('.', '/')}.py::{name}"


def names(lines: Iterable[str]) -> frozenset[str]:
    """Tests of the lines of the list.

    >>> sorted(names(["12.5 tests/a.py::test_b[c d]", ""]))
    ['tests/a.py::test_b[c d]']
    """
    return frozenset(line.rstrip("\n").partition(" ")[2] for line in lines if line.strip())


def main() -> None:
    """Write the list of a report."""
    found = long_tests(Path(sys.argv[1]))
    LIST.write_text("".join(f"{seconds:.1f} {name}\n" for name, seconds in found.items()), encoding="utf-8")
    print(f"{len(found)} tests, {sum(found.values()) / 60.0:.1f} minutes of one core: {LIST}")


if __name__ == "__main__":
    main()
