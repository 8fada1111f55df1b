"""What a pendulum may lack, as laws that its unit can switch on."""

from __future__ import annotations

from dataclasses import dataclass

from diagnosis.search.cosim_model import ComponentTerm
from diagnosis.search.problem import Term, TermParameter


@dataclass(frozen=True)
class _Law:
    """One effect; the first parameter is its strength. The source stands in mechanics/pendulum_design.py."""

    identifier: str
    law: str
    parameters: tuple[TermParameter, ...]


_TORQUE, _DAMPING, _DRAG = "N*m", "N*m*s", "N*m*s^2"
#: Friction and drag take energy, so they are bounded below by 0: a fit that is not bounded finds the wrong sign.
_LAWS = (
    _Law("viscous_damping", "torque = -viscous_damping * w", (
        TermParameter("viscous_damping", _DAMPING, 0.0, 0.05, (1e-5, 1e-4, 1e-3)),)),
    _Law("coulomb_friction", "torque = -coulomb_friction * sign(w)", (
        TermParameter("coulomb_friction", _TORQUE, 0.0, 0.5, (1e-5, 1e-4, 1e-3)),)),
    _Law("stiction", "torque = -stiction * exp(-(w / stribeck_speed)**2) * sign(w)", (
        TermParameter("stiction", _TORQUE, 0.0, 0.5, (1e-5, 1e-4, 1e-3)),
        TermParameter("stribeck_speed", "rad/s", 1e-3, 10.0, (0.05, 0.5)))),
    _Law("quadratic_drag", "torque = -quadratic_drag * abs(w) * w", (
        TermParameter("quadratic_drag", _DRAG, 0.0, 0.05, (1e-6, 1e-5, 1e-4)),)),
    _Law("backlash", "abs(arm - encoder) <= backlash / 2", (
        TermParameter("backlash", "rad", 0.0, 0.5, (1e-3, 1e-2)),)),
    _Law("tilt", "torque = weight_moment * sin(angle - tilt)", (
        TermParameter("tilt", "rad", -0.2, 0.2, (1e-3, -1e-3, 1e-2, -1e-2)),)),
)  # fmt: skip


def pendulum_terms(component: str) -> list[ComponentTerm]:
    """Terms of a component of kind `bullet_pendulum`.

    Args:
        component: Its name in the scenario.
    """
    return [
        ComponentTerm(
            Term(law.identifier, component, "mechanical", law.parameters, law=law.law), component,
            tuple(p.name for p in law.parameters),
        )
        for law in _LAWS
    ]  # fmt: skip
