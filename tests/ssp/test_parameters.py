"""Parameter sets, mappings and bindings: which value reaches which variable (SSP, section ParameterBindings).

FMUs of the running tests are y = gain u + offset with u = 1, so y = gain + offset. Numbers are exact in binary.
"""

import zipfile

import pytest
import yaml

from cosim.ssp.importer import import_ssp
from tests.ssp import packages as p
from tests.ssp.runs import STEP, final

ONE = p.inline(p.parameter("u", "1"))


def single(*bound, **keywords):
    return p.description(p.system("root", p.feedthrough("f", p.bindings(ONE, *bound))), **keywords)


def gain(value, **keywords):
    return p.inline(p.parameter("gain", value), **keywords)


@pytest.mark.parametrize(
    ("bound", "expected"),
    [
        ([gain("8")], 8.0),
        ([gain("8"), gain("4")], 4.0),  # the later binding counts
        ([gain("4"), p.inline(p.parameter("other", "8"))], 4.0),  # a name that is not there is ignored
        ([p.inline(p.parameter("ain", "8"), prefix="g")], 8.0),
        ([p.inline(p.parameter("k", "8"), mapping=p.mapping(p.entry("k", "gain")))], 8.0),
        ([p.inline(p.parameter("k", "8"), mapping=p.mapping(p.entry("k", "gain"), p.entry("k", "offset")))], 16.0),
        # with a mapping, what is not mapped is not applied, even where its own name would fit
        ([p.inline(p.parameter("gain", "8"), p.parameter("k", "4"), mapping=p.mapping(p.entry("k", "offset")))], 5.0),
        # the prefix belongs to the name that a mapping looks for
        ([p.inline(p.parameter("k", "8"), prefix="a.", mapping=p.mapping(p.entry("a.k", "gain")))], 8.0),
        ([p.inline(p.parameter("k", "8"), mapping=p.mapping(p.entry("k", "gain", p.linear(2, 0.5))))], 16.5),
    ],
)
def test_bindings_of_a_component(pack, tmp_path, bound, expected):
    assert final(pack(single(*bound)), tmp_path / "in", "f.y") == [expected]


def test_files_are_read_like_inline_sets(pack, tmp_path):
    bound = (
        '<ssd:ParameterBinding source="resources/values.ssv"><ssd:ParameterMapping source="resources/names.ssm"/>'
        "</ssd:ParameterBinding>"
    )
    values = p.parameter_set(p.parameter("k", "8"), head=p.NAMESPACES)
    names = f'<ssm:ParameterMapping {p.NAMESPACES} version="1.0">{p.entry("k", "gain")}</ssm:ParameterMapping>'
    path = pack(single(bound), values_ssv=values, names_ssm=names)
    assert final(path, tmp_path / "in", "f.y") == [8.0]


def hierarchy(root=(), outer=(), leaf=()):
    inner = p.feedthrough("f", p.bindings(ONE, *leaf))
    nested = p.system("B", inner, bindings=p.bindings(*outer) if outer else "")
    return p.description(p.system("A", nested, bindings=p.bindings(*root) if root else ""))


@pytest.mark.parametrize(
    ("root", "outer", "leaf", "expected"),
    [
        ("B.f.gain", None, None, 2.0),
        (None, "f.gain", None, 4.0),
        (None, "f.gain", "gain", 4.0),
        ("B.f.gain", "f.gain", "gain", 2.0),  # the highest level counts
        ("f.gain", None, "gain", 8.0),  # not the hierarchical name at that level
    ],
)
def test_bindings_of_systems_reach_inside_and_the_highest_level_counts(pack, tmp_path, root, outer, leaf, expected):
    levels = [
        () if name is None else (p.inline(p.parameter(name, value)),)
        for name, value in ((root, "2"), (outer, "4"), (leaf, "8"))
    ]
    assert final(pack(hierarchy(*levels)), tmp_path / "in", "B_f.y") == [expected]


def test_equal_hierarchical_names_all_get_the_value(pack, tmp_path):
    """The standard's punning: element f in system A.B, and element A.B.f beside it."""
    nested = p.system("A", p.system("B", p.feedthrough("f", p.bindings(ONE))))
    root = p.system(
        "root",
        nested,
        p.feedthrough("A.B.f", p.bindings(ONE)),
        bindings=p.bindings(p.inline(p.parameter("A.B.f.gain", "2"))),
    )
    assert final(pack(p.description(root)), tmp_path / "in", "A_B_f.y", "A_B_f_2.y") == [2.0, 2.0]


