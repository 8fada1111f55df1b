"""Findings on a fabric: which links and coils their places mean, and the way from a report to the page."""

import json
from dataclasses import replace

import pytest

from chainmail.play.from_diagnosis import findings_of
from diagnosis.judge.diagnosis import Verdict
from diagnosis.report.json_file import write_json
from diagnosis.report.network import Network
from diagnosis.report.page import write_html
from tests.diagnosis.report_examples import diagnosis, fit

from .films import fabric


def places(folder, place, elements=()):
    entry = {"place": place, "elements": list(elements), "intervals": [], "is_accepted": True, "statement": "it is"}
    (folder / "diagnosis.json").write_text(json.dumps({"verdict": "missing physics", "findings": [entry]}))
    (finding,), notes = findings_of(folder, fabric())
    return set(finding.links), set(finding.coils), notes


@pytest.mark.parametrize(
    ("place", "links", "coils"),
    [
        ("coil[1,1]", {0}, {0}),
        ("coil[4,3]", {10}, {20}),  # row 4 begins at coil 18; its third coil is in its second link
        ("coil[36]", {17}, {35}),
        ("coil[2,5].temperature", {5}, {10}),
        ("coil[1,6] and coil[2,1]", {2, 3}, {5, 6}),
        ("string[6]", {15, 16, 17}, set()),
        ("link[7]", {6}, set()),
        ("marker[12].z", {17}, set()),
        ("marker[1]", {2}, set()),
        ("all coils", set(range(18)), set()),
        ("all coils on one day", set(range(18)), set()),
        ("fabric", set(range(18)), set()),
        ("supply", set(), set()),
        ("coil[7,1]", set(), set()),  # there are six rows
        ("coil[0,1]", set(), set()),
        ("coil[2,7]", set(), set()),
        ("coil[37]", set(), set()),
        ("link[19]", set(), set()),
        ("string[9]", set(), set()),
    ],
)
def test_a_place_means_these_links(place, links, coils, tmp_path):
    found = places(tmp_path, place)
    assert found[:2] == (links, coils)
    assert any("at no link of this fabric" in note for note in found[2]) == (not links)


def test_where_the_place_names_no_element_the_elements_do(tmp_path):
    links, coils, _ = places(tmp_path, "ends of the strings", ["coil[1,1]", "coil[1,6]"])
    assert (links, coils) == ({0, 2}, {0, 5})


def test_what_a_diagnosis_writes_is_read(tmp_path):
    write_json(diagnosis(Verdict.MISSING_PHYSICS), tmp_path / "diagnosis.json")
    (contact, mass), notes = findings_of(tmp_path, fabric())
    assert contact.links == (6, 7, 8)
    assert contact.intervals == ((5.0, 42.5), (60.0, 88.0))
    assert mass.links == (5,)
    assert "verdict `missing physics`, 2 findings" in notes[0]


@pytest.mark.parametrize("channel", ["marker[3].z", "fabric.max_curvature", "coil[1,1].temperature"])
def test_the_report_of_a_fabric_says_how_to_see_its_findings_move(channel, tmp_path):
    found = diagnosis(Verdict.MISSING_PHYSICS)
    write_html(replace(found, fit=(fit(channel, "m", 1.0, True),)), [], tmp_path / "report.html", Network((6,) * 6))
    told = "<code>cosim play RUN FOLDER</code>" in (tmp_path / "report.html").read_text()
    assert told == (not channel.startswith("coil"))
