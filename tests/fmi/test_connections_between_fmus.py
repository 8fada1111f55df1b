"""Ticks, Booleans, units and rings of discrete values between FMUs."""

from __future__ import annotations

import zipfile
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import pytest
import xarray as xr
import yaml

from cosim.assemble import assemble
from cosim.connection import Connection
from cosim.fmu.archive import open_fmu
from cosim.fmu.co_simulation import CoSimulationUnit
from cosim.fmu.settings import FmuSettings
from cosim.run import run
from cosim.scenario import Scenario, load_scenario
from cosim.system import System
from cosim.unit.errors import InputError
from cosim.unit.protocol import AnyArray, Causality, Unit, UnitError, Variable, VariableType
from cosim.unit.quantity import PhysicalValue, conversion
from tests.fmi.fmi_models import described

Built = dict[tuple[str, int], Path]


def scenario(
    folder: Path,
    fmus: dict[str, Path | dict[str, Any]],
    connections: list[Any],
    algorithm: str = "gauss_seidel",
    stop: str = "1.4 s",
    **more: Any,
) -> Scenario:
    components = {
        name: {"kind": "fmu", **({"fmu": str(fmu)} if isinstance(fmu, Path) else fmu)} for name, fmu in fmus.items()
    }
    data = {
        "title": "connected",
        "time": {"stop": stop, "macro_step": "0.1 s", "output_step": "0.1 s"},
        "algorithm": {"kind": algorithm},
        "components": components,
        "connections": connections,
        **more,
    }
    path = folder / "scenario.yaml"
    path.write_text(yaml.safe_dump(data, sort_keys=False))
    return load_scenario(path)


def result(*arguments: Any, **keywords: Any) -> xr.Dataset:
    return run(scenario(*arguments, **keywords))


@pytest.mark.parametrize("algorithm", ["gauss_seidel", "jacobi", "iterated", "step_doubling"])
@pytest.mark.parametrize("order", ["source target", "target source"])
@pytest.mark.parametrize("is_direct", [False, True])
def test_a_tick_arrives_once(built: Built, tmp_path: Path, algorithm: str, order: str, is_direct: bool) -> None:
    fmu = built["clocks", 3]
    if is_direct:  # all outputs depend on all inputs, clocks among them
        fmu = described(fmu, tmp_path / "direct.fmu", ' dependencies=""', "")
    fmus: dict[str, Path | dict[str, Any]] = dict.fromkeys(order.split(), fmu)
    found = result(tmp_path, fmus, ["source.every_second -> target.triggered"], algorithm, "2 s")
    # the source ticks at 0.4, 1.0 and 1.6 s
    assert found["target.triggered_ticks"].values[-1] == 3
    assert found["source.triggered_ticks"].values[-1] == 0


@pytest.mark.parametrize("version", [2, 3])
def test_a_boolean_goes_to_numbers_as_0_or_1_and_may_be_scaled(built: Built, tmp_path: Path, version: int) -> None:
    echo = built["echo", version]
    wires = [
        "a.boolean_out -> b.float64_in",
        "a.boolean_out -> b.int32_in",
        {"connect": "b.boolean_out -> c.float64_in", "factor": 230.0},
    ]
    on = {"fmu": str(echo), "fmi": version, "start": {"boolean_in": True}}
    plain = {"fmu": str(echo), "fmi": version}
    found = result(tmp_path, {"a": on, "b": on, "c": plain}, wires, stop="0.2 s")
    assert found["b.float64_out"].values[-1] == 1.0
    assert found["b.int32_out"].values[-1] == 1
    assert found["c.float64_out"].values[-1] == 230.0
    off = result(tmp_path, {"a": plain, "b": plain}, ["a.boolean_out -> b.float64_in"], stop="0.2 s")
    assert off["b.float64_out"].values[-1] == 0.0


def test_a_number_goes_to_no_boolean_and_the_remedy_says_how(built: Built, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"Float64 does not fit Boolean without loss; put an FMU between them"):
        assemble(scenario(tmp_path, dict.fromkeys("ab", built["echo", 3]), ["a.float64_out -> b.boolean_in"]))


