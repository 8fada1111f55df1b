"""Draws cases from a seed and writes them: recordings in one folder, answers in another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from evaluation.proving.case import VERDICTS, Case, drawn_chain
from evaluation.proving.composed.case import ComposedCase
from evaluation.proving.draw import drawn_effect, fits, in_order
from evaluation.proving.effects import measurement
from evaluation.proving.effects.effect import STRENGTHS, Effect, Strength
from evaluation.proving.effects.measurement import SensorFault, drawn_fault
from evaluation.proving.pendulum import arm
from evaluation.proving.pendulum.case import STOP, PendulumCase, drawn_pendulum
from evaluation.proving.programme import Programme
from evaluation.proving.rig import drawn_rig
from evaluation.proving.sabotage.deal import PAIRS
from evaluation.proving.sabotage.pendulum import ArmSabotage
from evaluation.proving.sabotage.sabotage import Bench, Sabotage
from evaluation.proving.setups import EFFECTS, SETUPS, SHARES, Setup

#: Kind of case to its share.
KINDS = {
    "single": 0.25,
    "null": 0.15,
    "parameters": 0.065,
    "sensor": 0.065,
    "two": 0.075,
    "outside": 0.06,
    "leave_one_out": 0.06,
    "sabotaged": 0.14,
    "composed": 0.135,
}
#: Share of the sabotaged cases that lack physics besides.
BESIDES_SHARE = 0.2
#: Rigs of composed cases, as often as they stand here, and equations that a law is composed for.
_COMPOSED_RIGS = (
    "network",
    "network",
    "small",
    "small",
    "zones",
    "bath",
    "bath",
    "heaters",
    "heaters",
    "pendulum",
    "pendulum",
)
_COMPOSED_TARGETS = {
    "bath": ("shift", "force", "length", "reading", "heat"),
    "heaters": ("heat", "heat", "heat", "reading"),
    "pendulum": ("torque",),
}
_ALL_TARGETS = ("heat", "heat", "resistance", "series", "shift", "force", "length", "reading")
#: Share of the cases (but sensor faults) that are a pendulum, and of the loads that MuJoCo swings where it can.
PENDULUM_SHARE, MUJOCO_SHARE = 0.12, 0.7
_OF_MUJOCO = {"slide_friction", "supply_wire_stiffness", "thermal_contraction", "tilt", "viscous_damping"}
#: Effects that a programme of one shape alone shows: it is among the training and the held-out ones.
_NEEDS = {
    "minor_loop_memory": ("partial", "inner"),
    "fatigue": ("pulses", "twice"),
    "fatigue_shift": ("pulses", "twice"),
}
#: Laws that are one equation once the base's own parameters are fitted: each of two thermal masses in any cascade, and
#: under a load that hangs a shift with the stress is a shift. Who hides one of them hides what it can pass for.
EQUAL = (
    frozenset({"second_mass", "lossy_second_mass", "sheath"}),
    frozenset({"stress_dependent_transformation", "transformation_shift"}),
)


def hidden_with(identifier: str) -> tuple[str, ...]:
    """An effect and the laws that are the same equation, the effect first."""
    equal = next((group for group in EQUAL if identifier in group), frozenset[str]())
    return identifier, *sorted(equal - {identifier})


#: A case before it is run.
AnyCase = Case | PendulumCase | ComposedCase


class Deck:
    """Items dealt in a drawn order, all of them before any comes again."""

    def __init__(self, items: Sequence[object], rng: np.random.Generator) -> None:
        self._items, self._rng, self._left = list(items), rng, list[object]()

    def deal(self) -> object:
        """The next one."""
        if not self._left:
            self._left = [self._items[i] for i in self._rng.permutation(len(self._items))]
        return self._left.pop()


class Dealer:
    """Decks of effects with their strengths, so that all of them come equally often."""

    def __init__(self, rng: np.random.Generator) -> None:
        named = [e for e in EFFECTS if e.is_named]
        unnamed = [e for e in EFFECTS if not e.is_named]
        faults = [f for f in measurement.EFFECTS if f.is_named]
        unnamed_faults = [f for f in measurement.EFFECTS if not f.is_named]
        both: list[type[Effect] | type[SensorFault]] = [*unnamed, *unnamed_faults]

        def deck(effects: Sequence[object]) -> Deck:
            return Deck([(e, s) for e in effects for s in STRENGTHS], rng)

        on_arm = [e for e in arm.EFFECTS if e.is_named]
        self.arm_decks = {
            "single": deck(on_arm),
            "two": deck(on_arm),
            "leave_one_out": deck(on_arm),
            "outside": deck([e for e in arm.EFFECTS if not e.is_named]),
            "sabotaged": deck(on_arm),
        }
        self.decks = {
            "single": deck(named),
            "two": deck(named),
            "leave_one_out": deck(named),
            "sensor": deck(faults),
            "outside": deck(both),
            "sabotaged": deck(named),
        }
        self._rng = rng
        self._sabotages: Deck | None = None
        self._rigs: Deck | None = None
        self._targets: dict[str, Deck] = {}

    def deal_sabotage(self, setups: Sequence[str]) -> tuple[type[Sabotage], str]:
        """A sabotage and the rig that it is done to, of some rigs; empty: of all."""
        if self._sabotages is None:
            self._sabotages = Deck([p for p in PAIRS if p[1] in (setups or p[1])], self._rng)
        return self._sabotages.deal()  # type: ignore[return-value]  # as put in

    def deal_composed(self, setups: Sequence[str]) -> tuple[str, str]:
        """A rig, of some rigs (empty: of all), and the equation that a law is composed for."""
        if self._rigs is None:
            self._rigs = Deck([s for s in _COMPOSED_RIGS if s in (setups or s)], self._rng)
        rig = str(self._rigs.deal())
        targets = self._targets.setdefault(rig, Deck(_COMPOSED_TARGETS.get(rig, _ALL_TARGETS), self._rng))
        return rig, str(targets.deal())

    def deal(self, kind: str) -> tuple[type[Effect] | type[SensorFault], Strength]:
        """An effect or fault and its strength, for a kind of case."""
        return self.decks[kind].deal()  # type: ignore[return-value]  # as put in

    def deal_for_arm(self, kind: str) -> list[tuple[arm.ArmEffect, Strength]]:
        """Effects on the pendulum's arm, for a kind of case."""
        if kind in ("null", "parameters", "composed"):
            return []
        dealt = [self.arm_decks[kind].deal()]
        while kind == "two" and len(dealt) < 2:
            other = self.arm_decks[kind].deal()
            dealt += [other] if other[0] is not dealt[0][0] else []  # type: ignore[index]
        return dealt  # type: ignore[return-value]  # as put in


