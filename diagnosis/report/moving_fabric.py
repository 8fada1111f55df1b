"""A fabric as the scenario and as the amended model move it, beside what was recorded, for the report."""

from __future__ import annotations

import base64
import hashlib
import html
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from chainmail.play.film import Fabric, Film
from chainmail.play.from_diagnosis import placed
from chainmail.play.from_results import fabric_of
from chainmail.play.page import page
from cosim.components import FabricComponent
from cosim.compute.steps import counted
from cosim.run import RunStopped, run
from cosim.scenario import Scenario, load_scenario
from cosim.unit.errors import InputError
from diagnosis.judge.diagnosis import Diagnosis
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import Recording
from diagnosis.report.json_file import as_json
from diagnosis.report.recorded_marks import marks_of

if TYPE_CHECKING:
    from markupsafe import Markup

_AMENDED, _AS_IT_IS = "amended model", "scenario as it was"


@dataclass(frozen=True)
class MovingFabric:
    """A moving picture, or why there is none.

    Args:
        recording: Title of the recording whose inputs drive the fabric.
        shown: Titles of the fabrics, the coloured one first; the others are outlines.
        page: A whole page; empty where no run ended.
        stopped: What each run that did not end said.
    """

    recording: str
    shown: tuple[str, ...] = ()
    page: str = ""
    stopped: tuple[str, ...] = ()

    @property
    def escaped(self) -> Markup:
        """The page as the value of an attribute: as it is, where other texts lose their line ends."""
        from markupsafe import Markup

        return Markup(html.escape(self.page))

    @property
    def scripts(self) -> tuple[str, ...]:
        """Hashes of the page's scripts: the report runs these, and no other (CSP Level 3, section 6.7.2.7)."""
        texts = re.findall("<script>(.*?)</script>", self.page, re.DOTALL)
        return tuple(f"sha256-{base64.b64encode(hashlib.sha256(t.encode()).digest()).decode()}" for t in texts)


def moving_fabric(diagnosis: Diagnosis, scenario: Scenario, recording: Recording) -> MovingFabric | None:
    """Run the amended model and the scenario under the inputs of a recording, by the whole co-simulation.

    What was fitted for one recording alone is not in the amended model, and so not in the picture. Ctrl-C ends the
    picture and costs nothing else.

    Args:
        diagnosis: With the path of its amended model, where it has one.
        scenario: What was diagnosed.
        recording: Whose inputs drive both, and whose points are drawn beside them.

    Returns:
        None where the scenario has no fabric.
    """
    if not any(isinstance(c, FabricComponent) for c in scenario.components.values()):
        return None
    models = {_AS_IT_IS: scenario}
    if diagnosis.amended_model is not None:
        models = {_AMENDED: load_scenario(Path(diagnosis.amended_model)), **models}
    fabrics, stopped = [], []
    for title, model in counted(tuple(models.items()), "runs for the moving fabric"):
        try:
            results = run(scenario_of(model, recording))
            fabrics.append(replace(fabric_of(results, title), title=title))
        except RunStopped as error:
            stopped.append(f"{title}: the run stopped: {error.reason}")
            if error.is_interrupt:  # the answer is there already: what is interrupted is its picture
                break
        except InputError as error:
            stopped.append(f"{title}: {error.problem}")
    try:
        text = page(_film(fabrics, diagnosis, recording)) if fabrics else ""
    except InputError as error:  # a marker that reads kilometres must not cost the answer
        return MovingFabric(recording.title, stopped=(*stopped, f"{error.key}: {error.problem}"))
    return MovingFabric(recording.title, tuple(f.title for f in fabrics), text, tuple(stopped))


def _film(fabrics: Sequence[Fabric], diagnosis: Diagnosis, recording: Recording) -> Film:
    first = fabrics[0]
    # Their times are those of a recording that was fitted, which this one need not be.
    findings = tuple(replace(f, intervals=()) for f in placed(as_json(diagnosis)["findings"], first))
    return Film(tuple(fabrics), (marks_of(recording, first),), findings)
