"""Every candidate: complete, a formula that can be read, nothing when it is zero, and what its unit says when not."""

import ast

import numpy as np
import pytest

from diagnosis.candidates.candidate import CandidateTerm, Parameter
from diagnosis.candidates.registry import candidate, catalogue
from diagnosis.models.coil_network.kernel.layout import COIL_FIELDS
from diagnosis.models.coil_network.kernel.network import CoilNetwork
from diagnosis.models.coil_network.kernel.places import coil_label, merge, places
from diagnosis.models.coil_network.kernel.source import READABLE
from tests.coil_network.rigs import LOADED, NETWORK, STOP, full_network, network_inputs

TIMES = np.linspace(0.0, STOP, 241)
NAMED = [t for t in catalogue() if t.is_named]
ALL = [pytest.param(t, id=t.identifier) for t in catalogue()]
MEASURED = ("temperature", "current", "extension")
#: Names that formulas may use beside parameters, states and what a hook offers.
LAW_NAMES = {
    "heat",
    "heat_a",
    "heat_b",
    "T_a",
    "T_b",
    "g_a",
    "g_b",
    "hA",
    "R",
    "R_0",
    "R_string",
    "R_string_0",
    "V",
    "V_terminal",
    "I_supply",
    "I_free",
    "T_ambient_0",
    "step",
    "sum",
    "d",
    "abs",
    "min",
    "max",
    "is_off",
    "shift",
    "fraction",
    "stiffness_0",
    "extension_0",
    "extension_marker",
    "value",
    "truth",
    "truth_of_other",
    "load",
}


def strongest(term, place):
    return place.values(term, {p.name: p.starts[-1] for p in term.parameters if not p.is_fixed})


def widest_place(term):
    found = places(term, NETWORK, MEASURED)
    return next((p for p in found if p.kind in ("all", "quantity")), found[0])


@pytest.fixture(scope="module")
def base():
    # Coils of unequal resistance, so that neighbours differ in temperature, in a string too.
    parameters = LOADED.with_base(reference_resistance=np.linspace(2.2, 2.6, 12))
    return parameters, full_network(NETWORK).simulate(parameters, network_inputs(), TIMES)


def test_the_catalogue_holds_every_effect_that_was_asked_for():
    asked = {
        "contact_resistance",
        "supply_source_resistance",
        "supply_current_limit",
        "temperature_dependent_resistance",
        "phase_dependent_resistance",
        "open_coil",
        "shorted_coil",
        "latent_heat",
        "second_mass",
        "shared_mass",
        "radiation",
        "temperature_dependent_convection",
        "chassis_insulation",
        "neighbour_heat",
        "touching_coils",
        "ambient_drift",
        "uneven_cooling",
        "stress_dependent_transformation",
        "fatigue",
        "minor_loop_memory",
        "incomplete_transformation",
        "slide_friction",
        "viscous_damping",
        "supply_wire_stiffness",
        "backlash",
        "tilt",
        "thermal_contraction",
        "sensor_clock_offset",
        "sensor_lag",
        "sensor_gain",
        "sensor_bias",
        "sensor_drift",
        "sensor_clipping",
        "wrong_identity",
    }
    assert asked <= {t.identifier for t in NAMED}
    assert sum(not t.is_named for t in catalogue()) > 50


def test_a_law_is_a_formula_of_known_names():
    for term in catalogue():
        _has_known_names(term)


def _has_known_names(term: CandidateTerm) -> None:
    known = LAW_NAMES | set(READABLE) | set(COIL_FIELDS) | {"t"}
    known |= {p.name for p in term.parameters} | {s.name for s in term.states}
    known |= {p.name + end for p in term.parameters for end in ("_a", "_b") if "pairs" in term.lines}
    for equation in term.law.split(";"):
        sides = equation.replace("<=", "=").split("=")
        assert len(sides) == 2, equation
        for side in sides:
            names = {n.id for n in ast.walk(ast.parse(side.strip(), mode="eval")) if isinstance(n, ast.Name)}
            assert names <= known, (term.identifier, names - known)
    assert all(p.name in term.law for p in term.parameters), term.identifier


@pytest.mark.parametrize("term", [pytest.param(t, id=t.identifier) for t in NAMED])
def test_a_named_candidate_says_what_it_is_confused_with(term: CandidateTerm):
    known = {t.identifier for t in NAMED} | {f"base:{f}" for f in COIL_FIELDS}
    assert term.confused_with
    assert set(term.confused_with) <= known
    assert len(term.source) > 10
    assert len(term.signature) > 20