def with_unit(built: Built, folder: Path, name: str, output: str, base: str = "") -> Path:
    """An FMU whose input and output u and y have this unit."""
    units = f'<UnitDefinitions><Unit name="{output}">{base}</Unit></UnitDefinitions>'
    old = '<UnitDefinitions><Unit name="s"/></UnitDefinitions>'
    plain = described(built["trouble", 3], folder / f"{name}1.fmu", old, units)
    plain = described(plain, folder / f"{name}2.fmu", ' unit="s"', "")
    plain = described(plain, folder / f"{name}3.fmu", 'causality="input"', f'causality="input" unit="{output}"')
    return described(plain, folder / f"{name}.fmu", 'name="sum"', f'name="sum" unit="{output}"')


HZ, RADIANS = '<BaseUnit s="-1"/>', '<BaseUnit s="-1" rad="1"/>'


@pytest.mark.parametrize(
    ("units", "factor"),
    [
        ((("Hz", HZ), ("rad/s", RADIANS)), 2 * np.pi),
        ((("rad/s", RADIANS), ("Hz", HZ)), 1 / (2 * np.pi)),
        ((("Hz", ""), ("rad/s", "")), 2 * np.pi),
        ((("Hz", HZ), ("1/s", HZ)), 1.0),
    ],
)
def test_hertz_become_radians_per_second(
    built: Built, tmp_path: Path, units: tuple[tuple[str, str], ...], factor: float
) -> None:
    one, other = (with_unit(built, tmp_path, f"f{i}", *u) for i, u in enumerate(units))
    found = result(tmp_path, {"a": one, "b": other}, ["a.sum -> b.u"], stop="0.1 s")
    assert found["a.sum"].values[0] == 10.0
    assert found["b.sum"].values[0] == pytest.approx(10.0 * 10.0 * factor, rel=1e-14)


@pytest.mark.parametrize(
    ("source", "target", "factor"),
    [
        ("Hz", "rad/s", 2 * np.pi),
        ("kHz", "deg/s", 360e3),
        ("rpm", "Hz", 1 / 60),
        ("Hz", "rpm", 60.0),
        ("1/s", "rad/s", 1.0),
        ("1/s", "Hz", 1.0),
        ("V*s/rad", "V/Hz", 2 * np.pi),
        ("N*m", "N*m/rad", 1.0),
        ("Hz", "1/min", 60.0),
        ("rad/s**2", "rad/s**2", 1.0),
    ],
)
def test_conversions_between_cycles_and_angles(source: str, target: str, factor: float) -> None:
    assert conversion(source, target) == (pytest.approx(factor, rel=1e-14), 0.0)
    assert PhysicalValue.parse(f"3 {source}").to(target) == pytest.approx(3.0 * factor, rel=1e-14)


def test_a_unit_into_none_is_refused_and_the_remedy_works(built: Built, tmp_path: Path) -> None:
    metres, none = with_unit(built, tmp_path, "m", "m", '<BaseUnit m="1"/>'), built["trouble", 3]
    wire = "a.sum -> b.u"
    with pytest.raises(InputError) as caught:
        assemble(scenario(tmp_path, {"a": metres, "b": none}, [wire]))
    assert "u has no unit" in caught.value.remedy
    remedy = caught.value.remedy.split("`")[1]
    written = yaml.safe_load(remedy)
    assert written == {"connect": wire, "convert_units": False}
    assert result(tmp_path, {"a": metres, "b": none}, [written], stop="0.1 s")["b.sum"].values[0] == 100.0


def test_a_ring_of_binary_is_no_algebraic_loop(built: Built, tmp_path: Path) -> None:
    """Every output follows every input, as of a bus and its nodes; a message that is there goes round and settles."""
    start = {"fmu": str(built["echo", 3]), "start": {"binary_in": "00ff"}}
    wires = ["a.binary_out -> b.binary_in", "b.binary_out -> c.binary_in", "c.binary_out -> a.binary_in"]
    found = result(tmp_path, {"a": start, "b": built["echo", 3], "c": built["echo", 3]}, wires, stop="0.3 s")
    assert {str(found[f"{n}.binary_out"].values[-1]) for n in "abc"} <= {"00ff", ""}
    assert len({str(found[f"{n}.binary_out"].values[-1]) for n in "abc"}) == 1


