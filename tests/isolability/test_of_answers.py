"""What channels of a fabric show and tell apart, and what others would add; answers are drawn, with known patterns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from cosim.scenario import load_scenario
from diagnosis.candidates.registry import catalogue
from diagnosis.isolability.of_answers import _told, of_answers
from diagnosis.models.answers import Answers
from diagnosis.models.build import model_of
from diagnosis.models.fabric.model import FabricModel
from diagnosis.models.fabric.scatter import Bins
from diagnosis.models.fabric.search import Effort, _Plan
from diagnosis.search.problem import Term, TermParameter
from diagnosis.search.search import Settings
from tests.fabric_diagnosis.fabrics import DRAPE, laws_but, made

CHANNELS, TIMES = 12, 8
CHANNEL = np.tile(np.arange(CHANNELS), TIMES)
TIME = np.repeat(np.linspace(0.0, 1.0, TIMES), CHANNELS)
#: Channels 0 to 5 are recorded, 6 to 8 are seen from above, 9 to 11 from the side.
ABOVE, SIDE = (CHANNEL >= 6) & (CHANNEL < 9), CHANNEL >= 9
EXTRA = np.where(ABOVE, "places from above", np.where(SIDE, "places from the side", "")).astype(object)
SCATTER, NOISE = 4e-5, 1.5e-4
BINS = Bins(
    CHANNEL,
    TIME,
    np.zeros(len(TIME), dtype=int),
    np.where(ABOVE, 1, np.where(SIDE, 2, 0)),
    np.full(len(TIME), NOISE),
    np.full(len(TIME), 1e-2),
)


def term(name: str, plausible: float = 1.0) -> Term:
    number = TermParameter(name, "rad", -10.0, 10.0, (0.3,), plausible=plausible)
    return Term(name, "fabric", "mechanical", (number,))


def pattern(kind: int, where: np.ndarray) -> np.ndarray:
    drawn = np.random.default_rng(100 + kind).standard_normal(CHANNELS)[CHANNEL]
    return np.where(where, TIME * drawn, 0.0)


def runs(count: int, seed: int, change: np.ndarray | float = 0.0) -> np.ndarray:
    """Fabrics whose channels are off by amounts that stay."""
    drawn = np.random.default_rng(seed).standard_normal((count, CHANNELS))
    return 0.05 + SCATTER * drawn[:, CHANNEL] + change


def answers(changes: Mapping[str, np.ndarray], seed: int = 0, slope: np.ndarray | None = None) -> Answers:
    """Each effect simulated at 0.3 from three starts, its change at the size that is believed as given."""
    effects = {
        term(name): {0.3: runs(3, 1000 * seed + 10 + i, 0.3 * change)}
        for i, (name, change) in enumerate(changes.items())
    }
    slopes = np.zeros((1, len(TIME))) if slope is None else slope[None, :]
    return Answers(BINS, EXTRA, runs(8, 1000 * seed), None, slopes, effects, ("fabric.link_mass",))


def test_an_effect_that_is_seen_from_above_alone_is_not_shown_and_that_view_would_help() -> None:
    recorded = EXTRA == ""
    told = of_answers(answers({"roll": pattern(1, ABOVE) * 5e-3, "tilt": pattern(2, recorded) * 5e-3}))
    assert told.statements[0].endswith("do not show, up to the size that is believed at most: roll (1 rad).")
    assert [e.channel for e in told.extra_channels] == ["places from above"]
    assert told.statements[-1] == "Other channels that would help are places from above: they would show roll (1 rad)."


def test_effects_of_one_pattern_are_told_apart_by_the_view_in_which_they_differ() -> None:
    recorded = EXTRA == ""
    same, other = pattern(3, recorded) * 5e-3, pattern(4, SIDE) * 5e-3
    told = of_answers(answers({"tilt": same, "payload": same + other}))
    assert told.statements == (
        "These channels hardly tell apart: tilt (1 rad) and payload (1 rad).",
        "Other channels that would help are places from the side: they would tell tilt (1 rad) from payload (1 rad).",
    )


def test_what_recalibration_does_as_well_is_said() -> None:
    recorded = EXTRA == ""
    change = pattern(5, recorded) * 5e-3
    told = of_answers(answers({"payload": change}, slope=change))
    assert told.statements == (
        "These channels do not show, up to the size that is believed at most: "
        "payload (1 rad) as recalibrating fabric.link_mass does the same.",
    )


def test_effects_that_do_nothing_are_not_shown_whatever_contacts_scatter_by() -> None:
    """Sizes without the products of a start with itself: means over few starts would show what scatters."""
    nothing = dict.fromkeys(("roll", "tilt", "payload"), np.zeros(len(TIME)))
    hidden = 0
    for seed in range(20):
        whole = answers(nothing, seed)
        told = _told(whole, [(t, 0.3) for t in whole.effects], "")
        assert not any(told.shows(i) for i in range(3))
        hidden += sum(told.hides(i) for i in range(3))
    assert hidden >= 30  # of 60; few starts leave the others open


def test_an_effect_that_was_simulated_once_is_not_judged() -> None:
    whole = answers({"tilt": pattern(2, EXTRA == "") * 5e-3})
    once = {t: {s: rows[:1] for s, rows in own.items()} for t, own in whole.effects.items()}
    assert of_answers(replace(whole, effects=once)).statements == ()


@pytest.mark.slow
def test_heights_of_a_drape_hardly_show_roll_and_a_camera_from_above_would_help(tmp_path) -> None:
    """Gravity across the fabric moves markers across it; heights and places along it stay."""
    drape = load_scenario(DRAPE)
    recording = made(tmp_path / "run", 1, [f"marker[{i}].z" for i in range(5, 9)], drape)
    model = model_of(drape, [recording], catalogue(), without=laws_but("roll", "payload"))
    assert isinstance(model, FabricModel)
    plan = _Plan(model, Settings(), Effort(8, 3, 2, others=0), lambda text: None)
    plan.anchor()
    plan.answers()
    assert model.answers is not None
    told = of_answers(model.answers)
    assert told.extra_channels[0].channel.startswith("places of the markers across")
    assert "roll (0.25 rad)" in told.extra_channels[0].statement
