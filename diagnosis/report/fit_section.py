"""How much better: fit before, recalibrated and amended, on recordings held out and in training."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from diagnosis.judge.diagnosis import ChannelFit, ChannelSpread, Spread
from diagnosis.report.display import UNKNOWN, number
from diagnosis.report.fits import STAGES, Row, rows, worst_first
from diagnosis.report.markup import Html, element, folded, table
from diagnosis.report.user_units import IN_SI, Units

TITLE = "How much better"
#: Chi-square per sample up to which a channel counts as met, and above which it counts as missed.
MET, MISSED = 1.2, 2.0
_FIGURES = (*STAGES, *STAGES, *STAGES)
_GROUPS = (("RMSE", 3), ("chi-square per sample", 3), ("whiteness", 3))


def fit_section(
    fits: Sequence[ChannelFit], spread: Sequence[ChannelSpread] = (), title: str = TITLE, units: Units = IN_SI
) -> Html:
    """Section with a row for each recording and quantity; every channel for itself is folded away.

    Args:
        fits: Of every channel of every recording.
        spread: Of every channel over recordings.
        title: Of the section.
        units: In which quantities are shown.
    """
    if not fits:
        return element("section", element("h2", title), element("p", "No recording was judged."))
    note = (
        "Before: the model as the scenario has it. Recalibrated: its own parameters fitted. After: with the findings. "
        "A chi-square per sample of about 1 is noise alone. Whiteness is the largest standardised sum of residuals "
        "over a window of time. A row of several channels gives the root mean square of their RMSE, the mean of their "
        "chi-square and the largest whiteness. Squared mismatch, where a share of it is said: residuals squared, in "
        "deviations of the noise, less what noise alone gives."
    )
    if all(len({f.chi_square.get(s) for s in STAGES}) == 1 for f in fits):
        note = (
            "Nothing was fitted: all figures are of the model as the scenario has it. "
            + note.partition("findings. ")[2]
        )
    judged = any(f.is_held_out for f in fits)
    warning = "" if judged else element("p", "No recording was held out: a fit that judges itself proves little.")
    return element(
        "section",
        element("h2", title),
        warning,
        table(
            ("recording", "quantity", *_FIGURES, "after"),
            [_grouped(r, units) for r in rows(fits)],
            (("", 2), *_GROUPS, ("RMSE by channel", 1)),
        ),
        element("p", note, class_="note"),
        folded(
            f"All {len(fits)} channels, the worst after recalibration first",
            table(
                ("recording", "channel", *_FIGURES), [_single(f, units) for f in worst_first(fits)], (("", 2), *_GROUPS)
            ),
        ),
        _over_recordings(spread, units),
    )


def _over_recordings(spread: Sequence[ChannelSpread], units: Units) -> Html:
    """Mean and range over recordings, where there are several of a part."""
    several = [s for s in spread if s.recordings > 1]
    if not several:
        return Html("")
    head = ("channel", "recordings", "samples", *STAGES, *STAGES)
    rows = [
        [
            _part(s, units),
            str(s.recordings),
            str(s.samples),
            *(_range(s.rmse.get(g), units.difference(s.unit)[0]) for g in STAGES),
            *(_range(s.chi_square.get(g), 1.0) for g in STAGES),
        ]
        for s in several
    ]
    groups = (("", 3), ("RMSE, mean (lowest to highest)", 3), ("chi-square per sample", 3))
    return folded("Spread over recordings", table(head, rows, groups))


def _part(spread: ChannelSpread, units: Units) -> str:
    _, unit = units.difference(spread.unit)
    name = f"{spread.channel} [{unit}]" if unit else spread.channel
    return f"{name} ({'held out' if spread.is_held_out else 'training'})"


def _range(spread: Spread | None, factor: float) -> str:
    if spread is None:
        return UNKNOWN
    mean, low, high = (number(factor * v) for v in (spread.mean, spread.lowest, spread.highest))
    return f"{mean} ({low} to {high})"


def _grouped(row: Row, units: Units) -> list[str]:
    factor, unit = units.difference(row.unit)
    name = f"{row.quantity} [{unit}]" if unit else row.quantity
    least, most = (number(factor * v) for v in row.spread)
    return [
        _titled(row.recording, row.is_held_out),
        name if row.channels == 1 else f"{name}, {row.channels} channels",
        *_cells(row.rmse, factor, row.chi_square, row.whiteness),
        "" if row.channels == 1 else f"{least} to {most}",
    ]


def _single(fit: ChannelFit, units: Units) -> list[str]:
    factor, unit = units.difference(fit.unit)
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
) -> list[str]:
    return [
        *(number(factor * rmse.get(s, math.nan)) for s in STAGES),
        *(_marked(chi_square.get(s, math.nan)) for s in STAGES),
        *(number(abs(whiteness.get(s, math.nan))) for s in STAGES),
    ]


def _marked(chi_square: float) -> Html:
    """A cell that tells by its colour whether noise alone is left."""
    if not math.isfinite(chi_square):
        return element("td", UNKNOWN)
    word = "met" if chi_square <= MET else "missed" if chi_square > MISSED else "near"
    return element("td", number(chi_square), class_=word)
