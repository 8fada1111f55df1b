"""What of the rig was another in one recording, as the search sees it: parameters, derivatives within an interval."""

from __future__ import annotations

from collections.abc import Sequence

from cosim.scenario import Scenario
from diagnosis.faults.law import PARAMETER, RATE, added_rate, fault_term, occasion, parameter_share
from diagnosis.faults.programme import span_of
from diagnosis.models.systems.changed_run import Changed
from diagnosis.recording.recording import Recording
from diagnosis.search.problem import Term


def rig_terms(
    changes: Sequence[Changed], scenario: Scenario, recordings: Sequence[Recording], number: int
) -> list[Term]:
    """A fault for each change, in the same order.

    Args:
        changes: What may have been another.
        scenario: Of the recording.
        recordings: All of them; their titles tell them apart.
        number: Of the recording.
    """
    span = span_of(scenario, recordings[number])
    titles = [r.title for r in recordings]
    found = []
    for change in changes:
        name = f"{change.component}.{change.name}"
        if change.is_share:
            found.append(fault_term(PARAMETER, occasion(name, titles, number), parameter_share(), span, number))
        else:
            label, strength = f"derivative of {name}", added_rate(change.unit_of_amount, abs(change.first))
            found.append(fault_term(RATE, occasion(label, titles, number), strength, span, number))
    return found
