"""Runs of designs in Bullet itself, on the smallest fabric: nine links, of which three are free."""

from __future__ import annotations

import pytest

from chainmail.design.candidate import Candidate, Pulse, rig_of, scenario_for
from chainmail.design.command import write_page
from chainmail.design.ledger import BudgetSpent, Ledger
from chainmail.design.task import load_task
from cosim.compute.batch import Batches
from cosim.compute.cache import Cache
from cosim.compute.cluster import Here
from tests.design.test_design import EXAMPLES, TASK

#: Heated for a fifth of a second only: what is looked at here is the record of runs, not what they say.
SHORT = Candidate((Pulse(3, 10.0, 300.0, 2.5, 2.7, 9.0),), 296.0, 2.5, 2.8)


def _ledger(folder, coarse=3):
    text = (EXAMPLES / "eight_rows.yaml").read_text().replace("rows: 8", "rows: 3")
    for many, three in (("[6, 6, 6, 6, 6, 6, 6, 6]", "[6, 6, 6]"), (f"[{', '.join(['0 V'] * 8)}]", "[0 V, 0 V, 0 V]")):
        assert many in text
        text = text.replace(many, three)
    (folder / "eight_rows.yaml").write_text(text)
    path = folder / "task.yaml"
    path.write_text(TASK.replace("at: 15 s", "at: 2.8 s").replace("coarse: 40, full: 20", f"coarse: {coarse}, full: 1"))
    task, scenario = load_task(path)
    return Ledger(task, rig_of(scenario, path), Batches(Here(), Cache(folder / "runs")))


@pytest.mark.slow
def test_runs_are_on_the_record_and_a_first_design_is_run_coarse_and_fine(tmp_path):
    ledger = _ledger(tmp_path)
    first = ledger.judged(SHORT)
    assert first.fidelity == "fine"
    assert [e.fidelity for e in ledger.entries] == ["coarse", "fine"]
    for entry in ledger.entries:
        assert not entry.failure
        # 10 V on six coils of 2.2 ohm for 0.2 s.
        assert entry.energy == pytest.approx(100.0 / 13.2 * 0.2, rel=1e-6)
        assert entry.values[1] == pytest.approx(100.0 / 13.2, rel=1e-9)
        assert 0.0 < entry.overlap < 1.5e-3
        assert abs(entry.values[0]) < 0.03
    assert len(ledger.pairs()) == 1
    assert ledger.table().count("\n") == 3
    assert ledger.batches.made == 2
    with pytest.raises(BudgetSpent, match="1 full runs"):
        ledger.full_batch(SHORT, (1001,))


@pytest.mark.slow
def test_the_page_shows_the_design_move(tmp_path):
    ledger = _ledger(tmp_path)
    out = tmp_path / "out"
    out.mkdir()
    write_page(scenario_for(SHORT, ledger.rig), out)
    text = (out / "play.html").read_text()
    assert "20 g at the tip" in text or "2 x 8" in text  # the title of the run
    assert (out / "winner" / "results.nc").is_file()
