"""FMUs of shipped actuators are built where they are asked for: once, whole or not at all, never in a folder given."""

import zipfile

import pytest

from cosim import shipped
from cosim.fmu_build.at_first_use import file_name, shipped_fmu
from cosim.unit.errors import InputError


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """An installation with an empty cache."""
    monkeypatch.setattr(shipped, "IS_INSTALLED", True)
    monkeypatch.delenv("COSIM_FMU_PATH", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    shipped._cache_folder.cache_clear()
    yield tmp_path
    shipped._cache_folder.cache_clear()


def test_an_fmu_is_built_once_and_said_so_once(cache, capsys):
    path = shipped_fmu("instant_stiffness", 3, 12)  # FMI 3.0: one file for every size
    assert path is not None
    assert path.name == "instant_stiffness_fmi3.fmu"
    assert path.is_relative_to(cache)
    assert "modelDescription.xml" in zipfile.ZipFile(path).namelist()
    assert "building instant_stiffness_fmi3.fmu" in capsys.readouterr().err
    before = path.stat().st_mtime_ns
    assert shipped_fmu("instant_stiffness", 3, 36) == path
    assert path.stat().st_mtime_ns == before
    assert capsys.readouterr().err == ""
    assert [p.name for p in path.parent.iterdir()] == [path.name]  # no scratch folder stays


def test_an_fmi_2_fmu_has_its_size_in_its_name(cache):
    path = shipped_fmu("instant_stiffness", 2, 5)
    assert path is not None
    assert path.name == file_name("instant_stiffness", 2, 5) == "instant_stiffness_fmi2_n5.fmu"


def test_without_a_compiler_there_is_an_error_and_nothing_is_left(cache, monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler")
    with pytest.raises(InputError, match="no such C compiler"):
        shipped_fmu("instant_stiffness", 3, 36)
    assert not [p for p in cache.rglob("*") if p.is_file()]


def test_a_cache_that_is_a_file_is_an_error_with_a_remedy(cache, monkeypatch):
    (cache / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(cache / "file"))
    shipped._cache_folder.cache_clear()
    with pytest.raises(InputError, match="COSIM_FMU_PATH") as caught:
        shipped_fmu("instant_stiffness", 3, 36)
    assert "cannot be built here" in caught.value.problem


def test_nothing_is_built_in_a_folder_that_the_user_names(cache, tmp_path, monkeypatch):
    folder = tmp_path / "mine"
    folder.mkdir()
    monkeypatch.setenv("COSIM_FMU_PATH", str(folder))
    assert shipped_fmu("instant_stiffness", 3, 36) is None
    assert not list(folder.iterdir())
    assert shipped_fmu("no_such_actuator", 3, 36) is None


def test_an_installation_has_no_commit_of_a_repository_around_it(monkeypatch, tmp_path):
    from cosim import run_folder

    monkeypatch.setattr(run_folder, "__file__", str(tmp_path / "site-packages" / "cosim" / "run_folder.py"))
    assert run_folder.versions()["commit"] == "unknown"
