"""Every term of the catalogue, in the amended co-simulation and in the network: the model that was fitted runs."""

from __future__ import annotations

from pathlib import Path

import pytest

from cosim.run import run
from diagnosis.amend.amend import AmendedModel, amend_like, write_amended
from diagnosis.amend.changes import Changes, fitted_terms
from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.models.coil_network.kernel.parameters import CoilNetworkParameters
from diagnosis.models.coil_network.translate import translate
from tests.amend import bench

#: The same C lines in the same order of steps; ngspice and the network's own solution of the network round differently,
#: and a switch of the stiffness' play can carry a last digit on. A term that is left out changes some quantity by 1e-3.
SAME = 1e-9
TERMS = bench.model_terms()
NAMED = [t for t in TERMS if t.is_named]
#: One unnamed term of each equation, with and without a state of its own, and the memory of a source.
UNNAMED = [
    t
    for t in TERMS
    if t.identifier
    in (
        "unnamed_heat_excess_times_stretch",
        "unnamed_resistance_delayed_stretch",
        "unnamed_stiffness_linear_rate",
        "unnamed_length_delayed_phase",
        "unnamed_supply_delayed",
    )
]
REST = [t for t in TERMS if t not in NAMED and t not in UNNAMED]


@pytest.fixture(scope="module")
def everything(tmp_path_factory: pytest.TempPathFactory) -> AmendedModel:
    """FMUs that hold all terms at once, so that they are compiled once."""
    given = bench.scenario()
    return write_amended(given, bench.changes(given, TERMS), tmp_path_factory.mktemp("everything"))


def _check(term: CandidateTerm, everything: AmendedModel, folder: Path) -> None:
    given = bench.scenario()
    amended = amend_like(everything, bench.changes(given, [term]), folder)
    results = run(amended.scenario)
    size, quantity = bench.difference(results, bench.by_network(given, [term]))
    assert size < SAME, f"{quantity} differs by {size:.2g}"
    without, _ = bench.difference(results, bench.by_network(given, []))
    assert without > 1e3 * SAME, "the term does nothing here"


@pytest.mark.parametrize("term", [*NAMED, *UNNAMED], ids=lambda t: t.identifier)
def test_the_amended_co_simulation_equals_the_network_with_the_term(
    term: CandidateTerm, everything: AmendedModel, tmp_path: Path
) -> None:
    _check(term, everything, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("term", REST, ids=lambda t: t.identifier)
def test_the_amended_co_simulation_equals_the_network_with_an_unnamed_term(
    term: CandidateTerm, everything: AmendedModel, tmp_path: Path
) -> None:
    _check(term, everything, tmp_path)


def test_the_fmus_with_all_terms_switched_off_are_the_scenario_itself(everything: AmendedModel, tmp_path: Path) -> None:
    given = bench.scenario()
    translation = translate(given)
    quiet = Changes(
        translation, {"load": 1.0 + 0.0 * bench.strengths(NAMED[0], translation.layout)["R_contact"]}, [], {}
    )
    amended = amend_like(everything, quiet, tmp_path)
    assert amended.scenario.components["load"].kind == "fmu"
    size, quantity = bench.difference(run(amended.scenario), bench.by_network(given, []))
    assert size < SAME, f"{quantity} differs by {size:.2g}"


def test_terms_of_all_parts_act_together(tmp_path: Path) -> None:
    chosen = [
        t
        for t in TERMS
        if t.identifier
        in (
            "self_heating_lead",
            "supply_current_limit",
            "phase_dependent_resistance",
            "latent_heat",
            "second_mass",
            "fatigue",
            "stress_dependent_transformation",
            "creep",
            "slide_friction",
        )
    ]
    given = bench.scenario()
    amended = write_amended(given, bench.changes(given, chosen), tmp_path)
    size, quantity = bench.difference(run(amended.scenario), bench.by_network(given, chosen))
    assert size < SAME, f"{quantity} differs by {size:.2g}"


def test_a_term_whose_amplitude_is_zero_is_not_written() -> None:
    translation = translate(bench.scenario())
    assert fitted_terms(TERMS, CoilNetworkParameters({}, {"radiation": {"emissivity_area": 0.0}})) == []
    assert translation.layout.coils == 4
