"""Running what was imported."""

import numpy as np

from cosim.run import run
from cosim.scenario import load_scenario
from cosim.ssp.export import export_ssp
from cosim.ssp.import_time import TimeRequest
from cosim.ssp.importer import import_ssp

STEP = TimeRequest(macro_step="1 ms")


def imported(path, folder, request=STEP):
    """The scenario of an SSP."""
    return load_scenario(import_ssp(path, folder, request).scenario)


def final(path, folder, *names, request=STEP):
    """Last values of variables of the imported system."""
    dataset = run(imported(path, folder, request))
    return [dataset[name].values[-1].tolist() for name in names]


def round_trip(scenario, folder, version):
    """Export, import; returns the imported scenario and asserts that both traces are equal to the last bit."""
    path = folder / "exported.ssp"
    export_ssp(scenario, path, version)
    result = import_ssp(path, folder / "imported")
    again = load_scenario(result.scenario)
    assert result.notes == ()
    for key in ("start", "stop", "macro_step", "output_step", "checkpoint_step"):
        assert getattr(again.time, key).to("s") == getattr(scenario.time, key).to("s")
    before, after = run(scenario), run(again)
    assert list(before) == list(after)
    for name in before:
        assert np.array_equal(before[name].values, after[name].values), name
    assert len(before["time"]) > 2
    return again
