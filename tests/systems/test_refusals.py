"""Each refusal of a diagnosis of a system once: one clear error, or what could not be tried and why."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from cosim.cli import main
from cosim.scenario import load_scenario
from diagnosis.models.cosimulation.model import ClosedLoopModel
from diagnosis.recording.recording import load_recording
from diagnosis.search.problem import Point
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import COUNT, OSCILLATOR, OSCILLATOR_SCENARIO, STEP, drive, write_recording


@dataclass(frozen=True)
class BrokenFmu(OdeModel):
    """An FMU of which one text of its C source or of its description is another.

    Args:
        instead: (text, replacement) pairs.
    """

    instead: tuple[tuple[str, str], ...] = ()

    def source(self, guid: str) -> str:
        """See `OdeModel`."""
        return self._changed(super().source(guid))

    def description(self, guid: str) -> str:
        """See `OdeModel`."""
        return self._changed(super().description(guid))

    def _changed(self, text: str) -> str:
        for old, new in self.instead:
            text = text.replace(old, new)
        return text


def _rig(folder: Path, *instead: tuple[str, str], integrator: str = "cvode") -> Path:
    """Scenario, FMU and one recording `run`; returns the scenario."""
    o = OSCILLATOR
    fmu = BrokenFmu(o.name, o.parameters, o.inputs, o.states, o.outputs, o.inner_step, instead)
    assert all(old in OSCILLATOR.source("g") + OSCILLATOR.description("g") for old, _ in instead)
    fmu.build(folder)
    path = folder / "scenario.yaml"
    path.write_text(OSCILLATOR_SCENARIO.replace("INTEGRATOR", integrator), encoding="utf-8")
    u = drive(1, 0.3)
    position = 1e-3 * np.random.default_rng(0).standard_normal(COUNT)
    write_recording(
        folder / "run",
        {"t": STEP * np.arange(COUNT), "u": u, "x": position},
        {"drive.u": ("u", "V")},
        {"rig.position": ("x", "m", "1 mm")},
    )
    return path


def _refusal(scenario: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> str:
    """What `cosim diagnose` says; it ends with code 2, without a traceback and without an answer."""
    out = scenario.parent / "answer"
    given = ["cosim", "diagnose", str(scenario), "--recording", str(scenario.parent / "run"), "--out", str(out)]
    monkeypatch.setattr("sys.argv", given)
    with pytest.raises(SystemExit) as ended:
        main()
    said = capsys.readouterr().err
    assert ended.value.code == 2
    assert "Traceback" not in said
    assert said.count("error:") == 1, said
    assert not (out / "diagnosis.json").exists()
    return re.sub(r"\s+", " ", said)


def _edited(path: Path, *instead: tuple[str, str]) -> None:
    text = path.read_text(encoding="utf-8")
    for old, new in instead:
        assert old in text
        text = text.replace(old, new)
    path.write_text(text, encoding="utf-8")


def _model(scenario: Path) -> ClosedLoopModel:
    return ClosedLoopModel(load_scenario(str(scenario)), [load_recording(scenario.parent / "run")])


Patch = pytest.MonkeyPatch
Captured = pytest.CaptureFixture[str]


def test_a_term_at_a_state_that_the_fmu_does_not_have(tmp_path: Path, monkeypatch: Patch, capsys: Captured) -> None:
    scenario = _rig(tmp_path)
    _edited(scenario, ("integrator: cvode", "integrator: cvode, added_terms: [{to: der(w), formula: v / time}]"))
    said = _refusal(scenario, monkeypatch, capsys)
    assert "the FMU has no continuous state `w`" in said
    assert "it has: x, v" in said


def test_a_term_inside_an_fmu_that_hides_its_states(tmp_path: Path, monkeypatch: Patch, capsys: Captured) -> None:
    scenario = _rig(tmp_path, integrator="internal")
    _edited(scenario, ("integrator: internal", "integrator: internal, added_terms: [{to: der(v), formula: v / time}]"))
    said = _refusal(scenario, monkeypatch, capsys)
    assert "its own solver integrates this FMU" in said
    assert "use `integrator: cvode`, or add to an input or output" in said


def test_a_channel_that_is_no_output(tmp_path: Path, monkeypatch: Patch, capsys: Captured) -> None:
    scenario = _rig(tmp_path)
    _edited(tmp_path / "run" / "recording.yaml", ("rig.position:", "rig.height:"))
    said = _refusal(scenario, monkeypatch, capsys)
    assert "recording.yaml" in said
    assert "channels.rig.height" in said
    assert "rig.position" in said  # what there is


def test_an_input_that_no_programme_gives(tmp_path: Path, monkeypatch: Patch, capsys: Captured) -> None:
    scenario = _rig(tmp_path)
    _edited(tmp_path / "run" / "recording.yaml", ("drive.u:", "drive.force:"))
    said = _refusal(scenario, monkeypatch, capsys)
    assert "inputs.drive.force: the programme has no output force" in said
    assert "it has: u" in said


def test_a_unit_of_a_channel_that_nobody_knows(tmp_path: Path, monkeypatch: Patch, capsys: Captured) -> None:
    scenario = _rig(tmp_path)
    _edited(tmp_path / "run" / "recording.yaml", ("unit: m", "unit: span"), ("noise: 1 mm", "noise: 1 span"))
    said = _refusal(scenario, monkeypatch, capsys)
    assert "channels.rig.position" in said
    assert "span" in said


def test_an_fmu_that_has_no_model_exchange(tmp_path: Path, monkeypatch: Patch, capsys: Captured) -> None:
    flags = 'canGetAndSetFMUstate="true" canSerializeFMUstate="true"'
    scenario = _rig(tmp_path, (f'<ModelExchange modelIdentifier="oscillator" {flags}/>', ""))
    said = _refusal(scenario, monkeypatch, capsys)
    assert "Model Exchange" in said or "ModelExchange" in said
    assert "internal" in said


def test_an_algorithm_that_repeats_steps_of_an_fmu_without_state_access(
    tmp_path: Path, monkeypatch: Patch, capsys: Captured
) -> None:
    scenario = _rig(tmp_path, ('canGetAndSetFMUstate="true" canSerializeFMUstate="true"', ""), integrator="internal")
    _edited(scenario, ("components:", "algorithm: {kind: step_doubling}\ncomponents:"))
    said = _refusal(scenario, monkeypatch, capsys)
    assert "rig (CoSimulationUnit) cannot return to a saved state" in said


def test_an_fmu_without_state_access_is_searched_all_the_same(tmp_path: Path) -> None:
    """It is reset, which every FMU can be."""
    scenario = _rig(tmp_path, ('canGetAndSetFMUstate="true" canSerializeFMUstate="true"', ""), integrator="internal")
    model = _model(scenario)
    assert not model.slow
    assert {"input_saturation", "output_offset"} <= {t.identifier for t in model.terms()}


def test_an_fmu_that_cannot_be_reset_is_not_searched_and_that_is_said(tmp_path: Path) -> None:
    reset = "API fmi2Status fmi2Reset(fmi2Component c) { reset(c); return fmi2OK; }"
    model = _model(_rig(tmp_path, (reset, "API fmi2Status fmi2Reset(fmi2Component c) { (void)c; return fmi2Error; }")))
    (said,) = model.untried
    assert "laws of FMUs need compiled code, which does not simulate this system" in said
    assert "an FMU cannot be reset" in said


def test_an_fmu_that_is_not_as_new_after_a_reset_is_not_searched_and_that_is_said(tmp_path: Path) -> None:
    reset = "API fmi2Status fmi2Reset(fmi2Component c) { reset(c); return fmi2OK; }"
    worn = (
        "static int resets; API fmi2Status fmi2Reset(fmi2Component c) "
        "{ reset(c); ((Model *)c)->p[0] *= 1.0 + 1e-3 * ++resets; return fmi2OK; }"
    )
    (said,) = _model(_rig(tmp_path, (reset, worn))).untried
    assert "an FMU that was reset is not as a new one" in said


def test_states_of_an_unknown_unit_are_named_with_what_was_not_tried(tmp_path: Path) -> None:
    model = _model(_rig(tmp_path, ('unit="m/s"/>', 'unit="knots_of_ours"/>'), ('<Unit name="m/s"/>', "")))
    assert any("`rig.v` has a unit or a name that no formula can use" in text for text in model.untried)
    assert not [t for t in model.terms() if t.identifier == "dry_friction"]


def test_states_that_the_description_does_not_tell_are_named(tmp_path: Path) -> None:
    model = _model(_rig(tmp_path, ('derivative="7"', ""), ('derivative="8"', "")))
    assert any("`rig` does not say which variables its states are" in text for text in model.untried)


#: Derivatives that fail beyond a stiffness that only a search asks for.
_FAILS = (
    "rates(m->time, m->p, m->x, m->u, m->d);\n    memcpy(d, m->d",
    "if (m->p[0] > 430.0) { return fmi2Error; }\n    rates(m->time, m->p, m->x, m->u, m->d);\n    memcpy(d, m->d",
)


def test_an_fmu_that_fails_at_some_values_of_a_search_fails_there_alone(tmp_path: Path) -> None:
    model = _model(_rig(tmp_path, _FAILS))
    stiffness = next(i for i, p in enumerate(model.parameters) if p.name == "rig.k")
    base = np.zeros((3, len(model.parameters)))
    base[1, stiffness] = 2.0  # 10 % stiffer: the FMU returns an error
    first, failed, again = model.residuals([Point(b) for b in base])
    assert np.isinf(failed).all()
    assert np.isfinite(first).all()
    np.testing.assert_array_equal(first, again)


def test_a_diagnosis_goes_on_where_the_fmu_fails_at_some_values(
    tmp_path: Path, monkeypatch: Patch, capsys: Captured
) -> None:
    scenario = _rig(tmp_path, _FAILS)
    given = [
        "cosim",
        "diagnose",
        str(scenario),
        "--recording",
        str(tmp_path / "run"),
        "--out",
        str(tmp_path / "a"),
        "--brief",
    ]
    monkeypatch.setattr("sys.argv", given)
    with pytest.raises(SystemExit) as ended:
        main()
    assert not ended.value.code
    assert "Traceback" not in capsys.readouterr().err


def test_an_fmu_that_fails_from_the_start_is_told_with_the_reason(
    tmp_path: Path, monkeypatch: Patch, capsys: Captured
) -> None:
    """It fails at 1 s in every run: what the answer rests on is said, and no law is accepted."""
    stops = _FAILS[0], _FAILS[1].replace("m->p[0] > 430.0", "m->time > 1.0")
    scenario = _rig(tmp_path, stops)
    given = ["cosim", "diagnose", str(scenario), "--recording", str(tmp_path / "run"), "--out", str(tmp_path / "a")]
    monkeypatch.setattr("sys.argv", given)
    with pytest.raises(SystemExit) as ended:
        main()
    said = re.sub(r"\s+", " ", "".join(capsys.readouterr()))
    assert "Traceback" not in said
    assert "rig" in said
    assert ended.value.code in (0, 2)
    assert "the FMU" in said or "stopped" in said or "stops" in said
