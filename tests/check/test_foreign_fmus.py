"""Recordings of FMUs that nobody here has seen: names, units and doubts are those of the user."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

from cosim.cli import app
from cosim.loading import load_scenario
from diagnosis.check.beside import compare
from diagnosis.check.check import check_recordings
from diagnosis.check.clock_doubts import shift_doubts
from diagnosis.check.edges import Edges, edge_doubts
from diagnosis.check.input_doubts import how
from diagnosis.check.inputs import compare_inputs
from diagnosis.check.tables import row
from diagnosis.judge.diagnosis import Doubt
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel

#: A filter whose output is called `y` and is a voltage, and a warm body.
FILTER = OdeModel(
    "filter",
    {"tau": (2.0, "s"), "C": (40.0, "J/K"), "loss": (0.8, "W/K")},
    {"u": "V", "power": "W"},
    {"q": ("V", "0.0", "(u - q)/tau"), "T": ("K", "293.15", "(power - loss*(T - 293.15))/C")},
    {"y": ("V", "q"), "body": ("K", "T")},
)
SCENARIO = """
title: A filter and a body
time: {stop: 60 s, macro_step: 100 ms, output_step: 500 ms}
components:
  source:
    kind: programme
    outputs:
      u: {unit: V, points: [[0 s, 1 V], [20 s, -1 V], [40 s, 2 V]]}
      power: {unit: W, constant: 0 W}
  rig: {kind: fmu, fmu: filter.fmu, integrator: cvode}
connections: [source.u -> rig.u, source.power -> rig.power]
"""
TIMES = np.arange(0.0, 60.0, 0.5)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Scenario and FMU."""
    found = tmp_path_factory.mktemp("filter")
    FILTER.build(found)
    (found / "scenario.yaml").write_text(SCENARIO)
    return found


#: Instants and levels of the scenario's programme [s, V].
LEVELS = ((0.0, 1.0), (20.0, -1.0), (40.0, 2.0))


def voltages(turned: float = 1.0, start: float = 0.0, levels: tuple[tuple[float, float], ...] = LEVELS) -> np.ndarray:
    """The closed form, with noise of 10 mV [mV]."""
    value, found = start, []
    for t in TIMES:
        found.append(value)
        u = next(level for begin, level in reversed(levels) if t >= begin - 1e-9)
        value = u + (value - u) * np.exp(-0.5 / 2.0)
    return turned * 1e3 * np.array(found) + 10.0 * np.random.default_rng(1).standard_normal(len(TIMES))


def write(folder: Path, name: str, noise: str = "10 mV", values: np.ndarray | None = None, **keys: object) -> Path:
    out = folder / name
    out.mkdir()
    columns = {"t": TIMES, "y_mV": voltages() if values is None else values}
    columns["body_degC"] = 20.0 + 0.05 * np.random.default_rng(2).standard_normal(len(TIMES))
    columns["u"] = 1.0 + 0.2 * np.sin(TIMES)
    rows = np.column_stack(list(columns.values()))
    np.savetxt(out / "data.csv", rows, delimiter=",", header=",".join(columns), comments="")
    sidecar = {
        "title": name,
        "table": "data.csv",
        "time": {"column": "t"},
        "channels": {
            "rig.y": {"column": "y_mV", "unit": "mV", "noise": noise},
            "rig.body": {"column": "body_degC", "unit": "degC", "noise": "0.05 K"},
        },
        **keys,
    }
    (out / "recording.yaml").write_text(yaml.safe_dump(sidecar))
    return out


def doubts(folder: Path, *recordings: Path) -> tuple[Doubt, ...]:
    return check_recordings(load_scenario(folder / "scenario.yaml"), [load_recording(r) for r in recordings])


def test_an_output_called_y_is_what_its_unit_says(folder: Path) -> None:
    channel = load_recording(write(folder, "volts")).channels["rig.y"]
    assert channel.unit == "V"
    assert channel.deviation == pytest.approx(0.01)
    body = load_recording(folder / "volts").channels["rig.body"]
    assert body.unit == "K"
    assert float(body.values.mean()) == pytest.approx(293.15, abs=0.05)


