"""docs/candidates.md is what the registry says, and explains every hook and name."""

from pathlib import Path

from diagnosis.candidates.candidate import HOOK_AXES
from diagnosis.candidates.document import markdown
from diagnosis.candidates.hooks import HOOKS, NAMES
from diagnosis.candidates.registry import catalogue
from diagnosis.models.coil_network.kernel.source import READABLE, WRITABLE

PAGE = Path(__file__).resolve().parents[2] / "docs" / "candidates.md"


def test_the_page_is_up_to_date():
    assert PAGE.read_text() == markdown(), "run `python -m diagnosis.candidates.document > docs/candidates.md`"


def section(identifier):
    """What the page says of one candidate."""
    (text,) = (part for part in PAGE.read_text().split("\n### ") if f"\n`{identifier}` ·" in part)
    return text


def test_a_person_finds_bounds_reason_and_starts_of_a_parameter():
    """Facts of the effects themselves: a sensor follows, it does not foresee; a surface that cools stays one."""
    share = next(line for line in section("insulation_when_off").splitlines() if line.startswith("- `share`"))
    assert share.startswith(
        "- `share` [1], share of the heat transfer (h A) that is held back while the power is off; 0 to 0.95: "
        "heat transfer stays positive; believed up to 0.8: a fan that"
    )
    assert "tried from 0.037, 0.126, 0.433; below 0.02 it is no finding" in share
    assert "- `lag_time` [s], time constant of the sensor; 0 to 60: a sensor follows, it does not foresee;" in section(
        "sensor_lag"
    )
    assert (
        "`C2` [J/K], heat capacity of the second mass; 0.001 to 100: a heat capacity is positive; "
        "believed up to 30 times the coil's heat capacity"
    ) in section("second_mass")
    assert "- `other` [1]: given with the place" in section("wrong_identity")
    assert "- needs one of: current, voltage, power, resistance" in section("shared_supply_droop")
    assert "- needs at least 2 coils or heaters" in section("shared_supply_droop")


def test_every_parameter_that_is_fitted_has_its_bounds_on_the_page():
    lines = PAGE.read_text().splitlines()
    for term in catalogue():
        for p in term.parameters if term.is_named else ():
            if not (p.is_fixed or p.is_instant):
                begin = f"- `{p.name}` [{p.unit}], {p.meaning}; {p.lower:g} to {p.upper:g}: {p.reason}; believed up to "
                assert any(line.startswith(begin) for line in lines), begin


def test_the_page_names_every_candidate():
    page = PAGE.read_text()
    missing = [t.identifier for t in catalogue() if t.identifier.removeprefix("unnamed_").split("_", 1)[-1] not in page]
    assert missing == []
    assert page.count("\n### ") == sum(t.is_named for t in catalogue())


def test_every_hook_and_every_name_of_the_network_is_explained():
    assert set(HOOKS) == set(HOOK_AXES)
    offered = set(READABLE) | {name for names in WRITABLE.values() for name in names} | {"t", "t_begin", "t_end", "dt"}
    assert set(NAMES) == offered
