"""`cosim prove`: arguments, files and exit codes."""

from __future__ import annotations

import csv
import os
import sys
from collections.abc import Sequence
from datetime import date
from pathlib import Path
from typing import Annotated, Any

import typer

from cosim.alone import alone
from cosim.run_folder import refuse_unwritable, write_atomically, writing
from cosim.unit.errors import InputError

#: Exit code after Ctrl-C, as shells have it.
INTERRUPTED = 130


def _names(text: str) -> tuple[str, ...]:
    return tuple(n.strip() for n in text.split(",") if n.strip())


def prove(
    cases: Annotated[int, typer.Option(min=1, help="How many cases.")] = 480,
    seed: Annotated[int, typer.Option(min=0, help="Of all draws.")] = 1,
    kinds: Annotated[str, typer.Option(help="Only these kinds of cases, separated by commas.")] = "",
    setups: Annotated[str, typer.Option(help="Only these rigs, separated by commas.")] = "",
    out: Annotated[Path, typer.Option(help="Folder of the proof; what is done there is kept.")] = Path("runs/prove"),
    jobs: Annotated[int | None, typer.Option(min=1, help="Cases at the same time; default: one per core.")] = None,
    cluster: Annotated[str | None, typer.Option(help="Address of a Dask scheduler to use instead.")] = None,
    limit: Annotated[float, typer.Option(min=1.0, help="Longest time of one diagnosis [s].")] = 1200.0,
    resume: Annotated[bool, typer.Option("--resume", help="Insist that there is a proof to go on with.")] = False,
    so_far: Annotated[bool, typer.Option("--so-far", help="No new diagnoses: score those that are done.")] = False,
    baselines: Annotated[bool, typer.Option(help="Try other methods on the same data.")] = True,
    table: Annotated[list[Path] | None, typer.Option(help="No new cases: tables of these proofs together.")] = None,
    page: Annotated[Path | None, typer.Option(help="Where the tables go; default: tables.md in the folder.")] = None,
) -> None:
    """Prove the diagnosis on recordings whose cause is concealed.

    Cases are made, each is diagnosed in a process that is given its recordings alone, and only then are the answers
    opened. Ctrl-C keeps what is done; the same command goes on.
    """
    from evaluation.proof.result import read_results
    from evaluation.proof.tables import page_of

    if table:
        proofs = [read_results(folder) for folder in table]
        target = page or Path("tables.md")
        text = page_of([a for a, _ in proofs], [r for _, rs in proofs for r in rs])
        with writing(target):
            write_atomically(target, text.encode(), is_shared=True)
        print(target)
        return
    if resume and not (out / "ground" / "draw.yaml").is_file():
        raise InputError(out, "", "there is no proof to go on with here", "leave `--resume` away")
    refuse_unwritable(out)
    from evaluation.proof.ground import Draw, drawn_with, library_commit, make_cases
    from evaluation.proof.proof import Effort, Folder
    from evaluation.proof.proof import prove as run
    from evaluation.proof.workers import workers

    if baselines:
        _check_packages()
    draw = Draw(cases, seed, _names(kinds), _names(setups))
    if so_far and not (out / "ground" / "draw.yaml").is_file():
        raise InputError(out, "", "there is no proof here that could be scored", "leave `--so-far` away")
    try:
        with alone(out, "proof"):
            make_cases(out / "ground", draw)  # what is refused needs no workers
            with workers(jobs or _cores(), cluster) as crew:
                results = run(Folder(out), draw, crew, Effort(limit, baselines, so_far))
    except KeyboardInterrupt:
        print(f"interrupted; what is done is kept: go on with the same command, `--out {out}`", file=sys.stderr)
        raise typer.Exit(INTERRUPTED) from None
    about = {
        "cases": cases,
        "scored": len(results),
        "seed": seed,
        "kinds": kinds,
        "setups": setups,
        "date": date.today().isoformat(),
        "library": drawn_with(out / "ground"),
        "library_now": library_commit(),
    }
    write_all(results, about, out, page)


def write_all(results: Sequence[Any], about: dict[str, Any], out: Path, page: Path | None = None) -> None:
    """Write results.json, results.csv and the tables, and print where they are."""
    from evaluation.proof.result import row, write_results
    from evaluation.proof.tables import page_of, short

    write_results(results, about, out / "results.json")
    rows = [row(r) for r in results]
    columns = list(dict.fromkeys(name for r in rows for name in r))
    with (out / "results.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, columns)
        writer.writeheader()
        writer.writerows(rows)
    target = page or out / "tables.md"
    target.write_text(page_of([about], results), encoding="utf-8")
    print(short(results))
    print(target)


def _cores() -> int:
    return (len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()) or 1


def _check_packages() -> None:
    import importlib.util

    missing = [n for n in ("sklearn", "pysindy") if importlib.util.find_spec(n) is None]
    if missing:
        raise InputError(
            "cosim prove",
            "",
            f"the other methods need {' and '.join(missing)}",
            "install them (`make dev`), or give `--no-baselines`",
        )
