"""`cosim play`: what it takes, what it refuses, what it writes."""

import json
import shutil

import pytest
import xarray as xr
import yaml
from typer.testing import CliRunner

from chainmail.play import play as play_in_notebook
from cosim.cli import app

from .test_page import content

FINDING = {
    "place": "coil[2,3]",
    "elements": ["coil[2,3]"],
    "intervals": [[0.05, 0.1], [0.15, None]],
    "is_accepted": True,
    "statement": "coil[2,3] is open",
}


def is_one_clear_error(answer):
    assert answer.code == 2
    assert answer.err.count("error:") == 1, answer.err
    assert "remedy:" in answer.err
    assert "Traceback" not in answer.err
    return True


@pytest.fixture
def recording(run_folder, tmp_path):
    folder = tmp_path / "camera"
    wanted = "marker[*].y marker[*].z fabric.max_curvature coil[1].tension"
    answer = CliRunner().invoke(
        app,
        ["record", str(run_folder), "--out", str(folder), "--channels", wanted, "--sensor", str(_sensors(tmp_path))],
    )
    assert answer.exit_code == 0, answer.output
    return folder


def _sensors(folder):
    path = folder / "sensors.yaml"
    path.write_text("default: {rate: 100 Hz}\n")
    return path


@pytest.fixture
def diagnosis(tmp_path):
    folder = tmp_path / "answer"
    folder.mkdir()
    far = {**FINDING, "place": "supply", "elements": ["supply"], "intervals": [], "is_accepted": False}
    content = {"verdict": "missing physics", "findings": [FINDING, far]}
    (folder / "diagnosis.json").write_text(json.dumps(content))
    return folder


def test_a_run_becomes_one_page_in_its_folder(run_folder, play):
    answer = play(run_folder)
    page = run_folder / "play.html"
    assert answer.code == 0, answer.err
    assert f"{page}: " in answer.out
    film, blocks = content(page.read_text())
    assert film["fabrics"][0]["links"] == 9
    assert blocks[film["fabrics"][0]["times"]].shape == (1, 21)
    assert [p["title"] for p in film["plots"]] == ["Maximum curvature", "Fabric length"]


def test_recorded_markers_and_findings_are_laid_over_a_run(run_folder, recording, diagnosis, play, tmp_path):
    page = tmp_path / "all.html"
    answer = play(run_folder, recording, diagnosis, "--out", page)
    assert answer.code == 0, answer.err
    film, blocks = content(page.read_text())
    (mark,) = film["marks"]
    assert [p["number"] for p in mark["points"]] == [1, 2, 3, 4, 5, 6]
    assert [axis is not None for axis in mark["points"][0]["axes"]] == [False, True, True]
    with xr.open_dataset(run_folder / "results.nc") as results:
        there = results["fabric.marker_position"].values[:, 3, 2]
    found = blocks[mark["points"][3]["axes"][2]["values"]][0]
    assert found == pytest.approx(there, abs=2e-5)  # a step of recorded coordinates
    first, second = film["findings"]
    assert first["links"] == [4]  # coil 3 of row 2: second link of the second row
    assert first["intervals"] == [[0.05, 0.1]]  # an end that is not known is no interval
    assert (second["links"], second["isAccepted"]) == ([], False)
    assert "`supply` is at no link of this fabric" in answer.out
    assert "1 recorded channels are not shown (coil[1].tension)" in answer.out
    assert "x of its points was not recorded" in answer.out
    assert {c["mark"] for p in film["plots"] for c in p["curves"]} == {None, 0}


def test_two_runs_of_one_scenario_are_told_apart_by_their_folders(run_folder, play, tmp_path):
    other = tmp_path / "second"
    shutil.copytree(run_folder, other)
    answer = play(run_folder, other, "--out", tmp_path / "two.html")
    assert answer.code == 0, answer.err
    film, _ = content((tmp_path / "two.html").read_text())
    assert [f["title"].split("(")[-1] for f in film["fabrics"]] == ["run)", "second)"]
    assert {c["fabric"] for c in film["plots"][0]["curves"]} == {0, 1}


def test_fabrics_that_differ_are_both_shown_and_it_is_said(run_folder, play, tmp_path):
    other = tmp_path / "narrow"
    shutil.copytree(run_folder, other)
    with xr.open_dataset(run_folder / "results.nc") as stored:
        whole = stored.load()
    first = whole.isel(link=slice(0, 6), coil=slice(0, 12), marker=slice(0, 4), row=slice(0, 2))
    first.assign_attrs(title="two rows").to_netcdf(other / "results.nc")
    answer = play(run_folder, other, "--out", tmp_path / "two.html")
    assert answer.code == 0, answer.err
    assert "has 3 rows of 3 links, two rows has 2 rows of 3 links" in answer.out
    assert [f["links"] for f in content((tmp_path / "two.html").read_text())[0]["fabrics"]] == [9, 6]


