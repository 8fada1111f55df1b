"""The coils with their terms as an FMU: heat, added states, stiffness, resistance."""

from __future__ import annotations

from collections.abc import Sequence

from diagnosis.amend.fmu_source import (
    Functions,
    Source,
    assemble_source,
    first_rows,
    give,
    show_states,
    state_rows,
    take,
)
from diagnosis.amend.parts import Port, names_in
from diagnosis.amend.table import Row
from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.models.coil_network.kernel.layout import COIL_FIELDS, CoilNetworkLayout

#: Fields of the network that parameters of the same name give.
_DIRECT = {
    "reference_resistance": "POSITIVE",
    "resistance_temperature_coefficient": "ANY",
    "reference_temperature": "POSITIVE",
    "power_gain": "NON_NEGATIVE",
    "cooling_rate": "NON_NEGATIVE",
    "off_power": "NON_NEGATIVE",
    "initial_temperature": "POSITIVE",
    "initial_loop_position": "NON_NEGATIVE",
    "cycles_before": "NON_NEGATIVE",
    **{f"{branch}_{letter}": "POSITIVE" for branch in ("heating", "cooling") for letter in "abcd"},
}
#: Inputs that terms may need beside power and ambient temperature: array of the step to unit and meaning.
_NEIGHBOURS = {
    "extension": ("m", "Elongation of each coil beyond its rest length"),
    "tension": ("N", "Pull on each coil"),
    "current": ("A", "Current of each coil"),
}
_READ_AS = {"extension": {"extension", "extension_before"}, "tension": {"tension"}, "current": {"I"}}


def neighbour_inputs(terms: Sequence[CandidateTerm]) -> list[str]:
    """Inputs that the terms of the coils need from circuit and load: `extension`, `tension`, `current`."""
    used = names_in(terms)
    return [name for name, reads in _READ_AS.items() if reads & used]


def actuator_source(
    terms: Sequence[CandidateTerm],
    layout: CoilNetworkLayout,
    ports: Sequence[Port],
    inputs: Sequence[str],
    contacts: Sequence[tuple[int, int]] = (),
) -> Source:
    """Sources of the coils.

    Args:
        terms: Terms of the part ACTUATOR, in the order of the catalogue.
        layout: Coils and strings.
        ports: What the load wants to be told, beside stiffness and rest length.
        inputs: Inputs beside power and ambient temperature: `extension`, `tension`, `current`.
        contacts: Pairs of coils that touch.
    """
    shown = [p for p in ports if p.array != "temperature"]
    rows = [
        *first_rows(),
        Row("power", "INPUT", "W", description="Electrical power turned into heat in each coil"),
        Row(
            "ambient_temperature",
            "INPUT",
            "K",
            "295.15",
            "Temperature of the surrounding air or bath",
            is_scalar=True,
            limit="POSITIVE",
            nominal=300.0,
        ),
        *(Row(name, "INPUT", *_NEIGHBOURS[name][:1], description=_NEIGHBOURS[name][1]) for name in inputs),
        *_outputs(terms, inputs),
        *(
            Row(f"port_{p.array}", "OUTPUT", p.unit, description=p.meaning, name=p.name, depends="@ambient_temperature")
            for p in shown
        ),
        *state_rows(terms, "@ambient_temperature"),
        *_parameters(),
    ]
    takes = "".join(take(name, name) for name in inputs)
    from_load = "".join(take(name, name) for name in inputs if name != "current")
    before = take_before() if "extension" in inputs else ""
    functions = Functions(
        {
            "fill_fields": _fill(),
            "take_inputs": before + takes + _POWER,
            "take_neighbours": from_load,
            "give_outputs": "".join(give(p) for p in shown) + show_states(terms),
        }
    )
    what = "Coils with the terms that a diagnosis found"
    return assemble_source("actuator", what, rows, terms, layout, functions, contacts)


#: The ambient temperature of the step, and the power of every coil.
_POWER = """    *(double *)s->plan->ambient = NUMBER(ambient_temperature);
    for (int64_t i = 0; i < s->coils; i++) {
        s->power[i] = ARRAY(power)[i] * COIL(power_gain)[i];
    }
"""


def take_before() -> str:
    """Statement that keeps the extension of the step before."""
    return "    memcpy(s->extension_before, s->extension, (size_t)s->coils * sizeof(double));\n"


def _outputs(terms: Sequence[CandidateTerm], inputs: Sequence[str]) -> list[Row]:
    used = names_in([t for t in terms if "resistance" in t.lines])
    direct = [n for n in inputs if n != "current" and _READ_AS[n] & used]
    start = "@ambient_temperature" + (" @tension" if "tension" in inputs else "")
    return [
        Row("temperature", "OUTPUT", "K", description="Temperature of each coil", limit="POSITIVE", nominal=300.0),
        Row(
            "stiffness",
            "OUTPUT",
            "N/m",
            description="Spring constant of each coil",
            limit="POSITIVE",
            depends=start,
            nominal=200.0,
        ),
        Row("rest_length", "OUTPUT", "m", description="Length of each coil without load", nominal=0.01),
        Row(
            "resistance",
            "OUTPUT",
            "ohm",
            description="Electrical resistance of each coil",
            limit="POSITIVE",
            depends=" ".join([start, *direct]),
        ),
        Row("stored_energy", "OUTPUT", "J", description="Heat stored in each coil since the start"),
        Row(
            "convected_energy",
            "OUTPUT",
            "J",
            description="Electrical energy that is not stored in the coil: given away, or to what the terms add",
        ),
    ]


def _parameters() -> list[Row]:
    """As those of thermal_stiffness, each with a value per coil."""
    plain = {
        "heat_transfer_coefficient": ("W/(m^2*K)", 90.0, "Convective heat transfer coefficient h"),
        "volume": ("m^3", 7.328e-9, "Volume of each coil"),
        "area": ("m^2", 97.85e-6, "Surface area of each coil"),
        "density": ("kg/m^3", 6450.0, "Density"),
        "specific_heat": ("J/(kg*K)", 837.0, "Specific heat"),
        "coil_rest_length": ("m", 0.0094, "Length of a coil without load"),
    }
    rows = [Row(n, "PARAMETER", u, repr(v), what, limit="NON_NEGATIVE") for n, (u, v, what) in plain.items()]
    for name, limit in _DIRECT.items():
        value, unit = COIL_FIELDS[name]
        rows.append(Row(name, "PARAMETER", unit, repr(value), f"Of each coil: {name.replace('_', ' ')}", limit=limit))
    return [
        *rows,
        Row(
            "use_regressed_cooling_rate",
            "FLAG",
            start="1",
            is_scalar=True,
            description="Whether a coil that is switched off cools with cooling_rate instead of h A / C",
        ),
    ]


def _fill() -> str:
    direct = "".join(f"        ARRAY(field_{n})[i] = ARRAY({n})[i];\n" for n in _DIRECT)
    return f"""    for (size_t i = 0; i < model->coils; i++) {{
{direct}        ARRAY(field_conductance)[i] = ARRAY(heat_transfer_coefficient)[i] * ARRAY(area)[i];
        ARRAY(field_capacity)[i] = ARRAY(density)[i] * ARRAY(volume)[i] * ARRAY(specific_heat)[i];
        ARRAY(field_use_regressed_cooling_rate)[i] = NUMBER(use_regressed_cooling_rate);
        ARRAY(field_rest_length)[i] = ARRAY(coil_rest_length)[i];
        ARRAY(field_ambient_offset)[i] = 0.0;
    }}
"""
