"""No package beside `diagnosis.models` asks of which kind a model is: a new kind is added there alone."""

from __future__ import annotations

import ast
import functools
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

from diagnosis.models.protocol import DiagnosisModel, Effect, RecordedRun, Spot

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("diagnosis", "chainmail", "cosim")
MODELS = "diagnosis.models"
#: File to why it may ask. None does; one that has to says here why no member of `DiagnosisModel` can tell it.
ALLOWED: Mapping[str, str] = {}
#: The search takes the smallest models too (`diagnosis.search.problem.Model`): what is faster is optional there.
OPTIONAL = "diagnosis/search/"
#: Members of models, runs, laws and places that are asked for as they are; scenarios have some of these names too.
MEMBERS = {n for kind in (DiagnosisModel, RecordedRun, Effect, Spot) for n in vars(kind) if not n.startswith("_")}
MEMBERS = (MEMBERS | {"inner", "layout", "scope"}) - {"terms", "runs", "name", "label", "law"}


def module_of(path: Path) -> str:
    return ".".join(path.relative_to(ROOT).with_suffix("").parts)


@functools.cache
def sources() -> tuple[tuple[str, ast.Module], ...]:
    """Name of every module with its tree."""
    paths = [p for package in PACKAGES for p in sorted((ROOT / package).rglob("*.py"))]
    return tuple((module_of(p), ast.parse(p.read_text(encoding="utf-8"))) for p in paths)


def imported(tree: ast.AST, module: str) -> dict[str, str]:
    """Local name to the full name of what was imported by it, anywhere in a module."""
    found: dict[str, str] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            origin = node.module or ""
            if node.level:
                origin = ".".join([*module.split(".")[: -node.level], *filter(None, [origin])])
            found |= {a.asname or a.name: f"{origin}.{a.name}" for a in node.names}
        elif isinstance(node, ast.Import):
            found |= {a.asname or a.name.partition(".")[0]: a.name if a.asname else "" for a in node.names}
    return found


def full_name(node: ast.AST, names: Mapping[str, str], module: str) -> str:
    """What a name or a chain of attributes stands for."""
    if isinstance(node, ast.Attribute):
        before = full_name(node.value, names, module)
        return f"{before}.{node.attr}"
    if isinstance(node, ast.Name):
        return names.get(node.id, f"{module}.{node.id}") or node.id
    return ""


@functools.cache
def wrappers_elsewhere() -> set[str]:
    """Classes of other packages that are models: they derive from one of `diagnosis.models`, or from each other."""
    bases: dict[str, set[str]] = {}
    for module, tree in sources():
        names = imported(tree, module)
        for node in ast.walk(tree):
            if isinstance(node, ast.ClassDef) and not module.startswith(MODELS):
                bases[f"{module}.{node.name}"] = {full_name(b, names, module) for b in node.bases}
    found: set[str] = set()
    while True:
        more = {n for n, own in bases.items() if any(b.startswith(f"{MODELS}.") or b in found for b in own)}
        if more == found:
            return found
        found = more


def asked_classes(node: ast.AST) -> Iterator[ast.AST]:
    """What a node compares the class of something with."""
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("isinstance", "issubclass"):
        yield from ast.walk(node.args[1])
    elif isinstance(node, ast.MatchClass):
        yield node.cls
    elif isinstance(node, ast.Compare) and any(
        isinstance(n, ast.Call) and isinstance(n.func, ast.Name) and n.func.id == "type"
        for n in (node.left, *node.comparators)
    ):
        yield from (node.left, *node.comparators)


def switches(module: str, tree: ast.AST, elsewhere: set[str]) -> list[str]:
    """Where a module asks of which kind a model is, by its class or by whether it has a member."""
    names, found = imported(tree, module), []
    for node in ast.walk(tree):
        for asked in asked_classes(node):
            name = full_name(asked, names, module)
            if name.startswith(f"{MODELS}.") or name in elsewhere:
                found.append(f"{module}:{getattr(node, 'lineno', 0)} asks for {name}")
        if (
            isinstance(node, ast.Call)
            and isinstance(node.func, ast.Name)
            and node.func.id in ("hasattr", "getattr")
            and isinstance(node.args[1], ast.Constant)
            and node.args[1].value in MEMBERS
            and not module.replace(".", "/").startswith(OPTIONAL)
        ):
            found.append(f"{module}:{node.lineno} asks for a member {node.args[1].value}")
    return found


def test_no_package_asks_of_which_kind_a_model_is() -> None:
    elsewhere = wrappers_elsewhere()
    found = [
        text
        for module, tree in sources()
        if not module.startswith(f"{MODELS}.") and f"{module.replace('.', '/')}.py" not in ALLOWED
        for text in switches(module, tree, elsewhere)
    ]
    assert not found, "ask a member of diagnosis.models.protocol.DiagnosisModel instead:\n" + "\n".join(found)


def test_wrappers_of_other_packages_are_known() -> None:
    found = wrappers_elsewhere()
    assert {"diagnosis.faults.model.FaultyModel", "diagnosis.faults.given.GivenFaults"} <= found
    assert "diagnosis.judge.initial_state.InitialStateModel" in found


@pytest.mark.parametrize(
    "source",
    [
        "from diagnosis.models.coil_network.model import CoilNetworkModel\nisinstance(x, CoilNetworkModel)",
        "from diagnosis.models.fabric.model import FabricModel as F\nnot isinstance(x, (int, F))",
        "from diagnosis.models.fabric.model import FabricModel as F\nisinstance(x, int | F)",
        "import diagnosis.models.build as b\nisinstance(x, b.ClosedLoopModel)",
        "from diagnosis.models import build\nissubclass(x, build.ClosedLoopModel)",
        "def f(x):\n    from diagnosis.models.wrappers.wrapped import WrappedModel as W\n    return isinstance(x, W)",
        "from diagnosis.models.fabric.model import FabricModel\ntype(x) is FabricModel",
        "from diagnosis.models.fabric.model import FabricModel\nmatch x:\n    case FabricModel():\n        pass",
        "from diagnosis.faults.given import GivenFaults\nassert isinstance(x, GivenFaults)",
        "while hasattr(model, 'inner'):\n    model = model.inner",
        "getattr(model, 'can_be_fitted', True)",
        "getattr(model.where(term)[1], 'mask', None)",
    ],
)
def test_a_switch_that_is_put_back_is_seen(source: str) -> None:
    assert switches("diagnosis.elsewhere", ast.parse(source), wrappers_elsewhere())


@pytest.mark.parametrize(
    "source",
    [
        "from diagnosis.recording.series import Series\nisinstance(x, Series)",
        "from cosim.components import FmuComponent\nisinstance(x, FmuComponent)",
        "model.can_be_fitted",
        "getattr(sensor, 'rate', None)",
    ],
)
def test_what_asks_no_model_is_left_alone(source: str) -> None:
    assert not switches("diagnosis.elsewhere", ast.parse(source), wrappers_elsewhere())
