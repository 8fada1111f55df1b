"""The numbers by which the diagnosis decides have a reason each, and a page that is that of the code."""

from __future__ import annotations

from pathlib import Path

from tools.thresholds import PACKAGES, page, thresholds

PAGE = Path(__file__).resolve().parents[1] / "docs" / "thresholds.md"


def test_every_number_says_what_it_is() -> None:
    silent = [(t.file, t.names) for package in PACKAGES for t in thresholds(package) if len(t.reason) < 8]
    assert not silent


def test_the_page_is_that_of_the_code() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(), "python -m tools.thresholds > docs/thresholds.md"


def test_numbers_that_a_person_knows_are_on_it() -> None:
    text = PAGE.read_text(encoding="utf-8")
    for line in ("| `MOST_LEFT` | 0.5 |", "| `FREE_LEFT` |", "| `HUBER` | 4.0 |"):
        assert line in text
