"""Examples in docstrings give what they say, and every benchmark can be loaded."""

from __future__ import annotations

import doctest
import importlib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("chainmail", "circuit", "cosim", "diagnosis", "evaluation", "mechanics", "tools")


def modules(package: str, text: str = "") -> list[str]:
    """Modules of a package whose source holds a text."""
    found = [p for p in sorted((ROOT / package).rglob("*.py")) if text in p.read_text(encoding="utf-8")]
    return [".".join(p.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__") for p in found]


@pytest.mark.parametrize("package", PACKAGES)
def test_examples_in_docstrings_give_what_they_say(package: str) -> None:
    wrong, tried = [], 0
    for name in modules(package, ">>> "):
        failed, count = doctest.testmod(importlib.import_module(name))
        tried += count
        wrong += [name] * bool(failed)
    assert not wrong
    assert tried > 0 or package in ("circuit",)


def test_every_benchmark_can_be_loaded() -> None:
    """They are run by hand, and a name that has moved is seen nowhere else."""
    names = [n for n in modules("benchmarks") if ".peers" not in n]  # those need other tools
    assert len(names) > 10
    for name in names:
        importlib.import_module(name)
