"""Archives that a hostile or damaged file can hold, and folders that killed processes leave."""

from __future__ import annotations

import os
import signal
import stat
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

import pytest

from cosim.fmu import extraction
from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.temporary import PREFIX, make_folder, remove_folder, sweep
from cosim.fmu.unit import FmuSettings
from cosim.unit.errors import InputError
from cosim.unit.protocol import NANOSECONDS
from tests.fmi.fmi_models import described


def entry(name, mode=0o644, kind=stat.S_IFREG):
    info = zipfile.ZipInfo(name)
    info.external_attr = (kind | mode) << 16
    return info


def archive_of(path, entries, compression=zipfile.ZIP_STORED):
    with zipfile.ZipFile(path, "w", compression) as archive:
        for name, data in entries:
            archive.writestr(name, data)
    return path


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ([("../outside", "")], "outside the FMU's folder"),
        ([("a/../../outside", "")], "outside the FMU's folder"),
        ([("/etc/passwd", "")], "outside the FMU's folder"),
        ([("..\\outside", "")], "outside the FMU's folder"),
        ([("C:/outside", "")], "outside the FMU's folder"),
        ([(entry("link", kind=stat.S_IFLNK), "/etc/passwd")], "symbolic link"),
        ([(entry("pipe", kind=stat.S_IFIFO), "")], "neither a file nor a folder"),
        ([("a", ""), ("a/b", "")], "both a file and a folder"),
        ([("readme", "")], "no modelDescription.xml"),
        ([("modelDescription.xml", "<no")], "cannot be read"),
    ],
)
def test_an_archive_is_judged_before_anything_is_loaded(tmp_path, entries, message):
    before = set(Path(tempfile.gettempdir()).glob(PREFIX + "*"))
    with pytest.raises(InputError, match=message):
        open_fmu(archive_of(tmp_path / "bad.fmu", entries))
    mine = {p for p in set(Path(tempfile.gettempdir()).glob(PREFIX + "*")) - before if _is_ours(p)}
    assert mine == set()
    assert not (tmp_path / "outside").exists()


def _is_ours(folder):
    from cosim.fmu import temporary

    return folder in temporary._locks


# The last two have one length and one CRC-32.
@pytest.mark.parametrize(("first", "second"), [("1", "2"), ("1", "11"), ("", "1"), ("plumless", "buckeroo")])
def test_an_entry_that_is_there_twice_with_different_contents_is_refused(tmp_path, first, second):
    with pytest.warns(UserWarning, match="Duplicate name"):
        path = archive_of(tmp_path / "twice.fmu", [("a", first), ("a", second)])
    with pytest.raises(InputError, match="there twice, with different contents"):
        open_fmu(path)


def test_an_entry_that_is_packed_twice_with_the_same_contents_is_read_once(tmp_path, built):
    with zipfile.ZipFile(built["ball", 3]) as ball:
        entries = [(n, ball.read(n)) for n in ball.namelist()]
    twice = [("extra/org.example/notes.xml", "<notes/>"), ("extra/org.example/empty", "")]
    with pytest.warns(UserWarning, match="Duplicate name"):
        path = archive_of(tmp_path / "twice.fmu", [*entries, *twice, *twice])
    archive = open_fmu(path)
    assert (archive.directory / "extra/org.example/notes.xml").read_text() == "<notes/>"
    assert (archive.directory / "extra/org.example/empty").read_text() == ""
    archive.remove()


def test_a_zip_bomb_is_refused_by_its_ratio_and_its_size(tmp_path, monkeypatch):
    path = archive_of(tmp_path / "bomb.fmu", [("zeros", bytes(80 << 20))], zipfile.ZIP_DEFLATED)
    with pytest.raises(InputError, match=r"times its size: a zip bomb"):
        open_fmu(path)
    monkeypatch.setattr(extraction, "MAXIMUM_UNPACKED_SIZE", 1 << 20)
    with pytest.raises(InputError, match=r"it unpacks to 0\.1 GB"):
        open_fmu(path)


def test_too_many_entries_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(extraction, "MAXIMUM_ENTRIES", 5)
    with pytest.raises(InputError, match="it has 6 entries, more than 5"):
        open_fmu(archive_of(tmp_path / "many.fmu", [(str(i), "") for i in range(6)]))


def test_an_entry_larger_than_it_declares_is_refused(tmp_path):
    path = archive_of(tmp_path / "liar.fmu", [("data", bytes(1000))], zipfile.ZIP_DEFLATED)
    content = bytearray(path.read_bytes())
    directory = content.index(b"PK\x01\x02")
    for offset in (22, directory + 24):  # uncompressed size, in the entry's header and in the directory
        content[offset : offset + 4] = (10).to_bytes(4, "little")
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"larger than|not an FMU"):
        open_fmu(path)


def test_an_encrypted_entry_is_refused(tmp_path):
    path = archive_of(tmp_path / "secret.fmu", [("data", b"x")])
    content = bytearray(path.read_bytes())
    content[content.index(b"PK\x01\x02") + 8] |= 1
    path.write_bytes(content)
    with pytest.raises(InputError, match="encrypted"):
        open_fmu(path)


def test_a_damaged_archive_is_refused(tmp_path):
    path = archive_of(tmp_path / "damaged.fmu", [("data", b"hello hello")])
    content = bytearray(path.read_bytes())
    content[content.index(b"hello")] ^= 1
    path.write_bytes(content)
    with pytest.raises(InputError, match="Bad CRC"):
        open_fmu(path)


def test_a_description_that_breaks_a_rule_but_can_be_read_is_used_with_a_warning(built, tmp_path, caplog):
    stated = 'modelName="stair"'
    path = described(built["stair", 2], tmp_path / "sloppy.fmu", stated, f'{stated} mood="sloppy"')
    unit = CoSimulationUnit("stair", open_fmu(path), FmuSettings())
    unit.initialise(0)
    unit.do_step(0, NANOSECONDS)
    assert unit.get("count") == 3
    assert "sloppy.fmu: modelDescription.xml is not valid" in caplog.text
    assert "mood" in caplog.text
    unit.terminate()


SCRIPT = """
import os, sys
from pathlib import Path
from cosim.fmu.archive import open_fmu
archive = open_fmu(Path(sys.argv[1]))
print(archive.directory, flush=True)
if sys.argv[2] == "killed":
    os.kill(os.getpid(), 9)
"""


@pytest.mark.parametrize("end", ["killed", "by itself"])
def test_no_folder_outlives_its_process_for_long(built, end):
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, built["stair", 3], end], capture_output=True, text=True, check=False
    )
    folder = Path(done.stdout.strip())
    assert done.returncode == (-signal.SIGKILL if end == "killed" else 0), done.stderr
    assert folder.exists() == (end == "killed")
    sweep(folder.parent)  # what the next process does
    assert not folder.exists()


SWEEP = """
import pathlib, sys
from cosim.fmu.temporary import sweep
sweep(pathlib.Path(sys.argv[1]))
"""


def test_a_folder_in_use_is_not_swept():
    folder = make_folder()
    child = os.fork()
    if child == 0:
        os._exit(0)  # a forked process that ends leaves it alone
    os.waitpid(child, 0)
    subprocess.run([sys.executable, "-c", SWEEP, folder.parent], check=True)
    assert folder.exists()
    remove_folder(folder)
    assert not folder.exists()
