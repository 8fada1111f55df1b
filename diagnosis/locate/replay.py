"""Each unit driven alone with the recorded inputs: residuals, what the sensors of the inputs add to their noise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache, partial

import numpy as np

from cosim.unit.protocol import Array
from diagnosis.locate.course import Course
from diagnosis.locate.fitted import Fitted
from diagnosis.locate.panel import Noise, Panel
from diagnosis.locate.response import heat_response, instant_response, interpolation, spread
from diagnosis.locate.smooth import cosines, levels
from diagnosis.models.coil_network.kernel.places import coil_label
from diagnosis.search.problem import Parameter

#: Parameters of the heat balance: nothing else depends on them once temperatures are given.
THERMAL = frozenset({"conductance", "capacity", "cooling_rate", "ambient_offset", "initial_temperature", "power_gain"})
ELECTRICAL = frozenset({"reference_resistance", "resistance_temperature_coefficient"})
#: Share of its largest value from which on a current flows.
FLOWS = 0.02


@dataclass(frozen=True)
class Replay:
    """A unit driven alone.

    Args:
        unit: electrical, thermal, stiffness or mechanical.
        equation: In words, with its formula.
        input_unit: Unit of an unknown input at this equation.
        driven_by: What it was driven with, in words.
        panels: Its residuals.
    """

    unit: str
    equation: str
    input_unit: str
    driven_by: str
    panels: tuple[Panel, ...]


def field_of(parameter: Parameter) -> str:
    """Name of the network's parameter behind a parameter of the fit."""
    return parameter.name.split(" of ")[0].rpartition(".")[2]


def electrical(model: Fitted, courses: Sequence[Course], found: Sequence[Panel]) -> list[Replay]:
    """Circuit driven by its programme, with the resistances at the recorded temperatures.

    Args:
        model: Recalibrated.
        courses: Of every recording.
        found: Panels of all quantities, of the closed simulation.
    """
    chosen = [p for p in found if p.quantity in ("current", "supply_current", "resistance", "power")]
    if not chosen or not model.coils.strings:
        return []
    slope = np.any(np.asarray(model.values(0).base.get("resistance_temperature_coefficient", 0.0)))
    by = "the supply's programme" + ("; resistances at simulated temperatures" if slope else "")
    keep = np.ones(chosen[0].columns.shape[2], dtype=bool)
    keep[: len(model.parameters)] = [field_of(p) not in THERMAL or bool(slope) for p in model.parameters]
    panels = []
    for panel in chosen:
        gain = partial(_current_response, model, courses[panel.recording], panel)
        respond = gain if panel.quantity in ("current", "supply_current") else None
        panels.append(replace(panel, columns=panel.columns * keep, respond=respond))
    return [Replay("electrical", "Ohm's law of a string: V + u = I * sum(R)", "V", by, tuple(panels))]


def _current_response(model: Fitted, course: Course, panel: Panel, element: int) -> Array:
    """Current per extra voltage; of the supply's current where all strings have it."""
    conductance = 1.0 / course.string_resistance
    gain = conductance.sum() if panel.quantity == "supply_current" else conductance[element]
    return instant_response(np.full(len(course.size), gain), course, panel.times)


def thermal(
    model: Fitted, courses: Sequence[Course], found: Sequence[Panel], shares: Array | None = None
) -> list[Replay]:
    """Coils heated by the power of the recorded currents, I^2 R.

    Args:
        model: Recalibrated.
        courses: Of every recording.
        found: Panels of all quantities, of the closed simulation.
        shares: Where a string takes more power V I than its coils' I^2 R, each coil's share of the difference, shape
            (coils,); None: it is turned into heat outside the coils.
    """
    chosen = [p for p in found if p.quantity == "temperature"]
    if not chosen:
        return []
    by: list[str] = []
    panels = []
    for panel in chosen:
        course = courses[panel.recording]
        current = [p for p in found if p.recording == panel.recording and p.quantity == "current"]
        supply = [p for p in found if p.recording == panel.recording and p.quantity == "supply_current"]
        panel = replace(panel, respond=cache(partial(_heat_response, course, panel.times)))
        if current:
            panels.append(_heated_by(model, course, (panel, current[0]), shares))
            by.append("recorded currents of the strings")
        elif supply and len(model.coils.strings) == 1:
            panels.append(_heated_by(model, course, (panel, supply[0]), shares))
            by.append("recorded current of the supply")
        else:
            panels.append(panel)
            by.append("simulated currents" if model.coils.strings else "the programme's power")
    return [
        Replay(
            "thermal",
            "heat balance of a coil: C * dT/dt = P - hA * (T - T_ambient) + u",
            "W",
            ", ".join(dict.fromkeys(by)),
            tuple(panels),
        )
    ]


