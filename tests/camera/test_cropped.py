"""Videos of another size than the rig's pixels: refused, or said that it cannot be told."""

import shutil

import numpy as np
import pytest
import yaml

from chainmail.camera.camera_file import CameraFile
from chainmail.camera.measure import measure
from chainmail.camera.opencv import opencv
from chainmail.camera.rendered import write_video
from chainmail.camera.rig import load_rig
from cosim.unit.errors import InputError
from tests.camera.fabrics import swaying
from tests.camera.test_track import SMALL

#: Lines and columns that are cut off at the top and on the left.
TOP, LEFT = 20, 30


@pytest.fixture(scope="module")
def film(tmp_path_factory):
    """A rendered video beside one of which lines and columns were cut off."""
    folder = tmp_path_factory.mktemp("film")
    write_video(folder, CameraFile.model_validate(SMALL), folder / "camera.yaml", swaying(), 4, "a test")
    cropped = folder / "cropped"
    shutil.copytree(folder / "frames", cropped)
    for file in cropped.iterdir():
        picture = opencv().imread(str(file))
        opencv().imwrite(str(file), picture[TOP:, LEFT:])
    return folder


def rig_with(folder, tmp_path, **keys):
    given = yaml.safe_load((folder / "rig.yaml").read_text())
    file = tmp_path / "rig.yaml"
    file.write_text(yaml.safe_dump({k: v for k, v in {**given, **keys}.items() if v is not None}))
    return file


def tracked(pictures, rig):
    return measure(pictures, load_rig(rig), rig)


def test_a_rendered_rig_says_of_which_size_its_pictures_are(film):
    assert load_rig(film / "rig.yaml").picture == (480, 360)


def test_a_cropped_video_is_refused(film, tmp_path):
    rig = rig_with(film, tmp_path)
    with pytest.raises(InputError) as raised:
        tracked(film / "cropped", rig)
    assert (raised.value.source, raised.value.key) == (str(rig), "picture")
    assert "480 x 360" in str(raised.value)
    assert "450 x 340" in str(raised.value)


def test_where_the_rig_does_not_say_it_the_summary_says_what_is_not_noticed(film, tmp_path):
    rig = rig_with(film, tmp_path, picture=None)
    whole, cropped = tracked(film / "frames", rig), tracked(film / "cropped", rig)
    assert any("450 x 340" in n and "shifts all places alike" in n for n in cropped.notes)
    shift = np.nanmedian(cropped.tracks.places - whole.tracks.places, axis=(0, 1))
    # 0.4 mm to a pixel; cut at the top and on the left, a marker is farther up and to the left
    np.testing.assert_allclose(shift, [-LEFT * 0.4e-3, TOP * 0.4e-3], atol=2e-5)


def test_nothing_is_said_where_the_rig_says_it(film, tmp_path):
    assert not any(n.startswith("picture") for n in tracked(film / "frames", rig_with(film, tmp_path)).notes)


def test_boards_of_another_size_are_refused(film, tmp_path):
    (tmp_path / "boards").mkdir()
    for number in range(8):
        opencv().imwrite(str(tmp_path / "boards" / f"{number}.png"), board(number))
    rig = rig_with(film, tmp_path, picture=None, lens={"chessboard": {"folder": "boards", "corners": [7, 5]}})
    with pytest.raises(InputError) as raised:
        tracked(film / "frames", rig)
    assert raised.value.key == "lens.chessboard"
    assert "640 x 480" in str(raised.value)
    assert "480 x 360" in str(raised.value)


def board(number):
    """A chessboard of 8 x 6 fields seen from another side each time, in 640 x 480 pixels."""
    fields = np.kron(np.indices((6, 8)).sum(axis=0) % 2, np.ones((40, 40))).astype(np.uint8) * 255
    flat = np.pad(fields, 40, constant_values=255)
    height, width = flat.shape
    random = np.random.default_rng(number)
    corners = np.array([[0, 0], [width, 0], [width, height], [0, height]], dtype=np.float32)
    seen = corners + np.array([120, 80]) + random.uniform(-40, 40, (4, 2))
    turn = opencv().getPerspectiveTransform(corners, seen.astype(np.float32))
    return opencv().warpPerspective(flat, turn, (640, 480), borderValue=255)
