"""docs/candidates.md, written from the registry: `python -m diagnosis.candidates.document > docs/candidates.md`."""

from __future__ import annotations

from collections.abc import Iterator

from diagnosis.candidates import unnamed, unnamed_completing, unnamed_shapes
from diagnosis.candidates.candidate import CandidateTerm, Parameter
from diagnosis.candidates.hooks import FUNCTIONS, HOOKS, NAMES
from diagnosis.candidates.registry import catalogue
from diagnosis.candidates.sizes import SCALES
from diagnosis.candidates.unnamed import TARGETS, VARIABLES

_UNITS = {
    "electrical": "Electrical",
    "thermal": "Thermal",
    "stiffness": "Stiffness",
    "mechanical": "Mechanical",
    "measurement": "Measurement",
}
_HEAD = """# Candidate effects

What `cosim diagnose` can add to a model. Written from the files of `diagnosis/candidates/`; do not edit it here:
`python -m diagnosis.candidates.document > docs/candidates.md`.

Each file states the law, its source, unit and bounds of every parameter with the reason for them, where the effect can
act, what it leaves in the residuals, what it is confused with, and the C lines that put it into the running model. The
first parameter is the strength: 0 switches the effect off. `step(x)` is 0 before and 1 after 0; `d(x)` is the rate
of x (or, where the law holds at any rate, its change). A parameter named `instant` is the instant of one recording at
which it sets in: what lasts is there from the start in all later recordings, what belongs to one day in none of another
day. An effect of a day without an instant is tried in all recordings at once, and on each day alone.

Every rig has a little of everything, and enough readings show it. So a strength may have a size below which it is no
finding: what coils of one lot differ by (2 K of transformation temperature), what a room does by itself (0.1 K, 2 % of
the cooling), what is less than a hundredth of a load, of a length or of a resistance.

Every size has a largest one that is believed of a real rig, with the reason. The search may go beyond it, but what is
found there stands in for something else and is not named. Many of these limits are multiples of what the rig itself has
(its h A, its load); in parentheses stands the value for the paper's coil under 0.1 kg.

The values that are tried follow from that limit by one rule (`diagnosis/candidates/sizes.py`): the range from the size
that is no finding, or 1 % of the limit, or the lower bound, to the limit is divided into parts that are equal by ratio
(three; two for each sign where either is possible), and the middle of each is tried. Thresholds and places are spread
evenly over their range instead. Limits and ceilings are tried at shares of the largest reading (0.99, 0.9, 0.75, 0.6,
0.45), for of what is cut off nothing is seen above. Where a file departs from the
rule it says why.
"""
_COMPLETING = """
Where all of these leave more than noise and recordings that were held out reject the model, sums of these describe what
is left ([how](diagnosis-architecture.md#where-held-out-recordings-reject-the-answer)). `spline` is
`min(max((variable - onset) / width, 0), 1)` with free knots, `delayed_spline` the same behind a first-order delay
`tau`.
"""
_UNNAMED = """## Unnamed terms

For a law that nobody named, generic terms compete with the effects above on the same footing: an amplitude `a` with a
unit times a dimensionless function phi of dimensionless variables. They are reported as unnamed, with what they depend
on.
"""
_HOOKS = """## Hooks

C lines act at hooks. A step comes to them in this order; every parameter is a number at the element concerned.
"""
_ADD = """## A candidate of your own

1. Copy the file that is nearest in kind and rename it; `identifier` is the file's name.
2. Write the law, its source, the parameters with bounds and the reason for them (passivity or sign), what each number
   is (`meaning`: a share, a factor or a change of what, or which physical quantity), the largest size that is believed
   of a real rig and why (`plausible`), which quantities must be measured to tell the law from heat or from motion
   (`needs`, by default those of its unit), how many coils it takes (`fewest`), and the lines.
   Write a term so that strength 0 changes no bit: `x += a * ...` or `x *= 1.0 + a * ...`.
3. A loss of heat belongs into `conductance`, which the step solves exactly, rather than into `heat`.
4. `python -m pytest tests/coil_network` tries it: formula, zero, what it moves, passivity. Add a closed form of its
   own.
"""


def _number(value: float) -> str:
    return f"{value:g}"


def _parameter(p: Parameter) -> str:
    if p.is_fixed:
        return f"`{p.name}` [{p.unit}]: given with the place"
    if p.is_instant:
        return f"`{p.name}` [{p.unit}], {p.meaning}: {p.reason}; tried from instants spread over it"
    starts = ", ".join(_number(v) for v in p.starts)
    starts += f" ({p.starts_reason})" if p.starts_reason else ""
    small = f"; below {_number(p.negligible)} it is no finding" if p.negligible else ""
    bounds = f"{_number(p.lower)} to {_number(p.upper)}: {p.reason}"
    return f"`{p.name}` [{p.unit}], {p.meaning}; {bounds}; {_limit(p)}; tried from {starts}{small}"


