"""Each sentence on an input on which another wording of it would be false."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import yaml

from cosim.scenario import Scenario, load_scenario
from diagnosis.candidates.registry import catalogue
from diagnosis.check.check import check_recordings
from diagnosis.faults.model import with_faults
from diagnosis.judge.diagnosis import Domain, Estimate, Searched, Verdict
from diagnosis.judge.doubts import doubted
from diagnosis.judge.headline import headline, how_right
from diagnosis.judge.location import WHOLE, Location
from diagnosis.judge.searched import searched
from diagnosis.judge.verdict import why_open
from diagnosis.models.build import model_of
from diagnosis.models.coil_network.runs import deviation
from diagnosis.models.cosimulation.model import ClosedLoopModel
from diagnosis.recording.noise import is_unresolved
from diagnosis.recording.recording import Recording, load_recording
from diagnosis.report.network import Network
from diagnosis.report.page import page
from diagnosis.report.sentences import sureness, when
from diagnosis.report.undecided import departing, model_note, what_decides
from diagnosis.search.problem import Point
from diagnosis.search.score import Scoring
from diagnosis.search.structure import Structure
from tests.diagnosis.report_examples import ADEQUACY, CONTACT, DOUBT, LAG, diagnosis
from tests.search.line_model import TIME
from tests.verdict.lines import Lines

ROOT = Path(__file__).resolve().parents[2]
FAULT = replace(LAG, effect="sensor_offset_in_interval", statement="sensor that was off for a while, coil[1]")


def recorded(folder: Path, columns: dict[str, np.ndarray], channels: dict[str, dict[str, str]]) -> Recording:
    """A recording from its columns; the first one is the time [s]."""
    folder.mkdir()
    table = np.column_stack(list(columns.values()))
    np.savetxt(folder / "data.csv", table, delimiter=",", header=",".join(columns), comments="", fmt="%.6f")
    given = {
        "title": folder.name,
        "table": "data.csv",
        "time": {"column": "time", "unit": "s", "zero": 0.0},
        "channels": channels,
    }
    (folder / "recording.yaml").write_text(yaml.safe_dump(given, sort_keys=False), encoding="utf-8")
    return load_recording(folder)


def pendulum() -> Scenario:
    return load_scenario("pendulum")


@pytest.mark.parametrize("is_stated", [True, False])
def test_a_closed_loop_knows_whether_its_noise_was_stated(tmp_path: Path, is_stated: bool) -> None:
    time = np.linspace(0.0, 9.0, 200)
    angle = 3.1 + 0.01 * np.random.default_rng(1).standard_normal(200)
    given = {"column": "a", "unit": "rad", "quantum": "0.02 rad", **({"noise": "0.01 rad"} if is_stated else {})}
    recording = recorded(tmp_path / "swing", {"time": time, "a": angle}, {"arm.angle": given})
    (series,) = ClosedLoopModel(pendulum(), [recording]).runs[0].series
    assert series.channel.is_deviation_given is is_stated
    if is_stated:  # rounding counts once, wherever the deviation is asked for
        both = math.hypot(0.01, 0.02 / math.sqrt(12.0))
        assert series.channel.deviation == pytest.approx(both)
        assert deviation(series.channel) == pytest.approx(both)


def test_where_no_null_gains_its_price_a_gain_is_rarer_than_one_of_them() -> None:
    quiet = Scoring([], 5, np.zeros(96))
    assert quiet.false_alarm_rate(500.0) == pytest.approx(1.0 / 97.0)
    assert quiet.false_alarm_rate(0.0) == 1.0


def test_a_model_without_numbers_to_fit_is_not_called_recalibrated() -> None:
    none = replace(ADEQUACY, is_recalibrated=False, explained=0.0, day=())
    assert how_right(none, False) == (
        "The model as it is misses the held-out recordings; 1.2 K of coil[2,5].temperature stays, 8.0 times the noise "
        "that is stated: something is missing or wrong."
    )
    told = replace(diagnosis(Verdict.CANNOT_TELL), findings=(), adequacy=none)
    assert model_note(told) == "as it was given: nothing fitted, nothing added"


def test_what_a_fault_explains_is_not_explained_by_recalibration() -> None:
    told = headline(Verdict.MEASUREMENT_FAULT, [FAULT], replace(ADEQUACY, day=()))
    assert "The model with what was found of sensors, inputs and single recordings explains 96 %" in told
    alone = replace(diagnosis(Verdict.MEASUREMENT_FAULT), findings=(FAULT,))
    assert model_note(alone) == "recalibrated, nothing added: a fault of one recording is no part of a model"


def test_of_readings_that_reject_nothing_no_share_is_explained() -> None:
    chance = replace(
        ADEQUACY,
        is_rejected=False,
        is_nominal_rejected=False,
        explained=0.4,
        day=(),
        chi_square={"before": 1.02, "recalibrated": 1.01, "after": 1.01},
    )
    within = "The held-out recordings are met within the stated noise of the sensors"
    assert how_right(chance, False) == f"{within}, before and after."
    one = replace(chance, is_nominal_rejected=True, chi_square={"before": 0.99, "recalibrated": 0.9, "after": 0.9})
    assert how_right(one, True) == f"{within} now; the model as it is misses them."


def test_scatter_of_contacts_is_no_noise_of_sensors() -> None:
    fabric = replace(ADEQUACY, has_scatter=True, is_rejected=False, is_nominal_rejected=False, day=())
    told = headline(Verdict.CONSISTENT, [], fabric)
    assert told.endswith("within the stated noise of the sensors and what simulations of an equal fabric differ by.")


def test_each_gain_is_told_with_the_readings_that_judged_it() -> None:
    alternate = "every other reading, left out of a fit"
    fault = replace(FAULT, held_out_gain=6170.0, judged_by=alternate)
    physics = replace(CONTACT, held_out_gain=50.0, judged_by="held-out recordings")
    told = sureness(replace(diagnosis(Verdict.MISSING_PHYSICS), findings=(physics, fault)))
    assert told.endswith(
        f"-2 log likelihood of readings that judge falls by 50.0 (held-out recordings); falls by 6170 ({alternate})."
    )


def test_another_recording_does_not_decide_about_a_fault_of_one() -> None:
    open_one = diagnosis(Verdict.CANNOT_TELL)
    fault, physics = replace(FAULT, is_accepted=False), replace(CONTACT, is_accepted=False)
    assert "second sensor" in what_decides(replace(open_one, findings=(fault,)))
    told = what_decides(replace(open_one, findings=(physics,)))
    assert told.startswith("Record a programme of the training once more and hold that out.")
    assert "has changed" not in told  # nothing shows that
    trained = tuple(f for f in open_one.fit if not f.is_held_out)
    alone = what_decides(replace(open_one, findings=(physics,), fit=trained))
    assert alone.startswith("Record another programme and hold that out")


def test_what_waits_for_a_start_is_not_sent_to_another_recording() -> None:
    start = replace(DOUBT, kind="start", is_serious=False, is_far=True, statement="begins at 35 degC")
    (waiting,) = doubted([CONTACT], [start])
    told = what_decides(replace(diagnosis(Verdict.CANNOT_TELL), findings=(waiting,)))
    assert told.startswith("Clear first what the check of the recordings saw")


def test_a_fast_oscillation_is_no_noise() -> None:
    time = np.arange(0.0, 4.0, 0.05)
    noise = 0.005 * np.random.default_rng(2).standard_normal(len(time))
    assert is_unresolved(time, np.cos(19.0 * time) + noise)  # 6.6 readings in a period
    assert not is_unresolved(time, np.cos(2.0 * time) + noise)
    assert not is_unresolved(time, noise)


def test_the_stated_noise_of_a_fast_swing_is_not_doubted(tmp_path: Path) -> None:
    """An arm of 8 rad/s read eight times in a period: neighbours differ by the swing, not by noise."""
    time = np.arange(0.0, 9.5, 0.1)
    noise = 0.005 * np.random.default_rng(3).standard_normal(len(time))
    channels = {"arm.angle": {"column": "a", "unit": "rad", "noise": "0.005 rad"}}
    recording = recorded(tmp_path / "fast", {"time": time, "a": np.pi + np.cos(8.0 * time) + noise}, channels)
    assert not [d for d in check_recordings(pendulum(), [recording]) if d.kind == "noise"]


def test_laws_that_no_channel_can_show_were_not_tried_and_faults_were(tmp_path: Path) -> None:
    """Heaters that are given their power have no load: nothing mechanical was tried, faults of thermometers were."""
    scenario = load_scenario("tclab")
    time = np.arange(0.0, 590.0, 5.0)
    warm = 21.0 + 5e-3 * time + 0.1 * np.random.default_rng(4).standard_normal(len(time))
    channels = {"coil[1].temperature": {"column": "a", "unit": "degC", "noise": "0.1 K"}}
    recording = recorded(tmp_path / "warm", {"time": time, "a": warm}, channels)
    model = with_faults(model_of(scenario, [recording], catalogue()))
    found = searched(model, scenario, (), Point(np.zeros(len(model.parameters))))
    assert "mechanical" not in {d.name for d in found.domains}
    assert "no mechanical law changes what these channels measure" in found.untried
    assert found.has_physics
    swing = {"time": np.linspace(0.0, 9.0, 100), "a": np.full(100, 3.1)}
    given = {"arm.angle": {"column": "a", "unit": "rad", "noise": "0.01 rad"}}
    arm = with_faults(ClosedLoopModel(pendulum(), [recorded(tmp_path / "swing", swing, given)]))
    measured = next(d for d in searched(arm, pendulum(), ()).domains if d.name == "measurement")
    assert measured.laws >= len({t.identifier for t in arm.faults()})


def test_a_law_that_is_suggested_may_explain_what_is_left() -> None:
    """The readings reject the model without it; whether a law that was tried explains them is then open."""
    base = SimpleNamespace(point=Point(np.zeros(1)), widths=np.ones(1))
    outcome = SimpleNamespace(base_structure=Structure(0.0, "", 0.0, 1.0), base=base, first=None)
    tried, rejected = (
        Searched((Domain("thermal", 30, 12, 37),)),
        replace(ADEQUACY, is_recalibration_worse=False, is_training_rejected=True),
    )
    without = why_open(outcome, (), rejected, tried)  # type: ignore[arg-type]
    assert "the readings reject the model, and no law that was tried explains what is left" in without
    outcome.first = SimpleNamespace(best=SimpleNamespace(terms=(CONTACT,)))
    found_before = why_open(outcome, (), rejected, tried)  # type: ignore[arg-type]
    assert "no law that was tried explains more of what is left than chance may" in found_before[0]
    met = replace(rejected, is_training_rejected=False)
    (there,) = why_open(outcome, (), met, tried)  # type: ignore[arg-type]
    assert "no law" not in there
    assert "of the training readings, to which laws are fitted, no more is left than noise explains" in there
    beside = why_open(outcome, (replace(CONTACT, is_accepted=False),), rejected, tried)  # type: ignore[arg-type]
    assert "the readings reject the model" in beside


def test_where_no_unit_could_be_driven_alone_none_is_said_to_be(tmp_path: Path) -> None:
    whole = Location("mechanical", WHOLE, "marker[3].x", "marker[3].x", 0.1, 0.3, 6.1, 4.0)
    told = replace(diagnosis(Verdict.CANNOT_TELL), findings=(), locations=(whole,))
    assert departing(told) == ""
    text = page(told, [], Network(()))
    assert "riven alone with" not in text
    assert "residuals of the whole simulation" in text


def test_a_report_without_held_out_recordings_says_what_judged() -> None:
    whole = diagnosis(Verdict.MEASUREMENT_FAULT)
    basis = "stretches of the training recordings, each left out of a fit"
    fault = replace(FAULT, judged_by="every other reading, left out of a fit", held_out_gain=-3.0)
    told = replace(
        whole,
        findings=(fault,),
        adequacy=replace(ADEQUACY, basis=basis),
        held_out_by="",
        fit=tuple(f for f in whole.fit if not f.is_held_out),
    )
    text = page(told, [], Network(()))
    assert f"<dt>Judged by</dt><dd>{basis}</dd>" in text
    assert "readings that judge (every other reading, left out of a fit) rises by 3" in text


class Fixed(Lines):
    """A model without a number that could be fitted, as FMUs are whose parameters state no uncertainty."""

    def __init__(self, truth: np.ndarray) -> None:
        super().__init__(truth, 1)
        self.parameters = []

    def signal(self, point: Point) -> np.ndarray:
        return super().signal(Point(np.zeros(2), point.terms))

    def base_jacobian(self, point: Point) -> np.ndarray:
        return np.zeros((len(TIME), 0))


def test_a_stuck_sensor_is_fitted_where_no_parameter_is() -> None:
    truth = 5.0 * TIME * (TIME < 0.5) + 2.5 * (TIME >= 0.5)
    model = with_faults(Fixed(truth))
    term = next(t for t in model.faults() if t.identifier == "sensor_stuck_in_interval")
    point = Point(np.zeros(0), {term: (1.0, 0.5, 1.0)})
    assert model.base_jacobian(point).shape == (len(TIME), 0)


def test_a_law_that_always_acts_is_seen_at_times_and_one_with_an_instant_acts_then() -> None:
    """A drag of the air was told as `when 2.02 to 9.16 s`, which is where it moves the readings most."""
    drag = replace(CONTACT, intervals=((2.02, 9.16),), recording="monday")
    assert when(drag) == "seen 2.02 to 9.16 s of monday"
    broken = replace(drag, intervals=((7.998, 60.0),), parameters=(Estimate("instant", "s", 7.998, 7.98, 8.01),))
    assert when(broken) == "from 7.998 s (7.980 to 8.010) of monday on"
    off = replace(FAULT, intervals=((35.4, 59.8),), parameters=(Estimate("begin", "s", 35.4, 35.0, 35.6),))
    assert when(off) == "35.4 to 59.8 s"
    assert when(replace(drag, intervals=())) == "– of monday"
