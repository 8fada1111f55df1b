"""What pyproject.toml cannot say: a wheel holds scenarios, actuators, templates and examples, and no evaluation.

They go into `cosim/data`, under their names in the tree; cosim/shipped.py finds them there. A clone that is installed
with `pip install -e` uses its own folders.
"""

from __future__ import annotations

import shutil
from pathlib import Path

from setuptools import setup
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


setup(cmdclass={"build_py": BuildWithData})
