"""What a pendulum may lack, as laws that its unit can switch on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from diagnosis.search.cosim_model import ComponentTerm
from diagnosis.search.problem import Term, TermParameter
from diagnosis.search.unit_law import UnitLaw


@dataclass(frozen=True)
class _Law:
    """One effect; the first parameter is its strength. The source stands in mechanics/pendulum_design.py."""

    identifier: str
    name: str
    law: str
    parameters: tuple[TermParameter, ...]
    confused_with: Mapping[str, str] = field(default_factory=dict)


_TORQUE, _DAMPING, _DRAG = "N*m", "N*m*s", "N*m*s^2"
_AMPLITUDES = "swings of different sizes decide: how the loss per swing falls with the amplitude"
#: Friction and drag take energy, so they are bounded below by 0: a fit that is not bounded finds the wrong sign.
_LAWS = (
    _Law("viscous_damping", "viscous damping of the hinge", "torque = -viscous_damping * w", (
        TermParameter("viscous_damping", _DAMPING, 0.0, 0.05, (1e-5, 1e-4, 1e-3)),),
        {"quadratic_drag": _AMPLITUDES, "coulomb_friction": _AMPLITUDES}),
    _Law("coulomb_friction", "dry friction of the hinge", "torque = -coulomb_friction * sign(w)", (
        TermParameter("coulomb_friction", _TORQUE, 0.0, 0.5, (1e-5, 1e-4, 1e-3)),),
        {"viscous_damping": _AMPLITUDES, "stiction": "slow swings decide: stiction lets go above its Stribeck speed"}),
    _Law("stiction", "stiction of the hinge", "torque = -stiction * exp(-(w / stribeck_speed)**2) * sign(w)", (
        TermParameter("stiction", _TORQUE, 0.0, 0.5, (1e-5, 1e-4, 1e-3)),
        TermParameter("stribeck_speed", "rad/s", 1e-3, 10.0, (0.05, 0.5))),
        {"coulomb_friction": "fast swings decide: there stiction does nothing"}),
    _Law("quadratic_drag", "drag of the air, with the square of the speed", "torque = -quadratic_drag * abs(w) * w", (
        TermParameter("quadratic_drag", _DRAG, 0.0, 0.05, (1e-6, 1e-5, 1e-4)),),
        {"viscous_damping": _AMPLITUDES}),
    _Law("backlash", "backlash between arm and encoder", "abs(arm - encoder) <= backlash / 2", (
        TermParameter("backlash", "rad", 0.0, 0.5, (1e-3, 1e-2)),),
        {"tilt": "slow turns decide: play stands still at each of them"}),
    _Law("tilt", "tilt of the stand against gravity", "torque = weight_moment * sin(angle - tilt)", (
        TermParameter("tilt", "rad", -0.2, 0.2, (1e-3, -1e-3, 1e-2, -1e-2)),)),
)  # fmt: skip


def pendulum_laws(component: str) -> list[UnitLaw]:
    """Laws of a component of kind `bullet_pendulum`.

    Args:
        component: Its name in the scenario.
    """
    return [
        UnitLaw(
            ComponentTerm(
                Term(law.identifier, component, "mechanical", law.parameters, law=law.law), component,
                tuple(p.name for p in law.parameters),
            ),
            law.name, "mechanics/pendulum_design.py", law.confused_with,
        )
        for law in _LAWS
    ]  # fmt: skip


def pendulum_terms(component: str) -> list[ComponentTerm]:
    """The same laws as terms alone."""
    return [law.place for law in pendulum_laws(component)]
