"""A recording.yaml proposed for a table, by the names of its columns."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml

from cosim.components import (
    CircuitComponent,
    FmuComponent,
    PendulumComponent,
    ProgrammeComponent,
    ProgrammeOutput,
    nanoseconds,
)
from cosim.run import RunStopped, run
from cosim.scenario import Scenario, parse_scenario
from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from cosim.unit.quantity import conversion
from cosim.yaml_file import parse_yaml, read_text
from diagnosis.check.heading import Heading, heading
from diagnosis.check.sniff import Sniffed
from diagnosis.recording.cells import how_to_write
from diagnosis.recording.channels import offered
from diagnosis.recording.noise import estimate_noise, find_quantum
from diagnosis.recording.quantity import SI_UNITS, parse_quantity
from diagnosis.recording.recording import FEWEST_VALUES
from diagnosis.recording.units import si_unit

#: Words and letters that stand for a quantity at the begin of a name.
WORDS = {
    "temperature": ("temperature", "temp", "thermocouple", "tc", "t"),
    "current": ("current", "amps", "i"),
    "voltage": ("voltage", "volts", "u", "v"),
    "power": ("power", "p", "q", "heater"),
    "extension": ("extension", "displacement", "position", "pos", "x"),
    "stiffness": ("stiffness",),
    "resistance": ("resistance", "r"),
    "angle": ("angle", "theta", "phi"),
    "angular_velocity": ("angular_velocity", "omega", "rate"),
    "max_curvature": ("max_curvature", "curvature", "kappa"),
    "length": ("length",),
}
#: Points up to which a programme is written out for a recording to change; a longer one is rather a recorded input.
MOST_POINTS = 12
_TIMES = frozenset({"time", "t", "timestamp", "date", "datetime", "clock", "seconds", "elapsed", "zeit", "x_value"})


@dataclass(frozen=True)
class Proposal:
    """What is written.

    Args:
        sidecar: Text of recording.yaml.
        table: Text of the plain copy of the table.
        channels: How many channels were matched.
        unclear_columns: Columns that were not, each with the reason and what to write.
    """

    sidecar: str
    table: str
    channels: int
    unclear_columns: tuple[str, ...]


def propose(scenario: Scenario, table: Sniffed, source: Path) -> Proposal:
    """Channels, clock, units and noise of a table.

    Args:
        scenario: What its columns are matched with.
        table: Read.
        source: File of the table, for errors and the proposal's `source`.

    Raises:
        InputError: No column holds times, or the scenario cannot be run.
    """
    heads = [heading(n) for n in table.names]
    clock = _clock(table, heads, source)
    times = table.columns[clock] * conversion(_clock_unit(table, heads[clock]), "s")[0]
    keep = np.isfinite(times)
    keep[keep] = np.concatenate([[True], np.diff(np.maximum.accumulate(times[keep])) > 0.0])
    names = _offered(scenario)
    channels: dict[str, dict[str, str]] = {}
    unclear: list[str] = []
    for k, head in enumerate(heads):
        if k == clock:
            continue
        reason, name = _match(table, head, names, list(channels))
        known = keep & np.isfinite(table.columns[k])
        if not reason and np.count_nonzero(known) < FEWEST_VALUES:
            reason = f"it has {np.count_nonzero(known)} values, fewer than {FEWEST_VALUES}: leave it out"
        if reason:
            reason = _input(head, _programmes(scenario), set(names.values())) or reason
            unclear.append(f"{head.name}: {reason}")
            continue
        channels[name] = _entry(head, times[known], table.columns[k][known])
    dropped = int(np.count_nonzero(~keep))
    text = _sidecar(scenario, table, heads[clock], channels, unclear, dropped, source)
    return Proposal(text, _plain(table, keep), len(channels), tuple(unclear))


def _clock(table: Sniffed, heads: Sequence[Heading], source: Path) -> int:
    """Number of the column of times."""
    for is_right in (
        lambda h: h.name in table.instants,
        lambda h: h.word in _TIMES and h.si_unit == "s",
        lambda h: h.word in _TIMES and not h.numbers and h.unit is None,
        lambda h: h.si_unit == "s",
    ):
        for k, head in enumerate(heads):
            values = table.columns[k][np.isfinite(table.columns[k])]
            if is_right(head) and len(values) >= FEWEST_VALUES and np.mean(np.diff(values) > 0.0) > 0.9:
                return k
    for name, example in table.texts.items():  # a date or a clock that nobody can read for sure
        if how_to_write(example) != how_to_write("") and not _has_letters(example):
            raise InputError(source, name, f"`{example}` is no time that can be read", how_to_write(example))
    raise InputError(
        source, "", "no column holds rising times", "name the column of times `time_s`, `time_ms` or `time [min]`"
    )


def _has_letters(text: str) -> bool:
    return any(c.isalpha() for c in text.upper().replace("AM", "").replace("PM", ""))


def _clock_unit(table: Sniffed, head: Heading) -> str:
    return "s" if head.name in table.instants or head.unit is None else head.unit


def _offered(scenario: Scenario) -> dict[str, str]:
    """Channels that a scenario offers, with the SI unit of each: of one step of it, which takes no time."""
    assert scenario.path is not None, "the scenario was read from a file"
    data = parse_yaml(read_text(scenario.path), scenario.path)
    begin = scenario.time.start.to("s")
    step = nanoseconds(scenario.time.output_step) * 1e-9
    data["time"]["stop"] = f"{begin + step:.12g} s"
    try:
        results = run(parse_scenario(yaml.safe_dump(data, sort_keys=False), scenario.path))
    except RunStopped as stopped:
        raise InputError(
            scenario.path, "", f"the scenario cannot be run: {stopped.reason}", "see `cosim run`"
        ) from stopped
    names = offered(results)
    names += [
        n
        for n in (
            f"{c}.{q}"
            for c, k in scenario.components.items()
            if isinstance(k, PendulumComponent)
            for q in ("angle", "angular_velocity")
        )
        if n in results and n not in names
    ]
    if any(isinstance(c, CircuitComponent) for c in scenario.components.values()):
        names += [n for n in ("supply.voltage", "supply.power") if n not in names]
    found = {}
    driven = {n for n, c in scenario.components.items() if isinstance(c, ProgrammeComponent)}
    if all(parse_quantity(n).is_component for n in names):  # FMUs of somebody: whatever they have
        names = [n for n in map(str, results) if results[n].ndim == 1 and n.partition(".")[0] not in driven]
    for name in names:
        target = parse_quantity(name)
        own = results[name].attrs.get("units", "1") if name in results else "1"
        found[name] = si_unit(str(own)) if target.is_component else SI_UNITS.get(target.quantity, "1")
    return found


def _match(table: Sniffed, head: Heading, names: dict[str, str], taken: Sequence[str]) -> tuple[str, str]:
    """Why a column is unclear, or the channel that it is."""
    if head.name in table.texts:
        return f"it holds text (`{table.texts[head.name]}`): leave it out", ""
    if head.name in table.instants:
        return "it holds dates, and another column is the clock: leave it out", ""
    quantities = [q for q, words in WORDS.items() if head.word.split("_")[0] in words or head.word in words]
    if head.word.startswith("set") or "setpoint" in head.word or head.word.startswith("sp_"):
        given = _flow({"column": head.name, "unit": head.unit or "UNIT"})
        what = f"write `PROGRAMME.OUTPUT: {given}` under `inputs` if it was applied as it stands, or leave it out"
        return f"by its name it is a set point, not a reading: {what}", ""
    own = _called(head, names, taken)
    if own:
        return "", own
    if head.unit is None:
        return f"its name has no unit that is known: {_to_write(head, names)}", ""
    fitting = [n for n, unit in names.items() if unit == head.si_unit]
    if not fitting:
        return f"the scenario has no channel in {head.si_unit}: leave it out, or correct the unit", ""
    by_word = [n for n in fitting if parse_quantity(n).quantity in quantities]
    if not by_word:
        why = f"its name does not say which quantity it is; in {head.si_unit} there are {_few(fitting)}"
        return f"{why}: {_to_write(head, fitting)}", ""
    chosen = _numbered(by_word, head)
    if len(chosen) != 1:
        return f"it may be {_few(chosen or by_word)}: {_to_write(head, chosen or by_word)}", ""
    if chosen[0] in taken:
        return f"another column is {chosen[0]} already: leave one of the two out", ""
    return "", chosen[0]


def _called(head: Heading, names: dict[str, str], taken: Sequence[str]) -> str:
    """The one variable of a component that has the name of a column and its unit, or none of both; else empty."""
    found = [n for n, unit in names.items() if unit == (head.si_unit or "1") and _is_called(head, n) and n not in taken]
    return found[0] if len(found) == 1 else ""


def _programmes(scenario: Scenario) -> dict[str, str]:
    """Outputs of all programmes, with the SI unit of each."""
    every = scenario.components.items()
    return {
        f"{n}.{o}": si_unit(given.unit)
        for n, c in every
        if isinstance(c, ProgrammeComponent)
        for o, given in c.outputs.items()
    }


def _input(head: Heading, programmes: dict[str, str], units: set[str]) -> str:
    """Why a column is the course of an input, by its name or by a unit that no channel has; empty if it is none."""
    entry = _flow({"column": head.name, "unit": head.unit or "UNIT"})
    called = [n for n in programmes if _is_called(head, n)]
    if len(called) == 1:
        return f"by its name it is the input {called[0]}: write `{called[0]}: {entry}` under `inputs`"
    fitting = [n for n, unit in programmes.items() if head.si_unit is not None and unit == head.si_unit]
    if not fitting or head.si_unit in units:
        return ""
    numbered = [n for n in fitting if tuple(int(k) for k in re.findall(r"\d+", n.partition(".")[2])) == head.numbers]
    likely = numbered if head.numbers and len(numbered) == 1 else fitting
    kind = "the input" if len(likely) == 1 else "one of the inputs"
    return f"by its unit it is {kind} {_few(likely)}: write `{likely[0]}: {entry}` under `inputs` if it was applied so"


def _is_called(head: Heading, name: str) -> bool:
    """Whether a column has the name of a variable of a component, with the component before it or without."""
    target = parse_quantity(name)
    if not target.is_component or target.element:
        return False
    body = re.sub(r"\W+", "_", head.body).strip("_").lower()
    return body in (target.quantity.lower(), f"{target.kind}_{target.quantity}".lower())


def _numbered(names: Sequence[str], head: Heading) -> list[str]:
    """Channels whose element is the number in a column's name."""
    whole = [n for n in names if n.startswith(("supply.", "fabric."))]
    if not head.numbers:
        is_whole = any(w in head.word for w in ("supply", "total", "sum"))
        others = [n for n in names if n not in whole]
        return (
            whole
            if is_whole or not others
            else (others if not whole else list(names))
            if len(names) > 1
            else list(names)
        )
    if any(w in head.word for w in ("supply", "total", "sum")):
        return whole
    exact = [n for n in names if parse_quantity(n).element == head.numbers]
    if exact or len(head.numbers) != 1:
        return exact
    counted = [n for n in names if parse_quantity(n).element]
    number = head.numbers[0]
    # coils of several strings are named coil[2,3]: one number counts through all of them
    if any(len(parse_quantity(n).element) == 2 for n in counted):
        return [counted[number - 1]] if 1 <= number <= len(counted) and len(counted) == 1 else []
    return [n for n in counted if parse_quantity(n).element == (number,)]


