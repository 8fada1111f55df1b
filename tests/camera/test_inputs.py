"""What is wrong in a rig, a camera, a video or a table gets one error that names it."""

import sys

import numpy as np
import pytest
import yaml

from chainmail.camera.camera_file import load_camera
from chainmail.camera.frames import Frames, frame_times
from chainmail.camera.import_file import ImportFile
from chainmail.camera.importing import imported
from chainmail.camera.imports import read_tracks
from chainmail.camera.lens import calibrate
from chainmail.camera.opencv import opencv
from chainmail.camera.rig import ClockEntry, load_rig
from cosim.unit.errors import InputError

RIG = {
    "title": "a rig",
    "plane": {"scale": "0.25 mm", "origin": [100, 200]},
    "markers": {"colour": "green", "diameter": "6 mm", "layout": {"kind": "fabric", "rows": 6}},
    "clock": {"rate": "60 Hz", "exposure": "4 ms"},
}
FOUR = [
    {"at": ["0 mm", "0 mm"], "pixel": [0, 0]},
    {"at": ["9 mm", "0 mm"], "pixel": [9, 0]},
    {"at": ["9 mm", "9 mm"], "pixel": [9, 9]},
    {"at": ["0 mm", "9 mm"], "pixel": [0, 9]},
]


def rig_with(path, **keys):
    (path / "rig.yaml").write_text(yaml.safe_dump({**RIG, **keys}))
    return path / "rig.yaml"


def test_a_rig_is_read(tmp_path):
    rig = load_rig(rig_with(tmp_path))
    assert rig.markers.layout.rows == 6
    assert rig.markers.layout.link_length.least.to("m") == 0.0295


@pytest.mark.parametrize(
    ("keys", "where", "what"),
    [
        ({"plane": {"scale": "0.25 mm"}}, "plane", "needs `origin`"),
        ({"plane": {}}, "plane", "either `scale`"),
        ({"plane": {"fiducials": FOUR[:3]}}, "plane.fiducials", "at least 4"),
        ({"plane": {"fiducials": FOUR, "y": "left"}}, "plane", "leave out"),
        ({"plane": {"fiducials": FOUR, "colour": "blue"}}, "plane", "belong together"),
        ({"plane": {"scale": "0.25", "origin": [0, 0]}}, "plane.scale", "has no unit"),
        ({"plane": {"scale": "0.25 s", "origin": [0, 0]}}, "plane.scale", "no quantity in m"),
        ({"markers": {**RIG["markers"], "colour": "grue"}}, "markers.colour", "no colour"),
        ({"markers": {**RIG["markers"], "colour": "#808080"}}, "markers.colour", "too grey"),
        ({"markers": {**RIG["markers"], "diameter": "-6 mm"}}, "markers.diameter", "greater than"),
        ({"markers": {**RIG["markers"], "layout": {"kind": "fabric", "rows": 2}}}, "markers.layout", "at least 3"),
        ({"clock": {"rate": "60 Hz"}}, "clock.exposure", "missing"),
        ({"clock": {"rate": "60 Hz", "exposure": "40 ms"}}, "clock", "longer than a frame"),
        ({"clock": {"rate": "60 Hz", "stamps": "t.csv", "exposure": "4 ms"}}, "clock", "not both"),
        ({"lens": {"focal": [900, 900]}}, "lens", "`centre`"),
        ({"colour": "green"}, "colour", "no such key"),
    ],
)
def test_faults_of_a_rig_are_named(tmp_path, keys, where, what):
    with pytest.raises(InputError) as raised:
        load_rig(rig_with(tmp_path, **keys))
    assert raised.value.key.startswith(where)
    assert what in str(raised.value)
    assert raised.value.remedy


def test_faults_of_a_camera_are_named(tmp_path):
    (tmp_path / "camera.yaml").write_text("{exposure: 4, jpeg: 0}")
    with pytest.raises(InputError, match="exposure") as raised:
        load_camera(tmp_path / "camera.yaml")
    assert "jpeg" in str(raised.value)


def test_without_opencv_one_sentence_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "cv2", None)
    with pytest.raises(InputError, match=r"opencv-python-headless[\s\S]*pip install"):
        opencv()


