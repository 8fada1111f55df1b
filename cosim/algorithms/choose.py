"""The algorithm that a scenario names, made for its system."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from cosim.algorithms import gauss_seidel, jacobi
from cosim.algorithms.algorithm import Algorithm, Plain
from cosim.algorithms.iterated import Iterated
from cosim.algorithms.step_doubling import ErrorControl, StepDoubling
from cosim.algorithms.synchronised import Synchronised
from cosim.components import nanoseconds
from cosim.scenario import Algorithm as Settings
from cosim.scenario import Iterated as IteratedSettings
from cosim.scenario import StepDoubling as StepDoublingSettings
from cosim.system import System
from cosim.unit.protocol import StepOutcome

PLAIN: Mapping[str, Callable[[System, int, int], StepOutcome]] = {
    "gauss_seidel": gauss_seidel.step,
    "jacobi": jacobi.step,
}


def choose(settings: Settings, system: System, size: int) -> Algorithm:
    """What makes the macro-steps.

    Args:
        settings: The scenario's `algorithm`.
        system: The system that it will step.
        size: Macro-step [ns].

    Raises:
        CannotRestore: The algorithm repeats steps, and a unit cannot.
    """
    if isinstance(settings, IteratedSettings):
        return Iterated(system, settings.relative_tolerance.to("1"), settings.iterations, settings.inputs == "mean")
    if isinstance(settings, StepDoublingSettings):
        control = ErrorControl(
            settings.relative_tolerance.to("1"), settings.absolute_tolerance, nanoseconds(settings.minimum_step)
        )
        return StepDoubling(system, PLAIN[settings.inner], control, size)
    plain = PLAIN[settings.kind]
    return Synchronised(system, plain) if settings.on_event == "synchronise" else Plain(plain)