def _to_write(head: Heading, names: Iterable[str]) -> str:
    """The line of recording.yaml that makes a channel of a column."""
    entry = _flow({"column": head.name, "unit": head.unit or "UNIT"})
    return f"write for example `{next(iter(names), 'CHANNEL')}: {entry}` under `channels`"


def _flow(entry: dict[str, str]) -> str:
    """A mapping in one line of YAML."""
    return yaml.safe_dump(entry, default_flow_style=True, sort_keys=False, allow_unicode=True, width=10_000).strip()


def _few(names: Sequence[str]) -> str:
    return ", ".join(names[:4]) + (f" or {len(names) - 4} others" if len(names) > 4 else "")


def _entry(head: Heading, times: Array, values: Array) -> dict[str, str]:
    unit = head.unit or "1"
    difference = {"degC": "K", "degF": "delta_degF"}.get(unit, unit)
    entry = {"column": head.name, "unit": unit}
    quantum = find_quantum(values)
    if quantum:
        entry["quantum"] = f"{quantum:.3g} {difference}".removesuffix(" 1")
    entry["noise"] = f"{estimate_noise(times, values, quantum):.3g} {difference}".removesuffix(" 1")
    return entry


def _sidecar(
    scenario: Scenario,
    table: Sniffed,
    clock: Heading,
    channels: dict[str, dict[str, str]],
    unclear: Sequence[str],
    dropped: int,
    source: Path,
) -> str:
    data: dict[str, object] = {
        "title": source.stem.replace("_", " "),
        "source": f"{source.name}; who measured it, where, when?",
        "table": "data.csv",
        "time": {"column": clock.name, "unit": _clock_unit(table, clock)},
    }
    lines = ["# Proposed by `cosim recording new` from the names of columns. Read every line before you use it."]
    if table.is_decimal_comma or table.separator != "," or table.header_lines or table.instants:
        lines.append(
            f"# data.csv is a plain copy: separator `{_shown(table.separator)}`, {table.header_lines} "
            f"lines before "
            f"the header{', decimal commas' if table.is_decimal_comma else ''}"
            f"{', dates as seconds since the first' if table.instants else ''}."
        )
    if dropped:
        lines.append(f"# {dropped} rows without a time, or whose time does not rise, were left out of the copy.")
    if clock.unit is None and clock.name not in table.instants:
        lines.append(f"# The unit of the clock `{clock.name}` is not in its name: s is taken. Is it ms, min?")
    lines.append(yaml.safe_dump(data, sort_keys=False, allow_unicode=True, width=110).rstrip())
    conditions = [f"# {line}" for line in _conditions(scenario)]
    if conditions:
        conditions.insert(0, "# Take away the `# ` before what differs, and write this recording's own numbers:")
    lines += [
        "# The clock starts at the scenario's time 0; else give `zero` and `offset_bound` under `time`.",
        "# What was done: the programme, the room and the start of THIS recording. Without it the scenario's hold.",
        *conditions,
    ]
    if channels:
        lines.append(
            "# Noise is the scatter of neighbouring readings; state the data sheet's where you know it better."
        )
        lines.append(yaml.safe_dump({"channels": channels}, sort_keys=False, allow_unicode=True, width=110).rstrip())
    else:
        lines.append(
            "channels: {}  # none could be matched: write them, as in `coil[1].temperature: {column: T1, unit: degC}`"
        )
    lines += [f"# unclear column {text}" for text in unclear]
    return "\n".join(line.replace("\r", " ") for line in lines) + "\n"


