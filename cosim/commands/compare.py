"""`cosim compare`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from cosim.options import Changes, complete_scenario
from cosim.unit.errors import InputError


def compare(
    scenario: Annotated[
        str,
        typer.Argument(
            help="A scenario file or name, with a component of kind actuator.", autocompletion=complete_scenario
        ),
    ],
    actuators: Annotated[
        str, typer.Option(help="Shipped names or .fmu files, with commas; default: all shipped.")
    ] = "",
    fmi: Annotated[int | None, typer.Option(min=2, max=3, help="FMI version; default: the scenario's.")] = None,
    component: Annotated[str | None, typer.Option(help="Which actuator, where the scenario has several.")] = None,
    out: Annotated[Path | None, typer.Option(help="Folder; default runs/compare/SCENARIO.")] = None,
    jobs: Annotated[int, typer.Option(min=1, help="Runs at the same time.")] = 2,
    changes: Changes = None,
) -> None:
    """Run one scenario over several actuators and show delay, energy, stiffness and shape side by side.

    Ctrl-C keeps what is computed; the same command goes on from there.
    """
    from chainmail.compare.command import Request
    from chainmail.compare.command import compare as compare_actuators

    names = tuple(name.strip() for name in actuators.split(",") if name.strip())
    if actuators.strip() and not names:
        raise InputError("--actuators", "", f"`{actuators}` names no actuator", "leave it out for all shipped ones")
    raise typer.Exit(compare_actuators(Request(scenario, names, fmi, component, jobs, tuple(changes or ())), out))