@pytest.mark.parametrize("term", ALL)
def test_a_candidate_of_strength_zero_changes_no_bit(term: CandidateTerm, base):
    """Switched on at string 2 alone, where strings do not feel each other, it leaves string 1 as it was."""
    parameters, without = base
    network = full_network(NETWORK)
    zero = parameters.with_term(term.identifier, **{term.amplitude.name: 0.0})
    result = network.simulate(zero, network_inputs(), TIMES)
    assert all(np.array_equal(result[q], without[q]) for q in without)
    if term.axis not in ("coil", "string"):
        return
    size = NETWORK.size(term.axis)
    mask = (np.arange(size) >= size // 2).astype(float)
    values = {p.name: np.full(size, p.starts[-1]) for p in term.parameters}
    values[term.amplitude.name] = values[term.amplitude.name] * mask
    result = network.simulate(parameters.with_term(term.identifier, **values), network_inputs(), TIMES)
    if "pairs" in term.lines or "shared" in term.lines:
        return
    for quantity in ("temperature", "stiffness", "extension", "resistance", "power"):
        assert np.array_equal(result[quantity][:, :6], without[quantity][:, :6]), quantity
        assert np.isfinite(result[quantity]).all()


def test_the_catalogue_compiled_in_but_off_is_the_base_to_the_last_bit(base):
    parameters, without = base
    alone = CoilNetwork(NETWORK).simulate(parameters, network_inputs(), TIMES)
    assert all(np.array_equal(alone[q], without[q]) for q in alone)


#: Unit: quantities that it must move, and those that it must leave alone.
TOUCHES = {
    "electrical": (("current", "power"), ()),
    "thermal": (("temperature",), ("current", "power", "resistance")),
    "stiffness": (("stiffness", "extension"), ("current", "power", "temperature")),
    "mechanical": (("extension",), ("current", "power", "temperature", "stiffness")),
}


#: Those that act in a network without a circuit alone have tests of their own.
TOUCHING = [pytest.param(t, id=t.identifier) for t in catalogue() if t.unit in TOUCHES and t.places != ("powered",)]


@pytest.mark.parametrize("term", TOUCHING)
def test_a_candidate_moves_what_belongs_to_its_unit_and_nothing_upstream(term: CandidateTerm, base):
    parameters, without = base
    place = widest_place(term)
    values = strongest(term, place)
    if term.identifier in ("supply_current_limit", "unnamed_supply_hinge"):
        values["limit"] = 0.4  # below the current of this small network
    if term.is_completing and "onset" in values:
        values["onset"] = term.parameters[1].starts[0]  # a knot that every variable reaches
    result = full_network(NETWORK).simulate(parameters.with_term(term.identifier, **values), network_inputs(), TIMES)
    moved, kept = TOUCHES[term.unit]
    for quantity in moved:
        change = np.abs(result[quantity] - without[quantity]).max()
        assert change > 1e-4 * np.abs(without[quantity]).max(), quantity  # far above rounding (1e-16)
    for quantity in kept:
        assert np.array_equal(result[quantity], without[quantity]), quantity


@pytest.mark.parametrize("term", [pytest.param(t, id=t.identifier) for t in catalogue() if t.unit == "measurement"])
def test_a_sensor_fault_moves_its_own_channels_alone(term: CandidateTerm, base):
    parameters, without = base
    found = places(term, NETWORK, ("temperature",))
    place = next(p for p in found if p.kind in ("channel", "swap") and (p.kind == "channel" or "2," in p.label))
    result = full_network(NETWORK).simulate(
        parameters.with_term(term.identifier, **strongest(term, place)), network_inputs(), TIMES
    )
    first = NETWORK.channel("temperature")
    own = np.flatnonzero(place.mask[first : first + 12])
    assert np.abs(result["temperature"] - without["temperature"])[:, own].max() > 0.05
    others = np.setdiff1d(np.arange(12), own)
    assert np.allclose(result["temperature"][:, others], without["temperature"][:, others], rtol=1e-13)  # rounding
    assert np.allclose(result["extension"], without["extension"], rtol=1e-13)
    assert np.array_equal(result["power"], without["power"]) or np.allclose(
        result["power"], without["power"], rtol=1e-13
    )


def test_places_are_named_from_one_and_gradients_have_no_mean():
    assert coil_label(NETWORK, 7) == "coil[2,2]"
    found = places(candidate("uneven_cooling"), NETWORK)
    rows = next(p for p in found if p.kind == "row_gradient")
    assert rows.mask.mean() == pytest.approx(0.0, abs=1e-15)
    assert rows.mask[0] == -1.0
    assert rows.mask[-1] == 1.0
    assert {p.label for p in places(candidate("contact_resistance"), NETWORK)} == {"string[1]", "string[2]"}


def test_one_candidate_at_two_places_keeps_both_instants():
    term = candidate("open_coil")
    found = places(term, NETWORK)
    first = found[0].values(term, {"openness": 1.0, "instant": 5.0})
    both = merge(term, first, found[9].values(term, {"openness": 0.5, "instant": 8.0}))
    assert both["openness"][[0, 9]].tolist() == [1.0, 0.5]
    assert both["instant"][[0, 9]].tolist() == [5.0, 8.0]


def test_a_parameter_without_room_or_with_a_start_outside_is_refused():
    with pytest.raises(ValueError, match="no room"):
        Parameter("a", "W", 1.0, 1.0, "", (1.0,))
    with pytest.raises(ValueError, match="within its bounds"):
        Parameter("a", "W", 0.0, 1.0, "", (2.0,))
