"""C source of a generated FMU: the network's own functions with the lines of the terms, behind our FMI layer."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from diagnosis.amend.parts import Port, step_arrays
from diagnosis.amend.table import Row, config
from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.models.coil_network.kernel.layout import COIL_FIELDS, CoilNetworkLayout
from diagnosis.models.coil_network.kernel.source import generate, words

_FOLDER = Path(__file__).resolve().parent
_HEAD = """/* Generated from the coil network and the terms that were found; see docs/amended-models.md. */
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-variable"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif
#include <stdio.h>

#include "model.h"

"""
_SIZE = "(size_t)s->coils * sizeof(double)"


@dataclass(frozen=True)
class Source:
    """Sources of one FMU, as `cosim fmu build` takes them.

    Args:
        config: Text of config.h.
        model: Text of model.c.
        page: Text of index.html.
    """

    config: str
    model: str
    page: str

    def write(self, folder: Path) -> None:
        """Write the three files."""
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in (("config.h", self.config), ("model.c", self.model), ("index.html", self.page)):
            (folder / name).write_text(text, encoding="utf-8")


@dataclass(frozen=True)
class Functions:
    """Bodies of what the text of a part (actuator.c, load.c) calls.

    Args:
        bodies: Name to statements; each has `Model *model` and `Step *s`.
    """

    bodies: Mapping[str, str]

    def text(self) -> str:
        """C functions."""
        return "\n".join(
            f"static void {name}(Model *model, Step *s)\n{{\n    (void)model;\n    (void)s;\n{body}}}\n"
            for name, body in self.bodies.items()
        )


def parameter_name(term: CandidateTerm, parameter: str) -> str:
    """Name of a term's parameter in the amended FMU, for example `radiation_emissivity_area`."""
    return f"{term.identifier}_{parameter}"


def contact_parameter(term: CandidateTerm, parameter: str, pair: tuple[int, int]) -> str:
    """Name of a parameter of two coils that touch, for example `touching_coils_g_1_3`: coils counted from 1."""
    return f"{parameter_name(term, parameter)}_{pair[0] + 1}_{pair[1] + 1}"


def first_rows() -> list[Row]:
    """Time and number of coils."""
    return [
        Row("time", "TIME", "s", description="Simulated time", is_scalar=True),
        Row("coils", "STRUCTURE", start="COILS", description="Number of coils", is_scalar=True),
    ]


def state_rows(terms: Sequence[CandidateTerm], depends: str) -> list[Row]:
    """States that the terms add, as outputs."""
    return [
        Row(
            f"shown_{t.identifier}_{s.name}",
            "OUTPUT",
            s.unit,
            description=f"State of {t.name}",
            depends=depends,
            name=f"{t.identifier}_{s.name}",
            is_scalar=s.kind == "shared",
        )
        for t in terms
        for s in t.states
    ]


def show_states(terms: Sequence[CandidateTerm]) -> str:
    """Statements that copy the states of the terms to the outputs."""
    lines = []
    for term in terms:
        for number, state in enumerate(term.states):
            source = f"s->state + (STATE_{term.identifier} + {number}) * s->width"
            size = "sizeof(double)" if state.kind == "shared" else _SIZE
            lines.append(f"    memcpy(ARRAY(shown_{term.identifier}_{state.name}), {source}, {size});\n")
    return "".join(lines)


def take(array: str, variable: str) -> str:
    """Statement that copies a variable to an array of the step."""
    return f"    memcpy(s->{array}, ARRAY({variable}), {_SIZE});\n"


def give(port: Port) -> str:
    """Statement that copies an array of the step to the port of that name."""
    return f"    memcpy(ARRAY(port_{port.array}), s->{port.array}, {_SIZE});\n"


def fields_in(terms: Sequence[CandidateTerm]) -> list[str]:
    """Base parameters of the network that the lines of terms read."""
    used = {w for t in terms for text in (*t.lines.values(), *(s.start for s in t.states)) for w in words(text)}
    used -= {p.name for t in terms for p in t.parameters}
    return [name for name in COIL_FIELDS if name in used]


def term_rows(terms: Sequence[CandidateTerm], contacts: Sequence[tuple[int, int]] = ()) -> list[Row]:
    """Parameters of the terms, one after the other: the network reads them as one block.

    Args:
        terms: The terms.
        contacts: Pairs of coils that may touch in this FMU; a term of them has a scalar for each.
    """
    rows = []
    for term in terms:
        for p in term.parameters:
            start, what = "0" if p.is_amplitude else repr(p.starts[0]), f"{term.name}: {p.name} in {term.law}"
            if term.axis != "pair":
                rows.append(Row(parameter_name(term, p.name), "PARAMETER", p.unit, start, what))
                continue
            for pair in contacts:
                of = f"{what}, of the coils {pair[0] + 1} and {pair[1] + 1}"
                rows.append(Row(contact_parameter(term, p.name, pair), "PARAMETER", p.unit, start, of, is_scalar=True))
    return rows


