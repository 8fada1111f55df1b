"""What a model that knew an effect outside the catalogue exactly would reach, from recordings without the effect."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from evaluation.proof.ground import Draw, make_cases
from evaluation.proof.isolated import files_of
from evaluation.proof.proof import Folder, answer_files
from evaluation.proof.reference import Reference
from evaluation.proof.references import make_reference

CASE = "case_0001"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Folder:
    """A proof with one case: boiling on the heaters."""
    made = Folder(tmp_path_factory.mktemp("proof"))
    make_cases(made.path / "ground", Draw(1, 2, ("outside",), ("heaters",)))
    return made


@pytest.fixture(scope="module")
def reference(folder: Folder) -> Reference:
    return make_reference(CASE, files_of(folder.case(CASE)), answer_files(folder, CASE), False)


def test_the_twin_lies_between_noise_alone_and_recalibration(reference: Reference) -> None:
    assert reference.oracle is None
    assert reference.floor is not None
    assert reference.twin is not None
    assert reference.recalibrated is not None
    assert reference.floor < reference.twin < reference.recalibrated


def test_the_twin_is_judged_as_a_null_of_the_same_rig_would_be(
    folder: Folder, reference: Reference, tmp_path: Path
) -> None:
    shutil.copytree(folder.case(CASE), tmp_path, dirs_exist_ok=True)
    shutil.copytree(folder.answer(CASE, "_twin"), tmp_path, dirs_exist_ok=True)
    answer = dict(answer_files(folder, CASE))
    told = json.loads(answer[f"{CASE}.json"])
    answer[f"{CASE}.json"] = json.dumps(told | {"kind": "null", "findings": []}).encode()
    null = make_reference(CASE, files_of(tmp_path), answer, False)
    assert null.recalibrated == reference.twin  # the same fit of the same readings


def test_without_a_twin_everything_else_is_the_same(folder: Folder, reference: Reference, tmp_path: Path) -> None:
    shutil.copytree(folder.path, tmp_path, dirs_exist_ok=True)
    old = Folder(tmp_path)
    shutil.rmtree(old.answer(CASE, "_twin"))
    assert set(answer_files(old, CASE)) == {f"{CASE}.json", f"{CASE}.npz"}
    found = make_reference(CASE, files_of(old.case(CASE)), answer_files(old, CASE), False)
    assert found.twin is None
    assert replace(found, twin=reference.twin, seconds=reference.seconds) == reference


def test_of_a_rig_without_a_network_the_noise_is_known_all_the_same(tmp_path: Path) -> None:
    """A pendulum: readings about the truth scatter by the noise that is stated and the encoder's steps."""
    made = Folder(tmp_path)
    make_cases(made.path / "ground", Draw(1, 2, ("null",), ("pendulum",)))
    found = make_reference(CASE, files_of(made.case(CASE)), answer_files(made, CASE), False)
    assert found.failure.startswith("no reference: ")
    assert found.recalibrated is None
    ((channel, (scatter, deviation)),) = found.noises.items()
    assert channel == "arm.angle"
    assert scatter == pytest.approx(deviation, rel=0.1)
    assert found.samples[channel] == pytest.approx(1200, abs=60)
    assert found.floor == pytest.approx((scatter / deviation) ** 2, rel=0.5)
