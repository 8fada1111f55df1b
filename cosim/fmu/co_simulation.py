"""A Co-Simulation FMU: it brings its own solver."""

from __future__ import annotations

import math

from cosim.fmu.archive import FmuArchive
from cosim.fmu.unit import FmuSettings, FmuUnit
from cosim.unit import NANOSECONDS, StepOutcome, StepStatus, UnitError, seconds


class CoSimulationUnit(FmuUnit):
    """An FMU that integrates itself (`integrator: internal`).

    Args:
        name: Name of the component in the scenario.
        archive: The opened FMU.
        settings: Structure and parameters.
    """

    def __init__(self, name: str, archive: FmuArchive, settings: FmuSettings) -> None:
        super().__init__(name, archive, settings, "co_simulation")

    def do_step(self, time: int, size: int) -> StepOutcome:
        """One fmi2DoStep or fmi3DoStep.

        Raises:
            UnitError: The FMU returned an error, asked to terminate, or an output is not finite.
        """
        self.exit_initialisation()
        end = time + size
        try:
            result = self.binding.do_step(seconds(time), seconds(size))
        except UnitError as error:
            raise UnitError(self.name, error.what, time, error.remedy) from error
        if result.discarded:
            return StepOutcome(StepStatus.DISCARDED, time, f"{self.name} discarded the step")
        self.buffers.read(end)
        if abs(result.reached - seconds(end)) > 0.5e-9:
            reached = math.ceil(result.reached * NANOSECONDS)
            return StepOutcome(StepStatus.EARLY_RETURN, reached, f"{self.name} returned early")
        return StepOutcome(StepStatus.OK, end)
