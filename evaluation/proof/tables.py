"""Results of a proof as a page in Markdown."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from evaluation.proof import breakdown
from evaluation.proof.aims import Aim, aims, counted
from evaluation.proof.headline import VISIBLE
from evaluation.proof.result import CaseResult

_HEAD = """# What the diagnosis reaches on concealed effects

This page is written by `cosim prove`; [proving.md](proving.md) says how recordings are made and how they are scored.
Shares stand with the number of cases and the 95 % interval of Wilson. A case whose diagnosis fails or takes too long
counts as wrong.
"""
_ON_AIMS = f"""Units, elements, times, names and classes are of cases with one effect or one fault of a sensor.
*Visible* are effects whose true terms, fitted to the training recordings, lower -2 log posterior by at least
{VISIBLE:g}: what lies below is absorbed by the parameters and their priors, and nobody can find it in these data.
"""
_ON_EFFECTS = """Named first, by strength; the weakest first. *Gain* is the median of what the true terms explain.
"""
_ON_CONFUSIONS = """Every truth with what was found in its place, but those that were named; `-`: nothing was found.
"""
_ON_SABOTAGE = """Right is the fault, or that nothing can be told; *false claims* name physics that is not there. A
scenario or recording that is *refused* in words has no verdict and makes no claim.
"""
_ON_VERDICTS = """What makes a headline true stands in [proving.md](proving.md).
"""
_ON_RIGS = """*All right*: verdict, units, elements, times and names. Time is that of the whole process, one thread.
"""
_ON_METHODS = """Median chi-square per sample of held-out recordings. All methods have the same recordings; the Gaussian
process and sparse regression start from the recalibrated model. *Terms* are those that SINDy reports per channel. *Ran
away*: forecasts of SINDy that grew without bound. *Without the effect*, of cases outside the catalogue: the
recalibrated model on recordings of the same rig with the same noise and no effect. No model of the effect is asked for
more, since what else the model lacks stays. *Noise alone*: the readings less what they would be without noise.
"""


def short(results: Sequence[CaseResult]) -> str:
    """A line for each aim that has cases, for the terminal."""
    lines = [f"{_mark(a):8}{a.name}: {a.share}, wanted {a.wanted}" for a in aims(results) if a.share.total]
    return "\n".join(lines)


def page_of(about: Sequence[dict[str, Any]], results: Sequence[CaseResult]) -> str:
    """The whole page.

    Args:
        about: What was asked for, of each proof.
        results: Cases of all proofs.
    """
    sections = [
        _HEAD,
        _about(about, results),
        _aims(results),
        _effects(results),
        _units(results),
        _confusions(results),
        _kinds(results),
        _verdicts(results),
        _sabotages(results),
        _rigs(results),
        _methods(results),
        _missing(results),
    ]
    return "\n".join(s for s in sections if s)


def table(header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A table in Markdown."""
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    lines += ["| " + " | ".join(_cell(v) for v in row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def _cell(value: object) -> str:
    if value is None:
        return ""
    return f"{value:.3g}" if isinstance(value, float) else str(value).replace("|", "/")


def _mark(aim: Aim) -> str:
    if not aim.share.total:
        return "no case"
    return "reached" if aim.is_reached else "missed"


def _about(about: Sequence[dict[str, Any]], results: Sequence[CaseResult]) -> str:
    lines = []
    for given in about:
        only = [f"only {given[k]}" for k in ("kinds", "setups") if given.get(k)]
        command = f"`cosim prove --cases {given['cases']} --seed {given['seed']}`"
        if given.get("scored", given["cases"]) < given["cases"]:
            command += f", the {given['scored']} of them that were done"
        lines.append(
            f"- {'; '.join([command, *only, *([given['date']] if 'date' in given else []), *_library(given)])}"
        )
    refused = len(results) - len(counted(results))
    apart = f" {refused} of them were refused in words and are counted apart." if refused else ""
    return "\n".join([*lines, "", f"{len(results)} cases.{apart}", ""])


def _library(given: dict[str, Any]) -> list[str]:
    """Which library the cases were drawn for, and which one diagnosed them if it is another."""
    if "library" not in given:
        return []
    found = [f"library frozen before the draw: {given['library']}"]
    if given.get("library_now", given["library"]) != given["library"]:
        found.append(f"scored with another: {given['library_now']}")
    return found


def _section(title: str, note: str, header: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """A section with a table; nothing where it has no rows."""
    return f"## {title}\n\n{note}{chr(10) if note else ''}{table(header, rows)}" if rows else ""


def _aims(results: Sequence[CaseResult]) -> str:
    rows = [(a.name, a.wanted, a.share, "" if a.visible is None else a.visible, _mark(a)) for a in aims(results)]
    return _section("Aims", _ON_AIMS, ("aim", "wanted", "reached", "reached where visible", ""), rows)


def _effects(results: Sequence[CaseResult]) -> str:
    header = (
        "effect",
        "unit",
        *breakdown.STRENGTHS,
        "unit right",
        "element right",
        "in class",
        "gain",
        "found instead",
    )
    return _section("Effects", _ON_EFFECTS, header, breakdown.by_effect(results))


def _units(results: Sequence[CaseResult]) -> str:
    return _section("Units: truth (down) and finding (across)", "", *breakdown.unit_matrix(results))


def _confusions(results: Sequence[CaseResult]) -> str:
    return _section("Confusions", _ON_CONFUSIONS, ("truth", "found", "cases"), breakdown.confusions(results))


def _kinds(results: Sequence[CaseResult]) -> str:
    header = ("kind", "cases", "verdict right", "headline true", "verdicts", "findings to spare")
    return _section("Kinds of cases", "", header, breakdown.by_kind(results))


def _verdicts(results: Sequence[CaseResult]) -> str:
    return _section("Verdicts", _ON_VERDICTS, ("verdict", "cases", "headline true"), breakdown.by_verdict(results))


def _sabotages(results: Sequence[CaseResult]) -> str:
    header = ("sabotage", "cases", "refused", "verdict right", "false claims", "verdicts")
    return _section("Sabotaged recordings", _ON_SABOTAGE, header, breakdown.by_sabotage(results))


def _rigs(results: Sequence[CaseResult]) -> str:
    header = ("rig", "engine", "cases", "all right", "false alarms", "median time [s]", "longest [s]")
    return _section("Rigs and times", _ON_RIGS, header, breakdown.by_rig(results))


def _methods(results: Sequence[CaseResult]) -> str:
    header = ("kind", "cases", *breakdown.METHODS, "ran away", "terms")
    return _section("Other methods", _ON_METHODS, header, breakdown.by_method(results))


def _missing(results: Sequence[CaseResult]) -> str:
    rows = [(r.case, r.kind, r.setup, r.outcome, r.message) for r in results if r.outcome != "diagnosed"]
    return _section("Cases without a diagnosis", "", ("case", "kind", "rig", "outcome", "message"), rows)