def test_what_is_shown_is_in_the_unit_of_the_column(folder: Path) -> None:
    one = compare(load_scenario(folder / "scenario.yaml"), load_recording(write(folder, "shown", noise="2 mV")))
    told = row(one.channels["rig.y"], one.units_of("rig.y"), one.units.scale(one.end, "s"))
    assert told.noise.endswith("mV")
    assert told.ranges[0].endswith("mV")
    (noise,) = [d for d in check_recordings(one.base, [one.recording]) if d.kind == "noise"]
    assert "noise of 2.00 mV" in noise.statement


def test_a_channel_of_opposite_sign_is_no_other_experiment(folder: Path) -> None:
    (found,) = [d for d in doubts(folder, write(folder, "sign", values=voltages(-1.0))) if d.is_serious]
    assert (found.kind, found.subject) == ("sign", "rig.y")
    assert "e+0" not in found.statement


def test_nothing_moves(folder: Path) -> None:
    """Readings at one state are met by any model that rests there."""
    overrides = {"components": {"source": {"outputs": {"u": {"constant": "0 V"}}}}}
    calm = np.random.default_rng(3).normal(0.0, 10.0, len(TIMES))
    still = write(folder, "still", values=calm, overrides=overrides)
    assert [d.kind for d in doubts(folder, still)] == ["still"]
    assert "still" not in [d.kind for d in doubts(folder, still, write(folder, "moved"))]


def test_a_programme_that_is_constant_has_no_switches_to_count(folder: Path) -> None:
    out = write(folder, "input", inputs={"source.power": {"column": "u", "unit": "W"}})
    scenario = load_scenario(folder / "scenario.yaml")
    (found,) = compare_inputs(compare(scenario, load_recording(out)))
    assert how(found) == "has another course from 0 to 59.5 s; the programme is constant"


def test_new_knows_the_variables_and_inputs_of_a_foreign_fmu(folder: Path) -> None:
    out = folder / "proposed"
    write(folder, "raw")
    told = CliRunner().invoke(
        app,
        [
            "recording",
            "new",
            str(folder / "raw" / "data.csv"),
            "--scenario",
            str(folder / "scenario.yaml"),
            "--out",
            str(out),
        ],
        catch_exceptions=False,
    )
    assert "2 channels proposed, 1 column unclear" in told.output
    assert set(load_recording(out).channels) == {"rig.y", "rig.body"}
    assert "by its name it is the input source.u" in (out / "recording.yaml").read_text()


def test_a_voltage_that_begins_elsewhere_and_is_met_later_has_another_start(folder: Path) -> None:
    """An offset of the sensor stays: that is no start."""
    (found,) = [d for d in doubts(folder, write(folder, "start", values=voltages(start=1.5))) if d.kind == "start"]
    assert (found.subject, found.is_serious, found.is_far) == ("rig.y", False, False)
    assert "mV on average, where " in found.statement
    offset = write(folder, "offset", values=voltages() + 1500.0)
    assert not [d for d in doubts(folder, offset) if d.kind == "start"]


def test_a_clock_that_is_off_by_more_than_a_short_pulse_is_no_other_programme(folder: Path) -> None:
    """Moved by 3 s the programme explains all, though one of its parts lasts for 1 s only."""
    levels = ((0.0, 1.0), (12.0, -1.0), (24.0, 2.0), (25.0, -2.0), (37.0, 1.5), (48.0, 0.0))
    points = [[f"{t} s", f"{v} V"] for t, v in levels]
    overrides = {"components": {"source": {"outputs": {"u": {"points": points}}}}}
    out = write(folder, "early", values=voltages(levels=levels), overrides=overrides, time={"column": "t", "zero": 3.0})
    (found,) = [d for d in doubts(folder, out) if d.is_serious]
    assert found.kind == "dead time"
    assert found.statement.startswith("the response comes 3")


