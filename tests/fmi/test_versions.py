"""What is not FMI 2.0 or 3.0 is refused as such, whatever else is wrong with it."""

from __future__ import annotations

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