def _heat_response(course: Course, times: Array, coil: int) -> Array:
    return heat_response(course, coil, times)


def _heated_by(model: Fitted, course: Course, seen_by: tuple[Panel, Panel], shares: Array | None) -> Panel:
    """Temperatures with the recorded instead of the simulated currents; `seen_by`: temperatures and currents."""
    panel, current = seen_by
    answer = panel.respond
    assert answer is not None
    change = np.zeros_like(panel.residual)
    columns = panel.columns.copy()
    noise: dict[int, list[tuple[int, Array]]] = {}
    own = {n: (field_of(p), p) for n, p in enumerate(model.parameters)}
    for n, (field, _) in own.items():
        if field in ELECTRICAL:
            columns[:, :, n] = 0.0
    for k, coil in enumerate(panel.elements):
        string = int(model.coils.string_of_coil[coil])
        at = current.place(string if current.quantity == "current" else 0)
        respond = answer(int(coil))
        squared = course.current[:, coil] ** 2
        if at is not None:
            seen = current.used[:, at]
            if seen.sum() < 2:
                continue
            simulated = interpolation(current.times[seen], course) @ course.current[:, coil]
            weights = _joined(current.times[seen], simulated, course, int(coil))
            deviation = current.deviation[seen, at]
            departure = weights @ (current.residual[seen, at] * deviation)
            resistance = course.resistance[coil]
            extra = resistance * (2.0 * course.current[:, coil] * departure + departure**2)
            # A string of too large a resistance takes V I, of which V I - I^2 sum(R) = -I R_string (I - I_simulated).
            share = 0.0 if shares is None else float(shares[coil]) * course.string_resistance[string]
            extra = extra - share * (course.current[:, coil] + departure) * departure
            squared = (course.current[:, coil] + departure) ** 2
            change[:, k] = respond @ extra
            factor = (respond * ((2.0 * resistance - share) * course.current[:, coil])) @ weights * deviation
            noise.setdefault(string if current.quantity == "current" else 0, []).append(
                (k, np.where(panel.used[:, k], 1.0 / panel.deviation[:, k], 0.0)[:, None] * factor)
            )
        by_resistance = respond @ (squared * course.resistance[coil]) / panel.deviation[:, k]
        for n, (field, parameter) in own.items():
            if field == "reference_resistance" and is_at(model, parameter, int(coil)):
                columns[:, k, n] = -by_resistance * parameter.deviation * model.fit.widths[n]
    columns *= panel.used[:, :, None]
    carried = tuple(
        Noise(("current", panel.recording, s), np.array([k for k, _ in own]), np.stack([f for _, f in own], axis=1))
        for s, own in noise.items()
    )
    return replace(panel.less(change), columns=columns, noise=(*panel.noise, *carried))


def _joined(times: Array, simulated: Array, course: Course, coil: int) -> Array:
    """Weights with which departures of a current at samples stand for those in steps, shape (steps, samples).

    While a current flows its departure is joined as a share of it, else as it is: so none is smeared over a jump.
    """
    flowing = course.current[:, coil]
    least = FLOWS * float(np.abs(flowing).max(initial=0.0))
    weights = np.zeros((len(flowing), len(times)))
    for is_on in (True, False):
        samples, steps = (np.abs(simulated) > least) == is_on, (np.abs(flowing) > least) == is_on
        if not samples.any() or not steps.any():
            continue
        scale = flowing[steps, None] / simulated[samples] if is_on else 1.0
        weights[np.ix_(steps, samples)] = spread(times[samples], course)[steps] * scale
    return weights


def is_at(model: Fitted, parameter: Parameter, coil: int) -> bool:
    """Whether a parameter is one of this coil, or of all."""
    label, _, _ = parameter.name.rpartition(".")
    return not label or label == coil_label(model.coils, coil)


def mechanical(model: Fitted, courses: Sequence[Course], found: Sequence[Panel]) -> list[Replay]:
    """Stiffness, and extension under the load, of coils that are as warm as was recorded.

    Where the stiffness is not recorded, the extension shows stiffness and load together, and the unit says so.
    """
    stiffness = [_at_recorded_temperature(model, courses, p, found) for p in found if p.quantity == "stiffness"]
    length = [
        _at_recorded_temperature(model, courses, p, found) for p in found if p.quantity in ("extension", "length")
    ]
    is_warm = any(p.quantity == "temperature" for p in found)
    by = "recorded temperatures, smoothed" if is_warm else "simulated temperatures"
    replays = []
    if stiffness:
        law = "stiffness of a coil: k = k(T, history) + u"
        replays.append(Replay("stiffness", law, "N/m", by, tuple(stiffness)))
    if length:
        law = "extension under the load: k(T, history) * x = load + u"
        unit = "mechanical" if stiffness else "stiffness or mechanical"
        replays.append(Replay(unit, law, "N", by, tuple(length)))
    return replays


