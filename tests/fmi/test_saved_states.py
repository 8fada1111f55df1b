"""Contract of every unit that can restore: what comes after a restored state is the same to the last bit."""

from __future__ import annotations

import numpy as np
import pytest

from cosim.unit.protocol import NANOSECONDS, Causality, UnitError, VariableType
from tests.fmi.fmi_models import FMUS

KINDS = [
    (m, v, i)
    for m, v in FMUS
    for i in ("cs", "me")
    if (m, i) not in {("relay", "cs"), ("clocks", "me")}  # each has one interface
]
every_kind = pytest.mark.parametrize(("model", "version", "interface"), KINDS)
SIZE = NANOSECONDS // 7  # no multiple of any period: events fall inside the steps


def drive(unit, begin, count):
    """Steps with changing inputs; every value of every step."""
    record = []
    for index in range(begin, begin + count):
        for name, v in unit.variables.items():
            if v.causality is Causality.INPUT and v.type.is_float:
                unit.set(name, np.full(v.shape, 0.25 * (index % 5)))
            elif v.causality is Causality.INPUT and v.type in (VariableType.BOOLEAN, VariableType.CLOCK):
                unit.set(name, np.full(v.shape, index % 3 == 0))
            elif v.type is VariableType.STRING and v.causality is Causality.INPUT:
                unit.set(name, np.full(v.shape, f"step {index}", dtype=object))
        unit.do_step(index * SIZE, SIZE)
        record.append({n: unit.get(n).copy() for n in unit.variables})
    return record


def assert_same(first, second):
    for one, other in zip(first, second, strict=True):
        for name in one:
            np.testing.assert_array_equal(one[name], other[name], err_msg=name)


@every_kind
def test_a_restored_state_replays_exactly(started, model, version, interface):
    unit = started(model, version, interface)
    assert unit.can_restore
    drive(unit, 0, 5)
    saved = unit.save()
    first = drive(unit, 5, 6)
    for _ in range(2):
        unit.restore(saved, 5 * SIZE)
        assert_same(drive(unit, 5, 6), first)
    unit.release(saved)


@every_kind
def test_a_restored_state_brings_back_inputs_and_outputs(started, model, version, interface):
    unit = started(model, version, interface)
    drive(unit, 0, 3)
    before = {n: unit.get(n).copy() for n in unit.variables}
    saved = unit.save()
    drive(unit, 3, 4)
    unit.restore(saved, 3 * SIZE)
    assert_same([{n: unit.get(n) for n in unit.variables}], [before])
    unit.release(saved)


@every_kind
def test_a_fresh_unit_continues_from_a_checkpoint(started, load, model, version, interface):
    unit = started(model, version, interface)
    drive(unit, 0, 5)
    checkpoint = {n: np.array(a) for n, a in unit.checkpoint().items()}
    assert all(a.dtype != object for a in checkpoint.values())  # a file of plain arrays holds it
    expected = drive(unit, 5, 6)
    fresh = load(model, version, interface)
    fresh.resume(checkpoint, 5 * SIZE)
    assert_same(drive(fresh, 5, 6), expected)


def test_an_fmu_without_saved_states_says_so(started):
    unit = started("trouble", 3)
    unit.can_restore = False
    with pytest.raises(UnitError, match="cannot return to a saved state"):
        unit.save()
    unit.can_restore = True
    unit.binding.capabilities.canSerializeFMUstate = False
    with pytest.raises(UnitError, match="can get and set its state but not serialise it"):
        unit.checkpoint()
