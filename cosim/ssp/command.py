"""`cosim ssp`: import, export and validation of SSP files."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from cosim.alone import alone
from cosim.loading import load_scenario
from cosim.options import Changes, ScenarioArgument
from cosim.unit.errors import InputError

if TYPE_CHECKING:
    from cosim.scenario import Scenario
    from cosim.ssp.namespaces import Version

app = typer.Typer(no_args_is_help=True, help="System Structure and Parameterization (SSP) 1.0 and 2.0.")

FileArgument = Annotated[Path, typer.Argument(help="An .ssp file, or the .ssd file of an unpacked one.")]
SchemaOption = Annotated[
    Path | None, typer.Option(help="Folder with the standard's schemas of SSP 2.0, to check against them too.")
]
VariantOption = Annotated[str, typer.Option(help="Another .ssd file of the package than SystemStructure.ssd.")]


@app.command("import")
def import_command(
    file: FileArgument,
    out: Annotated[Path, typer.Option(help="Folder for scenario.yaml, FMUs and parameter sets; empty or absent.")],
    start: Annotated[str | None, typer.Option(help="Start time, for example `0 s`.")] = None,
    stop: Annotated[str | None, typer.Option(help="Stop time, where the SSP gives none, or instead of it.")] = None,
    step: Annotated[str | None, typer.Option(help="Macro-step; SSP itself has no place for it.")] = None,
    output_step: Annotated[str | None, typer.Option(help="Interval of recorded values; default: every step.")] = None,
    algorithm: Annotated[str | None, typer.Option(help="jacobi (default), gauss_seidel, iterated, ...")] = None,
    variant: VariantOption = "",
    schema: SchemaOption = None,
) -> None:
    """Import an SSP as a scenario that `cosim run` runs."""
    from cosim.ssp.import_time import TimeRequest
    from cosim.ssp.importer import import_ssp
    from cosim.ssp.schemas import named_schemas

    with named_schemas(schema), alone(out, "import"):
        imported = import_ssp(file, out, TimeRequest(start, stop, step, output_step, algorithm), variant)
    _print_notes(imported.notes)
    for path, name in imported.names.items():
        print(f"{path} is the component {name}")
    print(imported.scenario)


@app.command("export")
def export_command(
    scenario: ScenarioArgument,
    out: Annotated[Path, typer.Option(help="The .ssp file.")],
    version: Annotated[Literal["1", "2"], typer.Option(help="Version of SSP.")] = "2",
    only_fmus: Annotated[
        bool, typer.Option("--only-fmus", help="Leave out what is no FMU, for tools that know FMUs alone.")
    ] = False,
    changes: Changes = None,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace the file that is there.")] = False,
) -> None:
    """Export a scenario as an SSP."""
    from cosim.ssp.export import export_ssp  # late: `--help` must not load Bullet

    if out.suffix.lower() != ".ssp":
        raise InputError("--out", "", f"`{out}` does not end in .ssp", "give a file name that ends in .ssp")
    if out.is_file() and not overwrite:
        raise InputError(
            out, "", "it exists already", "replace it with `--overwrite`, or give another name with `--out`"
        )
    number: Version = "1.0" if version == "1" else "2.0"
    _print_notes(export_ssp(load_scenario(scenario, changes or ()), out, number, only_fmus))
    print(out)


@app.command("validate")
def validate_command(file: FileArgument, variant: VariantOption = "", schema: SchemaOption = None) -> None:
    """Check an SSP against schemas (1.0) or our rules (2.0), and its connections and parameters against its FMUs."""
    from cosim.ssp.importer import check_ssp
    from cosim.ssp.schemas import named_schemas

    with named_schemas(schema):
        structure, notes = check_ssp(file, variant)
    _print_notes(notes)
    print(f"{file}: valid SSP {structure.version}, `{structure.name}`")


def is_ssp(scenario: str) -> bool:
    """Whether an argument names an SSP rather than a scenario."""
    return Path(scenario).suffix.lower() in (".ssp", ".ssd")


def scenario_of(file: Path, folder: Path, changes: Sequence[str] = ()) -> Scenario:
    """Scenario of an SSP, imported into `folder`, which a run in the same place may have left behind."""
    from cosim.ssp.importer import import_ssp

    if (folder / "scenario.yaml").is_file():
        shutil.rmtree(folder)
    imported = import_ssp(file, folder)
    _print_notes(imported.notes)
    return load_scenario(imported.scenario, changes)


def _print_notes(notes: list[str] | tuple[str, ...]) -> None:
    for note in notes:
        print(f"note: {note}", file=sys.stderr)
