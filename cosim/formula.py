"""Formulas that a user writes: read without running any of it, checked for units, evaluated on arrays in SI.

Allowed are numbers, names (`body.T`, `x[2]` too), `+ - * / **` and the functions below; nothing else of Python.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from cosim.unit.quantity import conversion, parse_unit, registry
from cosim.unit.variable import AnyArray

Values = Mapping[str, AnyArray]
_Evaluate = Callable[[Values], Any]

#: Functions of numbers without unit.
_PURE: Mapping[str, Callable[..., Any]] = {
    "exp": np.exp,
    "log": np.log,
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "tanh": np.tanh,
}
#: Functions that keep the unit of their arguments.
_KEEPING: Mapping[str, Callable[..., Any]] = {"abs": np.abs, "min": np.minimum, "max": np.maximum}
#: Functions that give 0, 1 or a sign of anything: `step(x)` is 1 where x >= 0.
_COUNTING: Mapping[str, Callable[..., Any]] = {
    "sign": np.sign,
    "step": lambda x: np.where(np.asarray(x) >= 0.0, 1.0, 0.0),
}
_OPERATORS: Mapping[type, Callable[[Any, Any], Any]] = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
}
#: Depth of brackets in brackets that a formula may have.
MOST_DEPTH = 60


class FormulaError(ValueError):
    """A formula cannot be read, or its units do not agree; the text says where."""


class Formula:
    """A formula of named quantities.

    Args:
        text: As written.
        units: Name to unit of every quantity that it may use.
        unit: Unit that its value must have the dimension of.

    Raises:
        FormulaError: It holds something that is not allowed, an unknown name, or units that do not agree.
    """

    def __init__(self, text: str, units: Mapping[str, str], unit: str) -> None:
        self.text, self._units = text, units
        #: Names that it uses.
        self.names: set[str] = set()
        try:
            tree = ast.parse(text.strip(), mode="eval").body
        except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
            raise FormulaError(f"`{text}` is no formula") from error
        self._evaluate, dimension = self._read(tree, 0)
        wanted = parse_unit(unit).dimensionality
        if dimension != wanted:
            raise FormulaError(f"`{text}` is in {_dimension_text(dimension)}, not in {unit}")

    def value(self, values: Values) -> Any:
        """Its value in SI base units, from quantities in SI base units."""
        return self._evaluate(values)

    def _read(self, node: ast.AST, depth: int) -> tuple[_Evaluate, Any]:
        """How a part is evaluated, and its dimension."""
        if depth > MOST_DEPTH:
            raise FormulaError(f"`{self.text}` is nested too deeply")
        if isinstance(node, ast.Constant):
            return self._number(node)
        if isinstance(node, ast.Name | ast.Attribute | ast.Subscript):
            return self._quantity(node)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.UAdd | ast.USub):
            inner, dimension = self._read(node.operand, depth + 1)
            return (inner if isinstance(node.op, ast.UAdd) else lambda v: -inner(v)), dimension
        if isinstance(node, ast.BinOp):
            return self._power(node, depth) if isinstance(node.op, ast.Pow) else self._operation(node, depth)
        if isinstance(node, ast.Call):
            return self._call(node, depth)
        raise FormulaError(f"`{ast.unparse(node)}` is not allowed in a formula")

    def _number(self, node: ast.Constant) -> tuple[_Evaluate, Any]:
        if isinstance(node.value, bool) or not isinstance(node.value, int | float) or not np.isfinite(node.value):
            raise FormulaError(f"`{ast.unparse(node)}` is no number")
        number = np.float64(node.value)  # overflows to infinity instead of raising
        return (lambda values: number), parse_unit("1").dimensionality

    def _quantity(self, node: ast.AST) -> tuple[_Evaluate, Any]:
        name = ast.unparse(node).replace(" ", "")
        element = None
        if name not in self._units and isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Constant):
            name, element = ast.unparse(node.value), node.slice.value
        if name not in self._units:
            raise FormulaError(f"there is no `{name}`; there are: {', '.join(self._units)}")
        self.names.add(name)
        dimension = parse_unit(self._units[name]).dimensionality
        if element is None:
            return (lambda values: values[name]), dimension
        if not isinstance(element, int) or element < 1:
            raise FormulaError(f"`{ast.unparse(node)}`: elements are counted from 1")
        return (lambda values: values[name].reshape(-1)[element - 1]), dimension

    def _operation(self, node: ast.BinOp, depth: int) -> tuple[_Evaluate, Any]:
        operator = _OPERATORS.get(type(node.op))
        if operator is None:
            raise FormulaError(f"`{ast.unparse(node)}`: only + - * / ** are allowed")
        one, first = self._read(node.left, depth + 1)
        other, second = self._read(node.right, depth + 1)
        if isinstance(node.op, ast.Add | ast.Sub) and first != second:
            raise FormulaError(
                f"`{ast.unparse(node)}` puts together {_dimension_text(first)} and {_dimension_text(second)}"
            )
        dimension = first * second if isinstance(node.op, ast.Mult) else first
        dimension = first / second if isinstance(node.op, ast.Div) else dimension
        return (lambda values: operator(one(values), other(values))), dimension

    def _power(self, node: ast.BinOp, depth: int) -> tuple[_Evaluate, Any]:
        base, dimension = self._read(node.left, depth + 1)
        before = set(self.names)
        power, of_power = self._read(node.right, depth + 1)
        if of_power != parse_unit("1").dimensionality:
            raise FormulaError(f"`{ast.unparse(node)}`: the exponent has a unit")
        if dimension == of_power:
            return (lambda values: base(values) ** power(values)), dimension
        if self.names != before:
            raise FormulaError(f"`{ast.unparse(node)}`: a quantity with a unit needs a number as exponent")
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            number = float(power({}))
        if not np.isfinite(number):
            raise FormulaError(f"`{ast.unparse(node)}`: the exponent is not finite")
        return (lambda values: base(values) ** number), dimension**number

    def _call(self, node: ast.Call, depth: int) -> tuple[_Evaluate, Any]:
        name = node.func.id if isinstance(node.func, ast.Name) else ast.unparse(node.func)
        if node.keywords or name not in {*_PURE, *_KEEPING, *_COUNTING, "sqrt"}:
            known = ", ".join([*_PURE, *_KEEPING, *_COUNTING, "sqrt"])
            raise FormulaError(f"there is no function `{name}`; there are: {known}")
        if len(node.args) != (2 if name in ("min", "max") else 1):
            raise FormulaError(f"`{ast.unparse(node)}` has a wrong number of arguments")
        read = [self._read(a, depth + 1) for a in node.args]
        parts, dimensions = [r[0] for r in read], [r[1] for r in read]
        nothing = parse_unit("1").dimensionality
        if name == "sqrt":
            return (lambda values: np.sqrt(parts[0](values))), dimensions[0] ** 0.5
        if name in _PURE and dimensions[0] != nothing:
            raise FormulaError(f"`{ast.unparse(node)}`: its argument is in {_dimension_text(dimensions[0])}")
        if any(d != dimensions[0] for d in dimensions):
            raise FormulaError(f"`{ast.unparse(node)}` compares different units")
        function = {**_PURE, **_KEEPING, **_COUNTING}[name]
        dimension = dimensions[0] if name in _KEEPING else nothing
        return (lambda values: function(*(p(values) for p in parts))), dimension


def _dimension_text(dimension: Any) -> str:
    return str(dimension) if dimension else "a number without unit"


def to_base(unit: str) -> tuple[float, float]:
    """(factor, offset) to SI base units: base value = factor * value + offset."""
    return conversion(unit, base_unit(unit))


def base_unit(unit: str) -> str:
    """SI base units of the same dimension.

    >>> base_unit("kg/h"), base_unit("%")
    ('kilogram / second', '1')
    """
    base = registry().Quantity(1.0, parse_unit(unit)).to_base_units().units
    return f"{base}" if str(base) != "dimensionless" else "1"
