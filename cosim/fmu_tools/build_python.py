"""An actuator in Python to an FMU, through pythonfmu3."""

from __future__ import annotations

import hashlib
import re
import shutil
import tempfile
from pathlib import Path

from cosim.unit.errors import InputError


def build_python(folder: Path, version: int, coils: int, target: Path) -> list[str]:
    """Pack the FMU of a folder with actuator.py.

    Args:
        folder: Holds actuator.py and what it imports.
        version: FMI version; pythonfmu3 makes 3 only.
        coils: Start value of the structural parameter.
        target: The .fmu file to write.

    Returns:
        No warnings.

    Raises:
        InputError: pythonfmu3 is not installed, the version is not 3, or the module cannot be loaded.
    """
    if version != 3:
        raise InputError(folder, "--fmi", "an actuator in Python becomes an FMI 3.0 FMU", "leave out `--fmi 2`")
    try:
        from pythonfmu3.builder import FmuBuilder
    except ImportError as error:
        raise InputError(folder, "", "pythonfmu3 is not installed", "pip install pythonfmu3") from error
    name, source = class_name(folder), (folder / "actuator.py").read_bytes()
    with tempfile.TemporaryDirectory(prefix="cosim-build-") as scratch:
        size = Path(scratch) / "coils.txt"
        size.write_text(f"{coils}\n")
        # Python keeps one module per name: two FMUs in one process must not both bring an `actuator`.
        module = Path(scratch) / f"{name}_{hashlib.sha256(source).hexdigest()[:8]}.py"
        module.write_bytes(source)
        others = [p for p in folder.glob("*.py") if p.name != "actuator.py"]
        options = {"needsExecutionTool": False, "canGetAndSetFMUState": True, "canSerializeFMUState": True}
        try:
            made = FmuBuilder.build_FMU(module, scratch, [*others, size], **options)
        except InputError:
            raise
        except Exception as error:  # whatever the user's module raises
            raise InputError(
                folder / "actuator.py", "", f"it cannot be built: {type(error).__name__}: {error}", "correct the module"
            ) from error
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.move(made, target)
    return []


def class_name(folder: Path) -> str:
    """Name of the actuator's class, which names the FMU.

    Raises:
        InputError: actuator.py defines none.
    """
    text = (folder / "actuator.py").read_text(encoding="utf-8")
    match = re.search(r"^class (\w+)\([^)]*\bFmi3Slave\b[^)]*\):", text, re.MULTILINE)
    if match is None:
        raise InputError(
            folder / "actuator.py",
            "",
            "it defines no class derived from CoilActuator and Fmi3Slave",
            "class my_actuator(CoilActuator, Fmi3Slave): ...",
        )
    return match[1]