def test_values_of_a_systems_connectors_go_on_to_what_they_are_connected_to(pack, tmp_path):
    interface = p.connector("in", "input", unit="mm"), p.connector("k", "parameter")
    listed = p.connector("u", "input", unit="m"), p.connector("gain", "parameter"), p.connector("y", "output")
    nested = p.system(
        "B",
        p.component("f", "feedthrough_fmi2.fmu", *listed, bindings=p.bindings(gain("100"))),
        interface=interface,
        connections=[p.connection("in", "f.u"), p.connection("k", "f.gain", p.linear(2, 0))],
    )
    root = p.system("A", nested, bindings=p.bindings(p.inline(p.parameter("B.in", "500"), p.parameter("B.k", "4"))))
    ssd = p.description(root, after=p.units("ssd", m={"m": 1}, mm={"m": 1, "factor": 0.001}))
    # u = 0.5, gain = 2 * 4, which counts more than the component's own 100
    assert final(pack(ssd), tmp_path / "in", "B_f.y") == [4.0]


MEGA = p.units("ssv", Mg={"kg": 1, "factor": 1000}, t={"kg": 1, "factor": 500}, odd={"m": 1})


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        (p.inline(p.parameter("mass", "0.5", unit="Mg"), units=MEGA), 500.0),
        (p.inline(p.parameter("mass", "0.5", unit="t"), units=MEGA), 250.0),  # as defined there, not as pint knows t
        (p.inline(p.parameter("mass", "0.5")), 0.5),
        (
            p.inline(
                p.parameter("k", "1", unit="Mg"), units=MEGA, mapping=p.mapping(p.entry("k", "mass", p.linear(1, 1)))
            ),
            1001.0,
        ),
        (
            p.inline(
                p.parameter("k", "2", unit="Mg"),
                units=MEGA,
                mapping=p.mapping(p.entry("k", "mass", p.linear(3, 1), suppressUnitConversion="true")),
            ),
            7.0,
        ),
    ],
)
def test_units_of_parameters_are_those_that_the_file_defines(pack, tmp_path, given, expected):
    ssd = p.description(p.system("root", p.component("c", "chassis_fmi2.fmu", bindings=p.bindings(given))))
    result = import_ssp(pack(ssd, fmus=("chassis_fmi2",)), tmp_path / "in", STEP)
    data = yaml.safe_load((tmp_path / "in" / "parameter_sets" / "c.yaml").read_text())["parameters"]["mass"]
    factor = {"kg": 1.0, "Mg": 1000.0}[data["unit"]]
    assert data["value"] * factor == expected
    assert "parameter set values" in data["source"]
    assert result.notes[-1].startswith("algorithm jacobi")


