"""Hysteresis: of friction before it slips, of any quantity, of a sensor; by closed forms and by what is found."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from cosim.scenario import load_scenario, parse_scenario
from cosim.unit.protocol import Array
from diagnosis.diagnose import Options, diagnose
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.laws.library import library
from diagnosis.models.sensor_chain import lagging, turned
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.places import Fit, fits, places_of
from diagnosis.models.systems.sensors import Reach, sensor_laws_of
from diagnosis.recording.recording import load_recording
from diagnosis.search.search import Settings
from tests.systems.rigs import COUNT, OSCILLATOR_SCENARIO, STEP, drive, held, oscillator, write_recording

FRICTION, SLIP = 12.0, 0.02
HALF_WIDTH, TRAVEL = 0.012, 0.03


def _stop(values: Array, travel: float) -> Array:
    """The stop operator as it is defined: what a follower that is dragged at both ends of its play is behind by."""
    follower, found = float(values[0]), []
    for value in values.tolist():
        follower = min(max(follower, value - travel), value + travel)
        found.append((value - follower) / travel)
    return np.array(found)


def _recordings(folder: Path, friction: float, half_width: float) -> list[Path]:
    """Three runs of an oscillator whose numbers are 1 to 2 % off, noise 1 mm; its friction is Dahl's."""
    found = []
    for number, size in enumerate((0.3, 0.4, 0.5)):
        u = drive(number, size)

        def rate(x: Array, volt: float) -> Array:
            force = 101.0 * volt - 396.0 * x[0] - 4.05 * x[1] - friction * x[2]
            return np.array([x[1], force, (x[1] - abs(x[1]) * x[2]) / SLIP])

        states = held(rate, np.zeros(3), u, STEP)
        noise = 1e-3 * np.random.default_rng(100 + number).standard_normal(COUNT)
        read = states[:, 0] - half_width * _stop(states[:, 0], TRAVEL)
        columns = {"t": STEP * np.arange(COUNT), "u": u, "x": read + noise}
        inputs, channels = {"drive.u": ("u", "V")}, {"rig.position": ("x", "m", "1 mm")}
        found.append(write_recording(folder / f"run_{number + 1}", columns, inputs, channels))
    return found


def _diagnosed(folder: Path, friction: float, half_width: float, integrator: str = "cvode") -> Diagnosis:
    scenario = load_scenario(str(oscillator(folder, integrator)))
    every = [load_recording(r) for r in _recordings(folder, friction, half_width)]
    return diagnose(scenario, every[:2], every[2:], Settings(), options=Options(is_brief=True)).diagnosis


def _fits(folder: Path, integrator: str) -> dict[tuple[str, str], Fit]:
    oscillator(folder)
    system = FastSystem(parse_scenario(OSCILLATOR_SCENARIO.replace("INTEGRATOR", integrator), folder / "scenario.yaml"))
    try:
        return {(f.term.identifier, f.placed.to): f for f in fits(places_of([system]), library(), STEP, STEP)}
    finally:
        system.close()


def test_friction_that_gives_way_before_it_slips_is_named(tmp_path: Path) -> None:
    found = _diagnosed(tmp_path, FRICTION, 0.0)
    assert found.verdict is Verdict.MISSING_PHYSICS
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert (finding.effect, finding.place) == ("presliding_friction", "rig.v")
    friction, slip = finding.parameters
    assert friction.lower < FRICTION < friction.upper
    assert friction.value == pytest.approx(FRICTION, rel=0.1)
    assert slip.value == pytest.approx(SLIP, rel=0.3)


def test_hysteresis_of_a_sensor_is_named(tmp_path: Path) -> None:
    found = _diagnosed(tmp_path, 0.0, HALF_WIDTH)
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert (finding.effect, finding.place) == ("sensor_hysteresis", "rig.position")
    assert found.verdict is Verdict.MEASUREMENT_FAULT
    half, travel = finding.parameters
    assert half.value == pytest.approx(HALF_WIDTH, rel=0.1)
    assert half.lower < HALF_WIDTH < half.upper
    assert travel.value == pytest.approx(TRAVEL, rel=0.2)


def test_of_an_fmu_that_hides_its_states_hysteresis_before_the_sensor_may_be_of_the_rig(tmp_path: Path) -> None:
    """The rigging of a brake rubs between its cylinder and its shoe, whose force is read: no sensor is at fault."""
    found = _diagnosed(tmp_path, 0.0, HALF_WIDTH, "internal")
    assert found.verdict is Verdict.CANNOT_TELL
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert (finding.effect, finding.is_of_either) == ("sensor_hysteresis", True)
    assert "is at fault" not in found.statement
    assert "The rig, a sensor or an input may do that" in " ".join([found.statement, *found.notes])


