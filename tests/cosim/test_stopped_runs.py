"""Runs that stop early: what, where and when is said, what was computed is kept, and nothing else breaks."""

import json
import os
import signal
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from circuit.unit import CircuitUnit
from cosim.interrupt import deferred_interrupt, end_as_interrupt, first_interrupt
from cosim.run import Progress, RunStopped, run
from cosim.run_folder import RunFolder, read_checkpoint
from cosim.scenario import load_scenario
from cosim.unit.errors import InputError

from .short_runs import changed, drape, heating, quantity, with_parameters


def supplied(*voltages, unit="V"):
    """Single coils with 1 V on all, and `voltages` (moment, value) on the last from then on."""
    scenario = heating()
    old = scenario.components["supply"].outputs["voltage"]
    one = [quantity("1 V")] * 6
    points = [(quantity("0 s"), one), *((quantity(t), [*one[:5], quantity(v)]) for t, v in voltages)]
    return changed(scenario, "supply", outputs={"voltage": old.model_copy(update={"points": points, "unit": unit})})


def tight(limit):
    solver = drape().components["fabric"].solver.model_copy(update={"penetration_limit": quantity(limit)})
    return changed(drape(), "fabric", solver=solver)


def heavy():
    """Gravity so strong that hooks open before Bullet resolves the contacts."""
    return with_parameters(tight("10 m"), "fabric", gravity=[quantity(f"{g} m/s^2") for g in (0, 1e5, 0)])


FAILURES = {
    # name: scenario, what stops it
    "overlap": (
        lambda: tight("1 um"),
        r"fabric at t = [\d.]+ s: link \d+ \(row \d, place \d\) and link \d+ .* overlap by",
    ),
    "torn": (heavy, r"fabric at t = 0.\d+ s: link \d+ \(row \d, place \d\) is torn free of link"),
    "fmu": (
        lambda: with_parameters(heating(), "actuator", resistance_temperature_coefficient="-0.05 1/K"),
        r"actuator at t = 0.7 s: fmi3DoStep returned error: resistance\[6\] = -[\d.]+ ohm: it must be positive",
    ),
    "circuit": (lambda: supplied(("1 s", "1e160 V")), r"circuit at t = 1.*inf W"),
    "not finite": (
        # 1e305 MV are a number, in volts they are none.
        lambda: supplied(("1 s", "1e305 MV"), unit="MV"),
        r"circuit at t = 1 s: .*supply_voltage\[6\].*finite.*, through supply.voltage -> circuit.supply_voltage",
    ),
}


@pytest.mark.filterwarnings("ignore:overflow encountered")
@pytest.mark.parametrize("name", FAILURES)
def test_a_failure_says_what_where_and_when_and_keeps_the_results_so_far(tmp_path, name):
    make, what = FAILURES[name]
    with pytest.raises(RunStopped, match=what) as stopped:
        run(make(), tmp_path / "run")
    assert not stopped.value.is_interrupt
    kept = xr.load_dataset(tmp_path / "run" / "results.nc")
    assert kept.sizes["time"] >= 1
    assert kept.attrs["status"] == stopped.value.reason
    assert all(np.isfinite(v.values).all() for v in kept.data_vars.values())
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    assert summary["status"] == stopped.value.reason
    assert summary["simulated_until_s"] >= float(kept["time"][-1])


def test_results_before_a_failure_are_those_of_a_run_that_goes_well():
    with pytest.raises(RunStopped) as stopped, np.errstate(over="ignore"):
        run(supplied(("1 s", "1e160 V")))
    kept, well = stopped.value.dataset, run(supplied())
    assert float(kept["time"][-1]) == 1.0
    for name in kept.data_vars:
        assert np.array_equal(kept[name].values, well[name].values[: kept.sizes["time"]]), name


def test_a_failed_run_that_is_resumed_fails_again_at_the_same_time(tmp_path):
    with pytest.raises(RunStopped) as first, np.errstate(over="ignore"):
        run(supplied(("2.3 s", "1e160 V")), tmp_path / "run")
    with pytest.raises(RunStopped) as second, np.errstate(over="ignore"):
        run(load_scenario(tmp_path / "run" / "scenario.yaml"), tmp_path / "run", resume=True)
    assert second.value.reason == first.value.reason
    assert json.loads((tmp_path / "run" / "summary.json").read_text())["resumed"] is True


def test_a_run_that_cannot_begin_is_bad_input_and_leaves_no_folder(tmp_path):
    scenario = changed(heating(), "circuit", start={"resistance": quantity("-1 ohm")})
    with pytest.raises(InputError, match=r"it cannot begin: resistance of coil 1 .*is -1") as caught:
        run(scenario, tmp_path / "run")
    assert caught.value.key == "components.circuit"
    assert caught.value.remedy
    assert not (tmp_path / "run").exists()


