"""Laws that are composed at random: what they are made of, and how strong they are."""

import math
from copy import deepcopy
from dataclasses import replace

import numpy as np
import pytest

from evaluation.proving.case import Case, drawn_chain, run_truth, twin
from evaluation.proving.cases import drawn_cases
from evaluation.proving.composed import shapes
from evaluation.proving.composed.case import ComposedCase
from evaluation.proving.composed.effect import TARGETS, Composed, ComposedReading
from evaluation.proving.composed.law import Chain, Law, Scale, drawn_law
from evaluation.proving.composed.search import Wanted, amount_of, strength_of
from evaluation.proving.composed.strength import FINE, LEAST_IN_TRAINING, LEFT, Gauge, Left
from evaluation.proving.composed.torque import ComposedTorque, left
from evaluation.proving.effects.effect import everywhere
from evaluation.proving.effects.measurement import SensorFault
from evaluation.proving.pendulum.arm import Arm
from evaluation.proving.pendulum.engines import own
from evaluation.proving.rig import ROOM, drawn_rig
from evaluation.proving.setups import SETUPS

ONE = np.ones(1)


def run(stage, course, size):
    stage.reset(course[0])
    return np.array([stage.moved(v, size) for v in course[1:]]).ravel()


def test_memories_have_their_closed_forms():
    step = np.ones((401, 1))
    step[0] = 0.0
    times = 0.01 * np.arange(1, 401)
    assert run(shapes.Lag(0.5), step, 0.01) == pytest.approx(1.0 - np.exp(-times / 0.5), rel=1e-12)
    assert run(shapes.Change(0.5), step, 0.01) == pytest.approx(np.exp(-times / 0.5), rel=1e-12)
    # d(z) = (1 - z)**2 / tau: z = 1 - 1 / (1 + t / tau).
    assert run(shapes.Relaxation(0.5), step, 0.01) == pytest.approx(1.0 - 1.0 / (1.0 + times / 0.5), rel=1e-12)
    assert run(shapes.Accumulation(2.0), step, 0.01) == pytest.approx(times / 2.0, rel=1e-12)
    ramp = times[:, None].repeat(1, axis=1)
    late = run(shapes.DeadTime(0.255), np.concatenate([[[0.0]], ramp]), 0.01)
    assert late == pytest.approx(np.maximum(times - 0.255, 0.0), abs=1e-12)
    # An oscillator without damping swings about 1; implicit midpoint, second order in the step.
    swing = run(shapes.Resonance(5.0, 0.0), step, 0.01)
    assert swing == pytest.approx(1.0 - np.cos(5.0 * times), abs=0.03)


def test_hysteresis_depends_on_the_way():
    up_and_down = np.array([0.0, 0.5, 1.0, 0.5, 0.0])[:, None]
    assert run(shapes.Relay(0.7, 0.3), up_and_down, 1.0).tolist() == [0.0, 1.0, 1.0, 0.0]
    assert run(shapes.Play(0.4), up_and_down, 1.0) == pytest.approx([0.3, 0.8, 0.7, 0.2])


def test_functions_at_known_points():
    half = np.array([0.5])
    assert shapes.Power(2.5).moved(-half, 0.0) == pytest.approx(-(0.5**2.5))
    assert shapes.Exponential(2.0).moved(ONE, 0.0) == pytest.approx(1.0)
    assert shapes.Saturation(0.5).moved(half, 0.0) == pytest.approx(math.tanh(1.0))
    assert shapes.Threshold(0.25).moved(half, 0.0) == pytest.approx(1.0 / 3.0)
    assert shapes.SmoothStep(0.5, 0.1).moved(half, 0.0) == pytest.approx(0.5)
    assert shapes.Bell(0.3, 0.2).moved(half, 0.0) == pytest.approx(math.exp(-1.0))


def test_the_same_seed_composes_the_same_law_and_no_two_are_alike():
    scales = {"warmth": Scale("T", ROOM, 50.0), "rate": Scale("d(T)", 0.0, 8.0, True), "time": Scale("t", 0.0, 100.0)}
    made = [drawn_law(scales, 100.0, np.random.default_rng(s)).formula() for s in (*range(60), *range(60))]
    assert made[:60] == made[60:]
    assert len(set(made)) == 60
    text = " ".join(made)
    for word in ("abs", "exp", "tanh", "max", "relay", "play", "delayed", "lag", "integral", "relaxed", "resonance"):
        assert word in text
    # Time alone would be the same course whatever is done to the rig.
    for seed in range(60):
        law = drawn_law(scales, 100.0, np.random.default_rng(seed))
        assert all({c.variable for c in chains} != {"time"} for _, chains in law.terms)


def test_a_formula_has_the_numbers_that_the_law_computes_with():
    chain = Chain("warmth", Scale("T", 300.0, 20.0), [shapes.Power(1.5), shapes.Saturation(0.5)])
    law = Law([(1.0, [chain])], 0.25)
    text = law.formula()
    value = law.reset({"warmth": np.array([310.0])})
    assert text == "0.25 * (1 * (tanh((sign(((T - 300) / 20)) * abs(((T - 300) / 20))**1.5) / 0.5)))"
    assert value == pytest.approx(0.25 * math.tanh(0.5**1.5 / 0.5), rel=1e-12)


@pytest.fixture(scope="module")
def bench():
    setup = replace(SETUPS["small"], stop=40.0)
    rng = np.random.default_rng(4)
    programmes = [setup.shapes[n](rng, setup.top, 40.0) for n in ("pulses", "soak", "pulses")]
    rig, chain = drawn_rig(setup.sheet, rng), drawn_chain(setup, rng)
    return setup, rig, chain, programmes, Gauge(setup, rig, chain, programmes)


