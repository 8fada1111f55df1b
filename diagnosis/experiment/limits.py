"""Limits of an experiment as a user writes them: `supply.voltage=12 V`."""

from __future__ import annotations

import math
from collections.abc import Sequence

from cosim.components import ProgrammeComponent
from cosim.scenario import Scenario
from cosim.unit.errors import InputError
from cosim.unit.quantity import PhysicalValue


def parse_limits(texts: Sequence[str], scenario: Scenario) -> dict[str, float]:
    """`component.output` to its greatest value in the unit of that output.

    Args:
        texts: As written.
        scenario: Has the programmes.

    Raises:
        InputError: One is no limit, names no output of a programme, or is in another unit.
    """
    outputs = {
        f"{name}.{output}": given.unit
        for name, component in scenario.components.items()
        if isinstance(component, ProgrammeComponent)
        for output, given in component.outputs.items()
    }
    found = {}
    for text in texts:
        name, equals, value = (part.strip() for part in text.partition("="))
        if not equals:
            raise InputError("--limit", text, "this is no limit", "write it as `component.output=12 V`")
        if name not in outputs:
            raise InputError(
                "--limit", name, "the scenario has no programme with this output", f"it has: {', '.join(outputs)}"
            )
        try:
            found[name] = PhysicalValue.parse(value).to(outputs[name])
        except ValueError as error:
            raise InputError("--limit", name, str(error), f"give it in {outputs[name]}") from error
    return found


def parse_time(text: str) -> float:
    """A time that is given to a diagnosis [s]; `never`: it has all.

    Raises:
        InputError: It is no time, or none at all.

    >>> parse_time("10 min"), parse_time("never")
    (600.0, inf)
    """
    if text == "never":
        return math.inf
    remedy = "give a time, as `10 min`, or `never`"
    try:
        seconds = PhysicalValue.parse(text).to("s")
    except ValueError as error:
        raise InputError("--stop-after", text, str(error), remedy) from error
    if not 0.0 < seconds < math.inf:
        raise InputError("--stop-after", text, "that is no time to work in", remedy)
    return seconds
