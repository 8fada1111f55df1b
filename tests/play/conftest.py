"""A short run of a real fabric in Bullet, once for all tests that need one."""

import pytest
import yaml
from typer.testing import CliRunner

from cosim.cli import app
from cosim.scenario import shipped_scenarios


@pytest.fixture(scope="session")
def run_folder(tmp_path_factory):
    """Run folder of a 2 x 3 fabric that drapes for 0.2 s."""
    folder = tmp_path_factory.mktemp("play")
    scenario = yaml.safe_load(shipped_scenarios()["passive_drape"].read_text())
    scenario["time"] |= {"stop": "0.2 s", "output_step": "10 ms"}
    scenario["components"]["fabric"] |= {"rows": 3, "tether": {"kind": "cantilever", "rows": 1}}
    file = folder / "short.yaml"
    file.write_text(yaml.safe_dump(scenario))
    answer = CliRunner().invoke(app, ["run", str(file), "--out", str(folder / "run"), "--no-plots"])
    assert answer.exit_code == 0, answer.output
    return folder / "run"


@pytest.fixture
def play(capsys):
    """`cosim play ...` as the entry point runs it: exit code, standard output and error."""
    import sys
    from types import SimpleNamespace
    from unittest import mock

    from cosim.cli import main

    def invoke(*arguments):
        with mock.patch.object(sys, "argv", ["cosim", "play", *map(str, arguments)]), pytest.raises(SystemExit) as end:
            main()
        told = capsys.readouterr()
        return SimpleNamespace(code=end.value.code, out=told.out, err=told.err)

    return invoke
