"""`cosim example`: a copy of a shipped scenario or example to begin from."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Annotated

import typer

from cosim.nearest import did_you_mean
from cosim.shipped import SCENARIOS, shipped_examples
from cosim.terminal import as_argument
from cosim.unit.errors import InputError


def _shipped() -> dict[str, Path]:
    return {path.stem: path for path in sorted(SCENARIOS.glob("*.yaml"))} | shipped_examples()


def _complete(incomplete: str) -> list[str]:
    return [name for name in _shipped() if name.startswith(incomplete)]


def example(
    name: Annotated[str, typer.Argument(help="A name of `cosim list`, or `rig`.", autocompletion=_complete)],
    out: Annotated[Path | None, typer.Option(help="File or folder to make; default: NAME here.")] = None,
) -> None:
    """Copy a shipped scenario, or the example of the diagnosis with its recordings (`rig`), to begin from."""
    known = _shipped()
    if name not in known:
        raise InputError(
            name or "NAME", "", f"there is no such example{did_you_mean(name, known)}", f"one of: {', '.join(known)}"
        )
    source = known[name]
    target = out or Path(source.name)
    if target.exists():
        raise InputError(target, "", "it exists already", "give another name with `--out`")
    quoted = as_argument(target)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, target, copy_function=shutil.copyfile)
            print(
                f"{target}: a scenario and recordings of it; go on with\n"
                f"  cosim diagnose {quoted}/scenario.yaml --recording {quoted}/monday --held-out {quoted}/tuesday "
                f"--out answer"
            )
        else:
            shutil.copyfile(source, target)
            print(f"{target}: edit it, then\n  cosim run {quoted}")
    except OSError as error:
        raise InputError(
            target, "", f"it cannot be written: {error.strerror or error}", "give another place with `--out`"
        ) from error
