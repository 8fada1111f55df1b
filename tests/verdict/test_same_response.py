"""Which coil of a string broke: the recorded channels say it or they do not; the class holds all that they leave."""

import functools
from dataclasses import replace

import numpy as np
import pytest

from diagnosis.candidates.registry import catalogue
from diagnosis.judge.diagnosis import Standing
from diagnosis.judge.same_response import same_response
from diagnosis.judge.standing import standing_of
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.recording.quantity import parse_quantity
from diagnosis.recording.recording import Channel
from diagnosis.search.problem import Point, strength_slopes
from tests.events import rig

LAWS = ("open_coil", "shorted_coil", "loose_contact", "unnamed_resistance_step", "contact_resistance")
BREAK = 12.0


@functools.cache
def model(*quantities: str) -> CoilNetworkModel:
    """Two strings of two coils with channels of these quantities; currents of the strings always."""
    given = rig.recorded(0)
    channels = {n: c for n, c in given.channels.items() if c.target.quantity in ("current", *quantities)}
    if "voltage" in quantities:
        times = channels["string[1].current"].times
        for coil in rig.COILS:
            name = f"coil[{coil}].voltage"
            channels[name] = Channel(
                name,
                parse_quantity(name),
                times,
                np.zeros(len(times)),
                1e-2,
                True,
                is_clipped=np.zeros(len(times), dtype=bool),
            )
    known = tuple(c for c in catalogue() if c.identifier in LAWS)
    return CoilNetworkModel(rig.scenario(), [replace(given, channels=channels)], known)


def members(made: CoilNetworkModel, effect: str, place: str, *values: float) -> set[tuple[str, str]]:
    term = next(t for t in made.terms() if (t.identifier, t.place) == (effect, place))
    point = Point(np.zeros(len(made.parameters))).plus(term, values)
    return {(m.effect, m.place) for m in same_response(made, point, term)}


def test_currents_do_not_say_which_coil_of_a_string_broke():
    found = members(model(), "open_coil", "coil[1,2]", 1.0, BREAK)
    assert ("open_coil", "coil[1,1]") in found
    assert ("loose_contact", "string[1]") in found
    assert not any("[2" in place for _, place in found)  # the current of the other string is there all the time


def test_temperatures_do_not_say_it_of_a_clean_break_either():
    """No current flows in any coil of the string: all of them stay cold."""
    found = members(model("temperature"), "open_coil", "coil[1,2]", 1.0, BREAK)
    assert {("open_coil", "coil[1,1]"), ("loose_contact", "string[1]")} <= found


def test_voltages_of_the_coils_say_which_one_broke():
    """The whole voltage of the supply lies at the coil that is open."""
    found = members(model("voltage"), "open_coil", "coil[1,2]", 1.0, BREAK)
    assert ("open_coil", "coil[1,1]") not in found
    assert ("loose_contact", "string[1]") not in found


def test_a_partial_break_is_a_step_of_the_resistance_by_another_name():
    """R / (1 - 0.5) = 2 R; the coil that takes more of the power is known by its temperature."""
    made = model("temperature")
    found = members(made, "unnamed_resistance_step", "coil[1,2]", 1.0, BREAK)
    assert ("open_coil", "coil[1,2]") in found
    assert ("open_coil", "coil[1,1]") not in found
    assert ("loose_contact", "string[1]") not in found
    # The name stands for the step as well: a generic law at the same place is no other explanation.
    assert ("unnamed_resistance_step", "coil[1,2]") not in members(made, "open_coil", "coil[1,2]", 0.5, BREAK)
    assert ("open_coil", "coil[1,1]") in members(model(), "open_coil", "coil[1,2]", 0.5, BREAK)


def test_what_does_not_show_has_no_class():
    assert members(model(), "open_coil", "coil[1,2]", 1e-6, BREAK) == set()


@pytest.mark.parametrize(("has_named_twin", "wanted"), [(True, Standing.CLASS), (False, Standing.UNNAMED)])
def test_a_law_without_a_name_is_of_a_class_with_a_law_that_has_one(has_named_twin, wanted):
    step = next(t for t in model().terms() if t.identifier == "unnamed_resistance_step")
    assert standing_of(step, (), ("open_coil",), True, has_named_twin) is wanted


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("runaway", [1e200, np.inf])
def test_a_law_whose_response_runs_away_is_no_member_and_warns_of_nothing(
    monkeypatch: pytest.MonkeyPatch, runaway: float
) -> None:
    def slopes(model, point, here, tasks):  # type: ignore[no-untyped-def]
        found = np.asarray(strength_slopes(model, point, here, tasks)).copy()
        found[0, ::2] = runaway
        return found

    expected = members(model(), "open_coil", "coil[1,2]", 1.0, BREAK)
    monkeypatch.setattr("diagnosis.judge.same_response.strength_slopes", slopes)
    assert members(model(), "open_coil", "coil[1,2]", 1.0, BREAK) <= expected
