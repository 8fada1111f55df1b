"""Sabotage: what is said and what was done differ as the answer says, and in nothing else."""

import json
import math
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
import yaml

from diagnosis.recording.recording import load_recording
from evaluation.proving.case import Case, drawn_chain, run_truth
from evaluation.proving.cases import drawn_cases
from evaluation.proving.pendulum.case import drawn_pendulum
from evaluation.proving.programme import delayed, offset, soak
from evaluation.proving.rig import drawn_rig
from evaluation.proving.sabotage import inputs, pendulum, readings, structure
from evaluation.proving.sabotage.deal import PAIRS
from evaluation.proving.sabotage.sabotage import Bench, Sabotage
from evaluation.proving.setups import SETUPS


def made_case(name, sabotage=None, stop=30.0):
    """A short case without effects; drawn alike whatever is done to it."""
    setup = replace(SETUPS[name], stop=stop, step=0.5)
    rng = np.random.default_rng(4)
    programmes = [setup.shapes["pulses"](rng, setup.top, stop) for _ in range(3)]
    rig, chain = drawn_rig(setup.sheet, rng), drawn_chain(setup, rng)
    for sensors in chain.values():
        sensors.dropouts = sensors.outliers = sensors.jitter = 0.0
    bench = Bench(setup, chain, programmes, 2)
    case = Case("case", "sabotaged", setup, rig, [], [], {}, programmes[:2], programmes[2:], (), chain)
    return replace(case, sabotage=Sabotage() if sabotage is None else sabotage(bench)), bench


def written(folder, name, sabotage=None):
    case, _ = made_case(name, sabotage)
    case.write(folder / "cases", folder / "answers", np.random.default_rng(6))
    return folder / "cases" / "case", json.loads((folder / "answers" / "case.json").read_text())


def drawn(kind, seed=1):
    return lambda bench: kind.drawn(bench, np.random.default_rng(seed))


def differing(one, other):
    names = sorted(str(p.relative_to(one)) for p in one.rglob("*") if p.is_file())
    return [n for n in names if (one / n).read_bytes() != (other / n).read_bytes()]


def sidecar(folder, name="training_1"):
    return yaml.safe_load((folder / name / "recording.yaml").read_text())


@pytest.fixture(scope="module")
def honest(tmp_path_factory):
    return {name: written(tmp_path_factory.mktemp(name), name)[0] for name in ("small", "zones")}


def test_a_case_without_sabotage_has_none_in_its_answer(honest):
    answer = json.loads((honest["small"].parents[1] / "answers" / "case.json").read_text())
    assert answer["sabotage"] is None
    assert [sidecar(honest["small"], n)["order"] for n in ("training_1", "training_2", "held_out_1")] == [1, 2, 3]


def test_swapped_columns_are_swapped_and_nothing_else(honest, tmp_path):
    folder, answer = written(tmp_path, "zones", drawn(readings.SwappedColumns))
    assert {n.split("/")[1] for n in differing(honest["zones"], folder)} == {"recording.yaml"}
    first, second = answer["sabotage"]["channels"]
    assert first.split(",")[0] != second.split(",")[0]  # of strings that are driven apart
    plain, changed = (load_recording(f / "training_1").channels for f in (honest["zones"], folder))
    assert changed[first].values.tolist() == plain[second].values.tolist()
    assert changed[second].values.tolist() == plain[first].values.tolist()
    others = [n for n in plain if n not in (first, second)]
    assert all(changed[n].values.tolist() == plain[n].values.tolist() for n in others)


def test_swapped_coils_take_all_their_channels_along(honest, tmp_path):
    folder, answer = written(tmp_path, "zones", drawn(readings.SwappedCoils))
    plain, changed = (load_recording(f / "held_out_1").channels for f in (honest["zones"], folder))
    one, _, other, _ = answer["sabotage"]["channels"]
    for quantity in ("temperature", "extension"):
        there = other.replace("temperature", quantity)
        assert changed[one.replace("temperature", quantity)].values.tolist() == plain[there].values.tolist()


