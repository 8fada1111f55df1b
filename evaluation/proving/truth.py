"""Runs a rig: network, wires, loops, loads and the effects of a case, in steps of TR-BDF2."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from evaluation.proving.effects.effect import Effect, LoopChange, Now
from evaluation.proving.hysteresis import CELSIUS, SOFTEST, Loop, phase
from evaluation.proving.network import Branches, solve
from evaluation.proving.programme import Programme
from evaluation.proving.rig import ROOM, Array, Rig
from evaluation.proving.wire import Wires


@dataclass(frozen=True)
class Trace:
    """Everything that sensors may see.

    States stand at the ends of steps; flows, which jump, at the begin and end of each step.

    Args:
        time: Ends of steps [s], shape (steps + 1,).
        states: `temperature` where the thermometer sits, `mean_temperature` [K], `extension` [m], `stiffness` [N/m];
            shape (steps + 1, coils).
        flows: `current` of the coils [A], `power` of the coils [W], `string` [A], `supply` [A];
            shape (steps, 2, elements).
        ambient: Around the coils in each step [K], shape (steps, coils).
    """

    time: Array
    states: dict[str, Array]
    flows: dict[str, Array]
    ambient: Array

    def signal(self, quantity: str) -> tuple[Array, Array]:
        """Knots of a course that is linear between them; flows have two at one time where they jump.

        Returns:
            Times [s], shape (knots,), and values, shape (knots, elements).
        """
        if quantity in self.states:
            return self.time, self.states[quantity]
        flow = self.flows[quantity]
        return np.repeat(self.time, 2)[1:-1], flow.reshape(-1, flow.shape[2])


class Truth:
    """A rig with effects.

    Args:
        rig: True numbers.
        effects: What acts, in the order in which it acts.
        cells: Pieces of each wire.
    """

    def __init__(self, rig: Rig, effects: Sequence[Effect] = (), cells: int = 12) -> None:
        self.rig, self.effects = rig, tuple(effects)
        self.wires = Wires(rig, cells)
        sheet = rig.sheet
        self._first = np.concatenate([[0], np.cumsum(sheet.strings)[:-1]]).astype(np.int64)
        self._latent = np.zeros(sheet.coils)
        self._duhem: Array | None = None
        for effect in self.effects:
            latent, duhem = effect.latent(), effect.duhem()
            self._latent = self._latent if latent is None else self._latent + latent
            self._duhem = self._duhem if duhem is None else duhem
        self._has_resistivity = any(type(e).resistivity is not Effect.resistivity for e in self.effects)
        self._heaters = [e for e in self.effects if type(e).heat is not Effect.heat]

    def run(
        self, programme: Programme, step: float = 0.1, instants: tuple[float, ...] = (), excess: float = 0.0
    ) -> Trace:
        """The truth over a programme.

        Args:
            programme: What is done.
            step: Longest step [s].
            instants: Times at which effects set in: ends of steps.
            excess: How much warmer than their surroundings the coils start [K].

        Raises:
            WireError: The temperatures do not converge.
        """
        grid = programme.grid(step, 0.0 if programme.is_ramped else self.rig.slew, instants)
        now = self._start(programme, excess)
        record = _Record(grid)
        record.keep_state(now, self._thermometer(now))
        for begin, end in zip(grid[:-1].tolist(), grid[1:].tolist()):
            self._step(now, programme, (begin, end), record)
            record.keep_state(now, self._thermometer(now))
        return record.trace()

    def _thermometer(self, now: Now) -> Array:
        return self.wires.at(self.rig.thermometer, now.wire)

    def _start(self, programme: Programme, excess: float) -> Now:
        coils, cells = self.wires.shape
        zero = np.zeros(coils)
        room = ROOM if not self.rig.sheet.is_bath else float(programme.at(0.0))
        ambient = np.full(coils, room + self.rig.room)
        begin = ambient + excess
        wire = np.repeat(begin[:, None], cells, axis=1)
        now = Now(
            self.wires.weight,
            0.0,
            0.0,
            0.0,
            0.0,
            wire,
            begin,
            ambient,
            zero,
            zero.copy(),
            zero.copy(),
            np.zeros((coils, cells)),
            zero.copy(),
            zero.copy(),
            zero.copy(),
            self.rig.weight.copy(),
        )
        for effect in self.effects:
            effect.load(now, now.tension)
        self._change = LoopChange(zero.copy(), np.ones(coils))
        for effect in self.effects:
            effect.begin(now)
            effect.loop(now, self._change)
        self._loop = Loop(self.rig, cells, begin - self.rig.shift - self._change.shift, self._duhem)
        self._accept(now)
        now.extension = now.tension / now.stiffness
        for effect in self.effects:
            before = now.extension.copy()  # hung up and shaken: nothing holds it back yet
            effect.length(now, now.extension, before)
            effect.begin(now)
        return now

    def _step(self, now: Now, programme: Programme, span: tuple[float, float], record: _Record) -> None:
        begin, end = span
        self._advance(now, 0.5 * (end - begin))
        now.time, now.size = begin, end - begin
        self._surround(now, programme)
        first, last = (programme.at(t, self.rig.slew) for t in (begin, end - 1e-9))
        now.moment = begin
        record.keep_flows(now, self._electricity(now, now.wire, first))
        # While the supply moves straight from one level to the other, heat goes with the mean of the square.
        is_voltage = not (self.rig.sheet.is_bath or self.rig.sheet.is_driven_by_power)
        level = np.sqrt((first**2 + first * last + last**2) / 3.0) if is_voltage else 0.5 * (first + last)
        now.moment = 0.5 * (begin + end)
        self._heat_up(now, level)
        now.moment = end
        record.keep_flows(now, self._electricity(now, now.wire, last))
        record.keep_ambient(now)
        self._advance(now, 0.5 * (end - begin))
        now.size = end - begin
        self._move(now)

    def _advance(self, now: Now, size: float) -> None:
        now.size = size
        for effect in self.effects:
            effect.advance(now)

    def _surround(self, now: Now, programme: Programme) -> None:
        room = ROOM if not self.rig.sheet.is_bath else float(programme.at(now.time + 0.5 * now.size))
        now.ambient = np.full(self.wires.shape[0], room + self.rig.room)
        for effect in self.effects:
            effect.surroundings(now, now.ambient)

    def _electricity(self, now: Now, wire: Array, level: Array) -> Array:
        """Sets currents and powers; returns the currents of the strings [A]."""
        sheet = self.rig.sheet
        strings = len(sheet.strings)
        now.wire = wire
        if sheet.is_bath or sheet.is_driven_by_power:
            now.power = np.zeros(sheet.coils) if sheet.is_bath else np.array(level)
            return np.zeros(strings)
        factor = np.ones(wire.shape)
        for effect in self.effects if self._has_resistivity else ():
            effect.resistivity(now, factor)
        self._share = factor / (factor @ self.wires.weight)[:, None]
        network = Branches(
            self.rig.resistance * (factor @ self.wires.weight),
            self._first,
            np.zeros(strings),
            np.zeros(strings),
            np.zeros(strings),
        )
        now.voltage = np.array(level) if sheet.is_per_string else float(level)
        for effect in self.effects:
            now.voltage = effect.voltage(now, now.voltage)
        for effect in self.effects:
            effect.branches(now, network)
        now.current, into = solve(network, now.voltage)
        now.power = now.current**2 * network.coil
        return into

    def _heat_up(self, now: Now, level: Array) -> None:
        """Moves the temperatures over the step."""
        start, weight = now.wire, self.wires.weight
        self._electricity(now, start, level)
        factor = np.ones(self.wires.shape[0])
        for effect in self.effects:
            effect.convection(now, factor)
        loss = (self.rig.conductance * factor)[:, None] * weight
        ambient = now.ambient[:, None]

        def balance(wire: Array) -> tuple[Array, Array]:
            if self._has_resistivity:
                self._electricity(now, wire, level)
            share = self._share if self._has_resistivity else 1.0
            heat = now.power[:, None] * weight * share - loss * (wire - ambient)
            slope = -loss
            for effect in self._heaters:
                found = effect.heat(now, wire)
                assert found is not None, "a heater gives heat"
                heat, slope = heat + found[0] * weight, slope + found[1] * weight
            return heat, slope

        wire = self.wires.step(start, now.size, now.ambient, balance, self._storage)
        now.rate = (self.wires.mean(wire) - now.temperature) / now.size
        now.wire, now.temperature = wire, self.wires.mean(wire)

    def _storage(self, wire: Array) -> tuple[Array, Array]:
        capacity = self.wires.capacity
        if not self._latent.any():
            return capacity * wire, capacity
        celsius = wire - CELSIUS - (self.rig.shift + self._change.shift)[:, None]
        latent = self._latent[:, None] * self.wires.weight
        here = phase(self._loop.stiffness(celsius))
        ahead = np.where(self._loop.is_warmer(celsius), 1e-2, -1e-2)
        slope = (phase(self._loop.stiffness(celsius + ahead)) - here) / ahead
        return capacity * wire + latent * here, capacity + latent * slope

    def _accept(self, now: Now) -> None:
        """Stiffness at the temperatures reached."""
        celsius = now.wire - CELSIUS - (self.rig.shift + self._change.shift)[:, None]
        piece = self._loop.accept(celsius)
        for effect in self.effects:
            piece = effect.curve(now, celsius, piece)
        now.phase = phase(piece)
        piece = SOFTEST + self._change.fraction[:, None] * (piece - SOFTEST)
        now.stiffness = self.rig.stiffness / self.wires.mean(1.0 / piece)

    def _move(self, now: Now) -> None:
        """Loop and load at the end of the step."""
        self._change.shift[:] = 0.0
        self._change.fraction[:] = 1.0
        for effect in self.effects:
            effect.loop(now, self._change)
        self._accept(now)
        now.tension = self.rig.weight.copy()
        for effect in self.effects:
            effect.load(now, now.tension)
        before, extension = now.extension, now.tension / now.stiffness
        for effect in self.effects:
            effect.length(now, extension, before)
        now.speed, now.extension = (extension - before) / now.size, extension


class _Record:
    """What a trace is made of, step by step."""

    def __init__(self, grid: Array) -> None:
        self._grid = grid
        self._states: dict[str, list[Array]] = {
            name: [] for name in ("temperature", "mean_temperature", "extension", "stiffness")
        }
        self._flows: dict[str, list[Array]] = {name: [] for name in ("current", "power", "string", "supply")}
        self._ambient: list[Array] = []

    def keep_state(self, now: Now, thermometer: Array) -> None:
        """At the end of a step."""
        for name, value in zip(self._states, (thermometer, now.temperature, now.extension, now.stiffness)):
            self._states[name].append(np.array(value))

    def keep_flows(self, now: Now, into: Array) -> None:
        """At the begin, then at the end of a step."""
        for name, value in zip(self._flows, (now.current, now.power, into, np.array([into.sum()]))):
            self._flows[name].append(np.array(value))

    def keep_ambient(self, now: Now) -> None:
        """Of a step."""
        self._ambient.append(np.array(now.ambient))

    def trace(self) -> Trace:
        """All of it."""
        steps = len(self._ambient)
        flows = {name: np.array(values).reshape(steps, 2, -1) for name, values in self._flows.items()}
        states = {name: np.array(values) for name, values in self._states.items()}
        return Trace(self._grid, states, flows, np.array(self._ambient))