def _limit(p: Parameter) -> str:
    most = f"{p.limit():.2g}"
    if p.of:
        most = f"{_number(p.plausible)} times {SCALES[p.of][1]} ({most})"
    return f"believed up to {most}: {p.plausible_reason}"


def _named(term: CandidateTerm) -> Iterator[str]:
    yield f"### {term.name[0].upper()}{term.name[1:]}\n"
    yield f"`{term.identifier}` · acts on: {', '.join(p.replace('_', ' ') for p in term.places)}\n"
    yield "\n".join(f"    {equation.strip()}" for equation in term.law.split(";")) + "\n"
    for parameter in term.parameters:
        yield f"- {_parameter(parameter)}"
    if term.needs:
        yield f"- needs one of: {', '.join(term.needs)}"
    if term.fewest > 1:
        yield f"- needs at least {term.fewest} {'coils or heaters' if term.axis == 'coil' else f'{term.axis}s'}"
    if term.states:
        yield "- adds " + ", ".join(f"`{s.name}` [{s.unit}] ({s.kind})" for s in term.states)
    if term.scope_reason:
        yield f"- {'lasts' if term.scope == 'rig' else 'belongs to one day'}: {term.scope_reason}"
    yield f"- leaves: {term.signature}"
    for other, decision in term.confused_with.items():
        kind = f"the model's own `{other[5:]}`" if other.startswith("base:") else f"`{other}`"
        yield f"- confused with {kind}: {decision}"
    yield f"- source: {term.source}\n"


def _unnamed() -> Iterator[str]:
    yield _UNNAMED
    yield "| variable | dimensionless form | meaning |\n|---|---|---|"
    for name, (formula, words) in VARIABLES.items():
        yield f"| {name} | `{formula}` | {words} |"
    yield "\n| equation | law | amplitude | terms |\n|---|---|---|---|"
    for equation, target in TARGETS.items():
        prefix = f"unnamed_{equation}_"
        names = [t.identifier[len(prefix) :] for t in unnamed.CANDIDATES if t.identifier.startswith(prefix)]
        law = target.law.format(phi="phi")
        yield f"| {equation} | `{law}` | {_number(target.bound)} {target.amplitude} at most | {', '.join(names)} |"
    yield "\nThresholds, steps, changes, and equations that few laws act on:\n"
    yield "| term | law | amplitude |\n|---|---|---|"
    for term in unnamed_shapes.CANDIDATES:
        yield f"| {term.identifier.removeprefix('unnamed_')} | `{term.law}` | [{term.amplitude.unit}] |"
    yield _COMPLETING
    yield "| equation | law | terms |\n|---|---|---|"
    for equation, law in [(e, own.law) for e, own in unnamed_completing.EQUATIONS.items()] + [("value", "")]:
        prefix = f"unnamed_{equation}_"
        own = [t.identifier[len(prefix) :] for t in unnamed_completing.CANDIDATES if t.identifier.startswith(prefix)]
        words = law.format(phi="phi") if law else "value = truth + a * scale * (phi)"
        yield f"| {equation} | `{words}` | {', '.join(own)} |"
    yield ""


def markdown() -> str:
    """The whole page."""
    parts = [_HEAD]
    for unit, title in _UNITS.items():
        own = [t for t in catalogue() if t.is_named and t.unit == unit]
        parts.append(f"## {title}\n")
        for term in sorted(own, key=lambda t: t.identifier):
            parts += _named(term)
    parts += _unnamed()
    parts.append(_HOOKS)
    parts.append("| hook | what it may change |\n|---|---|")
    parts += [f"| `{hook}` | {words} |" for hook, words in HOOKS.items()]
    parts.append(
        "\nLines may use these names, those of their own parameters and states, and the model's own parameters. In\n"
        "hooks up to `heat` a state stands at the middle of the step; `<state>_begin` is its value at the begin.\n"
    )
    parts.append("| name | unit | meaning |\n|---|---|---|")
    parts += [f"| `{name}` | {unit} | {words} |" for name, (unit, words) in NAMES.items()]
    parts.append("\n| function | value |\n|---|---|")
    parts += [f"| `{call}` | {words} |" for call, words in FUNCTIONS.items()]
    parts += ["", _ADD]
    return "\n".join(parts).rstrip() + "\n"


if __name__ == "__main__":
    print(markdown(), end="")
