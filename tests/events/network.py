"""Recordings of the proving ground, whose code shares nothing with the diagnosis: each has its own effects."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from diagnosis.recording.recording import Recording, load_recording
from evaluation.proving.case import drawn_chain
from evaluation.proving.effects.effect import Effect, Place
from evaluation.proving.effects.electrical import OpenCoil
from evaluation.proving.effects.thermal import Draught
from evaluation.proving.recording import write_recording
from evaluation.proving.rig import drawn_rig
from evaluation.proving.sensors import read
from evaluation.proving.setups import SETUPS
from evaluation.proving.truth import Truth

SCENARIOS = Path(__file__).resolve().parents[2] / "evaluation" / "proving" / "scenarios"


def open_coil(setup: str, string: int, place: int, instant: float, openness: float = 0.8) -> Effect:
    """A coil that is open in part from an instant on; after a clean break nothing tells which of a string it was."""
    sheet = SETUPS[setup].sheet
    amount = np.zeros(sheet.coils)
    amount[sum(sheet.strings[: string - 1]) + place - 1] = 1.0
    return OpenCoil(Place("coil", ((string, place),), amount), {"openness": openness, "instant": instant})


def draught(setup: str, amount: float, instant: float) -> Effect:
    """A draught over all coils from an instant on."""
    return Draught(Place("all", (), np.ones(SETUPS[setup].sheet.coils)), {"amount": amount, "instant": instant})


def recorded(folder: Path, setup: str, effects: Sequence[Sequence[Effect]], seed: int) -> list[Recording]:
    """One recording for each list of effects, of one rig with its sensors, each under a programme of its own.

    Args:
        folder: Where they are written.
        setup: Kind of rig.
        effects: What acts in each recording, instants on its own clock.
        seed: Of rig, sensors, programmes and noise.
    """
    kind, rng = SETUPS[setup], np.random.default_rng(seed)
    rig = drawn_rig(kind.sheet, rng)
    sensors = drawn_chain(kind, rng)
    shapes = list(kind.shapes.values())
    found = []
    for number, own in enumerate(effects):
        programme = shapes[number % len(shapes)](rng, kind.top, kind.stop)
        instants = tuple(e.parameters["instant"] for e in own if e.parameters.get("instant", -1.0) > 0.0)
        trace = Truth(rig, own).run(programme, kind.step, instants)
        networks = [(s, read(s, trace, programme.stop, rng)) for s in sensors.values()]
        name = f"day_{number + 1}"
        write_recording(folder / name, name, kind.overrides(programme), networks, is_noise_told=True)
        found.append(load_recording(folder / name))
    return found
