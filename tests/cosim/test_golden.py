"""Short runs of every shipped scenario against stored traces.

`pytest tests/cosim/test_golden.py --update-golden` rewrites them; the changelog says why.
"""

import pytest

from cosim.run import run
from cosim.scenario import load_scenario, shipped_scenarios

from . import golden
from .golden import Tolerance
from .short_runs import changed, quantity, shortened, with_parameters, without_fabric

SMOOTH = Tolerance(0.0, 1e-9, "closed-form steps, linear circuit: only last digits of exp and LU differ between CPUs")


def spread(absolute):
    """Fabrics are chaotic: friction changed by 1e-12 moves these runs by about a third of the tolerance."""
    return Tolerance(absolute, 0.0, "three times the spread of runs whose friction differs by 1e-12")


def every(step, start, stop):
    """Times from start to stop."""
    return [round(start + i * step, 9) for i in range(round((stop - start) / step) + 1)]


COILS = dict.fromkeys(("actuator.temperature", "actuator.stiffness", "actuator.resistance", "circuit.power"), SMOOTH)
SUPPLY = dict.fromkeys(("circuit.supply_current", "circuit.string_current", "circuit.supply_power"), SMOOTH)


def selected(dataset, selection, times, coils=None):
    """Series of the first and last coil where all carry the same, else of all."""
    if coils is not None:
        dataset = dataset.isel(coil=coils)
    return golden.series(dataset, selection, times)


ELECTRICAL = {
    # trace: scenario, selection, times, coils
    "single_coil_heating": (load_scenario, COILS | SUPPLY, every(8.0, 0.0, 80.0), None),
    "water_bath": (
        load_scenario,
        dict.fromkeys(("actuator.temperature", "actuator.stiffness", "load.length", "load.tension"), SMOOTH),
        every(60.0, 50.0, 2450.0),
        None,
    ),
    "hanging_coils": (load_scenario, COILS | SUPPLY | {"load.length": SMOOTH}, every(3.0, 0.0, 45.0), [0, 5]),
    "prototype_cantilever": (without_fabric, COILS | SUPPLY, every(2.0, -4.0, 32.0), [0, 35]),
    "prototype_cantilever_instant": (without_fabric, COILS | SUPPLY, every(2.0, -4.0, 32.0), [0, 35]),
    "hanging_contraction": (without_fabric, COILS | SUPPLY, every(3.0, -3.0, 36.0), [0, 35]),
    "spatial_control": (without_fabric, COILS | SUPPLY, every(1.0, -1.0, 10.0), [0, 29, 30, 39, 40, 59]),
}

LUMPS = {
    # trace: selection, times
    "closed_loop_coil": (
        dict.fromkeys(
            ("actuator.temperature", "actuator.stiffness"),
            Tolerance(0.0, 1e-3, "a reading that rounds the other way moves the loop a little"),
        ),
        every(2.0, 0.0, 30.0),
    ),
    "tclab": ({"heaters.temperature": SMOOTH, "heaters.convected_energy": SMOOTH}, every(60.0, 0.0, 600.0)),
    "sma_limb": ({"wire.temperature": SMOOTH, "wire.convected_energy": SMOOTH}, every(8.0, 0.0, 208.0)),
    # A swing without friction is regular: Bullet's single precision aside, nothing amplifies a difference.
    "pendulum": (
        dict.fromkeys(("arm.angle", "arm.angular_velocity"), Tolerance(1e-6, 0.0, "rounding over 10 s")),
        every(1.0, 0.0, 10.0),
    ),
}

FABRIC = {
    # trace: stop, times, tolerance of curvature [1/m], length [m], row centres [m], link lengths [m], energy [J]
    "passive_drape": ("0.2 s", every(0.04, 0.0, 0.2), (4.0, 2e-3, 5e-3, 1.3e-3, 2.5e-3)),
    "prototype_cantilever": ("-3.8 s", every(0.04, -4.0, -3.8), (1.6, 6e-4, 1e-3, 3e-4, 3e-4)),
    "hanging_contraction": ("-2.8 s", every(0.04, -3.0, -2.8), (1e-4, 1e-8, 1e-7, 1e-8, 1e-8)),
    "spatial_control": ("-0.9 s", every(0.02, -1.0, -0.9), (0.3, 3e-4, 4e-4, 1e-4, 1e-4)),
}
#: Too large for a test: `make nightly`.
NIGHTLY = {"large_row_by_row"}
SHAPE = ("max_curvature", "fabric_length", "row_centre", "link_length", "potential_energy")


def fabric_run(name):
    stop, times, tolerances = FABRIC[name]
    selection = {f"fabric.{n}": spread(t) for n, t in zip(SHAPE, tolerances, strict=True)}
    return shortened(name, stop, checkpoint_step="0.1 s"), selection, times


