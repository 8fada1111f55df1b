"""Amended scenarios of models that the co-simulation itself simulates: other parameters of its components."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

import yaml

from cosim.scenario import Scenario
from diagnosis.amend.beside import take_along
from diagnosis.amend.written import comment_of, write_scenario
from diagnosis.search.problem import Term


def amend_closed_loop(
    scenario: Scenario, restated: Scenario, terms: Mapping[Term, Iterable[float]], folder: Path
) -> Path:
    """Write the scenario with the fitted parameters and terms, which its components switch on themselves.

    What belongs to one recording or day alone (its initial state) is left as the scenario has it; what all share is in.

    Args:
        scenario: What was diagnosed.
        restated: The same with the values of the fitted point that all recordings share.
        terms: Laws of that point, with their values.
        folder: Where the scenario goes.

    Returns:
        The file that `cosim run` takes.
    """
    folder.mkdir(parents=True, exist_ok=True)
    data = yaml.safe_load(restated.to_yaml())
    take_along(scenario, data, folder)
    path = folder / "scenario.yaml"
    write_scenario(data, comment_of("docs/amended-models.md", terms), path)
    return path