def drawn_cases(
    count: int, seed: int, kinds: Sequence[str] = (), setups: Sequence[str] = ()
) -> list[tuple[AnyCase, np.random.Generator]]:
    """Cases, each with the source of its noise; the same seed draws the same.

    Args:
        count: How many.
        seed: Of all draws.
        kinds: Only these kinds; default: all, by their shares.
        setups: Only these rigs; default: all, by their shares.

    Raises:
        ValueError: A kind or a rig is not known, or no cases are wanted.
    """
    _check(count, kinds, setups)
    rng = np.random.default_rng(np.random.SeedSequence([seed, 0]))
    dealer = Dealer(rng)
    shares = {k: KINDS[k] for k in kinds or KINDS}
    plan = _plan(shares, count, rng)
    sources = [np.random.default_rng(np.random.SeedSequence([seed, 1, n])) for n in range(count)]
    drawn: list[tuple[AnyCase, np.random.Generator]] = []
    for n, (kind, source) in enumerate(zip(plan, sources)):
        identifier = f"case_{n + 1:04d}"
        if kind in ("sabotaged", "composed"):
            make = _drawn_sabotaged if kind == "sabotaged" else _drawn_composed
            drawn.append((make(identifier, dealer, source, setups), source))
            continue
        is_arm = source.random() < PENDULUM_SHARE if kind != "sensor" else False
        if is_arm if not setups else "pendulum" in setups and (is_arm or set(setups) == {"pendulum"}):
            wanted = dealer.deal_for_arm(kind)
            drawn.append((drawn_pendulum(identifier, kind, wanted, VERDICTS[kind], source), source))
        else:
            drawn.append((_drawn_case(identifier, kind, dealer, source, setups), source))
    return drawn