@pytest.mark.usefixtures("_one_step_per_turn")
def test_an_interrupt_inside_a_unit_takes_effect_after_the_step(monkeypatch):
    honest, steps = CircuitUnit.do_step, []

    def interrupted_step(self, time, size):
        steps.append(time)
        if len(steps) == 17:
            os.kill(os.getpid(), signal.SIGINT)
        return honest(self, time, size)

    monkeypatch.setattr(CircuitUnit, "do_step", interrupted_step)
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(RunStopped, match=r"interrupted at t = 1.7 s") as stopped:
        run(heating())
    assert stopped.value.is_interrupt
    # The step in which it came is whole: the actuator, which steps after the circuit, has made it too.
    assert float(stopped.value.dataset["time"][-1]) == 1.7
    assert len(steps) == 17
    assert signal.getsignal(signal.SIGINT) is before


def test_a_second_interrupt_acts_at_once():
    with deferred_interrupt() as interrupt:
        os.kill(os.getpid(), signal.SIGINT)
        assert interrupt.is_requested
        with pytest.raises(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT)


def test_an_interrupt_that_is_taken_does_no_more_and_the_next_one_acts_at_once():
    before = signal.getsignal(signal.SIGINT)
    asked = []
    with first_interrupt(lambda: asked.append(1) or True):
        os.kill(os.getpid(), signal.SIGINT)
        with pytest.raises(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT)
    assert asked == [1]
    with first_interrupt(lambda: False), pytest.raises(KeyboardInterrupt):
        os.kill(os.getpid(), signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is before


@pytest.fixture
def _ended_as_interrupt():
    before = signal.getsignal(signal.SIGTERM)
    end_as_interrupt()
    yield
    signal.signal(signal.SIGTERM, before)


@pytest.mark.usefixtures("_ended_as_interrupt")
def test_a_signal_to_end_is_an_interrupt_and_its_echo_from_the_group_is_none(monkeypatch):
    """`timeout` sends its signal to the process, and at once to the process's group."""
    now = [100.0]
    monkeypatch.setattr("cosim.interrupt.time.monotonic", lambda: now[0])
    with deferred_interrupt() as interrupt:
        os.kill(os.getpid(), signal.SIGTERM)
        assert interrupt.is_requested
        now[0] += 0.01
        os.kill(os.getpid(), signal.SIGTERM)
        now[0] += 2.0
        with pytest.raises(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGTERM)


@pytest.mark.usefixtures("_ended_as_interrupt")
def test_a_signal_to_end_is_an_interrupt_where_ctrl_c_is_ignored(monkeypatch):
    """What a script starts with `&` ignores SIGINT; `kill` and `timeout` must end it all the same."""
    now = [100.0]
    monkeypatch.setattr("cosim.interrupt.time.monotonic", lambda: now[0])
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with deferred_interrupt() as interrupt:
            os.kill(os.getpid(), signal.SIGINT)
            assert not interrupt.is_requested
            os.kill(os.getpid(), signal.SIGTERM)
            assert interrupt.is_requested
            now[0] += 2.0
            with pytest.raises(KeyboardInterrupt):
                os.kill(os.getpid(), signal.SIGTERM)
        now[0] += 2.0
        with pytest.raises(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGTERM)
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)


def test_a_run_within_a_search_is_asked_first():
    asked = []
    with first_interrupt(lambda: asked.append(1) or True), deferred_interrupt() as interrupt:
        os.kill(os.getpid(), signal.SIGINT)
    assert interrupt.is_requested
    assert asked == []


def test_a_run_in_another_thread_leaves_the_signals_alone():
    handlers, sizes = [], []

    def work():
        result = run(heating(), on_progress=lambda _: handlers.append(signal.getsignal(signal.SIGINT)))
        sizes.append(result.sizes["time"])

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert sizes == [31]
    assert set(handlers) == {signal.default_int_handler}


@pytest.mark.usefixtures("_one_step_per_turn")
def test_a_run_interrupted_before_its_first_checkpoint_starts_again_when_resumed(tmp_path):
    def interrupt(progress):
        if progress.done == 3:
            raise KeyboardInterrupt

    with pytest.raises(RunStopped):
        run(heating(), tmp_path / "run", on_progress=interrupt)
    assert list((tmp_path / "run" / "checkpoints").iterdir()) == []
    resumed, whole = run(heating(), tmp_path / "run", resume=True), run(heating())
    assert all(np.array_equal(resumed[n].values, whole[n].values) for n in whole.data_vars)


def interrupted(folder, done=25):
    def interrupt(progress):
        if progress.done == done:
            raise KeyboardInterrupt

    with pytest.raises(RunStopped):
        run(heating(), folder, on_progress=interrupt)


