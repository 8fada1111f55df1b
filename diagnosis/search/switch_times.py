"""When a recorded input changed: somewhere between two rows of its table, which the table does not say.

Each change of an input that holds its value has a number of its own, in its recording alone: the time by which it came
earlier than its row says. Where readings do not ask for that, changes stay where their
rows are. Without it a heater that switches between rows of two minutes leaves readings that no law of
the rig explains, or that a dead time, a lag or a gain of the input seems to explain.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import chdtri

from cosim.components import ProgrammeComponent, ProgrammeOutput
from cosim.scenario import Scenario
from cosim.unit.protocol import Array
from cosim.unit.quantity import conversion
from diagnosis.faults.programme import InputChange
from diagnosis.recording.recording import Input, Recording
from diagnosis.search.fit import Fit, fit, fit_best
from diagnosis.search.free_numbers import Free
from diagnosis.search.problem import Model, Own, Parameter, Point, Term
from diagnosis.search.shares import own_label
from diagnosis.search.structure import deviation_of, structure

#: Prior standard deviation of an instant, in rows: it lies within the row before, or in the one after where a logger
#: writes what it sets.
HALF = 0.5
#: Largest departure, in prior deviations: one row.
ONE_ROW = 2.0
#: Changes of a recording's inputs up to which each has an instant of its own: each costs a simulation of its recording
#: in every step of a fit.
MOST = 64
#: Changes, and share of the rows of an input, beyond both of which it changes nearly with each row, as a course that is
#: sampled does: between its rows it is somewhere between its values.
FEW, MOST_ROWS = 24, 0.25
#: Probability of taking instants that are not needed.
CHANCE = 1e-3
#: Share of what noise does not explain that instants have to explain.
MOST_OF_IT = 0.5
#: Share of an input's range from which a change is one.
LEAST = 0.02
#: Fewest rows of a table that was sampled, and the share of a row by which sampled ones differ.
FEWEST, EVEN = 10, 0.1


#: Laws that are present, with the values of their numbers.
Terms = Mapping[Term, tuple[float, ...]]


@dataclass(frozen=True)
class Switch:
    """A change of a recorded input between two rows.

    Args:
        time: Of the row that has the new value [s].
        change: New value less the old one, in the unit of the programme's output.
    """

    time: float
    change: float

    def moved(self, earlier: float) -> InputChange:
        """What acts beside the recorded course where the change came earlier by a time [s], or later where negative."""
        begin, end = sorted((self.time - earlier, self.time))
        return InputChange(self.change if earlier > 0.0 else -self.change, begin, end, True, True)


def switch_times(scenarios: Sequence[Scenario], recordings: Sequence[Recording]) -> list[Free]:
    """Instants of the changes of every recorded input that holds its value.

    Args:
        scenarios: Of each recording.
        recordings: The recordings.
    """
    found = []
    for number, (scenario, recording) in enumerate(zip(scenarios, recordings)):
        own = [(i, _switches(scenario, i, recording.end)) for i in recording.inputs]
        own.sort(key=lambda pair: len(pair[1]))
        count = 0
        for recorded, switches in own:
            if len(switches) > max(FEW, MOST_ROWS * len(recorded.times)):
                continue
            count += len(switches)
            if count > MOST:
                break
            found += [_free(recorded, s, row, number) for s, row in switches]
    return found


def are_needed(plain: Model, moved: Model, late: Sequence[Term] = (), terms: Terms | None = None) -> bool:
    """Whether the training recordings ask for instants of their own.

    By what they gain beyond their priors, more than chance gives so many of them once in a thousand: where changes
    come with their rows, such instants would only make everything else less certain. And by what they leave: where a
    law is missing, many free instants take up a bit of it; they explain what noise does not if that is most of it, or
    if nothing but noise is left, whatever its size: no noise need be stated, and a larger one than stated is no law.
    A dead time is what all changes of an input have in common: they must gain over that too.

    Args:
        plain: The model without them.
        moved: The same with them.
        late: Dead times of inputs.
        terms: Laws that were found, with their values.
    """
    count = len(moved.parameters) - len(plain.parameters)
    least = chdtri(count, CHANCE)
    given = terms or {}
    as_recorded, free = (fit(m, Point(np.zeros(len(m.parameters)), given)) for m in (plain, moved))
    gain, excess = as_recorded.cost - free.cost, as_recorded.cost - len(plain.layout.time)
    if not gain > max(least, MOST_OF_IT * excess):
        # what is left is the noise then: a gain counts in its units (McCullagh and Nelder 1989, chapter 9)
        louder = max(free.cost / max(len(plain.layout.time), 1), 1.0)
        if not gain > louder * least or not _is_noise(free, moved):
            return False
    common = _with_late(plain, late, as_recorded)
    if set(common.point.terms) == set(given):
        return True
    own = fit(moved, Point(np.zeros(len(moved.parameters)), common.point.terms))
    return bool(common.cost - min(own.cost, free.cost) > least)


def _is_noise(found: Fit, model: Model) -> bool:
    """Whether a fit leaves nothing but noise, that of each channel as large as its neighbouring readings differ by."""
    left = found.residuals.copy()
    for number in range(len(model.layout.names)):
        own = np.flatnonzero((model.layout.channel == number) & (left != 0.0))
        if len(own) > FEWEST:
            left[own] /= max(deviation_of(np.diff(left[own])), 1.0)
    return structure(left, model.layout).is_noise


def _with_late(plain: Model, late: Sequence[Term], best: Fit) -> Fit:
    """A fit of the model with those further dead times that it gains by, one after the other."""
    for term in [t for t in late if t not in best.point.terms]:
        (number,) = term.parameters
        starts = [Point(best.point.base, {**best.point.terms, term: (s,)}) for s in number.starts]
        found = fit_best(plain, starts)
        if best.cost - found.cost > chdtri(1, CHANCE):
            best = found
    return best


def is_held(scenario: Scenario, recorded: Input) -> bool:
    """Whether an input holds each of its values until the next row, and no straight lines join them."""
    return len(recorded.times) > 1 and _output(scenario, recorded).interpolation != "linear"


def row_length(scenario: Scenario, recorded: Input) -> float:
    """Median time from one row to the next [s] of an input that was sampled, holds its values and changes; else 0.

    A programme whose rows are its switches is known to the instant: where fewer than half of the rows are evenly apart,
    they are no samples.
    """
    steps = np.diff(recorded.times)
    if len(steps) < FEWEST or not is_held(scenario, recorded) or not np.any(np.diff(recorded.values)):
        return 0.0
    middle = float(np.median(steps))
    return middle if np.mean(np.abs(steps - middle) <= EVEN * middle) >= 0.5 else 0.0


def earlier(recorded: Input, shares: Array | float) -> Input:
    """The input with each change earlier by a share of the row before it.

    Args:
        recorded: The input as its rows say.
        shares: One for all rows, or of each row but the first, shape (rows - 1,).
    """
    times = recorded.times.copy()
    times[1:] -= shares * np.diff(recorded.times) * (np.diff(recorded.values) != 0.0)
    return replace(recorded, times=times)


def with_earlier_inputs(scenarios: Sequence[Scenario], recordings: Sequence[Recording]) -> list[list[Recording]]:
    """The recordings with one input that was sampled half a row earlier wherever it was, for each such input."""
    sampled = {
        (number, i.component, i.output)
        for number, (scenario, r) in enumerate(zip(scenarios, recordings))
        for i in r.inputs
        if row_length(scenario, i) > 0.0
    }
    found = []
    for name in sorted({one[1:] for one in sampled}):
        moved = []
        for number, r in enumerate(recordings):
            is_own = (number, *name) in sampled
            inputs = [earlier(i, HALF) if is_own and (i.component, i.output) == name else i for i in r.inputs]
            moved.append(replace(r, inputs=tuple(inputs)))
        found.append(moved)
    return found


def shifts_by_recording(changes: Sequence[Array], sizes: Sequence[int]) -> Array:
    """Changes of all residuals, one row for each recording that moves; shape (rows, residuals).

    Args:
        changes: Of the residuals, one for each input, in order of the recordings; not finite where runs have none.
        sizes: Residuals of each recording.
    """
    ends = np.cumsum(sizes)
    found = []
    for change in changes:
        for begin, end in zip((0, *ends), ends):
            row = np.zeros(len(change))
            row[begin:end] = change[begin:end]
            if np.isfinite(row).all() and np.any(row):
                found.append(row)
    return np.array(found) if found else np.zeros((0, int(ends[-1])))


def _output(scenario: Scenario, recorded: Input) -> ProgrammeOutput:
    component = scenario.components[recorded.component]
    assert isinstance(component, ProgrammeComponent)
    return component.outputs[recorded.output]


def _switches(scenario: Scenario, recorded: Input, end: float) -> list[tuple[Switch, float]]:
    """Changes with the time since the row before [s]; none of an input that straight lines join."""
    if not is_held(scenario, recorded):
        return []
    given = _output(scenario, recorded)
    factor = conversion(recorded.unit, given.unit)[0]
    steps = np.diff(recorded.values)
    start = scenario.time.start.to("s")
    places = np.flatnonzero(np.abs(steps) > LEAST * float(np.ptp(recorded.values))) + 1
    return [
        (
            Switch(float(recorded.times[i]), factor * float(steps[i - 1])),
            float(recorded.times[i] - recorded.times[i - 1]),
        )
        for i in places.tolist()
        if start < recorded.times[i - 1] and recorded.times[i] < end
    ]


def _free(recorded: Input, switch: Switch, row: float, number: int) -> Free:
    own = Own(f"change of {recorded.component}.{recorded.output} before {switch.time:.6g} s", number)
    parameter = Parameter(own_label(own), "s", 0.0, HALF * row, False, bounds=ONE_ROW, own=own, is_within_row=True)
    return Free(parameter, recorded.component, recorded.output, frozenset((number,)), switch=switch)
