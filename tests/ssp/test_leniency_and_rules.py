"""What other tools let pass is read with a note; what breaks a rule of SSP 2.0 is refused in words, whatever it is."""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import Any

import pytest
from lxml import etree
from typer.testing import CliRunner

from cosim.cli import app
from cosim.run import run
from cosim.scenario import load_scenario
from cosim.ssp.importer import check_ssp, import_ssp
from cosim.ssp.schemas import named_schemas, schema
from cosim.unit.errors import InputError
from tests.fmi.fmi_models import described
from tests.ssp import packages as p
from tests.ssp.runs import STEP

INSIDE = p.feedthrough(
    "f",
    p.bindings(
        p.inline(
            p.parameter("gain", "2.5", "Float64", unit="mm/m"),
            version="2.0",
            units=p.units("ssv", **{"mm/m": {"factor": 1e-3}}),
        )
    ),
)
WHOLE = p.description(
    p.system(
        "root",
        INSIDE,
        p.feedthrough("g"),
        connections=[p.connection("f.y", "g.u", p.linear(2, 1), suppressUnitConversion="true")],
    ),
    version="2.0",
)


def replaced_fmu(package: Path, fmu: Path) -> Path:
    """The package with another FMU in place of its own."""
    target = package.with_name("other.ssp")
    with zipfile.ZipFile(package) as source, zipfile.ZipFile(target, "w") as into:
        for name in source.namelist():
            into.writestr(name, fmu.read_bytes() if name.endswith(".fmu") else source.read(name))
    return target


def test_an_fmu_whose_description_is_only_warned_of_is_imported_and_runs(pack: Any, tmp_path: Path) -> None:
    package = pack(p.description(p.system("root", p.feedthrough("f"))))
    with zipfile.ZipFile(package) as archive:
        (tmp_path / "plain.fmu").write_bytes(archive.read("resources/feedthrough_fmi2.fmu"))
    sloppy = described(tmp_path / "plain.fmu", tmp_path / "sloppy.fmu", '<Real unit="1"', '<Real unit="blorb"')
    imported = import_ssp(replaced_fmu(package, sloppy), tmp_path / "in", STEP)
    assert run(load_scenario(imported.scenario)).sizes["time"] > 1


def test_a_prefix_of_another_author_that_is_not_declared_is_passed_over_with_a_note(pack: Any, tmp_path: Path) -> None:
    note = '<ssd:Annotations><ssc:Annotation type="acme"><acme:Colour acme:of="f">red</acme:Colour></ssc:Annotation>'
    root = p.system("root", p.feedthrough("f")).replace("</ssd:System>", f"{note}</ssd:Annotations></ssd:System>")
    imported = import_ssp(pack(p.description(root)), tmp_path / "in", STEP)
    assert any("does not declare the prefix `acme`" in text for text in imported.notes)


def test_two_prefixes_of_others_are_both_passed_over(pack: Any, tmp_path: Path) -> None:
    note = '<ssd:Annotations><ssc:Annotation type="acme"><a:B><c:D/></a:B></ssc:Annotation></ssd:Annotations>'
    root = p.system("root", p.feedthrough("f")).replace("</ssd:System>", f"{note}</ssd:System>")
    assert len(import_ssp(pack(p.description(root)), tmp_path / "in", STEP).notes) >= 2


def mutations() -> list[tuple[str, str]]:
    """The description with one attribute left out, spoilt or added, or one element left out, doubled or renamed."""
    found: list[tuple[str, str]] = []
    count = len(list(etree.fromstring(WHOLE.encode()).iter()))
    for index in range(count):
        keys = list(list(etree.fromstring(WHOLE.encode()).iter())[index].attrib)
        deeds = [
            *(("drop", k) for k in keys),
            *(("spoil", k) for k in keys),
            ("add", ""),
            ("remove", ""),
            ("double", ""),
            ("rename", ""),
        ]
        for deed, key in deeds:
            root = etree.fromstring(WHOLE.encode())
            element = list(root.iter())[index]
            label = f"{deed} {etree.QName(element).localname} {key}"
            if deed == "drop":
                del element.attrib[key]
            elif deed == "spoil":
                element.set(key, "\N{GREEK SMALL LETTER PI} not this")
            elif deed == "add":
                element.set("unheard", "of")
            elif deed == "rename":
                element.tag = etree.QName(element).namespace and f"{{{etree.QName(element).namespace}}}Unheard"
            elif element.getparent() is None:
                continue
            elif deed == "remove":
                element.getparent().remove(element)
            else:
                element.addnext(etree.fromstring(etree.tostring(element)))
            found.append((label, etree.tostring(root, encoding="unicode")))
    return found


def refusal(package: Path) -> InputError | None:
    try:
        check_ssp(package)
    except InputError as error:
        return error
    return None


def test_the_unspoilt_description_is_read(pack: Any) -> None:
    assert check_ssp(pack(WHOLE))[0].version == "2.0"


def test_no_mutation_of_a_description_ends_in_anything_but_an_answer_or_one_error(pack: Any) -> None:
    errors = {label: error for label, text in mutations() if (error := refusal(pack(text))) is not None}
    assert all(error.remedy for error in errors.values())
    assert [label for label, _ in mutations() if label.startswith(("add ", "rename ")) and label not in errors] == []
    assert len(errors) > 80


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('startConnector="y" ', "", "ssd:Connection breaks the rules of SSP 2.0: it has no attribute `startConnector`"),
        ('kind="input"', 'kind="entrance"', "its attribute `kind` is `entrance`, which is not a valid value"),
        ("<ssd:Connections>", "<ssd:Connections><ssd:Wire/>", "it holds ssd:Wire, which does not belong there"),
        ('value="2.5"', 'value="many"', "its attribute `value` is `many`"),
        ('factor="2"', 'factr="2"', "it has an attribute `factr`, which does not belong there"),
    ],
)
def test_rules_of_2_name_element_and_fault(pack: Any, old: str, new: str, message: str) -> None:
    assert old in WHOLE
    with pytest.raises(InputError) as caught:
        check_ssp(pack(WHOLE.replace(old, new, 1)))
    assert message in caught.value.problem
    assert "line" in caught.value.key


def test_a_schema_that_the_user_names_is_applied_to_2(pack: Any, tmp_path: Path) -> None:
    strict = """<xs:schema xmlns:xs="http://www.w3.org/2001/XMLSchema"
        targetNamespace="http://ssp-standard.org/SSP1/SystemStructureDescription"/>"""
    (tmp_path / "SystemStructureDescription.xsd").write_text(strict)
    with named_schemas(tmp_path), pytest.raises(InputError, match=r"breaks the schema of SSP 2\.0"):
        check_ssp(pack(WHOLE))
    assert schema("SystemStructureDescription", "2.0") is None
    found = CliRunner().invoke(app, ["ssp", "validate", str(pack(WHOLE)), "--schema", str(tmp_path / "nowhere")])
    assert isinstance(found.exception, InputError)
    assert "there is no SystemStructureDescription.xsd in it" in str(found.exception)


@pytest.mark.parametrize("given", ["ScheduledExecution", "ModelExchange"])
def test_an_interface_that_is_not_there_names_those_that_are(pack: Any, given: str) -> None:
    component = f'<ssd:Component name="a" source="resources/feedthrough_fmi2.fmu" implementation="{given}"/>'
    with pytest.raises(InputError) as caught:
        check_ssp(pack(p.description(p.system("root", component), version="2.0")))
    assert "ask for CoSimulation, which it has" in caught.value.remedy
