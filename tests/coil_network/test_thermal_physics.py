"""Thermal candidates against closed forms, SciPy and the conservation of energy; none makes heat from nothing."""

import itertools

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from diagnosis.candidates.registry import catalogue
from diagnosis.models.coil_network.kernel.inputs import Drive, Programme, grid
from diagnosis.models.coil_network.kernel.layout import COIL_FIELDS, CoilNetworkLayout
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from tests.coil_network.rigs import ROOM, full_network, heater

HEATER = CoilNetworkLayout(1)
C, G = COIL_FIELDS["capacity"][0], COIL_FIELDS["conductance"][0]
PLAIN = CoilNetworkParameters({"use_regressed_cooling_rate": 0.0})
POWER = 0.4


def temperatures(parameters, inputs, layout=HEATER, times=None):
    times = inputs.time if times is None else times
    return full_network(layout).simulate(parameters, inputs, {"temperature": times})["temperature"]


@pytest.mark.parametrize("step", [0.5, 0.004])  # on either side of where the series takes over from exp
def test_a_lumped_heater_without_a_circuit_follows_its_exponential(step):
    inputs = heater(POWER, 30.0, step)
    exact = ROOM + POWER / G * (1.0 - np.exp(-G / C * inputs.time))
    assert np.allclose(temperatures(PLAIN, inputs)[:, 0], exact, rtol=1e-12)  # the step is exact; rounding only


def test_radiation_follows_scipy():
    area = 3e-4
    inputs = heater(POWER, 40.0, 0.02)

    def slope(_, y):
        return (POWER - G * (y - ROOM) - area * 5.670374419e-8 * (y**4 - ROOM**4)) / C

    exact = solve_ivp(slope, (0.0, 40.0), [ROOM], t_eval=inputs.time, rtol=1e-11, atol=1e-9).y[0]
    error = np.abs(temperatures(PLAIN.with_term("radiation", emissivity_area=area), inputs)[:, 0] - exact).max()
    assert error < 2e-3  # second order: 0.02 s steps of a 3 s time constant over 40 K leave about 1 mK
    assert np.abs(exact - temperatures(PLAIN, inputs)[:, 0]).max() > 5.0


def test_temperature_dependent_convection_follows_scipy():
    slope_h = 0.01
    inputs = heater(POWER, 40.0, 0.02)

    def slope(_, y):
        return (POWER - G * (1.0 + slope_h * abs(y - ROOM)) * (y - ROOM)) / C

    exact = solve_ivp(slope, (0.0, 40.0), [ROOM], t_eval=inputs.time, rtol=1e-11, atol=1e-9).y[0]
    found = temperatures(PLAIN.with_term("temperature_dependent_convection", slope=slope_h), inputs)[:, 0]
    assert np.abs(found - exact).max() < 5e-3


def two_masses(g, c2, loss, time):
    matrix = np.array([[-(G + g) / C, g / C], [g / c2, -(g + loss) / c2]])
    steady = -np.linalg.solve(matrix, [POWER / C, 0.0])
    return np.array([ROOM + (steady - expm(matrix * t) @ steady)[0] for t in time])


@pytest.mark.parametrize(("term", "loss"), [("second_mass", 0.0), ("lossy_second_mass", 2e-3)])
def test_a_second_mass_follows_the_linear_two_mass_system(term, loss):
    g, c2 = 4e-3, 0.1
    values = {"g": g, "C2": c2} | ({"loss": loss} if loss else {})
    errors = []
    for step in (0.2, 0.1):
        inputs = heater(POWER, 60.0, step)
        exact = two_masses(g, c2, loss, inputs.time)
        errors.append(np.abs(temperatures(PLAIN.with_term(term, **values), inputs)[:, 0] - exact).max())
    assert errors[1] < 0.01  # far below the noise of a thermometer
    assert 3.0 < errors[0] / errors[1] < 5.0  # second order: halving the step quarters the error


@pytest.mark.parametrize("g", [0.05, 0.5])
@pytest.mark.parametrize("c2", [1e-3, 0.1])
@pytest.mark.parametrize(("term", "loss"), [("second_mass", 0.0), ("lossy_second_mass", 0.05)])
def test_a_mass_far_faster_than_the_step_is_still_right(term, loss, g, c2):
    """Time constants down to 2 ms under a step of 0.1 s: a fit that wanders there must not find a ghost."""
    values = {"g": g, "C2": c2} | ({"loss": loss} if loss else {})
    inputs = heater(POWER, 30.0, 0.1)
    exact = two_masses(g, c2, loss, inputs.time)
    found = temperatures(PLAIN.with_term(term, **values), inputs)[:, 0]
    assert np.abs(found - exact).max() < 0.012 * np.ptp(exact)  # of the rise; largest in the first two steps
    assert np.abs(found - exact)[30:].max() < 2e-3 * np.ptp(exact)


