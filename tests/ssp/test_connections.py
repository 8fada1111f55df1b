"""Connections of an SSP: units, transformations, nested systems, signal dictionaries, arrays.

Every expected number is computed by hand from the standard; the chains are y = gain u + offset, so there is no error
but rounding of one product and one sum (1e-15 relative).
"""

import zipfile

import pytest

from cosim.run import run
from cosim.scenario import load_scenario
from cosim.ssp.importer import import_ssp
from tests.ssp import packages as p
from tests.ssp.runs import STEP, final, imported

LENGTHS = p.units("ssd", m={"m": 1}, mm={"m": 1, "factor": 0.001}, C={"K": 1, "offset": 273.15}, K={"K": 1})
THREE = p.bindings(p.inline(p.parameter("u", "3")))


def chain(inner="", after=LENGTHS, u="", y="", **attributes):
    """first.y = 3 goes to second.u."""
    return p.description(
        p.system(
            "root",
            p.feedthrough("first", THREE, y=y),
            p.feedthrough("second", u=u),
            connections=[p.connection("first.y", "second.u", inner, **attributes)],
        ),
        after=after,
    )


@pytest.mark.parametrize(
    ("ssd", "expected"),
    [
        (chain(), 3.0),
        (chain(p.linear(2, 0.5)), 6.5),
        (chain(y="mm", u="m"), 0.003),
        (chain(p.linear(2, 0.5), y="mm", u="m"), 0.506),  # units first, then the transformation
        (chain(p.linear(2, 0.5), y="mm", u="m", suppressUnitConversion="true"), 6.5),
        (chain(y="mm", u="m", suppressUnitConversion="1"), 3.0),
        (chain(y="C", u="K"), 276.15),
    ],
)
def test_units_are_converted_before_the_linear_transformation_unless_suppressed(pack, tmp_path, ssd, expected):
    assert final(pack(ssd), tmp_path / "in", "second.y") == [pytest.approx(expected, rel=1e-15)]


def test_the_direction_follows_from_the_connectors_and_not_from_start_and_end(pack, tmp_path):
    ssd = p.description(
        p.system(
            "root",
            p.feedthrough("first", THREE),
            p.feedthrough("second"),
            connections=[p.connection("second.u", "first.y", p.linear(2, 1))],
        )
    )
    assert final(pack(ssd), tmp_path / "in", "second.y") == [7.0]


def nested(**inner):
    """first -> outer.in -> inner.in -> second -> inner.out -> outer.out -> third, transformed on the way."""
    interface = p.connector("in", "input", **inner), p.connector("out", "output", **inner)
    deep = p.system(
        "inner",
        p.feedthrough("second"),
        interface=interface,
        connections=[p.connection("in", "second.u", p.linear(2, 0)), p.connection("second.y", "out")],
    )
    outer = p.system(
        "outer",
        deep,
        interface=interface,
        connections=[p.connection("in", "inner.in", p.linear(1, 1)), p.connection("inner.out", "out", p.linear(10, 0))],
    )
    return p.description(
        p.system(
            "root",
            p.feedthrough("first", THREE),
            outer,
            p.feedthrough("third"),
            connections=[p.connection("first.y", "outer.in"), p.connection("outer.out", "third.u", p.linear(1, -5))],
        ),
        after=LENGTHS,
    )


def test_nested_systems_become_components_named_by_their_path(pack, tmp_path):
    path = pack(nested())
    scenario = imported(path, tmp_path / "in")
    assert list(scenario.components) == ["first", "outer_inner_second", "third"]
    # second.u = 2 (3 + 1) = 8, third.u = 10 * 8 - 5 = 75
    assert final(path, tmp_path / "run", "outer_inner_second.y", "third.y") == [8.0, 75.0]


def test_units_of_the_connectors_on_the_way_count(pack, tmp_path):
    ssd = p.description(
        p.system(
            "root",
            p.feedthrough("first", THREE, y="m"),
            p.system(
                "inner",
                p.feedthrough("second", u="mm"),
                interface=[p.connector("in", "input", unit="mm")],
                connections=[p.connection("in", "second.u", p.linear(1, 0.25))],
            ),
            connections=[p.connection("first.y", "inner.in")],
        ),
        after=LENGTHS,
    )
    assert final(pack(ssd), tmp_path / "in", "inner_second.y") == [3000.25]