@pytest.mark.usefixtures("_one_step_per_turn")
def test_another_scenario_is_not_resumed_into_a_folder(tmp_path):
    interrupted(tmp_path / "run")
    other = with_parameters(heating(), "actuator", volume="8 mm^3")
    what = r"another scenario: `volume: 7.328 mm\^3` there, `volume: 8 mm\^3` in"
    with pytest.raises(InputError, match=what) as caught:
        run(other, tmp_path / "run", resume=True)
    assert "--resume" in caught.value.remedy
    assert run(heating(), tmp_path / "run", resume=True).sizes["time"] == 31


@pytest.mark.usefixtures("_one_step_per_turn")
def test_a_checkpoint_that_is_damaged_is_named_with_the_way_out(tmp_path):
    interrupted(tmp_path / "run")
    first, last = sorted((tmp_path / "run" / "checkpoints").iterdir())
    last.write_bytes(last.read_bytes()[:100])
    with pytest.raises(InputError, match="this checkpoint cannot be read") as caught:
        run(heating(), tmp_path / "run", resume=True)
    assert caught.value.source == str(last)
    last.unlink()
    resumed, whole = run(heating(), tmp_path / "run", resume=True), run(heating())
    assert first.exists()
    assert all(np.array_equal(resumed[n].values, whole[n].values) for n in whole.data_vars)


def test_a_run_too_long_for_memory_is_refused():
    clock = heating().time.model_copy(update={"stop": quantity("1e12 s"), "checkpoint_step": quantity("1e12 s")})
    with pytest.raises(InputError, match=r"macro-steps with .* free memory") as caught:
        run(heating().model_copy(update={"time": clock}))
    assert caught.value.key == "time.output_step"


def with_two_checkpoints(folder: Path) -> list[Path]:
    """A run of 3 s that stopped at 2.2 s, with its checkpoints at 1 and 2 s."""

    def stop(progress: Progress) -> None:
        if progress.time > 2.2:
            raise KeyboardInterrupt

    with pytest.raises(RunStopped):
        run(heating(), folder, on_progress=stop)
    return RunFolder(folder).checkpoints()


def rewritten(file: Path, change: Callable[[dict[str, Any]], None]) -> None:
    content = read_checkpoint(file)
    change(content)
    np.savez(file, **content)


@pytest.mark.parametrize(
    ("spoil", "what"),
    [
        (lambda files: files[0].unlink(), "does not go on from the one before"),
        (lambda files: rewritten(files[-1], lambda c: c.pop("index")), "lacks something or has too much"),
        (lambda files: rewritten(files[-1], lambda c: c.pop("energy")), "lacks something or has too much"),
        (lambda files: rewritten(files[-1], lambda c: c.update(index=np.array(10**9))), "does not go on"),
        (lambda files: rewritten(files[-1], _one_row_more), "does not go on from the one before"),
        (lambda files: rewritten(files[-1], _another_state), "is refused by|lacks something or has too much"),
        (lambda files: files[-1].write_bytes(b"no archive"), "cannot be read"),
    ],
    ids=["missing", "no index", "no energy", "index too large", "a row more", "another state", "no archive"],
)
def test_a_useless_checkpoint_is_named_with_what_to_do(
    tmp_path: Path, spoil: Callable[[list[Path]], None], what: str
) -> None:
    files = with_two_checkpoints(tmp_path / "run")
    assert len(files) >= 2
    spoil(files)
    with pytest.raises(InputError, match=what) as refused:
        run(heating(), tmp_path / "run", resume=True)
    assert "delete it and those after it" in refused.value.remedy
    # and that is so: without it the run goes on, from the one before or from the beginning
    for file in files if "does not" in what and not files[0].exists() else files[-1:]:
        file.unlink(missing_ok=True)
    whole = run(heating())
    resumed = run(heating(), tmp_path / "run", resume=True)
    assert all(np.array_equal(resumed[n].values, whole[n].values) for n in whole.data_vars)


def _one_row_more(content: dict[str, Any]) -> None:
    for name in [n for n in content if n.startswith("trace/")]:
        content[name] = np.concatenate([content[name], content[name][-1:]])


def _another_state(content: dict[str, Any]) -> None:
    for name in [n for n in content if n.endswith("/state")]:
        content[name] = content[name][:3]


def test_foreign_files_among_checkpoints_and_a_summary_that_is_none(tmp_path: Path) -> None:
    files = with_two_checkpoints(tmp_path / "run")
    (files[0].parent / "notes.npz").write_bytes(b"mine")
    (tmp_path / "run" / "summary.json").write_text("[]")
    assert run(heating(), tmp_path / "run", resume=True).sizes["time"] == 31
