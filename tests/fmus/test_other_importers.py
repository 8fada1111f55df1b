"""Every FMI 2.0 FMU runs unchanged in FMPy, libcosim (libcosimpy) and ecos (ecospy), with the same trace."""

import importlib.util
import json
import subprocess
import sys
from pathlib import Path

import importer_run
import numpy as np
import pytest
from fmu_runs import FMUS, every_model

SCRIPT = Path(importer_run.__file__)
#: All three run the same binary with the same steps. What differs is rounding in the time and step that they pass
#: (libcosim counts nanoseconds): a part of 1e-13 was seen. A lost step or an input one step late is a part of 1e-3.
TOLERANCE = 1e-9

others = pytest.mark.parametrize("importer", ["libcosimpy", "ecospy"])


@pytest.fixture(scope="module")
def trace(fmu_file, tmp_path_factory):
    """`trace(importer, model)` runs a process; shape (steps, outputs, elements)."""
    folder, kept = tmp_path_factory.mktemp("importers"), {}

    def run(importer, model):
        if (importer, model) not in kept:
            out = folder / f"{importer}_{model}.json"
            table = (FMUS / model / "config.h").read_text()
            inputs = ",".join(name for name in importer_run.INPUTS if f'"{name}", INPUT' in table)
            fmu = fmu_file(model, 2, importer_run.ELEMENTS)
            done = subprocess.run(
                [sys.executable, SCRIPT, importer, fmu, inputs, out], capture_output=True, text=True, check=False
            )
            # Some importers crash while Python shuts down, after everything has been written.
            assert out.exists(), done.stdout[-2000:] + done.stderr[-2000:]
            values = np.array(json.loads(out.read_text()))
            kept[importer, model] = values.reshape(len(values), len(importer_run.OUTPUTS), importer_run.ELEMENTS)
        return kept[importer, model]

    return run


@every_model
@others
def test_another_importer_gives_the_trace_of_fmpy(trace, model, importer):
    if importlib.util.find_spec(importer) is None:
        pytest.skip(f"{importer} is not installed: `make dev` installs it")
    expected, seen = trace("fmpy", model), trace(importer, model)
    assert seen.shape == expected.shape == (importer_run.STEPS, 6, importer_run.ELEMENTS)
    for k, name in enumerate(importer_run.OUTPUTS):
        size = np.abs(expected[:, k]).max()
        np.testing.assert_allclose(seen[:, k], expected[:, k], rtol=TOLERANCE, atol=TOLERANCE * size, err_msg=name)


@every_model
def test_the_trace_that_is_compared_moves(trace, model):
    """Each element was driven on its own, and let go half-way; so an importer that lost an input would be found."""
    run = trace("fmpy", model)
    convected = run[:, importer_run.OUTPUTS.index("convected_energy")]
    assert (np.diff(convected[-1]) > 1e-3).all()
    half = importer_run.STEPS // 2
    assert convected[half - 1, -1] > 0.1
    moved = [name for k, name in enumerate(importer_run.OUTPUTS) if np.ptp(run[:, k]) > 1e-6 * np.abs(run[:, k]).max()]
    assert {"stiffness", "rest_length"} & set(moved)
