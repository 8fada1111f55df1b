"""CSV files: numbers read back unchanged, and the native writer gives the bytes of the one in Python."""

from __future__ import annotations

import csv
import io

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from cosim.native import csv_file
from cosim.native.csv_file import CsvColumn, CsvWriter, write_csv
from cosim.native.layout import ELEMENT_TYPES
from cosim.native.trace_csv import write_trace
from cosim.observers.trace import Trace
from cosim.system import System
from tests.native.both_loops import fmu

RNG = np.random.default_rng(20)


def written(times, columns, is_native=True, pieces=1):
    """The file's bytes."""
    file = io.BytesIO()
    writer = CsvWriter(file, times, columns)
    if is_native:
        assert writer._native is not None, "build the library: pip install -e ."
    else:
        writer._native = None
    for stop in np.linspace(0, len(times), pieces + 1).astype(int)[1:]:
        writer.write(int(stop))
    return file.getvalue()


def lines_of(values):
    """One column of doubles as text."""
    values = np.asarray(values, dtype=np.float64)
    return written(values, []).decode().splitlines()[1:]


def test_doubles_of_every_exponent_are_written_as_repr_writes_them():
    """Powers of two, where the neighbours are at different distances, and the three doubles on either side."""
    powers = np.arange(2047, dtype=np.uint64) << np.uint64(52)
    bits = np.concatenate([powers + np.uint64(i) for i in range(4)] + [powers[1:] - np.uint64(i) for i in range(1, 4)])
    values = bits.view(np.float64)
    assert len(values) == 14326
    assert lines_of(values) == list(map(repr, values.tolist()))


def test_random_bits_subnormals_and_short_decimals_are_written_as_repr_writes_them():
    values = np.concatenate(
        [
            RNG.integers(0, 2**64, 60_000, dtype=np.uint64).view(np.float64),
            RNG.integers(0, 2**52, 20_000, dtype=np.uint64).view(np.float64),
            RNG.integers(-(10**7), 10**7, 20_000) / 1000,
            [float(f"{d}e{k}") for k in range(-323, 309) for d in (1, 5, 9)],
        ]
    )
    assert lines_of(values) == list(map(repr, values.tolist()))


@settings(deadline=None)  # a busy machine is no error
@given(st.floats())
@example(5e-324)
@example(1.7976931348623157e308)
@example(-0.0)
@example(1e16)
@example(9999999999999998.0)
@example(9007199254740993.0)
@example(1e-4)
@example(9.999e-5)
@example(float("nan"))
@example(float("-inf"))
def test_any_double_reads_back_to_the_same_bits(value):
    (text,) = lines_of([value])
    assert text == repr(value)
    if value == value:  # a NaN's payload is not kept
        assert np.float64(text).tobytes() == np.float64(value).tobytes()


def table():
    """Every type that the library writes, scalars and arrays."""
    rows = 3000
    columns = [
        CsvColumn("unit.temperature", "K", 1e3 * RNG.normal(size=(rows, 3))),
        CsvColumn("unit.x", "m", RNG.normal(size=(rows, 2, 2)), first_index=0),
        CsvColumn("unit.on", "1", RNG.random((rows, 2)) < 0.5),
    ]
    for name in ELEMENT_TYPES:
        if name.startswith(("int", "uint")):
            limits = np.iinfo(name)
            values = RNG.integers(limits.min, limits.max, rows, dtype=name, endpoint=True)
            values[:2] = limits.min, limits.max
            columns.append(CsvColumn(f"n.{name}", "1", values))
    columns.append(CsvColumn("n.single", "m", RNG.normal(size=rows).astype(np.float32)))
    return 1e-3 * np.arange(rows), columns


@pytest.mark.parametrize("pieces", [1, 7])
def test_native_and_python_writer_give_the_same_bytes(pieces, monkeypatch):
    monkeypatch.setattr(csv_file, "PIECE", 10_000)  # many pieces in the library too
    times, columns = table()
    assert written(times, columns, pieces=pieces) == written(times, columns, is_native=False)


def test_headings_name_component_variable_element_and_unit():
    times, columns = table()
    first = next(csv.reader(io.StringIO(written(times, columns).decode())))
    assert first[:5] == [
        "time [s]",
        "unit.temperature[1] [K]",
        "unit.temperature[2] [K]",
        "unit.temperature[3] [K]",
        "unit.x[0,0] [m]",
    ]
    assert len(first) == 1 + 3 + 4 + 2 + 8 + 1


def test_values_read_back_from_the_file(tmp_path):
    times, columns = table()
    write_csv(tmp_path / "run.csv", times, columns)
    rows = list(csv.reader((tmp_path / "run.csv").read_text().splitlines()))[1:]
    read = np.array([[float(text) for text in row[:8]] for row in rows])
    assert read[:, 0].tobytes() == times.tobytes()
    assert read[:, 1:4].tobytes() == columns[0].values.tobytes()
    assert read[:, 4:8].tobytes() == columns[1].values.reshape(-1, 4).tobytes()
    assert [int(row[-2]) for row in rows[:2]] == [0, 2**64 - 1]


def test_text_is_quoted_and_only_the_rows_asked_for_are_written():
    texts = np.array(["plain", 'a "quoted", one', "never"], dtype=object)
    file = io.BytesIO()
    CsvWriter(file, np.array([0.0, 0.5, 1.0]), [CsvColumn("unit.mode", "1", texts)]).write(2)
    assert file.getvalue() == b'time [s],unit.mode [1]\n0.0,plain\n0.5,"a ""quoted"", one"\n'


def test_a_trace_of_every_type_is_written(scripted, tmp_path):
    system = System({"a": fmu("a", scripted[2], rate=2.0)}, [])
    system.initialise(0, {})
    trace = Trace(system, range(0, 3_000_000, 1_000_000))
    trace.record(0)
    system.step("a", 0, 1_000_000)
    trace.record(1_000_000)
    system.terminate()
    write_trace(tmp_path / "run.csv", trace)
    first, *rows = csv.reader((tmp_path / "run.csv").read_text().splitlines())
    assert set(first) == {
        "time [s]",
        "a.y [1]",
        "a.yf [1]",
        "a.yi [1]",
        "a.yb [1]",
        "a.z [1]",
        "a.ya[1] [1]",
        "a.ya[2] [1]",
        "a.ya[3] [1]",
    }
    assert len(rows) == 2
    last = dict(zip(first, rows[1]))
    assert (last["time [s]"], last["a.yi [1]"], last["a.yb [1]"], last["a.yf [1]"]) == (
        "0.001",
        "7",
        "0",
        repr(float(np.float32(0.1))),
    )