TYPES = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="types" instantiationToken="t">
<CoSimulation modelIdentifier="types"/>
<TypeDefinitions><EnumerationType name="Mode"><Item name="off" value="7"/><Item name="on" value="9"/></EnumerationType>
</TypeDefinitions>
<ModelVariables><Float64 name="time" valueReference="0" causality="independent" variability="continuous"/>{}
</ModelVariables><ModelStructure/></fmiModelDescription>"""
NUMBERS = ("Float64", "Float32", "Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64", "Boolean")


def types_fmu(folder):
    """The description of an FMU with a parameter of every type, and of arrays."""
    rows = [
        f'<{t} name="p{t}" valueReference="{i}" causality="parameter" variability="fixed" start="0"/>'
        for i, t in enumerate(NUMBERS, 1)
    ]
    fixed = 'causality="parameter" variability="fixed"'
    rows += [
        f'<Enumeration name="pEnumeration" declaredType="Mode" valueReference="20" {fixed} start="7"/>',
        f'<String name="pString" valueReference="21" {fixed}><Start value=""/></String>',
        f'<Binary name="pBinary" valueReference="22" {fixed}><Start value=""/></Binary>',
        f'<Float64 name="matrix" valueReference="23" {fixed} start="0 0 0 0 0 0"><Dimension start="2"/>'
        '<Dimension start="3"/></Float64>',
        f'<String name="texts" valueReference="24" {fixed}><Dimension start="2"/><Start value=""/><Start value=""/>'
        "</String>",
    ]
    path = folder / "types.fmu"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("modelDescription.xml", TYPES.format("\n".join(rows)))
    return path


def test_values_of_every_type_and_arrays_reach_the_scenario(pack, tmp_path):
    values = {
        "Float64": "0.1",
        "Float32": "0.5",
        "Int8": "-128",
        "UInt8": "255",
        "Int16": "-3",
        "UInt16": "4",
        "Int32": "-5",
        "UInt32": "6",
        "Int64": "-9007199254740993",
        "UInt64": "18446744073709551615",
        "Boolean": "true",
        "Enumeration": "on",
        "String": "5 V",
        "Binary": "00ff00",
    }
    given = [p.parameter(f"p{t}", v, t) for t, v in values.items()]
    given += [
        p.parameter("matrix", "1 2 3 4 5 6", "Float64", shape=(2, 3)),
        p.parameter("texts", ["a b", "c"], "String", shape=(2,)),
    ]
    bound = p.bindings(p.inline(*given, version="2.0"))
    path = pack(p.description(p.system("root", p.component("c", "types.fmu", bindings=bound)), version="2.0"), fmus=())
    with zipfile.ZipFile(path, "a") as archive:
        archive.write(types_fmu(tmp_path), "resources/types.fmu")
    import_ssp(path, tmp_path / "in", STEP)
    component = yaml.safe_load((tmp_path / "in" / "scenario.yaml").read_text())["components"]["c"]
    sourced = yaml.safe_load((tmp_path / "in" / "parameter_sets" / "c.yaml").read_text())["parameters"]
    found = component["parameters"] | {k: v["value"] for k, v in sourced.items()}
    assert found == {
        "pFloat64": 0.1,
        "pFloat32": 0.5,
        "pInt8": -128,
        "pUInt8": 255,
        "pInt16": -3,
        "pUInt16": 4,
        "pInt32": -5,
        "pUInt32": 6,
        "pInt64": "-9007199254740993",
        "pUInt64": "18446744073709551615",
        "pBoolean": True,
        "pEnumeration": 9,
        "pString": "5 V",
        "pBinary": "00ff00",
        "matrix": [[1, 2, 3], [4, 5, 6]],
        "texts": ["a b", "c"],
    }


@pytest.mark.parametrize(
    ("kind", "given", "table", "expected"),
    [
        (
            "Boolean",
            "true",
            '<ssc:BooleanMappingTransformation><ssc:MapEntry source="true" target="false"/>'
            "</ssc:BooleanMappingTransformation>",
            False,
        ),
        (
            "Int32",
            "3",
            '<ssc:IntegerMappingTransformation><ssc:MapEntry source="3" target="-4"/>'
            "</ssc:IntegerMappingTransformation>",
            -4,
        ),
        (
            "Int32",
            "5",
            '<ssc:IntegerMappingTransformation><ssc:MapEntry source="3" target="-4"/>'
            "</ssc:IntegerMappingTransformation>",
            5,
        ),  # what is not listed stays
        (
            "Enumeration",
            "high",
            '<ssc:EnumerationMappingTransformation><ssc:MapEntry source="high" target="on"/>'
            "</ssc:EnumerationMappingTransformation>",
            9,
        ),
    ],
)
def test_mappings_transform_single_values(pack, tmp_path, kind, given, table, expected):
    entries = p.mapping(p.entry("k", f"p{kind}", table), version="2.0")
    bound = p.bindings(p.inline(p.parameter("k", given, kind), mapping=entries, version="2.0"))
    path = pack(p.description(p.system("root", p.component("c", "types.fmu", bindings=bound)), version="2.0"), fmus=())
    with zipfile.ZipFile(path, "a") as archive:
        archive.write(types_fmu(tmp_path), "resources/types.fmu")
    import_ssp(path, tmp_path / "in", STEP)
    component = yaml.safe_load((tmp_path / "in" / "scenario.yaml").read_text())["components"]["c"]
    if kind == "Boolean":
        component["parameters"] = {
            "pBoolean": yaml.safe_load((tmp_path / "in" / component["parameter_set"]).read_text())["parameters"][
                "pBoolean"
            ]["value"]
        }
    assert component["parameters"] == {f"p{kind}": expected}
