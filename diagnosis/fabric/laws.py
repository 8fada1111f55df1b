"""What a fabric may lack, as laws that its unit in Bullet can switch on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from diagnosis.search.cosim_model import ComponentTerm
from diagnosis.search.problem import Term, TermParameter
from diagnosis.search.unit_law import UnitLaw


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
#: Bounds: friction and damping take energy, springs store it; start values: what shows beyond the contacts' scatter.
_LAWS = (
    _Law("contact_friction", "more friction between links", "friction_of_a_pair = friction + added_friction",
         TermParameter("added_friction", "1", 0.0, 2.0, (0.4,)),
         {"hinge_friction": "whether links stop sliding or rolling: markers of single links decide",
          "base:friction": "never told apart: the same number, beyond what the scenario allows it"}),
    _Law("slide_friction", "Coulomb friction in the slides of the links", "force = -slide_friction * sign(slide_rate)",
         TermParameter("slide_friction", "N", 0.0, 5.0, (0.5,)),
         {"backlash": _HOT, "contact_friction": "lengths of single links decide"}),
    _Law("viscous_damping", "viscous damping in the slides of the links", "force = -slide_damping * slide_rate",
         TermParameter("slide_damping", "N*s/m", 0.0, 100.0, (2.0,)),
         {"slide_friction": "where links stop decides: damping lets them reach their stops"}),
    _Law("hinge_friction", "stiction of the hinges that hooked links make",
         "torque = -hinge_friction * normal_force * sign(rolling)",
         TermParameter("hinge_friction", "m", 0.0, 0.02, (3e-3,)),
         {"contact_friction": "markers of single links decide"}),
    _Law("supply_wire_stiffness", "stiffness of the supply wires", "force = -wire_stiffness * (place - woven_place)",
         TermParameter("wire_stiffness", "N/m", 0.0, 50.0, (0.5,)),
         {"payload": _HOT, "tilt": "positions along and across decide"}),
    _Law("backlash", "play of the coils in their pins",
         "tension = stiffness * maximum(extension - coil_play, 0)",
         TermParameter("coil_play", "m", 0.0, 5e-3, (1e-3,)),
         {"thermal_contraction": _HOT, "base:steel_stiffness": _HOT}),
    _Law("thermal_contraction", "contraction of the coils with their transformation (two-way effect)",
         "rest_length = cold_rest_length - coil_contraction * (stiffness - cold_stiffness)",
         TermParameter("coil_contraction", "m^2/N", 0.0, 5e-5, (1e-5,)), {"backlash": _HOT}),
    _Law("payload", "a mass on the last row", "force = payload * gravity",
         TermParameter("payload", "kg", 0.0, 0.2, (5e-3,)),
         {"base:link_mass": _LOAD, "supply_wire_stiffness": _HOT}),
    _Law("tilt", "tilt of the stand along the fabric", "gravity_y = -gravity * sin(tilt)",
         TermParameter("tilt", "rad", -0.5, 0.5, (0.08, -0.08)), {"payload": "lengths along the fabric decide"}),
    _Law("roll", "tilt of the stand across the fabric", "gravity_x = -gravity * sin(roll)",
         TermParameter("roll", "rad", -0.5, 0.5, (0.08, -0.08))),
)  # fmt: skip


def fabric_laws(component: str) -> list[UnitLaw]:
    """Laws of a component of kind `bullet_fabric`.

    Args:
        component: Its name in the scenario.
    """
    return [
        UnitLaw(
            ComponentTerm(
                Term(law.identifier, component, "mechanical", (law.parameter,), law=law.law), component,
                (law.parameter.name,),
            ),
            law.name, "mechanics/added.py", law.confused_with,
        )
        for law in _LAWS
    ]  # fmt: skip
