"""Programmes keep the limits of the rig, and the scenario that is written says what was designed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.scenario import load_scenario
from cosim.unit.errors import InputError
from diagnosis.experiment.drivers import Rig, drive, rig
from diagnosis.experiment.limits import parse_limits
from diagnosis.experiment.plan import courses
from diagnosis.experiment.programmes import Levels, again, shapes, stretched
from diagnosis.experiment.write import write_experiment
from diagnosis.judge.next_experiment import NextExperiment
from diagnosis.models.coil_network.translate import translate
from tests.experiment.rig import SCENARIO, scenario

#: A voltage per string, and a bath whose temperature cannot jump: 0.5 K/s at most.
BATH = (
    SCENARIO.replace(
        "      temperature: {unit: K, constant: 22 degC}",
        "      temperature: {unit: degC, interpolation: linear, points: [[0 s, 30 degC], [60 s, 60 degC]]}",
    )
    .replace(
        "{unit: V, points: [[0 s, 0 V], [3 s, 1.7 V], [30 s, 0 V]]}",
        "{unit: V, dim: string, points: [[0 s, [0 V, 0 V]], [3 s, [1.7 V, 1 V]]]}",
    )
    .replace("strings: [2], supply: common", "strings: [1, 1], supply: per_string")
)


def made_rig(folder: Path, text: str = SCENARIO, limits: dict[str, float] | None = None) -> Rig:
    one = scenario(folder, text)
    found = rig(one, [one], 60.0, limits or {})
    assert found is not None
    return found


def all_shapes(columns: int) -> list:  # type: ignore[type-arg]
    found = list(shapes(60.0, columns, Levels(0.4, 0.3, 0.8)))
    return [*found, *(stretched(s, 180.0) for s in found), again(found[0], 3)]


@pytest.mark.parametrize("text", [SCENARIO, BATH])
def test_every_programme_stays_within_the_limits_of_the_rig(text: str, tmp_path: Path) -> None:
    made = made_rig(tmp_path, text)
    for shape in all_shapes(made.columns):
        assert shape.duration <= 180.0
        for driver, course in zip(made.drivers, courses(made, shape)):
            values, times = np.array(course.values), np.array(course.times)
            assert values.min() >= driver.lowest
            assert values.max() <= driver.highest
            # On the grid of macro-steps, or the scenario check would refuse it: 1e-9 s is its own tolerance.
            assert np.abs(times / 0.05 - np.round(times / 0.05)).max() < 1e-6
            assert (np.diff(times) > 0.0).all()
            if np.isfinite(driver.slew):
                assert driver.slew == pytest.approx(0.5)
                change = np.abs(np.diff(values, axis=0)).max(axis=1) / np.diff(times)
                # Corners are rounded to macro-steps of 0.05 s, values to 0.01 K: a ramp may be steeper by that.
                assert (change <= 0.5 + (0.025 + 0.05) / np.diff(times)).all()


def test_a_room_that_is_given_as_constant_is_not_driven_but_a_bath_is(tmp_path: Path) -> None:
    assert [d.name for d in made_rig(tmp_path).drivers] == ["supply.voltage"]
    assert [d.name for d in made_rig(tmp_path, BATH).drivers] == ["supply.voltage", "room.temperature"]


def test_a_limit_replaces_the_greatest_value_that_was_ever_given(tmp_path: Path) -> None:
    limits = parse_limits(["supply.voltage = 2500 mV"], scenario(tmp_path))
    assert limits == {"supply.voltage": 2.5}
    assert made_rig(tmp_path).drivers[0].highest == 1.7
    assert made_rig(tmp_path, limits=limits).drivers[0].highest == 2.5


@pytest.mark.parametrize(
    ("text", "key", "problem"),
    [
        ("supply.voltage", "supply.voltage", "this is no limit"),
        ("supply.current=2 A", "supply.current", "no programme with this output"),
        ("supply.voltage=2 A", "supply.voltage", "no quantity in V"),
    ],
)
def test_a_limit_that_makes_no_sense_is_refused(text: str, key: str, problem: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=problem) as caught:
        parse_limits([text], scenario(tmp_path))
    assert caught.value.source == "--limit"
    assert caught.value.key == key


@pytest.mark.parametrize("text", [SCENARIO, BATH])
def test_the_scenario_that_is_written_drives_the_rig_as_designed(text: str, tmp_path: Path) -> None:
    made = made_rig(tmp_path, text)
    like = translate(scenario(tmp_path, text))
    for number, shape in enumerate(all_shapes(made.columns)):
        planned = courses(made, shape)
        experiment = NextExperiment(None, shape.kind, "", (), planned, shape.duration, (), 0, 0, 0, 0, mass=0.05)
        written = write_experiment(scenario(tmp_path, text), experiment, tmp_path / str(number))
        assert written.scenario is not None
        there = load_scenario(written.scenario)
        assert there.time.stop.to("s") == pytest.approx(shape.duration)
        told, meant = translate(there), drive(made, planned, like)
        assert told.parameters.base["load"] == pytest.approx(0.05 * 9.81)
        moments = np.linspace(0.0, shape.duration, 401)
        for one, other in ((told.drive.voltage, meant.voltage), (told.drive.ambient, meant.ambient)):
            assert one is not None
            assert other is not None
            # The same numbers go through text of twelve digits.
            np.testing.assert_allclose(
                one.over(moments[:-1], moments[1:]), other.over(moments[:-1], moments[1:]), rtol=1e-9
            )


def test_uneven_programmes_need_several_courses() -> None:
    kinds = {columns: {s.kind for s in shapes(60.0, columns, Levels())} for columns in (1, 2)}
    assert kinds[2] - kinds[1] == {"uneven strings"}
