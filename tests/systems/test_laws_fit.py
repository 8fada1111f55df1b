"""Every law of the library is tried somewhere: one that does not fit its role would be left out silently."""

from __future__ import annotations

from pathlib import Path

import pytest

from cosim.scenario import parse_scenario
from cosim.unit.protocol import Array
from diagnosis.laws.law import Law
from diagnosis.laws.library import library
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.places import Fit, fits, places_of
from diagnosis.models.systems.quantities import Places
from evaluation.fmus.model import OdeModel

#: Two masses, an unbalanced wheel with a load on its bearing, two lumps, two tanks, a coil, a capacitor.
RIG = OdeModel(
    "rig",
    {
        "m": (2.0, "kg"),
        "k": (50.0, "1/s^2"),
        "d": (0.3, "1/s"),
        "J": (0.2, "kg*m^2"),
        "C_T": (30.0, "J/K"),
        "g": (0.1, "1/s"),
        "room": (293.15, "K"),
        "A": (0.5, "m^2"),
        "c": (0.1, "m^2/s"),
        "L": (0.5, "H"),
        "R": (4.0, "ohm"),
        "C": (2e-3, "F"),
    },
    {"force": "N", "torque": "N*m", "load": "N", "heat": "W", "inflow": "m^3/s", "voltage": "V", "current": "A"},
    {
        "x": ("m", "0.01", "v"),
        "v": ("m/s", "0.0", "force/m - k*(x - y) - d*v"),
        "y": ("m", "0.02", "w"),
        "w": ("m/s", "0.0", "-k*(y - x) - d*w"),
        "a": ("rad", "0.1", "turning"),
        "turning": ("rad/s", "0.0", "torque/J - d*turning + 0.0*load"),
        "T": ("K", "300.0", "heat/C_T - g*(T - S) - g*(T - room)"),
        "S": ("K", "299.0", "g*(T - S) - g*(S - room)"),
        "h": ("m", "0.4", "(inflow - c*h - c*(h - j))/A"),
        "j": ("m", "0.3", "(c*(h - j) - c*j)/A"),
        "i": ("A", "0.1", "(voltage - R*i)/L"),
        "q": ("V", "0.2", "(current - q/R)/C"),
    },
    {
        "place": ("m", "x"),
        "speed": ("m/s", "v"),
        "angle": ("rad", "a"),
        "rate": ("rad/s", "turning"),
        "warm": ("K", "T"),
        "level": ("m", "h"),
        "amps": ("A", "i"),
        "volts": ("V", "q"),
        "power": ("W", "R*i*i"),
    },
)
#: A law that is tried, the quantities of its FMU, and what these are simulated as.
Fitted = tuple[Fit, Places, dict[str, Array]]
#: Inputs with values that they take one after the other.
INPUTS = {
    "force": ("N", 1.0, -2.0),
    "torque": ("N*m", 0.1, 0.0),
    "load": ("N", 3.0, 5.0),
    "heat": ("W", 3.0, 0.0),
    "inflow": ("m^3/s", 0.02, 0.0),
    "voltage": ("V", 2.0, 0.0),
    "current": ("A", 1.0, 0.0),
}


def _fitted(folder: Path, integrator: str) -> list[Fitted]:
    """Laws that are tried, with the quantities and what they are simulated as."""
    outputs = ", ".join(
        f"{name}: {{unit: {unit}, points: [[0 s, {first} {unit}], [4 s, {then} {unit}]]}}"
        for name, (unit, first, then) in INPUTS.items()
    )
    outputs += ", beside: {unit: m, points: [[0 s, 0 m], [3 s, 2 m]]}"  # what nothing connects to the rig
    wires = ", ".join(f"drive.{name} -> rig.{name}" for name in INPUTS)
    text = (
        "title: Everything\ntime: {stop: 10 s, macro_step: 10 ms, output_step: 20 ms}\n"
        f"components:\n  drive: {{kind: programme, outputs: {{{outputs}}}}}\n"
        f"  rig: {{kind: fmu, fmu: rig.fmu, integrator: {integrator}}}\nconnections: [{wires}]\n"
    )
    system = FastSystem(parse_scenario(text, folder / "scenario.yaml"))
    try:
        (own,) = places = places_of([system])
        rows = system.simulate()
        assert rows is not None
        taken = {name.removeprefix("state "): rows.values[:, s] for (_, name), s in system.recorded.items()}
        taken["drive_beside"] = taken["beside"]
        return [(fit, own, taken) for fit in fits(places, library(), 0.02)]
    finally:
        system.close()


@pytest.fixture(scope="module")
def every(tmp_path_factory: pytest.TempPathFactory) -> list[Fitted]:
    """Where the FMU shows its states, and where it hides them."""
    folder = tmp_path_factory.mktemp("rig")
    RIG.build(folder)
    return _fitted(folder, "cvode") + _fitted(folder, "internal")


@pytest.fixture(scope="module")
def tried(every: list[Fitted]) -> set[str]:
    """Laws that are tried."""
    return {fit.law.identifier for fit, _, _ in every}


@pytest.mark.parametrize("law", library(), ids=lambda law: law.identifier)
def test_every_law_is_tried_somewhere(tried: set[str], law: Law) -> None:
    assert law.identifier in tried


def test_a_search_begins_at_values_that_a_quantity_takes(every: list[Fitted]) -> None:
    """A knot, a stop or a phase change where the quantity never is would change nothing, and no fit leaves it."""
    asked = 0
    for fit, own, taken in every:
        meant = {
            name: values
            for name, values in taken.items()
            if name in {*own.states, *own.outputs} and name in fit.term.law and values.shape[1] == 1
        }
        for parameter in fit.term.parameters:
            if not parameter.is_reading or len(meant) != 1:
                continue
            (values,) = meant.values()
            assert values.min() < min(parameter.starts) < max(parameter.starts) < values.max(), fit.term
            assert parameter.lower <= values.min()
            assert values.max() <= parameter.upper
            asked += 1
    assert asked > 20


def test_what_a_law_is_confused_with_is_a_law() -> None:
    known = {law.identifier for law in library()}
    others = [(law.identifier, other) for law in library() for other in law.confused_with]
    wrong = [(law, other) for law, other in others if other not in known and " " not in other]  # words: no law at all
    assert not wrong