def compare(name, found, selection, update):
    if update:
        golden.store(name, found)
    assert golden.path(name).is_file(), f"no golden trace {name}: make it with --update-golden"
    assert golden.differences(found, golden.load(name), selection) == []


@pytest.mark.parametrize("name", ELECTRICAL)
def test_currents_and_temperatures_are_those_stored(name, request):
    make, selection, times, coils = ELECTRICAL[name]
    found = selected(run(make(name)), selection, times, coils)
    compare(name, found, selection, request.config.getoption("--update-golden"))


@pytest.mark.parametrize("name", LUMPS)
def test_lumps_and_swings_are_those_stored(name, request):
    selection, times = LUMPS[name]
    found = golden.series(run(load_scenario(name)), selection, times)
    compare(name, found, selection, request.config.getoption("--update-golden"))


@pytest.mark.parametrize("name", FABRIC)
def test_the_first_moments_of_a_fabric_are_those_stored(name, request):
    scenario, selection, times = fabric_run(name)
    found = golden.series(run(scenario), selection, times)
    compare(f"{name}_fabric", found, selection, request.config.getoption("--update-golden"))


def test_every_shipped_scenario_has_a_golden_trace():
    # Until power comes the instant variant is the cantilever: its fabric adds nothing.
    assert {*ELECTRICAL, *LUMPS, *FABRIC} == set(shipped_scenarios()) - NIGHTLY


@pytest.mark.parametrize(
    ("parameter", "value"),
    [
        ("volume", "7.33 mm^3"),
        ("heating_c", "0.167 1/K"),
        ("reference_resistance", "2.2001 ohm"),
        ("use_regressed_cooling_rate", False),
    ],
)
def test_a_slightly_wrong_coil_leaves_the_tolerance(parameter, value):
    _, selection, times, _ = ELECTRICAL["single_coil_heating"]
    wrong = run(with_parameters(load_scenario("single_coil_heating"), "actuator", **{parameter: value}))
    assert golden.differences(selected(wrong, selection, times), golden.load("single_coil_heating"), selection)


@pytest.mark.parametrize(
    ("parameter", "value"), [("link_mass", "8 g"), ("tolerance", "1.2 mm"), ("length_cold", "3.35 cm")]
)
def test_a_wrong_fabric_leaves_the_tolerance(parameter, value):
    scenario, selection, times = fabric_run("hanging_contraction")
    wrong = golden.series(run(with_parameters(scenario, "fabric", **{parameter: value})), selection, times)
    assert golden.differences(wrong, golden.load("hanging_contraction_fabric"), selection)


def test_gravity_the_wrong_way_round_leaves_the_tolerance():
    scenario, selection, times = fabric_run("passive_drape")
    up = with_parameters(scenario, "fabric", gravity=[quantity(f"{g} m/s^2") for g in (0, 0, 9.81)])
    solver = up.components["fabric"].solver.model_copy(update={"penetration_limit": quantity("10 m")})
    up = changed(up, "fabric", solver=solver)
    wrong = golden.series(run(up), selection, times)
    assert golden.differences(wrong, golden.load("passive_drape_fabric"), selection)


def test_one_wrong_value_is_named_with_its_time():
    stored = golden.load("single_coil_heating")
    _, selection, _, _ = ELECTRICAL["single_coil_heating"]
    assert golden.differences(stored, stored, selection) == []
    wrong = {**stored, "actuator.temperature": [list(row) for row in stored["actuator.temperature"]]}
    wrong["actuator.temperature"][3][5] *= 1.0 + 1e-8
    (line,) = golden.differences(wrong, stored, selection)
    assert line.startswith("actuator.temperature at t = 24.0 s: off by ")
    wrong["actuator.temperature"][3][5] = float("nan")
    (line,) = golden.differences(wrong, stored, selection)
    assert "t = 24.0 s" in line


def test_cvode_and_fmi_2_reproduce_the_golden_trace_of_the_prototype():
    _, selection, times, coils = ELECTRICAL["prototype_cantilever"]
    stored = golden.load("prototype_cantilever")
    twin = selected(run(changed(without_fabric("prototype_cantilever"), "actuator", fmi=2)), selection, times, coils)
    assert golden.differences(twin, stored, selection) == []
    # rtol 1e-8 of 345 K per step of 10 ms decays at 0.14 1/s: up to 2.5 mK, which at 9.5 N/m/K is 7e-5 of 356 N/m.
    loose = dict.fromkeys(selection, Tolerance(0.0, 1e-4, "rtol 1e-8 of CVODE, added up over steps"))
    cvode = changed(without_fabric("prototype_cantilever"), "actuator", integrator="cvode")
    assert golden.differences(selected(run(cvode), loose, times, coils), stored, loose) == []
