"""Every effect leaves its mark, where and when it acts."""

import numpy as np
import pytest

from evaluation.proving.draw import drawn_effect, fits
from evaluation.proving.effects import electrical, mechanical, outside, stiffness, thermal
from evaluation.proving.effects.effect import Place, coil_place, string_place
from evaluation.proving.rig import ideal_rig
from evaluation.proving.sensors import KINDS
from evaluation.proving.setups import EFFECTS, SETUPS
from evaluation.proving.truth import Truth

SMALL, ZONES = SETUPS["small"], SETUPS["zones"]
RIG = ideal_rig(SMALL.sheet)
SHAPE_OF = {"minor_loop_memory": "partial", "fatigue": "pulses", "fatigue_shift": "pulses"}


def truth(effects=(), shape="staircase"):
    programme = SMALL.shapes[shape](np.random.default_rng(8), SMALL.top, SMALL.stop)
    instants = tuple(e.parameters["instant"] for e in effects if "instant" in e.parameters)
    return Truth(RIG, effects, cells=6).run(programme, 0.2, instants)


@pytest.fixture(scope="module")
def plain():
    return {shape: truth(shape=shape) for shape in ("staircase", "pulses", "partial")}


def differences(trace, other):
    """Chi-square of the difference of every element: over the sensors' readings, at the middle of their noises."""
    found = {}
    for name, kind in KINDS.items():
        moments = np.arange(0.13, SMALL.stop, 1.0 / kind.rate)
        seen = []
        for one in (trace, other):
            times, course = one.signal(kind.quantity)
            seen.append(np.stack([np.interp(moments, times, c) for c in course.T]))
        found[name] = (((seen[0] - seen[1]) / np.mean(kind.noise)) ** 2).sum(axis=1)
    return found


@pytest.mark.parametrize("effect", [e for e in EFFECTS if fits(e, SMALL)], ids=lambda e: e.identifier)
def test_medium_strength_stands_out_of_the_noise(effect, plain):
    made = drawn_effect(effect, SMALL, RIG, "medium", np.random.default_rng(1))
    shape = SHAPE_OF.get(effect.identifier, "staircase")
    found = differences(truth([made], shape), plain[shape])
    # Chance reaches 15 in a search over dozens of effects; recalibration takes its part of what is left.
    assert sum(values.sum() for values in found.values()) > 75.0
    untouched = {"stiffness": ("temperature", "string"), "mechanical": ("temperature", "string")}
    for name in untouched.get(effect.unit, ()):
        assert found[name].max() < 1e-9
    if made.place.kind in ("coil", "string") and effect.unit in ("thermal", "stiffness", "mechanical"):
        outside_place = made.place.amount == 0.0
        assert found["temperature"][outside_place].max() < 1e-9
        assert found["extension"][outside_place].max() < 1e-9


def test_second_mass_ends_where_the_lumped_pair_does():
    place = Place("all", (), np.ones(6))
    trace = Truth(RIG, [thermal.LossySecondMass(place, {"g": 2e-3, "C2": 0.02, "loss": 1e-3})], cells=1).run(
        SMALL.shapes["soak"](np.random.default_rng(1), 3.0, 400.0), 0.2
    )
    plateau = trace.states["temperature"][np.searchsorted(trace.time, 0.62 * 400.0 - 1.0), 0]
    programme = SMALL.shapes["soak"](np.random.default_rng(1), 3.0, 400.0)
    current = programme.levels[2] / 6.6
    series = 2e-3 * 1e-3 / (2e-3 + 1e-3)  # the mass in series with its own loss
    rise = current**2 * 2.2 / (SMALL.sheet.conductance + series)
    assert plateau == pytest.approx(295.15 + rise, abs=1e-3)  # 100 time constants later


