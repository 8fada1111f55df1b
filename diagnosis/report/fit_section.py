"""How much better: fit before, recalibrated and amended, on recordings held out and in training."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from diagnosis.judge.diagnosis import ChannelFit
from diagnosis.report.display import UNKNOWN, difference, number
from diagnosis.report.fits import STAGES, Row, rows, worst_first
from diagnosis.report.markup import Html, element, folded, table

#: Chi-square per sample up to which a channel counts as met, and above which it counts as missed.
MET, MISSED = 1.2, 2.0
_HEAD = (*(f"RMSE {s}" for s in STAGES), "unit", *(f"chi-square {s}" for s in STAGES),
         *(f"whiteness {s}" for s in STAGES))  # fmt: skip


def fit_section(fits: Sequence[ChannelFit]) -> Html:
    """Section with a row for each recording and quantity; every channel for itself is folded away."""
    if not fits:
        return element("section", element("h2", "How much better"), element("p", "No recording was judged."))
    note = (
        "Before: the model as the scenario has it. Recalibrated: its own parameters fitted. After: with the findings. "
        "Chi-square is per sample: about 1 is noise alone. Whiteness is the largest standardised sum of residuals over "
        "a window of time. A row of several channels gives the root mean square of their RMSE (after: with the "
        "smallest and the largest), the mean chi-square and the largest whiteness."
    )
    judged = any(f.is_held_out for f in fits)
    warning = "" if judged else element("p", "No recording was held out: a fit that judges itself proves little.")
    return element(
        "section",
        element("h2", "How much better"),
        warning,
        table(("recording", "", "quantity", *_HEAD), [_grouped(r) for r in rows(fits)]),
        element("p", note, class_="note"),
        folded(f"All {len(fits)} channels, the worst after recalibration first",
               table(("recording", "", "channel", *_HEAD), [_single(f) for f in worst_first(fits)])),
    )  # fmt: skip


def _grouped(row: Row) -> list[str]:
    name = row.quantity if row.channels == 1 else f"{row.quantity} ({row.channels} channels)"
    cells = _cells(row.rmse, row.unit, row.chi_square, row.whiteness)
    if row.channels > 1 and math.isfinite(row.spread[0]):
        factor, _ = difference(row.unit)
        cells[2] += f" ({number(factor * row.spread[0], 2)} to {number(factor * row.spread[1], 2)})"
    return [row.recording, _part(row.is_held_out), name, *cells]


def _single(fit: ChannelFit) -> list[str]:
    return [
        fit.recording,
        _part(fit.is_held_out),
        fit.channel,
        *_cells(fit.rmse, fit.unit, fit.chi_square, fit.whiteness),
    ]


def _part(is_held_out: bool) -> str:
    return "held out" if is_held_out else "training"


def _cells(
    rmse: Mapping[str, float], unit: str, chi_square: Mapping[str, float], whiteness: Mapping[str, float]
) -> list[str]:
    factor, name = difference(unit)
    return [
        *(number(factor * rmse.get(s, math.nan)) for s in STAGES),
        name,
        *(_marked(chi_square.get(s, math.nan)) for s in STAGES),
        *(number(whiteness.get(s, math.nan)) for s in STAGES),
    ]


def _marked(chi_square: float) -> Html:
    """A cell that tells by its colour whether noise alone is left."""
    if not math.isfinite(chi_square):
        return element("td", UNKNOWN)
    word = "met" if chi_square <= MET else "missed" if chi_square > MISSED else "near"
    return element("td", number(chi_square), class_=word)
