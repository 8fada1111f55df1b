"""How much better: fit before, recalibrated and amended, on recordings held out and in training."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from diagnosis.judge.diagnosis import ChannelFit, ChannelSpread, Spread
from diagnosis.report.display import UNKNOWN, number
from diagnosis.report.fits import STAGES, Row, rows, worst_first
from diagnosis.report.section import Cell, Section, section
from diagnosis.report.user_units import IN_SI, Units

TITLE = "How much better"
#: Chi-square per sample up to which a channel counts as met, and above which it counts as missed.
MET, MISSED = 1.2, 2.0


def fit_section(
    fits: Sequence[ChannelFit], spread: Sequence[ChannelSpread] = (), title: str = TITLE, units: Units = IN_SI
) -> Section:
    """Section with a row for each recording and quantity; every channel for itself is folded away.

    Args:
        fits: Of every channel of every recording.
        spread: Of every channel over recordings.
        title: Of the section.
        units: In which quantities are shown.
    """
    return section(
        title,
        "fit.html.j2",
        stages=STAGES,
        grouped=[_grouped(r, units) for r in rows(fits)],
        single=[_single(f, units) for f in worst_first(fits)],
        spread=[_spread(s, units) for s in spread if s.recordings > 1],
        is_judged=any(f.is_held_out for f in fits),
        is_fitted=any(len({f.chi_square.get(s) for s in STAGES}) > 1 for f in fits),
    )


def _spread(spread: ChannelSpread, units: Units) -> list[str]:
    """Mean and range over recordings."""
    factor, _ = units.of(spread.channel).difference(spread.unit)
    return [
        _part(spread, units),
        str(spread.recordings),
        str(spread.samples),
        *(_range(spread.rmse.get(s), factor) for s in STAGES),
        *(_range(spread.chi_square.get(s), 1.0) for s in STAGES),
    ]


def _part(spread: ChannelSpread, units: Units) -> str:
    _, unit = units.of(spread.channel).difference(spread.unit)
    name = f"{spread.channel} [{unit}]" if unit else spread.channel
    return f"{name} ({'held out' if spread.is_held_out else 'training'})"


def _range(spread: Spread | None, factor: float) -> str:
    if spread is None:
        return UNKNOWN
    mean, low, high = (number(factor * v) for v in (spread.mean, spread.lowest, spread.highest))
    return f"{mean} ({low} to {high})"


def _grouped(row: Row, units: Units) -> list[str | Cell]:
    factor, unit = units.of(row.first).difference(row.unit)
    name = f"{row.quantity} [{unit}]" if unit else row.quantity
    least, most = (number(factor * v) for v in row.spread)
    return [
        _titled(row.recording, row.is_held_out),
        name if row.channels == 1 else f"{name}, {row.channels} channels",
        *_cells(row.rmse, factor, row.chi_square, row.whiteness),
        "" if row.channels == 1 else f"{least} to {most}",
    ]


def _single(fit: ChannelFit, units: Units) -> list[str | Cell]:
    factor, unit = units.of(fit.channel).difference(fit.unit)
    name = f"{fit.channel} [{unit}]" if unit else fit.channel
    return [
        _titled(fit.recording, fit.is_held_out),
        name,
        *_cells(fit.rmse, factor, fit.chi_square, fit.whiteness),
    ]


def _titled(recording: str, is_held_out: bool) -> str:
    return f"{recording} ({'held out' if is_held_out else 'training'})"


def _cells(
    rmse: Mapping[str, float], factor: float, chi_square: Mapping[str, float], whiteness: Mapping[str, float]
) -> list[str | Cell]:
    return [
        *(number(factor * rmse.get(s, math.nan)) for s in STAGES),
        *(_marked(chi_square.get(s, math.nan)) for s in STAGES),
        *(number(abs(whiteness.get(s, math.nan))) for s in STAGES),
    ]


def _marked(chi_square: float) -> str | Cell:
    """A cell that tells by its colour whether noise alone is left."""
    if not math.isfinite(chi_square):
        return UNKNOWN
    return Cell(number(chi_square), "met" if chi_square <= MET else "missed" if chi_square > MISSED else "near")
