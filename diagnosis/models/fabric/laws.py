"""What a fabric may lack, as laws that its unit in Bullet can switch on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from diagnosis.search.cosim_model import ComponentTerm
from diagnosis.search.problem import Term, TermParameter
from diagnosis.search.unit_law import UnitLaw
from mechanics.fabric import Layout


@dataclass(frozen=True)
class _Law:
    """One effect of one number; it is simulated first at the first start value."""

    identifier: str
    name: str
    law: str
    parameter: TermParameter
    confused_with: Mapping[str, str] = field(default_factory=dict)


_HOT = "a hot and a cold part of the recording decide"
_LOAD = "a known weight on the last row decides"
#: Share of the largest believable size at which an effect is simulated first: one run each, and it has to show beyond
#: the scatter of the contacts.
FIRST = 0.3


#: The same of an effect of one link: a spring that is a third weaker moves less than contacts scatter.
SHARE = 0.6


def _number(
    name: str, unit: str, lower: float, upper: float, most: float, why: str, meaning: str, first: float = FIRST
) -> TermParameter:
    """The number of an effect, tried at one share of the largest size that is believed, and of either sign."""
    starts = (first * most, -first * most) if lower < 0.0 else (first * most,)
    return TermParameter(name, unit, lower, upper, starts, plausible=most, plausible_reason=why, meaning=meaning)


#: Bounds: friction and damping take energy, springs store it.
_LAWS = (
    _Law(
        "contact_friction",
        "more friction between links",
        "friction_of_a_pair = friction + added_friction",
        _number(
            "added_friction",
            "1",
            0.0,
            2.0,
            1.0,
            "dry metal has a coefficient of 0.5 to 1 in all",
            "change of the coefficient of friction between links",
        ),
        {
            "hinge_friction": "whether links stop sliding or rolling: markers of single links decide",
            "base:friction": "never told apart: the same number, beyond what the scenario allows it",
        },
    ),
    _Law(
        "slide_friction",
        "Coulomb friction in the slides of the links",
        "force = -slide_friction * sign(slide_rate)",
        _number(
            "slide_friction",
            "N",
            0.0,
            5.0,
            1.5,
            "a coil that is stretched by 10 mm pulls with 1.6 N: more would hold it for good",
            "force that friction holds in a slide",
        ),
        {"backlash": _HOT, "contact_friction": "lengths of single links decide"},
    ),
    _Law(
        "viscous_damping",
        "viscous damping in the slides of the links",
        "force = -slide_damping * slide_rate",
        _number(
            "slide_damping",
            "N*s/m",
            0.0,
            100.0,
            10.0,
            "grease of 10 Pa s between surfaces of 1 cm^2 that are 0.1 mm apart",
            "force in a slide per speed",
        ),
        {"slide_friction": "where links stop decides: damping lets them reach their stops"},
    ),
    _Law(
        "hinge_friction",
        "stiction of the hinges that hooked links make",
        "torque = -hinge_friction * normal_force * sign(rolling)",
        _number(
            "hinge_friction",
            "m",
            0.0,
            0.02,
            0.01,
            "the lever of rolling is not longer than the link",
            "lever of the torque that holds a hinge",
        ),
        {"contact_friction": "markers of single links decide"},
    ),
    _Law(
        "supply_wire_stiffness",
        "stiffness of the supply wires",
        "force = -wire_stiffness * (place - woven_place)",
        _number(
            "wire_stiffness",
            "N/m",
            0.0,
            50.0,
            2.6,
            "two stranded leads of 0.5 mm that bend over 50 mm: 3 E I / L^3 = 1.3 N/m each",
            "spring constant of the wires",
        ),
        {"payload": _HOT, "tilt": "positions along and across decide"},
    ),
    _Law(
        "backlash",
        "play of the coils in their pins",
        "tension = stiffness * maximum(extension - coil_play, 0)",
        _number(
            "coil_play",
            "m",
            0.0,
            5e-3,
            0.003,
            "a third of a coil of 9.4 mm: it would rattle",
            "play of a coil in its pins",
        ),
        {"thermal_contraction": _HOT, "base:steel_stiffness": _HOT},
    ),
    _Law(
        "thermal_contraction",
        "contraction of the coils with their transformation (two-way effect)",
        "rest_length = cold_rest_length - coil_contraction * (stiffness - cold_stiffness)",
        _number(
            "coil_contraction",
            "m^2/N",
            0.0,
            5e-5,
            3e-05,
            "230 N/m, the whole transformation, times that are 7 mm: the coil's length",
            "change of the length per change of the stiffness",
        ),
        {"backlash": _HOT},
    ),
    _Law(
        "payload",
        "a mass on the last row",
        "force = payload * gravity",
        _number(
            "payload",
            "kg",
            0.0,
            0.2,
            0.06,
            "half of what the 18 links of the prototype weigh, 7.3 g each",
            "mass on the last row",
        ),
        {"base:link_mass": _LOAD, "supply_wire_stiffness": _HOT},
    ),
    _Law(
        "tilt",
        "tilt of the stand along the fabric",
        "gravity_y = -gravity * sin(tilt)",
        _number("tilt", "rad", -0.5, 0.5, 0.25, "a stand that leans by 15 degrees is seen", "angle along the fabric"),
        {"payload": "lengths along the fabric decide"},
    ),
    _Law(
        "roll",
        "tilt of the stand across the fabric",
        "gravity_x = -gravity * sin(roll)",
        _number("roll", "rad", -0.5, 0.5, 0.25, "a stand that leans by 15 degrees is seen", "angle across the fabric"),
    ),
)


@dataclass(frozen=True)
class _LinkLaw:
    """An effect of one link, or of all free links of a row."""

    identifier: str
    name: str
    law: str
    parameter: TermParameter
    confused_with: Mapping[str, str]


_ONE_LINK = "the lengths of single links decide"
_LINK_LAWS = (
    _LinkLaw(
        "weak_steel",
        "weak steel springs",
        "stiffness = (1 - steel_loss) * steel_stiffness",
        _number(
            "steel_loss",
            "1",
            0.0,
            1.0,
            1.0,
            "springs that are left out",
            "share of the stiffness of the steel springs that is missing",
            SHARE,
        ),
        {"weak_coil": "never told apart from stronger coils: the two balance", "base:steel_stiffness": _ONE_LINK},
    ),
    _LinkLaw(
        "weak_coil",
        "weak coils",
        "stiffness = (1 - coil_loss) * coil_stiffness",
        _number(
            "coil_loss",
            "1",
            0.0,
            1.0,
            1.0,
            "coils that are broken",
            "share of the stiffness of the coils that is missing",
            SHARE,
        ),
        {"unheated_coil": "the cold part of the recording decides", "jammed_link": _HOT, "weak_steel": _ONE_LINK},
    ),
    _LinkLaw(
        "unheated_coil",
        "coils that are heated less",
        "stiffness = coil_stiffness - heat_loss * maximum(coil_stiffness - cold_stiffness, 0)",
        _number(
            "heat_loss",
            "1",
            0.0,
            1.0,
            1.0,
            "coils that stay cold",
            "share of the rise of the coils' stiffness that is missing",
            SHARE,
        ),
        {"weak_coil": "the cold part of the recording decides", "jammed_link": "the cold part decides"},
    ),
    _LinkLaw(
        "jammed_link",
        "a slide that jams",
        "force = -slide_friction * sign(slide_rate)",
        _number(
            "slide_friction",
            "N",
            0.0,
            40.0,
            40.0,
            "more than all springs of a link can push",
            "force that friction holds in the slide",
            SHARE,
        ),
        {"weak_coil": _HOT, "unheated_coil": "the cold part decides", "slide_friction": _ONE_LINK},
    ),
)

#: Identifiers of what single links and rows may have.
LINK_LAWS = frozenset(law.identifier for law in _LINK_LAWS)


@dataclass(frozen=True)
class LinkPlace:
    """Links that an effect acts in.

    Args:
        label: For people.
        links: Their numbers, from 1.
        row: Number of the row, from 1.
        is_row: Whether they are all free links of the row.
    """

    label: str
    links: tuple[int, ...]
    row: int
    is_row: bool


def link_places(component: str, layout: Layout) -> list[LinkPlace]:
    """Every row with links that slide, then every such link.

    A row with one of them is no place of its own.

    Args:
        component: Name of the fabric in the scenario.
        layout: Its links.
    """
    sliding = [int(i) for i in np.flatnonzero(~layout.is_locked)]
    rows: dict[int, list[int]] = {}
    for link in sliding:
        rows.setdefault(int(layout.row[link]) + 1, []).append(link + 1)
    found = [LinkPlace(f"{component}, row {r}", tuple(own), r, True) for r, own in rows.items() if len(own) > 1]
    for link in sliding:
        row, place = int(layout.row[link]) + 1, int(layout.link_in_row[link]) + 1
        label = f"{component}, link {link + 1} (row {row}, place {place})"
        found.append(LinkPlace(label, (link + 1,), row, False))
    return found


def fabric_laws(component: str) -> list[UnitLaw]:
    """Laws of all links of a component of kind `bullet_fabric`.

    Args:
        component: Its name in the scenario.
    """
    return [
        UnitLaw(
            ComponentTerm(
                Term(law.identifier, component, "mechanical", (law.parameter,), law=law.law),
                component,
                (law.parameter.name,),
            ),
            law.name,
            "mechanics/added.py",
            law.confused_with,
        )
        for law in _LAWS
    ]


def link_laws(component: str, places: Sequence[LinkPlace]) -> dict[Term, tuple[UnitLaw, LinkPlace]]:
    """Laws of single links and rows, with where each acts.

    Args:
        component: Name of the fabric in the scenario.
        places: See `link_places`.
    """
    found = {}
    for place in places:
        for law in _LINK_LAWS:
            term = Term(law.identifier, place.label, "mechanical", (law.parameter,), law=law.law)
            names = tuple(f"{law.parameter.name}[{link}]" for link in place.links)
            own = UnitLaw(ComponentTerm(term, component, names), law.name, "mechanics/added.py", law.confused_with)
            found[term] = own, place
    return found
