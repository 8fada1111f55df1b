"""The binding of an FMU's FMI version."""

from __future__ import annotations

from cosim.fmu.archive import FmuArchive
from cosim.fmu.binding import Binding, Interface
from cosim.fmu.fmi2 import Fmi2Binding
from cosim.fmu.fmi3 import Fmi3Binding
from cosim.unit.errors import InputError


def bind(archive: FmuArchive, interface: Interface, name: str) -> Binding:
    """Load an FMU with the binding of its FMI version.

    Raises:
        InputError: FMI 1.0, or the interface is not offered, or the binary cannot be loaded.
    """
    version = archive.description.fmiVersion
    if version.startswith("3"):
        return Fmi3Binding(archive, interface, name)
    if version.startswith("2"):
        return Fmi2Binding(archive, interface, name)
    raise InputError(archive.path, "modelDescription.xml", f"FMI {version} is not supported", "export it as FMI 2 or 3")