@pytest.mark.parametrize("step", [0.1, 1.0])
def test_what_the_coil_gives_to_its_second_mass_is_there_in_the_end(step):
    """Without loss to the room, coil and mass settle at the heat given over both capacities, at any step."""
    power = Programme(np.array([0.0, 10.0]), np.array([[POWER], [0.0]]))
    inputs = Drive(Programme.constant(ROOM), power=power).on_grid(grid(0.0, 900.0, step, [10.0]))
    parameters = PLAIN.with_base(conductance=0.0).with_term("second_mass", g=4e-3, C2=0.1)
    end = temperatures(parameters, inputs, times=np.array([900.0]))[0, 0]
    assert end - ROOM == pytest.approx(POWER * 10.0 / (C + 0.1), rel=1e-10)  # rounding over 9000 steps


def test_a_sheath_follows_the_linear_system_of_core_and_shell():
    g, c2 = 0.02, 0.1
    inputs = heater(POWER, 60.0, 0.05)
    matrix = np.array([[-g / C, g / C], [g / c2, -(g + G) / c2]])
    steady = -np.linalg.solve(matrix, [POWER / C, 0.0])
    exact = np.array([ROOM + (steady - expm(matrix * t) @ steady)[0] for t in inputs.time])
    found = temperatures(PLAIN.with_term("sheath", share=1.0, g=g, C2=c2), inputs)[:, 0]
    assert np.abs(found - exact).max() < 0.01  # second order in the step
    bare = temperatures(PLAIN.with_term("sheath", share=0.5, g=0.5, C2=1e-3), inputs)[:, 0]
    # a layer without capacity or resistance is not there; 2 % of its conductance G / g are left
    assert np.abs(bare - temperatures(PLAIN, inputs)[:, 0]).max() < 0.02 * 46.0


def test_a_shared_mass_follows_the_linear_system_of_all_coils():
    g, mass, loss = 2e-3, 1.0, 0.01
    layout = CoilNetworkLayout(2)
    inputs = heater([POWER, 0.0], 60.0, 0.05, coils=2)
    matrix = np.array(
        [
            [-(G + g) / C, 0.0, g / C],
            [0.0, -(G + g) / C, g / C],
            [g / mass, g / mass, -(2 * g + loss) / mass],
        ]
    )
    steady = -np.linalg.solve(matrix, [POWER / C, 0.0, 0.0])
    exact = np.array([ROOM + (steady - expm(matrix * t) @ steady)[:2] for t in inputs.time])
    found = temperatures(PLAIN.with_term("shared_mass", g=g, C_chassis=mass, loss=loss), inputs, layout)
    assert np.abs(found - exact).max() < 2e-3  # second order in the step
    assert exact[-1, 1] - ROOM > 0.4  # the unpowered coil warms up


def test_neighbours_exchange_heat_without_loss():
    """Without loss to the room, what one coil gives the others have."""
    layout = CoilNetworkLayout(3, neighbours=((0, 1), (1, 2)))
    parameters = PLAIN.with_base(conductance=0.0).with_term("neighbour_heat", g=np.array([1e-3, 3e-3, 2e-3]))
    inputs = heater([POWER, 0.0, 0.1], 20.0, 0.1, coils=3)
    stored = C * (temperatures(parameters, inputs, layout) - ROOM)
    assert np.allclose(stored.sum(axis=1), 0.5 * inputs.time, rtol=1e-11, atol=1e-12)  # rounding only
    assert stored[-1, 1] > 0.3  # joules that came through the contacts


@pytest.mark.parametrize("g", [1e-3, 0.1])
@pytest.mark.parametrize("step", [0.05, 0.4])
def test_neighbours_never_cross_however_strong_their_contact(step, g):
    """Heat flows from hot to cold alone: the order of a row of coils stays, and none leaves the range of the others."""
    layout = CoilNetworkLayout(3, neighbours=((0, 1), (1, 2)))
    inputs = heater([POWER, 0.0, 0.0], 20.0, step, coils=3)
    found = temperatures(PLAIN.with_base(conductance=0.0).with_term("neighbour_heat", g=g), inputs, layout)
    stored = C * (found - ROOM).sum(axis=1)
    assert np.allclose(stored, POWER * inputs.time, rtol=1e-11, atol=1e-12)  # rounding only
    assert np.all(np.diff(found, axis=1) <= 1e-9)


