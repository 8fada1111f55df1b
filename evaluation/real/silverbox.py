"""Silverbox: an electronic circuit that imitates a mass on a spring that hardens.

T. Wigren, J. Schoukens, Three free data sets for development and benchmarking in nonlinear system identification,
European Control Conference 2013 (nonlinearbenchmark.org). The simple model is a linear oscillator.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd  # type: ignore[import-untyped]
from scipy.signal import resample_poly

from evaluation.fmus.model import OdeModel
from evaluation.real.folder import DataSet, Part
from evaluation.real.raw_files import SOURCES, raw_file

#: Samples at the begin of a recording that are discarded, samples of a window, and steps between two samples.
SETTLING, WINDOW, FINER = 50, 2000, 8
#: Time between two samples [s].
STEP = 0.0016384
MODEL = OdeModel(
    "oscillator",
    {"b": (1.875e5, "1/s^2"), "stiffness": (1.9e5, "1/s^2"), "damping": (43.0, "1/s")},
    {"force": "V"},
    {"x": ("V", "0.0", "v"), "v": ("V/s", "0.0", "b * force - stiffness * x - damping * v")},
    {"displacement": ("V", "x")},
)
SCENARIO = f"""\
title: An oscillator of one mass, linear
time: {{stop: 3.2768 s, macro_step: {STEP / FINER!r} s, output_step: {STEP!r} s}}
components:
  source: {{kind: programme, outputs: {{force: {{unit: V, interpolation: linear, constant: 0 V}}}}}}
  circuit: {{kind: fmu, fmu: oscillator.fmu, integrator: cvode, parameter_set: oscillator.yaml}}
connections:
  - source.force -> circuit.force
"""
PARAMETERS = """\
title: A linear oscillator, from its frequency response
parameters:
  b: {value: 1.875e5, unit: 1/s^2, source: "frequency response", uncertainty: 0.1}
  stiffness: {value: 1.9e5, unit: 1/s^2, source: "frequency response", uncertainty: 0.1}
  damping: {value: 43, unit: 1/s, source: "frequency response", uncertainty: 0.3}
"""


def silverbox(raw: Path, out: Path) -> DataSet:
    """The data set; scenario, parameters and FMU are written beside it.

    Args:
        raw: Folder of the raw files.
        out: Folder of the data sets.

    Raises:
        InputError: A file is missing.
    """
    train = list(_windows(raw, "multisine_train", 4))
    test = list(_windows(raw, "multisine_test", 8))
    arrow = list(_windows(raw, "arrow", 20))
    folder = out / "silverbox"
    MODEL.build(folder)
    (folder / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")
    (folder / "oscillator.yaml").write_text(PARAMETERS, encoding="utf-8")
    fitted = tuple(p.name for p in train)
    splits = {"multisine": (fitted, tuple(p.name for p in test)), "arrow": (fitted, tuple(p.name for p in arrow))}
    return DataSet("silverbox", "scenario.yaml", SOURCES["silverbox"], (*train, *test, *arrow), splits)


def _windows(raw: Path, name: str, most: int) -> Iterator[Part]:
    """Windows of one file, evenly spread over it; the input is band-limited and is given between the samples too."""
    table = pd.read_csv(raw_file(raw, "silverbox", f"{name}.csv"))
    force, displacement = table["force_V"].to_numpy(), table["displacement_V"].to_numpy()
    finer = resample_poly(force, FINER, 1, padtype="line")
    starts = np.unique(np.linspace(0, len(force) - WINDOW - 1, most).astype(int))
    for number, start in enumerate(starts.tolist()):
        clock = np.round(np.arange(WINDOW * FINER) * STEP / FINER, 10)
        columns: dict[str, Any] = {"time": clock, "force": finer[start * FINER : (start + WINDOW) * FINER]}
        columns["displacement"] = np.full(len(clock), np.nan)
        columns["displacement"][::FINER] = displacement[start : start + WINDOW]
        sidecar = {
            "time": {"column": "time", "unit": "s"},
            "begin": f"{SETTLING * STEP!r} s",
            "inputs": {"source.force": {"column": "force", "unit": "V"}},
            "channels": {"circuit.displacement": {"column": "displacement", "unit": "V", "bias_bound": "10 mV"}},
        }
        yield Part(f"{name}_{number + 1}", f"{name} {number + 1}", columns, sidecar)
