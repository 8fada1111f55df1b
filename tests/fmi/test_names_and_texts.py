"""Names and types of any kind that FMI allows, from a run into its files and back."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import pytest
import xarray as xr
import yaml

from cosim.run import run
from cosim.scenario import load_scenario
from tests.fmi.fmi_models import described

#: As XML has it, to the name of the variable.
NAMES = {
    "a/b": "a/b",
    "line&#10;break": "line\nbreak",
    "tab&#9;": "tab\t",
    "100%/h": "100%/h",
    "blank ": "blank ",
    "Größe μ": "Größe μ",
    "comma, &quot;quote&quot;": 'comma, "quote"',
    "&lt;der(x)&gt;": "<der(x)>",
    "der(x)": "der(x)",
}


def results(folder: Path, fmu: Path, fmi: int = 2, **settings: Any) -> xr.Dataset:
    """Results of two seconds in four steps, as they are stored."""
    path = folder / "scenario.yaml"
    component = {"kind": "fmu", "fmu": str(fmu), "fmi": fmi, **settings}
    times = {"stop": "2 s", "macro_step": "0.5 s", "output_step": "0.5 s"}
    path.write_text(yaml.safe_dump({"title": "any", "time": times, "components": {"u": component}}))
    run(load_scenario(path), folder / "run", csv=True)
    return xr.load_dataset(folder / "run" / "results.nc")


@pytest.mark.parametrize(("written", "name"), NAMES.items(), ids=range(len(NAMES)))
def test_every_name_is_stored_and_read_back(
    built: dict[tuple[str, int], Path], tmp_path: Path, written: str, name: str
) -> None:
    named = described(built["early", 2], tmp_path / "named.fmu", 'name="y"', f'name="{written}"')
    found = results(tmp_path, named, parameters={"gain": 3})
    (values,) = [v for n, v in found.data_vars.items() if v.attrs.get("name", n) == f"u.{name}"]
    assert values.values.tolist() == [3.0] * 5
    with (tmp_path / "run" / "results.csv").open(newline="", encoding="utf-8") as file:
        header = next(csv.reader(file))
    assert any(column.startswith(f"u.{name}") for column in header)


@pytest.mark.parametrize("fmi", [2, 3])
def test_texts_numbers_and_bytes_are_stored_and_read_back(
    built: dict[tuple[str, int], Path], tmp_path: Path, fmi: int
) -> None:
    start: dict[str, Any] = {"string_in": 'Größe, "μ" ', "int32_in": -(2**31), "boolean_in": True}
    found = results(tmp_path, built["echo", fmi], fmi, start=start | ({"binary_in": "00ff10"} if fmi == 3 else {}))
    assert found["u.string_out"].values.tolist() == ['Größe, "μ" '] * 5
    assert found["u.int32_out"].values.tolist() == [-(2**31)] * 5
    assert found["u.boolean_out"].values.astype(bool).tolist() == [True] * 5
    if fmi == 3:
        assert found["u.binary_out"].values.tolist() == ["00ff10"] * 5
        assert found["u.texts_out"].shape == (5, 2)
