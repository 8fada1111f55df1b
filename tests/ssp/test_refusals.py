"""What an SSP asks for that is wrong, or that cannot be carried out: one error with file, line and remedy each."""

import re
import stat
import struct
import zipfile

import pytest

from cosim.ssp.import_time import TimeRequest
from cosim.ssp.importer import check_ssp, import_ssp
from cosim.unit.errors import InputError
from tests.ssp import packages as p
from tests.ssp.runs import STEP

TWO = p.feedthrough("a"), p.feedthrough("b")


def refused(path, folder, request=STEP):
    """The error of an import, which leaves nothing behind."""
    with pytest.raises(InputError) as caught:
        import_ssp(path, folder / "in", request)
    assert not (folder / "in").exists()
    assert caught.value.source == str(path)
    assert caught.value.remedy
    return caught.value


def root(*elements, **keywords):
    return p.description(p.system("root", *elements, **keywords))


def one(bound):
    return root(p.feedthrough("f", p.bindings(bound)))


MAP = (
    '<ssc:BooleanMappingTransformation><ssc:MapEntry source="true" target="false"/></ssc:BooleanMappingTransformation>'
)
REAL_TO_NOTHING = p.component("a", "feedthrough_fmi2.fmu", p.connector("x", "output"))


@pytest.mark.parametrize(
    ("ssd", "problem"),
    [
        ("<a>", r"this is no XML"),
        ("<a/>", r"the element is a, not ssd:SystemStructureDescription"),
        (p.description(p.system("root", *TWO), version="Draft20180219"), r"its version is `Draft20180219`"),
        (
            root(*TWO).replace("<ssd:Elements>", "<ssd:Parts>").replace("</ssd:Elements>", "</ssd:Parts>"),
            r"breaks the schema of SSP 1\.0: Element 'ssd:Parts'",
        ),
        (
            root(
                p.component("c", "chassis_fmi2.fmu", p.connector("z", "output", unit="blorb")),
                p.feedthrough("f"),
                connections=[p.connection("c.z", "f.u")],
            ),
            r"connector `z`: m cannot be converted to blorb",
        ),
        *(
            (
                p.description(p.system("root", *TWO), experiment=f'<ssd:DefaultExperiment stopTime="{time}"/>'),
                f"stopTime is `{time}`, which is no time",
            )
            for time in ("NaN", "INF")
        ),
        (root(p.system("empty")), r"there is no component in it"),
        (root(*TWO, connections=[p.connection("a.y", "c.u")]), r"there is no element `c`"),
        (root(*TWO, connections=[p.connection("a.z", "b.u")]), r"`a` has no connector `z`"),
        (root(*TWO, connections=[p.connection("a.y", "b.y")]), r"neither end can be the source"),
        (root(*TWO, connections=[p.connection("a.y", "b.u"), p.connection("b.y", "b.u")]), r"already leads into `b.u`"),
        (root(*TWO, connections=[p.connection("a.y", "b.u", MAP)]), r"do not carry out a BooleanMappingTransformation"),
        (root(REAL_TO_NOTHING), r"the FMU of `a` has no variable `x`"),
        (root(p.component("a", "feedthrough_fmi2.fmu", p.connector("y", "input"))), r"`y` of `a` is of kind input"),
        (root(*TWO, p.feedthrough("a")), r"two elements of one system are named `a`"),
        (root(p.component("a", "missing.fmu")), r"there is no file `resources/missing.fmu`"),
        (root(p.component("a", "../../etc/passwd")), r"leaves the package"),
        (root(p.component("a", "x").replace("resources/x", "file:///etc/passwd")), r"no relative reference"),
        (
            root('<ssd:Component name="a" type="text/x-modelica" source="resources/feedthrough_fmi2.fmu"/>'),
            r"`a` is of type text/x-modelica",
        ),
        (
            root('<ssd:Component name="a" source="resources/feedthrough_fmi2.fmu" implementation="ModelExchange"/>'),
            r"the FMU of `a` has no ModelExchange",
        ),
        (one('<ssd:ParameterBinding type="text/csv" source="resources/x.csv"/>'), r"the type `text/csv` is not read"),
        (one("<ssd:ParameterBinding/>"), r"neither a source nor content"),
        (one('<ssd:ParameterBinding sourceBase="component" source="x.ssv"/>'), r"lies inside a component"),
        (one(p.inline(p.parameter("gain", "1"), p.parameter("gain", "2"))), r"`gain` stands twice"),
        (one(p.inline(p.parameter("gain", "many"))), r"breaks the schema.*'many' is not a valid value"),
        (one(p.inline(p.parameter("gain", "INF"))), r"not a finite number"),
        (one(p.inline(p.parameter("gain", "true", "Boolean"))), r"`f.gain` is Real, the value is Boolean"),
        (one(p.inline(p.parameter("y", "1"))), r"`f.y` is output and calculated"),
        (
            root(
                p.component(
                    "c",
                    "chassis_fmi2.fmu",
                    bindings=p.bindings(p.inline(p.parameter("mass", "1", unit="s"), units=p.units("ssv", s={"s": 1}))),
                )
            ),
            r"s cannot be converted to kg",
        ),
        (
            one(
                p.inline(
                    p.parameter("a", "1"),
                    p.parameter("b", "1"),
                    mapping=p.mapping(p.entry("a", "gain"), p.entry("b", "gain")),
                )
            ),
            r"are mapped to `gain`",
        ),
        (one(p.inline(p.parameter("gain", "1", shape=(2,)), version="2.0")), r"has 1 values; its dimensions ask for 2"),
        (
            root(
                p.system(
                    "loop",
                    interface=[p.connector("i", "input"), p.connector("o", "output")],
                    connections=[p.connection("i", "o")],
                ),
                p.feedthrough("a"),
                connections=[p.connection("loop.o", "loop.i"), p.connection("loop.o", "a.u")],
            ),
            r"form a ring",
        ),
    ],
)
def test_each_fault_has_one_clear_error(pack, tmp_path, ssd, problem):
    error = refused(pack(ssd, fmus=("feedthrough_fmi2", "chassis_fmi2")), tmp_path)
    assert re.search(problem, error.problem), error.problem
    assert error.key.startswith("SystemStructure.ssd, line ")


