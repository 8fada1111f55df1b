"""Drawn systems and programmes: both loops agree to the last bit, whatever is connected and whatever fails."""

from __future__ import annotations

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cosim.connection import Connection
from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.unit import FmuSettings
from cosim.programme import ProgrammeUnit
from cosim.system import System
from tests.native.both_loops import Course, compare, fmu, linear
from tests.native.scripted_fmu import Fault

MS = 1_000_000


@given(
    points=st.lists(
        st.tuples(st.integers(-(2**40), 2**40), st.floats(-1e9, 1e9)), min_size=2, max_size=6, unique_by=lambda p: p[0]
    ),
    size=st.integers(1, 2**36),
    start=st.integers(-(2**40), 2**40),
)
@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_any_linear_course_has_the_bits_of_numpy(scripted, points, size, start):
    times, values = zip(*sorted(points))

    def make():
        units = {"given": ProgrammeUnit("given", {"y": linear(times, values)}), "first": fmu("first", scripted[2])}
        return System(units, [Connection(("given", "y"), ("first", "u"))], frozenset({"given"}))

    native = compare(make, Course("gauss_seidel", start, size, steps=12))
    assert native.index == 12


ENDS = ["u", "ua", "ua[0]", "ua[2]", "uf", "ui", "ub"]
WIRES = st.tuples(
    st.sampled_from(["y", "z", "ya", "ya[1]", "yf", "yi", "yb"]),
    st.sampled_from(ENDS),
    st.integers(0, 3),
    st.integers(0, 3),
    st.sampled_from([(1.0, 0.0), (0.5, 0.0), (-0.7, 0.3), (1.0, 1e-3)]),
)


def _end(text):
    name, _, rest = text.partition("[")
    return name, (int(rest[:-1]),) if rest else None


def _wires(system_units, drawn):
    """The drawn connections that fit the system, one into each input."""
    wires, taken = [], set()
    for output, target, source, into, (factor, offset) in drawn:
        names = list(system_units)
        source_name, into_name = names[source % len(names)], names[into % len(names)]
        (left, left_element), (right, right_element) = _end(output), _end(target)
        if source_name == into_name or (into_name, right) in taken:
            continue
        wire = Connection((source_name, left), (into_name, right), factor, offset, left_element, right_element)
        try:
            System(system_units, [*wires, wire])
        except ValueError:  # types or shapes do not fit, or an algebraic loop of values that cannot be solved for
            continue
        wires.append(wire)
        taken.add((into_name, right))
    return wires


@given(
    versions=st.lists(st.sampled_from([2, 3]), min_size=1, max_size=4),
    drawn=st.lists(WIRES, max_size=12),
    kind=st.sampled_from(["jacobi", "gauss_seidel"]),
    fault=st.sampled_from(list(Fault)),
    per_record=st.integers(1, 4),
    start=st.integers(-3, 3),
    hand_over=st.sampled_from([0, 0, 3]),
)
@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_any_system_of_scripted_fmus(scripted, versions, drawn, kind, fault, per_record, start, hand_over):
    def make():
        units = {}
        for i, version in enumerate(versions):  # the last one fails
            parameters = {"rate": 1.0 + i, "gain": 0.5, "moment": start + 0.035}
            parameters["kind"] = float(fault if i == len(versions) - 1 else Fault.NONE)
            values = {"u": 0.7 + i, "ua": [0.1, -0.2, 0.3], "uf": 0.4, "ui": 3 + i}
            archive = open_fmu(scripted[version])
            units[f"u{i}"] = CoSimulationUnit(f"u{i}", archive, FmuSettings(parameters=parameters, start=values))
        return System(units, _wires(units, drawn))

    compare(make, Course(kind, start * 10**9, 5 * MS, 12, per_record), hand_over)
