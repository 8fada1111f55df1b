"""Two programs that share no code: the truth of an ideal rig is the co-simulation of its scenario."""

import math
from pathlib import Path

import numpy as np
import pytest
import yaml

from cosim.run import run
from cosim.scenario import load_scenario, parse_scenario
from diagnosis.recording.conditions import scenario_of
from diagnosis.recording.recording import load_recording
from evaluation.proving.case import Case
from evaluation.proving.pendulum.arm import EFFECTS, Arm, middle
from evaluation.proving.pendulum.case import behind_play
from evaluation.proving.pendulum.engines import own
from evaluation.proving.rig import ideal_rig
from evaluation.proving.sensors import drawn_sensors
from evaluation.proving.setups import SETUPS

SCENARIOS = Path(__file__).resolve().parents[2] / "evaluation" / "proving" / "scenarios"


@pytest.fixture(autouse=True)
def _fmus_of_these_sources(shipped_fmus, monkeypatch):
    monkeypatch.setenv("COSIM_FMU_PATH", str(shipped_fmus))


def co_simulated(folder):
    recording = load_recording(folder / "held_out_1")
    return run(scenario_of(load_scenario(folder / "scenario.yaml"), recording))


def perfect_chain(setup):
    chain = {}
    for name, kind in setup.sensors.items():
        sensors = drawn_sensors(kind, setup.sheet, np.random.default_rng(1))
        for array in (sensors.lag, sensors.gain, sensors.bias, sensors.delay):
            array[:] = 0.0
        sensors.jitter = 0.0
        chain[name] = sensors
    return chain


@pytest.mark.parametrize("name", SETUPS)
def test_an_ideal_rig_is_its_scenario(name, tmp_path):
    setup = SETUPS[name]
    rng = np.random.default_rng(3)
    programmes = [shape(rng, setup.top, setup.stop) for shape in list(setup.shapes.values())[:2]]
    # One piece of wire: no conduction, no ends.
    case = Case(
        name,
        "null",
        setup,
        ideal_rig(setup.sheet),
        [],
        [],
        {},
        programmes[:1],
        programmes[1:],
        (),
        perfect_chain(setup),
    )
    case.write(tmp_path / "cases", tmp_path / "answers", rng)
    found = co_simulated(tmp_path / "cases" / name)
    clean = np.load(tmp_path / "answers" / f"{name}.npz")
    thermal = "block" if name == "heaters" else "actuator"
    variables = {"temperature": f"{thermal}.temperature", "extension": "load.extension"}
    # The co-simulation holds its inputs over macro-steps of 50 ms (heaters: 500 ms), the truth takes steps of 0.2 s
    # (0.5 s) of second order and reads straight lines between them: at 11 K/s, bends of 5 K/s^2 give 25 mK.
    tolerances = {"temperature": 0.04, "extension": 3e-5}
    for quantity in set(variables) & set(setup.sensors):
        stamps, values = (clean[f"held_out_1/{quantity}/{n}"] for n in ("stamps", "clean"))
        inner = (stamps > 0.5) & (stamps < setup.stop - 0.5)
        series = found[variables[quantity]]
        other = np.stack([np.interp(stamps, found["time"], c) for c in series.values.T], axis=1)
        assert np.abs(values - other)[inner].max() < tolerances[quantity], quantity
        assert np.ptp(values) > 50 * tolerances[quantity]


@pytest.mark.parametrize(
    "effect", [None, *(e for e in EFFECTS if e.is_named)], ids=lambda e: "none" if e is None else e.identifier
)
def test_an_arm_is_its_scenario_with_the_effect_switched_on(effect):
    parameters = {} if effect is None else middle(effect)
    distance, mass = 0.115, 0.1
    arm = Arm(4408e-7 + mass * distance**2, mass * 9.80665 * distance, distance, parameters)
    angle = behind_play(own(arm, math.pi - 1.2, 0.5, 12.0, 0.01), arm.of("backlash"))
    scenario = load_scenario(SCENARIOS / "pendulum.yaml")
    listed = {"initial_angle": math.pi - 1.2, "initial_angular_velocity": 0.5} | parameters
    units = {
        "initial_angle": "rad",
        "tilt": "rad",
        "backlash": "rad",
        "initial_angular_velocity": "rad/s",
        "stribeck_speed": "rad/s",
        "viscous_damping": "N*m*s",
        "coulomb_friction": "N*m",
        "stiction": "N*m",
        "quadratic_drag": "N*m*s^2",
    }
    data = yaml.safe_load((SCENARIOS / "pendulum.yaml").read_text())
    data["components"]["arm"]["parameters"] |= {n: f"{v!r} {units[n]}" for n, v in listed.items()}
    found = run(parse_scenario(yaml.safe_dump(data), scenario.path))
    # Steps of 0.5 ms against 0.25 ms, both of second order; dry friction within a step is first order: less than a step
    # of the encoder. Stiction falls with the speed, and the unit takes it at the speed of the step before: 3 mrad.
    tolerance = 4e-3 if effect is not None and effect.identifier == "stiction" else 1e-3
    assert np.abs(found["arm.angle"].values - angle).max() < tolerance