def _check(count: int, kinds: Sequence[str], setups: Sequence[str]) -> None:
    for what, given, known in (("kind of case", kinds, [*KINDS]), ("rig", setups, [*SETUPS, "pendulum"])):
        unknown = sorted(set(given) - set(known))
        if unknown:
            raise ValueError(f"there is no {what} `{unknown[0]}`; there are: {', '.join(known)}")
    if count < 1:
        raise ValueError(f"{count} cases: ask for at least one")
    if set(setups) == {"pendulum"} and "sensor" in (kinds or KINDS):
        raise ValueError("the pendulum has no cases of the kind `sensor`: name other kinds")


def _plan(shares: dict[str, float], count: int, rng: np.random.Generator) -> list[str]:
    """Kinds by their shares, in a drawn order; largest remainders fill up."""
    total = sum(shares.values())
    exact = {k: count * s / total for k, s in shares.items()}
    counts = {k: int(v) for k, v in exact.items()}
    rest = sorted(exact, key=lambda k: counts[k] - exact[k])[: count - sum(counts.values())]
    kinds = [k for k in shares for _ in range(counts[k] + (k in rest))]
    return [kinds[i] for i in rng.permutation(count)]


def _drawn_case(
    identifier: str, kind: str, dealer: Dealer, rng: np.random.Generator, setups: Sequence[str] = ()
) -> Case:
    wanted: list[tuple[type[Effect] | type[SensorFault], Strength]] = []
    while kind not in ("null", "parameters") and len(wanted) < (2 if kind == "two" else 1):
        dealt = dealer.deal(kind)
        if all(dealt[0] is not e for e, _ in wanted) and _able([*(e for e, _ in wanted), dealt[0]], setups):
            wanted.append(dealt)
    setup = _setup([e for e, _ in wanted], rng, setups)
    rig = drawn_rig(setup.sheet, rng, 2.0 if kind == "parameters" else 1.0)
    chain = drawn_chain(setup, rng)
    effects, faults = [], []
    for effect, strength in wanted:
        if issubclass(effect, SensorFault):
            faults.append(drawn_fault(effect, chain, strength, rng))
        else:
            effects.append(drawn_effect(effect, setup, rig, strength, rng))
    is_mujoco = _loads_of_mujoco(effects) and rng.random() < MUJOCO_SHARE
    training, held_out = _programmes(setup, [e.identifier for e, _ in wanted], rng)
    return Case(
        identifier,
        kind,
        setup,
        rig,
        in_order(effects),
        faults,
        {e.identifier: s for e, s in wanted},
        training,
        held_out,
        hidden_with(wanted[0][0].identifier) if kind == "leave_one_out" else (),
        chain,
        "mujoco" if is_mujoco else "own",
    )


def _drawn_sabotaged(identifier: str, dealer: Dealer, rng: np.random.Generator, setups: Sequence[str]) -> AnyCase:
    """A case whose recordings and scenario are not of one experiment; some of them lack physics besides."""
    sabotage, rig_name = dealer.deal_sabotage(setups)
    is_besides = bool(rng.random() < BESIDES_SHARE)
    if issubclass(sabotage, ArmSabotage):
        wanted = dealer.deal_for_arm("sabotaged") if is_besides else []
        case = drawn_pendulum(identifier, "sabotaged", wanted, VERDICTS["sabotaged"], rng)
        return replace(case, sabotage=sabotage.drawn_for_arm(len(case.starts) - 1, STOP, rng))
    setup = SETUPS[rig_name]
    effects: list[Effect] = []
    strengths: dict[str, str] = {}
    rig, chain = drawn_rig(setup.sheet, rng), drawn_chain(setup, rng)
    if is_besides:
        effect, strength = dealer.deal("sabotaged")
        while not _can(effect, setup):
            effect, strength = dealer.deal("sabotaged")
        assert issubclass(effect, Effect), "the deck holds effects on the rig"
        effects, strengths = [drawn_effect(effect, setup, rig, strength, rng)], {effect.identifier: strength}
    training, held_out = _programmes(setup, [*strengths], rng)
    bench = Bench(setup, chain, [*training, *held_out], len(training))
    made = sabotage.drawn(bench, rng)
    return Case(identifier, "sabotaged", setup, rig, effects, [], strengths, training, held_out, (), chain, "own", made)