def _shown(separator: str) -> str:
    return {"\t": "tab", " ": "spaces"}.get(separator, separator)


def _conditions(scenario: Scenario) -> list[str]:
    """The `overrides` that state what drove a recording and how it started, with the scenario's own numbers."""
    components: dict[str, object] = {}
    for name, component in scenario.components.items():
        if isinstance(component, ProgrammeComponent):
            courses: dict[str, object] = {
                o: _course(g) for o, g in component.outputs.items() if len(g.points or ()) <= MOST_POINTS
            }
            if courses:
                components[name] = {"outputs": courses}
        elif isinstance(component, FmuComponent | PendulumComponent):
            starts: dict[str, object] = {
                k: _plain_value(v) for k, v in component.parameters.items() if k.startswith("initial_")
            }
            if starts:
                components[name] = {"parameters": starts}
    if not components:
        return []
    text = yaml.safe_dump(
        {"overrides": {"components": components}},
        default_flow_style=None,
        sort_keys=False,
        allow_unicode=True,
        width=10_000,
    )
    return text.rstrip().splitlines()


def _course(given: ProgrammeOutput) -> dict[str, object]:
    """What an output of a programme does."""
    kept: dict[str, object] = {"unit": given.unit}
    if given.dim:
        kept["dim"] = given.dim
    if given.interpolation != "hold":
        kept["interpolation"] = given.interpolation
    if given.points is None:
        return kept | {"constant": _plain_value(given.constant)}
    return kept | {"points": [[str(t), _plain_value(v)] for t, v in given.points]}


def _plain_value(value: object) -> object:
    return [str(v) for v in value] if isinstance(value, list) else str(value)


def _plain(table: Sniffed, keep: np.ndarray) -> str:
    """The table with commas, points and one header line; columns of text are left out."""
    chosen = [k for k, name in enumerate(table.names) if name not in table.texts]
    header = io.StringIO()
    csv.writer(header, lineterminator="").writerow([table.names[k] for k in chosen])
    rows = [header.getvalue()]
    for values in table.columns[chosen][:, keep].T.tolist():
        rows.append(",".join("" if v != v else repr(v) for v in values))
    return "\n".join(rows) + "\n"
