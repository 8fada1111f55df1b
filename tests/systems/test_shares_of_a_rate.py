"""Terms that are a share of the derivative as an FMU has it: capacities and inertias that change."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cosim.run import run
from cosim.scenario import load_scenario, parse_scenario
from cosim.unit.errors import InputError
from cosim.unit.protocol import Array
from diagnosis.judge.diagnosis import Diagnosis, Verdict
from diagnosis.laws.library import library
from diagnosis.models.systems.fast import FastSystem
from diagnosis.models.systems.places import Fit, fits, places_of
from diagnosis.recording.recording import load_recording
from evaluation.fmus.model import OdeModel
from tests.systems.rigs import LUMP, ROOM, built, diagnosed, held, write_recording

STEP, COUNT = 2.0, 600
LATENT, MELTING, WIDTH = 4.0, 318.0, 2.5
SCENARIO = """
title: A lump
time: {stop: 1200 s, macro_step: 2 s, output_step: 2 s}
components:
  drive: {kind: programme, outputs: {power: {unit: W, constant: 12 W}}}
  room: {kind: programme, outputs: {temperature: {unit: degC, constant: 21 degC}}}
  lump:
    kind: fmu
    fmu: lump.fmu
    integrator: cvode
    ADDED
connections: [drive.power -> lump.power, room.temperature -> lump.room]
"""
CONSTANT = "added_terms: [{to: der(T), formula: share, is_share: true, parameters: {share: 0.5}}]"
BOTH = """added_terms:
      - {to: der(T), formula: heat, parameters: {heat: 0.01 K/s}}
      - {to: der(T), formula: share, is_share: true, parameters: {share: 0.5}}
"""


def _scenario(folder: Path, added: str) -> Path:
    return built(LUMP, SCENARIO.replace("ADDED", added), folder)


@pytest.mark.parametrize(("added", "share", "heat"), [(CONSTANT, 0.5, 0.0), (BOTH, 0.5, 0.01)])
def test_a_share_of_a_half_makes_a_lump_faster_by_that_and_what_is_added_is_no_part_of_it(
    tmp_path: Path, added: str, share: float, heat: float
) -> None:
    """T' = 1.5 (P - k (T - T_a))/C + q is a first-order response in closed form; both simulators give it."""
    path = _scenario(tmp_path, added)
    rate = (1.0 + share) * 0.4 / 50.0
    final = ROOM + 12.0 / 0.4 + heat / rate
    times = np.arange(0.0, 1201.0, 2.0)
    expected = final + (300.0 - final) * np.exp(-rate * times)
    results = run(load_scenario(str(path)))
    np.testing.assert_allclose(results["lump.temperature"].to_numpy(), expected, atol=1e-3)
    system = FastSystem(load_scenario(str(path)))
    rows = system.simulate()
    assert rows is not None
    np.testing.assert_allclose(rows.values[:, system.recorded["lump", "temperature"]].ravel(), expected, atol=1e-3)
    system.close()


def test_a_share_of_what_is_no_derivative_is_refused(tmp_path: Path) -> None:
    path = _scenario(tmp_path, CONSTANT.replace("der(T)", "power"))
    with pytest.raises(InputError, match=r"added_terms\[0\].is_share.*`power` is no derivative"):
        run(load_scenario(str(path)))


def test_a_share_with_a_unit_is_refused(tmp_path: Path) -> None:
    path = _scenario(tmp_path, CONSTANT.replace("share: 0.5", "share: 0.5 K/s"))
    with pytest.raises(InputError, match=r"added_terms\[0\].formula"):
        run(load_scenario(str(path)))


def _fits(folder: Path, text: str) -> dict[tuple[str, str], Fit]:
    system = FastSystem(parse_scenario(text, folder / "scenario.yaml"))
    try:
        return {(f.term.identifier, f.placed.to): f for f in fits(places_of([system]), library(), STEP)}
    finally:
        system.close()


def test_a_temperature_may_have_latent_heat_and_takes_no_energy_from_nowhere(tmp_path: Path) -> None:
    _scenario(tmp_path, "")
    found = _fits(tmp_path, SCENARIO.replace("    ADDED\n", ""))
    law = found["latent_heat", "der(T)"]
    assert law.placed.is_share
    assert [p.unit for p in law.term.parameters] == ["1", "K", "K"]
    assert law.term.parameters[0].lower == 0.0
    assert [p.is_reading for p in law.term.parameters] == [False, True, False]  # 48 degC, and a width of 2 K
    assert law.term.law.startswith("der(T) *= 1 + ")
    assert found["rate_scaled", "der(T)"].placed.is_share


def test_where_an_output_reads_the_derivative_no_share_of_it_is_tried(tmp_path: Path) -> None:
    model = OdeModel(
        "cart",
        {"m": (2.0, "kg"), "c": (1.0, "N*s/m")},
        {"force": "N"},
        {"x": ("m", "0", "v"), "v": ("m/s", "0", "(force - c*v)/m")},
        {"acceleration": ("m/s^2", "(force - c*v)/m")},
    )
    model.build(tmp_path)
    text = """
title: A cart
time: {stop: 20 s, macro_step: 0.1 s, output_step: 0.1 s}
components:
  drive: {kind: programme, outputs: {force: {unit: N, points: [[0 s, 1 N], [9 s, -1 N]]}}}
  cart: {kind: fmu, fmu: cart.fmu, integrator: cvode}
connections: [drive.force -> cart.force]
"""
    assert not [f for f in _fits(tmp_path, text).values() if f.placed.is_share and f.placed.to.startswith("der(")]


def _wax(folder: Path, latent: float) -> Diagnosis:
    """Three runs of a lump of wax whose numbers are 2 % off, noise 0.1 K."""
    LUMP.build(folder)
    (folder / "scenario.yaml").write_text(SCENARIO.replace("    ADDED\n", ""), encoding="utf-8")
    every = []
    for number in range(3):
        rng = np.random.default_rng(number)
        power = np.repeat(rng.uniform(0.0, 26.0, 12), 50)

        def rate(x: Array, watt: float) -> Array:
            capacity = 49.0 * (1.0 + latent * np.exp(-(((x[0] - MELTING) / WIDTH) ** 2)))
            return np.array([(watt - 0.41 * (x[0] - ROOM)) / capacity])

        states = held(rate, np.array([300.0]), power, STEP)
        columns = {"t": STEP * np.arange(COUNT), "P": power, "T": states[:, 0] + 0.1 * rng.standard_normal(COUNT)}
        inputs, channels = {"drive.power": ("P", "W")}, {"lump.temperature": ("T", "K", "0.1 K")}
        every.append(load_recording(write_recording(folder / f"run_{number + 1}", columns, inputs, channels)))
    return diagnosed(folder / "scenario.yaml", every)


def test_latent_heat_is_named_with_its_temperature(tmp_path: Path) -> None:
    found = _wax(tmp_path, LATENT)
    assert found.verdict is Verdict.MISSING_PHYSICS
    (finding,) = [f for f in found.findings if f.is_accepted]
    assert (finding.effect, finding.place) == ("latent_heat", "lump.T")
    latent, melting, width = finding.parameters
    assert latent.lower < LATENT < latent.upper
    assert melting.value == pytest.approx(MELTING, abs=0.2)
    assert width.value == pytest.approx(WIDTH, rel=0.1)


def test_a_lump_without_a_phase_change_has_none(tmp_path: Path) -> None:
    assert not [f for f in _wax(tmp_path, 0.0).findings if f.is_accepted]
