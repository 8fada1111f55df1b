"""Reference trajectories beside the models: made by an independent oracle (scipy), met by both FMI versions.

`UPDATE_REFERENCE=1` rewrites the files; say in the changelog why.
"""

import csv
import os

import niti_twin
import numpy as np
import polypyrrole_twin
import pytest
import tcp_twin
import thermal_twin
from fmu_runs import FMUS, MODELS, STEP, advance, drive_of

COILS, ROWS, TIME = 3, 40, 0.6

#: Outputs in the order of each oracle, and how far the FMU may be away: what the oracle's own tolerances leave.
OUTPUTS = {
    "thermal_stiffness": {"temperature": 1e-8, "stiffness": 2e-7, "convected_energy": 1e-9},
    "instant_stiffness": {"stiffness": 1e-11, "stored_energy": 0.0, "convected_energy": 1e-13},
    "niti_kinetics": {"temperature": 1e-7, "martensite_fraction": 1e-8, "convected_energy": 1e-8},
    "tcp_muscle": {"temperature": 1e-8, "rest_length": 1e-12, "stored_energy": 1e-9, "convected_energy": 1e-9},
    "polypyrrole_film": {
        "rest_length": 1e-14,
        "stored_energy": 1e-12,
        "convected_energy": 1e-11,
        "film_current": 1e-12,
    },
}
every_reference = pytest.mark.parametrize("model", OUTPUTS)


def drives():
    """Power [W] or voltage [V] of three elements: on, off, partly on, so that coils turn inside their loop."""
    blocks = [[0.45, 0.3, 0.5], [0.0, 0.4, 0.2], [0.5, 0.05, 0.0], [0.0, 0.0, 0.3]]
    return np.repeat(blocks, ROWS // 4, axis=0)


def tensions():
    """Pull [N], changed at other times than the drives."""
    return np.repeat([[3.5, 3.5, 0.0], [5.0, 3.5, 2.0], [4.0, 3.5, 6.0], [3.5, 3.5, 4.0], [3.0, 3.5, 1.0]], 8, axis=0)


def oracle(model):
    """Shape (steps, outputs, coils)."""
    if model == "niti_kinetics":
        run = niti_twin.simulate(drives(), tensions(), TIME)
        run[:, 1] = 1.0 - run[:, 1]
        return run
    if model == "thermal_stiffness":
        return thermal_twin.simulate(drives(), TIME)
    if model == "instant_stiffness":
        stiffness = np.where(drives() > 0.0, float(thermal_twin.heating(70.0)), 157.1)
        return np.stack([stiffness, 0.0 * drives(), np.cumsum(drives(), axis=0) * TIME], axis=1)
    return (tcp_twin if model == "tcp_muscle" else polypyrrole_twin).simulate(drives(), TIME)


def test_every_model_has_a_reference():
    assert sorted(OUTPUTS) == MODELS


def table(model, run):
    """Header and rows of the file."""
    names = ["drive", "tension", *OUTPUTS[model]]
    values = np.concatenate([drives()[:, None], tensions()[:, None], run], axis=1)
    header = ["time", *(f"{name}[{i}]" for name in names for i in range(1, COILS + 1))]
    return header, np.column_stack([TIME * np.arange(1, ROWS + 1), values.reshape(ROWS, -1)])


@every_reference
def test_the_file_holds_what_the_oracle_computes(model):
    header, rows = table(model, oracle(model))
    file = FMUS / model / "reference.csv"
    if os.environ.get("UPDATE_REFERENCE"):
        with file.open("w", newline="") as stream:
            writer = csv.writer(stream, lineterminator="\n")
            writer.writerow(header)
            writer.writerows([[f"{value:.12g}" for value in row] for row in rows])
    with file.open() as stream:
        assert next(csv.reader(stream)) == header
    # Twelve digits are written; scipy's step control may differ by its tolerance elsewhere.
    np.testing.assert_allclose(np.loadtxt(file, delimiter=",", skiprows=1), rows, rtol=1e-9, atol=1e-9)


@every_reference
@pytest.mark.parametrize("version", [3, 2])
def test_the_fmu_meets_the_reference(make_unit, model, version):
    unit = make_unit(model, version, coils=COILS)
    if "tension" in unit.variables:
        unit.set("tension", tensions()[0])
    unit.initialise(0)
    assert drive_of(unit) == ("voltage" if model == "polypyrrole_film" else "power")
    run = advance(unit, drives(), tuple(OUTPUTS[model]), size=60 * STEP, tensions=tensions())
    reference = np.loadtxt(FMUS / model / "reference.csv", delimiter=",", skiprows=1)
    expected = reference[:, 1 + 2 * COILS :].reshape(run.shape)
    for k, (name, tolerance) in enumerate(OUTPUTS[model].items()):
        written = 1e-11 * np.abs(expected[:, k]).max()  # digits in the file
        np.testing.assert_allclose(run[:, k], expected[:, k], rtol=0.0, atol=tolerance + written, err_msg=name)
        assert np.ptp(expected[:, k]) >= 1e4 * tolerance, name  # there is something to compare
