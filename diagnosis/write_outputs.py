"""What a diagnosis leaves in its folder; diagnosis.json comes last and tells that all is there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from cosim.run_folder import writing
from cosim.scenario import Scenario
from diagnosis.amend.evaluate import evaluate_amended_model
from diagnosis.curves import curves
from diagnosis.diagnose import Result
from diagnosis.experiment.write import write_experiment
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.models.build import strings_of
from diagnosis.recording.recording import Recording
from diagnosis.report.json_file import write_json
from diagnosis.report.moving_fabric import moving_fabric
from diagnosis.report.network import Network
from diagnosis.report.page import write_html


def write_outputs(
    found: Result, scenario: Scenario, training: Sequence[Recording], held_out: Sequence[Recording], out: Path
) -> Diagnosis:
    """Write the amended model, next_experiment/scenario.yaml where one was designed, report.html and diagnosis.json.

    Args:
        found: The diagnosis and its models.
        scenario: What was diagnosed.
        training: Recordings that were fitted, as the diagnosis was given them.
        held_out: Recordings that judged, likewise.
        out: Folder; made where it does not exist.

    Returns:
        The diagnosis with the paths of what was written.

    Raises:
        InputError: The folder cannot be written.
    """
    diagnosis = found.diagnosis
    with writing(out):
        out.mkdir(parents=True, exist_ok=True)
        points = found.points, found.held_out_points
        moving = None
        if diagnosis.verdict is not Verdict.RECORDING_FAULT:  # else there is nothing to amend
            diagnosis = evaluate_amended_model(
                diagnosis, scenario, (found.training, found.judge), points, held_out, out / "amended"
            )
            moving = moving_fabric(diagnosis, scenario, (*held_out, *training)[0])
        if diagnosis.next_experiment is not None:
            written = write_experiment(scenario, diagnosis.next_experiment, out / "next_experiment")
            diagnosis = replace(diagnosis, next_experiment=written)
        network = Network(strings_of(scenario))
        write_html(diagnosis, curves(found), out / "report.html", network, scenario.title, moving)
        write_json(diagnosis, out / "diagnosis.json")
    return diagnosis
