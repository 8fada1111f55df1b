"""Formulas as C: the grammar of `cosim.formula`, with every name replaced."""

from __future__ import annotations

import ast
from collections.abc import Mapping

from cosim.formula import FormulaError

_FUNCTIONS = {
    "exp": "exp",
    "log": "log",
    "sin": "sin",
    "cos": "cos",
    "tan": "tan",
    "tanh": "tanh",
    "sqrt": "sqrt",
    "abs": "fabs",
    "min": "fmin",
    "max": "fmax",
    "sign": "sign_of",
    "step": "step_of",
}
_OPERATORS: Mapping[type, str] = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}
#: Largest whole exponent that becomes a product.
_PRODUCT = 4
PREAMBLE = """
static inline double sign_of(double x) { return (double)((x > 0.0) - (x < 0.0)); }
static inline double step_of(double x) { return x >= 0.0 ? 1.0 : 0.0; }
"""


def to_c(text: str, names: Mapping[str, str]) -> str:
    """A formula as an expression in C.

    Args:
        text: The formula, already checked by `cosim.formula`.
        names: Name to what stands for it in C.

    Raises:
        FormulaError: It holds something that has no place in C here.
    """
    return _node(ast.parse(text.strip(), mode="eval").body, names)


def _node(node: ast.AST, names: Mapping[str, str]) -> str:
    if isinstance(node, ast.Constant) and isinstance(node.value, int | float):
        return repr(float(node.value))
    if isinstance(node, ast.Name | ast.Attribute | ast.Subscript):
        name = ast.unparse(node).replace(" ", "")
        if name not in names:
            raise FormulaError(f"`{name}` has no place in a compiled formula")
        return names[name]
    if isinstance(node, ast.UnaryOp):
        sign = "-" if isinstance(node.op, ast.USub) else "+"
        return f"({sign}{_node(node.operand, names)})"
    if isinstance(node, ast.BinOp):
        return _operation(node, names)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
        return f"{_FUNCTIONS[node.func.id]}({', '.join(_node(a, names) for a in node.args)})"
    raise FormulaError(f"`{ast.unparse(node)}` has no place in a compiled formula")


def _operation(node: ast.BinOp, names: Mapping[str, str]) -> str:
    left = _node(node.left, names)
    if not isinstance(node.op, ast.Pow):
        return f"({left} {_OPERATORS[type(node.op)]} {_node(node.right, names)})"
    power = node.right.value if isinstance(node.right, ast.Constant) else None
    if isinstance(power, int) and 1 <= power <= _PRODUCT:
        return "(" + " * ".join([left] * power) + ")"
    return f"pow({left}, {_node(node.right, names)})"
