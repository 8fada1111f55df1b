"""Isolated FMUs compute what they compute alone, whatever else is loaded, and several at the same time."""

from functools import partial
from pathlib import Path

import numpy as np
import pytest

from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.model_exchange import ModelExchangeUnit
from cosim.fmu.settings import FmuSettings
from cosim.isolation.limits import Limits
from cosim.isolation.unit import IsolatedUnit
from cosim.run import run
from cosim.unit.errors import InputError
from cosim.unit.protocol import Causality, UnitError

from .conftest import rising

STEP = 10_000_000
#: Values of an input by its unit that every actuator accepts.
LEVELS = {"W": 0.3, "V": 0.4, "K": 295.0, "m": 0.02, "N": 0.5}


def trace(unit, steps=25):
    """Bytes of all outputs at every step, of the checkpoint, and after a restored step."""
    inputs = [v for v in unit.variables.values() if v.causality is Causality.INPUT]
    outputs = [v.name for v in unit.variables.values() if v.causality is Causality.OUTPUT]
    seen = []

    def drive(k):
        for v in inputs:
            swing = 1 + 0.05 * np.sin(0.7 * k + np.arange(v.size)).reshape(v.shape)
            unit.set(v.name, LEVELS[v.unit] * swing)

    def look():
        unit.refresh()
        seen.extend(unit.get(name).tobytes() for name in outputs)

    drive(0)
    unit.initialise(0)
    look()
    unit.exit_initialisation()
    look()
    for k in range(steps):
        drive(k)
        unit.do_step(k * STEP, STEP)
        look()
    saved = unit.save()
    unit.do_step(steps * STEP, STEP)
    unit.restore(saved, steps * STEP)
    unit.release(saved)
    look()
    seen.extend(value.tobytes() for value in unit.checkpoint().values())
    return seen


MODELS = sorted(p.parent.name for p in Path(__file__).resolve().parents[2].glob("fmus/*/model.c"))


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("kind", [CoSimulationUnit, ModelExchangeUnit], ids=["co_simulation", "model_exchange"])
def test_a_shipped_fmu_gives_the_same_bits_in_a_process_of_its_own(shipped_fmus, model, version, kind):
    traces = []
    for is_isolated in (False, True):
        archive = open_fmu(shipped_fmus / f"{model}_fmi{version}.fmu")
        build = partial(kind, "actuator", archive, FmuSettings())
        unit = IsolatedUnit("actuator", build, Limits(), archive) if is_isolated else build()
        try:
            traces.append(trace(unit))
        finally:
            unit.terminate()
    assert len(traces[0]) > 28
    assert traces[0] == traces[1]


def test_fmus_with_different_libraries_of_one_name_each_get_their_own(fmu, isolate):
    # Loaded into one process, the second gets the library of the first: its rate is 2 instead of 3.
    together = [CoSimulationUnit(n, open_fmu(fmu(gain=g)), FmuSettings()) for n, g in (("two", 2.0), ("three", 3.0))]
    apart = [isolate(fmu(gain=g), name=n) for n, g in (("two", 2.0), ("three", 3.0))]
    for unit in (*together, *apart):
        unit.initialise(0)
        unit.exit_initialisation()
        unit.do_step(0, STEP)
    values = [[float(unit.get("y")) for unit in units] for units in (together, apart)]
    for unit in together:
        unit.terminate()
    assert values == [pytest.approx([0.02, 0.02], rel=1e-12), pytest.approx([0.02, 0.03], rel=1e-12)]


def test_an_fmu_that_may_exist_once_per_process_can_exist_twice(fmu, scenario, monkeypatch):
    both = {"first": fmu(once=True), "second": fmu(once=True)}
    dataset = run(scenario(both))
    for name in both:
        assert dataset[f"{name}.y"].values.tolist() == rising(11)
        # Static variables of the library are not shared either.
        assert dataset[f"{name}.calls_in_process"].values.tolist() == list(range(11))
    monkeypatch.setenv("FAULTY_IS_LOADED", "1")  # as the first leaves it; set here to be taken back after the test
    with pytest.raises(InputError):
        run(scenario(both, isolation="none"))


def test_units_step_at_the_same_time_between_begin_step_and_finish_step(fmu, isolate, tmp_path, monkeypatch):
    # Each step returns only once both have begun it.
    (tmp_path / "meeting").mkdir()
    monkeypatch.setenv("FAULTY_FOLDER", str(tmp_path / "meeting"))
    units = [isolate(fmu("meet", "step"), name=name, step_limit=60.0) for name in ("first", "second")]
    for unit in units:
        unit.initialise(0)
        unit.exit_initialisation()
    for k in range(5, 8):
        for unit in units:
            unit.begin_step(k * STEP, STEP)
        for unit in units:
            assert unit.finish_step().time == (k + 1) * STEP
    assert [float(unit.get("y")) for unit in units] == pytest.approx([0.03] * 2, rel=1e-12)


def test_a_step_that_waits_for_another_unit_is_never_finished_one_after_the_other(fmu, isolate, tmp_path, monkeypatch):
    (tmp_path / "meeting").mkdir()
    monkeypatch.setenv("FAULTY_FOLDER", str(tmp_path / "meeting"))
    unit = isolate(fmu("meet", "step"), step_limit=1.5)
    unit.initialise(0)
    unit.exit_initialisation()
    with pytest.raises(UnitError, match=r"fmi2DoStep did not return within 1\.5 s"):
        unit.do_step(5 * STEP, STEP)


def test_a_crash_of_one_leaves_the_other_running(fmu, isolate):
    good, bad = isolate(fmu(), name="good"), isolate(fmu("segfault", "step"), name="bad")
    for unit in (good, bad):
        unit.initialise(0)
        unit.exit_initialisation()
        unit.begin_step(5 * STEP, STEP)
    with pytest.raises(UnitError, match=r"^bad at t = 0\.05 s: .*SIGSEGV"):
        bad.finish_step()
    assert good.finish_step().time == 6 * STEP
    assert good.do_step(6 * STEP, STEP).time == 7 * STEP
    assert good.get("y") == pytest.approx(0.02, rel=1e-12)


def test_the_record_of_a_run_names_the_file_of_an_isolated_fmu(fmu, scenario, tmp_path):
    run(scenario({"faulty": fmu()}), tmp_path / "run")
    written = "".join(p.read_text() for p in (tmp_path / "run").glob("*.json"))
    assert "nothing_nowhere.fmu, sha256" in written
