"""Amended scenarios as files, with what was found as comments."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from pathlib import Path
from typing import Any

import yaml

from cosim.scenario import Scenario, load_scenario
from diagnosis.search.problem import Term


def write_scenario(data: Mapping[str, Any], comment: str, path: Path) -> Scenario:
    """Write a scenario and read it back: what cannot be read back must not be handed over.

    Args:
        data: Its YAML content.
        comment: Lines before it, each with its end.
        path: The file.

    Raises:
        InputError: What was written is no scenario.
    """
    text = yaml.safe_dump(dict(data), sort_keys=False, allow_unicode=True, width=110, default_flow_style=None)
    path.write_text(comment + text, encoding="utf-8")
    return load_scenario(path)


def comment_of(page: str, terms: Mapping[Term, Iterable[float]], readings: Collection[Term] = ()) -> str:
    """Comment that names the page that explains the file, and what was found.

    Args:
        page: Path of the document.
        terms: What was found, with the values of its parameters.
        readings: Terms that change readings alone and are not in the scenario.
    """
    lines = [f"# Amended scenario, written by `cosim diagnose` ({page})."]
    for term, values in terms.items():
        numbers = ", ".join(f"{p.name} = {v:.6g} {p.unit}" for p, v in zip(term.parameters, values))
        left_out = "" if term.recording is None else "left out, a fault of one recording: "
        if term in readings:
            left_out = "left out, it changes readings and moves nothing: "
        lines.append(f"# {left_out}{term.place}: {term.law}; {numbers}")
    return "\n".join(lines) + "\n"
