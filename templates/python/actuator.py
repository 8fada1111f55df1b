"""my_actuator: an actuator in Python. Edit this file; coil_actuator.py holds the FMI side and stays as it is.

Example: coils heated by their own current, which soften or stiffen along a straight line between two temperatures.
Replace parameters, states and equations by your own; everything is SI, arrays have one element per coil.
"""

import numpy as np
from coil_actuator import CoilActuator, Parameter
from pythonfmu3 import Fmi3Slave


# The class names the FMU; pythonfmu3 looks for the word Fmi3Slave in this line.
class my_actuator(CoilActuator, Fmi3Slave):  # noqa: N801
    summary = "Heated coils whose stiffness follows their temperature along a straight line"

    #: Inputs that the model uses beside ambient_temperature: power or voltage (or both), tension, extension.
    inputs = ("power",)
    #: States beyond the outputs: whatever the next step needs and the outputs do not tell.
    states = ()
    parameters = (
        Parameter("reference_resistance", 2.2, "ohm", "resistance of one coil", is_per_coil=True),
        Parameter("coil_rest_length", 9.4e-3, "m", "length of one coil without load"),
        Parameter("heat_capacity", 0.0396, "J/K", "mass times specific heat of one coil"),
        Parameter("conductance", 0.00881, "W/K", "heat given to the surroundings per kelvin"),
        Parameter("initial_temperature", 295.15, "K", "temperature at the start"),
        Parameter("soft_stiffness", 157.1, "N/m", "stiffness at soft_temperature and below"),
        Parameter("stiff_stiffness", 356.1, "N/m", "stiffness at stiff_temperature and above"),
        Parameter("soft_temperature", 303.15, "K", "where the stiffness begins to change"),
        Parameter("stiff_temperature", 343.15, "K", "where the stiffness has changed"),
    )

    def start(self) -> None:
        """First values of states, from the parameters."""
        self.temperature = np.full(self.coils, self.initial_temperature)
        self.convected_energy = np.zeros(self.coils)

    def advance(self, step: float) -> None:
        """Advance the states by `step` [s]; the inputs are constant. C dT/dt = P - G (T - T_a), solved exactly."""
        final = self.ambient_temperature + self.power / self.conductance
        before = self.temperature
        self.temperature = final + (before - final) * np.exp(-self.conductance / self.heat_capacity * step)
        self.convected_energy = (
            self.convected_energy + self.power * step - self.heat_capacity * (self.temperature - before)
        )

    def outputs(self) -> None:
        """Outputs from states and inputs."""
        span = self.stiff_temperature - self.soft_temperature
        share = np.clip((self.temperature - self.soft_temperature) / span, 0.0, 1.0)
        self.stiffness = self.soft_stiffness + share * (self.stiff_stiffness - self.soft_stiffness)
        self.rest_length = np.full(self.coils, self.coil_rest_length)
        self.resistance = self.reference_resistance * np.ones(self.coils)
        self.stored_energy = self.heat_capacity * (self.temperature - self.initial_temperature)