def _drawn_composed(identifier: str, dealer: Dealer, rng: np.random.Generator, setups: Sequence[str]) -> AnyCase:
    """A case with a law that is composed at random; it is looked for when the case is written."""
    rig_name, target = dealer.deal_composed(setups)
    if rig_name == "pendulum":
        return drawn_pendulum(identifier, "composed", [], VERDICTS["composed"], rng)
    setup = SETUPS[rig_name]
    rig, chain = drawn_rig(setup.sheet, rng), drawn_chain(setup, rng)
    training, held_out = _programmes(setup, [], rng)
    return ComposedCase(identifier, setup, rig, chain, [*training, *held_out], target)


def _setup(
    effects: Sequence[type[Effect] | type[SensorFault]], rng: np.random.Generator, setups: Sequence[str]
) -> Setup:
    """A kind of rig on which all of the effects can act."""
    able = _able(effects, setups)
    shares = np.array([SHARES[s.name] for s in able])
    return able[int(rng.choice(len(able), p=shares / shares.sum()))]


def _loads_of_mujoco(effects: Sequence[Effect]) -> bool:
    """Whether there are loads with effects that MuJoCo can make, and nothing that hears their motion."""
    loads = [e.identifier for e in effects if e.unit == "mechanical"]
    return bool(loads) and set(loads) <= _OF_MUJOCO and all(e.identifier != "motion_draught" for e in effects)


def _able(effects: Sequence[type[Effect] | type[SensorFault]], setups: Sequence[str]) -> list[Setup]:
    return [s for s in SETUPS.values() if s.name in (setups or SETUPS) and all(_can(e, s) for e in effects)]


def _can(effect: type[Effect] | type[SensorFault], setup: Setup) -> bool:
    if issubclass(effect, SensorFault):
        is_swap = effect.places == ("swap",)
        # Where all strings are driven alike, exchanged sensors look like exchanged parameters.
        is_apart = setup.sheet.is_per_string or setup.sheet.is_driven_by_power
        return any(k in setup.sensors for k in effect.kinds) and (is_apart or not is_swap)
    return fits(effect, setup)


def _programmes(
    setup: Setup, effects: Sequence[str], rng: np.random.Generator
) -> tuple[list[Programme], list[Programme]]:
    """Two programmes to learn from and one of another shape to judge by."""
    names = list(setup.shapes)
    needed = [n for e in effects for n in _NEEDS.get(e, ()) if n in names]
    order = [names[i] for i in rng.permutation(len(names))]
    order = [*needed, *(n for n in order if n not in needed)]
    training = [order[i] for i in rng.permutation(2)]
    held_out = [needed[0] if needed else order[2]]
    made = [setup.shapes[n](rng, setup.top, setup.stop) for n in (*training, *held_out)]
    return made[:2], made[2:]


def write_cases(
    folder: str | Path, count: int, seed: int, kinds: Sequence[str] = (), setups: Sequence[str] = ()
) -> None:
    """Writes cases: `cases/<case>/` with scenario, task and recordings, `answers/<case>.json` and `.npz`.

    Args:
        folder: Made if it is not there.
        count: How many.
        seed: Of all draws; the same seed writes the same bytes.
        kinds: Only these kinds of cases; default: all.
        setups: Only these rigs; default: all.

    Raises:
        ValueError: A kind or a rig is not known, or no cases are wanted.
        WireError: A truth does not converge.
        NoLaw: None of many compositions can be made strong enough on a rig.
    """
    folder = Path(folder)
    for case, rng in drawn_cases(count, seed, kinds, setups):
        case.write(folder / "cases", folder / "answers", rng)
