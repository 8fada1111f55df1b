"""One case: a rig, its effects, its recordings, and the answer."""

from __future__ import annotations

import json
from copy import deepcopy
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from evaluation.proving.effects.effect import Effect
from evaluation.proving.effects.measurement import Clipping, SensorFault
from evaluation.proving.programme import Programme
from evaluation.proving.recording import SensorSets, write_clean, write_recording
from evaluation.proving.rig import Rig
from evaluation.proving.sabotage.sabotage import Sabotage
from evaluation.proving.sensors import Sensors, drawn_sensors, read
from evaluation.proving.setups import Setup
from evaluation.proving.truth import Trace, Truth

_SCENARIOS = Path(__file__).resolve().parent / "scenarios"


@dataclass
class Case:
    """A case before it is run.

    Args:
        identifier: Says nothing about the answer.
        kind: One of `VERDICTS`.
        setup: The kind of rig.
        rig: The rig.
        effects: On the rig, in order.
        faults: Of sensors.
        strengths: By identifier.
        training: Programmes to learn from.
        held_out: Programmes to judge by.
        hidden: Identifiers to be taken out of the catalogue.
        sensors: By kind.
        engine: `own`, or `mujoco` for the loads.
        sabotage: What makes recordings and scenario be of different experiments; by default nothing.
    """

    identifier: str
    kind: str
    setup: Setup
    rig: Rig
    effects: list[Effect]
    faults: list[SensorFault]
    strengths: dict[str, str]
    training: list[Programme]
    held_out: list[Programme]
    hidden: tuple[str, ...] = ()
    sensors: dict[str, Sensors] = field(default_factory=dict)
    engine: str = "own"
    sabotage: Sabotage = field(default_factory=Sabotage)

    def write(self, cases: Path, answers: Path, rng: np.random.Generator) -> None:
        """Runs the case and writes its recordings and its answer; its faults spoil its sensors.

        Args:
            cases: Folder that the diagnosis is given; the case gets a folder of its own.
            answers: Folder that it is not given; beside an effect outside the catalogue it gets the twin's recordings.
            rng: Source of noise.

        Raises:
            WireError: A truth does not converge.
        """
        folder = cases / self.identifier
        folder.mkdir(parents=True, exist_ok=True)
        is_noise_told = bool(rng.random() < 0.6)
        # Before sensors are spoiled and numbers are drawn.
        second = (twin(self), deepcopy(rng)) if self.kind in ("outside", "composed") else None
        written = _record(self, folder, rng, is_noise_told)
        if second is not None:
            other, same = second
            _record(other, answers / other.identifier, same, is_noise_told)
        names = list(written)
        (folder / "scenario.yaml").write_text((_SCENARIOS / f"{self.setup.name}.yaml").read_text())
        task = {
            "scenario": "scenario.yaml",
            "training": names[: len(self.training)],
            "held_out": names[len(self.training) :],
            "hidden": list(self.hidden),
        }
        (folder / "task.yaml").write_text(yaml.safe_dump(task, sort_keys=False))
        answers.mkdir(parents=True, exist_ok=True)
        (answers / f"{self.identifier}.json").write_text(json.dumps(_answer(self), indent=1) + "\n")
        held_out = {n: b for n, b in written.items() if n.startswith("held_out")}
        write_clean(answers / f"{self.identifier}.npz", held_out)


def twin(case: Case) -> Case:
    """The same rig with the same sensors and nothing wrong with them: no effects, no faults.

    A model that knows the effects of the case exactly has still to cope with all of this. With the same random numbers
    the twin has the same noise and loses the same readings.
    """
    name = f"{case.identifier}_twin"
    return replace(case, identifier=name, effects=[], faults=[], sensors=deepcopy(case.sensors))


def _record(case: Case, folder: Path, rng: np.random.Generator, is_noise_told: bool) -> dict[str, SensorSets]:
    """Runs and writes every recording of a case; its faults spoil its sensors."""
    names = recording_names(len(case.training), len(case.held_out))
    written: dict[str, SensorSets] = {}
    sabotage = case.sabotage
    for number, (name, programme) in enumerate(zip(names, [*case.training, *case.held_out]), start=1):
        trace = run_truth(case, programme, number)
        if not written:
            _spoil(case, trace.signal)
        sensor_sets = sabotage.spoil(number, [(s, read(s, trace, programme.stop, rng)) for s in case.sensors.values()])
        overrides = case.setup.overrides(sabotage.stated(number, programme))
        change = partial(sabotage.tell, number)
        write_recording(
            folder / name, title_of(case.setup.name, name), overrides, sensor_sets, is_noise_told, number, change
        )
        written[name] = sensor_sets
    return written


def title_of(setup: str, recording: str) -> str:
    """Title of a recording: `small, training 1`."""
    return f"{setup}, {recording.replace('_', ' ')}"


