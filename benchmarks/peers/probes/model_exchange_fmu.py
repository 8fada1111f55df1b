"""An FMU that offers Model Exchange alone: a shipped FMU without its Co-Simulation element."""

from __future__ import annotations

import re
import zipfile
from pathlib import Path

from benchmarks.models.systems import FMUS


def write(folder: Path, version: int) -> Path:
    """`thermal_stiffness` of this project (`make fmus`), its description cut."""
    source = FMUS.parent / "fmus" / f"thermal_stiffness_fmi{version}.fmu"
    target = folder / f"model_exchange_fmi{version}.fmu"
    with zipfile.ZipFile(source) as whole, zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as cut:
        for entry in whole.infolist():
            content = whole.read(entry)
            if entry.filename == "modelDescription.xml":
                text = content.decode()
                content = re.sub(r"<CoSimulation\b[^>]*?(/>|>.*?</CoSimulation>)", "", text, flags=re.S).encode()
                assert b"<ModelExchange" in content
                assert b"<CoSimulation" not in content
            cut.writestr(entry, content)
    return target
