"""The unknown input at a located equation: its course with its band, and a law for it."""

from dataclasses import replace

import numpy as np
import pytest
import sympy

from diagnosis.locate.course import course
from diagnosis.locate.locate import locate
from tests.locate.rig import TITLES, at, fit_to, perfect_model, term, truth


def shares_inside(located, point, fit, unit, input_of, days=(0, 1)):
    """Share of the samples of each waveform of a unit in whose band the truth lies; on other days there is no input."""
    source = at(perfect_model(), fit)
    true = replace(source, fit=replace(source.fit, point=point))
    found = []
    for wave in located.waveforms:
        if wave.unit == unit:
            number = TITLES.index(wave.recording)
            value = input_of(course(true, number)) * (number in days)
            found.append(float(np.mean((value >= np.array(wave.lower)) & (value <= np.array(wave.upper)))))
    return found


CASES = {
    "heat that steps": (
        "ambient_step",
        "string[2]",
        (4.0, 25.0),
        "W",
        lambda c: np.where(c.middle > 25.0, 4.0 * c.loss[:, 2] * c.capacity[2], 0.0),
    ),
    "heat that grows": (
        "unnamed_heat_excess_times_time",
        "coil[1,2]",
        (0.03,),
        "W",
        lambda c: 0.03 * (c.temperature - c.ambient)[:, 1] / 30.0 * c.middle / 60.0,
    ),
    "voltage": (
        "unnamed_resistance_linear_time",
        "string[1]",
        (0.05,),
        "V",
        lambda c: -c.current[:, 0] * 0.05 * c.middle / 60.0 * c.resistance[:2].sum(),
    ),
    "force": (
        "unnamed_length_square_time",
        "coil[2,2]",
        (6e-4,),
        "N",
        lambda c: c.stiffness[:, 3] * 6e-4 * (c.middle / 60.0) ** 2,
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_the_true_input_lies_in_the_band(name):
    identifier, place, values, unit, input_of = CASES[name]
    point = truth({term(identifier, place): values})
    model, fit = fit_to(point)
    located = locate(model, fit, TITLES)
    days = (0,) if identifier == "ambient_step" else (0, 1)  # a room steps on one day
    inside = shares_inside(located, point, fit, unit, input_of, days)
    assert len(inside) == 2
    assert min(inside) >= 0.9
    strongest = max(np.abs(w.values).max() for w in located.waveforms if w.unit == unit)
    assert any(
        min(np.array(w.upper) - np.array(w.lower)) < strongest for w in located.waveforms
    )  # the band says something


def test_a_law_outside_the_catalogue_is_found_with_its_amplitude():
    model, fit = fit_to(truth({term("unnamed_heat_excess_times_time", "coil[1,2]"): (0.03,)}))
    located = locate(model, fit, TITLES)
    best = located.proposals[0]
    assert best.terms == ("unnamed_heat_excess_times_time",)
    assert best.place == "coil[1,2]"
    assert best.unit == "W"
    assert best.amplitudes[0] == pytest.approx(0.03, rel=0.2)  # z = 13: a deviation of some 8 %
    assert best.share > 0.6
    side, _, formula = best.formula.partition("=")
    assert side.strip() == "heat"
    names = {"T", "T_ambient", "t"}
    parsed = sympy.sympify(formula, locals={n: sympy.Symbol(n) for n in names})
    assert {s.name for s in parsed.free_symbols} == names


def test_what_a_resistance_depends_on_is_told():
    model, fit = fit_to(truth({term("unnamed_resistance_linear_time", "string[1]"): (0.05,)}))
    located = locate(model, fit, TITLES)
    electrical = next(line for line in located.locations if line.unit == "electrical")
    assert electrical.element == "string[1]"
    assert any("time" in d.variable and d.correlation > 0.5 for d in electrical.depends_on)