@pytest.mark.parametrize(("g", "error"), [(2e-3, 2e-3), (0.02, 2e-3), (0.1, 4e-3)])  # a step is g dt / C = 0.12 at most
def test_neighbours_follow_the_linear_system(g, error):
    layout = CoilNetworkLayout(2, neighbours=((0, 1),))
    inputs = heater([POWER, 0.0], 40.0, 0.05, coils=2)
    matrix = np.array([[-(G + g), g], [g, -(G + g)]]) / C
    steady = -np.linalg.solve(matrix, [POWER / C, 0.0])
    exact = np.array([ROOM + steady - expm(matrix * t) @ steady for t in inputs.time])
    found = temperatures(PLAIN.with_term("neighbour_heat", g=g), inputs, layout)
    assert np.abs(found - exact).max() < error  # second order in the step


def test_latent_heat_is_the_area_of_the_pause_in_heating_and_comes_back():
    """Without loss to the room all energy is stored, so the temperature tells what the transformation took."""
    latent = 0.8
    parameters = PLAIN.with_base(conductance=0.0).with_term("latent_heat", latent=latent)
    power = Programme(np.array([0.0, 12.0]), np.array([[0.4], [-0.4]]))  # heated, then cooled by a heat sink
    inputs = Drive(Programme.constant(ROOM), power=power).on_grid(grid(0.0, 24.0, 0.05, [12.0]))
    result = full_network(HEATER).simulate(parameters, inputs, dict.fromkeys(("temperature", "stiffness"), inputs.time))
    given = 0.4 * np.minimum(inputs.time, 24.0 - inputs.time)
    missing = given - C * (result["temperature"][:, 0] - ROOM)
    phase = np.clip((result["stiffness"][:, 0] - COIL_FIELDS["heating_d"][0]) / COIL_FIELDS["heating_a"][0], 0.0, 1.0)
    assert phase.max() > 0.9
    # What a step assumed wrongly is settled in the next: the difference stays at that of one step.
    assert np.abs(missing - latent * phase).max() < 2e-3 * latent
    assert abs(missing[-1] - latent * phase[-1]) < 1e-4 * latent


def test_latent_heat_converges_with_the_step():
    parameters = PLAIN.with_term("latent_heat", latent=0.8)
    times = np.arange(0.0, 30.0, 0.8)
    runs = [temperatures(parameters, heater(0.6, 30.0, step), times=times) for step in (0.2, 0.1, 0.0125)]
    errors = [np.abs(run - runs[-1]).max() for run in runs[:-1]]
    assert errors[1] < 0.1  # K; a third of a thermocouple's noise at a step of 0.1 s
    assert errors[0] / errors[1] > 2.0


@pytest.mark.parametrize("name", ["ambient_drift", "ambient_step"])
def test_other_surroundings_move_the_temperature_that_nothing_heats(name):
    values = {"drift": 0.02} if name == "ambient_drift" else {"step_size": 3.0, "instant": 10.0}
    inputs = heater(0.0, 60.0, 0.05)
    found = temperatures(PLAIN.with_term(name, **values), inputs)[:, 0] - ROOM
    rate = G / C
    if name == "ambient_drift":
        exact = 0.02 * (inputs.time - (1.0 - np.exp(-rate * inputs.time)) / rate)
    else:
        exact = np.where(inputs.time > 10.0, 3.0 * (1.0 - np.exp(-rate * (inputs.time - 10.0))), 0.0)
    assert np.abs(found - exact).max() < 1e-4  # second order: the drift is taken at the middle of each step


PASSIVE = [t for t in catalogue() if t.unit == "thermal" and t.is_named and not t.identifier.startswith("ambient")]


@pytest.mark.parametrize("step", [0.1, 0.4])
@pytest.mark.parametrize("term", [pytest.param(t, id=t.identifier) for t in PASSIVE])
def test_no_candidate_within_its_bounds_makes_heat_from_nothing(term, step):
    """Hot coils in a cooler room, no power: none gets hotter than the hottest was or colder than the room.

    Every corner of the bounds and every start value, also where they make time constants far below the step.
    """
    layout = CoilNetworkLayout(4, (2, 2))
    start = ROOM + np.array([60.0, 30.0, 5.0, 0.0])
    inputs = Drive(Programme.constant(ROOM), Programme.constant(0.0)).on_grid(grid(0.0, 40.0, step))
    for corner in itertools.product(*({p.lower, p.upper, *p.starts} for p in term.parameters)):
        values = {p.name: 5.0 if p.is_instant else v for p, v in zip(term.parameters, corner)}
        parameters = CoilNetworkParameters({"initial_temperature": start}, {term.identifier: values})
        found = temperatures(parameters, inputs, layout)
        assert np.isfinite(found).all()
        # 0.02 K, far below any thermometer's noise: the step is split between coil and candidate
        assert found.max() <= start.max() + 0.02, values
        assert found.min() >= ROOM - 0.02, values
