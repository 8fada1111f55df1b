"""Courses of a programme as operations."""

from __future__ import annotations

import numpy as np

from cosim.native.action import Call
from cosim.native.layout import Code, Operation
from cosim.programme import Course
from cosim.unit.protocol import AnyArray


def course_call(course: Course, target: AnyArray, unit: int) -> tuple[Call, AnyArray, AnyArray]:
    """Evaluate a course at the begin of each macro-step, or at its middle where it is linear.

    Args:
        course: What is given over time.
        target: Live array of the output.
        unit: Whose wall time it counts for.

    Returns:
        The call, and the arrays that must live as long as it.
    """
    points = np.array(course.times, dtype=np.int64)
    values = np.ascontiguousarray(course.values, dtype=np.float64)
    operation = Operation(
        code=Code.COURSE_LINEAR if course.is_linear else Code.COURSE_HELD,
        unit=unit,
        target=target.ctypes.data,
        source=values.ctypes.data,
        count=target.size,
        points=points.ctypes.data,
        point_count=len(points),
    )
    return Call(operation), points, values
