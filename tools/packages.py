"""Which packages and modules of the diagnosis import which others: `python -m tools.packages`.

The column of imports in docs/diagnosis-architecture.md is compared with it (`tests/test_packages.py`).
"""

from __future__ import annotations

import ast
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def imports_of(folder: Path, root: Path = ROOT) -> set[str]:
    """Packages, and modules of the top level, of the diagnosis that a package imports, itself left out.

    Args:
        folder: Of a package below `diagnosis/`, or a module.
        root: Of the tree.
    """
    files = [folder] if folder.suffix == ".py" else sorted(folder.rglob("*.py"))
    own = ".".join(folder.relative_to(root).with_suffix("").parts)
    found = set()
    for file in files:
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module is not None:
                found.add(node.module)
            elif isinstance(node, ast.Import):
                found |= {name.name for name in node.names}
    inside = {m for m in found if m.startswith("diagnosis.") and not (m == own or m.startswith(f"{own}."))}
    return {m.split(".")[1] for m in inside} - {own.split(".")[1]}


def packages(root: Path = ROOT) -> dict[str, set[str]]:
    """Every package and every module of the top level of the diagnosis, with what it imports."""
    places = sorted(p for p in (root / "diagnosis").iterdir() if p.suffix == ".py" or (p / "__init__.py").is_file())
    return {p.stem: imports_of(p, root) for p in places if p.stem != "__init__"}


if __name__ == "__main__":
    for name, others in packages().items():
        print(f"{name}: {', '.join(sorted(others)) or 'nothing'}")
