"""Hook of mkdocs: pages of the tree outside docs/ are part of the site, and links between all of them hold.

In the tree a document links to files by their place; a site has only pages and pictures. Links to other pages are
rewritten, links to files that are no page (sources, folders) become plain text.
"""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
#: Where pages of the tree outside docs/ stand in the site.
OUTSIDE = "tree"
_PAGES = (
    "README.md",
    "CONTRIBUTING.md",
    "CHANGELOG.md",
    "fmus/README.md",
    "fmus/*/README.md",
    "benchmarks/results/*.md",
    "benchmarks/models/README.md",
    "benchmarks/peers/README.md",
)
#: A link, or code, in which brackets are no link.
_LINK = re.compile(r"(?P<code>`[^`\n]*`)|(?P<before>!?\[(?P<text>(?:[^\[\]]|\[[^\]]*\])*)\])\((?P<target>[^)\s]+)\)")


def on_files(files: Any, config: Any) -> Any:
    """Add the pages outside docs/."""
    for pattern in _PAGES:
        for path in sorted(ROOT.glob(pattern)):
            text = path.read_text(encoding="utf-8")
            files.append(File.generated(config, _place(path), content=text))
    return files


def on_page_markdown(markdown: str, page: Any, config: Any, files: Any) -> str:
    """Rewrite the links of a page."""
    uri = page.file.src_uri
    source = ROOT / uri.removeprefix(f"{OUTSIDE}/") if uri.startswith(f"{OUTSIDE}/") else DOCS / uri
    known = {file.src_uri for file in files}

    def rewritten(match: re.Match[str]) -> str:
        if match["code"]:
            return match[0]
        target, hash_mark, anchor = match["target"].partition("#")
        if not target or re.match(r"[a-z]+:", target):
            return match[0]
        path = Path(os.path.normpath(source.parent / target))
        place = _place(path / "README.md" if path.is_dir() else path)
        if place in known:
            return f"{match['before']}({os.path.relpath(place, os.path.dirname(uri) or '.')}{hash_mark}{anchor})"
        return match["text"]

    parts = re.split(r"(^```.*?^```)", markdown, flags=re.MULTILINE | re.DOTALL)
    return "".join(part if n % 2 else _LINK.sub(rewritten, part) for n, part in enumerate(parts))


def _place(path: Path) -> str:
    """Where a file stands in the site."""
    if path.is_relative_to(DOCS):
        return path.relative_to(DOCS).as_posix()
    return f"{OUTSIDE}/{path.relative_to(ROOT).as_posix()}" if path.is_relative_to(ROOT) else ""
