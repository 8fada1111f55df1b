"""Saved states: after a return to one, the future is the same to the last bit."""

import numpy as np
import pytest
from fmu_runs import MODELS, STEP, advance

from cosim.unit.protocol import UnitError

OUTPUTS = ("temperature", "stiffness", "rest_length", "resistance", "stored_energy", "convected_energy")
COUNT = 60

kinds = pytest.mark.parametrize(
    ("model", "version", "interface"),
    [
        (model, version, interface)
        for model in MODELS
        for version in (3, 2)
        for interface in ("co_simulation", "model_exchange")
    ],
)


def programme(seed):
    chance = np.random.default_rng(seed)
    return np.repeat(chance.uniform(0.0, 1.5, (6, 36)) * (chance.random((6, 36)) < 0.6), COUNT // 6, axis=0)


def run(unit, seed, begin=0):
    tensions = np.full((COUNT, 36), 3.0 + seed)
    return advance(unit, programme(seed), OUTPUTS, size=10 * STEP, begin=begin * 10 * STEP, tensions=tensions)


def started(make_unit, *kind, **given):
    unit = make_unit(*kind, **given)
    unit.initialise(0)
    unit.exit_initialisation()
    return unit


@kinds
def test_a_restored_state_has_the_same_future(make_unit, model, version, interface):
    unit = started(make_unit, model, version, interface)
    run(unit, 1)
    state = unit.save()
    first = run(unit, 2, begin=COUNT)
    for seed in (2, 2):
        unit.restore(state, COUNT * 10 * STEP)
        np.testing.assert_array_equal(run(unit, seed, begin=COUNT), first)
    unit.release(state)


@kinds
def test_a_fresh_unit_continues_from_a_checkpoint(make_unit, model, version, interface):
    unit = started(make_unit, model, version, interface)
    run(unit, 1)
    checkpoint = {name: array.copy() for name, array in unit.checkpoint().items()}
    expected = run(unit, 2, begin=COUNT)
    fresh = make_unit(model, version, interface)
    fresh.resume(checkpoint, COUNT * 10 * STEP)
    np.testing.assert_array_equal(run(fresh, 2, begin=COUNT), expected)


@kinds
def test_saving_a_state_does_not_change_the_run(make_unit, model, version, interface):
    quiet, watched = (started(make_unit, model, version, interface) for _ in range(2))
    expected = run(quiet, 3)
    record = []
    for index, value in enumerate(programme(3)):
        watched.binding.serialise()
        tension = np.full((1, 36), 6.0)
        record.append(
            advance(watched, value[None], OUTPUTS, size=10 * STEP, begin=index * 10 * STEP, tensions=tension)[0]
        )
    np.testing.assert_array_equal(np.array(record), expected)


def _parameter(unit, name):
    return next(v.start for v in unit.archive.description.modelVariables if v.name == name)


@kinds
def test_a_state_includes_the_parameters(make_unit, model, version, interface):
    given = {"coil_rest_length": 0.012, "reference_resistance": np.linspace(1.0, 3.0, 36)}
    unit = started(make_unit, model, version, interface, parameters=given)
    other = make_unit(model, version, interface)
    other.resume(unit.checkpoint(), 0)
    np.testing.assert_array_equal(other.get("resistance"), given["reference_resistance"])
    np.testing.assert_array_equal(other.get("rest_length"), unit.get("rest_length"))
    default = started(make_unit, model, version, interface)
    # Lengths add up in every model; the sum is right to rounding.
    change = 0.012 - float(_parameter(default, "coil_rest_length"))
    np.testing.assert_allclose(unit.get("rest_length") - default.get("rest_length"), change, rtol=1e-12)


@pytest.mark.parametrize("version", [3, 2])
def test_outputs_are_computed_anew_after_a_return(make_unit, version):
    """The state was saved after the input had changed, but before any output was read."""
    unit = started(make_unit, "instant_stiffness", version)
    unit.set("power", np.full(36, 0.4))
    state = unit.binding.save()
    unit.set("power", np.zeros(36))
    unit.do_step(0, STEP)
    assert unit.get("stiffness")[0] == 157.1
    unit.binding.restore(state)
    unit.buffers.read(0)
    np.testing.assert_array_equal(unit.get("stiffness"), 356.05951795685417)
    unit.binding.free_state(state)


def test_a_state_brings_its_number_of_coils_along(make_unit):
    small, large = started(make_unit, coils=6), started(make_unit, coils=36)
    data = small.binding.serialise()
    large.binding.deserialise(data)
    np.testing.assert_array_equal(large.binding.serialise(), data)


@pytest.mark.parametrize("version", [3, 2])
def test_a_refused_step_leaves_no_mark(make_unit, version):
    unit = started(make_unit, "thermal_stiffness", version)
    run(unit, 1)
    before = unit.binding.serialise()
    time = 10 * COUNT * STEP / 1e9
    for begin, size in [(time + 1.0, 0.1), (time, 0.0), (time, -0.1), (time, np.nan), (np.nan, 0.1), (time, np.inf)]:
        with pytest.raises(UnitError, match="DoStep returned error"):
            unit.binding.do_step(begin, size)
        np.testing.assert_array_equal(unit.binding.serialise(), before)


@pytest.mark.parametrize("version", [3, 2])
def test_bytes_that_are_no_state_are_refused(make_unit, version):
    unit = started(make_unit, "thermal_stiffness", version)
    data = unit.binding.serialise()
    damaged_size, damaged_coils = data.copy(), data.copy()
    damaged_size[8] ^= 1
    damaged_coils[16] ^= 64
    foreign = started(make_unit, "instant_stiffness", version).binding.serialise()
    exchange = started(make_unit, "thermal_stiffness", version, "model_exchange").binding.serialise()
    for bad, reason in [
        (data[:10], "no saved state"),
        (data[:-8], "damaged"),
        (damaged_size, "damaged"),
        (damaged_coils, "damaged"),
        (foreign, "another model"),
        (exchange, "other interface"),
    ]:
        with pytest.raises(UnitError, match=reason):
            unit.binding.deserialise(bad)
    np.testing.assert_array_equal(unit.binding.serialise(), data)
