"""The list of long tests: which tests `make test` leaves to `make test-long`."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from tools.long_tests import LIST, long_tests, names

ROOT = Path(__file__).resolve().parents[1]


def test_every_long_test_is_a_test_of_this_tree() -> None:
    """One of another name would run in `make test` unnoticed."""
    known: dict[str, set[str]] = {}
    for name in names(LIST.read_text(encoding="utf-8").splitlines()):
        file, _, test = name.partition("::")
        if file not in known:
            tree = ast.parse((ROOT / file).read_text(encoding="utf-8"))
            known[file] = {n.name for n in ast.walk(tree) if isinstance(n, ast.FunctionDef)}
        assert test.partition("[")[0] in known[file], f"{name}: python -m tools.long_tests REPORT.xml"


def test_a_listed_test_has_the_marker_and_others_have_not(request: pytest.FixtureRequest) -> None:
    listed = names(LIST.read_text(encoding="utf-8").splitlines())
    for item in request.session.items:
        assert (item.get_closest_marker("long") is not None) == (item.nodeid in listed)


def test_the_report_of_a_run_gives_the_longest_first(tmp_path: Path) -> None:
    report = tmp_path / "report.xml"
    cases = "".join(
        f'<testcase classname="tests.a.test_b" name="{n}" time="{s}"/>'
        for n, s in (("test_c", 0.1), ("test_d[x y]", 5.0), ("test_e", 70.0))
    )
    report.write_text(f"<testsuites><testsuite>{cases}</testsuite></testsuites>", encoding="utf-8")
    assert list(long_tests(report).items()) == [
        ("tests/a/test_b.py::test_e", 70.0),
        ("tests/a/test_b.py::test_d[x y]", 5.0),
    ]
    report.write_text("<testsuites/>", encoding="utf-8")
    with pytest.raises(ValueError, match="holds no test"):
        long_tests(report)
