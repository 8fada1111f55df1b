"""One small example of every kind of model, and of every wrapper, with a recording that the model does not explain."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from cosim.run import run
from cosim.scenario import load_scenario, parse_scenario
from diagnosis.candidates.registry import catalogue
from diagnosis.faults.given import LawsOnly
from diagnosis.faults.model import with_faults
from diagnosis.models.build import model_of
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.models.wrappers.masked import MaskedModel
from diagnosis.models.wrappers.quasi_likelihood import QuasiLikelihoodModel
from diagnosis.recording.readings import read_results
from diagnosis.recording.recording import load_recording
from diagnosis.recording.sensor import SensorFile
from diagnosis.recording.write import Notes, write_recording
from tests.systems.rigs import oscillator, oscillator_recordings

RIG = Path(__file__).resolve().parents[2] / "docs" / "examples" / "rig"
ARM = """
title: An arm
time: {stop: 2 s, macro_step: 5 ms, output_step: 5 ms, checkpoint_step: 2 s}
components:
  arm:
    kind: bullet_pendulum
    micro_step: 1 ms
    parameter_set: pendulum_arm
    parameters: {initial_angle: 90 deg, initial_angular_velocity: 0 rad/s, viscous_damping: DAMPING}
"""


def coil_network(folder: Path) -> DiagnosisModel:
    """The rig of the documentation: two strings of coils, one recording."""
    return model_of(load_scenario(str(RIG / "scenario.yaml")), [load_recording(RIG / "monday")], catalogue())


def system_of_fmus(folder: Path) -> DiagnosisModel:
    """An oscillator as a Model Exchange FMU; its recording is of a spring that hardens."""
    scenario = oscillator(folder)
    (recorded,) = oscillator_recordings(folder, lambda x, v: -900.0 * x**3, (0.4,))
    return model_of(load_scenario(str(scenario)), [load_recording(recorded)], catalogue())


def pendulum(folder: Path, damping: str = "1e-5 N*m*s/rad") -> DiagnosisModel:
    """An arm in Bullet, recorded with another damping.

    Args:
        folder: For its files.
        damping: Of the scenario, and what else is to follow it among the parameters.
    """
    folder.mkdir(parents=True, exist_ok=True)
    sensors = SensorFile.model_validate({"default": {"rate": "50 Hz", "noise": "2 mrad", "unit": "rad"}})
    truth = parse_scenario(ARM.replace("DAMPING", "8e-5 N*m*s/rad"), folder / "truth.yaml")
    write_recording(folder / "arm", read_results(run(truth), ["arm.angle"], sensors, 1, folder / "arm"), Notes("arm"))
    file = folder / "scenario.yaml"
    file.write_text(ARM.replace("DAMPING", damping), encoding="utf-8")
    return model_of(load_scenario(str(file)), [load_recording(folder / "arm")], catalogue())


def _masked(folder: Path) -> DiagnosisModel:
    inner = coil_network(folder)
    return MaskedModel(inner, np.arange(len(inner.layout.time)) % 3 > 0)


def _scaled(folder: Path) -> DiagnosisModel:
    inner = coil_network(folder)
    return QuasiLikelihoodModel(inner, np.full(len(inner.layout.names), 2.5))


#: Kind to what makes its model in a folder.
CASES: Mapping[str, Callable[[Path], DiagnosisModel]] = {
    "coil network": coil_network,
    "system of FMUs": system_of_fmus,
    "pendulum": pendulum,
    "masked": _masked,
    "quasi-likelihood": _scaled,
    "with faults": lambda folder: with_faults(coil_network(folder)),
    "laws alone": lambda folder: LawsOnly(with_faults(coil_network(folder))),
}
