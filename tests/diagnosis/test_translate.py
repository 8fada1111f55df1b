"""Every key of a scenario is either honoured by the coil network, or the network says that it cannot stand for it."""

import copy
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import yaml

from cosim.run import run
from cosim.scenario import load_scenario, parse_scenario
from cosim.unit.errors import InputError
from diagnosis.candidates.registry import catalogue
from diagnosis.models.build import model_of, models_of
from diagnosis.models.coil_network.kernel.network import CoilNetwork
from diagnosis.models.coil_network.stated import stated_candidates
from diagnosis.models.coil_network.translate import NoCoilNetwork, translate
from diagnosis.models.cosimulation.model import ClosedLoopModel
from diagnosis.recording.recording import load_recording
from diagnosis.search.search import recalibrate
from tests.amend.bench import VARIABLES

TWO_BY_TWO = yaml.safe_load((Path(__file__).parent.parent / "amend" / "two_by_two.yaml").read_text())
#: Both make the same steps; rounding adds up over some hundred of them.
SAME = 1e-9
#: Where resistances follow the current, each solves for it by steps of its own.
SOLVED = {"leads": 1e-5, "drop": 1e-5}
PER_STRING = {"unit": "V", "dim": "string", "points": [["0 s", ["2 V", "1 V"]], ["8 s", ["0 V", "2 V"]]]}


@pytest.fixture(scope="module", autouse=True)
def _fmus(shipped_fmus):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COSIM_FMU_PATH", str(shipped_fmus))
        yield


def changed(changes: dict[str, Any]) -> dict[str, Any]:
    """The scenario of two strings of two coils with other values; `a.b.c` names a key, None takes it away."""
    data = copy.deepcopy(TWO_BY_TWO)
    for path, value in changes.items():
        *folders, last = path.split(".")
        place = data
        for folder in folders:
            place = place.setdefault(folder, {})
        if value is None:
            del place[last]
        else:
            place[last] = value
    return data


def scenario(data, tmp_path):
    return parse_scenario(yaml.safe_dump(data, sort_keys=False), tmp_path / "scenario.yaml")


def by_both(data, tmp_path):
    """Quantity to what the network and the co-simulation give, in steps of one macro-step."""
    given = scenario(data, tmp_path)
    translation = translate(given)
    results = run(given)
    ends = results["time"].values
    inputs = translation.drive.on_grid(ends)
    stated = stated_candidates(translation.parameters.terms)
    found = CoilNetwork(translation.layout, stated, is_midpoint=False).simulate(translation.parameters, inputs, ends)
    names = {q: v for q, v in VARIABLES.items() if v in results and q in found}
    return {q: (found[q][1:], results[v].values.reshape(len(ends), -1)[1:]) for q, v in names.items()}


@pytest.fixture(scope="module")
def unchanged(_fmus, tmp_path_factory):
    """Quantity to what the network gives of the scenario as it is."""
    return {q: own for q, (own, _) in by_both(TWO_BY_TWO, tmp_path_factory.mktemp("unchanged")).items()}


def largest_difference(pairs):
    return max(float(np.abs(a - b).max() / np.abs(b).max()) for a, b in pairs.values())


TWO_LIMITS = [{"kind": "current_limit", "limit": limit} for limit in ("0.5 A", "0.4 A")]

