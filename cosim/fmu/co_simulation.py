"""A Co-Simulation FMU: it brings its own solver."""

from __future__ import annotations

from cosim.fmu.archive import FmuArchive
from cosim.fmu.binding import DoStepDiscarded
from cosim.fmu.unit import FmuSettings, FmuUnit
from cosim.unit import StepOutcome, StepStatus, UnitError, seconds


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
        end = time + size
        try:
            reached = self.binding.do_step(seconds(time), seconds(size))
        except DoStepDiscarded:
            return StepOutcome(StepStatus.DISCARDED, time, f"{self.name} discarded the step")
        except UnitError as error:
            raise UnitError(self.name, error.what, time, error.remedy) from error
        self._read_outputs(end)
        if abs(reached - seconds(end)) > 0.5e-9:
            return StepOutcome(StepStatus.EARLY_RETURN, round(reached * 1e9), f"{self.name} returned early")
        return StepOutcome(StepStatus.OK, end)