def run_truth(case: Case, programme: Programme, number: int) -> Trace:
    """The truth over the programme of a recording, counted from 1; loads swing in MuJoCo where that is the engine."""
    sabotage = case.sabotage
    effects = [e.in_recording(number) for e in (*sabotage.effects(), *case.effects)]
    given = (e.parameters["instant"] for e in effects if "instant" in e.parameters)
    instants = tuple(i for i in given if np.isfinite(i))
    rig = replace(case.rig, room=case.rig.room + sabotage.room(number))
    applied = sabotage.applied(number, programme)
    trace = Truth(rig, effects).run(applied, case.setup.step, instants, sabotage.start(number))
    if case.engine == "mujoco":
        from evaluation.proving.mujoco_load import hang  # only cases of this engine need MuJoCo

        loads = [e for e in effects if e.unit == "mechanical"]
        trace = replace(trace, states=trace.states | {"extension": hang(trace, case.rig, loads)})
    return trace


def drawn_chain(setup: Setup, rng: np.random.Generator) -> dict[str, Sensors]:
    """Sensors of a rig, by kind."""
    chain = {name: drawn_sensors(kind, setup.sheet, rng) for name, kind in setup.sensors.items()}
    if rng.random() < 0.1:
        chain["temperature"].outliers = 0.01
    return chain


def _spoil(case: Case, signal: Any) -> None:
    """Puts the faults into the sensors; a ceiling is set within what the first recording shows."""
    for fault in case.faults:
        sensors = next(s for s in case.sensors.values() if fault.place.channels[0] in s.names)
        if isinstance(fault, Clipping):
            course = signal(sensors.kind.quantity)[1][:, sensors.rows(fault.place.channels)]
            share = fault.parameters["share"]
            low, high = float(course.min()), float(course.max(axis=0).min())
            fault.parameters = {"ceiling": low + min(share, 0.95) * (high - low)}
        fault.spoil(sensors)


#: Kind of case to the verdicts that are right; those of a sabotaged one are its sabotage's.
VERDICTS = {
    "single": ["missing physics"],
    "two": ["missing physics"],
    "null": ["consistent", "recalibrated"],
    "parameters": ["recalibrated"],
    "sensor": ["measurement fault"],
    "outside": ["unnamed physics"],
    "leave_one_out": ["unnamed physics", "cannot tell"],
    "composed": ["unnamed physics", "cannot tell"],
    "sabotaged": [],
}


def _answer(case: Case) -> dict[str, Any]:
    rig = case.rig
    numbers = ("resistance", "conductance", "capacity", "weight", "stiffness", "shift", "end", "thermometer")
    return {
        "case": case.identifier,
        "kind": case.kind,
        "setup": case.setup.name,
        "engine": case.engine,
        "verdicts": [*VERDICTS[case.kind], *case.sabotage.verdicts],
        "hidden": list(case.hidden),
        "findings": [_finding(case, e) for e in _all(case)],
        "sabotage": _sabotage(case),
        "rig": {n: np.asarray(getattr(rig, n)).tolist() for n in numbers}
        | {"room": rig.room, "slew": rig.slew, "duhem": rig.duhem, "spread": rig.spread},
        "noise": {name: s.noise for name, s in case.sensors.items()},
        "delay": {name: float(s.delay[0]) for name, s in case.sensors.items()},
        "lag": {name: float(s.lag[0]) for name, s in case.sensors.items()},
    }


def _sabotage(case: Case) -> dict[str, Any] | None:
    names = recording_names(len(case.training), len(case.held_out))
    titles = [title_of(case.setup.name, n) for n in names]
    return case.sabotage.answer(names, titles, case.setup.stop) if case.sabotage.kind else None


def recording_names(training: int, held_out: int) -> list[str]:
    """Folders of the recordings of a case, in the order in which they were made."""
    return [*(f"training_{n + 1}" for n in range(training)), *(f"held_out_{n + 1}" for n in range(held_out))]


def _intervals(case: Case, effect: Effect | SensorFault) -> list[dict[str, Any]] | None:
    """Recordings in which a sudden effect is there, and from when to when; None: everywhere and always."""
    instant = effect.parameters.get("instant")
    if instant is None or not isinstance(effect, Effect):
        return None
    names = recording_names(len(case.training), len(case.held_out))
    found = []
    for number, name in enumerate(names, start=1):
        begin = max(effect.in_recording(number).parameters["instant"], 0.0)
        if begin < case.setup.stop:
            title = title_of(case.setup.name, name)
            found.append({"recording": name, "title": title, "order": number, "begin": begin, "end": case.setup.stop})
    return found


def _finding(case: Case, effect: Effect | SensorFault) -> dict[str, Any]:
    kind = effect.place.kind
    element = {"coil": "coil", "string": "string"}.get(kind, "")
    is_numbered = case.setup.sheet.is_bath or case.setup.sheet.is_driven_by_power
    numbers = [n[:1] if is_numbered else n for n in effect.place.numbers]
    return {
        "effect": effect.identifier,
        "unit": effect.unit,
        "is_in_catalogue": effect.is_named,
        "is_hidden": effect.identifier in case.hidden,
        "strength": case.strengths[effect.identifier],
        "place": kind,
        "elements": [f"{element}[{','.join(map(str, n))}]" for n in numbers],
        "channels": list(effect.place.channels),
        "law": effect.law,
        "parameters": effect.parameters,
        "comparable_parameters": list(effect.same_parameters),
        "intervals": _intervals(case, effect),
    }


def _all(case: Case) -> list[Effect | SensorFault]:
    return [*case.effects, *case.faults]