def _states(terms: Sequence[CandidateTerm]) -> list[str]:
    return [f"{t.identifier}_{number}" for t in terms for number in range(len(t.states))]


def hidden_rows(terms: Sequence[CandidateTerm]) -> list[Row]:
    """Fields, arrays and states of the network, part of the saved state of the FMU."""
    names = [f"field_{n}" for n in COIL_FIELDS] + [f"step_{n}" for n in _arrays()]
    names += [f"state_{n}" for n in _states(terms)] + [f"rate_{n}" for n in _states(terms)]
    return [Row(n, "HIDDEN") for n in names] + [Row("last_step", "HIDDEN", is_scalar=True)]


def _arrays() -> list[str]:
    return [n for n in step_arrays() if n not in ("state", "state_rate")]


def assemble_source(
    part: str,
    what: str,
    rows: Sequence[Row],
    terms: Sequence[CandidateTerm],
    layout: CoilNetworkLayout,
    functions: Functions,
    contacts: Sequence[tuple[int, int]] = (),
) -> Source:
    """All of it.

    Args:
        part: actuator or load: the file of this folder with the model's functions.
        what: Description.
        rows: Variables, without those of the terms and the hidden ones.
        terms: Terms of this part, in the order of the catalogue.
        layout: Coils and strings.
        functions: What the part calls.
        contacts: Pairs of coils that touch.
    """
    table = [*rows, *term_rows(terms, contacts), *hidden_rows(terms)]
    model = "\n".join(
        [
            _HEAD,
            generate(terms),
            _bind(terms, layout, contacts),
            functions.text(),
            (_FOLDER / f"{part}.c").read_text("utf-8"),
        ]
    )
    return Source(config(f"amended_{part}", what, table), model, _page(what, terms))


def _first_name(term: CandidateTerm, contacts: Sequence[tuple[int, int]]) -> str:
    """Name of the variable that the block of a term's parameters begins with."""
    name = term.parameters[0].name
    return contact_parameter(term, name, contacts[0]) if term.axis == "pair" else parameter_name(term, name)


def _bind(terms: Sequence[CandidateTerm], layout: CoilNetworkLayout, contacts: Sequence[tuple[int, int]]) -> str:
    """C function that points the arrays of a step into the block of values of an instance."""
    offsets = "".join(
        f"    bound->offset[{n}] = (int64_t)model->offset[VAR_{_first_name(t, contacts)}];\n"
        for n, t in enumerate(terms)
    )
    arrays = "".join(f"    s->{n} = ARRAY(step_{n});\n" for n in _arrays())
    states = _states(terms)
    if states:
        arrays += f"    s->state = ARRAY(state_{states[0]});\n    s->state_rate = ARRAY(rate_{states[0]});\n"
    has_pairs = any("pairs" in t.lines for t in terms)
    pairs = layout.pairs if has_pairs else ()
    numbers = [", ".join(str(p[side]) for p in some) or "0" for some in (pairs, contacts) for side in (0, 1)]
    return f"""
#define PAIRED_COILS {layout.coils}
static const int64_t pairs_a[] = {{{numbers[0]}}}, pairs_b[] = {{{numbers[1]}}};
static const int64_t contacts_a[] = {{{numbers[2]}}}, contacts_b[] = {{{numbers[3]}}};

typedef struct {{
    Plan plan;
    int64_t offset[{len(terms) + 1}];
    double ambient[1], time[2];
}} Bound;

static Step *bind(Model *model, Step *s, Bound *bound)
{{
    memset(s, 0, sizeof *s);
    memset(bound, 0, sizeof *bound);
    Plan *plan = &bound->plan;
    s->plan = plan;
    s->coils = s->width = plan->coils = plan->width = (int64_t)model->coils;
    plan->steps = 1;
    plan->pairs = {len(pairs)};
    plan->pair_a = pairs_a;
    plan->pair_b = pairs_b;
    plan->contacts = {len(contacts)};
    plan->contact_a = contacts_a;
    plan->contact_b = contacts_b;
    plan->ambient = bound->ambient;
    plan->time = bound->time;
    plan->term_offset = bound->offset;
    bound->time[0] = bound->time[1] = NUMBER(time);
    s->set = model->values;
    s->coil = ARRAY(field_{next(iter(COIL_FIELDS))});
{offsets}{arrays}    s->felt = s->temperature;
    return s;
}}
"""


def _page(what: str, terms: Sequence[CandidateTerm]) -> str:
    rows = "".join(
        f"<tr><td>{_html(t.name)}</td><td><code>{_html(t.law)}</code></td><td>{_html(t.source)}</td></tr>\n"
        for t in terms
    )
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{_html(what)}</title></head><body>\n'
        f"<h1>{_html(what)}</h1>\n<p>Co-Simulation. A step has the equations of the coil network with inputs "
        "held.</p>\n"
        f"<table><tr><th>term</th><th>law</th><th>source</th></tr>\n{rows}</table>\n</body></html>\n"
    )


def _html(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
