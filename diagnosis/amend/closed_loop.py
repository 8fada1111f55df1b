"""Amended scenarios of models that the co-simulation itself simulates: other parameters of its components."""

from __future__ import annotations

from pathlib import Path

import yaml

from cosim.scenario import Scenario
from diagnosis.amend.beside import take_along
from diagnosis.amend.written import comment_of, write_scenario
from diagnosis.search.cosim_model import CosimModel
from diagnosis.search.cosim_run import changed
from diagnosis.search.problem import Point


def amend_closed_loop(scenario: Scenario, model: CosimModel, point: Point, folder: Path) -> Path:
    """Write the scenario with the fitted parameters and terms, which its components switch on themselves.

    What belongs to one recording or day alone (its initial state) is left as the scenario has it; what all share is in.

    Args:
        scenario: What was diagnosed.
        model: Model of the recordings that were fitted.
        point: Its fitted values.
        folder: Where the scenario goes.

    Returns:
        The file that `cosim run` takes.
    """
    lasting = model.changes_at(point.lasting, None)
    folder.mkdir(parents=True, exist_ok=True)
    data = yaml.safe_load(changed(scenario, lasting).to_yaml())
    take_along(scenario, data, folder)
    path = folder / "scenario.yaml"
    write_scenario(data, comment_of("docs/amended-models.md", point.terms), path)
    return path