def test_what_is_a_parameter_is_absorbed_and_what_is_none_stays(bench):
    setup, rig, _, _, gauge = bench
    scale = {"warmth": Scale("T", ROOM, 1.0)}
    linear = Law(
        [(1.0, [Chain("warmth", scale["warmth"], [shapes.Power(1.0)])])], -0.04 * float(rig.conductance.mean())
    )
    cubic = Law([(1.0, [Chain("warmth", Scale("T", ROOM, 50.0), [shapes.Power(3.0)])])], -0.06)
    place = everywhere(setup.sheet)
    none, like_loss, other = (
        gauge.left([Composed(place, "heat", law)], [amount])[0]
        for law, amount in ((linear, 0.0), (linear, 1.0), (cubic, 1.0))
    )
    assert (none.training, none.held_out) == (1.0, 1.0)
    # 4 % of h A are one prior deviation; the law is held over a step of 0.5 s.
    assert like_loss.held_out < 1.05
    assert other.held_out > 1.5


@pytest.mark.parametrize("target", ["heat", "series", "reading"])
def test_a_recalibration_leaves_2_to_20_per_sample_of_a_composed_law(bench, target):
    setup, rig, chain, programmes, _ = bench
    case = ComposedCase("case", setup, rig, deepcopy(chain), programmes, target).found(np.random.default_rng(5))
    (effect,) = [*case.effects, *case.faults]
    told = effect.parameters
    assert LEFT[0] <= told["left_held_out"] <= LEFT[1]
    assert told["left_training"] >= LEAST_IN_TRAINING
    again = Gauge(setup, rig, case.sensors, programmes)
    if isinstance(effect, SensorFault):
        assert isinstance(effect, ComposedReading)
        effect.spoil(case.sensors[effect.place.channels[0].rpartition(".")[2]])
        kind = next(k for k, s in case.sensors.items() if s.distortion is not None)
        assert again.left_of_reading(kind, case.sensors[kind].distortion).held_out == pytest.approx(
            told["left_held_out"]
        )
        return
    assert again.left([effect], [1.0], FINE)[0].held_out == pytest.approx(told["left_held_out"], rel=1e-9)
    # What the law does in training by itself, from the truth of the case: a fit can only take away from it.
    raw, count = 0.0, 0
    for number, programme in enumerate(programmes[:2], start=1):
        changed, plain = (run_truth(c, programme, number) for c in (case, twin(case)))
        for kind, sensors in case.sensors.items():
            moments = np.arange(0.5, 40.0, 2.0 / sensors.kind.rate)
            (knots, values), (own, others) = changed.signal(kind), plain.signal(kind)
            for one, other in zip(values.T, others.T):
                away = np.interp(moments, knots, one) - np.interp(moments, own, other)
                raw, count = raw + float(np.sum((away / sensors.noise) ** 2)), count + moments.size
    assert raw / count > told["left_training"] - 1.0


def test_the_least_amount_that_leaves_what_is_wanted_is_taken():
    found = [Left(1.0 + a**2, 1.0 + 4.0 * a**2) for a in (0.25, 0.5, 1.0, 2.0)]
    assert amount_of([0.25, 0.5, 1.0, 2.0], found, Wanted(5.0)) == pytest.approx(1.0)
    assert amount_of([0.25, 0.5], found[:2], Wanted(9.0)) is None
    hidden = [replace(one, training=1.0) for one in found]
    assert amount_of([0.25, 0.5, 1.0, 2.0], hidden, Wanted(5.0)) is None  # training shows nothing of it
    assert [strength_of(Left(2.0, x)) for x in (2.5, 6.0, 15.0)] == ["weak", "medium", "strong"]


def test_a_composed_torque_acts_in_the_engine_as_it_was_measured():
    arm = Arm(4408e-7 + 0.1 * 0.115**2, 0.1 * 9.80665 * 0.115, 0.115)
    law = Law([(1.0, [Chain("rate", Scale("w", 0.0, 10.0, True), [shapes.Power(1.0)])])], -3e-4)
    plain = own(arm, 2.0, 0.3, 2.0, 0.01)
    damped = own(replace(arm, extra=ComposedTorque(law, Left(1.0, 1.0)).fresh()), 2.0, 0.3, 2.0, 0.01)
    viscous = own(replace(arm, effects={"viscous_damping": 3e-5}), 2.0, 0.3, 2.0, 0.01)
    assert np.abs(damped - plain).max() > 0.01
    assert damped == pytest.approx(viscous, abs=2e-4)  # explicit here, implicit there
    starts = ((2.0, 0.3), (4.0, 0.0), (2.4, -0.5))
    nothing, some = left(arm, law, starts, (1e-3, 2.0, 0.01), [0.0, 1.0])
    assert nothing.held_out == pytest.approx(1.0, abs=1e-6)
    # Neither weight nor start makes a loss.
    assert some.held_out > 2.0
    assert some.training > 2.0


def test_composed_cases_come_on_all_rigs_and_for_all_equations():
    cases = [case for case, _ in drawn_cases(66, 3, ["composed"])]
    rigs = [c.setup.name if isinstance(c, ComposedCase) else "pendulum" for c in cases]
    assert set(rigs) == {*SETUPS, "pendulum"}
    assert min(rigs.count(r) for r in set(rigs)) >= 6
    assert {c.target for c in cases if isinstance(c, ComposedCase)} == {*TARGETS, "reading"}
    assert not any(isinstance(c, Case) for c in cases)
