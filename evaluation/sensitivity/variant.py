"""Constants of the diagnosis, and trees of its source in which one of them is another."""

from __future__ import annotations

import ast
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tools.thresholds import is_number, names_of

#: Repository whose constants are changed.
ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Constant:
    """One number of a module.

    Args:
        file: Within the repository.
        name: Of the constant.
        value: As it is.
    """

    file: str
    name: str
    value: float

    @property
    def key(self) -> str:
        """`judge.agreement.LEVEL`."""
        return ".".join([*Path(self.file).with_suffix("").parts[1:], self.name])

    def at(self, factor: float) -> float | int | None:
        """The value times a factor; None where it does not change.

        Of a share above one half the rest to 1 is divided by it: twice 0.99 would be no share. Whole numbers stay
        whole, and at least 1.
        """
        if isinstance(self.value, int):
            whole = max(round(self.value * factor), 1)
            return whole if whole != self.value else None
        if self.value == 0.0:
            return None
        if 0.5 < self.value < 1.0:
            return 1.0 - (1.0 - self.value) / factor
        return self.value * factor


def constants(package: str) -> Iterator[Constant]:
    """Numbers of a package of the diagnosis, in the order of its files.

    Args:
        package: Folder in `diagnosis/`.
    """
    for path in sorted((ROOT / "diagnosis" / package).rglob("*.py")):
        file = str(path.relative_to(ROOT))
        for name, node in _numbers(path.read_text(encoding="utf-8")):
            value = eval(compile(ast.Expression(node), file, "eval"), {"__builtins__": {}})  # numbers and signs alone
            yield Constant(file, name, value)


def write_variant(constant: Constant, value: float | int, folder: Path) -> None:
    """Write the package `diagnosis` with another value of one constant.

    Args:
        constant: Which.
        value: Its other value.
        folder: Where `diagnosis/` is written, to stand first in a path of packages.

    Raises:
        KeyError: There is no such constant.
    """
    shutil.copytree(ROOT / "diagnosis", folder / "diagnosis", ignore=shutil.ignore_patterns("__pycache__"))
    path = folder / constant.file
    text = path.read_text(encoding="utf-8")
    node = dict(_numbers(text))[constant.name]
    lines = text.splitlines(keepends=True)
    begin = _offset(lines, node.lineno, node.col_offset)
    end = _offset(lines, node.end_lineno or node.lineno, node.end_col_offset or 0)
    raw = text.encode("utf-8")
    path.write_bytes(raw[:begin] + repr(value).encode("utf-8") + raw[end:])


def _offset(lines: list[str], line: int, column: int) -> int:
    """Byte in the file of a place as `ast` gives it: columns count bytes of UTF-8."""
    return sum(len(one.encode("utf-8")) for one in lines[: line - 1]) + column


def _numbers(text: str) -> Iterator[tuple[str, ast.expr]]:
    """Constants of a module that are single numbers, also where several are defined together."""
    for node in ast.parse(text).body:
        names = names_of(node)
        value = node.value if isinstance(node, ast.Assign | ast.AnnAssign) else None
        if not names or value is None or not is_number(value):
            continue
        parts = value.elts if isinstance(value, ast.Tuple) else [value]
        if len(parts) != len(names):  # one name of several numbers
            continue
        for name, part in zip(names, parts):
            if not isinstance(part, ast.Tuple):
                yield name, part
