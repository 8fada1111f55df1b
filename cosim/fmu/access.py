"""One set or get call of an FMU as an object: which C function, which value references, which buffer.

Whoever steps many FMUs can make the same call without Python: `function(component, references, count, buffer)` in FMI
2.0, with `, number of values` in FMI 3.0 (not for Clocks). Where `is_direct` is false, Python has to translate between
`values` and `buffer` (text, binary data, and FMI 2.0's Booleans and enumerations, which are C integers).
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any

import numpy as np

from cosim.fmu.sizes import MOST_BYTES
from cosim.fmu.variables import FmuVariable
from cosim.unit.protocol import AnyArray, UnitError

#: Called with the name of a function and a status that is neither OK nor Warning; raises UnitError.
StatusCheck = Callable[[str, int], None]

_WARNING = 1


def address_of(function: Any) -> int:
    """Address of a C function, for whoever calls it without Python."""
    value = ctypes.cast(function, ctypes.c_void_p).value
    assert value is not None
    return value


class Access:
    """A set or get call with everything bound; `access()` makes it.

    Args:
        function: Name of the C function, for example `fmi3SetFloat64`.
        component: The FMU's instance pointer.
        call: The C function, declared with plain addresses and sizes.
        variable: What is accessed (for a call that covers several variables, the first of them).
        references: Value references, a ctypes array; kept alive here.
        values: The unit's own array, of the type's dtype.
        buffer: What the C function sees: `values` itself, or an array of C's type with the same number of elements.
        check: Raises UnitError for a bad status.
        unit: Name of the component, for errors.
    """

    is_direct = True

    def __init__(
        self,
        function: str,
        component: int,
        call: Callable[..., int],
        variable: FmuVariable,
        references: Any,
        values: AnyArray,
        buffer: AnyArray,
        check: StatusCheck,
        unit: str,
    ) -> None:
        if not buffer.flags["C_CONTIGUOUS"]:
            raise ValueError("a buffer must be contiguous: its address is kept")
        self.function, self.variable, self.references = function, variable, references
        self.values, self.buffer, self.unit = values, buffer, unit
        #: The C function and what it is called with; the component comes first.
        self.call, self._check = call, check
        self.arguments: tuple[Any, ...] = component, ctypes.addressof(references), len(references), buffer.ctypes.data
        if function.startswith("fmi3") and not function.endswith("Clock"):
            self.arguments += (buffer.size,)

    def __call__(self) -> None:
        """Make the call; raises UnitError with the FMU's message if it is refused."""
        status = self.call(*self.arguments)
        if status > _WARNING:
            self._check(f"{self.function}({self.variable.variable.name})", status)


class ConvertingWriter(Access):
    """Sets values whose C type differs from the unit's (FMI 2.0: Boolean and Enumeration are C integers)."""

    is_direct = False

    def __call__(self) -> None:
        """Convert, then set."""
        np.copyto(self.buffer, self.values, casting="unsafe")
        super().__call__()


class ConvertingReader(Access):
    """Gets values whose C type differs from the unit's."""

    is_direct = False

    def __call__(self) -> None:
        """Get, then convert."""
        super().__call__()
        np.copyto(self.values, self.buffer, casting="unsafe")


class TextWriter(Access):
    """Sets text: `values` holds str, `buffer` the addresses of UTF-8 bytes."""

    is_direct = False

    def __call__(self) -> None:
        """Encode, then set; the FMU copies the text."""
        texts = [ctypes.create_string_buffer(str(v).encode()) for v in self.values.flat]
        self.buffer.flat[:] = [ctypes.addressof(t) for t in texts]
        super().__call__()


class TextReader(Access):
    """Gets text."""

    is_direct = False

    def __call__(self) -> None:
        """Get, then decode at once: the FMU may free its text at the next call."""
        super().__call__()
        for i, address in enumerate(self.buffer.flat):
            self.values.flat[i] = ctypes.string_at(int(address)).decode("utf-8", "replace") if address else ""


class _Binary(Access):
    is_direct = False

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self.sizes = np.zeros(self.buffer.size, dtype=np.uintp)
        component, references, count, pointers, size = self.arguments
        self.arguments = component, references, count, self.sizes.ctypes.data, pointers, size


class BinaryWriter(_Binary):
    """Sets binary data: `values` holds bytes, `buffer` their addresses, `sizes` their lengths."""

    def __call__(self) -> None:
        """Pass the addresses; the FMU copies the data."""
        data = [ctypes.create_string_buffer(bytes(v), max(len(v), 1)) for v in self.values.flat]
        self.buffer.flat[:] = [ctypes.addressof(d) for d in data]
        self.sizes[:] = [len(v) for v in self.values.flat]
        super().__call__()


class BinaryReader(_Binary):
    """Gets binary data."""

    def __call__(self) -> None:
        """Get, then copy at once: the FMU may free its data at the next call.

        Raises:
            UnitError: The FMU refuses, or says that there is more than anybody could hold.
        """
        super().__call__()
        if self.sizes.size and self.sizes.max() > MOST_BYTES:
            what = (
                f"{self.function}({self.variable.variable.name}) gives {self.sizes.max()} bytes, more than {MOST_BYTES}"
            )
            raise UnitError(self.unit, what, remedy="correct the FMU, or do not connect and record this variable")
        for i, address in enumerate(self.buffer.flat):
            self.values.flat[i] = ctypes.string_at(int(address), int(self.sizes[i])) if address else b""
