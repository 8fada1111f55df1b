"""One small example of every kind of model, and of every wrapper, with a recording that the model does not explain."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from cosim.run import run
from cosim.scenario import load_scenario, parse_scenario
from diagnosis.candidates.registry import catalogue
from diagnosis.faults.given import GivenFaults, LawsOnly
from diagnosis.faults.model import with_faults
from diagnosis.judge.initial_state import InitialStateModel
from diagnosis.judge.recording_parameters import OwnNumbers
from diagnosis.models.build import model_of
from diagnosis.models.fabric.model import FabricModel
from diagnosis.models.protocol import DiagnosisModel
from diagnosis.models.wrappers.biased import with_biases
from diagnosis.models.wrappers.masked import MaskedModel
from diagnosis.models.wrappers.quasi_likelihood import QuasiLikelihoodModel
from diagnosis.recording.readings import read_results
from diagnosis.recording.recording import load_recording
from diagnosis.recording.sensor import SensorFile
from diagnosis.recording.write import Notes, write_recording
from diagnosis.search.problem import Point
from tests.fabric_diagnosis.fabrics import small, still
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


def coil_network(folder: Path, recording: Path = RIG / "monday") -> DiagnosisModel:
    """The rig of the documentation: two strings of coils, one recording."""
    return model_of(load_scenario(str(RIG / "scenario.yaml")), [load_recording(recording)], catalogue())


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


def _biased(folder: Path) -> DiagnosisModel:
    monday = folder / "monday"
    shutil.copytree(RIG / "monday", monday)
    sidecar = monday / "recording.yaml"
    text = sidecar.read_text(encoding="utf-8").replace("quantum: 1 mA}", "quantum: 1 mA, bias_bound: 3 mA}")
    sidecar.write_text(text, encoding="utf-8")
    return with_biases(coil_network(folder, monday))


def _given_fault(folder: Path) -> DiagnosisModel:
    model = with_faults(coil_network(folder))
    fault = model.faults()[0]
    return GivenFaults(model, {fault: (fault.parameters[0].starts[0], 20.0, 40.0)})


def fabric(folder: Path) -> DiagnosisModel:
    """A fabric that is not prepared: it is asked, and never simulated."""
    return FabricModel(small(), [still(folder / "still")], catalogue())


def _begun(folder: Path) -> DiagnosisModel:
    monday = replace(load_recording(RIG / "monday"), beginning=10.0)
    return InitialStateModel(coil_network(folder), [monday])


def _of_a_day(folder: Path) -> DiagnosisModel:
    inner = coil_network(folder)
    return OwnNumbers(inner, Point(np.zeros(len(inner.parameters))), range(3))


def _scaled(folder: Path) -> DiagnosisModel:
    inner = coil_network(folder)
    return QuasiLikelihoodModel(inner, np.full(len(inner.layout.names), 2.5))


#: Kind to what makes its model in a folder.
CASES: Mapping[str, Callable[[Path], DiagnosisModel]] = {
    "coil network": coil_network,
    "system of FMUs": system_of_fmus,
    "pendulum": pendulum,
    "masked": _masked,
    "with biases": _biased,
    "quasi-likelihood": _scaled,
    "with faults": lambda folder: with_faults(coil_network(folder)),
    "laws alone": lambda folder: LawsOnly(with_faults(coil_network(folder))),
    "with a given fault": _given_fault,
    "begun": _begun,
}
#: Those too that cannot be searched as they are: they answer every question of `DiagnosisModel` all the same.
ASKED: Mapping[str, Callable[[Path], DiagnosisModel]] = {**CASES, "fabric": fabric, "of a day": _of_a_day}
