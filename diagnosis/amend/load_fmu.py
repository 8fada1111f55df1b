"""What hangs below the coils, with its terms, as an FMU in place of the ideal hanging mass."""

from __future__ import annotations

from collections.abc import Sequence

from diagnosis.amend.fmu_source import (
    Functions,
    Source,
    assemble_source,
    fields_in,
    first_rows,
    show_states,
    state_rows,
    take,
)
from diagnosis.amend.parts import Port, load_ports, names_in
from diagnosis.amend.table import Row
from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.models.coil_network.kernel.layout import COIL_FIELDS, CoilNetworkLayout

#: Fields that the load has itself.
_OWN = ("load", "rest_length")


def load_fields(terms: Sequence[CandidateTerm]) -> list[str]:
    """Base parameters of the coils that the load must be given too, for example reference_temperature."""
    return [name for name in fields_in(terms) if name not in _OWN]


def load_source(terms: Sequence[CandidateTerm], layout: CoilNetworkLayout) -> Source:
    """Sources of the load.

    Args:
        terms: Terms of the part LOAD, in the order of the catalogue.
        layout: Coils and strings.
    """
    ports = load_ports(terms)
    every = " ".join(f"@{name}" for name in ("stiffness", "rest_length", *(p.name for p in ports)))
    rows = [
        *first_rows(),
        Row("stiffness", "INPUT", "N/m", "157.1", "Spring constant of each coil", limit="POSITIVE", nominal=200.0),
        Row("rest_length", "INPUT", "m", "0.0094", "Length of each coil without load", nominal=0.01),
        *(Row(f"port_{p.array}", "INPUT", p.unit, _start_of(p), p.meaning, name=p.name) for p in ports),
        Row("extension", "OUTPUT", "m", description="Elongation under the load", depends=every, nominal=0.01),
        Row("length", "OUTPUT", "m", description="Length under the load", depends=every, nominal=0.01),
        Row("tension", "OUTPUT", "N", description="Force on each coil", depends=_tension(terms)),
        *state_rows(terms, every),
        Row("mass", "PARAMETER", "kg", "0.1", "Mass below each coil", limit="NON_NEGATIVE"),
        Row("gravity", "PARAMETER", "m/s^2", "9.81", "Gravity", is_scalar=True, limit="NON_NEGATIVE", nominal=10.0),
        *(
            Row(n, "PARAMETER", COIL_FIELDS[n][1], repr(COIL_FIELDS[n][0]), f"Of each coil: {n.replace('_', ' ')}")
            for n in load_fields(terms)
        ),
    ]
    copies = {False: "", True: take("stiffness", "stiffness") + _REST_LENGTH}
    for p in ports:
        copies[p.is_late] += take(p.array, f"port_{p.array}")
    functions = Functions(
        {
            "fill_fields": _fill(load_fields(terms)),
            "take_inputs": copies[False],
            "take_stiffness": copies[True],
            "give_outputs": show_states(terms),
        }
    )
    what = "Load below the coils, with the terms that a diagnosis found"
    return assemble_source("load", what, rows, terms, layout, functions)


_REST_LENGTH = "    memcpy(ARRAY(field_rest_length), ARRAY(rest_length), (size_t)s->coils * sizeof(double));\n"


def _start_of(port: Port) -> str:
    return "295.15" if port.array in ("temperature", "mean", "ambient") else "0"


def _tension(terms: Sequence[CandidateTerm]) -> str:
    """Inputs that the force depends on at the start."""
    in_load = [t for t in terms if "load" in t.lines]
    reads = " ".join(f"@{p.name}" for p in load_ports(in_load))
    return f"{reads} @stiffness".strip() if "stiffness" in names_in(in_load) else reads


def _fill(fields: Sequence[str]) -> str:
    given = "".join(f"        ARRAY(field_{n})[i] = ARRAY({n})[i];\n" for n in fields)
    return f"""    for (size_t i = 0; i < model->coils; i++) {{
        ARRAY(field_load)[i] = ARRAY(mass)[i] * NUMBER(gravity);
        ARRAY(field_rest_length)[i] = ARRAY(rest_length)[i];
{given}    }}
"""
