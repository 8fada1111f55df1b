"""The pendulum's three engines against closed forms and each other."""

import json
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import ellipk

from cosim.scenario import load_scenario
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import load_recording
from evaluation.proving.effects.effect import STRENGTHS
from evaluation.proving.pendulum.arm import EFFECTS, GRAVITY, Arm, middle
from evaluation.proving.pendulum.case import behind_play, drawn_pendulum
from evaluation.proving.pendulum.engines import ENGINES

MOMENT, DISTANCE = 0.1 * GRAVITY * 0.115, 0.115
INERTIA = 4408e-7 + 0.1 * DISTANCE**2


def swing(engine, effects=None, angle=math.pi - 1.2, speed=0.0, stop=8.0):
    return ENGINES[engine](Arm(INERTIA, MOMENT, DISTANCE, effects or {}), angle, speed, stop, 0.01)


def peaks(angle):
    """Largest distances from pi, refined by parabolas through three samples."""
    away = np.abs(angle - math.pi)
    found = []
    for n in range(1, away.size - 1):
        if away[n] >= away[n - 1] and away[n] > away[n + 1]:
            low, mid, high = away[n - 1 : n + 2]
            found.append(mid + (high - low) ** 2 / (8.0 * (2.0 * mid - low - high)))
    return np.array(found)


@pytest.mark.parametrize("engine", ENGINES)
def test_period_of_a_wide_swing_is_the_elliptic_integral(engine):
    angle = swing(engine)
    crossings = np.flatnonzero(np.diff(np.sign(angle - math.pi)))
    share = (angle[crossings] - math.pi) / (angle[crossings] - angle[crossings + 1])
    times = 0.01 * (crossings + share)
    period = 4.0 * math.sqrt(INERTIA / MOMENT) * ellipk(math.sin(0.6) ** 2)
    # Straight lines between samples at the steepest point: no first order error; second order steps of 0.25 ms.
    assert np.diff(times).mean() * 2.0 == pytest.approx(period, rel=2e-4)


@pytest.mark.parametrize("engine", ENGINES)
def test_viscous_damping_shrinks_small_swings_exponentially(engine):
    angle = swing(engine, {"viscous_damping": 3e-4}, angle=math.pi - 0.05)
    found = peaks(angle)
    half = math.pi / math.sqrt(MOMENT / INERTIA - (3e-4 / (2 * INERTIA)) ** 2)
    assert found[1:] / found[:-1] == pytest.approx(
        np.full(found.size - 1, math.exp(-3e-4 / (2 * INERTIA) * half)), rel=2e-3
    )


@pytest.mark.parametrize("engine", ENGINES)
def test_dry_friction_takes_the_same_angle_from_every_small_swing(engine):
    friction = 4e-4
    found = peaks(swing(engine, {"coulomb_friction": friction}, angle=math.pi - 0.1))
    lost = -np.diff(found)[found[1:] > 2.5 * friction / MOMENT]
    # 2 F / W for a harmonic swing; the sine takes 0.1^2 / 6 of it, MuJoCo's friction gives way a little.
    assert lost == pytest.approx(np.full(lost.size, 2.0 * friction / MOMENT), rel=0.03)


@pytest.mark.parametrize("engine", ENGINES)
def test_the_arm_sticks_where_the_weight_is_less_than_friction(engine):
    angle = swing(engine, {"coulomb_friction": 5e-3}, angle=math.pi - 0.3, stop=6.0)
    assert abs(angle[-1] - math.pi) < 5e-3 / MOMENT
    # MuJoCo holds by a stiff law of its solver and creeps, by 2 % of a step of the encoder in a second.
    assert abs(angle[-1] - angle[-100]) < 3e-5


@pytest.mark.parametrize("engine", ["bullet", "mujoco"])
@pytest.mark.parametrize(
    "effect", [e for e in EFFECTS if e.identifier not in ("stiction", "backlash")], ids=lambda e: e.identifier
)
def test_engines_agree_on_every_effect(effect, engine):
    parameters = middle(effect)
    difference = np.abs(swing(engine, parameters, stop=6.0) - swing("own", parameters, stop=6.0)).max()
    assert difference < 1e-3  # [rad], below the noise of the encoder
    assert np.abs(swing("own", parameters, stop=6.0) - swing("own", stop=6.0)).max() > 0.01


def test_every_strength_of_every_effect_is_drawn_and_written_for_the_diagnosis(tmp_path):
    for number, effect in enumerate(EFFECTS):
        kind = "single" if effect.is_named else "outside"
        wanted = [(effect, STRENGTHS[number % 3])]
        rng = np.random.default_rng(number)
        case = drawn_pendulum(f"case_{number}", kind, wanted, ["missing physics"], rng)
        case.write(tmp_path / "cases", tmp_path / "answers", rng)
        folder = tmp_path / "cases" / f"case_{number}"
        recording = load_recording(folder / "held_out_1")
        scenario = scenario_of(load_scenario(folder / "scenario.yaml"), recording)
        assert scenario.components["arm"].parameters["initial_angle"].to("rad") == pytest.approx(case.starts[-1][0])
        answer = json.loads((tmp_path / "answers" / f"case_{number}.json").read_text())
        assert answer["findings"][0]["effect"] == effect.identifier
        clean = np.load(tmp_path / "answers" / f"case_{number}.npz")["held_out_1/angle/clean"]
        read = recording.channels["arm.angle"].values
        # Noise and the steps of the encoder, sqrt(1201) readings.
        assert (read - clean).std() == pytest.approx(np.hypot(case.noise, 1.534e-3 / math.sqrt(12.0)), rel=0.1)


def test_backlash_holds_the_encoder_within_half_its_play():
    effect = next(e for e in EFFECTS if e.identifier == "backlash")
    rng = np.random.default_rng(1)
    case = drawn_pendulum("case", "single", [(effect, "strong")], ["missing physics"], rng)
    angle = swing("own")
    play = case.arm.of("backlash")
    away = np.abs(behind_play(angle, play) - angle)
    assert away.max() == pytest.approx(0.5 * play, rel=1e-9)
    assert 0.05 * (0.008 / 0.05) ** (1.0 / 3.0) <= play <= 0.05  # the last third of its range


@pytest.mark.parametrize("engine", ["own", "bullet"])
def test_stiction_agrees_with_a_stiff_integration(engine):
    arm = Arm(INERTIA, MOMENT, DISTANCE, {"stiction": 2.5e-3, "stribeck_speed": 0.4})

    def slopes(_, state):
        angle, speed = state
        return [speed, (arm.weight(angle) - arm.dry(speed) * math.tanh(speed / 1e-5)) / INERTIA]

    times = 0.01 * np.arange(601)
    exact = solve_ivp(slopes, (0.0, 6.01), [2.0, 0.5], method="Radau", rtol=1e-9, atol=1e-11, t_eval=times).y[0]
    # First order in a step of 0.25 ms: 0.13 mrad, a tenth of a step of the encoder.
    assert np.abs(swing(engine, dict(arm.effects), 2.0, 0.5, 6.0) - exact).max() < 3e-4