def test_a_ring_of_integers_settles(built: Built, tmp_path: Path) -> None:
    wires = ["a.int32_out -> b.int32_in", "b.int32_out -> a.int32_in"]
    start = {"fmu": str(built["echo", 3]), "start": {"int32_in": 7}}
    found = result(tmp_path, {"a": start, "b": start}, wires, stop="0.3 s")
    assert found["a.int32_out"].values.tolist() == [7] * 4


def test_a_ring_that_never_settles_is_an_error_that_says_so() -> None:
    values = {"u": np.array(False), "y": np.array(True)}

    class Inverter(Unit):
        name = "not"
        variables = MappingProxyType(
            {
                "u": Variable("u", Causality.INPUT, (), "1", start=False, type=VariableType.BOOLEAN),
                "y": Variable("y", Causality.OUTPUT, (), "1", type=VariableType.BOOLEAN),
            }
        )
        feedthrough = initial_feedthrough = MappingProxyType({"y": frozenset({"u"})})

        def get(self, name: str) -> AnyArray:
            return values[name]

        def set(self, name: str, value: AnyArray) -> None:
            values[name][...] = value

        def refresh(self) -> None:
            values["y"][...] = not values["u"]

    system = System({"not": Inverter()}, [Connection(("not", "y"), ("not", "u"))])  # type: ignore[abstract]
    with pytest.raises(UnitError, match=r"ring of discrete values .* do not settle in 100 rounds"):
        system.propagate()


def test_scheduled_execution_alone_is_named_as_such(built: Built, tmp_path: Path) -> None:
    only = described(built["trouble", 3], tmp_path / "a.fmu", "<ModelExchange ", "<ScheduledExecution ")
    only = described(only, tmp_path / "b.fmu", "<CoSimulation modelIdentifier", "<!-- modelIdentifier")
    only = described(only, tmp_path / "c.fmu", 'mightReturnEarlyFromDoStep="true"/>', "-->")
    with pytest.raises(InputError, match="it has no Co-Simulation interface") as caught:
        CoSimulationUnit("u", open_fmu(only), FmuSettings())
    assert "Scheduled Execution alone, which is not supported" in caught.value.remedy
    wanted = described(built["clocks", 3], tmp_path / "d.fmu", "x", "x")
    with pytest.raises(InputError, match="it has no Model Exchange interface") as caught:
        assemble(scenario(tmp_path, {"u": {"fmu": str(wanted), "integrator": "cvode"}}, []))
    assert "write `integrator: internal`" in caught.value.remedy


@pytest.mark.parametrize("isolation", ["none", "process"])
def test_a_second_name_of_an_output_is_connected_once_it_is_recorded(built: Built, tmp_path: Path, isolation: str):
    with zipfile.ZipFile(built["ball", 3]) as archive:
        text = archive.read("modelDescription.xml").decode()
    old = next(line for line in text.splitlines() if 'name="height"' in line)
    new = old.replace("/>", '><Alias name="depth" description="the same"/></Float64>')
    ball = {"fmu": str(described(built["ball", 3], tmp_path / "ball.fmu", old, new)), "isolation": isolation}
    connections = [{"connect": "ball.depth -> echo.float64_in", "convert_units": False}]
    with pytest.raises(
        InputError, match=r"depth is no output of ball, but a local variable of its FMU.*record: \[depth"
    ):
        assemble(scenario(tmp_path, {"ball": ball, "echo": built["echo", 3]}, connections))
    found = result(tmp_path, {"ball": {**ball, "record": ["depth"]}, "echo": built["echo", 3]}, connections)
    assert np.array_equal(found["echo.float64_out"], found["ball.height"])
