"""Names of columns as laboratories write them: quantity and unit."""

import pytest

from diagnosis.check.heading import heading


@pytest.mark.parametrize(
    ("name", "body", "unit", "si_unit"),
    [
        ("p_bag/kPa", "p_bag", "kPa", "Pa"),
        ("n/(1/min)", "n", "1/min", "1/min"),
        ("i_d/A", "i_d", "A", "A"),
        ("Druck [mbar]", "Druck", "mbar", "Pa"),
        ("v in mm/s", "v", "mm/s", "m/s"),
        ("Q (L/min)", "Q", "L/min", "m^3/s"),
        ("Drehzahl [U/min]", "Drehzahl", "rpm", "rad/s"),
        ("opto_mm", "opto", "mm", "m"),
        ("valve_%", "valve", "%", "1"),
        ("T1 (C)", "T1", "degC", "K"),
        ("dose [mg/L]", "dose", "mg/L", "kg/m^3"),
        ("on/off", "on/off", None, None),
        ("in/out", "in/out", None, None),
        ("Conc", "Conc", None, None),
        ("flag [raw]", "flag", None, None),
        ("x [M]", "x", None, None),
    ],
)
def test_a_name_is_divided_into_quantity_and_unit(name: str, body: str, unit: str | None, si_unit: str | None) -> None:
    found = heading(name)
    assert (found.body, found.unit, found.si_unit) == (body, unit, si_unit)