def _at_recorded_temperature(model: Fitted, courses: Sequence[Course], panel: Panel, found: Sequence[Panel]) -> Panel:
    course = courses[panel.recording]
    panel = _with_uncertain_temperature(model, replace(panel, respond=partial(_load_response, course, panel)))
    warm = next((p for p in found if p.recording == panel.recording and p.quantity == "temperature"), None)
    if warm is None:
        return panel
    begin, end = course.time[0], course.time[-1]
    basis, size = cosines(warm.times, begin, end)
    groups = _groups(model, warm)
    weight = np.where(warm.used, 1.0 / warm.deviation**2, 0.0)
    found_courses = levels(warm.residual * warm.deviation, weight, basis, size, groups)
    on_grid = cosines(model.network.runs[panel.recording].inputs.time, begin, end)[0]
    departure = np.zeros((len(on_grid), model.coils.coils))
    for members, smoothed in zip(groups, found_courses):
        departure[:, warm.elements[members]] += (on_grid @ smoothed.mean)[:, None]
    change, slope = _stiffness_change(model, panel, departure)
    at_samples = cosines(panel.times, begin, end)[0]
    noise = []
    for number, (members, smoothed) in enumerate(zip(groups, found_courses)):
        factor = at_samples @ smoothed.factor
        own = np.flatnonzero(np.isin(panel.elements, warm.elements[members]))
        if own.size:
            gain = np.where(panel.used, slope / panel.deviation, 0.0)[:, own]
            noise.append(Noise(("temperature", panel.recording, number), own, gain[:, :, None] * factor[:, None, :]))
    return replace(panel.less(change), noise=(*panel.noise, *noise))


def _groups(model: Fitted, panel: Panel) -> list[Array]:
    """Numbers of the channels of all coils, of each string, and of each coil alone."""
    count = len(panel.elements)
    groups = [np.arange(count)] if count > 1 else []
    strings = model.coils.string_of_coil[panel.elements]
    if len(set(strings.tolist())) > 1:
        groups += [np.flatnonzero(strings == s) for s in sorted(set(strings.tolist())) if np.sum(strings == s) > 1]
    return groups + [np.array([n]) for n in range(count)]


def _with_uncertain_temperature(model: Fitted, panel: Panel) -> Panel:
    """The thermal parameters are not the unit's own: what is unknown of them comes in as noise of the temperature."""
    others = np.array([n for n, p in enumerate(model.parameters) if field_of(p) in THERMAL | ELECTRICAL], dtype=int)
    covariance = model.fit.covariance[: len(model.parameters), : len(model.parameters)][np.ix_(others, others)]
    values, vectors = np.linalg.eigh(covariance)
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    columns = panel.columns.copy()
    columns[:, :, others] = (columns[:, :, others] / model.fit.widths[others]) @ root
    return replace(panel, columns=columns)


def _stiffness_change(model: Fitted, panel: Panel, departure: Array) -> tuple[Array, Array]:
    """What recorded temperatures change at the samples, and the slope by the temperature, (samples, elements) each."""
    run = model.network.runs[panel.recording]
    parameters = model.values(panel.recording)
    closed = model.network.network.simulate(parameters, run.inputs, {"temperature": run.inputs.time})["temperature"]
    step = 0.2  # K: small beside the width of the transformation (some 10 K), large beside rounding
    values = []
    for shift in (0.0, step, -step, None):
        given = closed if shift is None else closed + departure + shift
        inputs = replace(run.inputs, temperature=np.ascontiguousarray(given))
        values.append(
            model.network.network.simulate(parameters, inputs, {panel.quantity: panel.times})[panel.quantity][
                :, panel.elements
            ]
        )
    return values[0] - values[3], (values[1] - values[2]) / (2.0 * step)


def _load_response(course: Course, panel: Panel, coil: int) -> Array:
    """Stiffness per stiffness, or extension per extra force."""
    if panel.quantity == "stiffness":
        return interpolation(panel.times, course)
    return instant_response(1.0 / course.stiffness[:, coil], course, panel.times)
