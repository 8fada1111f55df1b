"""Truth for fabrics: its own weave against that of the unit, what the camera sees, and how answers are scored."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from evaluation.fabrics.__main__ import main as diagnose_draw
from evaluation.fabrics.score import page, score
from evaluation.proving.fabric import case as case_module
from evaluation.proving.fabric import truth
from evaluation.proving.fabric.case import RIGS, FabricCase, drawn_case, write_cases
from evaluation.proving.fabric.truth import COLUMNS, HELD, ROWS, Specimen, drape
from evaluation.proving.fabric.weave import Measures, weave
from mechanics.fabric import layout
from tests.mechanics.designs import prototype, woven_unit


def test_its_own_weave_lies_where_that_of_the_unit_lies():
    links, plan = weave(Measures(), ROWS, COLUMNS, HELD), layout(prototype(rows=ROWS))
    assert len(links) == len(plan.row)
    np.testing.assert_allclose([link.back for link in links], plan.back_bar, atol=1e-9)
    np.testing.assert_allclose([link.tilt for link in links], plan.tilt, atol=1e-7)
    np.testing.assert_allclose([link.distance for link in links], plan.bar_distance, atol=1e-9)
    assert [link.is_held for link in links] == plan.is_locked.tolist()


def test_markers_sit_where_the_unit_has_them():
    unit = woven_unit(prototype(rows=ROWS))
    found = drape(Specimen(), 0.0, 0.04, np.random.default_rng(0))
    np.testing.assert_allclose(found[0], unit.get("marker_position"), atol=1e-9)
    unit.terminate()


def test_a_lean_and_a_payload_move_the_free_end():
    def end(**effects):
        return drape(Specimen(effects=effects), 0.04, 0.04, np.random.default_rng(0))[-1, -1]

    plain = end()
    assert end(tilt=0.3)[1] < plain[1] - 1e-4  # the raised end slides back towards the tether
    assert end(roll=0.3)[0] - plain[0] > 1e-3
    assert end(payload=0.2)[2] < plain[2] - 2e-4


def seen(effect, strength=1.0):
    markers = np.arange(3 * 2 * ROWS * 3, dtype=float).reshape(3, 2 * ROWS, 3)
    case = FabricCase("x", "camera", effect, strength, Specimen())
    return markers[:, 2 * HELD :], case._seen(markers, np.random.default_rng(3))


def test_the_camera_exchanges_turns_and_loses_markers():
    plain, exchanged = seen("exchanged_markers")
    there = ~np.isnan(exchanged[:, :2]).any(axis=(1, 2))
    assert np.abs(exchanged[there][:, 0] - plain[there][:, 1]).max() < 2e-3
    plain, turned = seen("turned_camera", 0.1)
    there = ~np.isnan(turned)
    before, after = (np.hypot(m[..., 1], m[..., 2])[there[..., 1]] for m in (plain, turned))
    np.testing.assert_allclose(before, after, atol=2e-3)
    assert not np.allclose(plain[there], turned[there], atol=0.1)
    plain, slipped = seen("slipped_marker", 0.5)
    shift = (slipped - plain)[:, 1, 1]
    assert shift[0] == pytest.approx(0.0, abs=2e-3)
    assert shift[-1] == pytest.approx(0.5, abs=2e-3)
    many = np.concatenate([seen("")[1].ravel() for _ in range(3)])
    assert 0.0 <= np.isnan(many).mean() < 0.2


def test_a_draw_repeats_and_says_nothing_of_its_answer(tmp_path):
    one, other = (drawn_case("a", np.random.default_rng([1, 4])) for _ in range(2))
    assert one == other
    kinds = {drawn_case("a", np.random.default_rng([1, n])).kind for n in range(40)}
    assert kinds == {"null", "global", "local", "camera"}
    (name,) = write_cases(tmp_path, 1, 3, "camera")
    files = {p.name for p in (tmp_path / "cases" / name).rglob("*") if p.is_file()}
    assert files == {"scenario.yaml", "task.yaml", "recording.yaml", "camera.csv"}
    answer = json.loads((tmp_path / "answers" / f"{name}.json").read_text())
    text = "".join(p.read_text() for p in (tmp_path / "cases").rglob("*") if p.is_file())
    assert answer["effect"] not in text


@pytest.fixture
def one_effect(monkeypatch):
    """A rig whose one effect of all links is a payload, from one start."""
    monkeypatch.setattr(case_module, "STARTS", 1)

    def with_range(low, high):
        rig = replace(RIGS["drape"], stop=0.08, spread={"payload": (low, high, False)})
        monkeypatch.setitem(RIGS, "drape", rig)

    return with_range


def test_an_effect_that_hardly_moves_the_markers_is_drawn_again(one_effect):
    one_effect(1e-6, 0.1)
    rng = np.random.default_rng(2)
    case = drawn_case("a", rng, "global", "drape", 2e-4)
    assert case.moves >= 2e-4
    assert case.strength > 0.01
    assert np.isnan(drawn_case("a", rng, "global", "drape").moves)
    assert drawn_case("a", rng, "null", "drape", 2e-4).effect == ""  # nothing moves nothing, and is not drawn again


def test_a_draw_ends_where_no_effect_moves_the_markers(one_effect, monkeypatch):
    one_effect(1e-6, 2e-6)
    monkeypatch.setattr(case_module, "TRIES", 2)
    with pytest.raises(ValueError, match="none of 2 effects that were drawn moves the markers of drape by 5 mm"):
        drawn_case("a", np.random.default_rng(2), "global", "drape", 5e-3)


def told(tmp_path, truth, findings, code=0):
    """One case with an answer."""
    for folder in ("answers", "diagnoses/x/answer"):
        (tmp_path / folder).mkdir(parents=True, exist_ok=True)
    (tmp_path / "answers/x.json").write_text(json.dumps({"case": "x", **truth}))
    (tmp_path / "diagnoses/x/done.json").write_text(json.dumps({"code": code, "seconds": 1.0}))
    plain = {"is_accepted": True, "unit": "mechanical", "standing": "named", "ambiguous_with": [], "parameters": []}
    plain["place"] = "fabric"
    whole = [{**plain, **f} for f in findings]
    answer = {"findings": whole, "verdict": "missing physics", "adequacy": None}
    (tmp_path / "diagnoses/x/answer/diagnosis.json").write_text(json.dumps(answer))
    return score(tmp_path, "x")


NOTHING = {"kind": "null", "effect": "", "strength": 0.0}
TILT = {"kind": "global", "effect": "tilt", "strength": 0.1}
JAMMED = {"kind": "local", "effect": "jammed_link", "strength": 20.0, "link": 8, "row": 0}
COLD_ROW = {"kind": "local", "effect": "unheated_coil", "strength": 0.9, "link": 0, "row": 4}
TURNED = {"kind": "camera", "effect": "turned_camera", "strength": 0.05}


@pytest.mark.parametrize(
    ("truth", "findings", "false", "is_named", "is_in_class"),
    [
        (NOTHING, [], [], False, False),
        (NOTHING, [{"effect": "roll", "standing": "unnamed"}], ["roll"], False, False),
        (NOTHING, [{"effect": "roll", "is_accepted": False}], [], False, False),
        (NOTHING, [{"effect": "camera_scale", "unit": "measurement"}], ["camera_scale"], False, False),
        (TILT, [{"effect": "tilt"}], [], True, True),
        (TILT, [{"effect": "payload", "ambiguous_with": ["tilt"]}], [], False, True),
        (TILT, [{"effect": "payload"}], ["payload"], False, False),
        (JAMMED, [{"effect": "roll"}], ["roll"], False, False),
        (JAMMED, [{"effect": "jammed_link", "place": "fabric, link 8 (row 3, place 2)"}], [], True, True),
        (JAMMED, [{"effect": "jammed_link", "place": "fabric, link 7 (row 3, place 1)"}], ["jammed_link"], False, True),
        (JAMMED, [{"effect": "jammed_link", "place": "fabric, row 3"}], ["jammed_link"], False, True),
        (COLD_ROW, [{"effect": "unheated_coil", "place": "fabric, row 4"}], [], True, True),
        (TURNED, [{"effect": "turned_camera", "unit": "measurement"}], [], True, True),
        (TURNED, [{"effect": "tilt", "standing": "unnamed"}], ["tilt"], False, False),
        (JAMMED, [{"effect": "roll", "standing": "unnamed"}], [], False, False),
    ],
)
def test_what_a_false_claim_is(tmp_path, truth, findings, false, is_named, is_in_class):
    found = told(tmp_path, truth, findings)
    assert found["false"] == false
    assert found["is_named"] == is_named
    assert found["is_in_class"] == is_in_class


def test_a_page_counts_false_claims_and_cases_without_an_answer(tmp_path):
    wrong, right = told(tmp_path, NOTHING, [{"effect": "roll"}]), told(tmp_path, TILT, [{"effect": "tilt"}])
    failed = told(tmp_path, TILT, [], code=1)
    text = page([wrong, right, failed], 1, 3)
    assert "| false claims | 1 of 2 |" in text
    assert "| of them where nothing acts | 1 of 1 |" in text
    assert "| effects of all links named | 1 of 1 |" in text
    assert "1 of them without an answer" in text


#: What the small fabric is given, and the effects that may be named of it.
SHOWN = {
    "nothing": ({}, set()),
    "tilt": ({"tilt": 0.1}, {"tilt"}),
    "roll": ({"roll": 0.1}, {"roll"}),
    "slide friction": ({"slide_friction": 1.5}, {"slide_friction"}),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(SHOWN))
def test_nothing_false_is_said_of_a_small_fabric_from_another_engine(tmp_path, name):
    """About seventy simulations of 0.4 s."""
    effects, allowed = SHOWN[name]
    effect = next(iter(effects), "")
    case = FabricCase(
        "fabric_001", "global" if effects else "null", effect, effects.get(effect, 0.0), Specimen(effects=effects)
    )
    case.write(tmp_path / "cases", tmp_path / "answers", np.random.default_rng(15))
    assert diagnose_draw(["--cases", "1", "--rig", "drape", "--out", str(tmp_path)]) == 0
    found = score(tmp_path, "fabric_001")
    assert not found["failed"]
    assert found["false"] == []
    assert all(said.split()[0] in allowed for said in found["said"] if "(named)" in said)


def test_strong_damping_is_simulated_in_finer_steps(monkeypatch) -> None:
    """In steps of a quarter of a millisecond slides that are damped by 36 N s/m ran away, and became a recording."""
    damped = Specimen(effects={"viscous_damping": 36.0})
    places = drape(damped, 0.08, 0.04, np.random.default_rng(1))
    assert np.abs(places).max() < 0.3
    monkeypatch.setattr(truth, "LIGHT", np.inf)
    with pytest.raises(ValueError, match="runs away"):
        drape(damped, 0.08, 0.04, np.random.default_rng(1))
