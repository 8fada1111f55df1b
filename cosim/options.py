"""Arguments and options that several commands share."""

from __future__ import annotations

from typing import Annotated

import typer

from cosim.nearest import did_you_mean
from cosim.shipped import SCENARIOS
from cosim.unit.errors import InputError


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
    from importlib import metadata  # late: `--help` does without

    try:
        return metadata.version("active-chainmail")
    except metadata.PackageNotFoundError:
        return "unknown"


ScenarioArgument = Annotated[
    str,
    typer.Argument(help="A scenario file, or the name of a shipped scenario.", autocompletion=complete_scenario),
]
Changes = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="KEY=VALUE", help="Replace a key of the scenario: `--set fabric.rows=8`; may be given again."
    ),
]
Formats = Annotated[
    str, typer.Option("--format", metavar="FORMATS", help="Of figures: png, svg, pdf, or several with commas.")
]
#: Formats in which figures are written; cosim.figure_style has the same ones, and a test compares them.
FORMATS = ("png", "svg", "pdf")


def formats_of(given: str) -> list[str]:
    """Formats of `--format`, each once.

    Raises:
        InputError: There is no such format.
    """
    names = list(dict.fromkeys(name.strip().lower() for name in given.split(",") if name.strip()))
    for name in names:
        if name not in FORMATS:
            raise InputError(
                "--format",
                "",
                f"there is no format `{name}`{did_you_mean(name, FORMATS)}",
                f"give one or several of: {', '.join(FORMATS)}",
            )
    if not names:
        raise InputError("--format", "", "no format is given", f"give one or several of: {', '.join(FORMATS)}")
    return names
