"""Cells of tables as people and loggers write them: numbers, dates, and what to write in place of what is none."""

from __future__ import annotations

import re
from collections.abc import Iterable
from datetime import datetime
from pathlib import Path

from cosim.unit.errors import InputError

#: What reads tables of any make.
NEW = "`cosim recording new TABLE --scenario SCENARIO --out FOLDER`"
#: A number with a decimal point, and one with a decimal comma.
POINT = re.compile(r"^\s*[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d+)?\s*$")
COMMA = re.compile(r"^\s*[-+]?(\d+(,\d*)?|,\d+)([eE][-+]?\d+)?\s*$")
#: `24.11.2026 10:00:00,5`: with points the day comes first everywhere. `2026/11/24`: the year does.
_DAY_FIRST = re.compile(
    r"^(?P<day>\d{1,2})\.(?P<month>\d{1,2})\.(?P<year>\d{4})"
    r"([ T]+(?P<clock>\d{1,2}:\d{2}(:\d{2})?)([.,](?P<fraction>\d{1,6})\d*)?)?$"
)
_YEAR_FIRST = re.compile(r"^\d{4}/\d{2}/\d{2}([ T]|$)")
#: A time of day, or one that elapsed: `10:00:00.5`, `1:05:00 PM`. Two numbers may be minutes and seconds as well.
_OF_DAY = re.compile(r"^(\d{1,3}):(\d{2}):(\d{2})(?:[.,](\d+))?(?: ?([AaPp])[Mm])?$")
#: What is no number and no date that is clear: `11/24/2026`, `10:00`, `1.234,5`.
_SLASHED = re.compile(r"^\d{1,2}[/.-]\d{1,2}[/.-]\d{2,4}([ T].*)?$")
_CLOCK = re.compile(r"^\d{1,2}:\d{2}(:\d{2})?([.,]\d+)?( ?[AaPp][Mm])?$")
_THOUSANDS = re.compile(r"^[-+]?(\d{1,3}(\.\d{3})+(,\d*)?|\d{1,3}(,\d{3})+\.\d*|\d{1,3}('\d{3})+([.,]\d*)?)$")


def uses_comma(path: Path, cells: Iterable[str]) -> bool:
    """Whether numbers have a decimal comma.

    Raises:
        InputError: Some have a comma and some a point.
    """
    comma = point = None
    for cell in cells:
        comma = cell if comma is None and "," in cell and COMMA.match(cell) else comma
        point = cell if point is None and "." in cell and POINT.match(cell) else point
    if comma is not None and point is not None:
        what = f"it has decimal commas (`{comma}`) and decimal points (`{point}`)"
        raise InputError(path, "", what, "write all numbers with one of them")
    return comma is not None


def has_thousands(cell: str) -> bool:
    """Whether a cell is a number with a mark between its thousands, such as `1.234,5`."""
    return bool(_THOUSANDS.match(cell.strip()))


def instant(cell: str) -> float | None:
    """Seconds since 1970 of a date in ISO 8601, or with day, month and year between points; None if it is none."""
    text = cell.strip()
    german = _DAY_FIRST.match(text)
    if german is not None:
        fraction = f".{german['fraction']}" if german["fraction"] else ""
        clock = german["clock"] or "0:00"
        hour, minute, *second = clock.split(":")
        text = f"{german['year']}-{german['month']:0>2}-{german['day']:0>2}T{hour:0>2}:{minute}"
        text += f":{second[0]}{fraction}" if second else ""
    elif _YEAR_FIRST.match(text):
        text = text.replace("/", "-", 2)
    elif len(text) < 10 or not text[:4].isdigit() or text[4] != "-":
        return None
    try:
        moment = datetime.fromisoformat(text)
    except ValueError:
        return None
    # without a zone: differences alone count
    return (moment - datetime(1970, 1, 1, tzinfo=moment.tzinfo)).total_seconds()


def time_of_day(cell: str) -> float | None:
    """Seconds since midnight, or since a begin, of hours, minutes and seconds; None if a cell is none.

    >>> time_of_day("10:00:00,5"), time_of_day("1:05:00 PM"), time_of_day("10:00"), time_of_day("10:61:00")
    (36000.5, 47100.0, None, None)
    """
    found = _OF_DAY.match(cell.strip())
    if found is None:
        return None
    hour, minute, second, fraction, half = found.groups()
    hours = int(hour)
    if half:
        if not 1 <= hours <= 12:
            return None
        hours = hours % 12 + (12 if half in "pP" else 0)
    if int(minute) > 59 or int(second) > 59:
        return None
    return 3600.0 * hours + 60.0 * int(minute) + float(f"{second}.{fraction or 0}")


def how_to_write(cell: str) -> str:
    """What to do about a cell that is no number, in words that work when they are followed literally.

    Args:
        cell: As it stands in the table.
    """
    text = cell.strip()
    if instant(text) is not None or time_of_day(text) is not None:
        return f"{NEW} reads dates and times of day and writes seconds in their place"
    if _SLASHED.match(text):
        return "write dates as `2026-11-24 10:00:00`: nobody knows whether the day or the month comes first"
    if _CLOCK.match(text):
        return "write date and time into one column, as `2026-11-24 10:00:00`, or seconds since the begin"
    if has_thousands(text):
        return "write numbers without a mark between thousands: `1234,5` or `1234.5`"
    if COMMA.match(text):
        return f"{NEW} reads decimal commas"
    return "leave the place empty where nothing was measured"