def test_milliamperes_that_are_called_amperes_are_a_thousand_times_as_large(honest, tmp_path):
    def wrong(bench):
        made = readings.WrongUnit(bench.all, {"factor": 1000.0}, bench.sensors["string"].names)
        made._mode = "mA as A"
        return made

    folder, answer = written(tmp_path, "small", wrong)
    plain, changed = (load_recording(f / "training_2").channels for f in (honest["small"], folder))
    assert changed["string[1].current"].values == pytest.approx(1000.0 * plain["string[1].current"].values, rel=1e-12)
    assert changed["supply.current"].values.tolist() == plain["supply.current"].values.tolist()
    assert answer["sabotage"]["mistake"] == "mA as A"
    assert answer["verdicts"] == ["recording fault", "measurement fault", "cannot tell"]


def test_fahrenheit_that_is_called_celsius(honest, tmp_path):
    def wrong(bench):
        made = readings.WrongUnit(bench.all, {"factor": 1.8}, bench.sensors["temperature"].names)
        made._mode = "degF as degC"
        return made

    folder, _ = written(tmp_path, "small", wrong)
    plain, changed = (
        load_recording(f / "training_1").channels["coil[1,2].temperature"] for f in (honest["small"], folder)
    )
    # 22 degC are 71.6 degF, which is read as 71.6 degC; tables have six digits.
    assert changed.values - 273.15 == pytest.approx(1.8 * (plain.values - 273.15) + 32.0, abs=1e-3)


def test_a_stuck_sensor_gives_its_last_reading_until_the_end_of_the_stretch(honest, tmp_path):
    def stuck(bench):
        return readings.SensorStuck((2,), {}, ("coil[2,1].temperature",), (10.0, 20.0))

    folder, answer = written(tmp_path, "small", stuck)
    assert differing(honest["small"], folder) == ["training_2/temperature.csv"]
    channel = load_recording(folder / "training_2").channels["coil[2,1].temperature"]
    plain = load_recording(honest["small"] / "training_2").channels["coil[2,1].temperature"]
    inside = (channel.times >= 10.0) & (channel.times < 20.0)
    assert np.ptp(channel.values[inside]) == 0.0
    assert np.ptp(plain.values[inside]) > 1.0
    assert channel.values[~inside].tolist() == plain.values[~inside].tolist()
    assert (answer["sabotage"]["begin"], answer["sabotage"]["end"]) == (10.0, 20.0)
    assert answer["sabotage"]["titles"] == ["small, training 2"]


def test_a_sensor_that_is_off_is_off_within_its_stretch_alone(honest, tmp_path):
    def off(bench):
        return readings.SensorOff((1,), {"bias": 3.0}, ("coil[1,1].temperature",), (10.0, 20.0))

    folder, _ = written(tmp_path, "small", off)
    changed, plain = (
        load_recording(f / "training_1").channels["coil[1,1].temperature"] for f in (folder, honest["small"])
    )
    inside = (plain.times >= 10.0) & (plain.times < 20.0)
    assert changed.values - plain.values == pytest.approx(3.0 * inside, abs=1e-3)


@pytest.mark.parametrize(
    ("sabotage", "late"),
    [
        (lambda bench: readings.ShiftedClock((1,), {"shift": 4.0}), lambda t: t + 4.0),
        (lambda bench: readings.DriftingClock((1,), {"rate": -0.05}), lambda t: 0.95 * t),
    ],
)
def test_a_wrong_clock_moves_stamps_and_leaves_readings(honest, tmp_path, sabotage, late):
    folder, _ = written(tmp_path, "small", sabotage)
    changed, plain = (
        load_recording(f / "training_1").channels["coil[1,1].temperature"] for f in (folder, honest["small"])
    )
    kept = late(plain.times) <= 30.0
    assert changed.times == pytest.approx(late(plain.times)[kept], abs=1e-4)
    assert changed.values.tolist() == plain.values[kept].tolist()
    assert not [n for n in differing(honest["small"], folder) if not n.startswith("training_1")]


