"""A parameter that a term changes by a constant share is that parameter with another value, in FMI 2.0 and 3.0."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from cosim.fmu.archive import open_fmu
from cosim.fmu.model_exchange import ModelExchangeUnit
from cosim.fmu.settings import AddedTerm, FmuSettings
from cosim.fmu_build.at_first_use import shipped_fmu
from cosim.unit.errors import InputError
from cosim.unit.protocol import NANOSECONDS, AnyArray, UnitError
from cosim.unit.quantity import PhysicalValue

COUNT, CAPACITY = "muscles", "muscle_heat_capacity"
STEP = NANOSECONDS // 10


def _share(of: str, formula: str = "s") -> AddedTerm:
    return AddedTerm(f"parameter({of})", formula, {"s": PhysicalValue(0.4, "1")}, is_share=True)


class _Maker:
    """Makes started units of an FMU, and frees them."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.units: list[ModelExchangeUnit] = []

    def __call__(self, **settings: object) -> ModelExchangeUnit:
        unit = ModelExchangeUnit("muscle", open_fmu(self.path), FmuSettings(**settings))  # type: ignore[arg-type]
        self.units.append(unit)
        unit.set("power", np.full(36, 0.5))
        unit.initialise(0)
        unit.exit_initialisation()
        return unit


@pytest.fixture(params=[2, 3])
def muscle(request: pytest.FixtureRequest) -> Iterator[_Maker]:
    """Of the shipped muscle."""
    path = shipped_fmu("tcp_muscle", request.param, 36)
    assert path is not None
    make = _Maker(path)
    yield make
    for unit in make.units:
        unit.terminate()


def _course(unit: ModelExchangeUnit, begin: int = 0, end: int = 60) -> AnyArray:
    """Temperature of the first bundle and heat given away, with a power that falls after 3 s, shape (steps, 2)."""
    found = []
    for n in range(begin, end):
        unit.set("power", np.full(36, 0.5 if n < 30 else 0.1))
        unit.do_step(n * STEP, STEP)
        found.append([float(np.ravel(unit.get(name))[0]) for name in ("temperature", "convected_energy")])
    return np.array(found)


@pytest.mark.parametrize("parameter", [COUNT, CAPACITY])
def test_a_constant_share_is_another_value(muscle: _Maker, parameter: str) -> None:
    plain = muscle()
    value = float(plain.table.value_of(parameter))
    other = _course(muscle(parameters={parameter: 1.4 * value}))
    found = _course(muscle(added_terms=(_share(parameter),)))
    np.testing.assert_allclose(found, other, rtol=1e-6)
    assert float(np.max(np.abs(_course(plain) - other))) > 0.05


def test_two_parameters_change_together_to_first_order(muscle: _Maker) -> None:
    """Each is exact; of a product of both changes, 16 % of the flow at most, their sum has nothing."""
    plain = muscle()
    numbers = {n: 1.1 * float(plain.table.value_of(n)) for n in (COUNT, CAPACITY)}
    other = _course(muscle(parameters=numbers))
    found = _course(muscle(added_terms=(_share(COUNT, "s/4"), _share(CAPACITY, "s/4"))))
    rise = other[:, 0] - other[0, 0]
    assert float(np.max(np.abs(found[:, 0] - other[:, 0]))) < 0.02 * float(np.max(rise))


def test_a_step_that_is_repeated_is_the_same(muscle: _Maker) -> None:
    unit = muscle(added_terms=(_share(CAPACITY),))
    _course(unit, 0, 25)
    saved = unit.save()
    first = _course(unit, 25, 40)
    unit.restore(saved, 25 * STEP)
    np.testing.assert_array_equal(_course(unit, 25, 40), first)
    unit.release(saved)


def test_a_run_goes_on_from_a_checkpoint(muscle: _Maker) -> None:
    unit = muscle(added_terms=(_share(CAPACITY),))
    _course(unit, 0, 25)
    state = unit.checkpoint()
    first = _course(unit, 25, 40)
    again = ModelExchangeUnit("muscle", open_fmu(muscle.path), FmuSettings(added_terms=(_share(CAPACITY),)))
    muscle.units.append(again)
    again.resume(state, 25 * STEP)
    np.testing.assert_allclose(_course(again, 25, 40), first, rtol=1e-12)


def test_an_fmu_with_event_indicators_is_refused(load) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(InputError, match="no parameter of this FMU can change: it has event indicators"):
        load("ball", 3, "me", added_terms=(_share("restitution"),))


@pytest.mark.parametrize("version", [2, 3])
def test_an_fmu_with_a_time_event_stops(load, version: int) -> None:  # type: ignore[no-untyped-def]
    unit = load("stair", version, "me", added_terms=(_share("period"),))
    unit.initialise(0)
    with pytest.raises(UnitError, match=r"it has an event at 0\.\d+ s, and a term changes one of its parameters"):
        unit.exit_initialisation()


def test_an_fmu_with_a_discrete_input_is_refused(load) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(InputError, match=r"no parameter of this FMU can change"):
        load("relay", 3, "me", added_terms=(_share("lower"),))
