"""A coil on iron: the current rises faster the larger it is, and ends where the resistance says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.unit.protocol import Array
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import diagnosed, held, write_recording

#: Resistance and inductance of a lifting magnet [ohm, H], current at which its differential inductance is half [A].
R, L, KNEE = 8.0, 0.5, 1.6
STEP, COUNT, NOISE = 2e-3, 800, 0.01
COIL = OdeModel(
    "coil",
    {"R": (R, "ohm"), "L": (L, "H")},
    {"voltage": "V"},
    {"i": ("A", "0", "(voltage - R*i)/L")},
    {"current": ("A", "i")},
)
SCENARIO = f"""\
title: A lifting magnet
time: {{stop: {STEP * COUNT:g} s, macro_step: 2 ms, output_step: 2 ms}}
components:
  amplifier: {{kind: programme, outputs: {{voltage: {{unit: V, constant: 4 V}}}}}}
  coil: {{kind: fmu, fmu: coil.fmu, integrator: cvode}}
connections: [amplifier.voltage -> coil.voltage]
"""


def _diagnosis(folder: Path, knee: float) -> Diagnosis:
    """Three runs whose flux is L knee atan(i / knee), numbers 2 % off."""
    COIL.build(folder)
    (folder / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")
    every = []
    for number in range(3):
        rng = np.random.default_rng(number)
        voltage = np.repeat(rng.uniform(-24.0, 24.0, 16), COUNT // 16)

        def rate(x: Array, u: float) -> Array:
            return np.array([(u - 1.02 * R * x[0]) / (0.98 * L) * (1.0 + (x[0] / knee) ** 2)])

        current = held(rate, np.zeros(1), voltage, STEP)[:, 0] + NOISE * rng.standard_normal(COUNT)
        columns = {"t": STEP * np.arange(COUNT), "U": voltage, "I": current}
        channels = {"coil.current": ("I", "A", f"{NOISE} A")}
        path = write_recording(folder / f"run_{number + 1}", columns, {"amplifier.voltage": ("U", "V")}, channels)
        every.append(load_recording(path))
    return diagnosed(folder / "scenario.yaml", every)


def test_iron_that_saturates_is_named_with_the_current_at_which_it_does(tmp_path: Path) -> None:
    found = _diagnosis(tmp_path, KNEE)
    assert found.verdict is Verdict.MISSING_PHYSICS, found.statement
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert (finding.effect, finding.place, finding.is_named) == ("saturating_inductance", "coil.i", True)
    (saturation,) = finding.parameters
    assert saturation.unit == "1/A^2"
    assert saturation.value**-0.5 == pytest.approx(KNEE, rel=0.03)


def test_a_coil_without_iron_saturates_nowhere(tmp_path: Path) -> None:
    assert not [f for f in _diagnosis(tmp_path, 1e6).findings if f.is_accepted]
