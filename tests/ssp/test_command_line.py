"""`cosim ssp import`, `export` and `validate`, and `cosim run FILE.ssp`."""

import sys
import zipfile

import pytest
import xarray as xr

from cosim import cli
from tests.cosim.short_runs import heating
from tests.ssp import packages as p


@pytest.fixture
def cosim(monkeypatch, capsys):
    """`cosim("run", "x.ssp")` gives exit code, output and error text."""

    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["cosim", *map(str, arguments)])
        with pytest.raises(SystemExit) as left:
            cli.main()
        captured = capsys.readouterr()
        return int(left.value.code or 0), captured.out, captured.err

    return call


@pytest.fixture
def ssp(pack):
    """A single y = gain u + offset, 10 ms long."""
    return pack(p.description(p.system("root", p.feedthrough("f", p.bindings(p.inline(p.parameter("u", "3")))))))


def test_export_validate_and_run(cosim, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "heating.yaml").write_text(heating().to_yaml())
    assert cosim("ssp", "export", "heating.yaml", "--out", "heating.ssp") == (0, "heating.ssp\n", "")
    code, out, err = cosim("ssp", "validate", "heating.ssp")
    assert (code, err) == (0, "")
    assert out.startswith("heating.ssp: valid SSP 2.0, `Single coils")
    assert cosim("run", "heating.yaml", "--no-plots", "--out", "direct")[0] == 0
    assert cosim("run", "heating.ssp", "--no-plots")[0] == 0
    with xr.open_dataset("direct/results.nc") as a, xr.open_dataset("runs/heating/results.nc") as b:
        assert a.equals(b)


def test_a_package_that_is_there_is_replaced_where_that_is_said(cosim, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "heating.yaml").write_text(heating().to_yaml())
    package = tmp_path / "heating.ssp"
    package.write_text("somebody's work")
    code, out, err = cosim("ssp", "export", "heating.yaml", "--out", "heating.ssp")
    assert (code, out) == (2, "")
    assert "heating.ssp: it exists already" in err
    assert "--overwrite" in err
    assert package.read_text() == "somebody's work"
    assert cosim("ssp", "export", "heating.yaml", "--out", "heating.ssp", "--overwrite")[0] == 0
    assert package.read_bytes()[:2] == b"PK"


def test_import_takes_the_step_that_ssp_does_not_hold(cosim, ssp, tmp_path):
    code, _, err = cosim("ssp", "import", ssp, "--out", tmp_path / "in")
    assert code == 2
    assert "gives no step size" in err
    assert "`--step`" in err
    code, out, err = cosim(
        "ssp", "import", ssp, "--out", tmp_path / "in", "--step", "2 ms", "--algorithm", "gauss_seidel"
    )
    assert (code, out, err) == (0, f"{tmp_path / 'in' / 'scenario.yaml'}\n", "")
    assert cosim("run", tmp_path / "in" / "scenario.yaml", "--no-plots", "--out", tmp_path / "run")[0] == 0
    with xr.open_dataset(tmp_path / "run" / "results.nc") as dataset:
        assert dataset["time"].values.tolist() == [0.0, 0.002, 0.004, 0.006, 0.008, 0.01]
        assert dataset["f.y"].values.tolist() == [3.0] * 6


def test_notes_say_what_the_file_leaves_open(cosim, ssp, tmp_path):
    _, _, err = cosim("ssp", "import", ssp, "--out", tmp_path / "in", "--step", "1 ms")
    assert err == "note: algorithm jacobi: SSP does not say how the components are stepped\n"


def test_a_second_run_of_an_ssp_into_one_folder_is_refused(cosim, ssp, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert cosim("run", ssp, "--no-plots")[0] == 2  # no step
    other = ssp.with_name("other.ssp")
    assert cosim("ssp", "import", ssp, "--out", "in", "--step", "1 ms")[0] == 0
    assert cosim("ssp", "export", "in/scenario.yaml", "--out", other, "--version", "1")[0] == 0
    assert cosim("run", other, "--no-plots")[0] == 0
    code, _, err = cosim("run", other, "--no-plots")
    assert code == 2
    assert "already holds a run" in err


def test_another_variant_of_a_package_can_be_taken(cosim, pack, tmp_path):
    path = pack(p.description(p.system("root", p.feedthrough("f"))))
    variant = p.description(p.system("root", p.feedthrough("g")))
    with zipfile.ZipFile(path, "a") as archive:
        archive.writestr("VarB.ssd", variant)
    assert cosim("ssp", "import", path, "--out", tmp_path / "in", "--step", "1 ms", "--variant", "VarB.ssd")[0] == 0
    assert "g:" in (tmp_path / "in" / "scenario.yaml").read_text()
    code, _, err = cosim("ssp", "validate", path, "--variant", "VarC.ssd")
    assert code == 2
    assert "it holds: SystemStructure.ssd, VarB.ssd" in err
