"""Names in formulas: which there are, and formulas with others in their place."""

from __future__ import annotations

import ast
from collections.abc import Mapping


def names_in(text: str) -> set[str]:
    """Names of quantities in a formula; dotted and indexed names whole."""
    found: set[str] = set()

    def visit(node: ast.AST) -> None:
        if isinstance(node, ast.Name | ast.Attribute | ast.Subscript):
            found.add(ast.unparse(node).replace(" ", ""))
            return
        for child in node.args if isinstance(node, ast.Call) else ast.iter_child_nodes(node):
            visit(child)

    visit(ast.parse(text.strip(), mode="eval").body)
    return found


def renamed(text: str, names: Mapping[str, str]) -> str:
    """A formula with symbols replaced by other names."""

    class Renamer(ast.NodeTransformer):
        def visit_Name(self, node: ast.Name) -> ast.AST:
            return ast.parse(names[node.id], mode="eval").body if node.id in names else node

        def visit_Call(self, node: ast.Call) -> ast.AST:
            node.args = [self.visit(a) for a in node.args]
            return node

    return ast.unparse(Renamer().visit(ast.parse(text.strip(), mode="eval").body))
