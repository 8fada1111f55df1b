"""Elements of the circuit that a scenario states: the fast simulation has them, and the search looks beside them."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import yaml

from cosim.components import CircuitComponent
from cosim.run import run
from cosim.scenario import load_scenario, parse_scenario
from diagnosis.amend.changes import FittedTerm
from diagnosis.amend.circuit_elements import circuit_elements
from diagnosis.candidates.registry import candidate, catalogue
from diagnosis.models.build import model_of
from diagnosis.models.coil_network.kernel.network import CoilNetwork
from diagnosis.models.coil_network.model import CoilNetworkModel
from diagnosis.models.coil_network.stated import stated_candidates, stated_terms
from diagnosis.models.coil_network.translate import translate
from diagnosis.recording.done import conditions
from diagnosis.recording.readings import read_results
from diagnosis.recording.recording import load_recording
from diagnosis.recording.sensor import SensorFile
from diagnosis.recording.write import Notes, write_recording
from diagnosis.search.problem import Point
from diagnosis.search.search import recalibrate

from .test_translate import changed

TWO_SUPPLIES = {
    "components.circuit.supply": "per_string",
    "components.supply.outputs.voltage": {"unit": "V", "dim": "string", "constant": ["2 V", "2 V"]},
}
LIMIT = {"kind": "current_limit", "supply": 2, "limit": "0.2 A"}


@pytest.fixture(scope="module", autouse=True)
def _fmus(shipped_fmus):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COSIM_FMU_PATH", str(shipped_fmus))
        yield


def circuit(*elements: dict[str, Any]) -> CircuitComponent:
    return CircuitComponent(kind="ngspice", strings=[2, 1], supply="per_string", elements=list(elements))


def test_elements_are_laws_at_their_string_or_source():
    terms = stated_terms(
        circuit(
            LIMIT,
            {"kind": "contact", "string": 1, "resistance": "2 ohm", "instant": "5 s"},
            {"kind": "contact", "string": 2, "resistance": "3 ohm", "instant": "1 s"},
            {"kind": "drop", "string": 2, "voltage": "0.1 V"},
            {"kind": "drop", "string": 2, "voltage": "0.2 V"},
            {"kind": "source_resistance", "supply": 1, "resistance": "1 ohm"},
        ),
        start=1.0,
    )
    assert sorted(terms) == ["stated_loose_contact", "stated_supply_current_limit", "stated_unnamed_series_constant"]
    np.testing.assert_array_equal(terms["stated_supply_current_limit"]["share"], [0.0, 1.0])
    assert terms["stated_supply_current_limit"]["limit"][1] == 0.2
    np.testing.assert_array_equal(terms["stated_loose_contact"]["R_contact"], [2.0, 0.0])  # the other was there before
    assert terms["stated_loose_contact"]["instant"][0] == 5.0
    np.testing.assert_allclose(terms["stated_unnamed_series_constant"]["a"], [0.0, 0.3])


@pytest.mark.parametrize(
    "element",
    [
        LIMIT,
        {"kind": "contact", "string": 1, "resistance": "2 ohm", "instant": "5 s"},
        {"kind": "slow_source", "supply": 1, "delay": "2 s"},
    ],
)
def test_two_of_a_kind_at_one_place_are_refused_where_they_do_not_add(element):
    with pytest.raises(ValueError, match=f"two elements of kind {element['kind']} at "):
        stated_terms(circuit(element, element), start=0.0)


def test_a_limit_that_is_found_at_another_source_leaves_the_stated_one_alone(tmp_path):
    data = changed({**TWO_SUPPLIES, "components.circuit.elements": [LIMIT]})
    found = translate(parse_scenario(yaml.safe_dump(data), tmp_path / "scenario.yaml"))
    law = candidate("supply_current_limit")
    network = CoilNetwork(found.layout, [*stated_candidates(found.parameters.terms), law])
    other = found.parameters.with_term(law.identifier, share=np.array([1.0, 0.0]), limit=np.array([0.3, 1.0]))
    inputs = found.drive.on_grid(np.linspace(0.0, 5.0, 51))
    for parameters, currents in ((found.parameters, (None, 0.2)), (other, (0.3, 0.2))):
        current = network.simulate(parameters, inputs, inputs.time)["current"][1:]
        for string, limit in enumerate(currents):
            if limit is None:
                assert current[:, string].min() > 0.35  # 2 V through two coils of 2.2 ohm
            else:
                np.testing.assert_allclose(current[:, string], limit, rtol=1e-9)


def test_a_rig_with_a_stated_limit_is_simulated_fast_and_agrees_with_its_recording(tmp_path: Path):
    data = changed({**TWO_SUPPLIES, "components.circuit.elements": [LIMIT]})
    results = run(parse_scenario(yaml.safe_dump(data), tmp_path / "scenario.yaml"))
    table = pd.DataFrame({"t": results["time"].values, "I": results["circuit.string_current"].values[:, 1]})
    folder = tmp_path / "day"
    folder.mkdir()
    table[1::10].to_csv(folder / "data.csv", index=False)
    sidecar = {
        "title": "day",
        "table": "data.csv",
        "time": {"column": "t", "unit": "s", "zero": 0},
        "channels": {"string[2].current": {"column": "I", "unit": "A", "noise": "1 mA"}},
    }
    (folder / "recording.yaml").write_text(yaml.safe_dump(sidecar))
    (tmp_path / "scenario.yaml").write_text(yaml.safe_dump(data))
    model = model_of(load_scenario(tmp_path / "scenario.yaml"), [load_recording(folder)], catalogue(), 1)
    assert isinstance(model, CoilNetworkModel)
    assert np.abs(recalibrate(model).residuals).max() < 0.01
    limits = [t for t in model.terms() if t.identifier.startswith("supply_current_limit")]
    assert limits
    assert not any("stated" in t.identifier for t in model.terms())
    base = Point(np.zeros(len(model.parameters)))
    assert np.isfinite(model.residuals([base.plus(t, [p.starts[0] for p in t.parameters]) for t in limits])).all()


def test_a_recording_of_a_rig_with_a_slow_source_is_met_by_the_fast_simulation(tmp_path: Path):
    """The co-simulation gives the mean over each macro-step; what is recorded of it is the value at its end."""
    slow = {"kind": "slow_source", "supply": 1, "delay": "0.4 s"}
    steps = {"unit": "V", "dim": "string", "points": [["0 s", ["2 V", "1 V"]], ["2 s", ["0.5 V", "1 V"]]]}
    data = changed(
        {
            **TWO_SUPPLIES,
            "components.supply.outputs.voltage": steps,
            "components.circuit.elements": [slow],
            "time.macro_step": "50 ms",
            "time.output_step": "50 ms",
        }
    )
    path = tmp_path / "scenario.yaml"
    path.write_text(yaml.safe_dump(data))
    scenario = load_scenario(path)
    sensors = SensorFile.model_validate({"default": {"rate": "20 Hz"}})
    read = read_results(run(scenario), ["string[1].current"], sensors, 0, path)
    write_recording(tmp_path / "day", read, Notes("day", "made", conditions(scenario)))
    model = model_of(scenario, [load_recording(tmp_path / "day")], catalogue(), 1)
    assert isinstance(model, CoilNetworkModel)
    (simulated,) = model.predict(Point(np.zeros(len(model.parameters))), 0)
    measured = model.runs[0].series[0].channel.values[-len(simulated) :]
    late = np.concatenate([measured[:1], 0.5 * (measured[1:] + measured[:-1])])
    off, half = (float(np.sqrt(np.mean((simulated - values) ** 2))) for values in (measured, late))
    assert off < 0.15 * half  # half a step later they are that much farther away


@pytest.mark.parametrize(
    "element",
    [
        LIMIT | {"share": 0.7},
        {"kind": "contact", "string": 1, "resistance": "2 ohm", "instant": "5 s"},
        {"kind": "lead", "string": 2, "rise": "3 ohm/A^2"},
        {"kind": "drop", "string": 2, "voltage": "0.4 V"},
        {"kind": "slow_source", "supply": 2, "delay": "2 s"},
    ],
)
def test_an_element_is_the_law_that_is_amended_by_it(element):
    """What the search finds is written as an element, and read again as what was found."""
    ((law, values),) = stated_terms(circuit(element), start=0.0).items()
    found = FittedTerm(candidate(law.removeprefix("stated_")), {n: np.asarray(v) for n, v in values.items()})
    assert circuit_elements([found]) == [element]