HONOURED = {
    "late contact": {
        "components.circuit.elements": [{"kind": "contact", "string": 1, "resistance": "1 ohm", "instant": "5 s"}]
    },
    "leads": {
        "components.circuit.elements": [
            {"kind": "lead", "string": 2, "rise": "3 ohm/A^2"},
            {"kind": "lead", "string": 2, "rise": "2 ohm/A^2"},
        ]
    },
    "drop": {"components.circuit.elements": [{"kind": "drop", "string": 1, "voltage": "0.5 V"}]},
    "limit": {"components.circuit.elements": [{"kind": "current_limit", "limit": "0.4 A"}]},
    "limit that gives way, of one supply": {
        "components.circuit.supply": "per_string",
        "components.supply.outputs.voltage": PER_STRING,
        "components.circuit.elements": [{"kind": "current_limit", "supply": 2, "limit": "0.2 A", "share": 0.6}],
    },
    "slow": {"components.circuit.elements": [{"kind": "slow_source", "delay": "2 s"}]},
    "contact": {"components.circuit.elements": [{"kind": "contact", "string": 1, "resistance": "1 kohm"}]},
    "contacts and a source": {
        "components.circuit.elements": [
            {"kind": "contact", "string": 2, "resistance": "1 ohm"},
            {"kind": "contact", "string": 2, "resistance": "2 ohm", "instant": "-1 s"},
            {"kind": "source_resistance", "resistance": "0.7 ohm"},
        ],
        "components.circuit.supply_resistance": "0.2 ohm",
        "components.circuit.string_resistance": "0.3 ohm",
    },
    "supply_resistance": {"components.circuit.supply_resistance": "3 ohm"},
    "string_resistance": {"components.circuit.string_resistance": "3 ohm"},
    "strings": {"components.circuit.strings": [1, 3]},
    "per_string": {"components.circuit.supply": "per_string", "components.supply.outputs.voltage": PER_STRING},
    "voltage by element": {
        "components.circuit.supply": "per_string",
        "components.supply.outputs.other": {"unit": "V", "points": [["0 s", "1 V"], ["4 s", "2.5 V"]]},
        "connections": ["supply.voltage -> circuit.supply_voltage[2]", "supply.other -> circuit.supply_voltage[1]"],
    },
    "scaled voltage": {
        "connections": [{"connect": "supply.voltage -> circuit.supply_voltage", "factor": 0.5, "offset": 1.0}]
    },
    "power by element": {
        "components.actuator.electrical": "circuit",
        "connections": [
            "supply.voltage -> circuit.supply_voltage",
            *(f"circuit.power[{n}] -> actuator.power[{n}]" for n in (1, 2, 3, 4)),
        ],
    },
    "mass": {"components.load.mass": "300 g"},
    "room": {"components.room.outputs.temperature.constant": "40 degC"},
    "start of the run": {"time.start": "-2 s"},
    "linear voltage": {"components.supply.outputs.voltage.interpolation": "linear"},
    "initial_temperature": {"components.actuator.parameters.initial_temperature": "60 degC"},
    "R(T)": {
        "components.actuator.parameters.resistance_temperature_coefficient": "0.01 1/K",
        "components.actuator.parameters.reference_temperature": "330 K",
    },
    "cooling": {
        "components.actuator.parameters.use_regressed_cooling_rate": True,
        "components.actuator.parameters.cooling_rate": "0.5 1/s",
        "components.actuator.parameters.off_power": "0.5 W",
    },
    "body": {
        "components.actuator.parameters.volume": "20 mm^3",
        "components.actuator.parameters.area": "300 mm^2",
        "components.actuator.parameters.density": "3000 kg/m^3",
        "components.actuator.parameters.specific_heat": "1500 J/(kg*K)",
        "components.actuator.parameters.heat_transfer_coefficient": "30 W/(m^2*K)",
    },
    "branches": {
        "components.actuator.parameters.heating_a": "190 N/m",
        "components.actuator.parameters.heating_b": "30000",
        "components.actuator.parameters.cooling_b": "300",
        "components.actuator.parameters.cooling_d": "170 N/m",
    },
    "rest length": {"components.actuator.parameters.coil_rest_length": "30 mm"},
}

#: Change to a part of the reason.
REFUSED = {
    "two limits": (
        {"components.circuit.elements": TWO_LIMITS},
        "two elements of kind current_limit at supply 1",
    ),
    "added terms": ({"components.actuator.added_terms": [{"to": "power", "formula": "0.1 * power"}]}, "added_terms"),
    "other FMU": (
        {"components.actuator.fmu": "instant_stiffness", "components.actuator.parameters": {}},
        "thermal_stiffness",
    ),
    "scaled power": (
        {
            "connections": [
                "supply.voltage -> circuit.supply_voltage",
                {"connect": "circuit.power -> actuator.power", "factor": 0.5},
            ]
        },
        "is scaled",
    ),
    "moved power": (
        {
            "connections": [
                "supply.voltage -> circuit.supply_voltage",
                *(f"circuit.power[{5 - n}] -> actuator.power[{n}]" for n in (1, 2, 3, 4)),
            ]
        },
        "in their order",
    ),
    "part of the power": (
        {
            "connections": [
                "supply.voltage -> circuit.supply_voltage",
                *(f"circuit.power[{n}] -> actuator.power[{n}]" for n in (1, 2, 3)),
            ]
        },
        "of some coils",
    ),
    "other power": (
        {
            "components.supply.outputs.power": {"unit": "W", "dim": "coil", "constant": ["0.2 W"] * 4},
            "connections": ["supply.voltage -> circuit.supply_voltage", "supply.power -> actuator.power"],
        },
        "circuit.power",
    ),
    "scaled stiffness": (
        {
            "connections": [
                "supply.voltage -> circuit.supply_voltage",
                {"connect": "actuator.stiffness -> load.stiffness", "factor": 2},
            ]
        },
        "is scaled",
    ),
    "other resistance": (
        {
            "components.supply.outputs.ohm": {"unit": "ohm", "dim": "coil", "constant": ["3 ohm"] * 4},
            "connections": ["supply.voltage -> circuit.supply_voltage", "supply.ohm -> circuit.resistance"],
        },
        "circuit.resistance from actuator",
    ),
    "driven by a start value": (
        {
            "components.circuit": None,
            "components.actuator.electrical": None,
            "components.actuator.structure": {"coils": 4},
            "components.actuator.start": {"power": "0.2 W"},
            "algorithm": None,
            "components.supply.outputs.power": {"unit": "W", "constant": "0.1 W"},
            "connections": ["supply.power -> actuator.power[1]"],
        },
        "start.power",
    ),
}