def test_names_that_are_no_names_here_are_changed_and_stay_unique(pack, tmp_path):
    ssd = p.description(p.system("root", p.feedthrough("a b"), p.feedthrough("a.b"), p.feedthrough("1")))
    assert list(imported(pack(ssd), tmp_path / "in").components) == ["a_b", "a_b_2", "c_1"]


def test_a_signal_dictionary_passes_signals_on_across_systems(pack, tmp_path):
    reference = '<ssd:SignalDictionaryReference name="{}" dictionary="bus">{}</ssd:SignalDictionaryReference>'
    listed = p.connectors(p.connector("s", "inout"))
    dictionary = (
        '<ssd:SignalDictionaries><ssd:SignalDictionary name="bus"><ssb:SignalDictionary version="1.0">'
        '<ssb:DictionaryEntry name="s"><ssc:Real/></ssb:DictionaryEntry></ssb:SignalDictionary></ssd:SignalDictionary>'
        "</ssd:SignalDictionaries>"
    )
    inner = p.system(
        "inner", reference.format("in", listed), p.feedthrough("second"), connections=[p.connection("in.s", "second.u")]
    )
    root = p.system(
        "root",
        p.feedthrough("first", THREE),
        reference.format("out", listed),
        inner,
        connections=[p.connection("first.y", "out.s", p.linear(3, 0))],
        dictionaries=dictionary,
    )
    assert final(pack(p.description(root)), tmp_path / "in", "inner_second.y") == [9.0]


def test_a_component_can_be_another_package_or_description_or_a_system_of_the_same_file(pack, tmp_path):
    interface = p.connector("in", "input"), p.connector("out", "output")
    wired = [p.connection("in", "f.u", p.linear(2, 0)), p.connection("f.y", "out")]
    again = p.bindings(p.inline(p.parameter("f.offset", "1")))
    body = p.system(
        "doubled", p.feedthrough("f"), interface=interface, connections=wired, bindings=again, attributes='id="twice"'
    )
    package = pack(p.description(body), name="doubled.ssp").read_bytes()
    more = p.bindings(p.inline(p.parameter("f.offset", "100")))
    links = (
        ("package", "resources/doubled.ssp", "application/x-ssp-package", ""),
        ("same", "#twice", "application/x-ssp-definition", more),
    )
    others = [
        f'<ssd:Component name="{n}" type="{t}" source="{s}">{p.connectors(*interface)}{b}</ssd:Component>'
        for n, s, t, b in links
    ]
    ways = ["first.y", "package.in"], ["package.out", "same.in"], ["same.out", "doubled.in"]
    root = p.system("root", p.feedthrough("first", THREE), body, *others, connections=[p.connection(*w) for w in ways])
    path = pack(p.description(root))
    with zipfile.ZipFile(path, "a") as archive:
        archive.writestr("resources/doubled.ssp", package)
    # package: 2 * 3 + 1 = 7; same: 2 * 7 + 100 = 114, for the component's binding counts more; doubled: 229
    names = "package_f.y", "same_f.y", "doubled_f.y"
    assert final(path, tmp_path / "in", *names) == [7.0, 114.0, 229.0]


def array(name, size, bindings=""):
    dimension = f'<ssc:Dimension size="{size}"/>'
    listed = (
        p.connector("u", "input", "Float64", inner=dimension),
        p.connector("y", "output", "Float64", inner=dimension),
        p.connector("n", "structuralParameter", "UInt64"),
    )
    sized = p.bindings(p.inline(p.parameter("n", size, "UInt64"), version="2.0"))
    return p.component(name, "vector_gain_fmi3.fmu", *listed, bindings=bindings or sized)


def test_arrays_connect_whole_and_by_elements_counted_from_1(pack, tmp_path):
    start = p.bindings(
        p.inline(p.parameter("n", 3, "UInt64"), p.parameter("u", "10 20 30", "Float64", shape=(3,)), version="2.0")
    )
    root = p.system(
        "root",
        array("a", 3, start),
        array("b", 3),
        array("c", 2),
        p.feedthrough("scalar"),
        connections=[
            p.connection("a.y", "b.u"),
            p.connection("b.y", "c.u", startIndices="3", endIndices="1"),
            p.connection("scalar.y", "c.u", endIndices="2"),
            p.connection("a.y", "scalar.u", p.linear(2, 0), startIndices="2"),
        ],
    )
    path = pack(p.description(root, version="2.0"), fmus=("feedthrough_fmi2", "vector_gain_fmi3"))
    assert final(path, tmp_path / "in", "b.y", "c.y", "scalar.y") == [[10.0, 20.0, 30.0], [30.0, 40.0], 40.0]


