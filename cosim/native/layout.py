"""The structures of plan.h, for ctypes."""

from __future__ import annotations

import ctypes
from enum import IntEnum

from cosim.unit.protocol import VariableType

#: Changes with every change of the structures or of what is done with them; the library says for which one it was
#: compiled.
LAYOUT_VERSION = 4


class Code(IntEnum):
    """What an operation does."""

    COPY_DOUBLE = 0
    COPY_BYTES = 1
    CONVERT = 2
    WRITE_FMI2 = 3
    WRITE_FMI3 = 4
    READ_FMI2 = 5
    READ_FMI3 = 6
    STEP_FMI2 = 7
    STEP_FMI3 = 8
    COURSE_HELD = 9
    COURSE_LINEAR = 10
    PYTHON = 11


class Return(IntEnum):
    """Why the library came back."""

    REACHED = 0
    PAUSED = 1
    REFUSED = 2
    NOT_FINITE = 3
    FLAGGED = 4
    CALLED = 5


#: Element types by numpy's name, numbered as in plan.h.
ELEMENT_TYPES = {
    name: number
    for number, name in enumerate(
        ("float64", "float32", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64", "bool")
    )
}

#: Types of variables whose values the library can carry.
CARRIED = frozenset(t for t in VariableType if t.dtype.name in ELEMENT_TYPES)


class Operation(ctypes.Structure):
    """One step of a plan."""

    _fields_ = (
        ("code", ctypes.c_int32),
        ("unit", ctypes.c_int32),
        ("source_type", ctypes.c_int32),
        ("target_type", ctypes.c_int32),
        ("function", ctypes.c_void_p),
        ("component", ctypes.c_void_p),
        ("references", ctypes.c_void_p),
        ("reference_count", ctypes.c_size_t),
        ("target", ctypes.c_void_p),
        ("source", ctypes.c_void_p),
        ("held", ctypes.c_void_p),
        ("held_bytes", ctypes.c_size_t),
        ("count", ctypes.c_size_t),
        ("source_step", ctypes.c_size_t),
        ("factor", ctypes.c_double),
        ("offset", ctypes.c_double),
        ("points", ctypes.c_void_p),
        ("point_count", ctypes.c_size_t),
        ("flags", ctypes.c_void_p * 3),
        ("reached", ctypes.c_void_p),
        ("due", ctypes.c_void_p),
    )


class Recording(ctypes.Structure):
    """One recorded variable."""

    _fields_ = (("source", ctypes.c_void_p), ("rows", ctypes.c_void_p), ("bytes", ctypes.c_size_t))


class PlanLayout(ctypes.Structure):
    """All operations and recordings, the time grid, the wall times."""

    _fields_ = (
        ("operations", ctypes.POINTER(Operation)),
        ("step_count", ctypes.c_size_t),
        ("operation_count", ctypes.c_size_t),
        ("recordings", ctypes.POINTER(Recording)),
        ("recording_count", ctypes.c_size_t),
        ("per_record", ctypes.c_int64),
        ("start", ctypes.c_int64),
        ("size", ctypes.c_int64),
        ("wall_time", ctypes.c_void_p),
        ("sample", ctypes.c_void_p),
        ("units", ctypes.c_size_t),
    )


class Cursor(ctypes.Structure):
    """Where the run stands; on a failure, which operation and element."""

    _fields_ = (
        ("index", ctypes.c_int64),
        ("operation", ctypes.c_int64),
        ("element", ctypes.c_int64),
        ("status", ctypes.c_int32),
        ("reserved", ctypes.c_int32),
    )
