"""The table of packages in docs/diagnosis-architecture.md says what is imported."""

from __future__ import annotations

import re
from pathlib import Path

from tools.packages import ROOT, imports_of, packages

PAGE = ROOT / "docs" / "diagnosis-architecture.md"
#: `| `diagnosis/judge/` | job | imports |`, of packages and modules of the top level.
ROW = re.compile(r"^\| `diagnosis/(\w+)(?:/|\.py)` \|.*\|([^|]*)\|$", re.MULTILINE)


def test_the_table_says_what_each_package_imports() -> None:
    rows = {name: set(re.findall(r"`(\w+)`", cell)) for name, cell in ROW.findall(PAGE.read_text(encoding="utf-8"))}
    found = packages()
    assert len(rows) >= 14
    assert {name: others for name, others in found.items() if name in rows} == rows
    missing = [name for name in found if name not in rows and (ROOT / "diagnosis" / name).is_dir()]
    assert missing == []


def test_imports_are_those_of_a_package_and_not_its_own(tmp_path: Path) -> None:
    package = tmp_path / "diagnosis" / "first"
    package.mkdir(parents=True)
    (package / "a.py").write_text(
        "from diagnosis.first.b import c\nfrom diagnosis.second.d import e\nimport diagnosis.third\nimport numpy\n",
        encoding="utf-8",
    )
    assert imports_of(package, tmp_path) == {"second", "third"}
