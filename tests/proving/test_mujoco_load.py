"""Loads in MuJoCo against statics."""

import numpy as np
import pytest

from evaluation.proving.effects.effect import everywhere
from evaluation.proving.effects.mechanical import (
    SlideFriction,
    SupplyWireStiffness,
    ThermalContraction,
    Tilt,
    ViscousDamping,
)
from evaluation.proving.effects.thermal import Draught
from evaluation.proving.mujoco_load import SUPPORTED, hang
from evaluation.proving.rig import ideal_rig
from evaluation.proving.setups import SETUPS
from evaluation.proving.truth import Truth

SMALL = SETUPS["small"]
RIG = ideal_rig(SMALL.sheet)
ALL = everywhere(SMALL.sheet)


def hung(*effects):
    trace = Truth(RIG, effects, cells=4).run(SMALL.shapes["staircase"](np.random.default_rng(1), 3.0, 100.0), 0.1)
    return trace, hang(trace, RIG, effects)


@pytest.mark.parametrize(
    "effect",
    [
        None,
        SupplyWireStiffness(ALL, {"wire": 25.0, "reach": 0.0015}),
        Tilt(ALL, {"loss": 0.1}),
        ThermalContraction(ALL, {"contraction": 1.5e-5}),
    ],
    ids=lambda e: "none" if e is None else e.identifier,
)
def test_without_friction_the_load_follows_its_equilibrium(effect):
    trace, extension = hung(*([] if effect is None else [effect]))
    # It swings a little when the stiffness changes, by a quarter of the best camera's noise at most.
    assert np.abs(extension - trace.states["extension"]).max() < 2.5e-5


def test_friction_holds_within_its_band_and_reaches_both_sides():
    friction = 0.08
    trace, extension = hung(SlideFriction(ALL, {"friction": friction}))
    missing = RIG.weight - trace.states["stiffness"] * extension
    # Swings add their inertia to what friction holds: m (2 pi 6 Hz)^2 18 um is 3 % of it.
    assert np.abs(missing).max() == pytest.approx(friction, rel=0.05)
    assert missing.min() < -0.9 * friction
    assert missing.max() > 0.9 * friction


def test_damping_delays_by_damping_over_stiffness():
    damping = 600.0
    trace, extension = hung(ViscousDamping(ALL, {"damping": damping}))
    stiffness = trace.states["stiffness"]
    exact = np.empty_like(extension)
    exact[0] = RIG.weight / stiffness[0]
    for n, size in enumerate(np.diff(trace.time)):
        middle = 0.5 * (stiffness[n] + stiffness[n + 1])
        exact[n + 1] = RIG.weight / middle + (exact[n] - RIG.weight / middle) * np.exp(-middle * size / damping)
    # The spring's own damping of 0.4 N s/m delays by 0.07 % more.
    assert np.abs(extension - exact).max() < 1e-5


def test_effects_that_it_cannot_make_are_refused():
    trace, _ = hung()
    with pytest.raises(ValueError, match="know no draught"):
        hang(trace, RIG, [Draught(ALL, {"amount": 0.1, "instant": 1.0})])
    assert Draught not in SUPPORTED
