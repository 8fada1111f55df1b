"""Writes what a public data set holds as a recording folder."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd  # type: ignore[import-untyped]
import yaml

from cosim.unit.protocol import AnyArray


@dataclass(frozen=True)
class Part:
    """One recording of a data set.

    Args:
        name: Folder.
        title: One line.
        columns: Column to its values, shape (rows,) each; the clock's column is `time`.
        sidecar: Keys of recording.yaml beside title, source and table.
    """

    name: str
    title: str
    columns: Mapping[str, AnyArray]
    sidecar: Mapping[str, Any]


@dataclass(frozen=True)
class DataSet:
    """One public data set, as a task for the diagnosis.

    Args:
        name: Folder.
        scenario: Shipped scenario that it is compared with.
        source: Where it is published, and its licence.
        parts: Its recordings.
        splits: Name of a task to its training recordings and its held-out ones.
    """

    name: str
    scenario: str
    source: str
    parts: tuple[Part, ...]
    splits: Mapping[str, tuple[tuple[str, ...], tuple[str, ...]]] = field(default_factory=dict)


def write_data_set(data: DataSet, out: Path) -> list[Path]:
    """Write every recording of a data set, and `splits.yaml` beside them.

    Returns:
        The folders.
    """
    folders = []
    for part in data.parts:
        folder = out / data.name / part.name
        folder.mkdir(parents=True, exist_ok=True)
        # repr-exact: what was published is what is compared
        pd.DataFrame(dict(part.columns)).to_csv(folder / "data.csv", index=False)
        sidecar = {"title": part.title, "source": data.source, "table": "data.csv", **part.sidecar}
        text = yaml.safe_dump(sidecar, sort_keys=False, allow_unicode=True, width=110)
        (folder / "recording.yaml").write_text(text, encoding="utf-8")
        folders.append(folder)
    splits = {n: {"training": list(t), "held_out": list(h)} for n, (t, h) in data.splits.items()}
    text = yaml.safe_dump({"scenario": data.scenario, "splits": splits}, sort_keys=False)
    (out / data.name / "splits.yaml").write_text(text, encoding="utf-8")
    return folders
