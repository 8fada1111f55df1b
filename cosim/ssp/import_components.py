"""Components of an SSP to components of a scenario."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pydantic
import yaml

from cosim.components import Component as ScenarioComponent
from cosim.components import FmuComponent
from cosim.ssp.files import copy_once
from cosim.ssp.fmus import Fmu, Variable
from cosim.ssp.graph import Node
from cosim.ssp.graph import Path as ElementPath
from cosim.ssp.import_connections import Ends
from cosim.ssp.model import Component, Unit
from cosim.ssp.namespaces import FLOAT_TYPES
from cosim.ssp.units import means_the_same, plain
from cosim.ssp.values import Value
from cosim.unit.errors import InputError
from cosim.yaml_file import parse_yaml, read_text

#: Keys of a scenario's FMU component that SSP has no place for; our annotation holds them.
OWN_KEYS = ("tolerance", "isolation", "structure", "record", "added_terms")
_EXACT = 2**53


def own_component(component: Component, out: Path) -> dict[str, Any]:
    """The YAML of a component of ours, with its parameter set beside the scenario.

    Raises:
        InputError: It is no component, is an FMU after all, or names a parameter set outside the package.
    """
    assert component.source is not None
    try:
        data = parse_yaml(read_text(component.source), component.source)
    except InputError as error:  # it names the file where the package is unpacked for the moment
        raise component.place.error(f"{component.source.name}: {error.key}: {error.problem}", error.remedy) from error
    try:
        given = pydantic.TypeAdapter(ScenarioComponent).validate_python(data)
    except pydantic.ValidationError as error:
        raise component.place.error(
            f"`{component.name}` is no component: {error.errors()[0]['msg']}", "export it again"
        ) from error
    if isinstance(given, FmuComponent):
        raise component.place.error(f"`{component.name}` is of kind {data['kind']}", "an FMU is a component of its own")
    if data.get("law", {}).get("kind") == "python":
        raise component.place.error(f"the law of `{component.name}` is a Python file", "a package carries no program")
    name = data.get("parameter_set")
    if name is not None:
        source = component.source.parent / Path(name).name
        if not source.is_file():
            raise component.place.error(f"there is no parameter set `{name}` beside it", "export it again")
        data["parameter_set"] = copy_once(source, out / "parameter_sets" / source.name).relative_to(out).as_posix()
    return dict(data)


@dataclass
class FmuImport:
    """Writes FMU components.

    Args:
        out: Folder of the scenario.
        values: Bound values.
        ends: Names of arrays and components.
        package: Name of the SSP, for the sources of parameters.
    """

    out: Path
    values: Mapping[Node, Value]
    ends: Ends
    package: str

    def component(self, path: ElementPath, component: Component, fmu: Fmu) -> dict[str, Any]:
        """One FMU component; its file and parameter set are written."""
        assert component.source is not None
        file = copy_once(component.source, self.out / "fmus" / component.source.name)
        data: dict[str, Any] = {"kind": "fmu", "fmu": file.relative_to(self.out).as_posix()}
        if self._interface(component, fmu) == "ModelExchange":
            data["integrator"] = "cvode"
        data |= {k: component.own[k] for k in OWN_KEYS if k in component.own}
        sorted_values = self._sorted(path, component, fmu)
        structure = {k: int(v) for k, v in sorted_values["structure"].items()}
        if structure:
            data["structure"] = {**data.get("structure", {}), **structure}
        scalars = {k: v for k, v in sorted_values["parameters"].items() if k in sorted_values["sourced"]}
        if scalars:
            data["parameter_set"] = self._parameter_set(path, scalars, sorted_values["sourced"])
        rest = {k: v for k, v in sorted_values["parameters"].items() if k not in scalars}
        if rest:
            data["parameters"] = rest
        if sorted_values["start"]:
            data["start"] = sorted_values["start"]
        if path in self.ends.locals:
            data["record"] = list(dict.fromkeys([*data.get("record", []), *self.ends.locals[path]]))
        return data

    def _interface(self, component: Component, fmu: Fmu) -> str:
        wanted = component.implementation
        if wanted == "any":
            return "CoSimulation" if "CoSimulation" in fmu.interfaces else "ModelExchange"
        return wanted

    def _sorted(self, path: ElementPath, component: Component, fmu: Fmu) -> dict[str, dict[str, Any]]:
        """Values as `structure`, `parameters` and `start`; `sourced` names those that a parameter set can hold."""
        found: dict[str, dict[str, Any]] = {"structure": {}, "parameters": {}, "start": {}, "sourced": {}}
        elements: dict[str, dict[str, Any]] = {}
        for (element, name), value in self.values.items():
            if element != path:
                continue
            variable = fmu.variables[name]
            self._check(component, variable, value)
            written, key = self._written(value, variable), _key(variable)
            if variable.name in fmu.elements:
                elements.setdefault(fmu.elements[variable.name][0], {})[variable.name] = written
                continue
            found[key][variable.name] = written
            if key == "parameters" and not isinstance(written, list) and variable.type in FLOAT_TYPES | {"Boolean"}:
                found["sourced"][variable.name] = value
        for name, given in elements.items():
            names = fmu.arrays[name]
            values = [given[n] if n in given else _start(fmu.variables[n]) for n in names]
            shape = tuple(b - a + 1 for a, b in zip(fmu.elements[names[0]][1], fmu.elements[names[-1]][1]))
            found[_key(fmu.variables[names[0]])][name] = _shaped(values, shape)
        return found

    def _check(self, component: Component, variable: Variable, value: Value) -> None:
        if not variable.is_settable:
            raise value.place.error(
                f"`{component.name}.{variable.name}` is {variable.causality} and calculated: it cannot be set",
                "set what it is calculated from",
            )
        written, wanted = value.parameter.type, variable.type
        if (written in FLOAT_TYPES and wanted not in FLOAT_TYPES) or (wanted == "Boolean") != (written == "Boolean"):
            raise value.place.error(
                f"`{component.name}.{variable.name}` is {wanted}, the value is {written}",
                "give it as the type of the variable",
            )

    def _written(self, value: Value, variable: Variable) -> Any:
        """The value as a scenario holds it."""
        if variable.type in FLOAT_TYPES:
            final = value.in_unit(variable.unit)
            if final.is_changed and not value.is_changed and value.unit is not None and means_the_same(value.unit):
                final = value  # as it is written: the FMU's layer converts it
            unit = variable.unit and final.unit
            texts = [_quantity(float(v), unit) for v in final.values]
            return _shaped(texts, value.parameter.shape)
        if variable.type == "Enumeration" and value.parameter.type == "Enumeration":
            return _shaped([self._item(value, variable, v) for v in value.values], value.parameter.shape)
        # A whole number that a floating-point number cannot hold is written as text.
        values = [str(v) if isinstance(v, int) and abs(v) > _EXACT else v for v in value.values]
        return _shaped(values, value.parameter.shape)

    def _item(self, value: Value, variable: Variable, name: str) -> int:
        """Number of an enumeration's item: the variable's own items count (SSP, section Enumeration)."""
        items = variable.items or value.parameter.enumeration or {}
        if name not in items:
            raise value.place.error(f"`{variable.name}` has no item `{name}`", f"it has: {', '.join(items) or 'none'}")
        return items[name]

    def _parameter_set(self, path: ElementPath, scalars: Mapping[str, Any], values: Mapping[str, Value]) -> str:
        """Write the numbers and switches of a component as a parameter set, with where each comes from."""
        parameters = {}
        for name, written in scalars.items():
            value = values[name]
            where = f"SSP {self.package}, parameter set {value.set_name}"
            source = value.parameter.description or where
            number, _, unit = written.partition(" ") if isinstance(written, str) else (written, "", "")
            parameters[name] = {
                "value": float(number) if unit else number,
                **({"unit": unit} if unit else {}),
                "source": source,
            }
        data = {"title": f"Parameters of {'.'.join(path)} ({self.package})", "parameters": parameters}
        file = self.out / "parameter_sets" / f"{self.ends.names[path]}.yaml"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(yaml.safe_dump(data, sort_keys=False, allow_unicode=True, width=110), encoding="utf-8")
        return file.relative_to(self.out).as_posix()


def _quantity(number: float, unit: Unit | None) -> float | str:
    """A number with its unit; a bare one where the FMU declares no unit."""
    return number if unit is None or unit.name == "1" else plain(unit, number)


def _start(variable: Variable) -> Any:
    """Start value of an array element that no value is bound to."""
    if variable.type in FLOAT_TYPES:
        return _quantity(float(variable.start or 0), variable.unit)
    return {"true": True, "false": False}.get(variable.start, variable.start)


def _key(variable: Variable) -> str:
    """Key of a scenario's component that a value belongs under."""
    return {"structuralParameter": "structure", "parameter": "parameters"}.get(variable.causality, "start")


def _collapsed(values: list[Any]) -> Any:
    """One value where all are equal: it fills the array."""
    return values[0] if all(v == values[0] and type(v) is type(values[0]) for v in values) else values


def _shaped(values: list[Any], shape: tuple[int, ...]) -> Any:
    """Nested lists of the shape, or one value where all are equal."""
    if not shape or isinstance(_collapsed(values), str | bool | int | float):
        return values[0]
    if len(shape) == 1:
        return values
    size = len(values) // shape[0]
    return [_shaped_rows(values[i * size : (i + 1) * size], shape[1:]) for i in range(shape[0])]


def _shaped_rows(values: list[Any], shape: tuple[int, ...]) -> list[Any]:
    if len(shape) == 1:
        return values
    size = len(values) // shape[0]
    return [_shaped_rows(values[i * size : (i + 1) * size], shape[1:]) for i in range(shape[0])]
