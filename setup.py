"""What pyproject.toml cannot say: what a wheel holds, and that one wheel serves every Python.

It holds scenarios, actuators, templates and examples, and no evaluation. Its library in C knows nothing of Python.

These go into `cosim/data`, under their names in the tree; cosim/shipped.py finds them there. A clone that is installed
with `pip install -e` uses its own folders.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from setuptools import setup
from setuptools.command.bdist_wheel import bdist_wheel
from setuptools.command.build_ext import build_ext
from setuptools.command.build_py import build_py

#: Folders of the tree, and which files of them.
PACKED = {
    "scenarios": ("*.yaml", "*.json"),
    "fmus": ("*.c", "*.h", "*.html", "*.py", "*.txt", "*.md", "Makefile"),
    "templates": ("*.c", "*.h", "*.html", "*.py", "*.yaml"),
    "docs/examples": ("*.yaml", "*.csv", "*.py"),
}
#: Packages of a clone that no wheel has: evidence, not product.
LEFT_OUT = {"evaluation"}


class BuildWithData(build_py):
    """Copies the folders of `PACKED` beside the modules."""

    def run(self) -> None:
        if not self.editable_mode:
            self.packages = [p for p in self.packages if p.split(".")[0] not in LEFT_OUT]
        super().run()
        if self.editable_mode:
            return
        target = Path(self.build_lib) / "cosim" / "data"
        shutil.rmtree(target, ignore_errors=True)  # what an earlier build has left
        for folder, patterns in PACKED.items():
            for file in sorted({f for p in patterns for f in Path(folder).rglob(p) if "__pycache__" not in f.parts}):
                (target / file).parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(file, target / file)


class PlainLibrary(build_ext):
    """Names the library as cosim/native/compiled.py looks for it, without the version of a Python."""

    def get_ext_filename(self, fullname: str) -> str:
        return str(Path(*fullname.split("."))) + (".dll" if sys.platform == "win32" else ".so")


class AnyPython(bdist_wheel):
    """Tags the wheel for its platform and any Python that `requires-python` allows."""

    def get_tag(self) -> tuple[str, str, str]:
        return "py3", "none", super().get_tag()[2]


setup(cmdclass={"build_py": BuildWithData, "build_ext": PlainLibrary, "bdist_wheel": AnyPython})
