"""Sizes that are believed and sizes that are tried: one rule, no candidate's answer among its starts."""

import math

import numpy as np
import pytest

from diagnosis.candidates.candidate import NEEDS, Parameter
from diagnosis.candidates.registry import candidate, catalogue
from diagnosis.candidates.sizes import SCALES, ladder
from diagnosis.models.coil_network.kernel.layout import COIL_FIELDS, CoilNetworkLayout
from diagnosis.models.coil_network.kernel.places import places
from diagnosis.models.coil_network.rig_scales import rig_scales

FITTED = [(t, p) for t in catalogue() for p in t.parameters if not (p.is_fixed or p.is_instant)]
#: Their values to start from are physics of their own, which their files state.
EXCEPTIONS = {("loose_contact", "R_contact"), ("open_coil", "openness"), ("shorted_coil", "bridged")}
HEATERS, ONE = CoilNetworkLayout(2, ()), CoilNetworkLayout(1, ())


def test_every_parameter_states_a_size_that_is_believed_within_its_bounds():
    assert len(FITTED) > 600
    for term, p in FITTED:
        assert 0.0 < p.limit() <= max(abs(p.lower), abs(p.upper)), f"{term.identifier}.{p.name}"
        assert len(p.plausible_reason) > 10, f"{term.identifier}.{p.name}"


def test_starts_follow_from_the_limit_by_the_rule_alone():
    """Written again here: middles of parts that are equal by ratio, from 1 % of the limit or what is no finding."""
    for term, p in FITTED:
        name = f"{term.identifier}.{p.name}"
        if (term.identifier, p.name) in EXCEPTIONS:
            assert len(p.starts_reason) > 20, name
            continue
        assert not p.starts_reason, name
        assert p.starts == _by_the_rule(p), name


def _by_the_rule(p):
    most = p.limit()
    if p.is_switch:
        return (p.upper,)
    if p.is_position:
        reach = most - abs(p.origin)
        count = p.count or 3
        middles = [p.origin + reach * (n + 0.5) / count for n in range(count)]
        wanted = [0.0, 0.5 * reach, -0.5 * reach] if p.lower < 0.0 else middles
        return pytest.approx(wanted, rel=6e-3)
    least = max(p.negligible or 0.01 * most, p.lower)
    is_signed = p.lower < 0.0 and p.is_amplitude
    count = p.count or (2 if is_signed else 3)
    steps = [least * (most / least) ** ((n + 0.5) / count) for n in range(count)]
    both = [sign * s for s in steps for sign in (1.0, -1.0)] if is_signed else steps
    return pytest.approx([v for v in both if p.lower <= v <= p.upper], rel=6e-3)


def test_the_answer_of_the_paper_is_no_start():
    """Cooling at 0.14 1/s, heating at 0.2226 1/s: the share of the paper's own data was a start once."""
    answer = 1.0 - 0.14 / 0.2226
    starts = candidate("insulation_when_off").amplitude.starts
    assert min(abs(s / answer - 1.0) for s in starts) > 0.1


def test_limits_that_were_passed_as_names_lie_inside_the_bounds():
    for name in ("insulation_when_off", "chassis_insulation", "temperature_dependent_convection", "backlash"):
        amplitude = candidate(name).amplitude
        assert amplitude.limit() < 0.9 * amplitude.upper, name
    assert candidate("ambient_step").amplitude.limit() == 5.0


def test_a_ladder_leaves_no_size_farther_from_a_start_than_another():
    found = np.array(ladder(0.02, 0.8, 3))
    half = (0.8 / 0.02) ** (1 / 6)
    assert found[1:] / found[:-1] == pytest.approx(half**2, rel=0.01)
    assert (found[0] / 0.02, 0.8 / found[-1]) == pytest.approx((half, half), rel=0.01)


def test_the_scales_of_the_catalogue_are_those_of_the_paper_s_coil():
    found = rig_scales({"load": 0.1 * 9.80665})
    assert set(found) == set(SCALES)
    assert found == pytest.approx({name: value for name, (value, _) in SCALES.items()})
    assert SCALES["conductance"][0] == COIL_FIELDS["conductance"][0]


def test_limits_and_starts_scale_with_the_rig():
    mass = next(p for p in candidate("second_mass").parameters if p.name == "C2")
    scales = rig_scales({"capacity": np.array([0.3, 0.4, 0.5]), "conductance": 0.08})
    assert mass.limit(scales) == pytest.approx(12.0)
    assert np.array(mass.tried(scales)) / np.array(mass.starts) == pytest.approx(0.4 / SCALES["capacity"][0], rel=0.01)
    without_load = candidate("slide_friction").amplitude  # no load is stated: that of the paper's coil
    assert without_load.limit(rig_scales({})) == pytest.approx(0.5 * 0.1 * 9.80665)


def test_a_large_rig_does_not_leave_the_bounds():
    capacity = next(p for p in candidate("second_mass").parameters if p.name == "C2")
    scales = rig_scales({"capacity": 50.0})
    assert capacity.limit(scales) == capacity.upper
    assert all(capacity.lower <= v <= capacity.upper for v in capacity.tried(scales))


def test_a_parameter_without_a_believable_size_is_refused():
    with pytest.raises(ValueError, match="how large it can be on a real rig"):
        Parameter("a", "W", 0.0, 1.0, "", (0.5,))
    with pytest.raises(ValueError, match="no scale weight"):
        Parameter("a", "W", 0.0, 1.0, "", plausible=1.0, plausible_reason="it is", of="weight")
    assert Parameter("a", "W", 0.0, 1.0, "", plausible=1.0, plausible_reason="it is").starts == (0.0215, 0.1, 0.464)
    assert math.isinf(Parameter("instant", "s", 0.0, 1.0, "", (0.5,)).limit())


@pytest.mark.parametrize(
    ("name", "fewest"),
    [
        ("shared_supply_droop", 2),
        ("neighbour_heat", 2),
        ("unnamed_heat_neighbour", 2),
        ("shared_mass", 2),
        ("uneven_cooling", 3),
    ],
)
def test_a_law_between_elements_has_no_place_where_there_are_too_few(name, fewest):
    term = candidate(name)
    assert term.fewest == fewest
    assert places(term, CoilNetworkLayout(fewest - 1, ())) == []
    assert places(term, CoilNetworkLayout(fewest, ()))


def test_one_heater_has_no_shared_supply_and_two_are_no_gradient():
    assert places(candidate("shared_supply_droop"), ONE) == []
    assert {p.label for p in places(candidate("unnamed_heat_linear_time"), HEATERS)} == {
        "all coils",
        "coil[1]",
        "coil[2]",
    }


def test_every_law_of_a_unit_needs_a_quantity_that_tells_it():
    assert all(t.needs == NEEDS[t.unit] for t in catalogue())
    assert NEEDS["measurement"] == ()
