"""An actuator in C to an FMU: the same commands as fmus/Makefile, for a folder anywhere.

A test compares the archives of both, byte by byte.
"""

from __future__ import annotations

import os
import re
import runpy
import shlex
import shutil
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import fmpy

from cosim.shipped import FMUS
from cosim.unit.errors import InputError

WARNINGS = ("-std=c99", "-Wall", "-Wextra", "-Wpedantic")
_SHARED = ("variables.c", "instance.c", "states.c", "snapshot.c")
_VERSION_SOURCES = ("fmi{}.c", "fmi{}_state.c", "fmi{}_model_exchange.c", "fmi{}_absent.c")
_HEADERS = ("model.h", "variables.h", "instance.h")
_IDENTIFIER = re.compile(r'^\s*#define\s+MODEL_IDENTIFIER\s+"(\w+)"', re.MULTILINE)


def model_identifier(folder: Path) -> str:
    """`MODEL_IDENTIFIER` of a folder's config.h.

    Raises:
        InputError: There is none.
    """
    match = _IDENTIFIER.search((folder / "config.h").read_text(encoding="utf-8"))
    if match is None:
        raise InputError(
            folder / "config.h", "MODEL_IDENTIFIER", "it is not defined", 'add `#define MODEL_IDENTIFIER "my_actuator"`'
        )
    return match[1]


def build_c(folder: Path, version: int, coils: int, target: Path) -> list[str]:
    """Compile and pack the FMU of a folder with config.h and model.c.

    Args:
        folder: Holds config.h and model.c; index.html, if there, becomes its documentation.
        version: FMI version, 2 or 3.
        coils: Number of coils; for FMI 3.0 the start value of the structural parameter.
        target: The .fmu file to write.

    Returns:
        Warnings of the compiler.

    Raises:
        InputError: There is no compiler, or the sources do not compile; its messages are in the error.
    """
    identifier = model_identifier(folder)
    with tempfile.TemporaryDirectory(prefix="cosim-build-") as scratch:
        root = Path(scratch) / "fmu"
        sources = root / "sources"
        names = ["model.c", *_SHARED, *(text.format(version) for text in _VERSION_SOURCES)]
        _lay_out(folder, root, names, coils)
        describe = Path(scratch) / "describe"
        generator = [str(FMUS / "fmi" / n) for n in ("describe.c", "describe_variables.c", "variables.c")]
        binary = f"{identifier}{fmpy.sharedLibraryExtension}"
        library = Path("..", "binaries", fmpy.platform_tuple if version == 3 else fmpy.platform, binary)
        (sources / library).parent.resolve().mkdir(parents=True)
        include = ["-I.", "-isystem", str(Path(fmpy.__file__).parent / "c-code")]
        flags = ["-fPIC", "-fvisibility=hidden", "-shared", *include]
        with ThreadPoolExecutor(1) as pool:  # the compiler runs twice at the same time
            built = pool.submit(_compile, folder, [*WARNINGS, *flags, "-o", str(library), *names, "-lm"], sources)
            # This program runs once: to optimise it takes longer than it runs.
            said = _compile(folder, ["-O0", *WARNINGS, f"-I{sources}", "-o", str(describe), *generator], FMUS)
            said += built.result()
        (root / "modelDescription.xml").write_bytes(_output(folder, describe, str(version)))
        if version == 3:
            (sources / "buildDescription.xml").write_bytes(_output(folder, describe, "build"))
        target.parent.mkdir(parents=True, exist_ok=True)
        runpy.run_path(str(FMUS / "pack.py"))["pack"](root, target)
    return said


def _lay_out(folder: Path, root: Path, names: list[str], coils: int) -> None:
    """Copy what the FMU holds beside its binary: sources, licence, documentation."""
    sources, licences = root / "sources", root / "documentation" / "licenses"
    sources.mkdir(parents=True)
    licences.mkdir(parents=True)
    for name in (*names, *_HEADERS):
        shutil.copy(folder / name if name == "model.c" else FMUS / "fmi" / name, sources)
    shutil.copy(folder / "config.h", sources)
    (sources / "size.h").write_text(f"#define COILS {coils}\n")
    own = folder / "licence.txt"
    shutil.copy(own if own.is_file() else FMUS / "documentation" / "licence.txt", licences / "license.txt")
    if (folder / "index.html").is_file():
        shutil.copy(folder / "index.html", root / "documentation")


def _compile(folder: Path, arguments: list[str], where: Path) -> list[str]:
    compiler = shlex.split(os.environ.get("CC", "gcc"))
    flags = shlex.split(os.environ.get("CFLAGS", "-O2"))
    try:
        done = subprocess.run([*compiler, *flags, *arguments], cwd=where, capture_output=True, text=True, check=False)
    except OSError as error:
        remedy = "install gcc (Debian, Ubuntu: build-essential), or name another: CC=clang"
        raise InputError(compiler[0], "", f"there is no such C compiler: {error.strerror}", remedy) from error
    if done.returncode:
        lines = [line for line in done.stderr.splitlines() if "error" in line][:5] or done.stderr.splitlines()[:5]
        raise InputError(folder, "", "it does not compile:\n  " + "\n  ".join(lines), "correct the source")
    return [line for line in done.stderr.splitlines() if "warning:" in line]


def _output(folder: Path, program: Path, argument: str) -> bytes:
    done = subprocess.run([program, argument], capture_output=True, check=False)
    if done.returncode:
        raise InputError(
            folder / "config.h",
            "",
            f"no model description: {done.stderr.decode(errors='replace')}",
            "correct the table",
        )
    return done.stdout
