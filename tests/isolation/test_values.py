"""Values, states and errors pass between the two processes unchanged."""

import gc
from functools import partial

import numpy as np
import pytest

from cosim.isolation.limits import Limits
from cosim.isolation.unit import IsolatedUnit
from cosim.unit.errors import InputError
from cosim.unit.protocol import StepStatus, Unit, UnitError, VariableType

from .conftest import descriptors
from .units import Babbler, Echo, Modules, refusing

TEXTS = ["", "grün 织物", "line\nline", "a" * 300_000, " ", "\0"]
BLOBS = [b"", bytes(range(256)), b"\0" * 300_000, b"\xff", b"a", b"b"]


@pytest.fixture
def isolated():
    """`isolated(build)` is an isolated unit; all are terminated after the test."""
    units = []

    def make(build, **limits):
        units.append(IsolatedUnit("unit", build, Limits(**limits)))
        return units[-1]

    yield make
    for unit in units:
        unit.terminate()


@pytest.fixture
def echo(isolated):
    unit = isolated(partial(Echo, "unit"))
    unit.initialise(0)
    unit.exit_initialisation()
    return unit


def extremes(vtype):
    """Six values of a type, its limits among them."""
    if vtype is VariableType.STRING:
        return np.array(TEXTS, dtype=object)
    if vtype is VariableType.BINARY:
        values = np.empty(6, dtype=object)
        values[:] = BLOBS
        return values
    dtype = vtype.dtype
    if dtype.kind == "b":
        return np.array([True, False, True, True, False, False])
    if dtype.kind == "f":
        limits = np.finfo(dtype)
        return np.array([limits.max, limits.min, limits.smallest_subnormal, -0.0, np.pi, 1 / 3], dtype=dtype)
    limits = np.iinfo(dtype)
    return np.array([limits.max, limits.min, 0, 1, 2, limits.max - 1], dtype=dtype)


@pytest.mark.parametrize("vtype", VariableType, ids=lambda t: t.value)
def test_every_type_passes_unchanged_to_the_last_bit(echo, vtype):
    values = extremes(vtype)
    for value in values:
        echo.set(f"{vtype.value}_input", np.array(value, dtype=vtype.dtype))
        echo.set(f"many_{vtype.value}_input", values.reshape(2, 3))
        assert echo.do_step(0, 10).status is StepStatus.OK
        back, all_back = echo.get(f"{vtype.value}_output"), echo.get(f"many_{vtype.value}_output")
        assert back.dtype == vtype.dtype
        assert (back.shape, all_back.shape) == ((), (2, 3))
        if vtype.dtype == object:
            assert back[()] == value
            assert all_back.ravel().tolist() == values.tolist()
        else:
            assert back.tobytes() == np.array(value).tobytes()
            assert all_back.tobytes() == values.tobytes()


def test_an_isolated_unit_satisfies_the_protocol_and_shows_what_the_unit_declares(echo):
    there = Echo("unit")
    assert isinstance(echo, Unit)
    assert dict(echo.variables) == there.variables
    assert echo.feedthrough == there.feedthrough
    assert echo.can_restore is True
    assert echo.coordinates["label"].values.tolist() == ["a", "b"]


def test_an_output_that_was_never_read_before_has_its_present_value(echo):
    echo.set("Float64_input", np.array(2.5))
    echo.do_step(0, 10)
    echo.set("Float64_input", np.array(3.5))
    assert echo.get("Float64_output") == 2.5


def test_direct_feedthrough_acts_without_a_step(echo):
    echo.set("Float64_input", np.array(4.0))
    echo.set("Int32_input", np.array(4))
    echo.refresh()
    assert (echo.get("Float64_output"), echo.get("Int32_output")) == (4.0, 0)


def test_only_the_last_of_several_values_reaches_the_unit_and_others_keep_theirs(echo):
    for value in (1, 2, 3):
        echo.set("Int32_input", np.array(value))
    echo.do_step(0, 10)
    echo.do_step(10, 10)
    assert echo.get("Int32_output") == 3


def test_a_state_can_be_restored_any_number_of_times(echo):
    echo.set("Float64_input", np.array(1.0))
    echo.do_step(0, 10)
    echo.get("Float64_output")
    saved = echo.save()
    for value in (2.0, 3.0):
        echo.set("Float64_input", np.array(value))
        echo.do_step(10, 10)
        assert echo.get("Float64_output") == value
        echo.set("Float64_input", np.array(9.0))
        echo.restore(saved, 10)
        assert (echo.get("Float64_input"), echo.get("Float64_output")) == (1.0, 1.0)
    echo.do_step(10, 10)
    assert echo.get("Float64_output") == 1.0
    echo.release(saved)


