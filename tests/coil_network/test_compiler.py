"""The compiler: cached by its source, and a clear error where there is none or it refuses."""

import pytest

from diagnosis.models.coil_network.kernel.compiler import CompilerError, library_path, load

SOURCE = "int answer(void) { return 42; }\n"


@pytest.fixture(autouse=True)
def _own_cache(monkeypatch, tmp_path):
    monkeypatch.setenv("COSIM_CACHE", str(tmp_path / "cache"))


def test_a_source_is_compiled_once_and_another_one_again():
    path = library_path(SOURCE)
    before = path.stat().st_mtime_ns
    assert load(SOURCE).answer() == 42
    assert library_path(SOURCE) == path
    assert path.stat().st_mtime_ns == before
    assert library_path(SOURCE.replace("42", "43")) != path
    assert {p.suffix for p in path.parent.iterdir()} == {".so"}  # nothing is left of the compilation


def test_a_missing_compiler_says_what_to_install(monkeypatch, tmp_path):
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(CompilerError, match=r"gcc was not found: install gcc"):
        library_path(SOURCE)


def test_a_refused_source_shows_what_the_compiler_said():
    with pytest.raises(CompilerError, match=r"(?s)refused the network.s source.*error") as caught:
        library_path("int answer(void) { return nothing; }\n")
    assert "nothing" in str(caught.value)


def test_a_cache_that_cannot_be_written_says_so(monkeypatch, tmp_path):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("COSIM_CACHE", str(tmp_path / "file" / "below"))
    with pytest.raises(CompilerError, match="set COSIM_CACHE"):
        library_path(SOURCE)