def test_latent_heat_is_taken_up_and_given_back_in_full():
    place = Place("all", (), np.ones(6))
    rig, latent = RIG, 0.45
    effect = thermal.LatentHeat(place, {"latent": latent})
    trace = Truth(rig, [effect], cells=1).run(SMALL.shapes["soak"](np.random.default_rng(1), 3.3, 100.0), 0.02)
    end = np.searchsorted(trace.time, 60.0)
    steps = np.diff(trace.time)[:end, None]
    put_in = (steps * trace.flows["power"].mean(axis=1)[:end]).sum(axis=0)
    rise = trace.states["mean_temperature"] - 295.15
    lost = rig.conductance * (steps * 0.5 * (rise[1 : end + 1] + rise[:end])).sum(axis=0)
    phase = (trace.states["stiffness"][end] - trace.states["stiffness"][0]) / 230.5
    taken = put_in - lost - rig.capacity * rise[end]
    assert phase.min() > 0.5
    assert taken == pytest.approx(latent * phase, rel=2e-3)  # second order in the step; kinks of the loop dominate


def test_open_coil_stops_its_string_from_its_instant_on(plain):
    effect = electrical.OpenCoil(coil_place(SMALL.sheet, 4), {"openness": 1.0, "instant": 30.0})
    trace, base = truth([effect]), plain["staircase"]
    times, current = trace.signal("string")
    assert np.abs(current[times > 30.0, 1]).max() < 1e-9
    assert np.interp(29.9, *[trace.time, trace.states["temperature"][:, 4]]) == pytest.approx(
        np.interp(29.9, base.time, base.states["temperature"][:, 4]), abs=1e-9
    )


def test_friction_stops_within_its_band():
    friction = 0.08
    effect = mechanical.SlideFriction(coil_place(SMALL.sheet, 0), {"friction": friction})
    states = truth([effect]).states
    missing = RIG.weight[0] - states["stiffness"][:, 0] * states["extension"][:, 0]
    assert np.abs(missing).max() == pytest.approx(friction, rel=1e-9)  # it slides both ways at some time
    assert missing.min() < 0.0 < missing.max()


def test_neighbours_exchange_heat_without_making_any():
    effect = drawn_effect(thermal.NeighbourHeat, ZONES, ideal_rig(ZONES.sheet), "strong", np.random.default_rng(1))
    now = type("Instant", (), {"temperature": 300.0 + np.array([0, 10, 5, 0, 30, -10, 0, 0, 0, 0, 0, 0.0])})
    heat, _ = effect.heat(now, now.temperature[:, None])
    assert heat.sum() == pytest.approx(0.0, abs=1e-15)
    g = effect.parameters["g"]
    around = 0.0 + (-10.0) + 10.0 + 0.0  # left, right, above, below; above 300 K
    assert heat[4, 0] == pytest.approx(g * (around - 4 * 30.0), rel=1e-12)


def test_wet_film_cools_until_it_is_gone():
    effect = outside.WetFilm(Place("all", (), np.ones(6)), {"film": 2e-6, "transfer": 5e-12})
    trace, base = truth([effect]), truth()
    rise = base.states["temperature"][:, 0] - trace.states["temperature"][:, 0]
    assert rise.max() > 2.0
    assert abs(rise[-1]) < 0.1  # dry and forgotten
    assert effect._film.max() < 1e-20  # [kg]


def test_incomplete_transformation_lowers_the_hot_stiffness_of_its_string():
    effect = stiffness.IncompleteTransformation(string_place(SMALL.sheet, 1), {"retained": 0.3})
    trace, base = truth([effect]), truth()
    rise, full = trace.states["stiffness"] - 157.1, base.states["stiffness"] - 157.1
    hot = full[:, 3] > 100.0
    # Means of compliances over the pieces of a wire, which are all equally warm here.
    assert rise[hot, 3] / full[hot, 3] == pytest.approx(np.full(hot.sum(), 0.7), rel=1e-9)
    assert rise[hot, 0] == pytest.approx(full[hot, 0], rel=1e-12)


def test_neighbours_of_zones_at_different_levels_warm_each_other():
    effect = drawn_effect(thermal.NeighbourHeat, ZONES, ideal_rig(ZONES.sheet), "medium", np.random.default_rng(1))
    programme = ZONES.shapes["soak"](np.random.default_rng(8), ZONES.top, ZONES.stop)
    plain, mixed = (Truth(ideal_rig(ZONES.sheet), e, cells=4).run(programme, 0.2) for e in ([], [effect]))
    assert np.abs(mixed.states["temperature"] - plain.states["temperature"]).max() > 1.0  # [K], noise at most 0.4 K
