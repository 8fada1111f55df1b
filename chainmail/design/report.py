"""What a design is worth: report, front and scenario."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence

import numpy as np

from chainmail.design.candidate import Candidate, Rig, scenario_for
from chainmail.design.impossible import Impossible
from chainmail.design.ledger import COARSE, Entry, Ledger
from chainmail.design.outcome import Outcome
from chainmail.design.search import Search, check_of
from chainmail.design.sequential import Verdict, share_interval
from chainmail.design.task import Wanted

#: A limit is active where the design comes this near to it.
NEAR = 0.02


def front(ledger: Ledger) -> str:
    """Designs that no other beats in both energy and the worst distance to a bound, as CSV.

    Both are medians over the runs of a design, those of the highest fidelity that it has. Of cycles `delay_front` is
    the front that was asked for.
    """
    rows = []
    for candidate, entries in _by_candidate(ledger.entries).items():
        distances = [min(ledger.scaled(e)) for e in entries]
        rows.append((float(np.median([e.energy for e in entries])), float(np.median(distances)), candidate, entries))
    rows.sort(key=lambda r: (r[0], -r[1]))
    best = -math.inf
    buffer = io.StringIO()
    writer = csv.writer(buffer)
    names = [f"{w.name} [{u}]" for w, u in zip(ledger.task.wanted, ledger.units)]
    writer.writerow(
        [
            "energy [J]",
            *(f"median {n}" for n in names),
            "distance to the nearest bound, of it",
            "fidelity",
            "runs",
            "design",
        ]
    )
    for energy, distance, candidate, entries in rows:
        if distance <= best:
            continue
        best = distance
        medians = np.median([e.values for e in entries], axis=0)
        writer.writerow(
            [
                f"{energy:.6g}",
                *(f"{v:.6g}" for v in medians),
                f"{distance:.4g}",
                entries[0].fidelity,
                len(entries),
                candidate.text(),
            ]
        )
    return buffer.getvalue()


def _by_candidate(entries: Sequence[Entry]) -> dict[Candidate, list[Entry]]:
    """Complete runs of every design, those of its highest fidelity alone."""
    found: dict[Candidate, list[Entry]] = {}
    for fidelity in ("full", "fine", "coarse"):
        for entry in entries:
            own = found.get(entry.candidate)
            if entry.fidelity == fidelity and not entry.failure and (own is None or own[0].fidelity == fidelity):
                found.setdefault(entry.candidate, []).append(entry)
    return found


def report(search: Search, outcome: Outcome) -> str:
    """The report as Markdown."""
    ledger = search.ledger
    rig = ledger.rig
    lines = [f"# {ledger.task.title}", ""]
    winner = outcome.winner
    if winner is not None:
        lines += [f"**{winner.text()}.**", "", "`scenario.yaml` carries it out.", ""]
    else:
        lines += [f"**No design was accepted.** The last check is {outcome.verdict.value}.", ""]
    if outcome.notes:
        lines += [*(f"- {note}" for note in outcome.notes), ""]
    if outcome.points:
        lines += ["## Energy against delay", "", *_delays(ledger, outcome)]
    if outcome.checks:
        lines += [f"## On {len(outcome.checks)} fresh starts", "", *_checks(ledger, outcome), ""]
    if winner is not None:
        lines += ["## Energy", "", *_energy(search, winner, outcome, rig), ""]
        lines += ["## Limits", "", *_limits(search, winner), *_nearest_bound(ledger, outcome), ""]
    if search.room:
        lines += ["## Room for the scatter", "", *_room(search), ""]
    lines += ["## Effort", "", *_effort(ledger, outcome)]
    return "\n".join(lines) + "\n"


def _checks(ledger: Ledger, outcome: Outcome) -> list[str]:
    complete = [e for e in outcome.checks if not e.failure]
    lines = ["| wanted | median | 5 to 95 % | met | share, with its interval |", "|---|---|---|---|---|"]
    count = len(outcome.checks)
    asked = _counted(ledger, outcome.counting)
    for number, wanted in asked:
        met = sum(not e.failure and e.distances[number] >= 0.0 for e in outcome.checks)
        low, high = share_interval(met, count, wanted.confidence)
        values = [e.values[number] for e in complete]
        unit = ledger.units[number] if ledger.units else ""
        told = [f"{v:.4g} {unit}" for v in np.percentile(values, [50, 5, 95])] if values else ["none"] * 3
        lines.append(
            f"| {wanted.text()} | {told[0]} | {told[1]} to {told[2]} | {met} of {count} | "
            f"{met / count:.2f} ({low:.2f} to {high:.2f} at {100 * wanted.confidence:.0f} %) |"
        )
    if len(asked) > 1:
        met, confidence = sum(e.meets(outcome.counting) for e in outcome.checks), max(w.confidence for _, w in asked)
        low, high = share_interval(met, count, confidence)
        lines.append(
            f"| all of it in one run | | | {met} of {count} | "
            f"{met / count:.2f} ({low:.2f} to {high:.2f} at {100 * confidence:.0f} %) |"
        )
    test = check_of([w for _, w in asked])
    meaning = {
        Verdict.ACCEPTED: f"accepted: were the share of starts that meet all of it {test.bad:.2f} or less, it "
        f"would happen in about {100 * test.error:.0f} % of checks",
        Verdict.REJECTED: f"rejected: were the share {test.good:.2f} or more, this would happen in about "
        f"{100 * test.error:.0f} % of checks",
        Verdict.OPEN: "open: more fresh starts are needed (`runs.full`)",
    }[outcome.verdict]
    return [
        *lines,
        "",
        f"Sequential test of {test.good:.2f} against {test.bad:.2f}: {meaning}. The test tells these two shares apart; "
        "how large the share is, the intervals say.",
    ]


def _counted(ledger: Ledger, counting: Sequence[int] | None) -> list[tuple[int, Wanted]]:
    """Requirements that count, with their numbers."""
    return [(n, w) for n, w in enumerate(ledger.task.wanted) if counting is None or n in counting]


def _delays(ledger: Ledger, outcome: Outcome) -> list[str]:
    lines = ["| delay | energy of a cycle | design | fresh starts that meet it | |", "|---|---|---|---|---|"]
    told = []
    for point in outcome.points:
        told += [f"- {point.delay}: {note}" for note in point.notes]
        if point.design is None:
            lines.append(f"| {point.delay} | | none found | | |")
            continue
        met = sum(e.meets(point.counting) for e in point.checks)
        lines.append(
            f"| {point.delay} | {point.design.energy(ledger.rig):.1f} J | {point.design.text()} | "
            f"{met} of {len(point.checks)} | {point.verdict.value} |"
        )
    return [*lines, "", *told]


def delay_front(ledger: Ledger, outcome: Outcome) -> str:
    """Energy against delay of a cycle, as CSV: medians and shares over the fresh starts of every point."""
    buffer = io.StringIO()
    writer = csv.writer(buffer)
    writer.writerow(
        [
            "delay [s]",
            "energy [J]",
            "median cold curvature [1/m]",
            "median hot curvature [1/m]",
            "median curvature at the end [1/m]",
            "met",
            "fresh starts",
            "share, low",
            "share, high",
            "verdict",
            "design",
        ]
    )
    for point in outcome.points:
        if point.design is None:
            writer.writerow([point.delay.to("s"), *[""] * 8, "none found", ""])
            continue
        complete = [e for e in point.checks if not e.failure]
        curvatures = [n for n, w in _counted(ledger, point.counting) if w.quantity.endswith(".max_curvature")]
        cold, end, hot = ([e.values[n] for e in complete] for n in curvatures)
        met, count = sum(e.meets(point.counting) for e in point.checks), len(point.checks)
        confidence = max(w.confidence for _, w in _counted(ledger, point.counting))
        low, high = share_interval(met, count, confidence) if count else (0.0, 1.0)
        medians = [f"{np.median(v):.4g}" if v else "" for v in (cold, hot, end)]
        energy = f"{point.design.energy(ledger.rig):.6g}"
        shares = [met, count, f"{low:.3g}", f"{high:.3g}", point.verdict.value]
        writer.writerow([point.delay.to("s"), energy, *medians, *shares, point.design.text()])
    return buffer.getvalue()


def _energy(search: Search, winner: Candidate, outcome: Outcome, rig: Rig) -> list[str]:
    lines = [f"- closed form: {winner.energy(rig):.1f} J"]
    measured = [e.energy for e in outcome.checks if not e.failure]
    if measured:
        lines.append(f"- co-simulation: {np.median(measured):.1f} J")
    task = search.ledger.task
    if task.shape is not None or task.schedule is not None:
        return lines  # with all rows hot together it would not be the same request
    reference = search.candidate(rig.free)
    if reference is not None and 0 < len(winner.rows) < len(rig.free):
        spent = reference.energy(rig)
        lines.append(
            f"- all {len(reference.rows)} free rows heated to {search.coolest - 273.15:.3g} degC instead: "
            f"{spent:.1f} J; this is "
            f"{100 * winner.energy(rig) / spent:.0f} % of it"
        )
    if not winner.rows:
        return lines
    steady = sum(r.power(r.holding_voltage(winner.hottest)) * winner.deadline for r in rig.rows)
    share = 100 * winner.energy(rig) / steady
    settled = f"{winner.hottest - 273.15:.3g} degC"
    lines.append(
        f"- all {len(rig.rows)} rows from 0 s on, at the voltage that settles at {settled}: {steady:.1f} J; "
        f"this is {share:.0f} % of it"
    )
    return lines


def _limits(search: Search, winner: Candidate) -> list[str]:
    """Which limits of voltage and power are active, and what a tenth more of each would save, by the closed form."""
    rig = search.ledger.rig
    if not winner.rows:
        return ["none: nothing is heated"]
    lines = []
    voltage, power = max(p.voltage for p in winner.pulses), winner.power(rig)
    for name, unit, value, limit in (("voltage", "V", voltage, search.voltage), ("power", "W", power, search.power)):
        if value > (1.0 - NEAR) * limit:
            more = {"voltage": 1.1 * limit} if name == "voltage" else {"power": 1.1 * limit}
            wider = search.wider(winner, **more)
            saved = winner.energy(rig) - wider.energy(rig) if wider is not None else 0.0
            lines.append(
                f"- {name}: {value:.4g} of {limit:.4g} {unit}; a tenth more would save {saved:.2g} J "
                f"of {winner.energy(rig):.3g} J"
            )
    return lines or ["no limit of voltage or power is active"]


def _nearest_bound(ledger: Ledger, outcome: Outcome) -> list[str]:
    """The requirement on the fabric that fresh starts come nearest to missing, in deviations between starts."""
    complete = [e for e in outcome.checks if not e.failure]
    found = []
    for number, wanted in _counted(ledger, outcome.counting):
        distances = [e.distances[number] for e in complete]
        scatter = float(np.std(distances, ddof=1)) if len(distances) > 1 else 0.0
        if scatter > 0.0 and wanted.quantity.startswith(f"{ledger.rig.fabric}."):
            found.append((float(np.mean(distances)) / scatter, float(np.mean(distances)), scatter, wanted, number))
    if not found:
        return []
    _, mean, scatter, wanted, number = min(found, key=lambda f: f[0])
    unit = ledger.units[number]
    return [
        f"- nearest requirement: {wanted.text()}; fresh starts are {mean:.3g} {unit} from it on average, with a "
        f"standard deviation of {scatter:.2g} {unit}"
    ]


def _room(search: Search) -> list[str]:
    """By how much a design had to hold in the search, and which cheaper ones did not."""
    ledger = search.ledger
    lines = [
        "The first design that met the request was run from three starts. From then on a design counted as good only "
        "where it was farther from each bound than the scatter between these asks for:",
        "",
    ]
    for number, (wanted, unit, least) in enumerate(zip(ledger.task.wanted, ledger.units, search.room)):
        if least > 0.0 and any(not math.isnan(e.distances[number]) for e in ledger.entries if not e.failure):
            lines.append(f"- {wanted.text()}: {least:.2g} {unit}")
    missed = [c for c, e in ledger.decided().items() if e.fidelity != "short" and e.is_met and not search.has_room(e)]
    lines += [""] * bool(missed)
    lines += [f"Met the request from start 1, without that room: {c.text()}." for c in missed]
    return lines


def _effort(ledger: Ledger, outcome: Outcome) -> list[str]:
    lines = ["| fidelity | runs | wall time |", "|---|---|---|"]
    for fidelity, what in (
        ("coarse", "coarse"),
        ("short", "of the scenario's own settings, until the fabric has been rigid"),
        ("fine", "of the scenario's own settings, in the search"),
        ("full", "the same, fresh starts"),
    ):
        own = [e for e in ledger.entries if e.fidelity == fidelity]
        if not own and fidelity in ("coarse", "short"):
            continue
        lines.append(f"| {what} | {len(own)} | {sum(e.seconds for e in own):.0f} s |")
    if outcome.chain is not None:
        chain = outcome.chain
        lines += [
            "",
            f"Row model for screening, fitted to the cold run: a cold row bends by "
            f"{math.degrees(chain.flexible):.1f} degrees.",
        ]
    if ledger.can_be_coarse() and ledger.pairs():
        told = [
            f"{w.text()}: {shift:+.3g} {u} (scatter {scatter:.2g} {u})"
            for w, u, (shift, scatter) in zip(ledger.task.wanted, ledger.units, ledger.difference())
        ]
        lines += [
            "",
            f"Coarse runs ({COARSE.engine}) read farther on the right side than fine ones of "
            f"the same start, over {len(ledger.pairs())} pairs: {'; '.join(told)}.",
        ]
    return lines


def impossible(ledger: Ledger, why: Impossible) -> str:
    """The report of a request that cannot be met."""
    told = [f"- limit: {why.limit}", f"- nearest: {why.nearest}"]
    lines = [f"# {ledger.task.title}", "", "**Not possible.**", "", *told, "", "## Effort", ""]
    lines += _effort(ledger, Outcome())
    return "\n".join(lines) + "\n"


def winning_scenario(winner: Candidate, rig: Rig, title: str) -> str:
    """The scenario of a design, as YAML."""
    scenario = scenario_for(winner, rig)
    return scenario.model_copy(update={"title": f"{title}: {winner.text()}"}).to_yaml()
