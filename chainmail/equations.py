"""Equations (2) to (5) of the paper in closed form, the oracle that runs are compared with.

Temperatures are in degrees Celsius here, as in the paper's fit; everything else is SI.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cosim.unit.protocol import Array


@dataclass(frozen=True)
class Coil:
    """Constants of one NiTi coil; the defaults are the paper's (section 2.3).

    Args:
        resistance: R [Ohm].
        heat_transfer_coefficient: h [W/(m^2 K)].
        area: A [m^2].
        volume: V [m^3].
        density: rho [kg/m^3].
        specific_heat: c_p [J/(kg K)].
        ambient: T_a [degC]; not published, see niti_paper.yaml.
        cooling_rate: alpha of equation (5) [1/s].
    """

    resistance: float = 2.2
    heat_transfer_coefficient: float = 90.0
    area: float = 97.85e-6
    volume: float = 7.328e-9
    density: float = 6450.0
    specific_heat: float = 837.0
    ambient: float = 22.0
    cooling_rate: float = 0.14

    @property
    def conductance(self) -> float:
        """hA [W/K]."""
        return self.heat_transfer_coefficient * self.area

    @property
    def heat_capacity(self) -> float:
        """rho V c_p [J/K]; equation (3) as printed lacks V (docs/decisions/0001)."""
        return self.density * self.volume * self.specific_heat

    @property
    def heating_rate(self) -> float:
        """hA / (rho V c_p) [1/s], 0.2226 with the paper's constants."""
        return self.conductance / self.heat_capacity

    def terminal_temperature(self, voltage: Array | float) -> Array:
        """Equation (4): temperature [degC] after long heating at `voltage` [V]."""
        return np.asarray(np.square(voltage) / (self.conductance * self.resistance) + self.ambient)

    def heating(self, time: Array | float, voltage: Array | float) -> Array:
        """Equation (3) with the volume: temperature [degC] at `time` [s] after switching on."""
        rise = self.terminal_temperature(voltage) - self.ambient
        return np.asarray(rise * (1.0 - np.exp(-self.heating_rate * np.asarray(time))) + self.ambient)

    def cooling(self, time: Array | float, begin: Array | float) -> Array:
        """Equation (5): temperature [degC] at `time` [s] after switching off at `begin` [degC]."""
        rise = np.asarray(begin) - self.ambient
        return np.asarray(rise * np.exp(-self.cooling_rate * np.asarray(time)) + self.ambient)


@dataclass(frozen=True)
class Gompertz:
    """Equation (2): k = a exp(-b exp(-c T)) + d, T in degC.

    Args:
        a: Rise of the stiffness; k, a and d share one unit (N/mm in our reading).
        b: Displacement, dimensionless.
        c: Growth rate [1/degC].
        d: Stiffness of martensite.
    """

    a: float
    b: float
    c: float
    d: float

    def __call__(self, temperature: Array | float) -> Array:
        """Stiffness at `temperature` [degC], in the unit of a and d."""
        return np.asarray(self.a * np.exp(-self.b * np.exp(-self.c * np.asarray(temperature))) + self.d)


#: Equation (2), temperature rising and falling.
HEATING = Gompertz(0.2305, 17443.0, 0.1669, 0.1571)
COOLING = Gompertz(0.1996, 696.0, 0.1549, 0.1579)