def test_errors_name_the_line(pack, tmp_path):
    ssd = root(*TWO, connections=["\n\n", p.connection("a.z", "b.u")])
    line = next(i for i, text in enumerate(ssd.splitlines(), 1) if 'startConnector="z"' in text)
    assert refused(pack(ssd), tmp_path).key == f"SystemStructure.ssd, line {line}"


def test_errors_of_other_files_name_them(pack, tmp_path):
    bound = '<ssd:ParameterBinding source="resources/values.ssv"/>'
    wrong = p.parameter_set('\n<ssv:Parameter name="gain"/>', head=p.NAMESPACES)
    assert refused(pack(one(bound), values_ssv=wrong), tmp_path).key == "resources/values.ssv, line 2"


def test_entities_and_document_types_are_refused(pack, tmp_path):
    ssd = root(*TWO).replace("?>", '?><!DOCTYPE x [<!ENTITY a SYSTEM "file:///etc/passwd">]>', 1)
    assert "document type" in refused(pack(ssd), tmp_path).problem


def test_ssp_2_features_are_refused_in_a_file_of_version_1(pack, tmp_path):
    system = p.system("root", p.component("a", "feedthrough_fmi2.fmu", p.connector("u", "input", "Float64")))
    assert "Float64" in refused(pack(p.description(system)), tmp_path).problem
    assert check_ssp(pack(p.description(system, version="2.0")))[0].version == "2.0"


@pytest.mark.parametrize(
    ("request_", "missing"), [(TimeRequest(), "step size"), (TimeRequest(stop="1 s"), "step size")]
)
def test_a_missing_step_is_asked_for(pack, tmp_path, request_, missing):
    error = refused(pack(root(*TWO)), tmp_path, request_)
    assert missing in error.problem
    assert "`--step`" in error.remedy


def test_a_missing_stop_time_is_asked_for(pack, tmp_path):
    error = refused(pack(p.description(p.system("root", *TWO), experiment="")), tmp_path)
    assert "no stop time" in error.problem
    assert "`--stop`" in error.remedy


def zipped(path, **entries):
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in entries.items():
            archive.writestr(name, content)
    return path


def link():
    entry = zipfile.ZipInfo("resources/link")
    entry.external_attr = (stat.S_IFLNK | 0o777) << 16
    return entry


