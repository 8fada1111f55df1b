"""A soft limb that SMA coils bend: its angle from the tags that a camera tracked, beside the coil's thermometer.

The limb is one lump of heat and one angle without inertia: the coil's moment rises with the share that has
transformed, an elastic limb pulls back to its rest angle, a damper holds the rate. Only ratios of moment, stiffness and
damping show, so the stiffness is given.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd  # type: ignore[import-untyped]

from cosim.unit.protocol import Array
from evaluation.fmus.model import OdeModel
from evaluation.real.folder import DataSet, Part
from evaluation.real.raw_files import SOURCES, raw_file
from evaluation.real.sma_limb import BETWEEN

#: Coil to file, duty, thermocouple, and the sign that makes bending towards the heated coil positive.
_COILS = {
    "c1": ("test_c1_only.csv", "pwm_duty_limb0_rev", "MCPtemp_0", 1.0),
    "c2": ("test_c2_only.csv", "pwm_duty_limb0_fwd", "MCPtemp_1", -1.0),
}
_TAGS = range(101, 110)
#: The tags of c1 stand still from 206.9 s on, to the last digit, while the limb moves: the tracker had stopped [s].
_TRACKED = 206.8
_CLOCK = "Timestamp (millisec since midnight today)"
MODEL = OdeModel(
    "limb",
    {
        "capacity": (0.189, "J/K"),
        "conductance": (0.01, "W/K"),
        "moment": (0.0144, "N*m"),
        "middle": (323.0, "K"),
        "width": (8.0, "K"),
        "stiffness": (0.05, "N*m/rad"),
        "damping": (0.05, "N*m*s/rad"),
        "rest_angle": (0.0, "rad"),
        "initial_angle": (0.0, "rad"),
        "initial_temperature": (294.15, "K"),
    },
    {"power": "W", "ambient": "K"},
    {
        "temperature": (
            "K",
            "initial_temperature",
            "(power - conductance * (temperature - ambient)) / capacity",
        ),
        "angle": (
            "rad",
            "initial_angle",
            "(moment / (1.0 + exp(-(temperature - middle) / width)) - stiffness * (angle - rest_angle)) / damping",
        ),
    },
    {"coil_temperature": ("K", "temperature"), "bending": ("rad", "angle")},
    inner_step=1e-2,
)
SCENARIO = """\
title: A soft limb that a shape-memory coil bends
time: {stop: 208 s, macro_step: 100 ms, output_step: 200 ms}
components:
  drive: {kind: programme, outputs: {power: {unit: W, constant: 0 W}}}
  room: {kind: programme, outputs: {temperature: {unit: K, constant: 21 degC}}}
  limb: {kind: fmu, fmu: limb.fmu, integrator: cvode, parameter_set: limb.yaml}
connections:
  - drive.power -> limb.power
  - room.temperature -> limb.ambient
"""
PARAMETERS = """\
title: A soft limb and its coil; of the limb only its length is published
parameters:
  capacity: {value: 0.189, unit: J/K, source: "heats by 90 K with the first pulse", uncertainty: 0.7}
  conductance: {value: 0.01, unit: W/K, source: "cools with a time constant of 20 s", uncertainty: 0.7}
  moment: {value: 0.0144, unit: N*m, source: "bends the limb by 0.29 rad at the stiffness given", uncertainty: 0.7}
  middle: {value: 323, unit: K, source: "assumption: transforms at 50 degC", uncertainty: 0.05}
  width: {value: 8, unit: K, source: "assumption: transforms over 30 K", uncertainty: 0.5}
  stiffness: {value: 0.05, unit: N*m/rad, source: "assumption: only ratios show", uncertainty: 0}
  damping: {value: 0.05, unit: N*m*s/rad, source: "assumption: settles within seconds", uncertainty: 0.7}