@pytest.mark.parametrize("name", HONOURED)
def test_a_key_of_the_scenario_changes_the_network_as_it_changes_the_co_simulation(name, unchanged, tmp_path):
    data = changed(HONOURED[name])
    if name == "start of the run":
        data["components"]["supply"]["outputs"]["voltage"]["points"][0][0] = "-2 s"
    pairs = by_both(data, tmp_path)
    assert set(pairs) >= {"temperature", "extension", "current"}
    assert largest_difference(pairs) < SOLVED.get(name, SAME)
    moved = [
        own.shape != unchanged[q].shape or np.abs(own - unchanged[q]).max() > 0.01 * np.abs(own).max()
        for q, (own, _) in pairs.items()
    ]
    assert any(moved) or name == "power by element"  # which says the same in other words


@pytest.mark.parametrize("name", REFUSED)
def test_what_a_network_cannot_stand_for_it_refuses_and_says_why(name, tmp_path):
    changes, reason = REFUSED[name]
    with pytest.raises(NoCoilNetwork, match=reason):
        translate(scenario(changed(changes), tmp_path))


@pytest.mark.parametrize("where", ["scenario", "recording"])
def test_what_a_network_refuses_the_co_simulation_diagnoses_though_nothing_of_it_may_be_off(where, tmp_path):
    """A source with two limits, in the scenario or in what a recording overrides; nothing states an uncertainty."""
    elements = TWO_LIMITS
    whole = changed({"components.circuit.elements": elements})
    results = run(scenario(whole, tmp_path))
    table = pd.DataFrame({"t": results["time"].values, "T": results["actuator.temperature"].values[:, 0] - 273.15})
    folder = tmp_path / "day"
    folder.mkdir()
    table[::10].to_csv(folder / "data.csv", index=False)
    own = {"components": {"circuit": {"elements": elements}}} if where == "recording" else {}
    sidecar = {
        "title": "day",
        "table": "data.csv",
        "time": {"column": "t", "unit": "s", "zero": 0},
        "overrides": own,
        "channels": {"coil[1].temperature": {"column": "T", "unit": "degC", "noise": "0.1 degC"}},
    }
    (folder / "recording.yaml").write_text(yaml.safe_dump(sidecar))
    (tmp_path / "scenario.yaml").write_text(yaml.safe_dump(whole if where == "scenario" else TWO_BY_TWO))
    model = model_of(load_scenario(tmp_path / "scenario.yaml"), [load_recording(folder)], catalogue(), 1)
    assert isinstance(model, ClosedLoopModel)
    assert list(model.parameters) == []
    assert np.abs(recalibrate(model).residuals).max() < 1e-6


@pytest.mark.parametrize(
    ("overrides", "text"),
    [
        ({"strings": [4]}, "strings of 4 coils and one supply for all strings, not strings of 2, 2 coils"),
        ({"strings": [3, 1]}, "strings of 3, 1 coils"),
        ({"supply": "per_string"}, "strings of 2, 2 coils and a supply for each string, not"),
    ],
)
def test_a_recording_of_another_rig_is_refused(overrides, text, tmp_path):
    """Simulated as the first one's coils, its misfit would be told as something that the model leaves out."""
    (tmp_path / "scenario.yaml").write_text(yaml.safe_dump(TWO_BY_TWO))
    times, days = np.arange(0.0, 10.0, 0.5), []
    for name, own in (("one", {}), ("other", overrides)):
        place = tmp_path / name
        place.mkdir()
        pd.DataFrame({"t": times, "T": 22.0 + 0.0 * times}).to_csv(place / "data.csv", index=False)
        sidecar = {
            "title": name,
            "table": "data.csv",
            "time": {"column": "t", "unit": "s", "zero": 0},
            "overrides": {"components": {"circuit": own}},
            "channels": {"coil[1].temperature": {"column": "T", "unit": "degC"}},
        }
        (place / "recording.yaml").write_text(yaml.safe_dump(sidecar))
        days.append(load_recording(place))
    given = load_scenario(tmp_path / "scenario.yaml")
    for training, held_out in ((days, []), (days[:1], days[1:])):
        with pytest.raises(InputError, match="its rig is not that of the other recordings") as caught:
            models_of(given, training, held_out, catalogue(), 1)
        assert text in str(caught.value)
        assert "other" in str(caught.value.source)
