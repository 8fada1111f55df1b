"""The structures of system.c, for ctypes."""

from __future__ import annotations

import ctypes
from enum import IntEnum

#: States of its own that a law may have.
MOST_OWN = 2
#: Delayed inputs that a law may have.
MOST_DELAYS = 2
#: Vectors of the length of all states that a unit needs: the states, and room for the integration.
ROOM = 7


class Code(IntEnum):
    """What an operation does."""

    COPY = 0
    PUT = 1
    GET = 2
    STEP = 3


class Kind(IntEnum):
    """What a law is added to."""

    RATE = 0
    INPUT = 1
    OUTPUT = 2
    SHARE = 3
    PARAMETER = 4


class AccessLayout(ctypes.Structure):
    """One set or get call."""

    _fields_ = (
        ("call", ctypes.c_void_p),
        ("references", ctypes.c_void_p),
        ("reference_count", ctypes.c_size_t),
        ("values", ctypes.c_void_p),
        ("count", ctypes.c_size_t),
    )


class CopyLayout(ctypes.Structure):
    """One number carried from one place to another."""

    _fields_ = (
        ("to", ctypes.c_void_p),
        ("source", ctypes.c_void_p),
        ("factor", ctypes.c_double),
        ("offset", ctypes.c_double),
    )


class DelayLayout(ctypes.Structure):
    """An input as it was some time ago."""

    _fields_ = (
        ("input", ctypes.c_int64),
        ("by", ctypes.c_void_p),
        ("factor", ctypes.c_double),
        ("offset", ctypes.c_double),
        ("history", ctypes.c_void_p),
        ("jump", ctypes.c_double),
        ("before", ctypes.c_double),
        ("after", ctypes.c_double),
    )


class MovedLayout(ctypes.Structure):
    """An instance with another value of a parameter."""

    _fields_ = (
        ("component", ctypes.c_void_p),
        ("held", ctypes.c_void_p),
        ("values", ctypes.c_void_p),
    )


class AddedLayout(ctypes.Structure):
    """A law that is added."""

    _fields_ = (
        ("kind", ctypes.c_int64),
        ("target", ctypes.c_int64),
        ("scale", ctypes.c_double),
        ("amount", ctypes.c_void_p),
        ("values", ctypes.c_void_p),
        ("own", ctypes.c_int64),
        ("first", ctypes.c_int64),
        ("rates", ctypes.c_void_p * MOST_OWN),
        ("starts", ctypes.c_void_p * MOST_OWN),
        ("output", ctypes.c_void_p),
        ("delay_count", ctypes.c_int64),
        ("delays", ctypes.c_void_p),
        ("delayed", ctypes.c_void_p),
        ("moved", ctypes.c_void_p),
    )


class UnitLayout(ctypes.Structure):
    """One FMU."""

    _fields_ = (
        ("component", ctypes.c_void_p),
        *((n, ctypes.c_int64) for n in ("is_fmi3", "is_model_exchange", "reports_steps", "substeps")),
        *((n, ctypes.c_int64) for n in ("states", "indicators", "inputs", "own")),
        *((n, ctypes.c_void_p) for n in ("set_time", "set_states", "get_states", "get_derivatives", "get_indicators")),
        *((n, ctypes.c_void_p) for n in ("completed", "enter_event_mode", "update")),
        *((n, ctypes.c_void_p) for n in ("enter_continuous_mode", "do_step")),
        *((n, ctypes.c_void_p) for n in ("state", "signs", "outer", "inner", "held")),
        ("writers", ctypes.c_void_p),
        ("writer_count", ctypes.c_int64),
        ("readers", ctypes.c_void_p),
        ("reader_count", ctypes.c_int64),
        ("environment", ctypes.c_void_p),
        ("known", ctypes.c_void_p),
        ("known_count", ctypes.c_int64),
        ("seen", ctypes.c_void_p),
        ("added", ctypes.c_void_p),
        ("added_count", ctypes.c_int64),
        ("next_event", ctypes.c_double),
        ("has_inputs_added", ctypes.c_int64),
        ("own_outputs", ctypes.c_void_p),
        ("own_output_count", ctypes.c_int64),
        ("has_delays", ctypes.c_int64),
        ("step", ctypes.c_int64),
        ("has_outputs_added", ctypes.c_int64),
        ("has_parameters_added", ctypes.c_int64),
    )


class OperationLayout(ctypes.Structure):
    """One step of the order in which things happen."""

    _fields_ = (("code", ctypes.c_int64), ("first", ctypes.c_int64), ("last", ctypes.c_int64))


class SampledLayout(ctypes.Structure):
    """A programme with its value in every macro-step."""

    _fields_ = (("to", ctypes.c_void_p), ("column", ctypes.c_void_p))


class SystemLayout(ctypes.Structure):
    """All units, the order, the time grid and what is recorded."""

    _fields_ = (
        ("units", ctypes.c_void_p),
        ("unit_count", ctypes.c_int64),
        ("copies", ctypes.c_void_p),
        ("settle", ctypes.c_void_p),
        ("settle_count", ctypes.c_int64),
        ("operations", ctypes.c_void_p),
        ("operation_count", ctypes.c_int64),
        ("programmes", ctypes.c_void_p),
        ("programme_count", ctypes.c_int64),
        ("recorded", ctypes.c_void_p),
        ("recorded_count", ctypes.c_int64),
        ("rows", ctypes.c_void_p),
        *((n, ctypes.c_int64) for n in ("steps", "per_output", "start", "size")),
    )
