"""Cycles: flexible, rigid after a delay, flexible again; programmes, requirements and closed forms."""

from __future__ import annotations

import math
from collections.abc import Sequence

from chainmail.design.candidate import LEAD, Candidate, Pulse, Rig, on_grid
from chainmail.design.closed_form import heated_together
from chainmail.design.impossible import Impossible
from chainmail.design.task import Cycle, Wanted
from cosim.unit.quantity import PhysicalValue

#: Below this temperature less than 3 % of the stiffness of equation (2)'s cooling branch is left [K].
SOFT = 307.15


def cycle_requirements(cycle: Cycle, rig: Rig) -> list[Wanted]:
    """Curvature before the first switch, at the end, and while it is to be rigid, the last for every delay."""
    common: dict[str, object] = {
        "quantity": f"{rig.fabric}.max_curvature",
        "unit": "1/m",
        "share": cycle.share,
        "confidence": cycle.confidence,
    }
    made: list[dict[str, object]] = [{"at": at, "above": cycle.cold} for at in (PhysicalValue(0.0, "s"), cycle.period)]
    for delay in delays(cycle):
        made.append({"over": "max", "from": delay, "to": rigid_until(cycle, delay), "below": cycle.hot})
    return [Wanted.model_validate({**common, **own}) for own in made]


def delays(cycle: Cycle) -> list[PhysicalValue]:
    """Shortest first."""
    return sorted(cycle.delay, key=lambda d: d.to("s"))


def rigid_until(cycle: Cycle, delay: PhysicalValue) -> PhysicalValue:
    """End of the time in which the fabric is to be rigid."""
    return PhysicalValue(round(delay.to("s") + cycle.hot_for.to("s"), 9), "s")


def counting(wanted: Sequence[Wanted], cycle: Cycle, delay: PhysicalValue) -> tuple[int, ...]:
    """Numbers of the requirements that count for one delay: all but the rigid times of the others."""
    others = {d.to("s") for d in cycle.delay} - {delay.to("s")}
    return tuple(
        n
        for n, w in enumerate(wanted)
        if not (w.quantity.endswith(".max_curvature") and w.from_ is not None and w.from_.to("s") in others)
    )


def cycled(
    cycle: Cycle,
    delay: PhysicalValue,
    rig: Rig,
    rows: Sequence[int],
    hots: Sequence[float],
    limits: tuple[float, float, float],
    hold: float,
    keys: tuple[tuple[str, str], ...] = (),
) -> Candidate | None:
    """The cheapest programme by the closed forms: heated from 0 s in the shortest time, held only if it must be.

    Args:
        cycle: What is wanted.
        delay: Until the fabric is to be rigid.
        rig: Scenario of the task.
        rows: Heated rows.
        hots: Temperature of each at the end of heating [K].
        limits: Lowest and greatest voltage of a row [V], greatest power of all [W].
        hold: Temperature of the hold [K].
        keys: Numbers of the scenario that are changed.

    Returns:
        None where voltage, power or time forbid it.
    """
    period = cycle.period.to("s")
    if not rows:
        return Candidate((), hold, 0.0, period, keys)
    own = [rig.rows[r - 1] for r in rows]
    exact = heated_together(own, hots, limits[1] * (1 - 1e-9), limits[2], delay.to("s") - LEAD)
    if exact is None:
        return None
    volts = [math.floor(1e4 * v) / 1e4 for v in exact]
    end = on_grid(max(r.heating_time(v, t) for r, v, t in zip(own, volts, hots)), rig)
    if min(volts) < limits[0] or end > delay.to("s") - LEAD + 1e-9:
        return None
    until = on_grid(rigid_until(cycle, delay).to("s"), rig)
    pulses = []
    for number, volt, hot, row in zip(rows, volts, hots, own):
        held = on_grid(end + row.coasting_time(hot, hold), rig, up=False)
        # Programmes of two delays are the same where neither needs a hold, and are then run once.
        pulses.append(
            Pulse(number, volt, hot, 0.0, end, held, until)
            if held < until
            else Pulse(number, volt, hot, 0.0, end, math.inf)
        )
    return Candidate(tuple(pulses), hold, 0.0, period, keys)


def check_cooling(cycle: Cycle, rig: Rig, hold: float) -> None:
    """Raise Impossible where coils cannot be cold again by the end of the cycle."""
    row = rig.rows[rig.held]
    if row.ambient >= SOFT:
        raise Impossible(
            f"the room: at {row.ambient - 273.15:.3g} degC a coil never cools to {SOFT - 273.15:.3g} degC, where it is "
            "soft again",
            f"a room below {SOFT - 273.15:.3g} degC",
        )
    hot = rigid_until(cycle, delays(cycle)[0]).to("s")
    needed = hot + row.coasting_time(hold, SOFT)
    if needed > cycle.period.to("s"):
        raise Impossible(
            f"the period: rigid until {hot:.3g} s, coils of at least {hold - 273.15:.3g} degC then need "
            f"{needed - hot:.3g} s to be soft again, and {cycle.period} are given",
            f"a period of {needed:.3g} s",
        )