def test_odds_against_a_programme_that_explains_nothing_are_serious(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Odds of 200 to 1 alone are a note; a lag or shift that explains nothing either is none at all."""
    levels = ((0.0, -1.0), (9.0, 1.5), (14.0, -2.0), (29.0, 2.0), (33.0, -1.5), (52.0, 1.0))
    scenario = load_scenario(folder / "scenario.yaml")
    other = compare(scenario, load_recording(write(folder, "other", values=voltages(levels=levels))))
    own = compare(scenario, load_recording(write(folder, "own")))
    odds = Edges((), (20.0, 40.0), (9.0, 14.0, 29.0), 200.0)
    monkeypatch.setattr("diagnosis.check.edges.edges", lambda compared: odds)
    (serious,), (note,) = edge_doubts(other), edge_doubts(own)
    assert (serious.is_serious, note.is_serious) == (True, False)
    assert "the programme explains" in serious.statement
    assert shift_doubts(other) == []


#: A batch that grows: its course bends by itself, where no feed is switched.
BATCH = OdeModel(
    "batch",
    {"mu": (0.06, "1/(kg*s)"), "yield_": (0.5, "1")},
    {"feed": "kg/s"},
    {"X": ("kg", "0.2", "mu*X*S"), "S": ("kg", "1.0", "feed - mu*X*S/yield_")},
    {"biomass": ("kg", "X"), "substrate": ("kg", "S")},
)
GROWTH = """
title: A batch
time: {stop: 60 s, macro_step: 100 ms, output_step: 500 ms}
components:
  pump:
    kind: programme
    outputs:
      feed: {unit: kg/s, points: [[0 s, 0.02 kg/s], [15 s, 0.1 kg/s], [30 s, 0.05 kg/s], [44 s, 0.01 kg/s]]}
  tank: {kind: fmu, fmu: batch.fmu, integrator: cvode}
connections: [pump.feed -> tank.feed]
"""


def growth(saturation: float) -> np.ndarray:
    """Biomass and substrate [kg] of the batch with Monod's constant [kg]; 0: the model's own law. Classical RK4."""

    def rate(x: np.ndarray, feed: float) -> np.ndarray:
        grown = 0.06 * x[0] * x[1] / (1.0 + saturation * x[1])
        return np.array([grown, feed - grown / 0.5])

    x, h, found = np.array([0.2, 1.0]), 0.01, []
    for n in range(6000):
        if n % 50 == 0:
            found.append(x)
        feed = np.select([n < 1500, n < 3000, n < 4400], [0.02, 0.1, 0.05], 0.01)
        a = rate(x, feed)
        b = rate(x + 0.5 * h * a, feed)
        c = rate(x + 0.5 * h * b, feed)
        x = x + h / 6.0 * (a + 2.0 * (b + c) + rate(x + h * c, feed))
    return np.array(found)


@pytest.mark.parametrize("saturation", [0.0, 0.8, 3.0])
def test_a_course_that_bends_by_itself_is_no_other_programme(tmp_path: Path, saturation: float) -> None:
    """Steps at free instants draw a growth curve better than a model of other kinetics; its programme is right."""
    BATCH.build(tmp_path)
    (tmp_path / "scenario.yaml").write_text(GROWTH)
    values = growth(saturation) + 0.005 * np.random.default_rng(3).standard_normal((120, 2))
    record = tmp_path / "run"
    record.mkdir()
    table = np.column_stack([TIMES, values])
    np.savetxt(record / "data.csv", table, delimiter=",", header="t,X,S", comments="", fmt="%.6g")
    channel = {"unit": "kg", "noise": "0.005 kg"}
    channels = {"tank.biomass": {"column": "X", **channel}, "tank.substrate": {"column": "S", **channel}}
    about = {"title": "run", "table": "data.csv", "time": {"column": "t", "unit": "s"}, "channels": channels}
    (record / "recording.yaml").write_text(yaml.safe_dump({**about, "source": "computed"}))
    found = doubts(tmp_path, record)
    assert not [d for d in found if d.is_serious and d.kind == "programme"]