"""


def sma_limb_angle(raw: Path, out: Path) -> DataSet:
    """The data set; scenario, parameters and FMU are written beside it.

    Args:
        raw: Folder of the raw files.
        out: Folder of the data sets.

    Raises:
        InputError: A file is missing.
    """
    parts: list[Part] = []
    for coil, (file, duty, temperature, sign) in _COILS.items():
        table = pd.read_csv(raw_file(raw, "sma-limb", file), skiprows=2)
        clock = table[_CLOCK].to_numpy(dtype=float)
        angle = sign * bending(table)
        columns = {
            "time": clock - clock[0],
            "duty": table[duty].to_numpy(dtype=float),
            "temperature": table[temperature].to_numpy(dtype=float),
            "angle": angle - angle[np.isfinite(angle)][0],
        }
        keep = np.concatenate([[True], np.diff(columns["time"]) > 0])
        columns = {name: values[keep] for name, values in columns.items()}
        cold = float(np.mean(columns["temperature"][columns["duty"].cumsum() == 0]))
        for pulse, window in (
            ("first", {"end": f"{BETWEEN:g} s"}),
            ("second", {"begin": f"{BETWEEN:g} s", "end": f"{_TRACKED:g} s"}),
        ):
            title = f"soft limb bent by SMA coil {coil}, {pulse} pulse"
            parts.append(Part(f"{coil}_{pulse}", title, columns, _sidecar(cold, window)))
    folder = out / "sma_limb_angle"
    MODEL.build(folder)
    (folder / "scenario.yaml").write_text(SCENARIO, encoding="utf-8")
    (folder / "limb.yaml").write_text(PARAMETERS, encoding="utf-8")
    splits = {f"{c} second pulse": ((f"{c}_first",), (f"{c}_second",)) for c in _COILS}
    return DataSet("sma_limb_angle", "scenario.yaml", SOURCES["sma-limb"], tuple(parts), splits)


def bending(table: pd.DataFrame) -> Array:
    """Angle of the line from the second tag to the last above that of the first two, shape (rows,) [rad].

    Anticlockwise is positive. Scale and rotation of the camera leave no mark on it. The first two tags sit on the
    clamp: their direction is the mean over the whole file. Not a number where a tag was not found.
    """
    tags = np.stack([table[[f"tagid_x_{k}", f"tagid_y_{k}"]].to_numpy(dtype=float) for k in _TAGS], axis=1)
    tags[(tags == 0.0).all(axis=2)] = np.nan
    clamp = np.nanmean(tags[:, 1] - tags[:, 0], axis=0)
    line = tags[:, -1] - tags[:, 1]
    turned = np.arctan2(-line[:, 1], line[:, 0]) - np.arctan2(-clamp[1], clamp[0])
    return np.asarray((turned + np.pi) % (2.0 * np.pi) - np.pi)


def _sidecar(cold: float, window: dict[str, str]) -> dict[str, Any]:
    return {
        "time": {"column": "time", "unit": "ms", "zero": 0.0},
        **window,
        "overrides": {
            "components": {
                "room": {"outputs": {"temperature": {"constant": f"{cold:.6g} degC"}}},
                "limb": {"parameters": {"initial_temperature": f"{cold:.6g} degC"}},
            }
        },
        "uncertain": {"room.temperature": "1 degC", "limb.rest_angle": "0.05 rad"},
        # Supply voltage and current were not recorded: 10 W at full duty is a guess, absorbed by the heat capacity.
        "inputs": {"drive.power": {"column": "duty", "unit": "W", "factor": 10.0}},
        "channels": {
            "limb.bending": {"column": "angle", "unit": "rad", "lag_bound": "0.3 s"},
            "limb.coil_temperature": {
                "column": "temperature",
                "unit": "degC",
                "quantum": "0.0625 degC",  # MCP9600 with its thermocouple, data sheet
                "lag_bound": "30 s",
                "bias_bound": "1.5 degC",
            },
        },
    }
