"""The amended scenario of a fabric: coils as the amended model has them, the fabric with what was found of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

from cosim.scenario import Scenario
from diagnosis.amend.amend import write_amended
from diagnosis.amend.beside import take_along
from diagnosis.amend.changes import changes_of
from diagnosis.amend.written import comment_of, write_scenario
from diagnosis.search.problem import Point

if TYPE_CHECKING:
    from diagnosis.models.fabric.model import FabricModel

#: Engine to how it is called.
ENGINES = {"bullet": "Bullet", "mujoco": "MuJoCo"}


def judged_by(engine: str, runs: int, has_network: bool) -> str:
    """What simulates readings that judge, for people.

    >>> judged_by("mujoco", 3, False)
    'means of 3 free runs of MuJoCo in the closed co-simulation (docs/fabric-diagnosis.md)'
    """
    what = f"means of {runs} free runs of {ENGINES[engine]}"
    if not has_network:
        return f"{what} in the closed co-simulation (docs/fabric-diagnosis.md)"
    return (
        f"{what}, driven by the coil network: the actuator ignores the fabric, so the closed co-simulation gives the "
        "same until contacts amplify the last digits (docs/fabric-diagnosis.md)"
    )


def amend_fabric(scenario: Scenario, model: FabricModel, point: Point, folder: Path) -> Path:
    """Write the scenario with the fitted parameters and effects of coils and fabric.

    What belongs to one recording alone is left as the scenario has it.

    Args:
        scenario: What was diagnosed.
        model: Model of the recordings that were fitted.
        point: Its fitted values.
        folder: Where the scenario goes.

    Returns:
        The file that `cosim run` takes.

    Raises:
        CannotAmend: Something that was found of the coils has no place in a scenario.
        InputError: An FMU cannot be compiled.
    """
    if model.network is not None:
        path = write_amended(scenario, changes_of(scenario, model.network, model.network_point(point)), folder).path
        data = yaml.safe_load(path.read_text(encoding="utf-8"))
    else:
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / "scenario.yaml"
        data = yaml.safe_load(scenario.to_yaml())
        take_along(scenario, data, folder)
    _put(data, model, point)
    write_scenario(
        data, comment_of("docs/fabric-diagnosis.md", model.own_point(point).terms, model.camera_terms()), path
    )
    return path


def _put(data: dict[str, Any], model: FabricModel, point: Point) -> None:
    daily = {f.name for f in model.free if f.is_own}
    numbers = model.fabric_parameters(point, 0)
    lasting = {name: f"{v.number!r} {v.unit}" for name, v in numbers.items() if name not in daily}
    fabric = data["components"][model.component]
    fabric["parameters"] = {**fabric.get("parameters", {}), **lasting}
