"""One part of a macro-step: how Python does it, and as which operations the library does."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from cosim.native.layout import Code, Operation
from cosim.unit.protocol import StepOutcome

#: Called with begin and length of the macro-step [ns]; a unit's step returns its outcome.
Perform = Callable[[int, int], StepOutcome | None]


@dataclass(frozen=True)
class Call:
    """One operation, and where Python holds the function that it calls.

    Args:
        operation: For the library.
        owner: Object that calls the FMU's function; None where the operation calls none.
        attribute: Its attribute that holds the function.
        results: ctypes objects that the function fills besides the status it returns.
    """

    operation: Operation
    owner: Any = None
    attribute: str = ""
    results: Sequence[Any] = ()


@dataclass(frozen=True)
class Action:
    """A connection carried out, a unit's step, or anything else that happens in a macro-step.

    Args:
        perform: Does it in Python.
        calls: The same as operations.
        can_be_empty: Whether no calls mean that there is nothing to do; otherwise that only Python can do it.
        prepare: Tells the library what it must know beforehand; after every time that Python did the action.
    """

    perform: Perform
    calls: Sequence[Call] = ()
    can_be_empty: bool = False
    prepare: Callable[[], None] | None = None

    @property
    def operations(self) -> list[Operation]:
        """For the library."""
        if not self.calls and not self.can_be_empty:
            return [Operation(code=Code.PYTHON)]
        return [c.operation for c in self.calls]

    def repeat(self, position: int, status: int, time: int, size: int) -> StepOutcome | None:
        """Do the action in Python with the answers that the FMU has already given.

        The library stops where a call was refused, a value is not finite, or a step asks for more than the plain loop
        knows (an event, an early return). Python then does the same action with that answer: its errors and its way
        to go on are the ones and only. A step is not made twice; values are read twice, which changes nothing.

        Args:
            position: The call at which the library stopped.
            status: What it returned.
            time: Begin of the macro-step [ns].
            size: Its length [ns].

        Raises:
            UnitError: The one that the loop in Python would have raised.
        """
        first = self.calls[0]
        made = {0: 0} if first.operation.code in (Code.STEP_FMI2, Code.STEP_FMI3) else {}
        if status > 1:
            made[position] = status
        return _answering([(self.calls[p], s) for p, s in made.items()], lambda: self.perform(time, size))


def _answering(answers: list[tuple[Call, int]], perform: Callable[[], StepOutcome | None]) -> StepOutcome | None:
    if not answers:
        return perform()
    (call, status), *others = answers
    with _answered(call, status):
        return _answering(others, perform)


@contextmanager
def _answered(call: Call, status: int) -> Iterator[None]:
    """The next call of a function gives the results it gave before without being made; those after it are made."""
    owner, attribute = call.owner, call.attribute
    function = getattr(owner, attribute)
    given = [(result, result.value) for result in call.results]

    def answer(*_arguments: Any) -> int:
        for result, value in given:
            result.value = value
        setattr(owner, attribute, function)
        return status

    setattr(owner, attribute, answer)
    try:
        yield
    finally:
        setattr(owner, attribute, function)
