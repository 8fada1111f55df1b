"""Hook of mkdocs: notebooks are pages of the site. Their cells are shown as they stand, without being run."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File

NOTEBOOKS = Path(__file__).resolve().parents[1] / "docs" / "notebooks"


def on_files(files: Any, config: Any) -> Any:
    """Put a page in the place of every notebook."""
    for path in sorted(NOTEBOOKS.glob("*.ipynb")):
        files.append(File.generated(config, f"notebooks/{path.stem}.md", content=page(path)))
    return files


def page(path: Path) -> str:
    """A notebook as Markdown, with how to run it."""
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    parts = ["".join(cell["source"]) for cell in cells]
    shown = [f"```python\n{text}\n```" if cell["cell_type"] == "code" else text for cell, text in zip(cells, parts)]
    run = f"Run it in a clone, after `pip install jupyterlab`: `jupyter lab docs/notebooks/{path.name}`."
    return "\n\n".join([shown[0], run, *shown[1:]]) + "\n"
