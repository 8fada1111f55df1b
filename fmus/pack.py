"""Zip a folder into an FMU, with fixed timestamps so that equal contents give equal files.

Usage: python pack.py FOLDER FMU
"""

import sys
import zipfile
from pathlib import Path

#: The earliest time that a zip entry can carry.
EPOCH = (1980, 1, 1, 0, 0, 0)


def pack(folder: Path, fmu: Path) -> None:
    """Write every file below `folder` to the archive `fmu`, in alphabetical order."""
    with zipfile.ZipFile(fmu, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in sorted(p for p in folder.rglob("*") if p.is_file()):
            entry = zipfile.ZipInfo(file.relative_to(folder).as_posix(), EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o100755 if file.suffix in {".so", ".dylib"} else 0o100644) << 16
            archive.writestr(entry, file.read_bytes())


if __name__ == "__main__":
    pack(Path(sys.argv[1]), Path(sys.argv[2]))
