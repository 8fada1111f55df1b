"""`python -m tools.thresholds > docs/thresholds.md`: every number by which the diagnosis decides, with its reason.

The numbers stand beside the code that uses them, with a comment that says what they are and why; this collects them.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
#: Packages whose numbers are collected, in the order of a diagnosis.
PACKAGES = (
    "recording",
    "check",
    "models",
    "search",
    "faults",
    "locate",
    "isolability",
    "judge",
    "experiment",
    "amend",
    "report",
)
_CONSTANT = re.compile(r"_?[A-Z][A-Z0-9_]*$")
_HEAD = """# Numbers by which the diagnosis decides

Written by `python -m tools.thresholds`; a test compares this page with the code. Each number stands beside the code
that uses it. Numbers of laws (bounds, sizes of real rigs) are in [candidates.md](candidates.md) and
[law-library.md](law-library.md), priors in [priors.md](priors.md).
"""


@dataclass(frozen=True)
class Threshold:
    """A constant of a module.

    Args:
        file: Where it stands.
        names: Its names; several are defined together.
        value: As it is written.
        reason: The comment above or beside it; empty: none.
    """

    file: str
    names: tuple[str, ...]
    value: str
    reason: str


def thresholds(package: str) -> Iterator[Threshold]:
    """Constants of a package of the diagnosis that are numbers, in the order of its files."""
    for path in sorted((ROOT / "diagnosis" / package).rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        lines = text.split("\n")
        for node in ast.parse(text).body:
            names = names_of(node)
            if names and isinstance(node, (ast.Assign, ast.AnnAssign)) and node.value and is_number(node.value):
                value = ast.get_source_segment(text, node.value) or ""
                yield Threshold(str(path.relative_to(ROOT)), names, " ".join(value.split()), _reason(lines, node))


def names_of(node: ast.stmt) -> tuple[str, ...]:
    if isinstance(node, ast.Assign):
        target = node.targets[0]
    elif isinstance(node, ast.AnnAssign):
        target = node.target
    else:
        return ()
    found = target.elts if isinstance(target, ast.Tuple) else [target]
    names = tuple(e.id for e in found if isinstance(e, ast.Name))
    return names if names and all(_CONSTANT.match(n) for n in names) else ()


def is_number(value: ast.expr) -> bool:
    """Whether it is built from numbers alone."""
    parts = list(ast.walk(value))
    allowed = (ast.Constant, ast.UnaryOp, ast.BinOp, ast.Tuple, ast.operator, ast.unaryop, ast.expr_context)
    numbers = [p.value for p in parts if isinstance(p, ast.Constant)]
    is_plain = all(isinstance(n, (int, float)) and not isinstance(n, bool) for n in numbers)
    return bool(numbers) and is_plain and all(isinstance(p, allowed) for p in parts)


def _reason(lines: list[str], node: ast.stmt) -> str:
    """The comment above a statement, or that at its end."""
    above: list[str] = []
    index = node.lineno - 2
    while index >= 0 and lines[index].startswith("#"):
        above.insert(0, lines[index].lstrip("#: ").strip())
        index -= 1
    beside = lines[node.lineno - 1].partition("  # ")[2].strip()
    return " ".join(t for t in (" ".join(above), beside) if t)


def page() -> str:
    """The page as Markdown."""
    parts = [_HEAD]
    for package in PACKAGES:
        rows = [_row(t) for t in thresholds(package)]
        if rows:
            parts += [f"\n## {package}\n", "| name | value | what and why | file |", "|---|---|---|---|", *rows]
    return "\n".join(parts) + "\n"


def _row(one: Threshold) -> str:
    names, reason = ", ".join(f"`{n}`" for n in one.names), one.reason.replace("|", "\\|")
    return f"| {names} | {one.value} | {reason} | [{Path(one.file).name}](../{one.file}) |"


if __name__ == "__main__":
    print(page(), end="")
