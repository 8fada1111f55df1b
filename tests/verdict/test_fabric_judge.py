"""A fabric that judges is simulated, never fitted: whatever is asked of it must not need a fit."""

from __future__ import annotations

from pathlib import Path

import pytest

from cosim.unit.errors import InputError
from diagnosis.candidates.registry import catalogue
from diagnosis.judge.of_a_day import is_shown_there_alone
from diagnosis.models.build import models_of
from diagnosis.models.fabric.model import FabricModel
from tests.fabric_diagnosis.fabrics import small, still


def test_whether_a_held_out_fabric_shows_what_its_coils_lack_is_asked_of_the_coils(tmp_path: Path) -> None:
    training = FabricModel(small(), [still(tmp_path / "monday")], catalogue())
    held_out = [still(tmp_path / "tuesday")]
    judge = FabricModel(small(), held_out, catalogue(), timeline=training.timeline)
    assert not judge.can_be_fitted
    events = {
        t.identifier: t
        for t in training.terms()
        if any(p.is_instant for p in t.parameters) and t.identifier == "open_coil"
    }
    term = events["open_coil"]
    early = tuple(0.1 if p.is_instant else p.starts[0] for p in term.parameters)
    assert not is_shown_there_alone(term, early, training, judge)  # open ever since: the other day shows it too


def test_a_first_stretch_of_a_held_out_fabric_is_refused_before_any_simulation(tmp_path: Path) -> None:
    training, held_out = still(tmp_path / "monday"), still(tmp_path / "tuesday", beginning="0.2 s")
    with pytest.raises(InputError, match="beginning"):
        models_of(small(), [training], [held_out], catalogue())