def test_an_interrupted_run_is_shown_up_to_where_it_came(run_folder, play, tmp_path):
    other = tmp_path / "stopped"
    shutil.copytree(run_folder, other)
    with xr.open_dataset(run_folder / "results.nc") as stored:
        cut = stored.load().isel(time=slice(0, 11)).assign_attrs(status="interrupted at t = 0.1 s")
    cut.to_netcdf(other / "results.nc")
    answer = play(other)
    assert answer.code == 0
    assert "the run did not reach its end: interrupted at t = 0.1 s" in answer.out


def test_a_run_without_results_says_how_to_go_on(run_folder, play, tmp_path):
    other = tmp_path / "killed"
    shutil.copytree(run_folder, other)
    (other / "results.nc").unlink()
    answer = play(other)
    assert is_one_clear_error(answer)
    assert f"cosim run {other} --resume" in answer.err


def test_a_run_without_a_fabric_is_refused(run_folder, play, tmp_path):
    other = tmp_path / "coils"
    shutil.copytree(run_folder, other)
    xr.Dataset({"a.temperature": ("time", [300.0])}, {"time": [0.0]}).to_netcdf(other / "results.nc")
    assert is_one_clear_error(answer := play(other))
    assert "hold no fabric" in answer.err


def test_damaged_results_are_refused(run_folder, play, tmp_path):
    other = tmp_path / "damaged"
    shutil.copytree(run_folder, other)
    (other / "results.nc").write_bytes(b"CDF and nothing else")
    assert is_one_clear_error(play(other))


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["nowhere"], "there is no such folder"),
        (["."], "it holds no run (results.nc), no recording (recording.yaml) and no diagnosis"),
        (["run", "--out", "page.txt"], "does not end in .html"),
        (["run", "--gif", "film.mp4"], "does not end in .gif"),
        (["run", "--mp4", "film.gif"], "does not end in .mp4"),
        (["run", "--gif", "film.gif", "--speed", "-1"], "-1 is no speed"),
        (["run", "--gif", "film.gif", "--colour", "temperature"], "give one of: tension, extension, link length"),
        (["run", "--gif", "film.gif", "--view", "below"], "there is no view `below`"),
    ],
)
def test_what_cannot_be_shown_is_one_clear_error(arguments, told, run_folder, play, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    answer = play(*[run_folder if a == "run" else a for a in arguments])
    assert is_one_clear_error(answer)
    assert told in answer.err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("option", ["--out", "--gif", "--mp4"])
def test_a_place_that_cannot_be_written_is_named(option, run_folder, play, tmp_path):
    if option == "--mp4":
        pytest.importorskip("imageio_ffmpeg")
    (tmp_path / "file").write_text("mine")
    ending = {"--out": "html"}.get(option, option[2:])
    answer = play(run_folder, option, tmp_path / "file" / f"page.{ending}", "--width", "200", "--speed", "1")
    assert is_one_clear_error(answer)
    assert f"page.{ending}: it cannot be written" in answer.err
    assert (tmp_path / "file").read_text() == "mine"


def test_recordings_and_diagnoses_need_a_run(diagnosis, play):
    assert is_one_clear_error(answer := play(diagnosis))
    assert "there is no run among what was given" in answer.err


@pytest.mark.parametrize("text", ["", "[]", '{"findings": []}', '{"verdict": "x", "findings": [{"place": 1}]}'])
def test_a_diagnosis_that_is_none_is_refused(text, run_folder, diagnosis, play, tmp_path):
    (diagnosis / "diagnosis.json").write_text(text)
    assert is_one_clear_error(play(run_folder, diagnosis, "--out", tmp_path / "a.html"))
    assert not (tmp_path / "a.html").exists()


def test_a_recorded_point_far_away_is_a_wrong_unit(run_folder, recording, play, tmp_path):
    file = recording / "recording.yaml"
    content = yaml.safe_load(file.read_text())
    content["channels"]["marker[2].z"]["unit"] = "km"
    content["channels"]["marker[2].z"]["factor"] = 1e6
    file.write_text(yaml.safe_dump(content))
    assert is_one_clear_error(answer := play(run_folder, recording, "--out", tmp_path / "a.html"))
    assert "channels.marker[2].z: it reads" in answer.err


def test_a_gif_alone_writes_no_page(run_folder, play, tmp_path):
    answer = play(run_folder, "--gif", tmp_path / "new" / "film.gif", "--width", "200", "--speed", "0.5")
    assert answer.code == 0, answer.err
    assert "film.gif: 6 pictures" in answer.out
    assert not (tmp_path / "play.html").exists()


def test_a_notebook_shows_a_dataset_and_a_run_folder(run_folder, tmp_path):
    with xr.open_dataset(run_folder / "results.nc") as stored:
        results = stored.load()
    player = play_in_notebook(results, run_folder, height=400)
    shown = player._repr_html_()
    assert shown.startswith("<iframe")
    assert "height: 400px" in shown
    # nothing of the page ends the attribute that holds it
    assert shown.count('"') == 6
    assert "<script" not in shown
    saved = player.save(tmp_path / "saved.html")
    assert len(content(saved.read_text())[0]["fabrics"]) == 2
