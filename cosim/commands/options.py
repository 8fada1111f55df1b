"""Arguments and options that several commands share."""

from __future__ import annotations

import importlib.metadata
from typing import Annotated

import typer

from cosim.shipped import SCENARIOS


def complete_scenario(incomplete: str) -> list[str]:
    """Names of shipped scenarios for tab completion; the shell completes files by itself."""
    return sorted(path.stem for path in SCENARIOS.glob("*.yaml") if path.stem.startswith(incomplete))


def show_version(wanted: bool) -> None:
    """Print name and version and end the program."""
    if wanted:
        print(f"cosim {version()}")
        raise typer.Exit


def version() -> str:
    """Version of the installed package, `unknown` where it is imported from a folder that was never installed."""
    try:
        return importlib.metadata.version("active-chainmail")
    except importlib.metadata.PackageNotFoundError:
        return "unknown"


ScenarioArgument = Annotated[
    str,
    typer.Argument(
        help="A scenario file, or the name of a shipped scenario.", autocompletion=complete_scenario
    ),
]
Changes = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="KEY=VALUE", help="Replace a key of the scenario: `--set fabric.rows=8`; may be given again."
    ),
]
