"""Tables with other marks between columns than commas, as they stand in a recording's folder."""

import numpy as np
import pytest

from cosim.unit.errors import InputError
from diagnosis.recording.table import Table

WANTED = {"time_s", "T, left", "T2"}
TIMES, LEFT, RIGHT = [0.0, 0.5, 1.0], [20.5, np.nan, -1500.0], [21.0, 22.25, 23.0]


def saved(tmp_path, text):
    file = tmp_path / "data.csv"
    file.write_text(text, encoding="utf-8")
    return file


@pytest.mark.parametrize(
    "text",
    [
        'time_s,"T, left",T2\n0,20.5,21\n0.5,,22.25\n1,-1.5e3,23\n',
        "time_s;T, left;T2\n0;20,5;21\n0,5;;22,25\n1;-1,5e3;23\n",
        "time_s;T, left;T2\n0;20.5;21\n0.5;;22.25\n1;-1.5e3;23\n",
        "time_s\tT, left\tT2\n0\t20,5\t21\n0,5\t\t22,25\n1\t-1,5e3\t23\n",
        "time_s;T, left;T2;\n0;20,5;21;\n0,5;;22,25;\n1;-1,5e3;23;\n",
        "time_s;note;T, left;T2\n0;a.b, c;20,5;21\n0,5;v1.2;;22,25\n1;3.5;-1,5e3;23\n",
    ],
)
def test_each_mark_gives_the_same_numbers(tmp_path, text):
    """The last one has a column with points that nobody asks for."""
    table = Table(saved(tmp_path, text), wanted=WANTED)
    for name, values in (("time_s", TIMES), ("T, left", LEFT), ("T2", RIGHT)):
        np.testing.assert_array_equal(table.column(name, "channels"), values)


def test_lines_before_the_header_have_marks_of_their_own(tmp_path):
    table = Table(saved(tmp_path, "logger 7, room 3\ntime_s;T2\n0;1,5\n"), 1, WANTED)
    assert table.column("T2", "channels").tolist() == [1.5]


def test_both_decimal_signs_in_one_table_are_refused(tmp_path):
    """1.234 may be a thousand there."""
    file = saved(tmp_path, "time_s;T2\n0;20,5\n1;1.234\n")
    with pytest.raises(InputError, match=r"decimal commas \(`20,5`\) and decimal points \(`1.234`\)"):
        Table(file, wanted=WANTED)


def test_a_mark_between_thousands_is_refused(tmp_path):
    table = Table(saved(tmp_path, "time_s;T2\n0;1.234,5\n"), wanted=WANTED)
    with pytest.raises(InputError, match="without a mark between thousands"):
        table.column("T2", "channels.x.column")


def test_a_column_that_is_not_there_is_named_with_those_that_are(tmp_path):
    table = Table(saved(tmp_path, "Zeit;T1\n0;1,5\n1;2\n"), wanted=WANTED)
    with pytest.raises(InputError, match=r"no column `T2`\n.*there are: Zeit, T1"):
        table.column("T2", "channels.x.column")


def test_a_row_with_more_values_than_names_is_refused(tmp_path):
    with pytest.raises(InputError, match="line 3: it has 3 values under 2 column names"):
        Table(saved(tmp_path, "time_s;T2\n0;1,5\n1;2;7\n"), wanted=WANTED)


def test_a_column_that_stands_twice_is_refused(tmp_path):
    with pytest.raises(InputError, match="the column `T2` is there 2 times"):
        Table(saved(tmp_path, "time_s;T2;T2\n0;1,5;3\n1;2;7\n"), wanted=WANTED)
