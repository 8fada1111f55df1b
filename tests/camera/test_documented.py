"""The files that docs/camera.md shows are read."""

import re
from pathlib import Path

from chainmail.camera.camera_file import load_camera
from chainmail.camera.import_file import load_import
from chainmail.camera.rig import load_rig

PAGE = Path(__file__).resolve().parents[2] / "docs" / "camera.md"


def test_every_example_is_valid(tmp_path):
    blocks = re.findall(r"^```yaml\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    files = []
    for number, text in enumerate(blocks):
        files.append(tmp_path / f"{number}.yaml")
        files[-1].write_text(text)
    rig, camera, given = files
    assert load_rig(rig).markers.layout.rows == 6
    assert load_camera(camera).jpeg == 50
    assert load_import(given).markers == ["base", "tip"]
