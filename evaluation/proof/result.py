"""Result of one case, and how it is kept."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError

from cosim.unit.errors import InputError
from evaluation.proof.reference import Reference
from evaluation.proof.scoring import Score


@dataclass(frozen=True)
class CaseResult:
    """Everything that the tables need about a case.

    Args:
        case: Its name.
        kind: Kind of case.
        setup: Rig.
        engine: What moved the loads or the arm.
        outcome: `diagnosed`, `refused`, `failed` or `timed out`.
        message: Why there is no diagnosis.
        seconds: Wall time of the diagnosis, from the start of its process to its end.
        score: See there.
        reference: What the data allow.
    """

    case: str
    kind: str
    setup: str
    engine: str
    outcome: str
    message: str
    seconds: float
    score: Score
    reference: Reference

    @property
    def is_refused(self) -> bool:
        """Whether the diagnosis said that it cannot work with such a scenario: it is counted apart."""
        return self.outcome == "refused"


_RESULTS = TypeAdapter(list[CaseResult])


def write_results(results: Sequence[CaseResult], about: dict[str, Any], path: Path) -> None:
    """Write results.json.

    Args:
        results: One per case.
        about: What was asked for, and of which version.
        path: The file.
    """
    content = {"about": about, "cases": [asdict(r) for r in results]}
    path.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def read_results(folder: Path) -> tuple[dict[str, Any], list[CaseResult]]:
    """What was asked for and the results of a proof.

    Raises:
        InputError: The folder has no results.json of this version.
    """
    path = folder / "results.json"
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        return content["about"], _RESULTS.validate_python(content["cases"])
    except OSError as error:
        raise InputError(
            path, "", f"cannot be read: {error.strerror}", "give a folder of `cosim prove --out`"
        ) from error
    except (ValueError, KeyError, TypeError, ValidationError) as error:
        raise InputError(path, "", "is no result of this version's `cosim prove`", "run it again") from error


def row(result: CaseResult) -> dict[str, object]:
    """One line of results.csv: single values, several effects joined by `;`."""
    scored, reference = result.score, result.reference
    effects = scored.effects
    held = scored.held_out

    def joined(name: str) -> str:
        values = [getattr(e, name) for e in effects]
        return ";".join("" if v is None else str(v) for v in values)

    return {
        "case": result.case,
        "kind": result.kind,
        "setup": result.setup,
        "engine": result.engine,
        "outcome": result.outcome,
        "message": result.message,
        "seconds": round(result.seconds, 2),
        "verdict": scored.verdict,
        "verdict_right": scored.is_verdict_right,
        "false_alarm": scored.is_false_alarm,
        **{name: joined(name) for name in ("effect", "unit", "strength", "found", "found_unit", "found_place", "gain")},
        **{
            name.removeprefix("is_"): joined(name)
            for name in ("is_unit_right", "is_place_right", "is_time_right", "is_named", "is_in_class", "is_misnamed")
        },
        "spare": scored.spare,
        "after": held.after,
        "ratio": held.ratio,
        "share": held.share,
        "recalibrated": reference.recalibrated,
        "oracle": reference.oracle,
        "twin": reference.twin,
        "floor": reference.floor,
        "training_gain": reference.training_gain,
        **{f"baseline_{n}": v for n, v in reference.baselines.items()},
        "sparse_terms": reference.terms,
        "reference_failure": reference.failure,
    }
