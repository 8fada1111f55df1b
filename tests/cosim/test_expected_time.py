"""A fabric that takes minutes says so before it begins."""

from __future__ import annotations

import pytest

from cosim.cli import main
from cosim.expected_time import announcement, expected_time
from cosim.scenario import load_scenario


def test_the_time_goes_with_free_links_micro_steps_and_starts():
    small = expected_time(load_scenario("passive_drape"))
    # 8 x 2 links less two rows held; 5 rows of 4 columns less two rows held.
    wide = expected_time(load_scenario("passive_drape", ["fabric.rows=5", "fabric.columns=4"]))
    assert wide / small == pytest.approx((3 * 7 / (6 * 3)) ** 1.2)
    assert expected_time(load_scenario("passive_drape"), 12) == pytest.approx(12 * small)
    fine = expected_time(load_scenario("passive_drape", ["fabric.solver.micro_step=0.25 ms"]))
    assert fine == pytest.approx(2 * small)
    few = expected_time(load_scenario("passive_drape", ["fabric.solver.iterations=100"]))
    assert 0.5 * small < few < 0.7 * small
    assert expected_time(load_scenario("single_coil_heating")) == 0.0


def test_only_what_takes_minutes_is_announced_with_what_would_be_faster():
    assert announcement(load_scenario("single_coil_heating")) == ""
    assert announcement(load_scenario("passive_drape")) == ""
    said = announcement(load_scenario("prototype_cantilever"), 12, 2)
    assert said.startswith("18 links, 12 starts: about ")
    assert "--set fabric.engine=mujoco" in said
    large = announcement(load_scenario("large_row_by_row"))
    assert large.startswith("276 links: about ")
    assert "engine=mujoco" not in large  # there it is no faster


def test_a_large_run_is_announced_before_it_begins(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("cosim.cli.run_into", lambda *given: None)
    monkeypatch.setattr("sys.argv", ["cosim", "run", "large_row_by_row", "--no-plots"])
    with pytest.raises(SystemExit):
        main()
    assert capsys.readouterr().err.startswith("276 links: about ")
