"""Each unit driven alone: nothing where nothing is missing, and the right unit where something is."""

import numpy as np
import pytest
import sympy

from diagnosis.candidates.registry import catalogue
from diagnosis.locate.course import course
from diagnosis.locate.locate import locate
from diagnosis.locate.panel import panels
from diagnosis.locate.replay import thermal
from diagnosis.locate.response import heat_response
from diagnosis.locate.statistic import calm, propagated
from diagnosis.locate.terms import features
from tests.locate.rig import TITLES, at, fit_to, term, truth


def lit(located):
    return {line.unit for line in located.locations if not line.is_noise}


def line_of(located, unit):
    return next(line for line in located.locations if line.unit == unit)


@pytest.mark.parametrize("seed", [11, 12, 13])
def test_a_null_shows_nothing(seed):
    model, fit = fit_to(truth({}, seed), seed)
    located = locate(model, fit, TITLES)
    assert [line.unit for line in located.locations if line.is_noise]
    assert not lit(located)
    assert not located.waveforms
    assert not located.proposals
    # The limit of a hundred recordings lies between that of one window (2.6) and of all as independent (5.3).
    assert all(3.5 < line.limit < 6.0 for line in located.locations)


def test_a_thermal_effect_lights_the_thermal_unit_alone():
    model, fit = fit_to(truth({term("ambient_step", "string[2]"): (2.0, 25.0)}))
    located = locate(model, fit, TITLES)
    assert lit(located) == {"thermal"}
    found = line_of(located, "thermal")
    assert found.element in ("string[2]", "coil[2,1]", "coil[2,2]")
    assert abs(found.z) > 10.0
    assert found is located.locations[0]


def test_resistance_that_grows_with_temperature_lights_the_electrical_unit_alone():
    effect = {term("temperature_dependent_resistance", "string[1]"): (4e-3,)}
    model, fit = fit_to(truth(effect))
    located = locate(model, fit, TITLES)
    assert lit(located) == {"electrical"}
    assert line_of(located, "electrical").element == "string[1]"
    assert "recorded currents" in line_of(located, "thermal").equation


def test_a_stiffness_effect_lights_the_last_unit_alone():
    model, fit = fit_to(truth({term("incomplete_transformation", "coil[1,2]"): (0.3,)}))
    located = locate(model, fit, TITLES)
    assert lit(located) == {"stiffness or mechanical"}
    assert line_of(located, "stiffness or mechanical").element == "coil[1,2]"


def test_the_response_to_heat_is_that_of_the_network():
    model, fit = fit_to(truth({}))
    own = at(model, fit)
    run, values = model.runs[0], own.values(0)
    warm = model.network.simulate(
        values.with_term("ambient_step", step_size=np.eye(4)[2] * 5.0, instant=20.0),
        run.inputs,
        {"temperature": np.arange(0.5, 60.0, 0.5)},
    )["temperature"]
    cold = model.network.simulate(values, run.inputs, {"temperature": np.arange(0.5, 60.0, 0.5)})["temperature"]
    now = course(own, 0)
    conductance = now.loss[:, 2] * now.capacity[2]
    share = np.clip((now.time[1:] - 20.0) / now.size, 0.0, 1.0)
    expected = heat_response(now, 2, np.arange(0.5, 60.0, 0.5)) @ (5.0 * conductance * share)
    # Both are exact exponentials; the network's samples are joined linearly between steps: (0.2 s / 5 s)^2 / 8 of 5 K.
    assert np.abs(warm - cold)[:, 2] == pytest.approx(expected, abs=3e-3)
    assert np.abs(warm - cold)[-1, 2] == pytest.approx(5.0, abs=0.05)


def test_the_noise_of_recorded_currents_is_carried_into_the_temperatures():
    model, fit = fit_to(truth({}))
    own = at(model, fit)
    now = course(own, 0)
    replay = thermal(own, [course(own, n) for n in range(2)], [p for q in model.measured for p in panels(own, q)])[0]
    panel = replay.panels[0]
    predicted = propagated(panel)[60, 0] * panel.deviation[60, 0] ** 2
    # White noise of the current, sigma each 0.25 s, through 2 I R and a lag: (2 I R / hA sigma)^2 * 0.25 s / (2 tau).
    rate = float(now.loss[100, 0])
    gain = 2.0 * np.interp(30.0, now.middle, now.current[:, 0]) * now.resistance[0] / (rate * now.capacity[0])
    at_20 = 2.0 * np.interp(20.0, now.middle, now.current[:, 0]) * now.resistance[0] / (rate * now.capacity[0])
    steady = (at_20 * 3e-3) ** 2 * 0.25 * rate / 2.0
    assert propagated(panel)[39, 0] * panel.deviation[39, 0] ** 2 == pytest.approx(steady, rel=0.15)  # 3 lags old
    assert gain == pytest.approx(0.0, abs=1e-9)
    assert predicted < 0.3 * steady


def test_one_wild_reading_is_no_structure():
    values = np.zeros((50, 1))
    values[20] = 60.0
    values[30:40] = 7.0
    found = calm(values, np.ones((50, 1), dtype=bool))
    assert found[20, 0] == 3.0
    assert np.all(found[31:39, 0] == 7.0)


def test_the_terms_are_those_of_the_catalogue():
    model, fit = fit_to(truth({}))
    now = course(at(model, fit), 0)
    laws = {c.identifier: c.law for c in catalogue()}
    here = {
        "T": now.temperature,
        "T_ambient": now.ambient,
        "P": now.power,
        "dTdt": now.rate,
        "energy": now.energy,
        "extension": now.extension,
        "phase": now.phase,
        "I": now.current,
        "tension": now.load + 0 * now.power,
        "t": now.middle[:, None] + 0 * now.power,
    }
    compared = 0
    for feature in features(now, "heat"):
        if not feature.identifier or "delay" in feature.formula:
            continue
        assert feature.formula.replace("Abs", "abs") in laws[feature.identifier]
        names = sorted(here)
        value = sympy.lambdify(names, sympy.sympify(feature.formula, locals={n: sympy.Symbol(n) for n in names}))
        assert value(*(here[n] for n in names)) == pytest.approx(feature.values, rel=1e-12, abs=1e-12)
        compared += 1
    assert compared >= 20