@pytest.mark.parametrize(
    ("entry", "problem"),
    [
        ("../outside", "outside"),
        ("/etc/outside", "outside"),
        ("a\\..\\..\\outside", "outside"),
        ("C:/outside", "outside"),
        (link(), "symbolic link"),
    ],
)
def test_archives_cannot_write_elsewhere(pack, tmp_path, entry, problem):
    path = pack(root(*TWO))
    with zipfile.ZipFile(path, "a") as archive:
        archive.writestr(entry, "x")
    assert problem in refused(path, tmp_path).problem


def test_an_archive_that_unpacks_to_too_much_is_refused(pack, tmp_path, monkeypatch):
    monkeypatch.setattr("cosim.fmu.extraction.MAXIMUM_UNPACKED_SIZE", 1 << 20)
    path = pack(root(*TWO), big_bin="0" * (1 << 21))
    assert "unpacks to" in refused(path, tmp_path).problem


def test_an_encrypted_entry_is_refused(pack, tmp_path):
    path = pack(root(*TWO), fmus=())
    content = bytearray(path.read_bytes())
    for signature, offset in ((b"PK\x01\x02", 8), (b"PK\x03\x04", 6)):
        at = content.index(signature) + offset
        content[at : at + 2] = struct.pack("<H", 1)
    path.write_bytes(content)
    assert "encrypted" in refused(path, tmp_path).problem


def test_what_is_no_ssp_is_refused(tmp_path):
    (tmp_path / "a.ssp").write_text("no zip")
    assert "this is not an SSP" in refused(tmp_path / "a.ssp", tmp_path).problem
    assert "no SystemStructure.ssd" in refused(zipped(tmp_path / "b.ssp", other="x"), tmp_path).problem
    assert "there is no such file" in refused(tmp_path / "c.ssp", tmp_path).problem


def test_a_folder_with_something_in_it_is_left_alone(pack, tmp_path):
    (tmp_path / "kept").write_text("mine")
    with pytest.raises(InputError, match="there is something here already"):
        import_ssp(pack(root(*TWO)), tmp_path, STEP)
    assert (tmp_path / "kept").read_text() == "mine"


def test_a_package_that_contains_itself_is_refused(pack, tmp_path):
    same = '<ssd:Component name="a" type="application/x-ssp-definition" source="#all"/>'
    ssd = p.description(p.system("root", same, attributes='id="all"'))
    assert "nested more than 20 deep" in refused(pack(ssd), tmp_path).problem


def test_prefixes_that_a_file_does_not_declare_are_taken_for_the_standards_with_a_note(pack, tmp_path):
    """ecos' example has such a parameter set."""
    bound = '<ssd:ParameterBinding source="resources/values.ssv"/>'
    values = p.parameter_set(p.parameter("gain", "4"))
    _, notes = check_ssp(pack(one(bound), values_ssv=values))
    assert any("resources/values.ssv: it uses prefixes that it does not declare" in note for note in notes)


OWN = '<ssd:Component name="own" type="application/vnd.active-chainmail.component+yaml" source="resources/own.yaml"/>'


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("{", "not valid YAML"),
        ("kind: hanging_mass", "`own` is no component"),
        ("{kind: fmu, fmu: /etc/passwd}", "is of kind fmu"),
        (
            "{kind: bullet_fabric, rows: 3, columns: 1, tether: {kind: hanging}, parameter_set: ../../etc/passwd}",
            "there is no parameter set `../../etc/passwd`",
        ),
    ],
)
def test_a_component_of_ours_is_checked_before_it_is_taken(pack, tmp_path, text, problem):
    assert problem in refused(pack(root(OWN), own_yaml=text), tmp_path).problem


def test_an_inner_package_that_is_none_is_named(pack, tmp_path):
    inner = '<ssd:Component name="a" type="application/x-ssp-package" source="resources/inner.ssp"/>'
    assert "resources/inner.ssp: this is not an SSP" in refused(pack(root(inner), inner_ssp="x"), tmp_path).problem


def test_signal_dictionaries_are_validated_too(pack, tmp_path):
    wrong = '<ssb:SignalDictionary version="1.0"><ssb:DictionaryEntry name="s"/></ssb:SignalDictionary>'
    listed = f'<ssd:SignalDictionary name="bus">{wrong}</ssd:SignalDictionary>'
    listed = f"<ssd:SignalDictionaries>{listed}</ssd:SignalDictionaries>"
    assert "Element 'ssb:DictionaryEntry'" in refused(pack(root(*TWO, dictionaries=listed)), tmp_path).problem
