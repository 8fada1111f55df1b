"""Read an FMU's modelDescription.xml: what must be right is refused, lesser faults are warned of."""

from __future__ import annotations

import logging
import tempfile
import zipfile
from pathlib import Path
from xml.etree import ElementTree

from fmpy.model_description import ModelDescription, ValidationError, read_model_description

from cosim.fmu.rules import check_rules
from cosim.fmu.sizes import MOST_XML
from cosim.unit.errors import InputError

_LOG = logging.getLogger(__name__)
FILE = "modelDescription.xml"


def read_description(path: Path, folder: Path) -> ModelDescription:
    """The description of an extracted FMU.

    Args:
        path: The .fmu file, for errors and warnings.
        folder: Where it is extracted.

    Raises:
        InputError: There is none, it is too large, cannot be read, or breaks a rule of `cosim.fmu.rules`.
    """
    file = folder / FILE
    if not file.is_file():
        raise InputError(path, "", f"there is no {FILE} in it", "an FMU holds one at its top level")
    if file.stat().st_size > MOST_XML:
        raise InputError(
            path,
            FILE,
            f"it has {file.stat().st_size >> 20} MiB, more than {MOST_XML >> 20}",
            "export the FMU with fewer variables",
        )
    try:
        description = _parse(path, folder)
        _complete(description, file)
    except InputError:
        raise
    except Exception as error:  # fmpy raises bare Exception for most defects
        raise InputError(
            path, FILE, f"it cannot be read: {_first_line(error)}", "check it with `fmpy validate`"
        ) from error
    return description


def read_packed_description(path: Path) -> ModelDescription:
    """The description of an FMU that is not extracted, whatever platform it is for.

    Raises:
        InputError: It is no archive, or as `read_description`.
    """
    with tempfile.TemporaryDirectory(prefix="cosim-description-") as folder:
        try:
            with zipfile.ZipFile(path) as archive:
                if FILE in archive.namelist() and archive.getinfo(FILE).file_size <= MOST_XML:
                    Path(folder, FILE).write_bytes(archive.read(FILE))
        except (OSError, zipfile.BadZipFile, RuntimeError, NotImplementedError, EOFError) as error:
            raise InputError(
                path, "", f"this is not an FMU: {error}", "an FMU is a zip archive; export it again"
            ) from error
        return read_description(path, Path(folder))


def _parse(path: Path, folder: Path) -> ModelDescription:
    """A description that breaks a rule but can be read is used, with a warning: other tools run such FMUs."""
    try:
        description = read_model_description(folder, validate=True)
        check_rules(path, description)
        return description
    except ValidationError as error:
        description = read_model_description(folder, validate=False)
        check_rules(path, description)  # what is refused need not be warned of
        more = f" (and {len(error.problems) - 1} more)" if len(error.problems) > 1 else ""
        _LOG.warning("%s: %s is not valid: %s%s", path.name, FILE, error.problems[0], more)
        return description


def _complete(description: ModelDescription, file: Path) -> None:
    """What fmpy 0.3 leaves out: all start values of String and Binary arrays (a tuple), bounds of unsigned integers."""
    variables = {v.name: v for v in description.modelVariables}
    root = ElementTree.parse(file).getroot()
    for element in root.iterfind("ModelVariables/*"):
        if element.tag.startswith("UInt"):
            variable = variables[element.attrib["name"]]
            variable.min, variable.max = element.get("min"), element.get("max")
        starts = element.findall("Start")
        if len(starts) > 1:
            variables[element.attrib["name"]].start = tuple(start.attrib.get("value", "") for start in starts)


def _first_line(error: Exception) -> str:
    if isinstance(error, KeyError):  # fmpy looks up value references and names of types so
        return f"it refers to {error}, which is not there"
    return str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__
