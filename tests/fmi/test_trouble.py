"""Steps that are refused, fail, end the simulation or return early."""

from __future__ import annotations

import zipfile

import numpy as np
import pytest

from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.unit import FmuSettings
from cosim.unit.errors import InputError
from cosim.unit.protocol import NANOSECONDS, StepStatus, UnitError

both_versions = pytest.mark.parametrize("version", [2, 3])
SIZE = NANOSECONDS


@both_versions
def test_a_refused_step_leaves_no_mark(started, version):
    unit = started("trouble", version, parameters={"longest": 0.5})
    outcome = unit.do_step(0, SIZE)
    assert (outcome.status, outcome.time) == (StepStatus.DISCARDED, 0)
    assert unit.get("integral") == 0.0
    for index in range(2):
        assert unit.do_step(index * SIZE // 2, SIZE // 2).status is StepStatus.OK
    assert unit.get("integral") == 1.0


@both_versions
def test_a_step_that_is_refused_on_the_way_says_how_far_it_came(started, version):
    unit = started("trouble", version, parameters={"longest": 0.5, "is_partial": True})
    saved = unit.save()
    outcome = unit.do_step(0, SIZE)
    assert (outcome.status, outcome.time) == (StepStatus.DISCARDED, SIZE // 2)
    unit.restore(saved, 0)
    for index in range(2):
        assert unit.do_step(index * SIZE // 2, SIZE // 2).status is StepStatus.OK
    assert unit.get("integral") == 1.0
    unit.release(saved)


@both_versions
def test_a_step_that_fails_is_an_error_with_name_time_and_reason(started, version):
    unit = started("trouble", version, parameters={"fails": 2.0})
    unit.do_step(0, SIZE)
    with pytest.raises(
        UnitError, match=rf"fmi{version}DoStep returned error: fmi{version}DoStep fails as it"
    ) as caught:
        unit.do_step(SIZE, SIZE)
    assert (caught.value.unit, caught.value.time) == ("trouble", SIZE)


@both_versions
@pytest.mark.parametrize("interface", ["cs", "me"])
def test_an_fmu_may_end_the_simulation_with_valid_outputs(started, version, interface):
    unit = started("trouble", version, interface, parameters={"terminates": 2.0})
    unit.do_step(0, SIZE)
    with pytest.raises(UnitError, match="asks to terminate") as caught:
        unit.do_step(SIZE, SIZE)
    assert caught.value.time == 2 * SIZE
    assert abs(unit.get("integral") - 2.0) < 1e-7  # rtol 1e-8 of CVODE in Model Exchange, exact else


def test_early_returns_without_an_event_are_passed_over(started):
    unit = started("trouble", 3, parameters={"returns": 0.3})
    assert unit.do_step(0, SIZE).status is StepStatus.OK
    assert abs(unit.get("integral") - 1.0) < 1e-12  # a sum of four parts
    reporting = started("trouble", 3, parameters={"returns": 0.3}, report_early_return=True)
    outcome = reporting.do_step(0, SIZE)
    assert (outcome.status, outcome.time) == (StepStatus.EARLY_RETURN, 3 * SIZE // 10)


def test_early_returns_without_motion_are_given_up(started):
    unit = started("trouble", 3, parameters={"returns": 0.0})
    with pytest.raises(UnitError, match="returned early 101 times without moving"):
        unit.do_step(0, SIZE)


@both_versions
def test_derivatives_that_are_no_numbers_stop_the_integrator(started, version):
    unit = started("trouble", version, "me", parameters={"breaks": 0.5})
    with pytest.raises(UnitError, match=r"Derivatives: a value is not finite just after (0.4999|0.5)"):
        unit.do_step(0, SIZE)


def test_an_fmu_with_constant_steps_refuses_another(started, built):
    unit = started("trouble", 3)
    unit.can_vary_step = False
    unit.do_step(0, SIZE)
    with pytest.raises(UnitError, match="cannot change its communication step size"):
        unit.do_step(SIZE, SIZE // 2)


def test_what_is_set_again_unchanged_costs_no_restart_but_a_change_is_seen(started):
    unit = started("trouble", 2, "me")
    for index, value in enumerate((1.0, 1.0, -3.0)):
        unit.set("u", np.array(value))
        unit.do_step(index * SIZE, SIZE)
    assert abs(unit.get("integral") + 1.0) < 1e-7  # 1 + 1 - 3; rtol 1e-8


def sloppy_copy(source, target, old, new):
    """An FMU with another description."""
    with zipfile.ZipFile(source) as given, zipfile.ZipFile(target, "w") as archive:
        for name in given.namelist():
            data = given.read(name)
            archive.writestr(name, data.replace(old, new) if name == "modelDescription.xml" else data)
    return target


def test_an_fmu_that_allows_one_instance_per_process_gets_one(built, tmp_path):
    old = b'canGetAndSetFMUState="true"'
    path = sloppy_copy(
        built["trouble", 3], tmp_path / "alone.fmu", old, old + b' canBeInstantiatedOnlyOncePerProcess="true"'
    )
    first = CoSimulationUnit("first", open_fmu(path), FmuSettings())
    with pytest.raises(InputError, match=r"first uses it already\n.*give second `isolation: process`"):
        CoSimulationUnit("second", open_fmu(path), FmuSettings())
    first.terminate()
    CoSimulationUnit("third", open_fmu(path), FmuSettings()).terminate()


def test_a_macro_step_must_be_a_multiple_of_a_fixed_internal_step(built, tmp_path):
    old = b'canHandleVariableCommunicationStepSize="true"'
    path = sloppy_copy(built["trouble", 3], tmp_path / "fixed.fmu", old, b'fixedInternalStepSize="0.25"')
    unit = CoSimulationUnit("unit", open_fmu(path), FmuSettings())
    unit.check_step(SIZE // 2)
    with pytest.raises(InputError, match=r"macro-step of 0\.3 s is no multiple"):
        unit.check_step(3 * SIZE // 10)
    unit.terminate()
