"""An independent twin of niti_kinetics: scipy integrates the temperature, where the FMU integrates the stored heat.

The transformation is in the effective heat capacity, corners of the cosine law are found as events, and a sudden change
of tension is an adiabatic balance solved by brentq. Numbers: scenarios/parameter_sets/niti_kinetics.yaml.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq


@dataclass(frozen=True)
class Alloy:
    """Constants of one coil, SI."""

    mass: float = 6450 * 7.328e-9
    specific_heat: float = 837.0
    latent_heat: float = 24000.0
    conductance: float = 90 * 97.85e-6
    martensite_finish: float = 278.34
    martensite_start: float = 310.37
    austenite_start: float = 297.42
    austenite_finish: float = 320.37
    slope: float = 13.8e6
    wire: float = 0.29956e-3
    coil: float = 1.0676e-3

    def shift(self, tension: float) -> float:
        """Rise of the transformation temperatures [K] under a tension [N]: mean shear stress over slope."""
        return 16.0 * max(tension, 0.0) * self.coil / (3.0 * np.pi * self.wire**3) / self.slope

    def heating(self, reduced):
        """Austenite on the heating branch."""
        x = (reduced - self.austenite_start) / (self.austenite_finish - self.austenite_start)
        return np.sin(0.5 * np.pi * np.clip(x, 0.0, 1.0)) ** 2

    def cooling(self, reduced):
        """Austenite on the cooling branch."""
        x = (reduced - self.martensite_finish) / (self.martensite_start - self.martensite_finish)
        return np.sin(0.5 * np.pi * np.clip(x, 0.0, 1.0)) ** 2


NITI = Alloy()


@dataclass
class Twin:
    """One coil: temperature [K], austenite fraction, convected energy [J], and where it last turned."""

    alloy: Alloy = NITI
    temperature: float = 295.15
    tension: float = 0.0
    convected: float = 0.0
    austenite: float = field(init=False)
    reduced: float = field(init=False)

    def __post_init__(self) -> None:
        self.reduced = self.temperature - self.alloy.shift(self.tension)
        self.austenite = float(self.alloy.heating(self.reduced))

    def fraction(self, reduced: float) -> float:
        """Austenite at a reduced temperature on the way from the present one."""
        a = self.alloy
        if reduced > self.reduced:
            left = 1.0 - a.heating(self.reduced)
            return float(1.0 - (1.0 - self.austenite) * (1.0 - a.heating(reduced)) / left) if left else self.austenite
        left = a.cooling(self.reduced)
        return float(self.austenite * a.cooling(reduced) / left) if left else self.austenite

    def _load(self, tension: float) -> None:
        """Change the tension at once: no heat flows, so latent heat goes to temperature."""
        if tension == self.tension:
            return
        a, shift = self.alloy, self.alloy.shift(tension)
        ratio = a.latent_heat / a.specific_heat

        def excess(temperature: float) -> float:
            return temperature - self.temperature + ratio * (self.fraction(temperature - shift) - self.austenite)

        temperature = brentq(excess, self.temperature - ratio, self.temperature + ratio, xtol=1e-12)
        self.austenite = self.fraction(temperature - shift)
        self.temperature, self.reduced, self.tension = temperature, temperature - shift, tension

    def step(self, power: float, step: float, tension: float = 0.0, ambient: float = 295.15) -> None:
        """Advance by `step` [s] with constant inputs."""
        self._load(tension)
        a, shift = self.alloy, self.alloy.shift(tension)
        capacity, before, start = a.mass * a.specific_heat, self.austenite, self.temperature
        corners = [a.austenite_start, a.austenite_finish, a.martensite_finish, a.martensite_start]
        events = [lambda _, y, c=c: y[0] - shift - c for c in corners]

        def rate(_, y):
            reduced, small = y[0] - shift, 1e-5
            slope = (self.fraction(reduced + small) - self.fraction(reduced - small)) / (2.0 * small)
            rising = power - a.conductance * (y[0] - ambient)
            # The law is one-sided where the coil turns: only the way ahead counts.
            if abs(reduced - self.reduced) < small:
                ahead = self.reduced + np.sign(rising) * small
                slope = (self.fraction(ahead) - self.austenite) / (ahead - self.reduced)
            return [rising / (capacity + a.mass * a.latent_heat * slope)]

        time, value = 0.0, np.array([start])
        for event in events:
            event.terminal = True
        while time < step:
            ahead = [e for e in events if abs(e(0.0, value)) > 1e-9]
            run = solve_ivp(rate, (time, step), value, "DOP853", rtol=1e-11, atol=1e-10, events=ahead)
            time, value = run.t[-1], run.y[:, -1]
        self.temperature = float(value[0])
        self.austenite, self.reduced = self.fraction(self.temperature - shift), self.temperature - shift
        stored = capacity * (self.temperature - start) + a.mass * a.latent_heat * (self.austenite - before)
        self.convected += power * step - stored


def simulate(powers, tensions, step):
    """Temperature [K], austenite and convected energy [J] at the end of every step; shape (steps, 3, coils)."""
    record = np.empty((len(powers), 3, powers.shape[1]))
    for coil in range(powers.shape[1]):
        twin = Twin()
        twin.tension = tensions[0, coil]
        twin.__post_init__()
        for index, (power, tension) in enumerate(zip(powers[:, coil], tensions[:, coil])):
            twin.step(power, step, tension)
            record[index, :, coil] = twin.temperature, twin.austenite, twin.convected
    return record