def test_another_programme_is_stated_and_the_readings_are_those_of_the_one_applied(honest, tmp_path):
    def wrong(bench):
        return inputs.WrongProgramme((1,), {1: inputs.other_programme(bench, 1, np.random.default_rng(9))})

    folder, _ = written(tmp_path, "small", wrong)
    assert differing(honest["small"], folder) == ["training_1/recording.yaml"]
    points = [
        sidecar(f)["overrides"]["components"]["supply"]["outputs"]["voltage"]["points"]
        for f in (folder, honest["small"])
    ]
    assert points[0] != points[1]


def test_a_recorded_input_is_the_applied_one_but_for_the_column_of_another_run(tmp_path):
    folder, answer = written(tmp_path, "small", drawn(inputs.OtherRunInput))
    case, _ = made_case("small")
    (spoiled,) = answer["sabotage"]["recordings"]
    for name, programme in zip(("training_1", "training_2", "held_out_1"), [*case.training, *case.held_out]):
        (recorded,) = load_recording(folder / name).inputs
        applied = np.array([float(programme.at(t)) for t in recorded.times])
        assert np.array_equal(recorded.values, applied) is (name != spoiled), name
        assert "components" not in sidecar(folder, name)["overrides"]


def test_a_source_that_gives_more_for_a_while_gives_more_then_and_no_record_shows_it(honest, tmp_path):
    def more(bench):
        return inputs.InputOffset((1,), {"factor": 1.1, "added": 0.0}, (), (5.0, 9.0))

    case, _ = made_case("small", more)
    plain, changed = (run_truth(replace(case, sabotage=s), case.training[0], 1) for s in (Sabotage(), case.sabotage))
    # Ohm's law: the current follows the voltage.
    for moment, factor in ((4.0, 1.0), (6.0, 1.1), (9.5, 1.0)):
        one, other = (
            float(np.interp(moment, *(c if c.ndim == 1 else c[:, 0] for c in t.signal("string"))))
            for t in (plain, changed)
        )
        assert other == pytest.approx(factor * one, rel=1e-9)
    folder, _ = written(tmp_path, "small", more)
    assert "training_1/recording.yaml" not in differing(honest["small"], folder)


def test_rooms_and_starts_are_other_than_stated_in_their_recording_alone():
    case, _ = made_case("small", lambda bench: inputs.UnequalRooms((2,), {"difference": 4.0}))
    starts = [run_truth(case, case.training[0], n).states["temperature"][0] for n in (1, 2)]
    assert starts[1] - starts[0] == pytest.approx(np.full(6, 4.0), rel=1e-9)
    case, _ = made_case("small", lambda bench: inputs.WrongStart((1,), {"excess": 12.0}))
    warm, cold = (run_truth(case, case.training[0], n) for n in (1, 2))
    assert warm.states["temperature"][0] - cold.states["temperature"][0] == pytest.approx(np.full(6, 12.0), rel=1e-9)
    assert np.array_equal(warm.ambient, cold.ambient)


def test_strings_on_each_others_supply_and_a_dead_time():
    case, bench = made_case("zones", drawn(inputs.OtherSupply))
    programme = bench.programmes[0]
    first, second = (int(case.sabotage.parameters[n]) - 1 for n in ("first", "second"))
    applied = case.sabotage.applied(1, programme)
    assert np.array_equal(applied.levels[:, first], programme.levels[:, second])
    late = delayed(programme, 2.5)
    for moment in (0.0, 4.6, 11.3, 29.0):
        assert np.array_equal(late.at(moment), programme.at(max(moment - 2.5, 0.0)))


def test_offset_of_a_programme():
    programme = soak(np.random.default_rng(1), 3.0, 100.0)
    changed = offset(programme, (20.0, 30.0), 1.1, 0.0)
    assert [float(changed.at(t)) for t in (19.9, 20.0, 29.9, 30.0)] == pytest.approx(
        [float(programme.at(t)) * f for t, f in ((19.9, 1.0), (20.0, 1.1), (29.9, 1.1), (30.0, 1.0))], rel=1e-12
    )
    ramp = SETUPS["bath"].shapes["loop"](np.random.default_rng(1), 70.0, 240.0)
    shifted = offset(ramp, (60.0, 90.0), 1.0, 3.0)
    assert [float(shifted.at(t) - ramp.at(t)) for t in (59.9, 60.1, 89.9, 90.1)] == pytest.approx(
        [0, 3, 3, 0], abs=1e-9
    )


