"""FMUs that cannot be run are refused by a sentence that is true of them."""

from __future__ import annotations

import re
import zipfile
from pathlib import Path

import pytest

from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.unit import FmuSettings
from cosim.unit.errors import InputError

DESCRIPTION = """<?xml version="1.0"?>
<fmiModelDescription fmiVersion="1.0" modelName="m" modelIdentifier="m" guid="1" numberOfContinuousStates="0"
  numberOfEventIndicators="0">
<ModelVariables>
  <ScalarVariable name="x" valueReference="0" causality="output"><Real/></ScalarVariable>
  <ScalarVariable name="x" valueReference="1" causality="output"><Real/></ScalarVariable>
</ModelVariables>
<Implementation><CoSimulation_StandAlone><Capabilities/></CoSimulation_StandAlone></Implementation>
</fmiModelDescription>
"""


def test_fmi_1_with_two_variables_of_one_name_is_refused_as_fmi_1(tmp_path: Path) -> None:
    path = tmp_path / "m.fmu"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("modelDescription.xml", DESCRIPTION)
        archive.writestr("binaries/linux64/m.so", b"")
    with pytest.raises(InputError, match=r"FMI 1\.0 is not supported"):
        CoSimulationUnit("m", open_fmu(path), FmuSettings())


def test_an_fmu_that_gives_no_instance_is_not_said_to_have_a_broken_binary(shipped_fmus: Path, tmp_path: Path) -> None:
    """Its token is not the one that its binary knows."""
    given, path = sorted(Path(shipped_fmus).glob("thermal_stiffness*fmi3*.fmu"))[0], tmp_path / "other.fmu"
    with zipfile.ZipFile(given) as source, zipfile.ZipFile(path, "w") as target:
        for entry in source.infolist():
            data = source.read(entry)
            if entry.filename == "modelDescription.xml":
                data = re.sub(rb'instantiationToken="[^"]*"', b'instantiationToken="{other}"', data)
            target.writestr(entry, data)
    with pytest.raises(InputError, match="its binary is loaded, but gives no instance") as refused:
        CoSimulationUnit("m", open_fmu(path), FmuSettings())
    assert "ask whoever exported it" in refused.value.remedy