def test_laws_of_forms_that_rigs_have_are_of_a_sensor_where_it_reads_a_state() -> None:
    for is_state in (True, False):
        reach = {"rig.position": Reach("m", 0.1, -0.2, 0.2, 1e-3, 10.0, is_state)}
        either = {law.place.term.identifier for law in sensor_laws_of(reach, 0.02, 0.02) if law.is_of_either}
        assert either == (set() if is_state else {"sensor_hysteresis", "sensor_bend"})


def test_a_recording_without_hysteresis_has_none(tmp_path: Path) -> None:
    found = _diagnosed(tmp_path, 0.0, 0.0)
    assert not [f for f in found.findings if f.is_accepted]


def test_a_turn_takes_twice_the_travel() -> None:
    """Up by 5, back by 3: from one end, -1 is reached after 2 travels and holds."""
    values = np.concatenate([np.linspace(0.0, 5.0, 51), np.linspace(4.9, 2.0, 30)])
    found = turned(values, 0.5)
    np.testing.assert_allclose(found, _stop(values, 0.5), atol=1e-12)
    assert found[50] == 1.0
    assert found[55] == pytest.approx(0.0, abs=1e-12)  # half a travel back, from 1
    assert np.all(found[60:] == pytest.approx(-1.0))


def test_hysteresis_does_not_depend_on_how_fast_it_is_passed_through() -> None:
    slow = np.sin(np.linspace(0.0, 12.0, 4001))
    np.testing.assert_allclose(turned(slow[::10], 0.2)[-1], turned(slow, 0.2)[-1], atol=0.03)
    held_still = np.repeat(slow[::10], 3)
    np.testing.assert_allclose(turned(held_still, 0.2)[::3], turned(slow[::10], 0.2), atol=1e-12)


def test_friction_after_a_turn_is_that_of_the_closed_form(tmp_path: Path) -> None:
    """Dahl: after a turn out of full slip the friction is 1 - 2 exp(-way/slip); a short step alone hides his law."""
    law = _fits(tmp_path, "cvode")["presliding_friction", "der(v)"]
    (state,) = law.placed.states
    step = law.placed.constants["step"].number
    assert step == pytest.approx(STEP / 2)
    assert law.term.parameters[0].lower == 0.0  # it takes energy
    speed, bend, way = 1e-3, -1.0, 0.0
    names = {"v": speed, "slip": SLIP, "step": step}
    while way < SLIP:
        bend += 1e-3 * eval(state.rate, {"abs": abs, "sqrt": np.sqrt}, {**names, "bend": bend})
        way += 1e-3 * speed
    assert bend == pytest.approx(1.0 - 2.0 * np.exp(-1.0), abs=2e-3)


@pytest.mark.parametrize(
    ("integrator", "law", "to"),
    [
        ("cvode", "rate_hysteresis", "der(v)"),
        ("cvode", "coupling_hysteresis_of_x", "der(v)"),
        ("internal", "port_hysteresis_of_position", "u"),
    ],
)
def test_every_quantity_may_have_hysteresis(tmp_path: Path, integrator: str, law: str, to: str) -> None:
    found = _fits(tmp_path, integrator)[law, to]
    assert found.term.is_completing
    assert not found.term.is_named
    assert found.term.parameters[1].unit in ("m", "m/s")
    (state,) = found.placed.states
    assert state.start in ("x", "v", "position")  # it begins in the middle of its loop


def test_a_lag_is_the_exact_response_to_a_ramp() -> None:
    times = np.arange(0.0, 1.0, 0.01)
    np.testing.assert_allclose(lagging(3.0 + times, 0.2, 0.01), 3.0 + times - 0.2 * (1.0 - np.exp(-times / 0.2)))


def test_readings_of_a_table_are_not_changed(tmp_path: Path) -> None:
    """Guard of this file: the recordings with hysteresis of a sensor differ from those without by its loop."""
    plain = pd.read_csv(_recordings(tmp_path / "a", 0.0, 0.0)[0] / "data.csv")["x"]
    loop = pd.read_csv(_recordings(tmp_path / "b", 0.0, HALF_WIDTH)[0] / "data.csv")["x"]
    assert np.abs(plain - loop).max() == pytest.approx(HALF_WIDTH, rel=0.01)
