"""Instances of one archive share its files and library, and nothing else."""

from __future__ import annotations

import pickle
import shutil
from pathlib import Path

import numpy as np

from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.settings import FmuSettings
from cosim.unit.protocol import NANOSECONDS

Built = dict[tuple[str, int], Path]


def test_files_are_extracted_once_and_deleted_with_the_last_user(built: Built) -> None:
    first, second = open_fmu(built["trouble", 2]), open_fmu(built["trouble", 2])
    folder = first.directory
    assert second.directory == folder
    assert second.description is first.description
    first.remove()
    first.remove()
    assert folder.is_dir()
    second.remove()
    assert not folder.exists()
    third = open_fmu(built["trouble", 2])
    assert third.directory != folder
    third.remove()


def test_a_file_that_was_replaced_is_read_again(built: Built, tmp_path: Path) -> None:
    path = shutil.copy(built["trouble", 2], tmp_path / "a.fmu")
    first = open_fmu(path)
    shutil.copy(built["trouble", 3], path)
    second = open_fmu(path)
    assert (first.description.fmiVersion, second.description.fmiVersion) == ("2.0", "3.0")
    first.remove()
    second.remove()


def test_instances_have_states_of_their_own_and_outlive_each_other(built: Built) -> None:
    for version in (2, 3):
        units = [CoSimulationUnit(f"u{i}", open_fmu(built["trouble", version]), FmuSettings()) for i in range(3)]
        for i, unit in enumerate(units):
            unit.set("u", np.array(float(i)))
            unit.initialise(0)
            unit.do_step(0, NANOSECONDS)
        assert [float(u.get("integral")) for u in units] == [0.0, 1.0, 2.0]
        units[0].terminate()
        units[2].terminate()
        units[1].do_step(NANOSECONDS, NANOSECONDS)
        assert float(units[1].get("integral")) == 2.0
        units[1].terminate()


def test_an_error_names_the_instance_that_met_it(built: Built) -> None:
    units = [CoSimulationUnit(n, open_fmu(built["trouble", 3]), FmuSettings()) for n in ("left", "right")]
    assert [u.binding.fmu.instanceName for u in units] == ["left", "right"]
    assert units[0].binding.fmu.component != units[1].binding.fmu.component
    for unit in units:
        unit.terminate()


def test_an_archive_of_its_own_is_shared_with_nobody(built: Built) -> None:
    shared, own = open_fmu(built["trouble", 2]), open_fmu(built["trouble", 2], is_shared=False)
    assert own.directory != shared.directory
    own.remove()
    assert not own.directory.exists()
    assert shared.directory.is_dir()
    sent = pickle.loads(pickle.dumps(shared))
    assert sent.directory == shared.directory
    shared.remove()
