"""Cases of the pendulum: free swings from some angles, seen by an encoder."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from evaluation.proving.composed.torque import ComposedTorque, drawn_torque
from evaluation.proving.effects.effect import Strength, drawn_values
from evaluation.proving.pendulum.arm import GRAVITY, Arm, ArmEffect, Torque
from evaluation.proving.pendulum.engines import ENGINES
from evaluation.proving.rig import Array
from evaluation.proving.sabotage.pendulum import ArmSabotage

_SCENARIO = Path(__file__).resolve().parents[1] / "scenarios" / "pendulum.yaml"
STOP, INTERVAL = 12.0, 0.01  # [s]
QUANTUM = 2.0 * math.pi / 4096.0  # [rad]; an encoder of 12 bits
# What the scenario says: kg, m, kg m^2.
_MASS, _DISTANCE, _CENTRAL = 0.1, 0.115, 4408e-7


@dataclass(frozen=True)
class PendulumCase:
    """A case before it is run.

    Args:
        identifier: Says nothing about the answer.
        kind: As in `evaluation.proving.case.Case`.
        arm: With its effects.
        effects: What acts, with its strength and parameters.
        engine: `own`, `bullet` or `mujoco`.
        noise: Of the encoder [rad].
        starts: Angle [rad] and angular velocity [rad/s] of each recording; the last one is held out.
        verdicts: That are right.
        hidden: Identifiers to be taken out of the catalogue.
        sabotage: What makes recordings and scenario be of different experiments; by default nothing.
        composed: A torque for which no catalogue has a law, or None.
    """

    identifier: str
    kind: str
    arm: Arm
    effects: tuple[tuple[ArmEffect, Strength, dict[str, float]], ...]
    engine: str
    noise: float
    starts: tuple[tuple[float, float], ...]
    verdicts: tuple[str, ...]
    hidden: tuple[str, ...] = ()
    sabotage: ArmSabotage = field(default_factory=ArmSabotage)
    composed: ComposedTorque | None = None

    def write(self, cases: Path, answers: Path, rng: np.random.Generator) -> None:
        """Runs the case and writes recordings, task and answer.

        Args:
            cases: Folder that the diagnosis is given.
            answers: Folder that it is not given.
            rng: Source of noise, and of a composed torque.

        Raises:
            NoLaw: None of many compositions can be made strong enough.
        """
        if self.kind == "composed" and self.composed is None:
            noise = math.hypot(self.noise, QUANTUM / math.sqrt(12.0))
            made = drawn_torque(self.arm, self.starts, noise, (STOP, INTERVAL), rng)
            replace(self, composed=made).write(cases, answers, rng)
            return
        folder = cases / self.identifier
        names = [*(f"training_{n + 1}" for n in range(len(self.starts) - 1)), "held_out_1"]
        clean: Array = np.zeros(0)
        stamps: Array = INTERVAL * np.arange(round(STOP / INTERVAL) + 1, dtype=np.float64)
        for number, (name, start) in enumerate(zip(names, self.starts), start=1):
            off = rng.normal(0.0, 0.005), rng.normal(0.0, 0.02)  # let go by hand
            angle, speed = self.sabotage.real_start(number, start)
            arm = replace(self.arm, extra=self._extra(number))
            swing = ENGINES[self.engine](arm, angle + off[0], speed + off[1], STOP, INTERVAL)
            clean = behind_play(swing, self.arm.of("backlash"))
            read: Array = QUANTUM * np.round((clean + self.noise * rng.standard_normal(clean.size)) / QUANTUM)
            course = self.sabotage.spoil_swing(number, stamps, read)
            stated = self.sabotage.stated_start(number, self.starts)
            _write_recording(folder / name, _title(name), stated, course, (self.noise, number))
        (folder / "scenario.yaml").write_text(_SCENARIO.read_text())
        task = {
            "scenario": "scenario.yaml",
            "training": names[:-1],
            "held_out": names[-1:],
            "hidden": list(self.hidden),
        }
        (folder / "task.yaml").write_text(yaml.safe_dump(task, sort_keys=False))
        answers.mkdir(parents=True, exist_ok=True)
        (answers / f"{self.identifier}.json").write_text(json.dumps(self._answer(), indent=1) + "\n")
        arrays: dict[str, Any] = {"held_out_1/angle/stamps": stamps, "held_out_1/angle/clean": clean}
        np.savez_compressed(answers / f"{self.identifier}.npz", **arrays)

    def _extra(self, number: int) -> Torque | None:
        """What acts besides in a recording: a sabotaged case has no composed law."""
        return self.composed.fresh() if self.composed is not None else self.sabotage.torque(number)

    def _answer(self) -> dict[str, Any]:
        names = [*(f"training_{n + 1}" for n in range(len(self.starts) - 1)), "held_out_1"]
        findings = [] if self.composed is None else [self.composed.finding()]
        findings += [
            {
                "effect": effect.identifier,
                "unit": "mechanical",
                "is_in_catalogue": effect.is_named,
                "is_hidden": effect.identifier in self.hidden,
                "strength": strength,
                "place": "component",
                "elements": ["arm"],
                "channels": [],
                "law": effect.law,
                "parameters": parameters,
                "comparable_parameters": list(effect.comparable),
                "intervals": None,
            }
            for effect, strength, parameters in self.effects
        ]
        arm = {"inertia": self.arm.inertia, "moment": self.arm.moment, "distance": self.arm.distance}
        return {
            "case": self.identifier,
            "kind": self.kind,
            "setup": "pendulum",
            "engine": self.engine,
            "verdicts": [*self.verdicts, *self.sabotage.verdicts],
            "hidden": list(self.hidden),
            "findings": findings,
            "sabotage": self.sabotage.answer(names, [_title(n) for n in names], STOP) if self.sabotage.kind else None,
            "rig": arm,
            "noise": {"angle": self.noise},
        }


def drawn_pendulum(
    identifier: str,
    kind: str,
    wanted: Sequence[tuple[ArmEffect, Strength]],
    verdicts: Sequence[str],
    rng: np.random.Generator,
) -> PendulumCase:
    """A case with its arm, parameters, engine and starts drawn.

    The ratio of weight moment to inertia is off by 2 % (6 % where the parameters are plainly wrong).
    """
    chosen = []
    for effect, strength in wanted:
        parameters = drawn_values(effect.strengths, effect.ranges, strength, rng)
        if effect.signed and rng.random() < 0.5:
            parameters[effect.signed] *= -1.0
        chosen.append((effect, strength, parameters))
    off = 0.06 if kind == "parameters" else 0.02
    distance = _DISTANCE * math.exp(off * float(np.clip(rng.standard_normal(), -2.5, 2.5)))
    mass = _MASS * math.exp(0.01 * rng.standard_normal())
    together = {n: v for _, _, p in chosen for n, v in p.items()}
    arm = Arm(_CENTRAL + mass * distance**2, mass * GRAVITY * distance, distance, together)
    # MuJoCo softens friction near standstill, where stiction is all that there is.
    engines = ["own", "bullet", *([] if "stiction" in together else ["mujoco", "mujoco"])]
    starts = tuple(
        (round(float(math.pi - side * rng.uniform(*span)), 3), round(float(rng.uniform(-1.0, 1.0)), 2))
        for side, span in ((1, (1.2, 1.9)), (-1, (0.5, 1.0)), (1, (0.8, 1.5)))
    )
    return PendulumCase(
        identifier,
        kind,
        arm,
        tuple(chosen),
        str(rng.choice(engines)),
        float(rng.uniform(5e-4, 2e-3)),
        starts,
        tuple(verdicts),
        tuple(e.identifier for e, _ in wanted) if kind == "leave_one_out" else (),
    )


def _title(name: str) -> str:
    return f"arm, {name.replace('_', ' ')}"


def behind_play(angle: Array, play: float) -> Array:
    """Encoder behind a play of this full width [rad], from its middle."""
    if play == 0.0:
        return angle
    found, stands = np.empty_like(angle), float(angle[0])
    for n, now in enumerate(angle.tolist()):
        stands = min(max(stands, now - 0.5 * play), now + 0.5 * play)
        found[n] = stands
    return found


def _write_recording(
    folder: Path, title: str, start: tuple[float, float], course: tuple[Array, Array], told: tuple[float, int]
) -> None:
    """Writes one recording; `course` is stamps and readings, `told` the noise [rad] and the place in time."""
    folder.mkdir(parents=True, exist_ok=True)
    noise, order = told
    lines = ["time,angle", *(f"{t:.6g},{a:.6f}" for t, a in zip(*(c.tolist() for c in course)))]
    (folder / "encoder.csv").write_text("\n".join(lines) + "\n")
    initial = {"initial_angle": f"{start[0]:.6g} rad", "initial_angular_velocity": f"{start[1]:.6g} rad/s"}
    sidecar = {
        "title": title,
        "table": "encoder.csv",
        "time": {"column": "time", "unit": "s", "zero": 0},
        "order": order,
        "overrides": {"time": {"stop": f"{STOP:g} s"}, "components": {"arm": {"parameters": initial}}},
        "uncertain": {"arm.initial_angle": "0.005 rad", "arm.initial_angular_velocity": "0.02 rad/s"},
        "channels": {
            "arm.angle": {
                "column": "angle",
                "unit": "rad",
                "noise": f"{noise:.3g} rad",
                "quantum": f"{QUANTUM:.6g} rad",
            }
        },
    }
    (folder / "recording.yaml").write_text(yaml.safe_dump(sidecar, sort_keys=False, width=120, default_flow_style=None))