def test_coils_without_a_loop_have_one_stiffness_at_one_temperature():
    case, _ = made_case("small", drawn(structure.SingleBranch), stop=60.0)

    def gap(sabotage):
        states = run_truth(replace(case, sabotage=sabotage), case.training[0], 1).states
        warm, stiff = states["mean_temperature"][:, 0], states["stiffness"][:, 0]
        rising = np.gradient(warm) > 0.0
        order = np.argsort(warm[rising])
        seen = np.interp(warm[~rising], warm[rising][order], stiff[rising][order])
        return np.abs(seen - stiff[~rising])[(warm[~rising] > 305.0) & (warm[~rising] < 325.0)].max()

    assert gap(case.sabotage) < 3.0  # [N/m]: pieces of a wire are not equally warm
    assert gap(Sabotage()) > 30.0


def test_a_thermostat_opens_its_string_when_it_is_hot():
    case, _ = made_case("small", drawn(structure.HiddenThermostat), stop=60.0)
    trace = run_truth(case, case.training[0], 1)
    opens = case.sabotage.parameters["T_open"]
    assert trace.states["mean_temperature"][:, 0].max() == pytest.approx(opens, abs=4.0)  # a step of 0.5 s late
    plain = run_truth(replace(case, sabotage=Sabotage()), case.training[0], 1)
    assert plain.states["mean_temperature"][:, 0].max() > opens + 8.0


def test_the_deck_deals_every_sabotage_on_every_rig_before_any_comes_again():
    cases = [case for case, _ in drawn_cases(len(PAIRS), 3, ["sabotaged"])]
    dealt = Counter((c.sabotage.kind, "pendulum" if not isinstance(c, Case) else c.setup.name) for c in cases)
    assert dealt == {(kind.kind, setup): 1 for kind, setup in PAIRS}
    assert {s for _, s in dealt} == {*SETUPS, "pendulum"}
    assert len({k for k, _ in dealt}) == 18
    besides = sum(bool(c.effects) for c in cases)
    assert 4 <= besides <= 26  # a fifth of 74: three deviations
    for case in cases:
        assert case.sabotage.verdicts[-1] == "cannot tell"
        assert case.sabotage.recordings


@pytest.mark.parametrize("kind", [pendulum.SensorStuck, pendulum.WrongStart, pendulum.Push])
def test_a_swing_is_spoiled_where_the_answer_says(kind, tmp_path):
    rng = np.random.default_rng(2)
    case = replace(drawn_pendulum("case", "sabotaged", [], [], rng), engine="own", starts=((2.2, 0.1), (2.6, 0.0)))
    spoiled = replace(case, sabotage=kind.drawn_for_arm(1, 12.0, np.random.default_rng(3)))
    for name, one in (("plain", case), ("spoiled", spoiled)):
        one.write(tmp_path / name / "cases", tmp_path / name / "answers", np.random.default_rng(5))
    plain, changed = (
        load_recording(tmp_path / n / "cases/case/training_1").channels["arm.angle"] for n in ("plain", "spoiled")
    )
    told = json.loads((tmp_path / "spoiled/answers/case.json").read_text())["sabotage"]
    before = plain.times < told["begin"]
    assert changed.values[before].tolist() == plain.values[before].tolist()
    away = np.abs(changed.values - plain.values)[~before]
    assert away.max() > 0.05
    if kind is pendulum.WrongStart:
        assert away[0] == pytest.approx(abs(told["parameters"]["excess"]), abs=2.0 * 2.0 * math.pi / 4096.0)
    held_out = [tmp_path / n / "cases/case/held_out_1/encoder.csv" for n in ("plain", "spoiled")]
    assert held_out[0].read_bytes() == held_out[1].read_bytes()
