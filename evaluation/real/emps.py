"""EMPS: a slide that a DC motor drives over a screw, in windows of two seconds.

A. Janot, M. Gautier, M. Brunot, Data set and reference models of EMPS, Workshop on Nonlinear System Identification
Benchmarks, 2019 (nonlinearbenchmark.org). The simple model is a mass with viscous friction.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd  # type: ignore[import-untyped]

from evaluation.fmus.model import OdeModel
from evaluation.real.folder import DataSet, Part
from evaluation.real.raw_files import SOURCES, raw_file

#: Length of a window [s], and share of the recording that is fitted.
WINDOW, FITTED = 2.0, 0.6
#: Readings that are kept: each of so many; 1 kHz, and the slide turns within 0.1 s.
EVERY = 5
MODEL = OdeModel(
    "slide",
    {"mass": (95.0, "kg"), "friction": (400.0, "N*s/m"), "x_0": (0.0, "m"), "v_0": (0.0, "m/s")},
    {"force": "N"},
    {"x": ("m", "x_0", "v"), "v": ("m/s", "v_0", "(force - friction * v) / mass")},
    {"position": ("m", "x")},
)
SCENARIO = """\
title: A slide that a motor drives, as a mass with viscous friction
time: {stop: 2 s, macro_step: 1 ms, output_step: 5 ms}
components:
  motor: {kind: programme, outputs: {force: {unit: N, constant: 0 N}}}
  slide: {kind: fmu, fmu: slide.fmu, integrator: cvode, parameter_set: slide.yaml}
connections:
  - motor.force -> slide.force
"""
PARAMETERS = """\
title: A slide, from a fit of the simple model
parameters:
  mass: {value: 95, unit: kg, source: "a fit of mass and viscous friction alone", uncertainty: 0.1}
  friction: {value: 400, unit: N*s/m, source: "a fit of mass and viscous friction alone", uncertainty: 0.5}
"""


def emps(raw: Path, out: Path) -> DataSet:
    """The data set; scenario, parameters and FMU are written beside it.

    Args:
        raw: Folder of the raw files.
        out: Folder of the data sets.

    Raises:
        InputError: The file is missing.
    """
    table = pd.read_csv(raw_file(raw, "emps", "slide.csv"))
    time, force, position = (table[c].to_numpy() for c in ("time_s", "motor_force_N", "position_m"))
    step = float(np.median(np.diff(time)))
    speed = np.gradient(np.convolve(position, np.ones(9) / 9, mode="same"), step)
    size = round(WINDOW / step)
    parts = []
    for number in range(len(time) // size):
        own = slice(number * size, (number + 1) * size)
        first = max(own.start, 5)
        clock = np.round((np.arange(size)) * 1e-3, 6)
        columns: dict[str, Any] = {"time": clock, "force": force[own], "position": np.full(size, np.nan)}
        columns["position"][::EVERY] = position[own][::EVERY]
        sidecar = {
            "time": {"column": "time", "unit": "s"},
            "order": number + 1,
            "day": "the record",
            "overrides": {
                "components": {
                    "slide": {
                        "parameters": {
                            "x_0": f"{float(position[own.start])!r} m",
                            "v_0": f"{float(speed[first])!r} m/s",
                        }
                    }
                }
            },
            "uncertain": {"slide.v_0": "2 mm/s"},
            "inputs": {"motor.force": {"column": "force", "unit": "N"}},
            "channels": {"slide.position": {"column": "position", "unit": "m"}},
        }
        parts.append(Part(f"window_{number + 1}", f"window {number + 1}", columns, sidecar))
    names = [p.name for p in parts]
    fitted = int(FITTED * len(names))
    folder = out / "emps"
    MODEL.build(folder)
    (folder / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")
    (folder / "slide.yaml").write_text(PARAMETERS, encoding="utf-8")
    return DataSet(
        "emps",
        "scenario.yaml",
        SOURCES["emps"],
        tuple(parts),
        {"first 60 %": (tuple(names[:fitted]), tuple(names[fitted:]))},
    )
