"""Places of truths and findings, as sets of elements."""

from __future__ import annotations

from dataclasses import replace

import pytest

from evaluation.proof.answer import Concealed
from evaluation.proof.place import Rig, found_place, read_duration, read_rig, true_place
from tests.proof.examples import BATH, RADIATION, SMALL


@pytest.mark.parametrize(
    ("label", "elements"),
    [
        ("coil[2,3]", {"coil[2,3]"}),
        ("string[2]", {"coil[2,1]", "coil[2,2]", "coil[2,3]"}),
        ("supply", {"supply"}),
        ("all sources", {"supply"}),
        ("gradient over rows", {"row gradient"}),
        ("ends of the strings", {"coil[1,1]", "coil[1,3]", "coil[2,1]", "coil[2,3]"}),
        ("place 2 of every string", {"coil[1,2]", "coil[2,2]"}),
        ("every temperature", {"coil[1,1].temperature", "coil[2,3].temperature"}),
        ("every current", {"string[1].current"}),
        ("coil[1,1].temperature and coil[2,3].temperature", {"coil[1,1].temperature", "coil[2,3].temperature"}),
        ("hinge", {"hinge"}),
    ],
)
def test_a_label_of_the_catalogue_is_a_set_of_elements(label: str, elements: set[str]) -> None:
    assert found_place(label, SMALL) == elements


@pytest.mark.parametrize("label", ["all coils", "all strings"])
def test_all_of_them_are_all_coils(label: str) -> None:
    assert len(found_place(label, SMALL)) == 6
    assert found_place(label, SMALL) == found_place("string[1]", SMALL) | found_place("string[2]", SMALL)


def _truth(place: str, *elements: str, channels: tuple[str, ...] = ()) -> Concealed:
    return replace(RADIATION, place=place, elements=elements, channels=channels)


@pytest.mark.parametrize(
    ("truth", "label"),
    [
        (_truth("all"), "all coils"),
        (_truth("coil", "coil[1,2]"), "coil[1,2]"),
        (_truth("string", "string[1]"), "string[1]"),
        (_truth("column_gradient"), "gradient over columns"),
        (_truth("supply"), "supply"),
        (_truth("channel", channels=("string[1].current",)), "string[1].current"),
        (_truth("quantity", channels=("coil[1,1].temperature", "coil[2,3].temperature")), "every temperature"),
    ],
)
def test_the_place_of_a_truth_is_that_of_the_label_which_means_the_same(truth: Concealed, label: str) -> None:
    assert true_place(truth, SMALL) == found_place(label, SMALL)


def test_other_coils_strings_and_gradients_are_other_places() -> None:
    labels = [
        "coil[1,1]",
        "coil[1,2]",
        "string[1]",
        "string[2]",
        "all coils",
        "gradient over rows",
        "supply",
        "gradient over columns",
        "every temperature",
        "coil[1,1].temperature",
    ]
    assert len({found_place(label, SMALL) for label in labels}) == len(labels)


def test_the_only_coil_of_a_rig_is_all_of_its_coils() -> None:
    assert found_place("all coils", BATH) == found_place("coil[1]", BATH) == true_place(_truth("all"), BATH)
    assert found_place("every extension", BATH) == found_place("coil[1].extension", BATH)


def test_rig_and_length_are_read_from_the_files_of_a_case(tmp_path) -> None:
    (tmp_path / "training_1").mkdir()
    (tmp_path / "scenario.yaml").write_text("components: {circuit: {kind: ngspice, strings: [2, 1]}}\n")
    (tmp_path / "training_1" / "recording.yaml").write_text(
        "overrides: {time: {stop: 240 s}}\nchannels: {supply.current: {}, 'coil[1,1].temperature': {}}\n"
    )
    assert read_rig(tmp_path) == Rig((2, 1), True, ("coil[1,1].temperature", "supply.current"))
    assert read_duration(tmp_path) == 240.0
    (tmp_path / "scenario.yaml").write_text("components: {block: {kind: actuator}}\n")
    assert read_rig(tmp_path).strings == (1,)