def test_what_is_no_video_is_refused(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        Frames(tmp_path / "none.mp4")
    (tmp_path / "text.mp4").write_text("no video")
    with pytest.raises(InputError, match="no frame"):
        Frames(tmp_path / "text.mp4")
    with pytest.raises(InputError, match="no picture"):
        Frames(tmp_path)


def test_chessboards_that_show_none_are_counted(tmp_path):
    cv2 = opencv()
    files = [tmp_path / f"{i}.png" for i in range(7)]
    for file in files:
        cv2.imwrite(str(file), np.full((60, 80), 200, np.uint8))
    with pytest.raises(InputError, match="found in 0 of 7 pictures"):
        calibrate(files, (9, 6), "lens.chessboard")


@pytest.mark.parametrize(("stamp", "shift"), [("begin", 0.005), ("middle", 0.0), ("end", -0.005)])
def test_time_stamps_mean_what_the_rig_says(tmp_path, stamp, shift):
    (tmp_path / "t.csv").write_text("time\n" + "\n".join(str(20 * k + k % 2) for k in range(5)))
    clock = ClockEntry.model_validate(
        {"stamps": "t.csv", "unit": "ms", "exposure": "10 ms", "stamp": stamp, "offset": "3 s"}
    )
    times, _ = frame_times(clock, np.full(5, np.nan), 0.0, tmp_path / "rig.yaml", tmp_path)
    assert times == pytest.approx(3.0 + shift + 1e-3 * np.array([0, 21, 40, 61, 80]))
    with pytest.raises(InputError, match="5 times for 6 frames"):
        frame_times(clock, np.full(6, np.nan), 0.0, tmp_path / "rig.yaml", tmp_path)


DLC = "scorer,net,net,net,net,net,net\nbodyparts,a,a,a,b,b,b\ncoords,x,y,likelihood,x,y,likelihood\n"
OPTITRACK = """Format Version,1.23,Take Name,t,Length Units,Millimeters
,Type,Marker,Marker,Marker,Marker,Marker,Marker
,Name,a,a,a,b,b,b
,ID,1,1,1,2,2,2
,,Position,Position,Position,Position,Position,Position
Frame,Time (Seconds),X,Y,Z,X,Y,Z
"""


def test_deeplabcut(tmp_path):
    rows = [f"{k},{100 + k},{50},{0.99},{10},{20 + k},{0.2 if k == 4 else 0.95}" for k in range(12)]
    (tmp_path / "d.csv").write_text(DLC + "\n".join(rows))
    given = ImportFile.model_validate(
        {
            "title": "t",
            "markers": ["b", "a"],
            "unit": "px",
            "noise": "0.1 mm",
            "clock": {"rate": "10 Hz"},
            "plane": {"scale": "0.5 mm", "origin": [0, 0]},
        }
    )
    found = imported(read_tracks(tmp_path / "d.csv"), given, tmp_path / "import.yaml")
    assert found.tracks.times == pytest.approx(0.1 * np.arange(12))
    assert found.tracks.places[3] == pytest.approx(np.array([[5e-3, -11.5e-3], [51.5e-3, -25e-3]]))
    assert np.isnan(found.tracks.places[4, 0]).all()  # not sure enough: a gap
    assert np.isfinite(found.tracks.places[4, 1]).all()


def test_optitrack(tmp_path):
    rows = [
        f"{k},{0.01 * k:.2f},1,2,{k},4,,{k}" if k == 5 else f"{k},{0.01 * k:.2f},1,2,{k},4,5,{k}" for k in range(12)
    ]
    (tmp_path / "o.csv").write_text(OPTITRACK + "\n".join(rows))
    given = ImportFile.model_validate(
        {"title": "t", "markers": ["a", "b"], "unit": "mm", "y": "-z", "z": "y", "noise": "0.1 mm"}
    )
    found = imported(read_tracks(tmp_path / "o.csv"), given, tmp_path / "import.yaml")
    assert found.tracks.places[7] == pytest.approx(1e-3 * np.array([[-7.0, 2.0], [-7.0, 5.0]]))
    assert np.isnan(found.tracks.places[5, 1]).all()
    assert found.tracks.times[-1] == pytest.approx(0.11)


def test_plain_table_with_decimal_commas_and_iso_times(tmp_path):
    rows = [f"2026-05-01T12:00:00,{40 * k:03d};{k},5;{2 * k},25" for k in range(12)]
    (tmp_path / "p.csv").write_text("Zeit;tip.x [mm];tip.y [mm]\n" + "\n".join(rows))
    table = read_tracks(tmp_path / "p.csv")
    assert table.kind == "plain"
    assert table.times == pytest.approx(0.04 * np.arange(12))
    given = ImportFile.model_validate({"title": "t", "markers": ["tip"], "unit": "mm"})
    with pytest.raises(InputError, match="no point `top`"):
        imported(table, given.model_copy(update={"markers": ["top"]}), tmp_path / "import.yaml")
    assert imported(table, given, tmp_path / "i").tracks.places[2, 0] == pytest.approx([2.5e-3, 4.25e-3])


def test_text_between_numbers_is_named(tmp_path):
    (tmp_path / "p.csv").write_text("time,p.x,p.y\n0,1,2\n1,oops,2\n")
    with pytest.raises(InputError, match="row 3, column 2: `oops`"):
        read_tracks(tmp_path / "p.csv")


def test_a_unit_that_the_table_contradicts_is_refused(tmp_path):
    rows = [f"{k},{0.01 * k:.2f},1,2,{k},4,5,{k}" for k in range(12)]
    settings, header = OPTITRACK.split("\n", 1)
    (tmp_path / "o.csv").write_text(f"{settings},Length Units,Millimeters\n{header}" + "\n".join(rows))
    given = ImportFile.model_validate({"title": "t", "markers": ["a", "b"], "unit": "m", "y": "-z", "z": "y"})
    with pytest.raises(InputError, match="the table says that its lengths are in mm"):
        imported(read_tracks(tmp_path / "o.csv"), given, tmp_path / "import.yaml")


def test_headers_of_optitrack_without_labels_are_read(tmp_path):
    """Up to version 1.21 the rows of the header say nothing of what they hold."""
    lines = OPTITRACK.splitlines()
    plain = [line.replace("Type", "").replace(",Name", ",").replace(",ID", ",") for line in lines[1:-1]]
    rows = [f"{k},{0.01 * k:.2f},1,2,{k},4,5,{k}" for k in range(12)]
    (tmp_path / "o.csv").write_text("\n".join([lines[0], *plain, lines[-1], *rows]))
    table = read_tracks(tmp_path / "o.csv")
    assert set(table.places) == {"a", "b"}
    assert table.places["b"]["y"] == pytest.approx(5.0)


def test_links_of_another_size_than_anybody_weaves_are_refused(tmp_path):
    names = [f"p{n}" for n in range(6)]
    header = "time," + ",".join(f"{n}.{a}" for n in names for a in "xy")
    rows = [f"{0.1 * k}," + ",".join(f"{30 * (n % 2)},{22 * (n // 2)}" for n in range(6)) for k in range(12)]
    (tmp_path / "p.csv").write_text("\n".join([header, *rows]))
    keys = {"title": "t", "markers": names, "noise": "0.1 mm", "fabric": True}
    found = imported(read_tracks(tmp_path / "p.csv"), ImportFile.model_validate({**keys, "unit": "mm"}), tmp_path / "i")
    assert "distance of the two markers of a row: 30 to 30 mm, 30 mm in the median" in found.notes
    with pytest.raises(InputError, match="would be 3e\\+04 mm apart"):
        imported(read_tracks(tmp_path / "p.csv"), ImportFile.model_validate({**keys, "unit": "m"}), tmp_path / "i")


def test_pixels_of_deeplabcut_as_lengths_are_said(tmp_path):
    rows = [f"{k},{100 + k},{50},{0.99},{10},{20 + k},{0.95}" for k in range(12)]
    (tmp_path / "d.csv").write_text(DLC + "\n".join(rows))
    given = ImportFile.model_validate(
        {"title": "t", "markers": ["a"], "unit": "mm", "noise": "0.1 mm", "clock": {"rate": "10 Hz"}}
    )
    found = imported(read_tracks(tmp_path / "d.csv"), given, tmp_path / "import.yaml")
    assert any("DeepLabCut writes pixels; these are taken to be in mm" in n for n in found.notes)
