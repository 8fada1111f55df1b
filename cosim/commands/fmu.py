"""`cosim fmu ...`: build, export, inspect and validate FMUs, or begin a new one."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from cosim.fmu_tools.sources import Language
from cosim.terminal import as_argument
from cosim.unit.errors import InputError

app = typer.Typer(no_args_is_help=True, help="Build, export, inspect and validate FMUs; begin an actuator of your own.")

Coils = Annotated[int, typer.Option(min=1, max=100_000, help="Number of coils (FMI 3.0: until an importer sets it).")]
Version = Annotated[int, typer.Option("--fmi", help="FMI version, 2 or 3.")]
File = Annotated[Path, typer.Argument(help="A .fmu file.")]


def _checked(version: int) -> int:
    if version not in (2, 3):
        raise InputError("--fmi", "", f"there is no FMI {version}", "give 2 or 3")
    return version


@app.command()
def new(
    name: Annotated[str, typer.Argument(help="Folder to make; it names the actuator.")],
    language: Annotated[Language, typer.Option(help="Language of its equations.")] = Language.C,
) -> None:
    """Begin an actuator of your own: a folder with equations, a scenario and everything that FMI asks for."""
    from cosim.fmu_tools.new import begin

    folder = begin(name, language)
    quoted = as_argument(folder)
    source = "config.h and model.c" if language is Language.C else "actuator.py"
    print(f"{folder}: edit {source}, then\n  cosim fmu build {quoted}\n  cosim run {quoted}/scenario.yaml")


@app.command()
def build(
    source: Annotated[str, typer.Argument(help="A folder with an actuator, or the name of a shipped one.")],
    coils: Coils = 36,
    version: Version = 3,
    out: Annotated[
        Path | None, typer.Option(help="Folder, or file ending in .fmu; default: the source folder.")
    ] = None,
) -> None:
    """Compile an actuator and pack it as an FMU."""
    from cosim.fmu_tools.build import build as build_fmu

    target, warnings = build_fmu(source, _checked(version), coils, out)
    for warning in warnings:
        print(warning)
    print(target)


@app.command()
def export(
    name: Annotated[str, typer.Argument(help="Name of a shipped actuator.")],
    coils: Coils = 36,
    version: Version = 3,
    out: Annotated[Path, typer.Option(help="Folder, or file ending in .fmu.")] = Path(),
) -> None:
    """Write a shipped actuator for other tools: any size, with its sources and licence inside."""
    from cosim.fmu_tools.build import export as export_fmu

    print(export_fmu(name, _checked(version), coils, out))


@app.command()
def info(file: File, is_json: Annotated[bool, typer.Option("--json", help="As JSON.")] = False) -> None:
    """Show what an FMU is: versions, interfaces, capabilities, variables, whether it is an actuator."""
    from rich.console import Console

    from cosim.fmu_tools.info import read_info, show_info

    found = read_info(file)
    if is_json:
        print(json.dumps(found.as_dict(), indent=2))
    else:
        show_info(file, found, Console())


@app.command()
def validate(file: File) -> None:
    """Check an FMU: description, binary, symbols, behaviour. The exit code is 1 where a check fails."""
    from rich.console import Console

    from cosim.fmu_tools.validate import validate as validate_fmu

    console, failed = Console(highlight=False, soft_wrap=True), 0
    for name, verdict in validate_fmu(file):
        word = {True: "[green]pass[/]", False: "[bold red]FAIL[/]", None: "[dim]  - [/]"}[verdict.is_met]
        console.print(f"{word}  {name}: ", end="")
        console.print(verdict.text, markup=False)
        failed += verdict.is_met is False
    print(
        f"{file}: {'every check passes' if not failed else f'{failed} check' + ('s fail' if failed > 1 else ' fails')}"
    )
    raise typer.Exit(1 if failed else 0)
