"""Laws that a diagnosis prints are formulas that sympy reads, over the whole catalogue."""

from __future__ import annotations

import ast
import re

import pytest
import sympy
from sympy.parsing.sympy_parser import parse_expr

from diagnosis.candidates.candidate import CandidateTerm
from diagnosis.candidates.registry import candidate, catalogue
from diagnosis.models.cosimulation.unit_laws import LAWS
from diagnosis.search.unit_law import UnitLaw

#: Functions of a law that are applied, and are no symbols.
_APPLIED = re.compile(r"\b([A-Za-z_]\w*)\s*\(")
_RELATION = re.compile(r"^(?P<left>[^=<>]+?)(?P<sign><=|>=|=)(?P<right>[^=<>]+)$")


def equations(law: str) -> list[sympy.Basic]:
    """Relations of a law: `;` between them, `=`, `<=` or `>=` between two expressions of Python's syntax.

    Every name is a symbol (`I` is a current), every name before a bracket a function; abs, min and max are sympy's.
    """
    found = []
    for part in law.split(";"):
        match = _RELATION.match(part.strip())
        assert match is not None, f"{part!r} is no relation"
        left, right = (expression(match[side]) for side in ("left", "right"))
        relation = {"=": sympy.Eq, "<=": sympy.Le, ">=": sympy.Ge}[match["sign"]]
        found.append(relation(left, right, evaluate=False))
    return found


def expression(text: str) -> sympy.Expr:
    ast.parse(text.strip(), mode="eval")
    functions = set(_APPLIED.findall(text))
    names = {n: sympy.Symbol(n) for n in re.findall(r"[A-Za-z_]\w*", text) if n not in functions}
    known = {"abs": sympy.Abs, "min": sympy.Min, "max": sympy.Max}
    return parse_expr(text, {**{f: known.get(f, sympy.Function(f)) for f in functions}, **names}, evaluate=False)


def test_sympy_reads_every_law_and_finds_the_fitted_parameters_in_it() -> None:
    assert len(catalogue()) > 100
    for term in catalogue():
        _is_read(term)


def _is_read(term: CandidateTerm) -> None:
    found = equations(term.law)
    symbols = {s.name for e in found for s in e.free_symbols}
    functions = {str(f.func) for e in found for f in e.atoms(sympy.Function)}
    for name in (p.name for p in term.parameters if not p.is_fixed):
        # A law between two coils has the parameter of each: `g_a`, `g_b`.
        assert name in symbols | functions or {f"{name}_a", f"{name}_b"} <= symbols, f"no {name} in `{term.law}`"


def test_the_parsed_law_gives_the_numbers_of_the_formula() -> None:
    (law,) = equations(candidate("radiation").law)
    there = {"emissivity_area": 1e-4, "T": 350.0, "T_ambient": 295.0, "heat": 0.0}
    value = float(law.rhs.subs(there))
    assert value == pytest.approx(-1e-4 * 5.670374419e-8 * (350.0**4 - 295.0**4), rel=1e-12)


@pytest.mark.parametrize("law", ["heat =", "heat = a * (T", "heat", "a = b = c"])
def test_what_is_no_formula_is_told(law: str) -> None:
    with pytest.raises((AssertionError, SyntaxError)):
        equations(law)


UNIT_LAWS = [law for own in LAWS.values() for law in own("arm")]


@pytest.mark.parametrize("law", UNIT_LAWS, ids=lambda law: law.place.term.identifier)
def test_sympy_reads_the_laws_of_units_in_bullet(law: UnitLaw) -> None:
    assert equations(law.law)