def test_the_algorithm_is_jacobi_where_nothing_says_another(pack, tmp_path):
    assert imported(pack(chain()), tmp_path / "in", STEP).algorithm.kind == "jacobi"


def test_a_connector_in_another_unit_than_its_variable_is_converted_at_its_component(pack, tmp_path):
    """The chassis stands at z = 1 m at rest under its own spring (FMU in m); its connector says mm."""
    listed = p.connector("z", "output", unit="mm")
    ssd = p.description(
        p.system(
            "root",
            p.component("c", "chassis_fmi2.fmu", listed),
            p.feedthrough("f", u="mm"),
            connections=[p.connection("c.z", "f.u")],
        ),
        after=LENGTHS,
    )
    z, y = final(pack(ssd, fmus=("feedthrough_fmi2", "chassis_fmi2")), tmp_path / "in", "c.z", "f.y")
    assert 0.9 < z < 1.1
    assert y == pytest.approx(1000 * z, rel=1e-14)


def test_an_empty_start_element_is_the_system_itself_as_some_tools_write_it(pack, tmp_path):
    nested = p.system(
        "B",
        p.feedthrough("f"),
        interface=[p.connector("in", "input")],
        connections=['<ssd:Connection startElement="" startConnector="in" endElement="f" endConnector="u"/>'],
    )
    root = p.system("A", nested, p.feedthrough("g", THREE), connections=[p.connection("g.y", "B.in")])
    assert final(pack(p.description(root)), tmp_path / "in", "B_f.y") == [3.0]


def test_a_unit_that_the_file_fails_to_define_is_taken_by_its_name_with_a_note(pack, tmp_path):
    result = import_ssp(pack(chain(y="mm", u="m", after="")), tmp_path / "in", STEP)
    assert (
        "SystemStructure.ssd: the unit `mm` is not defined there; it was taken for what its name means" in result.notes
    )
    assert final(pack(chain(y="mm", u="m", after="")), tmp_path / "run", "second.y") == [
        pytest.approx(0.003, rel=1e-15)
    ]


def test_a_local_variable_that_is_connected_is_read_like_an_output(pack, tmp_path):
    """SSP, section Connectors: kind local. The spring carries 400 kg at rest, so it is compressed by m g / k."""
    ssd = p.description(
        p.system(
            "root",
            p.component("c", "chassis_fmi2.fmu", p.connector("compression", "local", unit="m")),
            p.feedthrough("f", u="m"),
            connections=[p.connection("c.compression", "f.u")],
        ),
        after=LENGTHS,
        version="2.0",
    )
    path = pack(ssd, fmus=("feedthrough_fmi2", "chassis_fmi2"))
    assert imported(path, tmp_path / "in").components["c"].record == ["compression"]
    compression, y = final(path, tmp_path / "run", "c.compression", "f.y")
    assert compression == pytest.approx(400 * 9.81 / 15e3, rel=1e-3)  # 10 ms after the start, nearly at rest
    assert y == compression


@pytest.mark.parametrize(
    ("annotation", "type_"),
    [
        (
            '<o:Algorithm xmlns:o="http://opensimulationplatform.com/SSP/OSPAnnotations"><o:FixedStepAlgorithm '
            'baseStepSize="2e-3"/></o:Algorithm>',
            "com.opensimulationplatform",
        ),
        (
            '<o:SimulationInformation xmlns:o="urn:oms"><o:FixedStepMaster description="oms-ma" stepSize="0.002000"/>'
            "</o:SimulationInformation>",
            "org.openmodelica",
        ),
    ],
)
def test_the_step_of_another_tools_annotation_is_taken_with_a_note(pack, tmp_path, annotation, type_):
    annotated = f'<ssd:Annotations><ssc:Annotation type="{type_}">{annotation}</ssc:Annotation></ssd:Annotations>'
    experiment = f'<ssd:DefaultExperiment startTime="1" stopTime="1.01">{annotated}</ssd:DefaultExperiment>'
    path = pack(p.description(p.system("root", p.feedthrough("f", THREE)), experiment=experiment))
    result = import_ssp(path, tmp_path / "in")
    assert "macro_step 0.002 s: from another tool's annotation" in result.notes
    times = run(load_scenario(result.scenario))["time"].values
    assert times.tolist() == [1.0, 1.002, 1.004, 1.006, 1.008, 1.01]
