"""What the channels can tell apart, and the experiment that would decide what they leave open."""

from __future__ import annotations

from diagnosis.judge.isolability import FaultClass, Isolability
from diagnosis.judge.next_experiment import NextExperiment
from diagnosis.report.course_figures import experiment_figure
from diagnosis.report.display import clean, listed, number, percent
from diagnosis.report.markup import Html, element, folded, image, listing, table, wrapped

#: Most channels whose spread between explanations is listed.
_CHANNELS = 5
#: Faults up to which they are shown as a matrix.
_MATRIX = 24


def experiment_section(experiment: NextExperiment | None) -> Html:
    """What to do next; nothing where nothing is open."""
    if experiment is None:
        return Html("")
    rivals = [(_named(r.effects), percent(r.probability)) for r in experiment.rivals]
    facts = (
        f"The rivals differ most in {clean(experiment.channel)} at {number(experiment.best_time)} s (dotted). Expected "
        f"ln of the odds for the true one: {number(experiment.log_bayes_factor)}; by a repeat of the recordings "
        f"{number(experiment.repeat_log_bayes_factor)}. {experiment.tried} programmes were simulated; what a "
        "recalibration would do as well does not count."
    )
    return element(
        "section",
        element("h2", "Next experiment"),
        element("p", element("strong", experiment.statement)),
        image(experiment_figure(experiment), f"programme of the next experiment: {experiment.kind}"),
        table(("explanation that is open", "probability now"), rivals),
        element("p", facts),
        _commands(experiment),
        element("p", "It keeps: ", listed(experiment.limits, 9), ".", class_="note"),
    )


def _named(effects: tuple[str, ...]) -> str:
    return clean(" with ".join(effects).replace("_", " "))


def _commands(experiment: NextExperiment) -> Html:
    if experiment.scenario is None:
        return Html("")
    told = "Ready to run: "
    return element(
        "p",
        told,
        element("code", f"cosim run {experiment.scenario}"),
        " shows what the model expects. "
        "Carry it out on the rig, describe it by a recording.yaml, and give it as one more ",
        element("code", "--recording"),
        ".",
    )


def isolability_section(told: Isolability) -> Html:
    """Statements, classes of faults, and channels that would help."""
    parts: list[str] = [listing(told.statements) if told.statements else element("p", "No statement was made.")]
    if told.extra_channels:
        # Each statement calls its own channel the one that helps most; what it would tell follows the colon.
        rows = [
            (clean(c.channel), str(c.classes), wrapped(c.statement.rpartition(": ")[2]))
            for c in told.extra_channels[:_CHANNELS]
        ]
        parts += [
            element("p", "Channels that would help, the best first:"),
            table(("channel", "classes told apart", ""), rows),
        ]
    if told.classes:
        parts += _matrix(told.classes)
        parts.append(folded(f"All {len(told.classes)} classes", listing(_class(c) for c in told.classes)))
    return element("section", element("h2", "What these channels can tell apart"), *parts)


def _matrix(classes: tuple[FaultClass, ...]) -> list[Html]:
    """Which fault is told from which, as far as it fits."""
    faults = [(fault, one) for one in classes for fault in one.faults]
    if not 2 <= len(faults) <= _MATRIX:
        return []
    head = element(
        "tr",
        element("th", ""),
        element("th", element("abbr", "seen", title="Whether it shows at all.")),
        *(element("th", element("abbr", str(n), title=clean(fault))) for n, (fault, _) in enumerate(faults, 1)),
    )
    rows = [
        element(
            "tr",
            element("th", f"{n}  {clean(fault)}", scope="row"),
            element("td", "yes" if own.is_detectable else "no", class_="met" if own.is_detectable else "missed"),
            *(_pair(fault, own, other, of) for other, of in faults),
        )
        for n, (fault, own) in enumerate(faults, 1)
    ]
    note = (
        "Filled: by the structure of the equations these channels cannot tell the two apart. Open: they can. Columns "
        "are numbered as rows."
    )
    grid = element("table", element("thead", head), element("tbody", *rows), class_="matrix")
    return [element("div", grid, class_="wide"), element("p", note, class_="note")]


def _pair(fault: str, own: FaultClass, other: str, of: FaultClass) -> Html:
    if fault == other:
        return element("td", "", class_="self")
    both = f"{clean(fault)} and {clean(other)}"
    if own is of:
        return element("td", "●", class_="alike", title=f"{both}: cannot be told apart")
    return element("td", "○", class_="apart", title=f"{both}: told apart")


def _class(one: FaultClass) -> str:
    seen = "" if one.is_detectable else " (cannot be seen)"
    return listed(one.faults, 12) + seen