def test_a_checkpoint_continues_in_another_process(echo, isolated):
    echo.set("many_Float64_input", np.arange(6.0).reshape(2, 3))
    echo.do_step(0, 10)
    other = isolated(partial(Echo, "unit"))
    other.resume(echo.checkpoint(), 10)
    assert other.get("many_Float64_output").tolist() == [[0, 1, 2], [3, 4, 5]]
    assert other.get("many_Float64_input").tolist() == [[0, 1, 2], [3, 4, 5]]


@pytest.mark.parametrize(
    ("size", "status", "time", "message"),
    [
        (1, StepStatus.DISCARDED, 100, "too short"),
        (2, StepStatus.EARLY_RETURN, 101, "event"),
        (9, StepStatus.OK, 109, ""),
    ],
)
def test_the_outcome_of_a_step_is_that_of_the_unit(echo, size, status, time, message):
    outcome = echo.do_step(100, size)
    assert (outcome.status, outcome.time, outcome.message) == (status, time, message)


def test_errors_are_those_of_the_unit_and_it_can_go_on(echo):
    with pytest.raises(InputError) as wrong:
        echo.do_step(100, 3)
    given = wrong.value
    assert (given.source, given.key, given.problem, given.remedy) == ("file.fmu", "key", "a wrong value", "correct it")
    with pytest.raises(UnitError) as failed:
        echo.do_step(100, 4)
    given = failed.value
    assert (given.unit, given.what, given.time, given.remedy) == ("another", "its own reason", 7, "a way out")
    echo.set("Int8_input", np.array(13))
    with pytest.raises(UnitError, match=r"^unit at t = 3e-07 s: 13 is refused$"):
        echo.do_step(300, 10)
    echo.set("Int8_input", np.array(12))
    assert echo.do_step(300, 10).time == 310


def test_a_defect_of_the_unit_is_reported_with_the_end_of_its_traceback(echo):
    with pytest.raises(UnitError, match=r"ZeroDivisionError: a defect; it printed last: .*a defect") as failed:
        echo.do_step(100, 5)
    assert failed.value.time == 100


@pytest.mark.parametrize(
    ("error", "kind", "what"),
    [
        ("input", InputError, r"^file.fmu: modelDescription.xml: it is damaged\n  remedy: export it again$"),
        ("unit", UnitError, r"^faulty: there is no licence \(buy one\)$"),
        ("other", UnitError, r"^unit: RuntimeError: a defect in the construction; it printed last: "),
    ],
)
def test_errors_of_the_construction_are_those_of_the_unit(isolated, error, kind, what):
    with pytest.raises(kind, match=what):
        isolated(partial(refusing, error))


def test_rubbish_in_place_of_a_reply_is_an_error_of_the_unit(isolated):
    unit = isolated(partial(Babbler, "unit"))
    with pytest.raises(UnitError, match=r"^unit at t = 1e-08 s: its process sent something unreadable"):
        unit.do_step(10, 10)
    with pytest.raises(UnitError, match="its process has ended: its process sent something unreadable"):
        unit.do_step(20, 10)


def test_nothing_but_finish_step_may_follow_begin_step(echo):
    echo.begin_step(0, 10)
    with pytest.raises(RuntimeError, match="finish_step comes before"):
        echo.checkpoint()
    assert echo.finish_step().time == 10


def test_terminating_during_a_step_waits_for_it_and_twice_is_once(echo):
    echo.begin_step(0, 10)
    echo.terminate()
    echo.terminate()
    with pytest.raises(UnitError, match="its process has ended"):
        echo.do_step(10, 10)


def test_the_process_loads_no_engine_of_another_unit_and_is_out_of_reach_of_ctrl_c(isolated):
    state = isolated(partial(Modules, "unit")).checkpoint()
    loaded = {str(name).split(".")[0] for name in state["modules"]}
    assert "cosim" in loaded
    assert not loaded & {"pybullet", "PySpice", "circuit", "mechanics", "netCDF4", "xarray", "matplotlib", "sksundae"}
    group, process = state["group"]
    assert group == process


def test_shared_memory_is_gone_with_the_unit():
    gc.collect()
    before = descriptors("memfd")
    unit = IsolatedUnit("unit", partial(Echo, "unit"), Limits())
    assert descriptors("memfd") > before
    unit.terminate()
    del unit
    gc.collect()
    assert descriptors("memfd") == before
