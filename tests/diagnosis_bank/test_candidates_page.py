"""docs/candidates.md is what the registry says, and explains every hook and name."""

from pathlib import Path

from diagnosis.bank.source import READABLE, WRITABLE
from diagnosis.candidates.candidate import HOOK_AXES
from diagnosis.candidates.document import markdown
from diagnosis.candidates.hooks import HOOKS, NAMES
from diagnosis.candidates.registry import catalogue

PAGE = Path(__file__).resolve().parents[2] / "docs" / "candidates.md"


def test_the_page_is_up_to_date():
    assert PAGE.read_text() == markdown(), "run `python -m diagnosis.candidates.document > docs/candidates.md`"


def test_the_page_names_every_candidate():
    page = PAGE.read_text()
    missing = [t.identifier for t in catalogue() if t.identifier.removeprefix("unnamed_").split("_", 1)[-1] not in page]
    assert missing == []
    assert page.count("\n### ") == sum(t.is_named for t in catalogue())


def test_every_hook_and_every_name_of_the_bank_is_explained():
    assert set(HOOKS) == set(HOOK_AXES)
    offered = set(READABLE) | {name for names in WRITABLE.values() for name in names} | {"t", "t_begin", "t_end", "dt"}
    assert set(NAMES) == offered
