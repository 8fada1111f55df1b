"""Which outputs depend on which inputs at the same instant, from the model structure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from fmpy.model_description import ModelDescription, Unknown

from cosim.fmu.variables import FmuVariable
from cosim.unit.protocol import Causality

Feedthrough = dict[str, frozenset[str]]


@dataclass(frozen=True)
class Dependencies:
    """Output to the inputs that it depends on.

    Args:
        feedthrough: While the simulation runs.
        initial: In Initialization Mode.
    """

    feedthrough: Feedthrough
    initial: Feedthrough


def dependencies(description: ModelDescription, variables: Mapping[str, FmuVariable]) -> Dependencies:
    """Direct feedthrough of whole arrays.

    An output without a list of dependencies depends on every input (FMI 2.0 section 2.2.8, FMI 3.0 section 2.4.8); an
    output that is missing among the initial unknowns has an exact start value and depends on none.
    """
    inputs = {
        reference: name
        for name, v in variables.items()
        if v.variable.causality is Causality.INPUT
        for reference in v.value_references
    }
    outputs = {n: v for n, v in variables.items() if v.variable.causality is Causality.OUTPUT}
    running, initial = _known(description.outputs, inputs), _known(description.initialUnknowns, inputs)
    every = frozenset(inputs.values())
    return Dependencies(
        {n: frozenset().union(*(running.get(r, every) for r in v.value_references)) for n, v in outputs.items()},
        {
            n: frozenset().union(
                *(initial.get(d.valueReference, frozenset() if d.initial == "exact" else every) for d in v.declared)
            )
            for n, v in outputs.items()
        },
    )


def _known(unknowns: Sequence[Unknown], inputs: Mapping[int, str]) -> dict[int, frozenset[str]]:
    """Value reference to the inputs that it depends on, for every unknown of the list."""
    every = frozenset(inputs.values())
    known: dict[int, frozenset[str]] = {}
    for unknown in unknowns:
        listed = unknown.dependencies
        known[unknown.variable.valueReference] = (
            every
            if listed is None
            else frozenset(inputs[v.valueReference] for v in listed if v.valueReference in inputs)
        )
    return known
