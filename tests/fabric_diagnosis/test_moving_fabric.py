"""The fabric in motion within a report: which runs are shown, and what happens where one stops."""

from __future__ import annotations

import json
import re
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml

from cosim.run import RunStopped, run
from cosim.scenario import load_scenario, scenario_folder
from diagnosis.judge.diagnosis import Verdict
from diagnosis.recording.recording import load_recording
from diagnosis.report.moving_fabric import MovingFabric, moving_fabric
from diagnosis.report.page import write_html
from tests.diagnosis.report_examples import diagnosis
from tests.fabric_diagnosis.test_refuted_finding import recorded, tiny
from tests.play.browser import Browser, chromium


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A scenario, the same with another tilt and with a limit of overlap that no run keeps, and a recording."""
    made = tmp_path_factory.mktemp("fabric")
    shutil.copytree(scenario_folder() / "parameter_sets", made / "parameter_sets")
    text = tiny().to_yaml(True)
    (made / "scenario.yaml").write_text(text, encoding="utf-8")
    for name, change in {
        "amended": {"parameters": {"tilt": "0.1 rad"}},
        "stops": {"solver": {"penetration_limit": "1 nm"}},
    }.items():
        data = yaml.safe_load(text)
        for key, values in change.items():
            data["components"]["fabric"].setdefault(key, {}).update(values)
        (made / f"{name}.yaml").write_text(yaml.safe_dump(data, sort_keys=False), encoding="utf-8")
    recorded(made / "monday", 1, tilt="0.1 rad")
    return made


def found(folder: Path, amended: str | None = None):
    return replace(
        diagnosis(Verdict.MISSING_PHYSICS), amended_model=None if amended is None else str(folder / f"{amended}.yaml")
    )


def shown(folder: Path, scenario: str, amended: str | None) -> MovingFabric | None:
    return moving_fabric(
        found(folder, amended), load_scenario(folder / f"{scenario}.yaml"), load_recording(folder / "monday")
    )


def test_the_amended_model_is_in_colours_and_the_scenario_an_outline(folder):
    moving = shown(folder, "scenario", "amended")
    assert moving is not None
    assert moving.shown == ("amended model", "scenario as it was")
    assert moving.stopped == ()
    assert "monday" in moving.page
    # The times of a finding are those of its own recording, which this one need not be.
    (film,) = re.findall('id="film">(.*?)</script>', moving.page, re.DOTALL)
    findings = json.loads(film)["findings"]
    assert [f["intervals"] for f in findings] == [[], []]


def test_what_stops_is_named_with_its_reason_and_the_other_is_shown(folder, tmp_path):
    moving = shown(folder, "scenario", "stops")
    assert moving is not None
    assert moving.shown == ("scenario as it was",)
    (reason,) = moving.stopped
    assert reason.startswith("amended model: the run stopped: ")
    assert "overlap" in reason
    write_html(found(folder), [], tmp_path / "report.html", moving=moving)
    text = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "Not shown: amended model: the run stopped" in text
    assert "<iframe" in text
    assert "as an outline" not in text


def test_where_every_run_stops_there_is_no_picture_and_no_script(folder, tmp_path):
    moving = shown(folder, "stops", None)
    assert moving is not None
    assert (moving.page, moving.shown, len(moving.stopped)) == ("", (), 1)
    write_html(found(folder), [], tmp_path / "report.html", moving=moving)
    text = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "Not shown: scenario as it was: the run stopped" in text
    assert "<iframe" not in text
    assert "script-src" not in text


def test_ctrl_c_ends_the_picture_and_not_the_answer(folder, tmp_path, monkeypatch):
    made = []

    def first_alone(scenario):
        if made:
            raise RunStopped("interrupted at t = 0.1 s", None, is_interrupt=True)
        made.append(run(scenario))
        return made[0]

    monkeypatch.setattr("diagnosis.report.moving_fabric.run", first_alone)
    moving = shown(folder, "scenario", "amended")
    assert moving is not None
    assert moving.shown == ("amended model",)
    assert moving.stopped == ("scenario as it was: the run stopped: interrupted at t = 0.1 s",)
    write_html(found(folder), [], tmp_path / "report.html", moving=moving)
    assert "Not shown: scenario as it was: the run stopped: interrupted" in (tmp_path / "report.html").read_text()


def test_a_marker_that_reads_kilometres_costs_the_picture_and_not_the_answer(folder):
    whole = load_recording(folder / "monday")
    name, channel = next((n, c) for n, c in whole.channels.items() if n.startswith("marker"))
    far = replace(whole, channels={**whole.channels, name: replace(channel, values=channel.values + 2000.0)})
    moving = moving_fabric(found(folder), load_scenario(folder / "scenario.yaml"), far)
    assert moving is not None
    assert (moving.page, moving.shown) == ("", ())
    (reason,) = moving.stopped
    assert reason.startswith(f"channels.{name}: it reads 200")


def test_a_scenario_without_a_fabric_has_no_picture(folder):
    scenario = load_scenario("single_coil_heating")
    assert moving_fabric(found(folder), scenario, load_recording(folder / "monday")) is None


@pytest.mark.slow
@pytest.mark.skipif(chromium() is None, reason="there is no Chromium")
def test_a_browser_runs_the_picture_and_no_other_script(folder, tmp_path):
    moving = shown(folder, "scenario", "amended")
    assert moving is not None
    path = tmp_path / "report.html"
    write_html(found(folder), [], path, moving=moving)
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("<body>", "<body><script>document.title = 'taken over'</script>"), encoding="utf-8")
    with Browser() as browser:
        browser.size(1200, 900)
        browser.call("Page.navigate", url=path.as_uri())
        browser.until("location.protocol === 'file:' && !!document.querySelector('iframe.moving')")
        inside = "document.querySelector('iframe.moving').contentDocument?.documentElement?.dataset"
        assert browser.until(f"{inside}?.ready || {inside}?.failed")
        assert not browser.evaluate(f"{inside}?.failed || ''")
        assert browser.evaluate("document.title") != "taken over"
        canvas = "document.querySelector('iframe.moving').contentWindow.player.scene.canvas"
        assert np.all(np.array(browser.evaluate(f"[{canvas}.width, {canvas}.height]")) > 100)
