"""From a video to the effect that is concealed in it: `cosim record --video`, `cosim track`, `cosim diagnose`."""

import json

import pytest
import yaml
from typer.testing import CliRunner

from cosim.cli import app
from evaluation.camera.case import CAMERA, SCENARIO
from tests.fabric_diagnosis.fabrics import laws_but

pytest.importorskip("mujoco")
TILT = 0.15
#: Two effects compete; all would take minutes more.
WITHOUT = laws_but("tilt", "contact_friction")


def call(*arguments):
    result = CliRunner().invoke(app, [str(a) for a in arguments])
    assert result.exit_code == 0, (result.output, result.exception)


@pytest.mark.slow
def test_a_video_of_a_leaning_stand_leads_to_its_lean(tmp_path):
    scenario = tmp_path / "fabric.yaml"
    content = yaml.safe_load(SCENARIO.read_text())
    content["time"]["stop"] = "0.12 s"  # it drapes, and that is enough
    scenario.write_text(yaml.safe_dump(content))
    camera = tmp_path / "camera.yaml"
    camera.write_text(yaml.safe_dump({**CAMERA, "jpeg": 70, "light": 0.8, "gradient": 0.3}))
    for number, name in enumerate(("monday", "tuesday"), start=7):
        own = {"tilt": f"{TILT} rad", "start_speed": "1 mm/s", "start_number": number}
        given = [text for key, value in own.items() for text in ("--set", f"fabric.parameters.{key}={value}")]
        film = tmp_path / "film" / name
        call("record", scenario, *given, "--video", camera, "--out", film)
        call("track", film / "frames", "--rig", film / "rig.yaml", "--no-page", "--out", tmp_path / name)
    out = tmp_path / "answer"
    recordings = ("--recording", tmp_path / "monday", "--held-out", tmp_path / "tuesday")
    without = [text for name in WITHOUT for text in ("--without", name)]
    call("diagnose", scenario, *recordings, *without, "--brief", "--jobs", 1, "--out", out)
    answer = json.loads((out / "diagnosis.json").read_text())
    found = answer["findings"][0]
    assert found["effect"] == "tilt"
